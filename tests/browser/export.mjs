// The export dialog: its options, and the files that it makes.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "./support/suite.mjs";

import { named, openWithScript, presented, ready } from "./support/browser.mjs";
import { bytesOf, pagesOf } from "./support/downloads.mjs";
import { decode } from "./support/pixels.mjs";
import { startServer } from "./support/server.mjs";
import { pngText } from "./node_modules/.oval4d/client.mjs";

const table = JSON.parse(readFileSync(new URL("../../protocol/export_formats.json", import.meta.url)));

const text = (bytes, length = bytes.length) => Buffer.from(bytes.subarray(0, length)).toString();

/** The width, height and depth of the bounding box of the object in a binary STL file. */
function boxOf(stl) {
    const [least, most] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    const triangles = stl.readUInt32LE(80);
    assert.equal(stl.length, 84 + 50 * triangles);
    assert.ok(triangles >= 4);
    for (let i = 0; i < triangles; ++i) {
        for (let k = 0; k < 9; ++k) {
            const value = stl.readFloatLE(84 + 50 * i + 12 + 4 * k);
            least[k % 3] = Math.min(least[k % 3], value);
            most[k % 3] = Math.max(most[k % 3], value);
        }
    }
    return most.map((value, k) => value - least[k]);
}

async function openExport(page) {
    await page.keyboard.press("x");
    await page.waitForSelector("#export[open]");
}

/** Clicks the label of a radio button, as a user does. */
async function choose(page, name, value) {
    await page.locator(`#export label:has([name=${name}][value="${value}"])`).click();
}

async function exported(page, choices = {}, numbers = {}) {
    await openExport(page);
    for (const [name, value] of Object.entries(choices)) await choose(page, name, value);
    for (const [name, value] of Object.entries(numbers)) await page.fill(`#export [name=${name}]`, String(value));
    const saving = page.waitForEvent("download");
    await page.click("#export-submit");
    const download = await saving;
    await page.waitForSelector("#export:not([open])", { state: "attached" });
    return { name: download.suggestedFilename(), bytes: await bytesOf(download) };
}

/**
 * Runs in the page before its scripts. Holds back the answer to the first request for a file until `window.release()`
 * is called.
 */
function holdFile() {
    let id;
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
        const message = JSON.parse(text);
        if (message.what === "file") id ??= message.id;
        return send.call(this, text);
    };
    const { set } = Object.getOwnPropertyDescriptor(WebSocket.prototype, "onmessage");
    Object.defineProperty(WebSocket.prototype, "onmessage", {
        set(handler) {
            set.call(this, (event) => {
                const pass = () => handler?.call(this, event);
                const isHeld = id !== undefined && typeof event.data === "string" && JSON.parse(event.data).id === id;
                if (isHeld) window.release = pass;
                else pass();
            });
        },
    });
}

test("export: the name of a file has the w of the request, also if the focus moves before the answer", async () => {
    const { page, script, errors, close } = await openWithScript({ before: holdFile });
    await openExport(page);
    await choose(page, "format", "stl");
    await choose(page, "of", "focus");
    const before = await page.locator("#export-focus").textContent();
    const saving = page.waitForEvent("download");
    await page.click("#export-submit");
    await page.waitForFunction(() => window.release);
    await script.request({ type: "set", slices: { focus: 3 } });
    await page.waitForFunction((text) => document.getElementById("export-focus").textContent !== text, before);
    await page.evaluate(() => window.release());
    assert.match((await saving).suggestedFilename(), /-w-0\.stl$/);
    assert.deepEqual(errors, []);
    await close();
});

test("export: every format makes its file, with a descriptive name", async () => {
    const begins = {
        "3mf": /^PK/,
        stl: /^[ -~]/,
        glb: /^glTF/,
        ply: /^ply\n/,
        obj: /^(#|o |v )/,
        off: /^(#.*\n)*4OFF/,
        csv: /^n,w,/,
        svg: /^<(\?xml|svg)/,
        pdf: /^%PDF-1/,
        tikz: /^% .*\n% A figure of [^]*\\begin\{tikzpicture\}/,
        x3d: /^<\?xml[^]*<X3D/,
        scad: /^\/\/ 24-cell, in millimeters, from oval4d\n/,
        vtp: /^<\?xml[^]*<PolyData/,
        pov: /^\/\/ 24-cell, from oval4d: povray [^]*#version 3\.7;/,
    };
    const ofPolytopes = table.formats.filter(({ objects }) => objects !== "fields").map(({ name }) => name);
    assert.deepEqual(new Set(Object.keys(begins)), new Set(ofPolytopes), "begins has a row for each format");
    for (const some of pagesOf(Object.entries(begins))) {
        const { page, script, press, errors, close } = await openWithScript();
        await script.request({ type: "set", polytope: "24-cell" });
        await press("4");
        for (const [format, expected] of some) {
            const { name, bytes } = await exported(page, { format });
            assert.match(name, new RegExp(`^24-cell.*\\.${format}$`));
            assert.match(text(bytes, 400), expected, format);
        }
        assert.equal(await page.evaluate(() => document.activeElement.id), "drawing", "the focus is returned");
        await press("4");
        assert.deepEqual(errors, []);
        await close();
    }
});

test("export: size, body and slices are as chosen", async () => {
    const { page, script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    // The slice of the tesseract at w = 0 is a cube. Its side is half the diameter of the sphere around the tesseract.
    const solid = await exported(page, { format: "stl" }, { size: 80 });
    boxOf(solid.bytes).forEach((side) => assert.ok(Math.abs(side - 40) < 0.01, `a side of ${side} mm`));
    assert.equal(solid.name, "8-cell-w-0.stl");
    const skeleton = await exported(page, { body: "skeleton" }); // the page remembers the other choices
    assert.equal(skeleton.name, "8-cell-w-0-skeleton.stl");
    assert.ok(
        boxOf(skeleton.bytes).every((side) => side > 40.5 && side < 50),
        "balls protrude at the corners",
    );
    const oval = await exported(page, { body: "solid", of: "oval" });
    assert.equal(oval.name, "8-cell-oval.stl");
    assert.ok(boxOf(oval.bytes)[0] > 100, "the slices are side by side");
    await page.reload();
    await page.waitForSelector("[data-action=help]", { state: "attached" });
    await openExport(page);
    assert.equal(await page.inputValue("#export [name=size]"), "80", "the choices survive a reload");
    await close();
});

/** The number of cubes in a binary STL file. Each cube has twelve triangles. */
const cubesIn = (stl) => stl.readUInt32LE(80) / 12;

test("export: slices are those that are chosen, and what the file lacks is told", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    await openExport(page);
    await choose(page, "format", "stl");
    assert.equal(await page.locator("#export [data-choice=slices]").isVisible(), false, "there is only the focus slice");
    await page.keyboard.press("Escape");
    const fitted = await exported(page, { of: "oval", slices: "fit" }, { fit: 4 });
    assert.equal(fitted.name, "8-cell-4-slices.stl");
    assert.equal(cubesIn(fitted.bytes), 4);
    assert.equal(await page.locator("#notice").textContent(), "");
    const listed = await exported(page, { slices: "at" }, { at: "-1/2, 0, 3" });
    assert.equal(listed.name, "8-cell-slices.stl");
    assert.equal(cubesIn(listed.bytes), 2);
    await page.waitForFunction(() => /1 of 3 slices is empty/.test(document.getElementById("notice").textContent));
    await openExport(page);
    await page.fill("#export [name=at]", "one");
    await page.click("#export-submit");
    await page.waitForFunction(() => /nothing is called 'one'/.test(document.getElementById("export-error").textContent));
    assert.deepEqual(errors, []);
    await close();
});

test("export: the highlighted element alone, if there is one", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    const isOffered = () => page.locator('#export label:has([name=of][value="highlight"])').isVisible();
    await openExport(page);
    await choose(page, "format", "stl");
    assert.equal(await isOffered(), false);
    await page.keyboard.press("Escape");
    const lit = async (element, number) => {
        const { revision } = await script.request({ type: "set", highlight: { element, number } });
        await presented(page, revision);
    };
    await lit("cell", 3);
    const cell = await exported(page, { of: "highlight" });
    assert.equal(cell.name, "8-cell-cell-3.stl");
    assert.equal(cubesIn(cell.bytes), 1);
    await lit("edge", 5);
    await openExport(page);
    assert.equal(await page.locator("#export-highlight").textContent(), "edge 5");
    assert.equal(await page.locator("#export [name=body]:checked").inputValue(), "skeleton", "an edge has no volume");
    assert.equal(await page.locator('#export label:has([name=body][value="solid"])').isVisible(), false);
    await page.keyboard.press("Escape");
    await script.request({ type: "set", highlight: null });
    await script.until(({ highlight }) => highlight === null, "the end of the light");
    await presented(page, (await script.state()).revision);
    await openExport(page);
    assert.equal(await isOffered(), false);
    assert.equal(await page.locator("#export [name=of]:checked").inputValue(), "focus");
    assert.deepEqual(errors, []);
    await close();
});

test("export: figures show what is chosen", async () => {
    const { page, script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    for (const [of, file, title] of [
        ["coordinates", "8-cell-coordinates.svg", "Parallel coordinates"],
        ["projection", "8-cell-projection.svg", "Perspective projection"],
        ["matrix", "8-cell-matrix.svg", "Planar sections"],
        ["oval", "8-cell-oval.svg", "Slices"],
        ["focus", "8-cell-w-0.svg", "Slice: "],
    ]) {
        const { name, bytes } = await exported(page, { format: "svg", of });
        assert.equal(name, file);
        assert.match(text(bytes, 400), new RegExp(`<title>${title}`));
    }
    const { bytes } = await exported(page, {}, { side: 100 });
    assert.match(text(bytes, 400), /width="100.000mm" height="100.000mm"/);
    await close();
});

test("export: a field and a polytope have different formats", async () => {
    const { page, script, errors, close } = await openWithScript();
    const offered = () =>
        page.locator("#export [name=format]:not([disabled])").evaluateAll((all) => all.map(({ value }) => value));
    await openExport(page);
    assert.ok((await offered()).includes("off") && !(await offered()).includes("vti"));
    await choose(page, "format", "off");
    await page.keyboard.press("Escape");
    await script.request({ type: "load", name: "ball", format: "formula", data: "x^2 + y^2 + z^2 + w^2 < 1" });
    await named(page, "ball");
    await openExport(page);
    assert.ok((await offered()).includes("vti") && !(await offered()).includes("off"));
    assert.equal(await page.locator("#export [name=format]:checked").inputValue(), "3mf");
    await page.keyboard.press("Escape");
    const begins = { vti: /<ImageData/, vtp: /<PolyData/, csv: /^n,w,volume,area,/, glb: /^glTF/ };
    for (const [format, expected] of Object.entries(begins)) {
        const { name, bytes } = await exported(page, { format });
        assert.match(name, new RegExp(`^ball.*\\.${format}$`));
        assert.match(text(bytes, 400), expected, format);
    }
    const isExactOffered = () => page.locator("#export [data-choice=exact]").isVisible();
    await openExport(page);
    for (const [format, offers] of Object.entries({ csv: false, vtp: true, svg: false, obj: true })) {
        await choose(page, "format", format);
        assert.equal(await isExactOffered(), offers, format);
    }
    await choose(page, "body", "skeleton");
    assert.equal(await isExactOffered(), false, "the box has no surfaces");
    await choose(page, "body", "solid");
    await page.keyboard.press("Escape");
    const smooth = await exported(page, { format: "obj" });
    const exact = await exported(page, { exact: "on" });
    assert.equal(exact.name, "ball-w-0-exact.obj");
    assert.ok(exact.bytes.length > 0 && !exact.bytes.equals(smooth.bytes));
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    await openExport(page);
    assert.equal(await isExactOffered(), false);
    await page.keyboard.press("Escape");
    assert.deepEqual(errors, []);
    await close();
});

test("export: of a field, only what each format can contain is offered, and is saved", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "load", name: "ball", format: "formula", data: "x^2 + y^2 + z^2 + w^2 < 1" });
    await named(page, "ball");
    const small = { svg: /^<(\?xml|svg)/, pdf: /^%PDF-1/, csv: /^(n,w,volume|w,change)/ };
    for (const [format, expected] of Object.entries(small)) {
        await openExport(page);
        await choose(page, "format", "stl");
        await choose(page, "of", "focus"); // drawings of fields do not offer this
        await choose(page, "format", format);
        const offered = await page
            .locator("#export label:visible:has([name=of])")
            .evaluateAll((all) => all.map((label) => [label.firstElementChild.value, label.innerText.split("\n")[0]]));
        const names = offered.map(([, name]) => name.replace(/ (w =|\d).*/, ""));
        const ofCsv = ["Focus slice", "Whole oval", "Critical w"];
        assert.deepEqual(names, format === "csv" ? ofCsv : ["Histogram", "Projection", "Matrix"]);
        if (format !== "csv") assert.match(await page.locator("#export-about").textContent(), /^The histogram/);
        await page.keyboard.press("Escape");
        for (const [of] of offered) {
            const { name, bytes } = await exported(page, { of });
            assert.match(text(bytes, 400), expected, `${format} of ${of}`);
            if (of === "coordinates") assert.equal(name, `ball-histogram.${format}`);
        }
    }
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    await openExport(page);
    await choose(page, "format", "svg");
    assert.equal(await page.locator("#export-coordinates").textContent(), "Parallel coordinates");
    assert.ok(await page.locator("#export label:has([name=of][value=oval])").isVisible());
    assert.deepEqual(errors, []);
    await close();
});

test("export: only the options of the format are shown", async () => {
    const { page, close } = await openWithScript();
    await openExport(page);
    const asked = () =>
        page.locator("#export [data-choice]:visible").evaluateAll((all) => all.map((one) => one.dataset.choice));
    for (const [format, expected] of Object.entries({
        stl: ["of", "body", "size", "label"],
        off: [],
        csv: ["of"],
        vtp: ["of"],
        png: ["pixels", "background"],
        svg: ["of", "side"],
        glb: ["of", "body", "size", "label"],
    })) {
        await choose(page, "format", format);
        assert.deepEqual(await asked(), expected, format);
        assert.ok((await page.locator("#export-about").innerText()).length > 20);
        assert.match(await page.locator("#export-submit").innerText(), new RegExp(format, "i"));
    }
    await close();
});

test("export: works with the keyboard alone", async () => {
    const { page, close } = await openWithScript();
    await openExport(page);
    assert.equal(await page.evaluate(() => document.activeElement.name), "format");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#export [name=format]:checked").inputValue(), "stl");
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.name), "of");
    await page.keyboard.press("Tab");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#export [name=body]:checked").inputValue(), "skeleton");
    const saving = page.waitForEvent("download");
    await page.keyboard.press("Enter");
    assert.match((await saving).suggestedFilename(), /skeleton\.stl$/);
    await openExport(page);
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#export").isVisible(), false);
    await page.waitForSelector("#drawing:focus");
    await close();
});

test("export: a PNG has the chosen size, and contains the state", async () => {
    const { page, script, press, close } = await openWithScript();
    const state = await press("y");
    await openExport(page);
    await choose(page, "format", "png");
    const isAsDisplayed = async () => {
        const { width, height } = await page
            .locator("#drawing")
            .evaluate((one) => ({ width: one.clientWidth, height: one.clientHeight }));
        assert.equal(await page.inputValue("#export [name=width]"), String(width));
        assert.equal(await page.inputValue("#export [name=height]"), String(height));
        await page.keyboard.press("Escape");
    };
    await isAsDisplayed();
    await page.setViewportSize({ width: 1000, height: 600 });
    await page.waitForFunction(() => {
        const drawing = document.getElementById("drawing");
        return innerWidth === 1000 && drawing.querySelector("canvas.solids").width === drawing.clientWidth;
    });
    await openExport(page);
    await isAsDisplayed();
    const large = await exported(page, { format: "png", preset: "1920x1080" });
    assert.equal(large.name, "5-cell.png");
    assert.deepEqual([decode(large.bytes).width, decode(large.bytes).height], [1920, 1080]);
    assert.deepEqual(JSON.parse(pngText(large.bytes)).orientation, state.orientation);
    const own = await exported(page, { preset: "" }, { width: 300, height: 200 });
    assert.deepEqual([decode(own.bytes).width, decode(own.bytes).height], [300, 200]);
    await page.reload();
    await ready(page);
    await openExport(page);
    assert.equal(await page.inputValue("#export [name=width]"), "300", "the size survives a reload");
    await page.keyboard.press("Escape");
    assert.equal((await script.state()).revision, state.revision);
    await close();
});

test("export: an error is shown in the dialog, and the choices stay", async () => {
    const server = await startServer({ options: ["--max-file-triangles", "1000"] });
    const { page, script, errors, close } = await openWithScript({ url: server.url });
    await openExport(page);
    await choose(page, "format", "stl");
    await choose(page, "body", "skeleton");
    await page.click("#export-submit");
    await page.waitForFunction(() =>
        /triangles.*1000.*allowed/.test(document.getElementById("export-error").textContent),
    );
    assert.equal(await page.locator("#export").isVisible(), true);
    assert.equal(await page.locator("#export-submit").isEnabled(), true);
    await choose(page, "body", "solid");
    assert.equal(await page.locator("#export-error").textContent(), "", "the error disappears with the next choice");
    await page.keyboard.press("Escape");
    await script.request({ type: "set", slices: { focus: 100 } }); // far outside the polytope
    await openExport(page);
    await page.click("#export-submit");
    await page.waitForFunction(() => /empty|flat/.test(document.getElementById("export-error").textContent));
    assert.deepEqual(errors, []);
    await close();
    await server.stop();
});

test("export: importing the 4OFF file gives the same polytope", async () => {
    const { page, script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "600-cell" });
    await script.request({ type: "rotate", planes: ["xw"], angles: [0.4] });
    await named(page, "600-cell");
    const { name, bytes } = await exported(page, { format: "off" });
    await page.setInputFiles("#file", { name, mimeType: "", buffer: Buffer.from(bytes) });
    const { polytope } = await script.until((one) => one.polytope.name === name, "the file's polytope");
    assert.deepEqual([polytope.vertices, polytope.edges, polytope.faces, polytope.cells], [120, 720, 1200, 600]);
    await close();
});
