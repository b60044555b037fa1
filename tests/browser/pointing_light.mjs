// All parts of the picture that show the element under the pointer are highlighted, as if the element were kept.
import assert from "node:assert/strict";

import { presented } from "./support/browser.mjs";
import { holdSent } from "./support/held.mjs";
import { assertSame, columnsOf, faceIn, labeled, litAt, loopOf, middle, named, openTurned, rounded, shot } from "./support/pointing.mjs";
import { project, worldPoints } from "./support/scene.mjs";
import { test } from "./support/suite.mjs";

/**
 * Finds the first place around which the server's picture shows one element of this kind. Resolves to the place and to
 * the server's description of it.
 */
async function firstWith({ script, size }, element, places) {
    for (const place of places) {
        const [x, y] = place.map(Math.round);
        const ask = (dx, dy) => script.request({ type: "get", what: "at", x: x + dx, y: y + dy, ...size });
        const shown = await ask(0, 0);
        if (shown.highlight?.element !== element) continue;
        const around = await Promise.all([ask(2, 0), ask(-2, 0), ask(0, 2), ask(0, -2)]);
        const { number } = shown.highlight;
        if (around.every(({ highlight: one }) => one?.element === element && one.number === number)) {
            return { at: [x, y], shown };
        }
    }
    return assert.fail(`no ${element} is at these places`);
}

/**
 * Points at a place, and asserts that the page highlights the same as when the element is kept. Resolves to the picture
 * before, the picture with the highlight, the label, and the message of the picture with the kept element.
 */
async function pointLikeKept({ page, script, picture, moveTo }, at, pattern) {
    await moveTo(4, 4);
    await labeled(page, /^$/);
    const before = await shot(page);
    await moveTo(...at);
    const text = await labeled(page, pattern);
    const lit = await shot(page);
    await moveTo(4, 4);
    await labeled(page, /^$/);
    assertSame(before, await shot(page), [-1000, 0]);
    const [, element, number] = /^(\w+) (\d+)/.exec(text);
    const set = async (highlight) => presented(page, (await script.request({ type: "set", highlight })).revision);
    await set({ element: element.toLowerCase(), number: Number(number) });
    assertSame(lit, await shot(page), at);
    const kept = await picture();
    await set(null);
    return { before, lit, text, kept };
}

/** Asserts that the parallel coordinates of all vertices of the kept element are highlighted. */
function assertColumnsLit({ before, lit, kept }, size, count) {
    const own = [...kept.highlight.own_vertices];
    assert.equal(own.length, count);
    for (const v of own) assert.ok(litAt(before, lit, columnsOf(kept.scene, size)(v)), `column ${v}`);
}

test("pointing light: cells and vertices of a star are lit like kept ones, in slices, projection and coordinates", async () => {
    const opened = await openTurned({ polytope: "small stellated 120-cell" });
    const { size, picture, errors, close } = opened;
    const { scene, slices } = await picture();
    const focus = slices.find((slice) => slice.focus);
    const points = worldPoints(scene, focus).map((point) => project(scene, point, size));
    const middles = [...focus.of.faces].map((_, f) => middle(loopOf(focus, f).map((v) => points[v])));
    const { at } = await firstWith(opened, "cell", middles);
    const cell = await pointLikeKept(opened, at, /^Cell .* · w .* … .* · slice w 0$/);
    assertColumnsLit(cell, size, 12); // the vertices of a small stellated dodecahedron
    assertColumnsLit(await pointLikeKept(opened, columnsOf(scene, size)(7), /^Vertex 7 /), size, 1);
    assert.deepEqual(errors, []);
    await close();
});

/** A 4OFF file of a Clifford torus with `columns` × `rows` faces. */
function cliffordTorus(columns, rows) {
    const angles = (count) => Array.from({ length: count }, (_, i) => (2 * Math.PI * i) / count);
    const vertices = angles(columns).flatMap((a) =>
        angles(rows).map((b) => [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)]),
    );
    const faces = vertices.map((_, v) => {
        const [i, j] = [Math.floor(v / rows), v % rows];
        const [k, n] = [(i + 1) % columns, (j + 1) % rows];
        return [4, i * rows + j, k * rows + j, k * rows + n, i * rows + n];
    });
    const counts = `${vertices.length} ${faces.length} ${2 * faces.length} 0`;
    return ["4OFF", counts, ...[...vertices, ...faces].map((line) => line.join(" ")), ""].join("\n");
}

test("pointing light: 2-faces and vertices of a surface are lit like kept ones", async () => {
    const opened = await openTurned();
    const { page, script, size, picture, errors, close } = opened;
    const data = cliffordTorus(8, 6);
    await presented(page, (await script.request({ type: "load", name: "torus", format: "off", data })).revision);
    const { scene, slices } = await picture();
    const focus = slices.find((slice) => slice.focus);
    const points = worldPoints(scene, focus).map((point) => project(scene, point, size));
    const middles = [...focus.of.edges].map((_, e) => middle([points[focus.edges[2 * e]], points[focus.edges[2 * e + 1]]]));
    const { at } = await firstWith(opened, "face", middles);
    assertColumnsLit(await pointLikeKept(opened, at, /^Face \d+ · rectangle · area .* · w .* … .* · slice w 0$/), size, 4);
    assertColumnsLit(await pointLikeKept(opened, columnsOf(scene, size)(7), /^Vertex 7 /), size, 1);
    assert.deepEqual(errors, []);
    await close();
});

test("pointing light: without parallel coordinates, elements are lit like kept ones, and have their range of w", async () => {
    const opened = await openTurned({ shown: { coordinates: false } });
    const { page, script, size, picture, moveTo, errors, close } = opened;
    const { scene, projection, coordinates, ...seen } = await picture();
    assert.equal(coordinates.length, 0);
    const { at } = faceIn({ scene, ...seen }, size, 1);
    const textAt = async (place) => {
        const { shown } = await firstWith(opened, "cell", [place]);
        const range = `w ${rounded(shown.least_w)} … ${rounded(shown.most_w)}`;
        return `Cell ${shown.highlight.number} · octahedron · volume 3.77 · ${range} · slice w 0.20`;
    };
    const { text, kept } = await pointLikeKept(opened, at, /volume/);
    assert.equal(text, await textAt(at));
    assert.equal(kept.highlight.own_vertices.length, 6);

    const [whole] = projection.parts;
    const points = worldPoints({ scale: projection.scale }, { position: projection.position, vertices: whole.vertices });
    const places = points.map((point) => project(scene, point, size));
    const vertex = await firstWith(opened, "vertex", places);
    const name = `Vertex ${vertex.shown.highlight.number} · w ${rounded(vertex.shown.least_w)}`;
    assert.equal((await pointLikeKept(opened, vertex.at, /^Vertex/)).text, name);

    // The range of w follows a rotation.
    await moveTo(...at);
    await labeled(page, /^Cell/);
    const { revision } = await script.request({ type: "rotate", planes: ["xw"], angles: [0.02] });
    await presented(page, revision);
    const turned = await textAt(at);
    assert.notEqual(turned, text);
    assert.equal(await labeled(page, /^Cell/), turned);
    assert.deepEqual(errors, []);
    await close();
});

test("pointing light: what is cut from the element itself is lit before the server has answered", async () => {
    const { page, size, picture, moveTo, errors, close } = await openTurned({}, { before: holdSent });
    await moveTo(4, 4);
    const before = await shot(page);
    const seen = await picture();
    await page.evaluate(() => void (window.isHeld = ({ type }) => type === "measure"));
    const { source: cell, at } = faceIn(seen, size, 1);
    await moveTo(...at);
    assert.equal(await named(page, /^Cell/), `Cell ${cell} · octahedron · slice w 0.20`);
    const withCell = await shot(page);
    assert.throws(() => assertSame(before, withCell, [-1000, 0]), "its faces are lit");

    const column = columnsOf(seen.scene, size)(7);
    await moveTo(...column);
    await named(page, /^Vertex 7 /);
    const withVertex = await shot(page);
    assert.ok(litAt(before, withVertex, column), "its column");
    await page.evaluate(() => window.release());
    await labeled(page, /^Vertex 7 /);
    const complete = await shot(page);
    assert.throws(() => assertSame(withVertex, complete, column), "its edges are lit in the slices, too");
    assert.deepEqual(errors, []);
    await close();
});
