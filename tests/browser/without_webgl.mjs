// The page in browsers without WebGL, or after the loss of WebGL.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, startBrowser } from "./support/browser.mjs";
import { within } from "./support/hang_limit.mjs";
import { covered, decode } from "./support/pixels.mjs";

test("without WebGL: the server renders, and the page says why", async () => {
    const browser = await startBrowser(["--disable-3d-apis"], { "webgl.disabled": true });
    const { page, press, errors, close } = await openWithScript({ browser });
    assert.equal(await page.getAttribute("#drawing", "data-mode"), "frames");
    const own = page.locator("[data-page-tool=geometry]");
    assert.equal(await own.isDisabled(), true);
    assert.match(await own.getAttribute("title"), /WebGL/);
    const before = await page.locator("#drawing").screenshot();
    assert.ok(covered(decode(before), [16, 20, 28]) > 0.02);
    const { revision } = await press("y");
    await presented(page, revision);
    assert.notDeepEqual(await page.locator("#drawing").screenshot(), before);
    assert.deepEqual(errors, []);
    await close();
    await browser.close();
});

/** Makes the page lose its WebGL context. The returned function restores the context. */
async function loseContext(page) {
    const extension = await page.evaluateHandle(() =>
        document.querySelector("#drawing .solids").getContext("webgl2").getExtension("WEBGL_lose_context"),
    );
    await extension.evaluate((one) => one.loseContext());
    return () => extension.evaluate((one) => one.restoreContext());
}

test("without WebGL: when the WebGL context is lost, the page switches to frames until it is restored", async () => {
    const { page, press, errors, close } = await openWithScript();
    assert.equal(await page.getAttribute("#drawing", "data-mode"), "geometry");
    const restore = await loseContext(page);
    await page.waitForSelector("#drawing[data-mode=frames]");
    assert.match(await page.locator("#notice").textContent(), /graphics/);
    const { revision } = await press("y");
    await presented(page, revision);
    const isPressed = (mode) => page.locator(`[data-page-tool=${mode}]`).getAttribute("aria-pressed");
    assert.equal(await isPressed("frames"), "true");

    await page.click("[data-page-tool=geometry]");
    assert.match(await page.locator("#notice").textContent(), /graphics.*unavailable/);
    assert.equal(await page.getAttribute("#drawing", "data-mode"), "frames", "the server's pictures stay");
    assert.equal(await isPressed("frames"), "true");

    await restore();
    await page.waitForSelector("#drawing[data-mode=geometry][data-drawn-by=geometry]");
    assert.equal(await isPressed("geometry"), "true");
    const later = await press("y");
    await presented(page, later.revision);
    assert.ok(covered(decode(await page.locator("#drawing").screenshot()), [16, 20, 28]) > 0.02);
    assert.deepEqual(errors, []);
    await close();
});

test("without WebGL: a restored context does not change the renderer that the user chose", async () => {
    const { page, errors, close } = await openWithScript();
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    const changes = await page.evaluateHandle(() =>
        // The listeners of the page run before these listeners, because they were added earlier.
        ["lost", "restored"].map((change) => {
            const canvas = document.querySelector("#drawing .solids");
            return new Promise((resolve) => canvas.addEventListener(`webglcontext${change}`, resolve, { once: true }));
        }),
    );
    const restore = await loseContext(page);
    await restore();
    await within(changes.evaluate(async (all) => void (await Promise.all(all))), "the restored context");
    assert.equal(await page.getAttribute("#drawing", "data-mode"), "frames");
    await page.click("[data-page-tool=geometry]");
    await page.waitForSelector("#drawing[data-mode=geometry][data-drawn-by=geometry]");
    assert.ok(covered(decode(await page.locator("#drawing").screenshot()), [16, 20, 28]) > 0.02);
    assert.deepEqual(errors, []);
    await close();
});
