// The element under the pointer: its name, its highlight in the picture, and the click that keeps the highlight.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, spoken } from "./support/browser.mjs";
import { assertSame, columnsOf, faceIn, frames, label, labeled, litAt, loadTesseract, loopOf, middle, openTurned } from "./support/pointing.mjs";
import { rounded, shot } from "./support/pointing.mjs";
import { project, rgb, worldPoints } from "./support/scene.mjs";

/** For each slice, the middles of the edges around a cell's face, on the screen. */
function edgesAround({ scene, slices }, size, cell) {
    return slices.flatMap((slice) => {
        const f = [...slice.of.faces].indexOf(cell);
        if (f < 0) return [];
        const points = worldPoints(scene, slice);
        const loop = loopOf(slice, f);
        const ends = loop.map((v, i) => [points[v], points[loop[(i + 1) % loop.length]]]);
        return [{ index: slice.index, at: ends.map((pair) => project(scene, middle(pair), size)) }];
    });
}

/** The range of w of these points, as a text in a label. */
function rangeOf(points) {
    const w = points.map((point) => point[3]);
    return `w ${rounded(Math.min(...w))} … ${rounded(Math.max(...w))}`;
}

const verticesFrom = ({ coordinates }, own) => [...own].map((v) => coordinates.slice(4 * v, 4 * v + 4));

test("pointing: a cell under the mouse is named, and lit in its slices, the projection and the coordinates", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openTurned();
    await moveTo(4, 4);
    const before = await shot(page);
    const seen = await picture();
    const { source: cell, at } = faceIn(seen, size, 1);
    const { revision } = await script.state();
    await moveTo(...at);
    const text = await labeled(page, /volume/);
    const lit = await shot(page);
    assert.equal((await script.state()).revision, revision, "pointing changes nothing");

    // The server highlights the same parts.
    const kept = await script.request({ type: "set", highlight: { element: "cell", number: cell } });
    const { highlight, projection, scene } = await picture();
    assert.equal(highlight.own_vertices.length, 6, "an octahedron");
    const range = rangeOf(verticesFrom(seen, highlight.own_vertices));
    assert.equal(text, `Cell ${cell} · octahedron · volume 3.77 · ${range} · slice w 0.20`);

    const places = edgesAround(seen, size, cell);
    assert.ok(places.length >= 4, "the cell is in several slices");
    for (const { index, at: points } of places) {
        if (Math.abs(index) > 4) continue; // the others are small, and partly hidden
        assert.ok(points.some((point) => litAt(before, lit, point)), `slice ${index}`);
    }
    const [whole] = projection.parts;
    const points = worldPoints({ scale: projection.scale }, { position: projection.position, vertices: whole.vertices });
    const edges = [...whole.of.edges].flatMap((edge, e) =>
        [...highlight.edges].includes(edge) ? [[points[whole.edges[2 * e]], points[whole.edges[2 * e + 1]]]] : [],
    );
    assert.equal(edges.length, 12);
    const litEdges = edges.filter((pair) => litAt(before, lit, project(scene, middle(pair), size)));
    assert.ok(litEdges.length >= 6, `${litEdges.length} edges of the projection are lit`);
    const columns = columnsOf(scene, size);
    for (let v = 0; v < 24; ++v) {
        const expected = [...highlight.own_vertices].includes(v);
        assert.equal(litAt(before, lit, columns(v)), expected, `column ${v}`);
    }

    await presented(page, kept.revision);
    await moveTo(4, 4);
    await labeled(page, /^$/);
    assertSame(lit, await shot(page), at);
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: the light ends when the mouse leaves the element or the drawing, and while it drags", async () => {
    const { page, size, picture, moveTo, close } = await openTurned();
    await moveTo(4, 4);
    const before = await shot(page);
    const { at } = faceIn(await picture(), size, 1);
    const assertEnded = async () => {
        await labeled(page, /^$/);
        assertSame(before, await shot(page), [-1000, 0]);
    };
    await moveTo(...at);
    await labeled(page, /^Cell/);
    await moveTo(4, 4);
    await assertEnded(); // over the background
    await moveTo(...at);
    await labeled(page, /^Cell/);
    await page.hover("#help-button");
    await assertEnded(); // outside the drawing
    await moveTo(...at);
    await labeled(page, /^Cell/);
    await page.mouse.down();
    await labeled(page, /^$/);
    await moveTo(at[0] + 30, at[1]);
    await frames(page);
    assert.equal(await label(page), "");
    await page.mouse.up();
    await close();
});

test("pointing: the tap of a finger shows the name that the mouse shows, until the next touch", async () => {
    for (const mode of ["geometry", "frames"]) {
        const { page, script, size, picture, moveTo, tap, close } = await openTurned({}, { hasTouch: true });
        await page.locator(`[data-page-tool=${mode}]`).dispatchEvent("click");
        await page.waitForSelector(`#drawing[data-drawn-by=${mode}]`);
        const { at } = faceIn(await picture(), size, 2);
        await moveTo(...at);
        const text = await labeled(page, /^Cell.*volume/);
        await moveTo(4, 4);
        await labeled(page, /^$/);
        const { revision } = await script.state();
        await tap(...at);
        assert.equal(await labeled(page, /^Cell.*volume/), text, mode);
        const { slices } = await script.until((one) => one.revision > revision, "the tapped slice is the focus");
        assert.equal(slices.focus, 2);
        await frames(page);
        assert.equal(await label(page), text, "the name stays while the picture changes");
        await tap(4, 4);
        await labeled(page, /^$/);
        await close();
    }
});

test("pointing: the name follows what the picture shows under a mouse at rest", async () => {
    const { page, size, script, picture, moveTo, close } = await openTurned();
    const { at, source } = faceIn(await picture(), size, 0);
    await moveTo(...at);
    await labeled(page, new RegExp(`^Cell ${source} `));
    const { revision } = await script.request({ type: "set", polytope: "5-cell", projection: "off" });
    await presented(page, revision);
    assert.match(await labeled(page, /tetrahedron|^Edge|^$|^Face/), /tetrahedron|length|^$/);
    await close();
});

test("pointing: edges and vertices have their lengths and coordinates", async () => {
    const { page, script, size, picture, moveTo, close } = await openTurned();
    const seen = await picture();
    const { scene, projection, coordinates } = seen;
    const [whole] = projection.parts;
    const points = worldPoints({ scale: projection.scale }, { position: projection.position, vertices: whole.vertices });
    const { eye } = scene.camera;
    const near = points.map((point, v) => [Math.hypot(...point.map((x, k) => x - eye[k])), v]);
    const [, v] = near.reduce((best, one) => (one[0] < best[0] ? one : best));
    const vertex = whole.of.vertices[v] - 96;
    const own = [...coordinates.slice(4 * vertex, 4 * vertex + 4)];
    const numbers = own.map(rounded);
    await moveTo(...project(scene, points[v], size));
    await labeled(page, new RegExp(`^Vertex ${vertex} `));
    assert.equal(await label(page), `Vertex ${vertex} (${numbers.join(", ")})`);

    const e = [...whole.of.edges].findIndex((_, i) => whole.edges[2 * i] === v || whole.edges[2 * i + 1] === v);
    const ends = [points[whole.edges[2 * e]], points[whole.edges[2 * e + 1]]];
    // A bar near the nearest vertex is in front of everything else.
    const [from, to] = whole.edges[2 * e] === v ? ends : [ends[1], ends[0]];
    await moveTo(...project(scene, from.map((x, k) => x + 0.25 * (to[k] - x)), size));
    assert.match(await labeled(page, /^Edge/), /^Edge \d+ · length 2 · w /);

    // Pointing at the parallel coordinates of this vertex highlights the same balls.
    await moveTo(4, 4);
    const before = await shot(page);
    await moveTo(...columnsOf(scene, size)(vertex));
    await labeled(page, new RegExp(`^Vertex ${vertex} `));
    const lit = await shot(page);
    assert.ok(litAt(before, lit, project(scene, points[v], size)), "in the projection");
    const incident = new Set();
    whole.edges.forEach((end, i) => end === v && incident.add(whole.of.edges[Math.floor(i / 2)] - 96));
    assert.equal(incident.size, 8);
    const litSlices = seen.slices.filter((slice) => {
        const places = worldPoints(scene, slice).map((point) => project(scene, point, size));
        return places.some((place, i) => incident.has(slice.of.vertices[i]) && litAt(before, lit, place));
    });
    assert.ok(litSlices.length >= 5, `lit in ${litSlices.length} slices`);
    const { revision } = await script.request({ type: "set", highlight: { element: "vertex", number: vertex } });
    await presented(page, revision);
    await moveTo(4, 4);
    await labeled(page, /^$/);
    assertSame(lit, await shot(page), columnsOf(scene, size)(vertex));
    await close();
});

test("pointing: a vertex is named in the band of its column, as by the server, and not beside it", async () => {
    const { page, script, size, picture, moveTo, errors, close } = await openTurned();
    const { coordinates: layout } = (await picture()).scene;
    const start = layout.left + 7 * layout.column_step - layout.line_step / 2;
    const band = 4 * layout.line_step + layout.line_width;
    const places = [
        [0.1 * band, 0, true],
        [(band + layout.column_step) / 2, 0, false],
        [0.9 * band, 0.8 * layout.amplitude, true],
        [0.5 * band, 1.2 * layout.amplitude, false],
    ];
    for (const [right, down, isInside] of places) {
        const [x, y] = [start + right, 1 - layout.zero + down].map((length) => Math.round(length * size.height));
        const { highlight } = await script.request({ type: "get", what: "at", x, y, ...size });
        assert.deepEqual(highlight ?? null, isInside ? { element: "vertex", number: 7 } : null);
        await moveTo(x, y);
        await labeled(page, isInside ? /^Vertex 7 / : /^$/);
    }
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: a cell is named with its kind, if there are several, and with its volume", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openTurned({ polytope: "truncated tesseract" });
    const { kinds } = (await script.state()).polytope;
    assert.deepEqual(kinds.map(({ name }) => name), ["truncated cube", "tetrahedron"]);
    const seen = await picture();
    const { source, at } = faceIn(seen, size, 1);
    const { kind } = await script.request({ type: "measure", element: "cell", number: source });
    await moveTo(...at);
    const named = `^Cell ${source} · ${kinds[kind].name}, kind ${kind + 1} of 2 · volume ${["109", "0\\.943"][kind]} · w `;
    await labeled(page, new RegExp(named));

    // A moving observer sees another size.
    const { revision } = await script.request({ type: "set", pace: 2 });
    await presented(page, revision);
    const moving = faceIn(await picture(), size, 1);
    await moveTo(4, 4);
    await moveTo(...moving.at);
    await labeled(page, new RegExp(`^Cell ${moving.source} · (truncated cube, kind 1|tetrahedron, kind 2) of 2 · w `));
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: a face is named for its polygon, in both modes", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openTurned({ polytope: "5,7-duoprism" });
    const shown = { faces: false, balls: false, coordinates: false };
    const { revision } = await script.request({ type: "set", shown, view: "single", projection: "off" });
    await presented(page, revision);
    const { scene, slices } = await picture();
    const slice = slices.find(({ focus }) => focus);
    const points = worldPoints(scene, slice);
    const names = new Set();
    const bars = [...slice.of.edges].map((_, e) => {
        const ends = [...slice.edges.slice(2 * e, 2 * e + 2)].map((v) => project(scene, points[v], size));
        // Points on the bar. They show whether other bars are far away.
        return Array.from({ length: 101 }, (_, i) => ends[0].map((from, k) => from + (i / 100) * (ends[1][k] - from)));
    });
    const isNear = ([x, y]) => ([left, top]) => Math.hypot(x - left, y - top) < 12;
    for (let e = 0; e < bars.length; ++e) {
        const [x, y] = bars[e][50].map(Math.round);
        if (bars.some((bar, other) => other !== e && bar.some(isNear([x, y])))) continue;
        const { highlight, name } = await script.request({ type: "get", what: "at", x, y, ...size });
        if (names.has(name)) continue;
        assert.deepEqual(highlight, { element: "face", number: slice.of.edges[e] });
        await moveTo(x, y);
        await labeled(page, new RegExp(`^Face ${highlight.number} · ${name} · area `));
        await page.locator("[data-page-tool=frames]").dispatchEvent("click");
        await page.waitForSelector("#drawing[data-drawn-by=frames]");
        await labeled(page, new RegExp(`^Face ${highlight.number} · ${name} · area `));
        await page.locator("[data-page-tool=geometry]").dispatchEvent("click");
        await page.waitForSelector("#drawing[data-drawn-by=geometry]");
        names.add(name);
    }
    assert.ok(names.has("square"), `squares are cut: ${[...names]}`);
    for (const name of names) assert.match(name, /^(square|pentagon|heptagon)$/);
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: the volume follows another object of the same name and with as many elements", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openTurned();
    await loadTesseract(page, script, 2);
    const { at, source } = faceIn(await picture(), size, 1);
    await moveTo(...at);
    await labeled(page, new RegExp(`^Cell ${source} · .* · volume 8 · `));
    await loadTesseract(page, script, 4);
    await labeled(page, new RegExp(`^Cell ${source} · .* · volume 64 · `));
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: a click keeps the element and moves the focus in one step; the background and Escape end it", async () => {
    const { page, script, press, errors, size, picture, click, close } = await openTurned();
    await spoken(page, "24-cell"); // from now on, the page announces changes
    const { at, source } = faceIn(await picture(), size, 2);
    await click(...at);
    const kept = await script.until(({ highlight }) => highlight !== null, "the highlight");
    assert.deepEqual(kept.highlight, { element: "cell", number: source });
    assert.equal(kept.slices.focus, 2);
    await presented(page, kept.revision);
    const undone = await press("u");
    assert.deepEqual([undone.highlight, undone.slices.focus], [null, 0]);
    assert.deepEqual((await press("Control+r")).highlight, kept.highlight);
    await spoken(page, `cell ${source} highlighted`);

    await click(8, size.height / 2 + 60);
    const ended = await script.until(({ highlight }) => highlight === null, "no highlight");
    assert.equal(ended.slices.focus, 2, "the focus stays");
    assert.deepEqual((await press("u")).highlight, kept.highlight);
    await page.focus("#drawing");
    assert.equal((await press("Escape")).highlight, null);

    // Clicks a column of the parallel coordinates.
    await click(...columnsOf((await picture()).scene, size)(7));
    const { highlight } = await script.until((state) => state.highlight !== null, "a vertex");
    assert.deepEqual(highlight, { element: "vertex", number: 7 });
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: the server's pictures are clicked in the same way", async () => {
    const { page, script, errors, size, picture, click, close } = await openTurned();
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    const seen = await picture();
    const { at, source } = faceIn(seen, size, -1);
    await click(...at);
    const { highlight, slices } = await script.until((state) => state.highlight !== null, "the highlight");
    assert.deepEqual(highlight, { element: "cell", number: source });
    assert.equal(slices.focus, -1);
    assert.deepEqual(rgb(seen.scene.colors.highlight), [255, 79, 184], "the color that the other tests look for");
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: the label stays within a narrow drawing, and stars and point clouds are named", async () => {
    const { page, script, errors, close } = await openWithScript({ viewport: { width: 320, height: 568 } });
    const box = await page.locator("#drawing").boundingBox();
    const name = async (settings, { anywhere }) => {
        const { revision } = await script.request({ type: "set", view: "single", ...settings });
        await presented(page, revision);
        for (let i = 0; i < 12; ++i) {
            await page.mouse.move(box.x + box.width * (0.3 + 0.05 * i), box.y + box.height * 0.4);
            await frames(page);
            const text = await label(page);
            const { x, width } = text === "" ? { x: 0, width: 0 } : await page.locator("#pointed").boundingBox();
            assert.ok(x >= 0 && x + width <= 320, `${x} + ${width}`);
            if (anywhere.test(text)) return text;
        }
        return assert.fail(`${anywhere} is nowhere`);
    };
    await name({ polytope: "24-cell" }, { anywhere: /^Cell \d+ · octahedron · .*w/ });
    await name({ polytope: "small stellated 120-cell" }, { anywhere: /^Cell \d+ · / });
    const cloud = "CLOUD\n0 0 0 0\n1 0 0 0.001\n-1 0 0 0\n0 1 0 0\n0 -1 0 0\n";
    await script.request({ type: "load", name: "five points", format: "cloud", data: cloud });
    const { revision } = await script.request({ type: "set", polytope: "five points", view: "single" });
    await presented(page, revision);
    const size = { width: Math.round(box.width), height: Math.round(box.height) };
    const { scene, slices } = await script.request({ type: "get", what: "slices", ...size });
    const focus = slices.find((slice) => slice.focus);
    const [x, y] = project(scene, worldPoints(scene, focus)[0], size);
    await page.mouse.move(box.x + x, box.y + y);
    await labeled(page, new RegExp(`^Vertex ${focus.of.vertices[0]}`));
    assert.deepEqual(errors, []);
    await close();
});

/** A 4OFF file of the product of an L-shaped hexagon in xy and a square in zw. */
function productOfLAndSquare() {
    const l = [[-1, -1], [1, -1], [1, 0], [0, 0], [0, 1], [-1, 1]];
    const square = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
    const vertices = square.flatMap((zw) => l.map((xy) => [...xy, ...zw]));
    const around = l.map((_, i) => i);
    const next = (i) => (i + 1) % 6;
    const over = (j) => (j + 1) % 4;
    const faces = [
        ...square.map((_, j) => around.map((i) => 6 * j + i)), // 0 to 3: an L at each vertex of the square
        ...around.map((i) => square.map((_, j) => 6 * j + i)), // 4 to 9: a square at each vertex of the L
        ...square.flatMap((_, j) => around.map((i) => [6 * j + i, 6 * j + next(i), 6 * over(j) + next(i), 6 * over(j) + i])),
    ];
    const cells = [
        ...square.map((_, j) => [j, over(j), ...around.map((i) => 10 + 6 * j + i)]),
        ...around.map((i) => [4 + i, 4 + next(i), ...square.map((_, j) => 10 + 6 * j + i)]),
    ];
    const lines = [...faces, ...cells].map((list) => [list.length, ...list]);
    return ["4OFF", "24 34 48 10", ...[...vertices, ...lines].map((line) => line.join(" ")), ""].join("\n");
}

test("pointing: faces in the hyperplane of a slice that is not convex are named as the server names them", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openTurned();
    await script.request({ type: "load", name: "L", format: "off", data: productOfLAndSquare(), center: "origin" });
    await script.request({ type: "reset" });
    const shown = { balls: false, bars: false, coordinates: false };
    await script.request({ type: "set", view: "single", projection: "off", shown });
    const { revision } = await script.request({ type: "command", line: "set w=1" });
    await presented(page, revision);
    const { scene, slices } = await picture();
    const slice = slices.find(({ focus }) => focus);
    assert.ok(slice.fill, "the slice need not be convex");
    const [x, y] = project(scene, slice.position, size);
    let faces = 0;
    for (let i = -4; i < 4; ++i) {
        const at = [Math.round(x + 0.05 * (i + 0.4) * size.height), Math.round(y - 0.03 * (i + 0.7) * size.height)];
        const { highlight } = await script.request({ type: "get", what: "at", x: at[0], y: at[1], ...size });
        await moveTo(...at);
        await labeled(page, highlight ? new RegExp(`^${highlight.element} ${highlight.number}\\b`, "i") : /^$/);
        if (highlight?.element === "face") ++faces;
    }
    assert.ok(faces > 0, "a face is named");
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: a face of a surface is named in the projection as the server names it", async () => {
    const { page, script, errors, size, picture, moveTo, close } = await openTurned();
    const data = "4OFF\n4 1 4 0\n1 1 0 0\n-1 1 0 0\n-1 -1 0 0\n1 -1 0 0\n4 0 1 2 3\n";
    await script.request({ type: "load", name: "square", format: "off", data, center: "origin" });
    await script.request({ type: "reset" });
    const shown = { balls: false, bars: false, coordinates: false, cells: true };
    const { revision } = await script.request({ type: "set", projection: "orthogonal", shown });
    await presented(page, revision);
    const { scene, projection } = await picture();
    assert.equal(scene.colors.cells.length, 1, "a surface has no cells, but its faces have a color");
    const at = project(scene, projection.position, size).map(Math.round);
    const { highlight } = await script.request({ type: "get", what: "at", x: at[0], y: at[1], ...size });
    assert.deepEqual([highlight.element, highlight.number], ["face", 0]);
    await moveTo(...at);
    await labeled(page, /^face 0\b/i);
    assert.deepEqual(errors, []);
    await close();
});

test("pointing: elements are found far from the middle of the projection and of a slice", async () => {
    const settings = { polytope: "600-cell", view: "single", eye: 1.05 };
    const { page, script, errors, size, picture, moveTo, close } = await openTurned(settings);
    const turned = await script.request({ type: "toward", element: "vertex", immediately: true });
    await presented(page, turned.revision);
    const { scene, projection } = await picture();
    const { position, scale, parts } = projection;
    const middleAt = project(scene, position, size);
    const fromMiddle = ([x, y]) => Math.hypot(x - middleAt[0], y - middleAt[1]);
    const places = worldPoints({ scale }, { position, vertices: parts[0].vertices }).map((at) => project(scene, at, size));
    await moveTo(...places.reduce((best, at) => (fromMiddle(at) > fromMiddle(best) ? at : best)));
    await labeled(page, /^Vertex \d+ /);

    const data = "CLOUD\n0 0 0 0 5\n1 0 0 0 0.001\n"; // the first point's ball is larger than the cloud
    await script.request({ type: "load", name: "large point", format: "cloud", data });
    const shown = await script.request({ type: "set", polytope: "large point", view: "oval", projection: "off" });
    await presented(page, shown.revision);
    const { scene: oval, slices } = await picture();
    const [x, y, z] = slices.find(({ focus }) => focus).position;
    await moveTo(...project(oval, [x - 4 * oval.scale, y, z], size));
    await labeled(page, /^Vertex 0 /);
    assert.deepEqual(errors, []);
    await close();
});
