// The page in Firefox: what the other tests examine in Chromium, in less detail.
import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";

import { effectOf, prepare, strokes, table } from "./support/keys.mjs";
import { common, shownValues } from "./support/browser.mjs";
import { eventually } from "./support/hang_limit.mjs";
import { openInFirefox, presented, type } from "./support/firefox.mjs";
import { compare, covered, decode } from "./support/pixels.mjs";
import { assertMatrix } from "./support/rotation.mjs";
import { test } from "./support/suite.mjs";

const kBackground = [16, 20, 28];

async function picture(page) {
    await page.evaluate(() => document.activeElement.blur()); // removes the frame around the drawing
    const drawing = await page.$("#drawing");
    return decode(await drawing.screenshot());
}

/** Switches the rendering mode and waits for a picture rendered in that mode. */
async function drawBy(page, mode) {
    await page.click(`[data-page-tool=${mode}]`);
    await page.waitForSelector(`#drawing[data-drawn-by=${mode}]`);
}

/** Waits until an element's text matches. */
async function says(page, selector, pattern) {
    await page.waitForFunction(
        (which, source) => new RegExp(source, "s").test(document.querySelector(which).textContent),
        {},
        ...[selector, pattern.source],
    );
}

test("firefox: draws the slices with WebGL, and the server's frames agree", async () => {
    const { page, script, errors, close } = await openInFirefox({ viewport: { width: 1280, height: 720 } });
    assert.equal(await page.$eval("#drawing", (one) => one.dataset.drawnBy), "geometry");
    const views = [
        [{ polytope: "600-cell" }, 1, 0.005],
        [{ polytope: "24-cell", projection: "perspective" }, 1, 0.005],
        [{ polytope: "small stellated 120-cell", projection: "off", view: "single" }, 1.6, 0.015],
    ];
    for (const [settings, most, allowed] of views) {
        const { revision } = await script.request({ type: "set", ...settings });
        await presented(page, revision);
        const geometry = await picture(page);
        assert.ok(covered(geometry, kBackground) > 0.05);
        await drawBy(page, "frames");
        const { mean, far } = compare(geometry, await picture(page));
        assert.ok(mean < most, `${settings.polytope}: mean difference ${mean.toFixed(2)} of 255`);
        assert.ok(far < allowed, `${settings.polytope}: ${(100 * far).toFixed(2)} % of the pixels differ much`);
        await drawBy(page, "geometry");
        assert.ok(compare(await picture(page), geometry).mean < 0.1, "switching back restores the first picture");
    }
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: every key has its effect", async () => {
    const { page, script, press, errors, close } = await openInFirefox({ viewport: { width: 640, height: 480 } });
    for (const binding of table.filter(({ client }) => !client)) {
        const before = await prepare(script, binding);
        const after = await press(...strokes(binding));
        effectOf(binding)(before, after, binding);
        assert.equal((await shownValues(page)).polytope, after.polytope.name, binding.name);
        if (binding.shift === "inverse") {
            const back = await press(...strokes(binding, true));
            assertMatrix(back.orientation, before.orientation);
        }
        if (binding.action === "turn") {
            await script.until((one) => one.revision > after.revision + 2, "the turning to continue");
            await type(page, "Space");
            await script.until((one) => !one.turning, "the turning to stop");
        }
    }
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: the command line executes commands and explains errors", async () => {
    const { page, script, errors, close } = await openInFirefox();
    await type(page, ":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type("polytope 25-cell\n");
    await says(page, "#command-error", /25-cell.*did you mean.*cell/);
    await page.$eval("#command", (input) => input.select());
    await page.keyboard.type("polytope 16-cell\n");
    await script.until((one) => one.polytope.name === "16-cell", "the 16-cell");
    await page.waitForSelector("#drawing:focus");
    await type(page, "?");
    await page.waitForSelector("#help[open]");
    await type(page, "Escape");
    await page.waitForSelector("#help:not([open])");
    await page.waitForSelector("#drawing:focus");
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: the picker finds and shows a polytope", async () => {
    const { page, script, errors, close } = await openInFirefox();
    await type(page, "s");
    await page.waitForSelector("#picker-list [role=option]");
    await page.keyboard.type("tesser");
    await page.waitForSelector('#picker-list [aria-selected=true][data-name="8-cell"]');
    await type(page, "Enter");
    const { revision } = await script.until((one) => one.polytope.name === "8-cell", "the tesseract");
    await page.waitForSelector("#drawing:focus");
    await presented(page, revision);
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: dragging orbits the view, the wheel zooms, a double click resets the viewpoint", async () => {
    const { page, script, errors, close } = await openInFirefox();
    const before = await picture(page);
    await page.mouse.move(500, 300);
    await page.mouse.down();
    await page.mouse.move(440, 330, { steps: 6 });
    await page.mouse.up();
    const { camera, revision } = await script.until((one) => one.camera.azimuth > 0.1, "the orbit in the session");
    assert.ok(camera.elevation > 0.05, "dragging down raises the camera");
    await presented(page, revision);
    assert.ok(compare(before, await picture(page)).mean > 1);
    await page.mouse.wheel({ deltaY: 300 });
    await script.until((one) => one.camera.zoom < 0.9, "zooming out");
    await page.mouse.click(500, 300, { count: 2 });
    await script.until((one) => one.camera.zoom === 1 && one.camera.azimuth === 0, "the initial viewpoint");
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: the slider snaps to a mark, and plays", async () => {
    const { page, script, errors, close } = await openInFirefox({ viewport: { width: 1280, height: 720 } });
    await script.request({ type: "set", polytope: "24-cell" });
    await script.request({ type: "toward", element: "cell", immediately: true });
    // The exact values replace the rounded ones.
    await page.waitForFunction("Math.abs(document.getElementById('focus-w').max - Math.SQRT2) < 1e-12");
    const box = await (await page.$("#focus-marks")).boundingBox();
    const y = box.y + box.height / 2;
    await page.mouse.move(box.x + 0.5 * box.width, y);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.8 * box.width, y, { steps: 5 });
    await script.until(({ section: { w } }) => w > 0 && w < 1.4, "a drag");
    await page.mouse.move(box.x + box.width - 3, y, { steps: 5 });
    await page.mouse.up();
    await script.until(({ section }) => section.name === "octahedron", "the cell at the highest w");
    await page.click("#focus-play");
    await script.until(({ section }) => section.name === "", "playing");
    await page.click("#focus-play");
    await page.waitForSelector("#focus-play[aria-pressed=false]");
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: exports a file", async () => {
    const { page, errors, downloads, close } = await openInFirefox({ url: `${(await common()).url}?polytope=8-cell` });
    await type(page, "x");
    await page.waitForSelector("#export[open]");
    await page.click('#export label:has([name=format][value="stl"])');
    await page.click("#export-submit");
    const name = "8-cell-w-0.stl";
    const complete = async () => {
        const files = await readdir(downloads);
        return files.includes(name) && files.length === 1; // while it downloads, there is also a .part file
    };
    await eventually(complete, "the download");
    const bytes = await readFile(join(downloads, name));
    assert.equal(bytes.length, 84 + 50 * bytes.readUInt32LE(80));
    await page.waitForSelector("#drawing:focus");
    assert.deepEqual(errors, []);
    await close();
});

test("firefox: a shared link opens the session in a second tab", async () => {
    const first = await openInFirefox();
    await first.press("y");
    await first.page.click("#share-button");
    await says(first.page, "#notice", /copied/);
    const link = await first.page.evaluate(() => navigator.clipboard.readText());
    const second = await openInFirefox({ url: link });
    assert.equal(second.page.url(), (await common()).url, "the token does not stay in the URL");
    assert.deepEqual((await second.script.state()).last.planes, ["xy", "zw"]);
    const { revision, polytope } = await second.press("n");
    await first.page.bringToFront();
    await presented(first.page, revision);
    assert.equal((await shownValues(first.page)).polytope, polytope.name);
    assert.deepEqual([...first.errors, ...second.errors], []);
    await second.close();
    await first.close();
});

test("firefox: the picture is as large as the window allows after a resize", async () => {
    const { page, press, errors, close } = await openInFirefox();
    for (const viewport of [{ width: 1200, height: 800 }, { width: 375, height: 667 }]) {
        await page.setViewport(viewport);
        await page.waitForFunction((width) => innerWidth === width, {}, viewport.width);
        await page.waitForFunction(() => {
            const { clientWidth, clientHeight } = document.getElementById("drawing");
            const { width, height } = document.querySelector("#drawing .solids");
            return width === clientWidth && height === clientHeight;
        });
        await page.focus("#drawing");
        await press("4");
        const shown = await picture(page);
        assert.ok(covered(shown, kBackground) > 0.02);
        const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        assert.ok(overflow <= 0, "nothing overflows");
    }
    assert.deepEqual(errors, []);
    await close();
});
