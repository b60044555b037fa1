// The background of the picture, and the color scheme of the page.
import assert from "node:assert/strict";

import { openWithScript, presented, ready } from "./support/browser.mjs";
import { bytesOf } from "./support/downloads.mjs";
import { assertSimilar, drawBy, picture } from "./support/drawing.mjs";
import { eventually } from "./support/hang_limit.mjs";
import { decode, distance, pixelAt } from "./support/pixels.mjs";
import { test } from "./support/suite.mjs";
import { pngText } from "./node_modules/.oval4d/client.mjs";

const kGrounds = { dark: [16, 20, 28], light: [244, 246, 249], white: [255, 255, 255] };

/** The color of the picture's background on the page, at a place without slices. */
const groundOf = async (page) => pixelAt(await picture(page), 600, 60);

const checked = (page) => page.locator("#tools [name=background]:checked").inputValue();

test("background: both streams draw every background, and the tools follow the session", async () => {
    const { page, script, errors, close } = await openWithScript();
    assert.equal(await checked(page), "auto");
    await script.request({ type: "set", polytope: "24-cell", highlight: { element: "cell", number: 5 } });
    for (const background of ["light", "transparent", "white"]) {
        const { revision } = await script.request({ type: "set", background });
        await presented(page, revision);
        const ground = kGrounds[background] ?? kGrounds.white;
        const geometry = await picture(page);
        assert.deepEqual(pixelAt(geometry, 600, 60), ground, background);
        assert.equal(await checked(page), background);
        if (background === "light") continue;
        await drawBy(page, "frames");
        const frame = await picture(page);
        assert.deepEqual(pixelAt(frame, 600, 60), ground, `${background} frames`);
        assertSimilar(geometry, frame, { mean: 1, far: 0.005 });
        await drawBy(page, "geometry");
    }
    await page.locator("#tools label:has([name=background][value=dark])").click();
    const { revision } = await script.until(({ background }) => background === "dark", "the tools' background");
    await presented(page, revision);
    assert.deepEqual(await groundOf(page), kGrounds.dark);
    await page.keyboard.press("u");
    await script.until(({ background }) => background === "white", "undo");
    assert.deepEqual(errors, []);
    await close();
});

test("background: a picture is exported on another background than that of the session", async () => {
    const { page, script, errors, close } = await openWithScript();
    const size = { width: 320, height: 180 };
    const ask = async (background) => script.request({ type: "get", what: "frame", ...size, background });
    const clear = decode(await ask("transparent"));
    assert.deepEqual([...clear.data.subarray(0, 4)], [0, 0, 0, 0], "the corner is transparent");
    const white = await ask("white");
    assert.deepEqual(pixelAt(decode(white), 1, 1), kGrounds.white);
    assert.equal(JSON.parse(pngText(white)).background, "white", "the state of the picture");
    assert.equal((await script.state()).background, "auto", "the session stays as it is");

    await page.keyboard.press("x");
    for (const [name, value] of [["format", "png"], ["background", "transparent"]]) {
        await page.locator(`#export label:has([name=${name}][value=${value}])`).click();
    }
    const saving = page.waitForEvent("download");
    await page.click("#export-submit");
    const saved = await bytesOf(await saving);
    assert.equal(saved[25], 6, "a PNG file with alpha");
    assert.deepEqual(errors, []);
    await close();
});

test("scheme: the page and its picture follow the system, and each viewer sees his own", async () => {
    const { page, script, errors, close } = await openWithScript({ colorScheme: "light" });
    const panel = () => page.evaluate(() => getComputedStyle(document.getElementById("tools")).backgroundColor);
    assert.equal(await panel(), "rgb(255, 255, 255)");
    assert.deepEqual(await groundOf(page), kGrounds.light);
    const { scene } = await script.request({ type: "get", what: "slices" });
    assert.equal(scene.colors.background, 0x10141c, "a viewer who has not named a scheme sees a dark picture");
    await drawBy(page, "frames");
    assert.deepEqual(await groundOf(page), kGrounds.light, "in frames, too");
    await drawBy(page, "geometry");

    await page.emulateMedia({ colorScheme: "dark" });
    await page.waitForFunction(() => document.documentElement.dataset.ground === "dark");
    await drawn(page, kGrounds.dark);
    assert.notEqual(await panel(), "rgb(255, 255, 255)");
    assert.equal((await script.state()).background, "auto", "the session stays as it is");

    await page.click("[data-page-tool=scheme_light]");
    await drawn(page, kGrounds.light);
    assert.equal(await page.getAttribute("[data-page-tool=scheme_light]", "aria-pressed"), "true");
    await script.request({ type: "set", background: "dark" });
    await drawn(page, kGrounds.dark); // the background of the session comes first
    await page.reload();
    await ready(page);
    assert.equal(await panel(), "rgb(255, 255, 255)", "the choice is remembered");
    await drawn(page, kGrounds.dark);
    assert.deepEqual(errors, []);
    await close();
});

/** Waits until the picture has this background color. */
function drawn(page, ground) {
    return eventually(async () => distance(await groundOf(page), ground) === 0, `a picture on ${ground}`);
}
