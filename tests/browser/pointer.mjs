// Mouse and touch gestures on the drawing.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented } from "./support/browser.mjs";
import { compare, decode } from "./support/pixels.mjs";

const shot = async (page) => decode(await page.locator("#drawing").screenshot());

test("pointer: dragging orbits the view, at once and in the session", async () => {
    const { page, script, errors, close } = await openWithScript();
    const before = await shot(page);
    await page.mouse.move(500, 300);
    await page.mouse.down();
    await page.mouse.move(440, 330, { steps: 6 });
    await page.mouse.up();
    const { camera, revision } = await script.until((one) => one.camera.azimuth > 0.1, "the orbit in the session");
    assert.ok(camera.elevation > 0.05, "dragging down raises the camera");
    await presented(page, revision);
    const after = await shot(page);
    assert.ok(compare(before, after).mean > 1);
    // The server's picture of that state is the same.
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await page.locator("#drawing").focus();
    assert.ok(compare(await shot(page), after).mean < 1);
    assert.deepEqual(errors, []);
    await close();
});

test("pointer: the view follows the mouse before the server has answered", async () => {
    const { page, close } = await openWithScript();
    const before = await shot(page);
    await page.evaluate(() => (WebSocket.prototype.send = () => {})); // the server receives nothing more
    await page.mouse.move(500, 300);
    await page.mouse.down();
    await page.mouse.move(380, 300, { steps: 4 });
    await page.mouse.up();
    assert.ok(compare(before, await shot(page)).mean > 1);
    await close();
});

test("pointer: the wheel zooms, a double click resets the viewpoint, undo does not affect it", async () => {
    const { page, script, press, close } = await openWithScript();
    await press("4");
    await page.mouse.move(500, 300);
    await page.mouse.wheel(0, -300);
    await script.until((one) => one.camera.zoom > 1.2, "zooming in");
    await page.mouse.wheel(0, 900);
    await script.until((one) => one.camera.zoom < 0.8, "zooming out");
    const { camera } = await press("u");
    assert.ok(camera.zoom < 0.8, "undo reverts the rotation, not the zoom");
    await page.mouse.dblclick(500, 300);
    await script.until((one) => one.camera.zoom === 1 && one.camera.azimuth === 0, "the initial viewpoint");
    await close();
});

test("pointer: one finger orbits, two fingers zoom", async () => {
    const { page, script, close } = await openWithScript({ hasTouch: true });
    const touch = await page.context().newCDPSession(page);
    const send = (type, ...points) =>
        touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await send("touchStart", [500, 300]);
    for (const x of [480, 450, 420]) await send("touchMove", [x, 300]);
    await send("touchEnd");
    const turned = await script.until((one) => one.camera.azimuth > 0.1, "the orbit by a finger");
    assert.equal(turned.camera.zoom, 1);
    await send("touchStart", [480, 300], [520, 300]);
    for (const d of [30, 45, 60]) await send("touchMove", [500 - d, 300], [500 + d, 300]);
    await send("touchEnd");
    await script.until(({ camera }) => Math.abs(camera.zoom - 3) < 0.01, "a zoom of 3");
    await close();
});
