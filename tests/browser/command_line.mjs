// The command line and the help sheet.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openPage, openWithScript, ready } from "./support/browser.mjs";

const error = (page) => page.locator("#command-error").textContent();

async function type(page, line) {
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type(line);
    await page.keyboard.press("Enter");
}

test("command line: executes the typed command, and returns the focus", async () => {
    const { page, script, close } = await openWithScript();
    await type(page, "polytope 24-cell");
    await script.until((one) => one.polytope.name === "24-cell", "the 24-cell");
    await page.waitForSelector("#drawing:focus");
    await type(page, ":rotate xw,yz pi/8 pi/sqrt(3)-pi/8"); // the colon may be typed again
    const { last } = await script.until((one) => one.last !== null, "the rotation");
    assert.deepEqual(last.planes, ["xw", "yz"]);
    assert.ok(Math.abs(last.angles[1] - (Math.PI / Math.sqrt(3) - Math.PI / 8)) < 1e-12);
    await close();
});

test("command line: errors are readable, and the typed line stays for correction", async () => {
    const { page, script, errors, close } = await openWithScript();
    const before = await script.state();
    await type(page, "polytope 25-cell");
    await page.waitForFunction(() => document.getElementById("command-error").textContent !== "");
    assert.match(await error(page), /25-cell.*did you mean.*cell/);
    assert.equal(await page.inputValue("#command"), "polytope 25-cell");
    const lines = { "set slices=four": /four/, "rotate xq 1": /xq/, "set alpha=1/0": /./, dance: /dance/ };
    for (const [line, expected] of Object.entries(lines)) {
        const said = await error(page);
        await page.fill("#command", line);
        await page.keyboard.press("Enter");
        await page.waitForFunction((old) => document.getElementById("command-error").textContent !== old, said);
        assert.match(await error(page), expected);
        assert.doesNotMatch(await error(page), /undefined|\[object|exception/i);
    }
    assert.equal((await script.state()).revision, before.revision);
    for (const dismiss of [() => page.keyboard.press("Escape"), () => page.click("#command-close")]) {
        await dismiss();
        assert.equal(await page.locator("#command-line").isVisible(), false);
        assert.equal(await page.evaluate(() => document.activeElement.id), "drawing");
        await page.keyboard.press(":");
    }
    assert.deepEqual(errors, []);
    await close();
});

test("command line: the arrow keys step through the history, which survives a reload", async () => {
    const { page, script, close } = await openWithScript();
    await type(page, "set slices=31");
    await script.until((one) => one.slices.count === 31, "31 slices");
    await page.waitForSelector("#drawing:focus");
    await type(page, "set slices=11");
    await script.until((one) => one.slices.count === 11, "11 slices");
    await page.reload();
    await ready(page);
    await page.keyboard.press(":");
    const shown = [];
    for (const key of ["ArrowUp", "ArrowUp", "ArrowUp", "ArrowDown", "ArrowDown"]) {
        await page.keyboard.press(key);
        shown.push(await page.inputValue("#command"));
    }
    assert.deepEqual(shown, ["set slices=11", "set slices=31", "set slices=31", "set slices=11", ""]);
    await close();
});

test("command line: clicking a value opens the command that changes it", async () => {
    const { page, script, close } = await openWithScript();
    await page.click("button:has([data-reading=alpha])");
    await page.waitForSelector("#command:focus");
    assert.equal(await page.inputValue("#command"), "set alpha=");
    await page.keyboard.type("pi/7");
    await page.keyboard.press("Enter");
    await script.until((one) => Math.abs(one.alpha - Math.PI / 7) < 1e-12, "the angle");
    await close();
});

test("help: the sheet lists every key of the table, and the same key opens and closes it", async () => {
    const { page, script, close } = await openWithScript();
    const { keys } = await script.request({ type: "get", what: "keymap" });
    await page.keyboard.press("?");
    await page.waitForSelector("#help[open]");
    const lines = await page.locator("#help tr").allTextContents();
    for (const { name, text } of keys) assert.ok(lines.includes(name + text), `${name}: ${text}`);
    assert.ok(lines.some((line) => /^Shift \+.*inverse/.test(line)));
    const { revision } = await script.state();
    await page.keyboard.press("y");
    await page.keyboard.press("?");
    assert.equal(await page.locator("#help").isVisible(), false);
    await page.keyboard.press("?");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#help").isVisible(), false);
    await page.waitForSelector("#drawing:focus");
    assert.equal((await script.state()).revision, revision, "keys under the sheet do nothing");
    await close();
});

test("help: a button opens the list of keys", async () => {
    const { page, close } = await openPage();
    await ready(page);
    await page.click("#help-button");
    assert.equal(await page.locator("#help").isVisible(), true);
    await page.click("#help button");
    assert.equal(await page.locator("#help").isVisible(), false);
    await close();
});
