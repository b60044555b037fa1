// The help dialog lists keys, commands and settings: all of them, or only those that mention a word.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openPage, openWithScript, ready } from "./support/browser.mjs";
import { commands, listedBy, type } from "./support/command_line.mjs";

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

test("help: lists every command with an example, and the settings", async () => {
    const { page, script, close } = await openWithScript();
    await page.keyboard.press("?");
    await page.waitForSelector("#help[open]");
    const lines = await page.locator("#help dl > div").allInnerTexts();
    assert.equal(lines.length, commands.length);
    commands.forEach(({ example, text }, i) => assert.ok(lines[i].includes(`:${example}`) && lines[i].includes(text)));
    const settings = await listedBy(script, "set nonsense=1");
    const ofSet = lines.find((line) => line.startsWith(":set"));
    for (const name of settings) assert.ok(ofSet.includes(name), name);
    await close();
});

test("help: :help shows everything, or only what mentions a word", async () => {
    const { page, errors, close } = await openWithScript();
    await type(page, "help");
    await page.waitForSelector("#help[open]");
    const all = await page.locator("#help :is(tr, dl > div):visible").count();
    assert.ok(all > 50);
    assert.equal(await page.locator("#help-topic").isVisible(), false);
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    assert.equal(await page.locator("#command-line").isVisible(), false);

    await type(page, "help ROTATE");
    await page.waitForSelector("#help[open]");
    const shown = page.locator("#help :is(tr, dl > div):visible");
    const lines = await shown.allInnerTexts();
    for (const line of lines) assert.match(line, /rotate|\bturn by/i);
    assert.ok(lines.some((line) => line.startsWith(":rotate")), "the command");
    assert.ok(lines.some((line) => /Turn by α in xw and by β in yz/.test(line)), "the keys with this action");
    assert.ok(lines.length < all / 2, `${lines.length} lines`);
    await page.click("#help-all");
    assert.equal(await shown.count(), all);
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");

    await type(page, "help elephants");
    await page.waitForFunction(() => /elephants/.test(document.getElementById("command-error").textContent));
    await page.keyboard.press("Escape");
    await page.keyboard.press("?");
    await page.waitForSelector("#help[open]");
    assert.equal(await shown.count(), all, "the key shows everything");
    assert.deepEqual(errors, []);
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
