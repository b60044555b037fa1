// Browsers without WebGL.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, startBrowser } from "./support/browser.mjs";
import { covered, decode } from "./support/pixels.mjs";

test("without WebGL: the server renders, and the page says why", async () => {
    const browser = await startBrowser(["--disable-3d-apis"]);
    const { page, press, errors, close } = await openWithScript({ browser });
    assert.equal(await page.getAttribute("#drawing", "data-mode"), "frames");
    const own = page.locator("[data-own=geometry]");
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

test("without WebGL: when the WebGL context is lost, the page switches to frames", async () => {
    const { page, press, errors, close } = await openWithScript();
    assert.equal(await page.getAttribute("#drawing", "data-mode"), "geometry");
    await page.evaluate(() => {
        document
            .querySelector("#drawing .solids")
            .getContext("webgl2")
            .getExtension("WEBGL_lose_context")
            .loseContext();
    });
    await page.waitForSelector("#drawing[data-mode=frames]");
    assert.match(await page.locator("#notice").textContent(), /graphics/);
    const { revision } = await press("y");
    await presented(page, revision);
    assert.equal(await page.locator("[data-own=frames]").getAttribute("aria-pressed"), "true");
    assert.deepEqual(errors, []);
    await close();
});
