// The dialog for choosing a polytope: search, choice and errors.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, named, openWithScript } from "./support/browser.mjs";
import { holdSent } from "./support/held.mjs";
import { startProxy } from "./support/proxy.mjs";

const listed = (page) =>
    page.locator("#picker-list [data-name]").evaluateAll((all) => all.map((one) => one.dataset.name));
const chosen = (page) => page.locator('#picker-list [aria-selected="true"]').getAttribute("data-name");
const focused = (page) => page.evaluate(() => document.activeElement.id);

/** Opens the dialog, and waits for the catalogue. */
async function openPicker(page) {
    await page.keyboard.press("s");
    await page.waitForSelector("#picker-list [role=option]");
}

test("picker: lists the whole catalogue in order, with the current polytope selected", async () => {
    const { page, script, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "24-cell" });
    await named(page, "24-cell");
    await openPicker(page);
    const { polytopes } = await script.request({ type: "get", what: "catalogue" });
    const families = [...new Set(polytopes.map(({ family }) => family))];
    const inOrder = families.flatMap((one) => polytopes.filter(({ family }) => family === one));
    assert.deepEqual(
        await listed(page),
        inOrder.map(({ name }) => name),
    );
    assert.equal(await chosen(page), "24-cell");
    for (const { name, vertices, cells, schlaefli } of polytopes.slice(0, 6)) {
        const text = (await page.locator(`#picker-list [data-name="${name}"]`).textContent()).replace(/\u2009/g, "");
        assert.ok(
            [vertices, cells, schlaefli].every((one) => text.includes(one)),
            text,
        );
    }
    assert.deepEqual(errors, []);
    await close();
});

test("picker: searches names, aliases, short names and symbols", async () => {
    const { page, close } = await openWithScript();
    await openPicker(page);
    const first = { tesser: "8-cell", HEX: "16-cell", "{3,3,5}": "600-cell", 343: "24-cell", "120cell": "120-cell" };
    for (const [query, name] of Object.entries({ ...first, "simplex 4": "5-cell", ico: "24-cell" })) {
        await page.fill("#picker-search", query);
        assert.equal(await chosen(page), name, query);
    }
    await page.fill("#picker-search", "20-cell");
    assert.ok(!(await listed(page)).includes("120-cell"), "a number matches only a whole number");
    await page.fill("#picker-search", "");
    assert.ok((await listed(page)).length >= 6, "all are listed again");
    await close();
});

test("picker: works with the keyboard alone", async () => {
    const { page, script, close } = await openWithScript();
    await openPicker(page);
    assert.equal(await focused(page), "picker-search");
    const names = await listed(page);
    const last = names.length - 1;
    const steps = [
        ["ArrowDown", 1],
        ["ArrowDown", 2],
        ["ArrowUp", 1],
        ["ArrowUp", 0],
        ["ArrowUp", last],
        ["ArrowDown", 0],
        ["PageDown", Math.min(8, last)],
        ["PageUp", 0],
    ];
    for (const [key, index] of steps) {
        await page.keyboard.press(key);
        assert.equal(await chosen(page), names[index], key);
        const active = await page.getAttribute("#picker-search", "aria-activedescendant");
        assert.equal(await page.locator(`#${active}`).getAttribute("data-name"), names[index], "the active option is announced");
        const visible = await page.locator(`#${active}`).evaluate((one) => {
            const [box, list] = [one.getBoundingClientRect(), one.closest("[role=listbox]").getBoundingClientRect()];
            return box.top >= list.top && box.bottom <= list.bottom;
        });
        assert.ok(visible, `${names[index]} is visible`);
    }
    await page.keyboard.type("hexacos");
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "600-cell", "the 600-cell");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    assert.equal(await focused(page), "drawing", "the focus is returned");
    const { revision } = await script.state();
    await openPicker(page);
    await page.keyboard.type("y2");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#picker").isVisible(), false);
    assert.equal(await focused(page), "drawing");
    assert.equal((await script.state()).revision, revision, "keys in the dialog have no other effect");
    await close();
});

test("picker: works with the mouse alone, and from the button at the top", async () => {
    const { page, script, press, close } = await openWithScript();
    await page.click("#polytope");
    await page.click('#picker-list [data-name="16-cell"]');
    await script.until((one) => one.polytope.name === "16-cell", "the 16-cell");
    await named(page, "16-cell");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    await press("4"); // keys act on the drawing again
    await page.focus("#polytope");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#picker-list [role=option]");
    await page.click("#picker [data-close]");
    assert.equal(await focused(page), "polytope", "the focus returns to the button if it was opened by keyboard");
    await page.keyboard.press("Enter");
    await page.mouse.click(4, 300); // outside the dialog
    assert.equal(await page.locator("#picker").isVisible(), false);
    await close();
});

test("picker: a misspelled name finds similar names, after the text itself", async () => {
    const { page, script, close } = await openWithScript();
    await openPicker(page);
    for (const [text, similar] of [
        ["tessaract", "8-cell"],
        ["hexacosichoran", "600-cell"],
        ["omnitrunkated 120 cell", "omnitruncated 120-cell"],
    ]) {
        await page.fill("#picker-search", text);
        assert.deepEqual(await listed(page), [text, similar]);
        assert.equal(await chosen(page), text);
        assert.equal(await page.textContent("#picker-found"), "1 object with a similar name");
    }
    for (const text of ["zq", "qj", "wvqzk", "pyramid of cube"]) {
        await page.fill("#picker-search", text);
        assert.deepEqual(await listed(page), [text], "no name is similar");
    }
    await page.fill("#picker-search", "tessaract");
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "8-cell", "the tesseract");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    await openPicker(page);
    await page.keyboard.type("pyramid of cube");
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "pyramid of cube", "a polytope that is built from its name");
    await close();
});

test("picker: a name that is not listed is sent as typed; an error is shown and can be corrected", async () => {
    const { page, script, errors, close } = await openWithScript();
    const { revision } = await script.state();
    await openPicker(page);
    await page.keyboard.type("25-cell");
    assert.equal(await chosen(page), "25-cell");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => /25-cell.*did you mean/.test(document.getElementById("picker-error").textContent));
    assert.equal(await page.getAttribute("#picker-search", "aria-invalid"), "true");
    assert.equal(await focused(page), "picker-search");
    assert.equal((await script.state()).revision, revision);
    await page.keyboard.press("Backspace");
    assert.equal(await page.locator("#picker-error").textContent(), "", "the error disappears with the next key");
    await page.fill("#picker-search", "Hyper-Cube"); // an alias in another spelling
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "8-cell", "the 8-cell");
    assert.deepEqual(errors, []);
    await close();
});

test("picker: an error is shown as a notice if the dialog was closed before the answer", async () => {
    const { page, errors, close } = await openWithScript({ before: holdSent });
    await page.evaluate(() => (window.isHeld = ({ polytope }) => polytope === "25-cell"));
    await openPicker(page);
    await page.keyboard.type("25-cell");
    await page.keyboard.press("Enter");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    await page.evaluate(() => window.release());
    await page.waitForFunction(() => /25-cell/.test(document.getElementById("notice").textContent));
    assert.deepEqual(errors, []);
    await close();
});

test("picker: a choice that is made before the catalogue has arrived closes the dialog, too", async () => {
    const { page, errors, close } = await openWithScript({ before: holdSent });
    // The server answers the request for the catalogue first, then the request for the choice.
    await page.evaluate(() => (window.isHeld = ({ what, polytope }) => what === "catalogue" || polytope === "16-cell"));
    await page.keyboard.press("s");
    await page.waitForSelector("#picker[open]");
    await page.keyboard.type("16-cell");
    await page.keyboard.press("Enter");
    await page.evaluate(() => window.release());
    await named(page, "16-cell");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    assert.deepEqual(errors, []);
    await close();
});

test("picker: reports a missing connection", async () => {
    const proxy = await startProxy((await common()).url, "/cut");
    const { page, script, close } = await openWithScript({ url: proxy.url });
    await openPicker(page);
    await proxy.stop();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => /no connection/.test(document.getElementById("picker-error").textContent));
    script.leave();
    await close();
});

test("picker: says that the server cannot be reached, and lists the polytopes once it can be", async () => {
    const proxy = await startProxy((await common()).url, "/cut");
    const { page, script, close } = await openWithScript({ url: proxy.url });
    proxy.cut();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await page.focus("#drawing");
    await page.keyboard.press("s");
    await page.waitForFunction(() => /cannot be reached/.test(document.getElementById("picker-error").textContent));
    assert.equal(await page.locator("#picker-found").textContent(), "");
    await page.keyboard.type("24");
    assert.match(await page.locator("#picker-error").textContent(), /cannot be reached/);
    proxy.restore();
    await page.waitForSelector('#picker-list [data-name="24-cell"]');
    assert.equal(await page.locator("#picker-error").textContent(), "");
    assert.match(await page.locator("#picker-found").textContent(), /^\d+ objects$/);
    script.leave();
    await close();
    await proxy.stop();
});

test("picker: in a narrow window, no name is broken within a word", async () => {
    const { page, close } = await openWithScript({ viewport: { width: 320, height: 568 } });
    await page.click("#polytope");
    await page.waitForSelector("#picker-list [data-name]");
    const broken = await page.locator("#picker-list [data-name] b").evaluateAll((names) =>
        names.flatMap(({ firstChild: text }) => {
            return [...text.data.matchAll(/\S+/g)].filter(({ 0: word, index }) => {
                const range = document.createRange();
                range.setStart(text, index);
                range.setEnd(text, index + word.length);
                return new Set([...range.getClientRects()].map(({ top }) => top)).size > 1 && !word.includes("-");
            });
        }),
    );
    assert.deepEqual(broken, []);
    await close();
});
