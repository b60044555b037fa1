// The command line and the help sheet.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "./support/suite.mjs";

import { idle, named, openPage, openWithScript, ready } from "./support/browser.mjs";
import { bytesOf, pagesOf } from "./support/downloads.mjs";
import { within } from "./support/hang_limit.mjs";

const protocol = (name) => JSON.parse(readFileSync(new URL(`../../protocol/${name}.json`, import.meta.url)));
const { commands } = protocol("commands");
const { formats } = protocol("export_formats");

const error = (page) => page.locator("#command-error").textContent();

async function type(page, line) {
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type(line);
    await page.keyboard.press("Enter");
}

/** Types a line, and waits until it has been executed. */
async function executed(page, line) {
    await type(page, line);
    // The line closes, or explains why it could not be executed.
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
        ["polytope 25-cell", () => true], // which is refused
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

/** The names that the server lists in its answer to this line. */
async function listedBy(script, line) {
    const answer = await script.request({ type: "command", line }).catch(({ message }) => message);
    const [, list] = /; the (?:commands|settings) are (.*)$/.exec(answer);
    return list.split(", ");
}

/** Replaces the line, and presses Tab. Returns the line, and the listed completions. */
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

test("command line: every example of a command is valid", async () => {
    const { script, close } = await openWithScript();
    for (const { name, example, client } of commands) {
        assert.match(example, new RegExp(`^${name}\\b`));
        if (!client) await script.request({ type: "command", line: example });
    }
    await close();
});

test("command line: Tab completes what is unique, or what the possible words have in common", async () => {
    const { page, close } = await openWithScript();
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type("polytope 24");
    await page.keyboard.press("Tab"); // may have to wait for the names of polytopes
    await page.waitForFunction(() => document.getElementById("command").value === "polytope 24-cell");
    const cases = {
        po: "polytope ",
        ":po": ":polytope ",
        res: "reset",
        "rotate xy,": "rotate xy,zw",
        "view si": "view single",
        "view m": "view matrix",
        "set poi": "set point=",
        "set view=m": "set view=matrix",
        "project p": "project perspective",
        "set al": "set alpha=",
        "set faces=of": "set faces=off",
        "set slices=31 col": "set slices=31 color=",
        "set polytope=grand a": "set polytope=grand antiprism",
        "polytope GRAND A": "polytope grand antiprism",
        "hide te": "hide tetrahedron",
        "key ct": "key ctrl-r",
        "export 3": "export 3mf",
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
    assert.equal((await completed(page, "polytope trunc")).line, "polytope truncated ");
    assert.equal((await completed(page, "polytope hexacosichoron", "Tab")).line, "polytope 600-cell");
    await page.fill("#command", "set h=1 end");
    await page.evaluate(() => document.getElementById("command").setSelectionRange(5, 5));
    await page.keyboard.press("Tab"); // hidden=, highlight=
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

    await completed(page, "color ");
    await page.click("#command-options [role=option]:text-is('plain')");
    assert.equal(await page.inputValue("#command"), "color plain");
    await page.waitForSelector("#command:focus");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#drawing:focus");
    await page.waitForSelector("#tools [value=plain]:checked", { state: "attached" });

    await page.keyboard.press(":");
    await page.keyboard.type("dance");
    await page.keyboard.press("Tab"); // nothing to complete
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

/** Executes a line that saves a file; returns the download. */
async function save(page, line) {
    const saving = page.waitForEvent("download", { timeout: 0 }); // a wait that begins later explains more
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
        ["export stl fit", "“fit” is not an option, such as fit=5; the options are of, body, size, label, at, fit"],
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
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    assert.deepEqual(errors, []);
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
