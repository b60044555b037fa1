// The controls of the frame of reference in the field panel.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, idle, openPage, named, ready, scriptFor, openWithScript, spoken } from "./support/browser.mjs";
import { focusSurface, openPanel, write } from "./support/field.mjs";
import { startProxy } from "./support/proxy.mjs";

const kMovingBall = "(x-0.5*t)^2 + y^2 + z^2 < 0.09";

const velocity = (page, name, axis) => page.locator(`[data-velocity='${name} ${axis}']`);

/** The x of the middle of the focus slice's surface. */
async function middle(page, script) {
    const { surface } = await focusSurface(page, script);
    const xs = surface.points.filter((_, i) => i % 3 === 0);
    return (Math.min(...xs) + Math.max(...xs)) / 2;
}

test("observer: a velocity that is typed is followed, and a boost is applied", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, kMovingBall);
    await script.request({ type: "set", slices: { w: 1 } });
    assert.ok(Math.abs((await middle(page, script)) - 0.5) < 0.05, "the ball has moved");
    await velocity(page, "follow", "x").fill("0.5");
    await script.until(({ follow }) => follow.join() === "0.5,0,0", "the velocity to follow");
    assert.ok(Math.abs(await middle(page, script)) < 0.05, "the ball stands still");
    await velocity(page, "boost", "y").fill("-0.6");
    await script.until(({ boost }) => boost.join() === "0,-0.6,0", "the boost");
    await spoken(page, "follow 0.5, 0, 0, boost 0, −0.6, 0");
    await write(page, script, `${kMovingBall} + 0.01`);
    assert.deepEqual((await script.state()).follow, [0.5, 0, 0], "editing the formula keeps the observer");
    assert.deepEqual(errors, []);
    await close();
});

test("observer: mistakes are explained, and the controls show the session's observer", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, kMovingBall);
    const before = (await script.state()).revision;
    const says = (pattern) =>
        page.waitForFunction(
            (source) => new RegExp(source).test(document.getElementById("observer-error").textContent),
            pattern.source,
        );
    for (const [name, text, expected] of [
        ["boost", "fast", /a number for each/],
        ["boost", "1.5", /−0\.999 to 0\.999/],
        ["follow", "", /a number for each/],
    ]) {
        await velocity(page, name, "x").fill(text);
        await says(expected);
        assert.equal(await velocity(page, name, "x").getAttribute("aria-invalid"), "true");
    }
    assert.equal((await script.state()).revision, before);
    await page.focus("#field-formula");
    await script.request({ type: "set", pace: 0.5, follow: [0.1, 0.2, 0.3], boost: [0, 0, 0.4] });
    await page.waitForFunction(() => document.getElementById("observer-pace-value").textContent === "0.5");
    for (const [i, axis] of ["x", "y", "z"].entries()) {
        assert.equal(await velocity(page, "follow", axis).inputValue(), String([0.1, 0.2, 0.3][i]));
        assert.equal(await velocity(page, "boost", axis).inputValue(), String([0, 0, 0.4][i]));
    }
    assert.equal(await page.locator("#observer-error").textContent(), "");
    assert.deepEqual(errors, []);
    await close();
});

test("observer: the slider sets the pace, and a drag is one step of undo", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, kMovingBall);
    const before = await script.state();
    await page.locator("#observer-pace").scrollIntoViewIfNeeded();
    const { x, y, width, height } = await page.locator("#observer-pace").boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    for (let i = 1; i <= 8; ++i) {
        await page.mouse.move(x + width * (0.5 + 0.04 * i), y + height / 2);
        await idle(page); // so that the page sends each value
    }
    await page.mouse.up();
    const { pace } = await script.until((state) => state.pace > 3, "a faster pace");
    await page.waitForFunction((text) => document.getElementById("observer-pace-value").textContent === text, String(pace));
    assert.equal(await page.getAttribute("#observer-pace", "aria-valuetext"), String(pace));
    await page.focus("#observer-pace");
    await page.keyboard.press("ArrowLeft");
    await script.until((state) => state.pace < pace, "a slower pace");
    await script.request({ type: "undo" });
    assert.equal((await script.state()).pace, pace, "a key is a step of its own");
    // The thumb shows the value after an undo, although the slider has the focus.
    const isAtThumb = (value) => Math.abs(document.getElementById("observer-pace").value - Math.log10(value)) < 0.02;
    await page.waitForFunction(isAtThumb, pace);
    await script.request({ type: "set", pace: 0.25 });
    await page.waitForFunction(isAtThumb, 0.25);
    await script.request({ type: "undo" });
    await script.request({ type: "undo" });
    const after = await script.state();
    assert.deepEqual([after.pace, after.slices], [before.pace, before.slices]);
    assert.deepEqual(errors, []);
    await close();
});

test("observer: a pace that cannot be applied is taken back, and the reason is shown", async () => {
    const proxy = await startProxy((await common()).url, "/pace");
    const { page, errors, close } = await openPanel({ url: proxy.url });
    await page.focus("#observer-pace");
    proxy.cut();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await page.keyboard.press("End");
    await page.waitForFunction(() => /no connection/.test(document.getElementById("observer-error").textContent));
    assert.equal(await page.inputValue("#observer-pace"), "0");
    assert.equal(await page.locator("#observer-pace-value").textContent(), "1");
    proxy.restore();
    await page.waitForSelector("#connection[data-kind=open]");
    await page.keyboard.press("End");
    await page.waitForFunction(() => document.getElementById("observer-error").textContent === "");
    await page.waitForFunction(() => document.getElementById("observer-pace-value").textContent === "10");
    assert.deepEqual(errors.filter((error) => !/WebSocket|ws:/.test(error)), []);
    await close();
    await proxy.stop();
});

test("observer: an address and the command line move the observer of a polytope", async () => {
    const permissions = ["clipboard-read", "clipboard-write"];
    const { page, script, errors, close } = await openPanel({ permissions });
    await write(page, script, kMovingBall);
    await script.request({ type: "set", pace: 2, boost: [0.25, 0, 0] });
    await page.waitForFunction(() => document.getElementById("observer-pace-value").textContent === "2");
    await page.click("#field-link");
    await page.waitForFunction(() => /copied/.test(document.getElementById("notice").textContent));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.endsWith("&pace=2&boost=0.25,0,0"), link);
    const second = await openPage({ url: link });
    await ready(second.page);
    await named(second.page, "formula");
    const other = await scriptFor(second.page);
    const state = await other.until(({ pace, boost }) => pace === 2 && boost[0] !== 0, "the observer of the address");
    assert.deepEqual([state.pace, state.follow, state.boost], [2, [0, 0, 0], [0.25, 0, 0]]);
    other.leave();
    await second.close();
    await close();
    const line = await openWithScript();
    await line.page.keyboard.press(":");
    await line.page.waitForSelector("#command:focus");
    await line.page.keyboard.type("boost x 0.6");
    await line.page.keyboard.press("Enter");
    await line.script.until(({ boost }) => boost.join() === "0.6,0,0", "the boost of the command line");
    assert.deepEqual([...errors, ...line.errors], []);
    await line.close();
});
