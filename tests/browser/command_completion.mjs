// The completion of commands, settings and names in the command line.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript } from "./support/browser.mjs";
import { commands, listedBy } from "./support/command_line.mjs";

/** Replaces the line, presses Tab and then further keys. Returns the line and the listed completions. */
async function completed(page, line, ...keys) {
    await page.fill("#command", line);
    for (const key of ["Tab", ...keys]) await page.keyboard.press(key);
    const options = await page.locator("#command-options:visible [role=option]").allTextContents();
    return { line: await page.inputValue("#command"), options };
}

test("command line: the page knows the server's commands and settings, and no others", async () => {
    const { page, script, close } = await openWithScript();
    const ofServer = commands.filter(({ client }) => !client).map(({ name }) => name);
    assert.deepEqual(ofServer, await listedBy(script, "nonsense"));
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    const { options } = await completed(page, "set ");
    const settings = options.map((option) => option.replace(/=$/, "")).filter((name) => name !== "latency");
    assert.deepEqual(settings.sort(), (await listedBy(script, "set nonsense=1")).sort());
    await close();
});

test("command line: Tab completes what is unique, or what the possible words have in common", async () => {
    const { page, close } = await openWithScript();
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type("polytope 24");
    await page.keyboard.press("Tab"); // may wait for the names of polytopes
    await page.waitForFunction(() => document.getElementById("command").value === "polytope 24-cell");
    const cases = {
        po: "polytope ",
        ":po": ":polytope ",
        res: "reset",
        "rotate xy,": "rotate xy,zw",
        "view si": "view single",
        "view m": "view matrix",
        "view r": "view row",
        "set poi": "set point=",
        "set view=m": "set view=matrix",
        "project p": "project perspective",
        "set al": "set alpha=",
        "set faces=of": "set faces=off",
        "set slices=31 col": "set slices=31 color=",
        "set polytope=grand a": "set polytope=grand antiprism",
        "polytope GRAND A": "polytope grand antiprism",
        "highlight ce": "highlight cell ",
        "highlight edge": "highlight edge ",
        "highlight n": "highlight none",
        "set highlight=f": "set highlight=face:",
        "set highlight=no": "set highlight=none",
        "hide te": "hide tetrahedron",
        "key ct": "key ctrl-r",
        "export 3": "export 3mf",
        "export stl si": "export stl size=",
        "export STL fit=5 body=sk": "export STL fit=5 body=skeleton",
        "export svg of=ma": "export svg of=matrix",
        "help rot": "help rotate",
    };
    for (const [line, expected] of Object.entries(cases)) {
        const { line: inserted, options } = await completed(page, line);
        assert.equal(inserted, expected);
        assert.deepEqual(options, [], `${line} has one completion`);
        assert.equal(await page.evaluate(() => document.activeElement.id), "command");
    }
    assert.equal((await completed(page, "set c")).line, "set c");
    assert.deepEqual((await completed(page, "set c")).options.sort(), ["caps=", "cells=", "color=", "coordinates="]);
    const { line, options } = await completed(page, "set co");
    assert.equal(line, "set co");
    assert.deepEqual(options.sort(), ["color=", "coordinates="]);
    assert.equal((await completed(page, "set sl")).line, "set slices=");
    assert.deepEqual((await completed(page, "export svg ")).options, ["of=", "size=", "at=", "fit="]);
    assert.deepEqual((await completed(page, "export latency s")).options, []);
    const highlighted = ["vertex", "edge", "face", "cell", "none"];
    assert.deepEqual((await completed(page, "highlight ")).options, highlighted);
    assert.deepEqual((await completed(page, "set highlight=")).options, highlighted);
    for (const line of ["highlight cell ", "highlight cell 1", "highlight none", "set highlight=cell:"])
        assert.deepEqual(await completed(page, line), { line, options: [] }, "a number follows, or nothing");
    assert.equal((await completed(page, "polytope trunc")).line, "polytope truncated ");
    assert.equal((await completed(page, "polytope hexacosichoron", "Tab")).line, "polytope 600-cell");
    await page.fill("#command", "set h=1 end");
    await page.evaluate(() => document.getElementById("command").setSelectionRange(5, 5));
    await page.keyboard.press("Tab"); // completes to hidden= or highlight=
    assert.equal(await page.inputValue("#command"), "set hi=1 end", "the text after the caret stays");
    await close();
});

test("command line: repeated Tab cycles through the completions, Shift-Tab goes back", async () => {
    const { page, errors, close } = await openWithScript();
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    const active = () =>
        page.evaluate(() => {
            const id = document.getElementById("command").getAttribute("aria-activedescendant");
            return document.getElementById(id)?.textContent;
        });
    const expanded = () => page.getAttribute("#command", "aria-expanded");
    assert.equal(await page.getAttribute("#command", "role"), "combobox");
    assert.equal(await expanded(), "false");
    const { options } = await completed(page, "color ");
    assert.deepEqual(options, ["cell", "kind", "w", "plain", "light", "growth", "value"]);
    assert.equal(await expanded(), "true");
    const steps = { Tab: ["cell", "kind"], "Shift+Tab": ["cell", "value"], ArrowDown: ["cell"], ArrowUp: ["value"] };
    for (const [key, expected] of Object.entries(steps)) {
        for (const option of expected) {
            await page.keyboard.press(key);
            assert.equal(await page.inputValue("#command"), `color ${option}`);
            assert.equal(await active(), option);
            assert.equal(await page.locator("#command-options [aria-selected=true]").textContent(), option);
        }
    }
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#command-options").isVisible(), false);
    assert.equal(await page.locator("#command-line").isVisible(), true, "Escape closes the list first");
    assert.equal(await active(), undefined);
    await page.keyboard.type("y"); // the input still has the focus, so the drawing does not get this key
    assert.equal(await page.inputValue("#command"), "color valuey");

    await completed(page, "color ");
    await page.click("#command-options [role=option]:text-is('plain')");
    assert.equal(await page.inputValue("#command"), "color plain");
    await page.waitForSelector("#command:focus");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#drawing:focus");
    await page.waitForSelector("#tools [value=plain]:checked", { state: "attached" });

    await page.keyboard.press(":");
    await page.keyboard.type("dance");
    await page.keyboard.press("Tab"); // has nothing to complete
    assert.notEqual(await page.evaluate(() => document.activeElement.id), "command", "Tab leaves the field");
    assert.deepEqual(errors, []);
    await close();
});

test("command line: completes the names of loaded polytopes", async () => {
    const { page, script, close } = await openWithScript();
    const data = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n-1 -1 -1 -1\n";
    await script.request({ type: "load", name: "zebra stripes", format: "points", data });
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await completed(page, "polytope ze");
    await page.waitForFunction(() => document.getElementById("command").value === "polytope zebra stripes");
    await close();
});

test("command line: on a touch screen, a button completes", async () => {
    const { page, close } = await openWithScript({ hasTouch: true, isMobile: true });
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type("pro");
    await page.tap("#command-complete");
    assert.equal(await page.inputValue("#command"), "project ");
    await close();
});

test("command line: it does not cover the parallel coordinates", async () => {
    for (const [width, height] of [[1440, 900], [1024, 768], [390, 844]]) {
        const { page, script, close } = await openWithScript({ viewport: { width, height } });
        await page.keyboard.press(":");
        await page.waitForSelector("#command:focus");
        await completed(page, "set ");
        const drawing = await page.locator("#drawing").boundingBox();
        const panel = await page.locator("#command-line").boundingBox();
        const { scene } = await script.request({
            ...{ type: "get", what: "slices" },
            ...{ width: Math.round(drawing.width), height: Math.round(drawing.height) },
        });
        const { zero, amplitude } = scene.coordinates;
        const top = drawing.y + drawing.height * (1 - zero - amplitude);
        assert.ok(panel.y + panel.height <= top, `${width} × ${height}: ${panel.y + panel.height} > ${top}`);
        await close();
    }
});
