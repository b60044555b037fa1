// Finding a polytope by typing.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, named, openWithScript } from "./support/browser.mjs";
import { startProxy } from "./support/proxy.mjs";

const listed = (page) =>
    page.locator("#picker-list [data-name]").evaluateAll((all) => all.map((one) => one.dataset.name));
const chosen = (page) => page.locator('#picker-list [aria-selected="true"]').getAttribute("data-name");
const focused = (page) => page.evaluate(() => document.activeElement.id);

/** The catalogue is there, and the dialog open. */
async function openPicker(page) {
    await page.keyboard.press("s");
    await page.waitForSelector("#picker-list [role=option]");
}

test("picker: lists the whole catalogue in its order, with the polytope that is shown chosen", async () => {
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

test("picker: what is typed finds names, aliases, short names and symbols", async () => {
    const { page, close } = await openWithScript();
    await openPicker(page);
    const first = { tesser: "8-cell", HEX: "16-cell", "{3,3,5}": "600-cell", 343: "24-cell", "120cell": "120-cell" };
    for (const [query, name] of Object.entries({ ...first, "simplex 4": "5-cell", ico: "24-cell" })) {
        await page.fill("#picker-search", query);
        assert.equal(await chosen(page), name, query);
    }
    await page.fill("#picker-search", "20-cell");
    assert.ok(!(await listed(page)).includes("120-cell"), "a number is meant whole");
    await page.fill("#picker-search", "");
    assert.ok((await listed(page)).length >= 6, "all are back");
    await close();
});

test("picker: the keyboard is enough", async () => {
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
        assert.equal(await page.locator(`#${active}`).getAttribute("data-name"), names[index], "and it is said so");
        const inSight = await page.locator(`#${active}`).evaluate((one) => {
            const [box, list] = [one.getBoundingClientRect(), one.closest("[role=listbox]").getBoundingClientRect()];
            return box.top >= list.top && box.bottom <= list.bottom;
        });
        assert.ok(inSight, `${names[index]} is in sight`);
    }
    await page.keyboard.type("hexacos");
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "600-cell", "the 600-cell");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    assert.equal(await focused(page), "drawing", "the focus is given back");
    const { revision } = await script.state();
    await openPicker(page);
    await page.keyboard.type("y2");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#picker").isVisible(), false);
    assert.equal(await focused(page), "drawing");
    assert.equal((await script.state()).revision, revision, "keys in the dialog turn nothing");
    await close();
});

test("picker: the mouse is enough, and so is the button at the top", async () => {
    const { page, script, press, close } = await openWithScript();
    await page.click("#polytope");
    await page.click('#picker-list [data-name="16-cell"]');
    await script.until((one) => one.polytope.name === "16-cell", "the 16-cell");
    await named(page, "16-cell");
    await page.waitForSelector("#picker:not([open])", { state: "attached" });
    await press("4"); // the keys act again
    await page.focus("#polytope");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#picker-list [role=option]");
    await page.click("#picker [data-close]");
    assert.equal(await focused(page), "polytope", "whoever came by keyboard goes on from there");
    await page.keyboard.press("Enter");
    await page.mouse.click(4, 300); // beside it
    assert.equal(await page.locator("#picker").isVisible(), false);
    await close();
});

test("picker: what the catalogue does not list is asked for as typed; a refusal is read there and can be mended", async () => {
    const { page, script, errors, close } = await openWithScript();
    const { revision } = await script.state();
    await openPicker(page);
    await page.keyboard.type("25-cell");
    assert.equal(await chosen(page), "25-cell");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => /25-cell.*did you mean/.test(document.getElementById("picker-error").textContent));
    assert.equal(await page.getAttribute("#picker-search", "aria-invalid"), "");
    assert.equal(await focused(page), "picker-search");
    assert.equal((await script.state()).revision, revision);
    await page.keyboard.press("Backspace");
    assert.equal(await page.locator("#picker-error").textContent(), "", "it is gone when one goes on");
    await page.fill("#picker-search", "Hyper-Cube"); // an alias, spelt freely
    await page.keyboard.press("Enter");
    await script.until((one) => one.polytope.name === "8-cell", "the 8-cell");
    assert.deepEqual(errors, []);
    await close();
});

test("picker: without a connection it says so", async () => {
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
