// The page shows the units of a field's axes, and what its values measure.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, spoken } from "./support/browser.mjs";
import { assertStreamsAgree, picture } from "./support/drawing.mjs";
import { netcdfWithUnits } from "./support/netcdf.mjs";
import { compare } from "./support/pixels.mjs";
import { drawingOf } from "./support/pointing.mjs";
import { project, worldPoints } from "./support/scene.mjs";

const valueAt = (x, y, z, t) => x * x + y * y + z * z + t;
const kFile = { side: 4, valueAt, quantity: "temperature", unit: "K", units: ["s", "m", "m", "m"] };

const load = (script, file) =>
    script.request({ type: "load", name: "run", format: "netcdf", data: netcdfWithUnits({ ...kFile, ...file }) });

test("field units: the panel and the color scale name the quantity", async () => {
    const { page, script, errors, close } = await openWithScript();
    await load(script);
    await script.request({ type: "set", color: "value", levels: [1, 2] });
    await page.waitForFunction(() => document.querySelector(".scale small")?.textContent === "temperature, K");
    const spokenScale = await page.getAttribute(".scale span", "aria-label");
    assert.match(spokenScale, /^The colors of temperature, from \S+ to \S+ K$/);
    await spoken(page, "levels 1, 2 K");
    const legends = () => page.locator("#field [data-quantity]").allTextContents();
    assert.deepEqual(await legends(), [" (temperature, K)", " (temperature, K)"]);
    await script.request({ type: "load", name: "formula", format: "formula", data: "x + y" });
    await page.waitForFunction(() => document.querySelector("#field [data-quantity]").textContent === "");
    assert.deepEqual(await legends(), ["", ""]);
    assert.deepEqual(errors, []);
    await close();
});

test("field units: beside w, the header has the moment of the focus slice", async () => {
    const { page, script, errors, close } = await openWithScript();
    await load(script);
    await script.request({ type: "set", slices: { focus: 2 } });
    const { coordinate } = (await script.state()).section;
    assert.equal(coordinate.unit, "s");
    const rounded = String(Math.round(coordinate.value * 1000) / 1000);
    const isShown = (text) =>
        page.waitForFunction(
            (pattern) => new RegExp(pattern).test(document.querySelector("[data-state-field=w]").textContent),
            text,
        );
    await isShown(`^0\\.\\d+ \\(${rounded.replace(".", "\\.")} s\\)$`);
    await script.request({ type: "rotate", planes: ["xw"], angles: [0.3] });
    await isShown("^0\\.\\d+$");
    assert.deepEqual(errors, []);
    await close();
});

for (const view of ["oval", "matrix"]) {
    test(`field units: geometry and frame agree: ${view}`, async () => {
        const { page, script, errors, close } = await openWithScript();
        const shown = async (file) => {
            await load(script, file);
            const { revision } = await script.request({ type: "set", view, shown: { faces: false } });
            await presented(page, revision);
            return picture(page);
        };
        const without = await shown({ quantity: "", unit: "", units: ["", "", "", ""] });
        assert.ok(compare(await shown({}), without).far > 0, "the names of the axes and the quantity are drawn");
        await assertStreamsAgree(page, { mean: 1.2, far: 0.008 });
        assert.deepEqual(errors, []);
        await close();
    });
}

test("field units: the label of a corner of the box has its coordinates in the box, in both modes", async () => {
    const { page, script, errors, close } = await openWithScript();
    await load(script);
    const { revision } = await script.request({ type: "set", view: "single", projection: "perspective", shown: { faces: false } });
    await presented(page, revision);
    const drawing = await drawingOf({ page, script });
    const { size, moveTo } = drawing;
    const { scene, projection } = await drawing.picture();
    const [whole] = projection.parts;
    const points = worldPoints({ scale: projection.scale }, { position: projection.position, vertices: whole.vertices });
    const far = points.map((point) => Math.hypot(...point.map((value, k) => value - scene.camera.eye[k])));
    const [x, y] = project(scene, points[far.indexOf(Math.min(...far))], size);
    const { highlight, place } = await script.request({ type: "get", what: "at", x, y, ...size });
    assert.equal(highlight.element, "vertex");
    const rounded = place.map((value) => String(Math.round(value * 1000) / 1000).replace("-", "−"));
    const [px, py, pz, pw] = rounded;
    const expected = `Vertex ${highlight.number} (${px} m, ${py} m, ${pz} m, ${pw} s)`;
    await moveTo(x, y);
    const isShown = (text) => page.waitForFunction((wanted) => document.getElementById("pointed").textContent === wanted, text);
    await isShown(expected);
    await moveTo(4, 4);
    await page.locator("[data-page-tool=frames]").dispatchEvent("click");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await moveTo(x, y);
    await isShown(expected);
    assert.deepEqual(errors, []);
    await close();
});

test("field units: the label beside the pointer has the units of the sizes of the box", async () => {
    const { page, script, errors, close } = await openWithScript();
    await load(script);
    const { revision } = await script.request({ type: "set", view: "single", shown: { faces: false } });
    await presented(page, revision);
    const drawing = await drawingOf({ page, script });
    const { size, moveTo } = drawing;
    const { scene, slices } = await drawing.picture();
    const slice = slices.find(({ focus }) => focus);
    const points = worldPoints(scene, slice).map((at) => project(scene, at, size));
    // An edge of the slice is cut from a 2-face of the box that also extends along w.
    let middle;
    for (let e = 0; e < slice.edges.length && !middle; e += 2) {
        const [a, b] = [points[slice.edges[e]], points[slice.edges[e + 1]]];
        const [x, y] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
        const { highlight } = await script.request({ type: "get", what: "at", x, y, ...size });
        if (highlight?.element === "face") middle = { x, y };
    }
    assert.ok(middle, "the middle of an edge of the slice is seen");
    await moveTo(middle.x, middle.y);
    await page.waitForFunction(() => / area [\d.]+ m s · /.test(document.getElementById("pointed").textContent));
    assert.deepEqual(errors, []);
    await close();
});
