// A phone turns the polytope when the user turns the phone.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, stateAfter } from "./support/browser.mjs";
import { assertMatrix, isNear, turned } from "./support/rotation.mjs";

const phone = { viewport: { width: 375, height: 667 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };
const kDegree = Math.PI / 180;

/**
 * Runs in the page. Replaces the sensors: the test sets the device's orientation, the screen's angle and the
 * permission.
 */
function simulateSensors() {
    const ignoreTrue = (event) => event.isTrusted && event.stopImmediatePropagation();
    window.addEventListener("deviceorientation", ignoreTrue, true);
    window.simulated = { angle: 0, permission: "granted" };
    Object.defineProperty(ScreenOrientation.prototype, "angle", { get: () => window.simulated.angle });
    DeviceOrientationEvent.requestPermission = async () => window.simulated.permission;
}

async function openPhone() {
    const opened = await openWithScript({ ...phone, before: simulateSensors });
    const { page, script } = opened;
    return {
        ...opened,
        simulate: (values) => page.evaluate((given) => void Object.assign(window.simulated, given), values),
        /** Holds the phone at these angles in degrees. Resolves to the state afterward. */
        async hold(alpha, beta, gamma) {
            const angles = { alpha, beta, gamma };
            const report = (given) => void window.dispatchEvent(new DeviceOrientationEvent("deviceorientation", given));
            await page.evaluate(report, angles);
            return stateAfter(page, script);
        },
        /** Taps the button for a kind of ball, and waits until the button is pressed or no longer pressed. */
        async toggle(ball, isPressed) {
            await page.locator(`[data-page-tool="tilt_${ball}"]`).tap();
            await page.waitForSelector(`[data-page-tool="tilt_${ball}"][aria-pressed=${isPressed}]`);
        },
    };
}

const assertTurned = ({ orientation }, start, plane, degrees) =>
    assert.ok(isNear(orientation, turned(start, [plane], [degrees * kDegree]), 1e-6), `${degrees}° in ${plane}`);

test("tilt: each slice turns as the phone does, in one undo step", async () => {
    const { page, script, press, hold, toggle, errors, close } = await openPhone();
    const { orientation: start, revision } = await script.state();
    await hold(30, 20, 10);
    await toggle("3-D", true);
    for (const [alpha, beta] of [[350, 0], [350, 0.1], [349.9, 0], [350, 0]]) {
        assert.equal((await hold(alpha, beta, 0)).revision, revision, "a phone that is not held quite still");
    }
    assertTurned(await hold(350, 20, 0), start, "yz", 20); // like the phone's own axes, y turns toward z
    assertTurned(await hold(350, 0, 0), start, "yz", 0);
    assertTurned(await hold(350, 0, 30), start, "xz", -30);
    assertTurned(await hold(350, 0, 0), start, "xz", 0);
    for (const angles of [[350, 30, 0], [20, 30, 0], [20, 30, 40], [20, 0, 0]]) await hold(...angles);
    assertTurned(await hold(10, 0, 0), start, "xy", 20);
    await toggle("3-D", false);
    assertTurned(await hold(50, 0, 0), start, "xy", 20);
    assertMatrix((await press("u")).orientation, start);

    // Another command ends the undo step.
    await toggle("3-D", true);
    await hold(0, 0, 0);
    await hold(0, 20, 0);
    const { orientation: between } = await press("2");
    assertTurned(await hold(0, 30, 0), between, "yz", 10);
    assertMatrix((await press("u")).orientation, between);
    await page.evaluate(() => {
        Object.defineProperty(document, "hidden", { get: () => true });
        document.dispatchEvent(new Event("visibilitychange"));
    });
    await page.waitForSelector('[data-page-tool="tilt_3-D"][aria-pressed=false]');
    assert.deepEqual(errors, []);
    await close();
});

test("tilt: in 4-D, the side toward +w follows the phone, also on its side", async () => {
    const { page, script, simulate, hold, toggle, errors, close } = await openPhone();
    const { orientation: start } = await script.state();
    await simulate({ angle: 90 }); // the phone's right side is at the top
    await toggle("4-D", true);
    await hold(0, 0, 0);
    const right = await hold(0, 20, 0);
    assertTurned(right, start, "xw", -20);
    assert.ok(right.orientation[0][3] > 0, "+w moves toward +x");
    assertTurned(await hold(0, 0, 0), start, "xw", 0);
    assertTurned(await hold(20, 0, 0), start, "zw", -20);
    await toggle("3-D", true);
    await page.waitForSelector('[data-page-tool="tilt_4-D"][aria-pressed=false]');
    assert.deepEqual(errors, []);
    await close();
});

test("tilt: the page says why it cannot be used, and offers it only on touch screens", async () => {
    const { page, simulate, hold, toggle, errors, close } = await openPhone();
    const says = (text) =>
        page.waitForFunction((part) => document.getElementById("notice").textContent.includes(part), text);
    await simulate({ permission: "denied" });
    await toggle("4-D", false);
    await says("This browser does not tell the page how the device is held.");
    await simulate({ permission: "granted" });
    await toggle("4-D", true);
    await hold(null, null, null); // like a device without sensors
    await says("This device does not tell how it is held.");
    await page.waitForSelector('[data-page-tool="tilt_4-D"][aria-pressed=false]');
    assert.deepEqual(errors, []);
    await close();

    const desktop = await openWithScript();
    assert.equal(await desktop.page.locator('[data-page-tool="tilt_4-D"]').count(), 0);
    await desktop.close();
});
