// The picture on the page: where the slices are, and that page and server draw the same picture.
import assert from "node:assert/strict";
import { inFirefox, test } from "./support/suite.mjs";

import { accurateBrowser, openPage, openWithScript, presented, shownValues } from "./support/browser.mjs";
import { within } from "./support/hang_limit.mjs";
import { assertSimilar, assertStreamsAgree, drawBy, picture } from "./support/drawing.mjs";
import { toggledViews } from "./support/keys.mjs";
import { below, compare, decode, distance, pixelAt } from "./support/pixels.mjs";
import { litAt } from "./support/pointing.mjs";
import { project, rgb, stripPoint, worldPoints } from "./support/scene.mjs";

const drawing = (page) => page.locator("#drawing");

for (const polytope of ["5-cell", "8-cell", "24-cell", "600-cell"]) {
    test(`picture: the slices of the ${polytope} are where the server places them`, async () => {
        const { page, script, errors, close } = await openWithScript();
        const { revision } = await script.request({ type: "set", polytope });
        await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.4, 1.1] });
        await presented(page, revision + 1);
        const shown = await picture(page);
        const { width, height } = shown;
        const { scene, slices } = await script.request({ type: "get", what: "slices", width, height });
        const background = rgb(scene.colors.background);
        let seen = 0;
        for (const slice of slices.filter(({ vertices }) => vertices.length > 0)) {
            for (const point of worldPoints(scene, slice)) {
                const [x, y] = project(scene, point, { width, height });
                if (x < 1 || y < 1 || x > width - 2 || y > height - 2) continue;
                ++seen;
                const apart = distance(pixelAt(shown, Math.floor(x), Math.floor(y)), background);
                assert.ok(apart > 8, `slice ${slice.index}: only background at ${x}, ${y}`);
            }
        }
        assert.ok(seen >= 4 * slices.filter(({ vertices }) => vertices.length > 0).length, "all slices are visible");
        const hole = pixelAt(shown, width / 2, height * 0.1);
        assert.ok(distance(hole, background) <= 8, "the inside of the oval is empty");
        assert.deepEqual(errors, []);
        await close();
    });
}

for (const [polytope, columns] of [
    ["600-cell", false],
    ["120-cell", true],
    ["omnitruncated 120-cell", true],
]) {
    test(`picture: the coordinates of the ${polytope} are ${columns ? "a density strip" : "lines"} in both streams`, async () => {
        const { page, script, errors, close } = await openWithScript();
        await script.request({ type: "set", polytope });
        const { revision } = await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
        await presented(page, revision);
        const geometry = await picture(page);
        const { width, height } = geometry;
        const { scene, density } = await script.request({ type: "get", what: "slices", width, height });
        const layout = scene.coordinates;
        assert.equal(density.length > 0, columns);
        assert.equal(layout.columns > 0, columns);
        await drawBy(page, "frames");
        const top = Math.floor((1 - layout.zero - layout.amplitude) * height);
        assertSimilar(below(geometry, top), below(await picture(page), top), { mean: 1.5, far: 0.005 });
        if (columns) {
            // The picture differs from the background where the density is highest, and equals it where the density is
            // 0.
            const at = (k) => {
                const column = k % layout.columns;
                const row = Math.floor(k / layout.columns);
                const gap = (layout.columns - 1) / 3;
                const x = (layout.left + layout.line_width / 2 + (column / gap) * layout.line_step) * height;
                const level = 1 - (2 * row) / (density.length / layout.columns - 1);
                return pixelAt(geometry, x, (1 - layout.zero - level * layout.amplitude) * height);
            };
            const background = rgb(scene.colors.background);
            const inner = [...density.keys()].filter((k) => (k % layout.columns) % 64 > 8 && (k % layout.columns) % 64 < 56);
            const most = inner.reduce((a, b) => (density[b] > density[a] ? b : a));
            assert.ok(distance(at(most), background) > 60);
            const none = inner.find((k) => density[k] === 0);
            assert.ok(distance(at(none), background) < 8);
        }
        assert.deepEqual(errors, []);
        await close();
    });
}

test("picture: over a density strip, both streams draw the lines of the highlighted element's vertices", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "120-cell" });
    const turned = await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
    await presented(page, turned.revision);
    const before = await picture(page);
    const { revision } = await script.request({ type: "set", highlight: { element: "cell", number: 5 } });
    await presented(page, revision);
    const geometry = await picture(page);
    const { width, height } = geometry;
    const shown = await script.request({ type: "get", what: "slices", width, height });
    await drawBy(page, "frames");
    const frames = await picture(page);
    const own = [...shown.highlight.own_vertices];
    assert.equal(own.length, 20, "a dodecahedron");
    for (const v of own) {
        for (const along of [0.25, 1.5, 2.75]) {
            const place = stripPoint(shown, v, along, height);
            assert.ok(litAt(before, geometry, place), `the page draws no line of vertex ${v} at ${along}`);
            assert.ok(litAt(before, frames, place), `the server draws no line of vertex ${v} at ${along}`);
        }
    }
    const { zero, amplitude } = shown.scene.coordinates;
    const top = Math.floor((1 - zero - amplitude) * height);
    assertSimilar(below(geometry, top), below(frames, top), { mean: 3, far: 0.02 });
    assert.deepEqual(errors, []);
    await close();
});

const views = [
    { name: "the 5-cell in its initial state", settings: {} },
    { name: "the 600-cell", settings: { polytope: "600-cell" } },
    {
        name: "from another side and nearer",
        settings: { polytope: "24-cell", camera: { azimuth: 0.5, elevation: 0.3, zoom: 1.6 } },
    },
    { name: "the single view", settings: { polytope: "16-cell", view: "single" } },
    ...toggledViews
        .filter((view) => view !== "matrix") // the matrix has its own tests
        .map((view) => ({ name: `the view ${view}`, settings: { polytope: "24-cell", view } })),
    { name: "101 slices", settings: { polytope: "8-cell", slices: { count: 101, spacing: 0.02 } } },
    { name: "bars alone", settings: { polytope: "120-cell", shown: { faces: false, balls: false } } },
    { name: "colored by kind", settings: { polytope: "truncated tesseract", color: "kind" } },
    { name: "with a kind hidden", settings: { polytope: "truncated tesseract", hidden: [1] } },
    { name: "with a kind faded", settings: { polytope: "cantellated 5-cell", color: "w", faded: [0, 1] } },
    { name: "a star", settings: { polytope: "great stellated 120-cell" }, mean: 1.2 },
    { name: "a star alone", settings: { polytope: "small stellated 120-cell", view: "single" } },
    {
        name: "a star and its projection",
        settings: { polytope: "small stellated 120-cell", projection: "perspective" },
        ...{ mean: 2.4, far: 0.02 },
    },
    {
        name: "the cells of a star in the projection",
        settings: { polytope: "5/2,5-duoprism", projection: "perspective", shown: { cells: true } },
        ...{ mean: 2.4, far: 0.02 },
    },
    { name: "a perspective projection", settings: { polytope: "24-cell", projection: "perspective" } },
    { name: "thick balls and bars", settings: { polytope: "24-cell", projection: "perspective", thickness: 2 } },
    { name: "clearer faces", settings: { polytope: "24-cell", projection: "perspective", opacity: 0.5 } },
    { name: "denser faces", settings: { polytope: "24-cell", opacity: 4 } },
    {
        name: "an orthogonal projection with many bars behind one another",
        settings: { polytope: "600-cell", projection: "orthogonal" },
        ...{ mean: 1.6, far: 0.008 },
    },
    {
        name: "a projection whose sections shine through its faces",
        settings: { polytope: "600-cell", projection: "perspective", shown: { sections: true } },
    },
    { name: "faces alone", settings: { polytope: "8-cell", shown: { bars: false, balls: false, coordinates: false } } },
];
for (const { name, settings, mean = 1, far = 0.005 } of views) {
    test(`picture: geometry and frame agree: ${name}`, async () => {
        const { page, script, errors, close } = await openWithScript();
        await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
        const { revision } = await script.request({ type: "set", ...settings });
        await presented(page, revision);
        await assertStreamsAgree(page, { mean, far });
        assert.deepEqual(errors, []);
        await close();
    });
}

/** The part of a picture that contains the matrix. */
function matrixOf({ width, height, data }, { left, bottom, step }) {
    const [x, y, side] = [left, 1 - bottom - 4 * step, 4 * step].map((length) => Math.floor(length * height));
    const row = (i) => data.subarray(4 * ((y + i) * width + x), 4 * ((y + i) * width + x + side));
    return { width: side, height: side, data: Buffer.concat(Array.from({ length: side }, (_, i) => row(i))) };
}

const matrices = [
    { name: "a 24-cell", settings: { polytope: "24-cell", point: [0.2, 0.1, -0.3, 0.15] } },
    { name: "denser faces", settings: { polytope: "24-cell", point: [0.2, 0.1, -0.3, 0.15], opacity: 4 } },
    {
        name: "a kind hidden, another one faded, and a cell highlighted",
        settings: { polytope: "cantellated 5-cell", color: "kind", hidden: [1], faded: [2], point: [0.1, 0.3, 0, -0.2] },
        highlight: { element: "cell", number: 2 },
    },
    { name: "a kind hidden with its vertices", settings: { polytope: "omnitruncated 5-cell", hidden: [0], point: [0.1, 0.9, 0, -1] } },
    { name: "a 2-face highlighted", settings: { polytope: "5-cell" }, highlight: { element: "face", number: 3 } },
    { name: "a star", settings: { polytope: "great stellated 120-cell", point: [0.1, 0.2, 0.3, 0.1] }, mean: 1.2, far: 0.003 },
    { name: "a star's bars", settings: { polytope: "{5/2,5,3}", shown: { faces: false, balls: false } }, mean: 0.8, far: 0.003 },
    { name: "faces alone", settings: { polytope: "600-cell", shown: { bars: false, balls: false } } },
    { name: "a point cloud", settings: { polytope: "dots", slices: { spacing: 0.5 } } },
    { name: "a tall window", settings: { polytope: "8-cell" }, viewport: { width: 400, height: 1000 }, mean: 0.7 },
    { name: "the focus point beyond the panels", settings: { polytope: "16-cell", point: [5, 0, -5, 0] } },
];
const kEdges = inFirefox ? 2 : 1; // Firefox draws the edges of shapes on 2-D canvases differently
for (const { name, settings, highlight, mean = 0.5, far = 0.0015, viewport } of matrices) {
    test(`picture: geometry and frame agree: the matrix: ${name}`, async () => {
        const { page, script, errors, close } = await openWithScript({ browser: await accurateBrowser(), ...(viewport && { viewport }) });
        const dots = Array.from({ length: 90 }, (_, i) => [1, 2, 3, 4].map((k) => Math.sin(k * i * i + k)));
        const lines = dots.map((dot, i) => [...dot, 0.05 + 0.15 * (i % 2)].join(" "));
        await script.request({ type: "load", name: "dots", format: "cloud", data: `CLOUD\n${lines.join("\n")}\n` });
        await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
        await script.request({ type: "set", view: "matrix", ...settings });
        // Without the labels, the matrix has no texts but the names of the axes.
        const { revision } = await script.request({ type: "set", highlight: highlight ?? null, shown: { labels: false } });
        await presented(page, revision);
        const geometry = await picture(page);
        const { width, height } = geometry;
        const { matrix } = await script.request({ type: "get", what: "slices", width, height });
        assert.equal(viewport !== undefined, matrix.left < 0.1, "beside the slice, or below it in a tall window");
        await drawBy(page, "frames");
        const [own, served] = [geometry, await picture(page)].map((one) => matrixOf(one, matrix));
        assertSimilar(own, served, { mean: kEdges * mean, far: kEdges * far });
        assert.deepEqual(errors, []);
        await close();
    });
}

/** Runs in the page. Records the texts that the page draws on its canvases, and their places in canvas pixels. */
function recordTexts() {
    const { fillText, clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...area) {
        this.canvas.texts = [];
        return clearRect.apply(this, area);
    };
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
        const box = this.measureText(text);
        this.canvas.texts?.push({
            text,
            left: x - box.actualBoundingBoxLeft,
            right: x + box.actualBoundingBoxRight,
            top: y - box.actualBoundingBoxAscent,
            bottom: y + box.actualBoundingBoxDescent,
        });
        return fillText.call(this, text, x, y);
    };
}

for (const [width, height] of [[1920, 1080], [1280, 720], [375, 667]]) {
    test(`picture: labels are whole and apart in a window of ${width} × ${height}`, async () => {
        const viewport = { width, height };
        const { page, script, errors, close } = await openWithScript({ viewport, before: recordTexts });
        for (const [count, spacing] of [[21, 0.1], [101, 0.02], [201, 0.01]]) {
            const slices = { count, spacing, focus: 5 };
            const { revision } = await script.request({ type: "set", polytope: "8-cell", slices });
            await presented(page, revision);
            const { labels, ...size } = await page.evaluate(() => {
                const [canvas] = [...document.querySelectorAll("#drawing canvas")].filter(({ texts }) => texts?.length);
                const isLabel = ({ text }) => /^(w = )?\u2212?[\d.]+(, [a-z: ]+)?$/.test(text);
                return { labels: canvas.texts.filter(isLabel), width: canvas.width, height: canvas.height };
            });
            const [focus] = labels.filter(({ text }) => text.startsWith("w = "));
            assert.equal(focus?.text, `w = ${(5 * spacing).toFixed(Math.ceil(-Math.log10(spacing)) + 1)}, cube`);
            assert.ok(labels.length > 10, `${labels.length} labels`);
            if (count === 21 && height > 700) assert.equal(labels.length, 21);
            for (const [i, a] of labels.entries()) {
                const whole = a.left >= 0 && a.right <= size.width && a.top >= 0 && a.bottom <= size.height;
                assert.ok(whole, `${a.text} is cut: ${JSON.stringify(a)}`);
                for (const b of labels.slice(i + 1)) {
                    const apart = a.right < b.left || b.right < a.left || a.bottom < b.top || b.bottom < a.top;
                    assert.ok(apart, `${a.text} overlaps ${b.text}`);
                }
            }
        }
        assert.deepEqual(errors, []);
        await close();
    });
}

test("picture: the comparison distinguishes two different states", async () => {
    const { page, press, close } = await openWithScript();
    const before = await picture(page);
    await drawing(page).focus();
    await press("6");
    const { mean, far } = compare(before, await picture(page));
    assert.ok(mean > 0.3 || far > 0.006, `one key changes the picture: ${mean}, ${far}`);
    await close();
});

const fog = [{ value: -1, opacity: 0.9 }, { value: 1, opacity: 0 }];
for (const { kind, formula, settings } of [
    { kind: "a polytope", settings: { polytope: "24-cell", projection: "perspective" } },
    { kind: "a star", settings: { polytope: "great stellated 120-cell" } },
    { kind: "a field", formula: "x^2 + y^2 - z^2 < w", settings: { levels: [-0.5, 0.5] } },
    { kind: "fog", formula: "x^2 + y^2 - z^2 < w", settings: { fog } },
]) {
    test(`picture: the page restores its own picture after that of the server: ${kind}`, async () => {
        const { page, script, close } = await openWithScript();
        if (formula) await script.request({ type: "load", name: "formula", format: "formula", data: formula });
        await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
        const { revision } = await script.request({ type: "set", ...settings });
        await presented(page, revision);
        const own = await picture(page);
        await drawBy(page, "frames");
        await drawBy(page, "geometry");
        assert.ok(compare(await picture(page), own).mean < 0.1);
        await close();
    });
}

test("picture: nothing is drawn unless something changes", async () => {
    const { page, close } = await openPage();
    const rest = page.evaluate(async () => {
        let asked = 1;
        const { requestAnimationFrame: ask } = window;
        window.requestAnimationFrame = (callback) => (++asked, ask.call(window, callback));
        // After the page has opened, some work remains for a moment.
        while (asked > 0) {
            asked = 0;
            for (let i = 0; i < 20; ++i) await new Promise((resolve) => ask.call(window, resolve));
        }
    });
    await within(rest, "animation frames in which the page draws nothing");
    await close();
});

test("picture: a high-resolution screen gets a high-resolution picture in either mode", async () => {
    const { page, close } = await openPage({ deviceScaleFactor: 2 });
    const sizes = () =>
        page.evaluate(() => {
            const { clientWidth, clientHeight, dataset } = document.getElementById("drawing");
            const canvas = document.querySelector(`#drawing .${dataset.mode === "frames" ? "frame" : "solids"}`);
            return [canvas.width - 2 * clientWidth, canvas.height - 2 * clientHeight];
        });
    assert.deepEqual(await sizes(), [0, 0]);
    await drawBy(page, "frames");
    assert.deepEqual(await sizes(), [0, 0]);
    await close();
});

test("picture: the header rounds w like the label of the focus slice", async () => {
    const { page, script, close } = await openWithScript();
    for (const [spacing, focus] of [[0.3, 1], [0.2, -2], [0.125, 1], [0.125, -3], [0.05, 2], [0.0123, 3], [0.1, 0]]) {
        await script.request({ type: "set", slices: { spacing, focus } });
        const { slices } = await script.request({ type: "get", what: "slices" });
        const { label } = slices.find((slice) => slice.focus);
        await page.waitForFunction(
            (value) => document.querySelector("[data-state-field=w]").textContent === value,
            /^w = ([^,]+)/.exec(label)[1],
        );
        assert.ok(label.startsWith(`w = ${(await shownValues(page)).w}`), label);
    }
    await close();
});
