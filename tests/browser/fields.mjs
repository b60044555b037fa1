// The surfaces and histograms of fields in the picture.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, named, openWithScript, presented, spoken } from "./support/browser.mjs";
import { assertSimilar, assertStreamsAgree, drawBy, picture } from "./support/drawing.mjs";
import { kBinaryEncodings, kEncodings } from "./support/encodings.mjs";
import { focusSurface, openPanel, write } from "./support/field.mjs";
import { below, compare, distance, pixelAt } from "./support/pixels.mjs";
import { project, rgb } from "./support/scene.mjs";
import { joinSession } from "./support/script.mjs";

const kTiger = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09";

const kFog = [
    { value: -0.09, opacity: 0.99 },
    { value: 0.1, opacity: 0.5, color: 0xff6040 },
    { value: 0.8, opacity: 0 },
];
const kWideFog = [
    { value: 0, opacity: 0.2 },
    { value: 4, opacity: 0.8 },
];

const views = [
    { name: "a closed surface", formula: kTiger },
    { name: "on a light page", formula: kTiger, options: { colorScheme: "light" } },
    { name: "capped by the box", formula: "x^2 + y^2 - z^2 < w" },
    { name: "two levels", formula: "x^2 + y^2 + z^2 + w^2", settings: { levels: [0.5, 2] } },
    { name: "three levels with caps", formula: "x^2 + y^2 - z^2 + w^2", settings: { levels: [-0.5, 2, 0.5] } },
    { name: "the levels above", formula: "x*y + z*w", settings: { levels: [0.5, 0], inside: "above" } },
    { name: "colored by growth", formula: kTiger, settings: { color: "growth" } },
    { name: "colored by a second function", formula: kTiger, values: "x*y + z", settings: { color: "value" } },
    { name: "caps colored by value", formula: "x^2 + y^2 - z^2 < w", settings: { caps: "value", levels: [0, 1] } },
    { name: "values on surfaces and caps", formula: "x^2 + y^2 - z^2 < w", values: "y", settings: { caps: "value" } },
    { name: "without caps", formula: "x^2 + y^2 - z^2 < w", settings: { caps: "open" } },
    { name: "colored by w, with a projection", formula: kTiger, settings: { color: "w", projection: "perspective" } },
    {
        name: "translucent levels in slices and in the projection",
        formula: "x^2 + y^2 + z^2 + w^2",
        settings: { levels: [0.5, 2], projection: "orthogonal" },
    },
    { name: "a slice alone", formula: "x^2 + y^2 - z^2 < w", settings: { view: "single" } },
    { name: "the matrix view", formula: "x^2 + y^2 - z^2 < w", settings: { view: "matrix", color: "growth" } },
    { name: "contours in the matrix", formula: kTiger, settings: { view: "matrix", levels: [0, 0.1], point: [0.6, 0.7, 0.5, 0.4] } },
    { name: "the box alone", formula: kTiger, settings: { shown: { faces: false } } },
    { name: "fog", formula: kTiger, settings: { fog: kFog, shown: { faces: false } } },
    { name: "fog around a level", formula: kTiger, settings: { fog: kFog } },
    { name: "fog between translucent levels", formula: "x^2 + y^2 + z^2 + w^2", settings: { levels: [0.5, 3], fog: kWideFog } },
    { name: "fog with holes", formula: "sqrt(x + 0.5) - y*z", settings: { shown: { faces: false }, fog: kFog } },
    { name: "fog and a projection", formula: kTiger, settings: { fog: kFog, projection: "perspective", inside: "above" } },
    { name: "fog of a slice alone", formula: kTiger, settings: { fog: kFog, view: "single", camera: { azimuth: 0.5, zoom: 3 } } },
];
for (const { name, formula, values, settings = {}, options } of views) {
    test(`fields: geometry and frame agree: ${name}`, async () => {
        const { page, script, errors, close } = await openWithScript(options);
        await script.request({ type: "load", name: "formula", format: "formula", data: formula, ...(values && { values }) });
        await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
        const { revision } = await script.request({ type: "set", ...settings });
        await presented(page, revision);
        await assertStreamsAgree(page, { mean: 1.2, far: 0.008 });
        assert.deepEqual(errors, []);
        await close();
    });
}

for (const { name, settings } of [
    { name: "one level", settings: { levels: [0.5] } },
    { name: "in a frame of reference", settings: { levels: [0, 1, 3], pace: 0.7, follow: [0.4, 0, 0] } },
]) {
    test(`fields: the histogram is the same in both streams: ${name}`, async () => {
        const { page, script, errors, close } = await openWithScript();
        await script.request({ type: "load", name: "formula", format: "formula", data: kTiger });
        await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.7, 0.3] });
        const { revision } = await script.request({ type: "set", ...settings });
        await presented(page, revision);
        const geometry = await picture(page);
        const { width, height } = geometry;
        const { scene, density, histogram, coordinates } = await script.request({ type: "get", what: "slices", width, height });
        const layout = scene.coordinates;
        assert.equal(coordinates.length, 0);
        assert.deepEqual(
            histogram.levels.map(({ value }) => value),
            settings.levels,
        );
        await drawBy(page, "frames");
        const top = Math.floor((1 - layout.zero - layout.amplitude) * height);
        assertSimilar(below(geometry, top), below(await picture(page), top), { mean: 1.5, far: 0.005 });

        // The picture differs from the background where the density is highest, and equals it where the density is 0.
        const [panel, rows] = [layout.columns / 4, density.length / layout.columns];
        const at = (k) => {
            const [column, row] = [k % layout.columns, Math.floor(k / layout.columns)];
            const along = ((column % panel) / (panel - 1)) * layout.panel;
            const x = (layout.left + Math.floor(column / panel) * layout.line_step + along) * height;
            const level = 1 - (2 * row) / (rows - 1);
            return pixelAt(geometry, x, (1 - layout.zero - level * layout.amplitude) * height);
        };
        const heights = histogram.levels.map(({ value }) => (value - histogram.range[0]) / (histogram.range[1] - histogram.range[0]));
        const clear = [...density.keys()].filter((k) => {
            const [column, row] = [k % layout.columns, Math.floor(k / layout.columns)];
            const level = 1 - row / (rows - 1);
            return column < 3 * panel && row > 0 && level > 0.05 && heights.every((line) => Math.abs(line - level) > 0.05);
        });
        const most = clear.reduce((a, b) => (density[b] > density[a] ? b : a));
        const background = rgb(scene.colors.background);
        assert.ok(distance(at(most), background) > 60);
        const around = [-1, 0, 1].flatMap((d) => [d, d - layout.columns, d + layout.columns]);
        const none = clear.find((k) => around.every((d) => density[k + d] === 0));
        assert.ok(distance(at(none), background) < 8);
        assert.deepEqual(errors, []);
        await close();
    });
}

test("fields: the key of the coordinates hides the histogram", async () => {
    const { page, script, errors, close } = await openWithScript();
    const { revision } = await script.request({ type: "load", name: "formula", format: "formula", data: kTiger });
    await presented(page, revision);
    const before = await script.request({ type: "get", what: "slices" });
    assert.ok(before.scene.shown.coordinates && before.histogram);
    await page.keyboard.press("p");
    const state = await script.until((one) => one.revision > revision, "the hidden histogram");
    assert.equal(state.shown.coordinates, false);
    await presented(page, state.revision);
    const after = await script.request({ type: "get", what: "slices" });
    assert.equal(after.histogram, undefined);
    const { width, height, data } = await picture(page);
    const background = rgb(after.scene.colors.background);
    const colored = [...Array(width).keys()].filter(
        (x) => distance(pixelAt({ width, height, data }, x, Math.floor(height * 0.97)), background) > 40,
    );
    assert.ok(colored.length < width * 0.05, "nothing is drawn at the lower edge");
    assert.deepEqual(errors, []);
    await close();
});

test("fields: surfaces and fog are drawn again after the WebGL context was lost", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "load", name: "formula", format: "formula", data: kTiger });
    const { revision } = await script.request({ type: "set", fog: kFog });
    await presented(page, revision);
    const before = await picture(page);
    const extension = await page.evaluateHandle(() =>
        document.querySelector("#drawing .solids").getContext("webgl2").getExtension("WEBGL_lose_context"),
    );
    await extension.evaluate((one) => one.loseContext());
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await extension.evaluate((one) => one.restoreContext());
    await page.waitForSelector("#drawing[data-drawn-by=geometry]");
    await page.evaluate(() => document.getElementById("notice").replaceChildren());
    assert.ok(compare(await picture(page), before).mean < 0.1);
    assert.deepEqual(errors, []);
    await close();
});

test("fields: all encodings have the same surfaces", async () => {
    const script = await joinSession((await common()).url);
    for (const color of ["cell", "growth", "w", "value"]) {
        await script.request({ type: "load", name: "formula", format: "formula", data: "x^2 + y^2 - z^2 < w" });
        const caps = color === "cell" ? "value" : "plain";
        await script.request({ type: "set", color, caps, levels: [0, 1], slices: { count: 5 } });
        const surfaces = {};
        for (const encoding of kEncodings) {
            await script.client.hello({ encoding });
            const { slices } = await script.request({ type: "get", what: "slices", width: 160, height: 90 });
            surfaces[encoding] = slices.map(({ surface = {} }) =>
                Object.entries(surface).map(([name, value]) => [name, value.length ? [...value] : value]).sort(),
            );
        }
        assert.ok(surfaces.json.some((surface) => surface.length > 0));
        assert.equal(surfaces.json.some((surface) => surface.some(([name]) => name === "colors")), ["growth", "value"].includes(color));
        assert.equal(surfaces.json.some((surface) => surface.some(([name]) => name === "cap_colors")), caps === "value");
        assert.equal(surfaces.json.some((surface) => surface.some(([name]) => name === "color")), color === "w");
        for (const encoding of kBinaryEncodings) assert.deepEqual(surfaces[encoding], surfaces.json, encoding);
    }
    script.leave();
});

test("fields: the colorings are those of a field, and growth is amber and blue", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, "(x-w)^2+y^2+z^2 < 1"); // a ball that moves along x
    await page.click("#field-close");
    await spoken(page, "formula");
    const offered = () => page.locator("#tools label:has([name=color]):visible").allInnerTexts();
    assert.deepEqual(await offered(), ["Level", "w", "Plain", "Growth", "Value"]);
    assert.equal(await page.locator(".kinds > div").count(), 0, "no kinds of cells");
    await page.locator("#tools label", { hasText: "Growth" }).click();
    await script.until(({ color }) => color === "growth", "growth");
    // Otherwise, the edges of the box would cover some points of the surface.
    const { revision } = await script.request({ type: "set", shown: { bars: false, balls: false } });
    await presented(page, revision);
    assert.match(await page.locator(".scale").innerText(), /shrinks\s+grows/);
    await spoken(page, "colored by growth");
    const focus = await focusSurface(page, script);
    const shown = await picture(page);
    const { surface, slice, scene, size } = focus;
    let [ahead, behind] = [0, 0];
    for (let i = 0; i < surface.points.length; i += 3) {
        const [x, , z] = surface.normals.slice(i, i + 3);
        if (z < 0.3 || Math.abs(x) < 0.5) continue; // must face the viewer, at the sides
        const world = slice.position.map((at, k) => at + scene.scale * surface.points[i + k]);
        const [r, , b] = pixelAt(shown, ...project(scene, world, size).map(Math.floor));
        if (x > 0 && r > b) ++ahead;
        if (x < 0 && b > r) ++behind;
        assert.ok(x > 0 === r > b || distance([r], [b]) < 24, `normal ${x}: ${r}, ${b}`);
    }
    assert.ok(ahead > 5 && behind > 5, `${ahead}, ${behind}`);
    await script.request({ type: "set", polytope: "24-cell" });
    await named(page, "24-cell");
    await page.waitForFunction(() => document.querySelector("#tools [value=plain]").checked);
    assert.deepEqual(await offered(), ["Cell", "Kind", "w", "Plain", "Light"]);
    assert.deepEqual(errors, []);
    await close();
});

test("fields: the ends of the color scale are told apart where the values differ little", async () => {
    const { page, script, errors, close } = await openWithScript();
    const formulas = { data: "x^2 + y^2 + z^2 + w^2 < 1", values: "1027.5 + x/4" };
    await script.request({ type: "load", name: "formula", format: "formula", ...formulas });
    const { revision } = await script.request({ type: "set", color: "value" });
    await presented(page, revision);
    const [, least, most] = /([\d.]+)\s+([\d.]+)/.exec(await page.locator(".scale").innerText());
    assert.ok(1027 <= Number(least) && Number(least) < Number(most) && Number(most) <= 1028, `from ${least} to ${most}`);
    assert.deepEqual(errors, []);
    await close();
});
