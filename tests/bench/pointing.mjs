// Measures the page in Chromium: the time from a movement of the mouse to the picture in which the element under the
// mouse is highlighted. Prints a line of JSON for each polytope and each part of its picture. OVAL4D names the server's
// binary, as for the tests of the page.
//   node pointing.mjs [points in each part of the picture]
//
// A movement leads to two pictures. The first highlights the sections of the element itself. The second highlights all
// parts that show the element, after the server has named them. For each picture, there are two times in milliseconds:
// - `work` is how long the page's scripts run: from the event `pointermove` (or the server's answer) to the end of the
//   drawing. Work of the browser, such as composing the page, and of the graphics card is not included.
// - `shown` is the time from the event until the browser has rendered the page, as in web_client/src/latency.ts.
import { bundleClient } from "../browser/support/bundle_client.mjs";

bundleClient();
const { accurateBrowser, idle } = await import("../browser/support/browser.mjs");
const { columnsOf, loopOf, middle, openTurned } = await import("../browser/support/pointing.mjs");
const { project, stripPoint, worldPoints } = await import("../browser/support/scene.mjs");
const { closeAll } = await import("../browser/support/suite.mjs");

const kPolytopes = ["24-cell", "120-cell", "600-cell", "small stellated 120-cell"];
const kPoints = Number(process.argv[2] ?? 100);

/**
 * Runs in the page before its scripts. window.pointing.begin() discards all measurements. window.pointing.pictures then
 * has {work, shown} for each picture that is drawn after the next movement of the mouse.
 */
function measurePictures() {
    let start; // when the page began to handle the movement
    let began; // when the page's current task began; undefined between tasks
    let work = 0; // for the next picture, in milliseconds
    let drawings = 0; // how many calls have drawn triangles
    let last = ""; // the mouse's place; browsers repeat events without a movement
    const endTask = () => {
        if (began !== undefined) work += performance.now() - began;
        began = undefined;
    };
    // A task includes the code that waits for promises that it resolves. The next message arrives after the end of the
    // task.
    const taskEnds = new MessageChannel();
    taskEnds.port1.onmessage = endTask;
    const beginTask = () => {
        endTask();
        began = performance.now();
    };
    const followTask = () => {
        beginTask();
        taskEnds.port2.postMessage(null);
    };
    const pointing = (window.pointing = {
        pictures: [],
        begin() {
            // The graphics card must have finished earlier pictures.
            document.querySelector("#drawing canvas.solids").getContext("webgl2").finish();
            pointing.pictures = [];
            start = undefined;
            work = 0;
        },
    });
    window.addEventListener(
        "pointermove",
        ({ clientX, clientY }) => {
            if (last === `${clientX} ${clientY}`) return;
            last = `${clientX} ${clientY}`;
            start = performance.now();
            followTask();
        },
        { capture: true },
    );
    const Plain = window.WebSocket;
    window.WebSocket = class extends Plain {
        constructor(...given) {
            super(...given);
            this.addEventListener("message", followTask);
        }
    };
    const { drawElements } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.drawElements = function (...given) {
        ++drawings;
        return drawElements.apply(this, given);
    };
    const afterRendering = new MessageChannel();
    const drawn = []; // pictures that the browser has not rendered yet
    afterRendering.port1.onmessage = () => {
        for (const picture of drawn.splice(0)) picture.shown = performance.now() - picture.start;
    };
    const ask = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (run) =>
        ask((time) => {
            beginTask();
            const before = drawings;
            run(time);
            endTask();
            if (drawings === before || start === undefined) return;
            const picture = { start, work };
            work = 0;
            pointing.pictures.push(picture);
            drawn.push(picture);
            afterRendering.port2.postMessage(null);
        });
}

/** Places on elements: the vertices, whose pixels are `points`, and the middles of the edges and faces. */
function placesOn(elements, points) {
    const { edges, of } = elements;
    const middles = [...of.edges].map((_, e) => middle([points[edges[2 * e]], points[edges[2 * e + 1]]]));
    return [...points, ...middles, ...[...of.faces].map((_, f) => middle(loopOf(elements, f).map((v) => points[v])))];
}

/** Places on the elements in each part of a picture, in pixels. */
function placesIn(picture, size) {
    const { coordinates, projection, scene, slices } = picture;
    const pixelsOf = (scale, position, vertices) =>
        worldPoints({ scale }, { position, vertices }).map((point) => project(scene, point, size));
    const shown = slices.filter(({ drawn, vertices }) => drawn && vertices.length > 0);
    const [whole] = projection.parts;
    const columnOf = columnsOf(scene, size);
    const onStrip = (v) => stripPoint(picture, v, (3 * (v + 0.5) * 4) / coordinates.length, size.height);
    return {
        slices: shown.flatMap((slice) => placesOn(slice, pixelsOf(scene.scale, slice.position, slice.vertices))),
        projection: placesOn(whole, pixelsOf(projection.scale, projection.position, whole.vertices)),
        coordinates: Array.from({ length: coordinates.length / 4 }, (_, v) =>
            scene.coordinates.columns > 0 ? onStrip(v) : columnOf(v),
        ),
    };
}

/** Chooses `count` evenly spread places. Consecutive places are far from each other. */
function chosen(places, count) {
    const step = (Math.sqrt(5) - 1) / 2;
    return Array.from({ length: count }, (_, i) => places[Math.floor(places.length * ((i * step) % 1))]);
}

/**
 * Points at places, one after another. Resolves to the pictures after each place that has another element than the
 * place before.
 */
async function point({ page, moveTo }, places) {
    const measured = [];
    for (const [x, y] of places) {
        await page.evaluate(() => window.pointing.begin());
        await moveTo(x, y);
        await idle(page);
        const { pictures, isNamed } = await page.evaluate(() => {
            return { pictures: window.pointing.pictures, isNamed: !document.getElementById("pointed").hidden };
        });
        if (isNamed && pictures.length > 0) measured.push(pictures);
    }
    return measured;
}

/** The median and the 95th percentile of values; undefined if there are none. */
function summary(values) {
    if (values.length === 0) return undefined;
    const sorted = [...values].sort((a, b) => a - b);
    const at = (part) => sorted[Math.floor(part * (sorted.length - 1))];
    return { median: at(0.5), p95: at(0.95) };
}

const browser = await accurateBrowser();
for (const polytope of kPolytopes) {
    const opened = await openTurned({ polytope }, { browser, before: measurePictures });
    const parts = placesIn(await opened.picture(), opened.size);
    await point(opened, chosen(parts.slices, 10)); // the browser compiles the code, and buffers get their sizes
    for (const [part, places] of Object.entries(parts)) {
        const measured = await point(opened, chosen(places, kPoints));
        const count = measured.length;
        if (count < kPoints / 4) throw new Error(`${polytope}, ${part}: only ${count} points have elements`);
        const of = (index, what) =>
            summary(measured.flatMap((pictures) => (pictures[index] ? [pictures[index][what]] : [])));
        const first = { work: of(0, "work"), shown: of(0, "shown") };
        const second = { work: of(1, "work"), shown: of(1, "shown") };
        console.log(JSON.stringify({ polytope, part, points: count, first, second }));
    }
    if (opened.errors.length > 0) throw new Error(opened.errors.join("\n"));
    await opened.close();
}
await closeAll("test");
await closeAll("process");
process.exit(0);
