// The density strip, which replaces the parallel coordinates of many vertices: what the page names and highlights in
// it.
import assert from "node:assert/strict";

import { presented } from "./support/browser.mjs";
import { frames, label, labeled, litAt, openTurned, shot } from "./support/pointing.mjs";
import { stripPoint } from "./support/scene.mjs";
import { test } from "./support/suite.mjs";

test("density strip: the vertex with the nearest line is named, as by the server, and its line is lit", async () => {
    const { page, script, size, picture, moveTo, errors, close } = await openTurned({ polytope: "120-cell" });
    const seen = await picture();
    const { left, zero, amplitude, line_step: step } = seen.scene.coordinates;
    const { height } = size;
    const leave = async () => {
        await moveTo(4, 4);
        await labeled(page, /^$/);
    };
    const askServer = async (x, y) => (await script.request({ type: "get", what: "at", x, y, ...size })).highlight ?? null;
    await leave();
    const before = await shot(page);

    // Beyond the ends of all lines, and above or below them, the outermost line is the nearest.
    for (const axis of [0, 3]) {
        for (const side of [-1, 1]) {
            const values = seen.coordinates.filter((_, i) => i % 4 === axis).map((value) => side * value);
            const outermost = values.reduce((most, value) => Math.max(most, value));
            const number = values.findIndex((value) => value > outermost - 1e-5 * seen.scene.circumradius);
            const [endX, endY] = stripPoint(seen, number, axis, height);
            const [x, y] = [endX + (axis === 0 ? -1.5 : 1.5), endY - 1.5 * side].map(Math.round);
            assert.deepEqual(await askServer(x, y), { element: "vertex", number });
            await moveTo(x, y);
            await labeled(page, new RegExp(`^Vertex ${number} `));
            await leave();
        }
    }

    // Elsewhere, several lines pass through each pixel.
    for (const [vertex, along] of [[0, 0.2], [137, 1.5], [421, 2.7]]) {
        const [x, y] = stripPoint(seen, vertex, along, height).map(Math.round);
        const served = await askServer(x, y);
        assert.equal(served?.element, "vertex");
        await moveTo(x, y);
        const named = Number(/^Vertex (\d+) /.exec(await labeled(page, /^Vertex/))[1]);
        for (const number of [served.number, named]) {
            const away = Math.abs(stripPoint(seen, number, along, height)[1] - y);
            assert.ok(away < 1.5, `the line of vertex ${number} is ${away} pixels from a point of that of vertex ${vertex}`);
        }
        const lit = await shot(page);
        const places = [0.5, 1.5, 2.5].map((at) => stripPoint(seen, named, at, height));
        assert.ok(places.every((place) => litAt(before, lit, place)), `the line of vertex ${named} is lit`);
        await leave();
    }

    for (const [right, down] of [[left + 1.5 * step, 1.2 * amplitude], [left - 0.02, 0]]) {
        const [x, y] = [right, 1 - zero + down].map((length) => Math.round(length * height));
        assert.equal(await askServer(x, y), null);
        await moveTo(x, y);
        await frames(page);
        assert.equal(await label(page), "");
    }

    // A line that is drawn over the strip is found, even if other lines are nearer.
    const { revision } = await script.request({ type: "set", highlight: { element: "vertex", number: 137 } });
    await presented(page, revision);
    for (const along of [0.4, 1.2, 2.6]) {
        const [x, y] = stripPoint(seen, 137, along, height).map(Math.round);
        assert.deepEqual(await askServer(x, y), { element: "vertex", number: 137 });
        await leave();
        await moveTo(x, y);
        await labeled(page, /^Vertex 137 /);
    }
    assert.deepEqual(errors, []);
    await close();
});
