// The label of a field's surfaces, caps and contours: it shows the level, the place in the box and the values.
import assert from "node:assert/strict";

import { openWithScript, presented, stateAfter } from "./support/browser.mjs";
import { panelOf } from "./support/matrix.mjs";
import { netcdfWithUnits } from "./support/netcdf.mjs";
import { drawingOf, labeled } from "./support/pointing.mjs";
import { project } from "./support/scene.mjs";
import { test } from "./support/suite.mjs";

const kModes = ["geometry", "frames"];
const kBox = [[-1, 1], [-1, 1], [-1, 1], [-1, 1]];
const kBall = { format: "formula", data: "x^2 + y^2 + z^2 + w^2", box: kBox };
const kBare = { balls: false, bars: false, coordinates: false };

/** Opens the page with a field, drawn by the page ("geometry") or by the server ("frames"). */
async function openField(mode, load, settings, options) {
    const opened = await openWithScript(options);
    const { page, script } = opened;
    await script.request({ type: "load", name: "field", ...load });
    const { revision } = await script.request({ type: "set", shown: kBare, ...settings });
    await presented(page, revision);
    await page.locator(`[data-page-tool=${mode}]`).dispatchEvent("click");
    await page.waitForSelector(`#drawing[data-drawn-by=${mode}]`);
    return { ...opened, ...(await drawingOf(opened)) };
}

/** The pixel of a point of a slice. The point lies from the slice's center toward the eye, at this distance. */
function facing({ scene }, slice, radius, size) {
    const toEye = scene.camera.eye.map((value, k) => value - slice.position[k]);
    const length = Math.hypot(...toEye);
    return project(scene, slice.position.map((value, k) => value + (scene.scale * radius * toEye[k]) / length), size);
}

const kNumber = "−?[\\d.]+";
const numbersIn = (text) => text.replaceAll("−", "-").match(/-?\d+(\.\d+)?/g).map(Number);

for (const mode of kModes) {
    test(`pointing at fields: a surface tells its level, the place and the second value: ${mode}`, async () => {
        const values = { values: "10 + x - 2*z" };
        const opened = await openField(mode, { ...kBall, ...values }, { view: "single", levels: [0.25, 0.64] });
        const { page, script, errors, size, picture, moveTo, close } = opened;
        const turned = await script.request({ type: "rotate", planes: ["xz"], angles: [0.5] });
        await presented(page, turned.revision);
        const seen = await picture();
        const slice = seen.slices.find(({ focus }) => focus);
        const { revision } = await script.state();
        await moveTo(...facing(seen, slice, 0.8, size));
        const place = `\\((${kNumber}), (${kNumber}), (${kNumber}), (${kNumber})\\)`;
        const text = await labeled(page, new RegExp(`^Level 0\\.64 ${place} · second value ${kNumber} · slice w 0$`));
        const [level, x, y, z, w, second] = numbersIn(text);
        assert.equal(level, 0.64);
        assert.ok(Math.abs(x * x + y * y + z * z + w * w - 0.64) < 0.01, text);
        assert.ok(Math.abs(10 + x - 2 * z - second) < 0.01, text);
        const toEye = seen.scene.camera.eye.map((value) => value / Math.hypot(...seen.scene.camera.eye));
        assert.ok(Math.abs(y - 0.8 * toEye[1]) < 0.02, `${text}: the rotation in xz leaves y as it is`);
        assert.equal((await script.state()).revision, revision, "pointing changes nothing");

        await moveTo(4, 4);
        await labeled(page, /^$/);
        const hidden = await script.request({ type: "set", shown: { faces: false } });
        await presented(page, hidden.revision);
        await moveTo(...facing(seen, slice, 0.8, size));
        await labeled(page, /^$/);
        const back = await script.request({ type: "set", shown: { faces: true } });
        await presented(page, back.revision);
        await labeled(page, /^Level 0\.64 \(/);
        assert.deepEqual(errors, []);
        await close();
    });

    test(`pointing at fields: a cap has the value and the units of the file: ${mode}`, async () => {
        const valueAt = (x, y, z, t) => 20 + 2 * x - y + 3 * z + t;
        const file = { side: 3, valueAt, quantity: "temperature", unit: "K", units: ["s", "m", "m", "km"] };
        const load = { format: "netcdf", data: netcdfWithUnits(file) };
        const settings = { view: "single", levels: [18], inside: "above" }; // the box's front is inside the body
        const { page, errors, size, picture, moveTo, close } = await openField(mode, load, settings);
        const seen = await picture();
        const slice = seen.slices.find(({ focus }) => focus);
        await moveTo(...project(seen.scene, slice.position, size));
        const place = `\\(${kNumber} km, ${kNumber} m, ${kNumber} m, ${kNumber} s\\)`;
        const pattern = `^Inside level 18 K ${place} · temperature ${kNumber} K · slice w ${kNumber}$`;
        const text = await labeled(page, new RegExp(pattern));
        const [, x, y, z, t, value] = numbersIn(text);
        assert.ok([x, y, z].some((one) => Math.abs(one) > 0.999), `${text}: on the boundary of the box`);
        assert.ok(Math.abs(valueAt(x, y, z, t) - value) < 0.01, text);
        assert.deepEqual(errors, []);
        await close();
    });

    test(`pointing at fields: a contour in the matrix tells its level: ${mode}`, async () => {
        const settings = { view: "matrix", levels: [0.16, 0.64], point: [0.1, 0.2, 0, 0] };
        const { page, script, errors, size, picture, moveTo, click, close } = await openField(mode, kBall, settings);
        const { matrix } = await picture();
        const panel = panelOf(matrix, "yx", size);
        const place = `\\((${kNumber}), (${kNumber}), (${kNumber}), (${kNumber})\\)`;
        for (const [level, radius] of [["0.64", 0.8], ["0.16", 0.4]]) {
            await moveTo(...panel.at(0.6 * radius, 0.8 * radius));
            const text = await labeled(page, new RegExp(`^Level ${level} ${place}$`));
            const [, x, y, z, w] = numbersIn(text);
            for (const [is, expected] of [[x, 0.6 * radius], [y, 0.8 * radius], [z, 0], [w, 0]]) {
                assert.ok(Math.abs(is - expected) < 0.04, text);
            }
        }
        // A click on a contour moves the focus point there, like a click beside the contour.
        await click(...panel.at(0.24, 0.32));
        const { point } = await script.until(({ point: [x] }) => Math.abs(x - 0.24) < 0.02, "the focus point");
        assert.ok(Math.abs(point[1] - 0.32) < 0.02, String(point));
        assert.deepEqual(errors, []);
        await close();
    });

    test(`pointing at fields: the surface in the projection tells its level, and a click keeps the highlight: ${mode}`, async () => {
        const highlight = { element: "cell", number: 3 };
        const settings = { view: "single", projection: "perspective", levels: [0.64], slices: { focus: 2 }, highlight };
        const { page, script, errors, size, picture, moveTo, click, close } = await openField(mode, kBall, settings);
        const { projection, scene, slices } = await picture();
        const { w: focusW } = slices.find(({ focus }) => focus);
        const placed = { scene: { ...scene, scale: projection.surface_scale } };
        const at = facing(placed, projection, Math.sqrt(0.64 - focusW ** 2), size);
        await moveTo(...at);
        const place = `\\((${kNumber}), (${kNumber}), (${kNumber}), (${kNumber})\\)`;
        const text = await labeled(page, new RegExp(`^Level 0\\.64 ${place}$`));
        const [, x, y, z, w] = numbersIn(text);
        assert.ok(Math.abs(x * x + y * y + z * z + w * w - 0.64) < 0.01, text);
        assert.ok(Math.abs(w - focusW) < 0.01, text);
        await click(...at);
        assert.deepEqual((await stateAfter(page, script)).highlight, highlight);
        assert.deepEqual(errors, []);
        await close();
    });

    test(`pointing at fields: a click on a surface makes its slice the focus, and keeps the highlight: ${mode}`, async () => {
        const settings = { levels: [0.64], highlight: { element: "cell", number: 3 } };
        const { page, script, errors, size, picture, click, close } = await openField(mode, kBall, settings);
        const seen = await picture();
        const slice = seen.slices.find(({ index }) => index === 2);
        await click(...facing(seen, slice, Math.sqrt(0.64 - slice.w ** 2), size));
        const { highlight } = await script.until(({ slices }) => slices.focus === 2, "the slice is the focus");
        assert.deepEqual(highlight, { element: "cell", number: 3 });
        assert.deepEqual(errors, []);
        await close();
    });
}

test("pointing at fields: the values follow the pointer over the surface, and a new orientation", async () => {
    const opened = await openField("geometry", { ...kBall, values: "x" }, { view: "single", levels: [0.64] });
    const { page, script, errors, size, picture, moveTo, close } = opened;
    const seen = await picture();
    const slice = seen.slices.find(({ focus }) => focus);
    const [x, y] = facing(seen, slice, 0.8, size);
    const secondAt = async (left) => {
        await moveTo(x + left, y);
        const { second_value: expected } = await script.request({ type: "get", what: "at", x: x + left, y, ...size });
        // The triangles of the page's own picture differ a little from the exact surface.
        await page.waitForFunction((wanted) => {
            const [, text] = / second value (\S+) /.exec(document.getElementById("pointed").textContent) ?? [];
            return text !== undefined && Math.abs(Number(text.replace("−", "-")) - wanted) < 0.01;
        }, expected);
        return expected;
    };
    assert.ok(Math.abs(await secondAt(0)) < 0.05);
    assert.ok((await secondAt(60)) > 0.05);
    const turned = await script.request({ type: "rotate", planes: ["xw"], angles: [Math.PI] });
    await presented(page, turned.revision);
    assert.ok((await secondAt(60)) < -0.05, "x has changed its sign");
    assert.deepEqual(errors, []);
    await close();
});
