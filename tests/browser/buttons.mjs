// Every action has a button that does the same as its key.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";

import { test } from "./support/suite.mjs";

import { named, openPage, openWithScript, presented, stateAfter } from "./support/browser.mjs";
import { bytesOf } from "./support/downloads.mjs";
import { hasTool, table } from "./support/keys.mjs";
import { decode } from "./support/pixels.mjs";
import { pngText } from "./node_modules/.oval4d/client.mjs";

const kPythonClient = new URL("../../protocol/python", import.meta.url).pathname;

const comparable = ({ id, revision, object_serial, ...state }) => state;

/**
 * The state after `act`. Each comparison starts from the same state: the initial state, with some changes and a
 * rotation.
 */
async function outcome(script, initial, { action, needs }, act) {
    // Buttons that change the projection can be pressed only while there is a projection.
    const projection = needs === "projection" ? "perspective" : "off";
    await script.request({ type: "reset" });
    await script.request({
        ...{ ...initial, type: "set", polytope: "16-cell", projection, alpha: 0.3, beta: 0.2 },
        ...{ shown: { ...initial.shown, cells: true }, slices: { count: 21, spacing: 0.14, focus: 2 } },
    });
    await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.25, 0.5] });
    if (action === "redo") await script.request({ type: "undo" });
    const { revision } = await script.state();
    await act();
    return comparable(await script.until((one) => one.revision > revision && !one.moving, `a change by ${action}`));
}

test("buttons: each button does what its key does", async () => {
    const { page, script, errors, close } = await openWithScript();
    const initial = await script.state();
    for (const binding of table.filter((one) => !one.client && one.action !== "turn" && hasTool(one))) {
        const { key, ctrl = false, action, name, shift } = binding;
        for (const inverse of shift === "inverse" ? [false, true] : [false]) {
            const byKey = await outcome(script, initial, binding, async () => {
                const strokes = key.length > 1 ? [...key] : [key];
                for (const one of strokes) await script.request({ type: "key", key: one, shift: inverse, ctrl });
            });
            const button = page.locator(`[data-action="${action}"][data-key="${inverse ? "Shift+" : ""}${name}"]`);
            assert.equal(await button.count(), 1, `a button for ${name}`);
            const byButton = await outcome(script, initial, binding, () => button.click());
            assert.deepEqual(byButton, byKey, name);
        }
    }
    assert.equal(
        await page.evaluate(() => document.activeElement.id),
        "drawing",
        "clicking a button leaves the focus on the drawing",
    );
    assert.deepEqual(errors, []);
    await close();
});

test("buttons: the turn button starts and stops turning, and shows whether the polytope turns", async () => {
    const { page, script, press, close } = await openWithScript();
    await press("4");
    const button = page.locator('[data-action="turn"]');
    await button.click();
    await script.until((one) => one.turning, "the turning to begin");
    await page.waitForSelector('[data-action="turn"][aria-pressed="true"]');
    await button.click();
    await script.until((one) => !one.turning, "the turning to stop");
    await page.waitForSelector('[data-action="turn"][aria-pressed="false"]');
    await close();
});

test("buttons: Project names the projection, and what changes it is disabled while there is none", async () => {
    const { page, press, close } = await openWithScript();
    const project = page.locator("[data-action=projection]");
    for (const [pressed, label] of [["false", "Project"], ["true", "Perspective"], ["true", "Orthogonal"]]) {
        await page.waitForSelector(`[data-action=projection][aria-pressed=${pressed}]:has-text("${label}")`);
        for (const { action } of table.filter(({ needs }) => needs === "projection")) {
            assert.equal(await page.locator(`[data-action=${action}]`).isDisabled(), label === "Project", action);
        }
        await project.click();
    }
    await page.waitForSelector("[data-action=projection][aria-pressed=false]");
    const { view } = await press("m");
    assert.equal(view, "matrix");
    await page.waitForSelector("[data-action=matrix][aria-pressed=true]");
    await page.click("[data-action=view]");
    await page.waitForSelector("[data-action=view][aria-pressed=true]");
    await page.click("[data-action=view]");
    await page.waitForSelector("[data-action=view][aria-pressed=false]");
    await page.waitForSelector("[data-action=matrix][aria-pressed=false]");
    await close();
});

test("buttons: two keys that decrease and increase a quantity are one control with its name", async () => {
    const { page, errors, close } = await openWithScript();
    const increasing = table.filter((one) => one.increases !== undefined && hasTool(one));
    assert.ok(increasing.length > 0);
    for (const { action, increases } of increasing) {
        const less = table.find(({ decreases }) => decreases === increases);
        const control = page.locator(".stepper").filter({ has: page.locator(`[data-action=${action}]`) });
        assert.equal(await control.locator(`[data-action=${less.action}]`).count(), 1, action);
        assert.ok((await control.textContent()).includes(increases), action);
    }
    assert.deepEqual(errors, []);
    await close();
});

test("buttons: a held button repeats until it is released", async () => {
    const { page, script, close } = await openWithScript();
    const { revision } = await script.state();
    await page.hover('[data-action="alpha_up"]');
    await page.mouse.down();
    const { alpha } = await script.until((one) => one.revision >= revision + 3, "three steps of a held button");
    await page.mouse.up();
    assert.ok(alpha > (3 * Math.PI) / 180);
    const rest = await stateAfter(page, script);
    await page.locator("#drawing").focus();
    await page.keyboard.press("Shift+J");
    const after = await script.until((one) => one.beta < rest.beta, "another key's change");
    assert.equal(after.alpha, rest.alpha, "the button sends nothing more");
    await close();
});

test("buttons: a key presses a button that was held, and left before it was released", async () => {
    const { page, script, close } = await openWithScript();
    const { revision } = await script.state();
    await page.hover('[data-action="alpha_up"]');
    await page.mouse.down();
    await script.until((one) => one.revision > revision, "a step of a held button");
    await page.hover("#drawing");
    await page.mouse.up();
    const { alpha } = await stateAfter(page, script);
    await page.locator('[data-action="alpha_up"]').focus();
    await page.keyboard.press("Enter");
    await script.until((one) => one.alpha > alpha, "a step of the key");
    await close();
});

test("buttons: the reset buttons restore the orientation and the viewpoint", async () => {
    const { page, script, press, close } = await openWithScript();
    const { orientation } = await script.state();
    await press("4");
    await script.request({ type: "set", camera: { azimuth: 1, zoom: 2 } });
    await page.click("[data-page-tool=reset]");
    const turned = await script.until((one) => one.orientation[0][0] === 1, "the initial orientation");
    assert.deepEqual(turned.orientation, orientation);
    await page.click("[data-action=reset_view]");
    await script.until(({ camera }) => camera.azimuth === 0 && camera.zoom === 1, "the initial viewpoint");
    await close();
});

test("buttons: the picture is saved as a PNG file that contains the state", async () => {
    const { page, script, press, close } = await openWithScript();
    const state = await press("y");
    const saving = page.waitForEvent("download");
    await page.click("[data-page-tool=save]");
    const download = await saving;
    assert.equal(download.suggestedFilename(), "5-cell.png");
    const png = await bytesOf(download);
    const { width, height } = decode(png);
    const size = await page.evaluate(() => {
        const { clientWidth, clientHeight } = document.getElementById("drawing");
        return [clientWidth, clientHeight];
    });
    assert.deepEqual([width, height], size);
    assert.deepEqual(JSON.parse(pngText(png)).orientation, state.orientation);
    await presented(page, (await script.state()).revision);
    await close();
});

test("buttons: Export and Share are in the header, or on narrow screens in the tools", async () => {
    const inHeader = "#export-button, #share-button";
    const inTools = "[data-action=export], [data-page-tool=share]";
    const permissions = ["clipboard-read", "clipboard-write"];
    const { page, errors, close } = await openWithScript({ permissions });
    assert.equal(await page.locator(inHeader).filter({ visible: true }).count(), 2);
    assert.equal(await page.locator(inTools).filter({ visible: true }).count(), 0);
    await page.click("#export-button");
    await page.waitForSelector("#export[open]");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    await page.click("#share-button");
    await page.waitForFunction(() => /copied/.test(document.getElementById("notice").textContent));
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /#session=.+&token=.+/);
    await page.setViewportSize({ width: 390, height: 844 });
    await page.click(".tabs button:text-is('More')");
    assert.equal(await page.locator(inHeader).filter({ visible: true }).count(), 0);
    assert.equal(await page.locator(inTools).filter({ visible: true }).count(), 2);
    assert.deepEqual(errors, []);
    await close();
});

test("buttons: a link and a script open the view elsewhere", async () => {
    const permissions = ["clipboard-read", "clipboard-write"];
    const { page, script, errors, close } = await openWithScript({ permissions });
    const copied = async (name, notice) => {
        await page.locator(`[data-page-tool=${name}]`).dispatchEvent("click");
        await page.waitForFunction((text) => document.getElementById("notice").textContent.startsWith(text), notice);
        return page.evaluate(() => navigator.clipboard.readText());
    };
    const slices = { count: 5, focus: 1, offset: 0.125 };
    await script.request({ type: "set", polytope: "24-cell", slices, point: [0.25, -0.5, 0, 0] });
    const { revision } = await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.3, 1] });
    await presented(page, revision);
    const link = await copied("view_link", "Link copied");
    const other = await openPage({ url: link });
    await named(other.page, "24-cell");
    await other.page.waitForFunction(() => document.querySelector("[data-state-field=slices]").textContent === "5");
    const wOf = (one) => one.locator("[data-state-field=w]").textContent();
    const w = await wOf(page);
    assert.notEqual(w, "0");
    await other.page.waitForFunction((text) => document.querySelector("[data-state-field=w]").textContent === text, w);
    assert.deepEqual(other.errors, []);
    await other.close();
    const python = await copied("python", "Python script copied");
    assert.ok(python.includes(`with connect(${JSON.stringify(link)}) as oval:`), python);
    const folder = await mkdtemp(join(tmpdir(), "oval4d-python-"));
    await promisify(execFile)("/usr/bin/python3", ["-c", python], { cwd: folder, env: { PYTHONPATH: kPythonClient } });
    const { orientation } = JSON.parse(pngText(await readFile(join(folder, "24-cell.png"))));
    await rm(folder, { recursive: true });
    const expected = (await script.state()).orientation.flat();
    orientation.flat().forEach((entry, i) => assert.ok(Math.abs(entry - expected[i]) < 1e-9, `${entry} ${expected[i]}`));
    assert.deepEqual(errors, []);
    await close();
});

test("buttons: what turns, cuts and shows the polytope is visible without scrolling", async () => {
    const { page, script, close } = await openWithScript({ viewport: { width: 1440, height: 900 } });
    const { keys } = await script.request({ type: "get", what: "keymap" });
    const below = ["point", "highlight", "camera", "files", "client"];
    for (const { action, group } of keys.filter((key) => !below.includes(key.group))) {
        for (const button of await page.locator(`[data-action=${action}]`).all()) {
            const { y, height } = await button.boundingBox();
            assert.ok(y + height <= 900, `${group}: ${action} ends at ${y + height}`);
        }
    }
    await close();
});

test("buttons: no button of the display stands alone in a row", async () => {
    const { page, close } = await openWithScript({ viewport: { width: 1440, height: 900 } });
    const tops = await page
        .locator("#tools [data-group=look] > div > *")
        .evaluateAll((all) => all.map((one) => Math.round(one.getBoundingClientRect().top)));
    assert.ok(tops.length > 4);
    for (const top of tops) assert.ok(tops.filter((other) => other === top).length > 1, `the rows begin at ${tops}`);
    await close();
});

test("buttons: the tools can be hidden and shown, and the picture uses the space", async () => {
    const { page, close } = await openWithScript();
    const width = () => page.evaluate(() => document.getElementById("drawing").clientWidth);
    const before = await width();
    await page.click("#tools-button");
    assert.equal(await page.locator("#tools").isVisible(), false);
    assert.equal(await page.getAttribute("#tools-button", "aria-expanded"), "false");
    assert.ok((await width()) > before + 200);
    await page.waitForFunction(
        () => document.querySelector("#drawing .solids").width === document.getElementById("drawing").clientWidth,
    );
    await page.click("#tools-button");
    assert.equal(await width(), before);
    await close();
});
