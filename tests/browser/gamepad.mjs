// Gamepads turn the polytope.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, stateAfter } from "./support/browser.mjs";
import { passTime } from "./support/page_time.mjs";
import { assertMatrix, isNear, turned } from "./support/rotation.mjs";

/** Waits for `count` animation frames of the page. */
const animationFrames = (page, count) =>
    page.evaluate(async (all) => {
        for (let i = 0; i < all; ++i) await new Promise((resolve) => requestAnimationFrame(resolve));
    }, count);

test("gamepad: the sticks and triggers turn the polytope", async () => {
    const { page, script, errors, press, close } = await openWithScript({
        isStopped: true,
        before: () => {
            const buttons = Array.from({ length: 17 }, () => ({ pressed: false, touched: false, value: 0 }));
            window.gamepad = { connected: true, mapping: "standard", axes: [0, 0, 0, 0], buttons };
            window.polls = 0;
            navigator.getGamepads = () => (++window.polls, [null, window.gamepad]);
        },
    });
    const polls = () => page.evaluate(() => window.polls);
    /** Lets time pass in the page, then waits until the gamepad has been polled. */
    const poll = async (milliseconds) => {
        await passTime(page, milliseconds);
        const before = await polls();
        await page.waitForFunction((count) => window.polls > count, before);
    };
    const { orientation: start, revision } = await script.state();
    assert.equal(await polls(), 0, "no gamepad is polled before one is connected");
    const connected = () => page.evaluate(() => window.dispatchEvent(new Event("gamepadconnected")));
    await page.evaluate(() => Object.assign(window.gamepad, { mapping: "", axes: [-1, 1, -1, 0.3] }));
    await connected();
    await passTime(page, 1000);
    await animationFrames(page, 5);
    assert.equal((await stateAfter(page, script)).revision, revision, "a device with other axes turns nothing");
    await page.evaluate(() => Object.assign(window.gamepad, { mapping: "standard" }));
    await connected();
    for (let i = 0; i < 3; ++i) await poll(50);
    assert.equal((await stateAfter(page, script)).revision, revision, "nor does one that has not been at rest yet");
    await page.evaluate(() => (window.gamepad.axes = [0, 0, 0, 0]));
    await page.evaluate(() => (window.gamepad.axes[1] = 0.1)); // within the dead zone
    for (let i = 0; i < 5; ++i) await poll(20);
    assert.equal((await stateAfter(page, script)).revision, revision);
    const controls = {
        xw: (pad, value) => (pad.axes[0] = value),
        yw: (pad, value) => (pad.axes[1] = value),
        xz: (pad, value) => (pad.axes[2] = value),
        yz: (pad, value) => (pad.axes[3] = value),
        zw: (pad, value) => (pad.buttons[7].value = value),
        xy: (pad, value) => (pad.buttons[5].value = value),
    };
    for (const [plane, control] of Object.entries(controls)) {
        await poll(1000); // ends the previous gesture
        const before = await script.state();
        await page.evaluate(`(${control})(window.gamepad, 1)`);
        for (let i = 0; i < 3; ++i) {
            await poll(50);
            await script.until((one) => one.revision > before.revision + i, `a turn in ${plane}`);
        }
        await page.evaluate(`(${control})(window.gamepad, 0)`);
        const { orientation, last } = await stateAfter(page, script);
        assert.deepEqual(last.planes, [plane]);
        const [a, b] = [..."xyzw"].flatMap((axis, i) => (plane.includes(axis) ? [i] : []));
        const angle = Math.atan2(orientation[b][a], orientation[a][a]);
        assert.ok(isNear(orientation, turned(before.orientation, [plane], [angle]), 1e-6), `only in ${plane}`);
        assertMatrix((await press("u")).orientation, start);
    }
    await page.evaluate(() => (window.gamepad.connected = false));
    await animationFrames(page, 2);
    const before = await polls();
    await animationFrames(page, 5);
    assert.equal(await polls(), before, "a disconnected gamepad is not polled");
    assert.deepEqual(errors, []);
    await close();
});
