// What is under the pointer: where elements are in the picture, their label, and their highlight.
import assert from "node:assert/strict";

import { idle, openWithScript, presented } from "./browser.mjs";
import { decode, distance, pixelAt } from "./pixels.mjs";
import { project, worldPoints } from "./scene.mjs";

/** Opens the page with a turned 24-cell and its projection. None of its elements lies in a hyperplane of a slice. */
export async function openTurned(settings = {}, options = {}) {
    const opened = await openWithScript(options);
    const { page, script } = opened;
    await script.request({ type: "set", polytope: "24-cell", projection: "perspective", ...settings });
    const planes = ["xw", "yz"];
    const { revision } = await script.request({ type: "rotate", planes, angles: [0.41, 1.13] });
    await presented(page, revision);
    return { ...opened, ...(await drawingOf(opened)) };
}

/**
 * The size of the page's drawing in pixels, the server's `slices` message for this size, and functions for the pointer.
 */
export async function drawingOf({ page, script }) {
    const box = await page.locator("#drawing").boundingBox();
    const size = { width: Math.round(box.width), height: Math.round(box.height) };
    return {
        size,
        picture: () => script.request({ type: "get", what: "slices", ...size }),
        /** Moves the mouse to a point of the drawing; click() and tap() press there. */
        moveTo: (x, y) => page.mouse.move(box.x + x, box.y + y),
        click: (x, y) => page.mouse.click(box.x + x, box.y + y),
        tap: (x, y) => page.touchscreen.tap(box.x + x, box.y + y),
    };
}

/** Loads a tesseract with edges of this length, always under the same name, and waits for its picture. */
export async function loadTesseract(page, script, edge) {
    const ends = [-edge / 2, edge / 2];
    const points = ends.flatMap((x) => ends.flatMap((y) => ends.flatMap((z) => ends.map((w) => [x, y, z, w].join(" ")))));
    const load = { type: "load", name: "mine", format: "points", data: points.join("\n") };
    await presented(page, (await script.request(load)).revision);
}

export const label = (page) =>
    page.evaluate(() => {
        const { hidden, textContent } = document.getElementById("pointed");
        return hidden ? "" : textContent;
    });

/** Waits until the label matches the pattern. The page may still be asking about the element. */
export async function named(page, pattern) {
    await page.waitForFunction(
        ([source, flags]) => {
            const { hidden, textContent } = document.getElementById("pointed");
            return new RegExp(source, flags).test(hidden ? "" : textContent);
        },
        [pattern.source, pattern.flags],
    );
    return label(page);
}

/**
 * Waits until the label matches the pattern. If the label is not empty, also waits until the server has answered, so
 * that the label and the highlight are complete.
 */
export async function labeled(page, pattern) {
    if ((await named(page, pattern)) !== "") await idle(page);
    return label(page);
}

/** Waits for two animation frames. By then, everything is drawn. */
export const frames = (page) =>
    page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** The picture without the label. */
export async function shot(page) {
    await frames(page);
    const setVisibility = (visibility) =>
        page.evaluate((value) => void (document.getElementById("pointed").style.visibility = value), visibility);
    await setVisibility("hidden");
    const picture = decode(await page.locator("#drawing").screenshot());
    await setVisibility("");
    return picture;
}

/** Whether a pixel has the hue of the highlight, 0xff4fb8, in some light or faintly. */
const isLit = ([r, g, b]) => r > 90 && r - g > 45 && b - g > 25 && r > b;

/** Whether the pixels around a point have become highlighted. */
export function litAt(before, after, [x, y]) {
    for (let dx = -3; dx <= 3; ++dx) {
        for (let dy = -3; dy <= 3; ++dy) {
            const [was, is] = [before, after].map((one) => pixelAt(one, x + dx, y + dy));
            if (isLit(is) && distance(was, is) > 24) return true;
        }
    }
    return false;
}

export const middle = (points) => points[0].map((_, k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);

export const loopOf = ({ faces }, f) => [...faces.corners.slice(faces.begin[f], faces.begin[f + 1])];

/**
 * In the slice with this index, the center of the front face with the most room, and the cell from which it was cut.
 */
export function faceIn({ scene, slices }, size, index) {
    const slice = slices.find((one) => one.index === index);
    const points = worldPoints(scene, slice);
    const areas = [...slice.of.faces].map((source, f) => {
        const loop = loopOf(slice, f).map((v) => project(scene, points[v], size));
        const twice = loop.reduce((sum, [x, y], i) => {
            const [a, b] = loop[(i + 1) % loop.length];
            return sum + y * a - x * b;
        }, 0); // positive if counterclockwise on the screen, where y points down
        return { source, area: twice, at: middle(loop) };
    });
    return areas.reduce((best, one) => (one.area > best.area ? one : best));
}

export const rounded = (value) => String(Math.round(value * 1000) / 1000).replace("-", "−");

/** Asserts that two pictures are equal, except around the label at this point. */
export function assertSame(one, other, [left, top]) {
    let differing = 0;
    for (let y = 0; y < one.height; ++y) {
        for (let x = 0; x < one.width; ++x) {
            const isLabel = Math.abs(x - left) < 400 && Math.abs(y - top) < 60;
            if (!isLabel && distance(pixelAt(one, x, y), pixelAt(other, x, y)) > 24) ++differing;
        }
    }
    assert.ok(differing < 20, `${differing} pixels differ`);
}

/**
 * Returns a function. It maps a vertex to a pixel between the lines of the vertex's column in the parallel coordinates.
 */
export function columnsOf({ coordinates: layout }, { height }) {
    const x = (v) => layout.left + (v % layout.per_row) * layout.column_step + 1.5 * layout.line_step + layout.line_width;
    const zero = (v) => layout.zero - Math.floor(v / layout.per_row) * layout.row_step;
    return (v) => [x(v) * height, (1 - zero(v) + 0.9 * layout.amplitude) * height];
}
