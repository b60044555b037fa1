// The matrix of planar sections: the elements under the pointer in its panels, and the focus point that the pointer
// moves.
import assert from "node:assert/strict";

import { assertSame, columnsOf, faceIn, frames, labeled, litAt, loadTesseract, middle, openTurned, rounded, shot } from "./support/pointing.mjs";
import { idle, presented } from "./support/browser.mjs";
import { kPanels, panelOf } from "./support/matrix.mjs";
import { distance, pixelAt } from "./support/pixels.mjs";
import { rgb } from "./support/scene.mjs";
import { test } from "./support/suite.mjs";
import { touchOf } from "./support/touch.mjs";

const kEdges = 96; // the number of edges of the 24-cell
const kFaces = 96;
const kPoint = [0.2, 0.1, -0.3, 0.15];

const openMatrix = (settings = {}, options = {}) => openTurned({ view: "matrix", point: kPoint, ...settings }, options);

async function drawByServer(page) {
    await page.locator("[data-page-tool=frames]").dispatchEvent("click");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
}

/** The middle of the longest edge in a panel, and the cell from which this edge was cut. */
function longestEdge({ section, place }) {
    const edges = section.edges.map((ends, e) => {
        const [from, to] = ends.map((p) => place(section.points[p]));
        return { cell: section.of.edges[e], at: middle([from, to]), length: Math.hypot(from[0] - to[0], from[1] - to[1]) };
    });
    return edges.reduce((best, edge) => (edge.length > best.length ? edge : best));
}

/**
 * Whether the middles of a cell's edges in a panel have become highlighted. Undefined if the panel does not cut the
 * cell.
 */
function litIn({ section, place }, cell, before, after) {
    const own = section.edges.filter((_, e) => section.of.edges[e] === cell);
    if (own.length === 0) return undefined;
    return own.every((ends) => litAt(before, after, middle(ends.map((p) => place(section.points[p])))));
}

/**
 * The vertices of the turned 24-cell. They are more exact than in messages, so that planes pass exactly through them.
 * Before the rotation, their coordinates are integers.
 */
async function exactVertices(script, coordinates) {
    const { orientation } = await script.state();
    const times = (rows, v) => rows.map((row) => row.reduce((sum, factor, k) => sum + factor * v[k], 0));
    const inverse = orientation.map((_, k) => orientation.map((row) => row[k]));
    return Array.from({ length: coordinates.length / 4 }, (_, v) => {
        const own = times(inverse, coordinates.subarray(4 * v, 4 * v + 4));
        return times(orientation, own.map(Math.round));
    });
}

const kPixel = 0.045; // more than the coordinates of neighboring pixels of a panel differ

const isNear = (point, expected) => point.every((value, axis) => Math.abs(value - expected[axis]) < kPixel);

/** Waits until the focus point of the session is near `expected`. */
const pointAt = (script, expected, what) => script.until(({ point }) => isNear(point, expected), what);

test("matrix: a cell under the mouse in a panel is named, and lit in all panels, slices and coordinates", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openMatrix();
    await moveTo(4, 4);
    const before = await shot(page);
    const seen = await picture();
    const { cell, at } = longestEdge(panelOf(seen.matrix, "wx", size));
    const { revision } = await script.state();
    await moveTo(...at);
    const text = await labeled(page, /volume/);
    const lit = await shot(page);
    assert.equal((await script.state()).revision, revision, "pointing changes nothing");
    const panels = kPanels.map((name) => litIn(panelOf(seen.matrix, name, size), cell, before, lit));
    assert.ok(panels.filter((isLit) => isLit).length >= 4, "the cell is in several panels");
    assert.ok(!panels.includes(false), String(panels));

    // The server highlights the same elements, and knows the same vertices.
    const kept = await script.request({ type: "set", highlight: { element: "cell", number: cell } });
    const { highlight, coordinates } = await picture();
    const w = [...highlight.own_vertices].map((v) => coordinates[4 * v + 3]);
    const range = `w ${rounded(Math.min(...w))} … ${rounded(Math.max(...w))}`;
    assert.equal(text, `Cell ${cell} · octahedron · volume 3.77 · ${range}`);
    await presented(page, kept.revision);
    await moveTo(4, 4);
    await labeled(page, /^$/);
    assertSame(lit, await shot(page), at);
    assert.deepEqual(errors, []);
    await close();
});

test("matrix: a point of a section is a 2-face, an edge or a vertex", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openMatrix();
    const { coordinates, projection, ...seen } = await picture();
    const yx = panelOf(seen.matrix, "yx", size);
    const face = yx.section.of.points[0];
    assert.ok(face < kFaces);
    await moveTo(...yx.place(yx.section.points[0]));
    assert.match(await labeled(page, /area/), new RegExp(`^Face ${face} · triangle · area 1.73 · w −?[\\d.]+ … −?[\\d.]+$`));

    const vertices = await exactVertices(script, coordinates);
    /** Moves the focus point, and hovers over it in the panel zw, where it is a point of the section. */
    const hoverAt = async (point, source) => {
        const { revision } = await script.request({ type: "set", point });
        await presented(page, revision);
        const zw = panelOf((await picture()).matrix, "zw", size);
        assert.ok(zw.section.of.points.includes(source), `${zw.section.of.points} and ${source}`);
        await moveTo(4, 4);
        const before = await shot(page);
        await moveTo(...zw.at(point[3], point[2]));
        const text = await labeled(page, /./);
        const lit = await shot(page);
        for (const name of kPanels) {
            const { at, row, column } = panelOf(seen.matrix, name, size);
            assert.ok(litAt(before, lit, at(point[column], point[row])), `lit in ${name}`);
        }
        return text;
    };
    const [whole] = projection.parts;
    const [a, b] = whole.edges.subarray(0, 2);
    const edge = whole.of.edges[0] - kFaces;
    const [from, to] = [a, b].map((v) => vertices[whole.of.vertices[v] - kEdges]);
    const between = from.map((value, axis) => 0.4 * value + 0.6 * to[axis]);
    assert.match(await hoverAt(between, kFaces + edge), new RegExp(`^Edge ${edge} · length 2 · w`));
    const vertex = whole.of.vertices[a] - kEdges;
    assert.equal(
        await hoverAt(from, kFaces + kEdges + vertex),
        `Vertex ${vertex} (${from.map(rounded).join(", ")})`,
    );
    assert.deepEqual(errors, []);
    await close();
});

test("matrix: what is pointed at elsewhere is lit in the panels", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openMatrix({ point: [0, 0, 0, 0] });
    const { coordinates } = await picture();
    const vertices = await exactVertices(script, coordinates);
    const point = vertices.reduce((best, one) => (Math.abs(one[3]) < Math.abs(best[3]) ? one : best));
    const vertex = vertices.indexOf(point);
    const { revision } = await script.request({ type: "set", point });
    await presented(page, revision);
    const seen = await picture();
    await moveTo(4, 4);
    const before = await shot(page);
    const { source: cell, at } = faceIn(seen, size, seen.slices.find(({ focus }) => focus).index);
    await moveTo(...at);
    await labeled(page, new RegExp(`^Cell ${cell} `));
    let lit = await shot(page);
    const panels = kPanels.map((name) => litIn(panelOf(seen.matrix, name, size), cell, before, lit));
    assert.ok(panels.includes(true) && !panels.includes(false), String(panels));

    await moveTo(...columnsOf(seen.scene, size)(vertex));
    await labeled(page, new RegExp(`^Vertex ${vertex} `));
    lit = await shot(page);
    const { at: place } = panelOf(seen.matrix, "yx", size);
    assert.ok(litAt(before, lit, place(point[0], point[1])), "the vertex at the focus point");
    assert.deepEqual(errors, []);
    await close();
});

for (const mode of ["geometry", "frames"]) {
    test(`matrix: a click keeps an element, or moves the focus point where there is none (${mode})`, async () => {
        const { page, script, errors, press, size, picture, click, close } = await openMatrix();
        if (mode === "frames") await drawByServer(page);
        const { matrix } = await picture();
        const zy = panelOf(matrix, "zy", size);
        const { cell, at } = longestEdge(zy);
        await click(...at);
        const { highlight, point, slices } = await script.until((state) => state.highlight !== null, "the highlight");
        assert.deepEqual(highlight, { element: "cell", number: cell });
        assert.ok(isNear(point, kPoint), `the point stays, not ${point}`);

        await click(...zy.at(-0.25, 0.4));
        const moved = await pointAt(script, [0.2, -0.25, 0.4, 0.15], "the point under the click");
        assert.deepEqual([moved.highlight, moved.slices], [highlight, slices]);
        assert.ok(isNear((await press("u")).point, kPoint), "one step");

        await click(...panelOf(matrix, "xw", size).at(-0.5, -0.1));
        const { section } = await pointAt(script, [-0.1, 0.1, -0.3, -0.5], "a click in a panel with w");
        assert.ok(Math.abs(section.w + 0.5) < kPixel, "the focus slice moves");
        assert.deepEqual(errors, []);
        await close();
    });

    test(`matrix: a drag in a panel moves the focus point in one undo step, and not the camera (${mode})`, async () => {
        const { page, script, errors, press, size, picture, moveTo, close } = await openMatrix();
        if (mode === "frames") await drawByServer(page);
        const { matrix, scene } = await picture();
        await frames(page);
        await page.evaluate(() => {
            window.sent = [];
            const { send } = WebSocket.prototype;
            WebSocket.prototype.send = function (text) {
                const { type, point, continues } = JSON.parse(text);
                if (type === "set" && point) window.sent.push(continues);
                return send.call(this, text);
            };
        });
        const { camera } = await script.state();
        const yw = panelOf(matrix, "yw", size);
        await moveTo(...yw.at(0.3, 0.2));
        await page.mouse.down();
        for (let i = 1; i <= 10; ++i) {
            await moveTo(...yw.at(0.3 - 0.08 * i, 0.2 + 0.03 * i));
            await idle(page); // so that the page sends each move
        }
        await pointAt(script, [0.2, 0.5, -0.3, -0.5], "the point under the pointer");
        await moveTo(...yw.at(-9, 0.1));
        await pointAt(script, [0.2, 0.1, -0.3, -1.08 * scene.circumradius], "the point at the panel's edge");
        await page.mouse.up();
        const [first, ...others] = await page.evaluate(() => window.sent);
        assert.equal(first, undefined);
        assert.ok(others.length >= 3 && others.every((continues) => continues), `${others.length} more moves`);
        assert.deepEqual((await script.state()).camera, camera);
        assert.ok(isNear((await press("u")).point, kPoint), "one step");

        // Outside the panels and on the diagonal, a drag orbits the camera.
        for (const from of [[yw.at(0, 0)[0], yw.at(0, 0)[1] + 2 * yw.half * 2.13], [200, 200]]) {
            const { camera: start } = await script.state();
            await moveTo(...from);
            await page.mouse.down();
            await moveTo(from[0] + 30, from[1]);
            await page.mouse.up();
            const orbited = await script.until((one) => one.camera.azimuth !== start.azimuth, "an orbit");
            assert.ok(isNear(orbited.point, kPoint), "the point stays");
        }
        assert.deepEqual(errors, []);
        await close();
    });
}

test("matrix: in the server's pictures, too, the panels follow another object of the same name", async () => {
    const { page, script, errors, size, picture, click, close } = await openMatrix();
    await drawByServer(page);
    for (const edge of [2, 4]) {
        await loadTesseract(page, script, edge);
        await idle(page);
        const { matrix } = await picture();
        const [y, z] = [0.2 * edge, 0.1 * edge];
        await click(...panelOf(matrix, "zy", size).at(y, z)); // at the same pixel of both
        const isUnderClick = ({ point }) => Math.abs(point[1] - y) < 0.05 * edge && Math.abs(point[2] - z) < 0.05 * edge;
        await script.until(isUnderClick, `the point under the click, for edges of length ${edge}`);
    }
    assert.deepEqual(errors, []);
    await close();
});

test("matrix: one finger moves the focus point, two fingers zoom", async () => {
    const { page, script, errors, size, picture, close } = await openMatrix({}, { hasTouch: true });
    const { matrix } = await picture();
    const { x, y } = await page.locator("#drawing").boundingBox();
    const send = await touchOf(page);
    const touch = (type, ...points) => send(type, ...points.map((at) => [x + at[0], y + at[1]]));
    const zx = panelOf(matrix, "zx", size);
    await touch("touchStart", zx.at(0, 0));
    for (let i = 1; i <= 8; ++i) await touch("touchMove", zx.at(0.1 * i, -0.05 * i));
    await touch("touchEnd");
    const { camera } = await pointAt(script, [0.8, 0.1, -0.4, 0.15], "the point under the finger");
    assert.deepEqual(camera, { azimuth: 0, elevation: 0, zoom: 1 });

    const [left, top] = zx.at(0, 0);
    await touch("touchStart", [left - 20, top], [left + 20, top]);
    for (const d of [25, 30, 35, 40]) await touch("touchMove", [left - d, top], [left + d, top]);
    await touch("touchEnd");
    const zoomed = await script.until((one) => one.camera.zoom > 1.5, "a zoom");
    assert.ok(isNear(zoomed.point, [0.8, 0.1, -0.4, 0.15]), "a pinch does not move the point");
    assert.deepEqual(errors, []);
    await close();
});

test("matrix: the cursor tells the panels, where Alt-drag still turns and a double click does not reset the view", async () => {
    const { page, script, press, size, picture, moveTo, close } = await openMatrix();
    const { matrix } = await picture();
    const cursor = () => page.evaluate(() => getComputedStyle(document.getElementById("drawing")).cursor);
    const wy = panelOf(matrix, "wy", size);
    const inside = wy.at(0.3, 0.3);
    await moveTo(200, 200);
    assert.equal(await cursor(), "grab");
    await moveTo(...inside);
    assert.equal(await cursor(), "crosshair");
    await page.mouse.down();
    await moveTo(inside[0] + 20, inside[1]);
    assert.equal(await cursor(), "crosshair");
    await page.mouse.up();
    await moveTo(...wy.at(0, 2.3));
    assert.equal(await cursor(), "grab", "between two panels");
    await moveTo(...inside);
    for (const [key, expected] of [["o", "grab"], ["m", "crosshair"]]) {
        await press(key);
        assert.equal(await cursor(), expected, "under a mouse at rest, after another view");
    }

    await script.request({ type: "set", point: kPoint, camera: { azimuth: 0.3 } });
    const { last } = await script.until(({ camera }) => camera.azimuth === 0.3, "the camera");
    await page.keyboard.down("Alt");
    await moveTo(...inside);
    await page.mouse.down();
    await moveTo(inside[0] + 40, inside[1]);
    await page.mouse.up();
    await page.keyboard.up("Alt");
    const turned = await script.until((one) => one.last.angles[0] !== last.angles[0], "a turn");
    assert.ok(isNear(turned.point, kPoint), "the point stays");
    const box = await page.locator("#drawing").boundingBox();
    await page.mouse.dblclick(box.x + inside[0], box.y + inside[1]);
    const { camera } = await pointAt(script, [0.2, 0.3, -0.3, 0.3], "the point under the click");
    await frames(page);
    assert.deepEqual([camera.azimuth, (await script.state()).camera.azimuth], [0.3, 0.3]);
    await close();
});

test("matrix: its button is pressed in the matrix view, that of the focus slice is not", async () => {
    const { page, script, press, close } = await openMatrix({ view: "oval" });
    const pressed = () =>
        page.evaluate(() => {
            const isPressed = (action) => document.querySelector(`[data-action=${action}]`).ariaPressed === "true";
            return { matrix: isPressed("matrix"), view: isPressed("view") };
        });
    assert.deepEqual(await pressed(), { matrix: false, view: false });
    await page.click("[data-action=matrix]");
    const { revision } = await script.until(({ view }) => view === "matrix", "the matrix");
    await presented(page, revision);
    assert.deepEqual(await pressed(), { matrix: true, view: false });
    await page.focus("#drawing");
    await press("o");
    assert.deepEqual(await pressed(), { matrix: false, view: true });
    await press("m");
    assert.deepEqual(await pressed(), { matrix: true, view: false });
    await close();
});

test("matrix: the command line moves the focus point, and its help mentions it", async () => {
    const { page, script, errors, close } = await openMatrix();
    await page.focus("#drawing");
    await page.keyboard.press(":");
    await page.keyboard.type("set point=-0.5,pi/8,0,0.25");
    await page.keyboard.press("Enter");
    await script.until(({ point }) => point[0] === -0.5 && point[1] === Math.PI / 8, "the point");
    await page.waitForSelector("#drawing:focus");
    await page.keyboard.press(":");
    await page.keyboard.type("set point=1,2");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => /four numbers/.test(document.getElementById("command-error").textContent));
    for (const topic of ["point", "matrix"]) {
        await page.fill("#command", `help ${topic}`);
        await page.keyboard.press("Enter");
        await page.waitForSelector("#help[open]");
        const shown = await page.locator("#help :is(tr, dl > div):visible").allTextContents();
        assert.ok(shown.length > 0 && shown.length < 16, shown.join("; "));
        assert.ok(shown.every((line) => line.includes(topic)), shown.join("; "));
        await page.keyboard.press("Escape");
        await page.waitForSelector("#drawing:focus");
        await page.keyboard.press(":");
    }
    assert.deepEqual(errors, []);
    await close();
});

test("matrix: what only the panels cut is lit and described, too", async () => {
    const slices = { count: 3, spacing: 0.05 };
    const { page, size, picture, moveTo, close } = await openMatrix({ slices, projection: "off" });
    const seen = await picture();
    const inSlices = (kind, source) => seen.slices.some(({ of }) => of[kind].includes(source));
    const wx = panelOf(seen.matrix, "wx", size);
    const { points, edges, of } = wx.section;
    const outside = edges.findIndex((_, e) => !inSlices("faces", of.edges[e]));
    const ends = edges[outside].map((p) => wx.place(points[p]));
    await moveTo(...middle(ends));
    assert.match(await labeled(page, /./), new RegExp(`^Cell ${of.edges[outside]} `));
    const lit = await shot(page);
    const color = rgb(seen.scene.colors.highlight);
    for (const end of ends) assert.ok(distance(pixelAt(lit, ...end), color) < 24, "the ends of the edge are lit");

    const cellsAt = (p) => of.edges.filter((_, e) => edges[e].includes(p));
    const corner = points.findIndex(
        (_, p) => !inSlices("edges", of.points[p]) && cellsAt(p).every((cell) => inSlices("faces", cell)),
    );
    await moveTo(...wx.place(points[corner]));
    assert.match(await labeled(page, /^Face/), new RegExp(`^Face ${of.points[corner]} · .*w`));
    await close();
});

test("matrix: moves in two panels add up while the first one is not answered", async () => {
    const { page, script, size, picture, click, close } = await openMatrix();
    const { matrix } = await picture();
    await page.evaluate(() => {
        window.held = [];
        const { send } = WebSocket.prototype;
        WebSocket.prototype.send = function (text) {
            if (!JSON.parse(text).point || window.isReleased) return send.call(this, text);
            return void window.held.push(() => send.call(this, text)); // the server receives it later
        };
    });
    await click(...panelOf(matrix, "yx", size).at(0.4, 0.5));
    await page.waitForFunction(() => window.held.length === 1);
    await click(...panelOf(matrix, "wz", size).at(-0.1, -0.4));
    await frames(page);
    await page.evaluate(() => {
        window.isReleased = true;
        window.held.forEach((sendNow) => sendNow());
    });
    await pointAt(script, [0.4, 0.5, -0.1, -0.4], "both moves");
    await close();
});

for (const mode of ["geometry", "frames"]) {
    test(`matrix: the contours of a field have the colors of their levels (${mode})`, async () => {
        const { page, script, errors, size, picture, close } = await openMatrix();
        await script.request({ type: "load", name: "formula", format: "formula", data: "sqrt(x^2 + y^2 + z^2 + w^2)" });
        const { revision } = await script.request({
            ...{ type: "set", view: "matrix", levels: [1, 1.5], point: kPoint, projection: "off" },
            shown: { bars: false, balls: false },
        });
        if (mode === "frames") await drawByServer(page);
        await presented(page, revision);
        const { matrix, scene } = await picture();
        const seen = await shot(page);
        for (const name of kPanels) {
            const { section, place } = panelOf(matrix, name, size);
            assert.deepEqual(section.contours.map(({ level }) => level), [0, 1], name);
            for (const { level, points } of section.contours) {
                const color = rgb(scene.surfaces.find((one) => one.level === level).color);
                const isDrawn = (point) => {
                    const [x, y] = place(point).map(Math.floor);
                    const steps = [-1, 0, 1];
                    return steps.some((dx) => steps.some((dy) => distance(pixelAt(seen, x + dx, y + dy), color) < 64));
                };
                const drawn = points.filter(isDrawn).length;
                assert.ok(drawn > 0.9 * points.length, `${name}: ${drawn} of ${points.length} points`);
            }
        }
        assert.deepEqual(errors, []);
        await close();
    });
}
