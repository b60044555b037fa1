// The projection of the whole object in the middle of the oval.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript } from "./support/browser.mjs";
import { decode, distance, pixelAt } from "./support/pixels.mjs";
import { labeled, openTurned } from "./support/pointing.mjs";
import { project, worldPoints } from "./support/scene.mjs";

async function picture(page) {
    await page.evaluate(() => document.activeElement.blur()); // removes the line around the focused drawing
    const shown = decode(await page.locator("#drawing").screenshot());
    await page.focus("#drawing");
    return shown;
}

/** The bounding box of points on the screen: left, top, right and bottom. */
function boundsOf(points) {
    const [x, y] = [0, 1].map((axis) => points.map((point) => point[axis]));
    return [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
}

/** The points within `box` at which two pictures differ. */
function changedPoints(before, after, [left, top, right, bottom]) {
    const points = [];
    for (let y = Math.ceil(top); y <= bottom; ++y) {
        for (let x = Math.ceil(left); x <= right; ++x) {
            if (distance(pixelAt(before, x, y), pixelAt(after, x, y)) > 24) points.push([x, y]);
        }
    }
    return points;
}

function assertBounds(actual, expected, tolerance) {
    const isNear = actual.every((value, i) => Math.abs(value - expected[i]) <= tolerance);
    assert.ok(isNear, `${actual} is not within ${tolerance} pixels of ${expected.map((value) => value.toFixed(1))}`);
}

test("projection: w shows the whole object in the middle of the oval, in the same place in both streams", async () => {
    const { page, script, press, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "24-cell" });
    await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.4, 1.1] });
    await press("k"); // the picture after it also shows the earlier changes
    const without = { geometry: await picture(page) };
    const kinds = ["perspective", "orthogonal"];
    const shown = {};
    for (const kind of kinds) {
        assert.equal((await press("w")).projection, kind);
        shown[kind] = { geometry: await picture(page) };
    }
    await press("w");
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    without.frames = await picture(page);
    for (const kind of kinds) {
        assert.equal((await press("w")).projection, kind);
        shown[kind].frames = await picture(page);

        const { width, height } = without.geometry;
        const { scene, projection } = await script.request({ type: "get", what: "slices", width, height });
        const { position, scale, parts } = projection;
        const vertices = worldPoints({ scale }, { position, vertices: parts[0].vertices });
        const expected = boundsOf(vertices.map((vertex) => project(scene, vertex, { width, height })));
        const box = expected.map((value, i) => value + (i < 2 ? -24 : 24));
        for (const mode of ["geometry", "frames"]) {
            const bounds = boundsOf(changedPoints(without[mode], shown[kind][mode], box));
            assertBounds(bounds, expected, 8); // balls extend beyond the vertices
            shown[kind][mode].bounds = bounds;
        }
        assertBounds(shown[kind].geometry.bounds, shown[kind].frames.bounds, 2);
    }
    assert.deepEqual(errors, []);
    await close();
});

test("projection: it covers no slice in either stream when the view is moved, and pointing finds the slice", async () => {
    // From this camera, the projection is nearer than the focus slice and nearly in front of it.
    const camera = { azimuth: 1.4, elevation: 0.1, zoom: 1 };
    const opened = await openTurned({ view: "single", camera });
    const { page, press, size, moveTo, errors, close } = opened;
    const { scene, slices, projection } = await opened.picture();
    const places = (elements, at) => worldPoints(at, elements).map((point) => project(scene, point, size));
    const { position, scale, parts } = projection;
    const [left, top, right, bottom] = boundsOf(places({ position, vertices: parts[0].vertices }, { scale }));
    const focus = slices.find((slice) => slice.focus);
    const balls = places(focus, scene).filter(([x, y]) => {
        const across = (2 * x - left - right) / (right - left);
        const down = (2 * y - top - bottom) / (bottom - top);
        return Math.hypot(across, down) < 0.7;
    });
    assert.ok(balls.length >= 3, `${balls.length} balls of the slice are in front of the projection`);
    for (const mode of ["geometry", "frames"]) {
        if (mode === "frames") {
            await page.click("[data-page-tool=frames]");
            await page.waitForSelector("#drawing[data-drawn-by=frames]");
        }
        const before = await picture(page);
        await press("c"); // fills the projection
        const after = await picture(page);
        assert.ok(changedPoints(before, after, [left, top, right, bottom]).length > 1000, mode);
        for (const [x, y] of balls) {
            assert.ok(distance(pixelAt(before, x, y), pixelAt(after, x, y)) < 12, `${mode}: a ball at ${x}, ${y}`);
        }
        await moveTo(...balls[0]);
        assert.match(await labeled(page, /\w/), /slice w/, mode);
        await moveTo(4, 4);
        await labeled(page, /^$/);
        await press("c");
    }
    assert.deepEqual(errors, []);
    await close();
});
