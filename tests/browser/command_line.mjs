// The command line of the page, and what its commands do.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "./support/suite.mjs";

import { idle, named, openWithScript, ready } from "./support/browser.mjs";
import { commands, type } from "./support/command_line.mjs";
import { bytesOf, pagesOf } from "./support/downloads.mjs";
import { within } from "./support/hang_limit.mjs";
import { holdSent } from "./support/held.mjs";

const { formats } = JSON.parse(readFileSync(new URL("../../protocol/export_formats.json", import.meta.url)));

const error = (page) => page.locator("#command-error").textContent();

/** Types a line into the command line, and waits until it has been executed or refused. */
async function executed(page, line) {
    await type(page, line);
    // Afterward, the command line closes, or shows why the line was refused.
    await page.waitForFunction(() => {
        return document.getElementById("command-line").hidden || document.getElementById("command-error").textContent !== "";
    });
    assert.equal(await error(page), "", line);
}

test("command line: executes the typed command, and returns the focus", async () => {
    const { page, script, close } = await openWithScript();
    await type(page, "polytope 24-cell");
    await script.until((one) => one.polytope.name === "24-cell", "the 24-cell");
    await page.waitForSelector("#drawing:focus");
    await type(page, ":rotate xw,yz pi/8 pi/sqrt(3)-pi/8"); // a further colon is allowed
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

test("command line: an error is shown as a notice if the line was closed or opened again before the answer", async () => {
    const { page, errors, close } = await openWithScript({ before: holdSent });
    for (const reopens of [false, true]) {
        await page.evaluate(() => (window.isHeld = ({ type }) => type === "command"));
        await type(page, "polytope 25-cell");
        await page.keyboard.press("Escape");
        await page.waitForSelector("#drawing:focus");
        if (reopens) await page.keyboard.press(":");
        await page.evaluate(() => window.release());
        await page.waitForFunction(() => /25-cell/.test(document.getElementById("notice").textContent));
        assert.equal(await error(page), "");
    }
    assert.deepEqual(errors, []);
    await close();
});

test("command line: in a low window, Page Down shows the rest of a long error", async () => {
    const { page, close } = await openWithScript({ viewport: { width: 320, height: 256 } });
    await type(page, `polytope ${"nonesuch of a long name ".repeat(8)}`);
    await page.waitForFunction(() => document.getElementById("command-error").textContent !== "");
    const ends = () =>
        page.evaluate(() => {
            const range = document.createRange();
            range.selectNodeContents(document.getElementById("command-error"));
            const { top, bottom } = range.getBoundingClientRect();
            const panel = document.getElementById("command-line").getBoundingClientRect();
            const [least, most] = [Math.max(0, panel.top), Math.min(innerHeight, panel.bottom)];
            return { top: top >= least, bottom: bottom <= most };
        });
    assert.deepEqual(await ends(), { top: true, bottom: false });
    for (let i = 0; i < 5; ++i) await page.keyboard.press("PageDown");
    assert.equal((await ends()).bottom, true);
    for (let i = 0; i < 5; ++i) await page.keyboard.press("PageUp");
    assert.equal((await ends()).top, true);
    assert.equal(await page.evaluate(() => document.activeElement.id), "command");
    await close();
});

test("command line: a line that is being typed is not closed by the answer to the line before", async () => {
    const { page, script, errors, close } = await openWithScript({
        before: () => {
            const { send } = WebSocket.prototype;
            window.held = [];
            WebSocket.prototype.send = function (text) {
                if (JSON.parse(text).type !== "command") send.call(this, text);
                else window.held.push(() => send.call(this, text)); // the server receives it later
            };
        },
    });
    for (const [line, holds] of [
        ["set slices=31", (state) => state.slices.count === 31],
        ["polytope 25-cell", () => true], // the server refuses this
    ]) {
        await type(page, line);
        await page.waitForFunction(() => window.held.length === 1);
        await page.keyboard.press("Escape");
        await page.keyboard.press(":");
        await page.keyboard.type("rotate x");
        await page.evaluate(() => window.held.shift()());
        await idle(page);
        await script.until(holds, line);
        await page.keyboard.type("y");
        assert.equal(await page.inputValue("#command"), "rotate xy");
        assert.equal(await error(page), "");
        await page.keyboard.press("Escape");
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

test("command line: the arrow keys return to the line being typed", async () => {
    const { page, close } = await openWithScript();
    await type(page, "set slices=31");
    await page.waitForSelector("#drawing:focus");
    await page.keyboard.press(":");
    await page.keyboard.type("rotate x");
    await page.keyboard.press("ArrowUp");
    assert.equal(await page.inputValue("#command"), "set slices=31");
    await page.keyboard.press("ArrowDown");
    assert.equal(await page.inputValue("#command"), "rotate x");
    await close();
});

test("command line: every example of a command is valid", async () => {
    const { script, close } = await openWithScript();
    for (const { name, example, client } of commands) {
        assert.match(example, new RegExp(`^${name}\\b`));
        if (name === "region") continue; // needs an array in the data folder
        if (!client) await script.request({ type: "command", line: example });
    }
    await close();
});

/** Executes a line that saves a file. Resolves to the download. */
async function save(page, line) {
    const saving = page.waitForEvent("download", { timeout: 0 }); // failures of the line explain more
    saving.catch(() => {});
    await executed(page, line);
    await page.waitForSelector("#drawing:focus");
    return within(saving, `the file of “${line}”`);
}

test("command line: :export saves a file in each format, as the export dialog does", async () => {
    for (const some of pagesOf(formats.filter(({ objects }) => objects !== "fields"))) {
        const { page, script, errors, close } = await openWithScript();
        await script.request({ type: "set", polytope: "8-cell" });
        await named(page, "8-cell");
        for (const { name, of } of some) {
            const download = await save(page, `export ${name}`);
            const part = of.includes("focus") ? "-w-0" : of.length > 1 ? `-${of[0]}` : "";
            assert.equal(download.suggestedFilename(), `8-cell${part}.${name}`);
            assert.ok((await bytesOf(download)).length > 50, name);
        }
        assert.deepEqual(errors, []);
        await close();
    }
});

test("command line: :export explains what it cannot save, and without a format opens the dialog", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "8-cell" });
    await named(page, "8-cell");
    assert.equal((await save(page, "export PNG")).suggestedFilename(), "8-cell.png");
    assert.equal(await page.locator("#export").isVisible(), false);

    assert.equal((await save(page, "export stl fit=3")).suggestedFilename(), "8-cell-3-slices.stl");
    assert.equal((await save(page, "export stl at=0,1/2,4")).suggestedFilename(), "8-cell-slices.stl");
    await page.waitForFunction(() => /1 of 3 slices is empty/.test(document.getElementById("notice").textContent));
    assert.equal((await save(page, "export stl body=skeleton")).suggestedFilename(), "8-cell-w-0-skeleton.stl");
    for (const [line, says] of [
        ["export stl fit", "“fit” is not an option, such as fit=5; the options are of, body, size, label, at, fit, exact"],
        ["export stl exact=maybe", "exact must be on or off, not “maybe”"],
        ["export stl size=big", "size must be a number, not “big”"],
        ["export stl at=0 fit=2", "give either at or fit"],
        ["export png size=3", "the size of a PNG is chosen in the export dialog"],
    ]) {
        await type(page, line);
        await page.waitForFunction((text) => {
            return document.getElementById("command-error").textContent.toLowerCase().includes(text.toLowerCase());
        }, says);
        await page.keyboard.press("Escape");
    }

    await type(page, "export stel");
    await page.waitForFunction(() =>
        /stel.*formats are 3mf, stl/.test(document.getElementById("command-error").textContent),
    );
    await page.keyboard.press("Escape");
    await type(page, "export vti");
    await page.waitForFunction(() =>
        /VTI files contain only fields/.test(document.getElementById("command-error").textContent),
    );
    await page.keyboard.press("Escape");
    await script.request({ type: "set", slices: { focus: 100 } }); // far outside the polytope
    await type(page, "export stl");
    await page.waitForFunction(() => /empty|flat/.test(document.getElementById("command-error").textContent));
    await page.keyboard.press("Escape");
    await type(page, "export");
    await page.waitForSelector("#export[open]");
    const chosen = page.locator("#export [name=format]:checked");
    assert.equal(await chosen.inputValue(), "3mf", "the commands have not chosen another format for the dialog");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    assert.deepEqual(errors, []);
    await close();
});
