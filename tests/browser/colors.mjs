// Colors on the page, and kinds of cells that are shown, faded or hidden.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { named, openWithScript, presented, spoken } from "./support/browser.mjs";
import { compare, covered, decode } from "./support/pixels.mjs";

const shot = async (page) => decode(await page.locator("#drawing").screenshot());

/** Clicks the label of a radio button, as a user does. */
const choose = (page, name, value) => page.locator(`#tools label:has([name="${name}"][value="${value}"])`).click();
const checked = (page, name) => page.locator(`#tools [name="${name}"]:checked`).inputValue();

/** Opens the page with a polytope that has several kinds of cells. */
async function openKinds() {
    const opened = await openWithScript();
    const { revision } = await opened.script.request({ type: "set", polytope: "truncated 5-cell" });
    await presented(opened.page, revision);
    await named(opened.page, "truncated 5-cell");
    return opened;
}

test("colors: the coloring can be chosen, is visible, and follows the session", async () => {
    const { page, script, errors, close } = await openKinds();
    assert.equal(await checked(page, "color"), "cell");
    const pictures = [await shot(page)];
    for (const color of ["kind", "w", "plain", "light"]) {
        await choose(page, "color", color);
        const { revision } = await script.until((one) => one.color === color, color);
        await presented(page, revision);
        pictures.push(await shot(page));
        assert.equal(await page.locator(".scale").isVisible(), color === "w", "the scale explains the colors of w");
    }
    for (const [i, a] of pictures.entries()) {
        for (const b of pictures.slice(i + 1)) assert.ok(compare(a, b).mean > 0.3, "the pictures differ");
    }
    await script.request({ type: "command", line: "color kind" });
    await page.waitForFunction(() => document.querySelector("#tools [name=color][value=kind]").checked);
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing", "the drawing keeps the focus");
    assert.deepEqual(errors, []);
    await close();
});

test("colors: the legend lists each kind of cell with its number of cells and its color", async () => {
    const { page, script, close } = await openKinds();
    const { polytope } = await script.state();
    assert.equal(polytope.kinds.length, 2);
    const rows = page.locator(".kinds > div");
    assert.equal(await rows.count(), 2);
    await choose(page, "color", "kind");
    await script.until((one) => one.color === "kind", "colors by kind");
    const { scene } = await script.request({ type: "get", what: "slices" });
    for (const [i, { name, cells }] of polytope.kinds.entries()) {
        const row = rows.nth(i);
        assert.equal((await row.innerText()).replaceAll("\u00ad", "").replace(/\s+/g, " "), `${name} ${cells}`);
        assert.match(await row.getAttribute("aria-label"), new RegExp(`${name}.*${cells}`));
        const shown = await row.locator("i").evaluate((one) => getComputedStyle(one).backgroundColor);
        const value = shown.match(/\d+/g).reduce((sum, part) => 256 * sum + Number(part), 0);
        assert.equal(scene.colors.cells.filter((one) => one === value).length, cells, "cells of this color");
    }
    await close();
});

test("colors: a kind can be hidden, faded and shown again, by mouse, by keyboard and by another client", async () => {
    const { page, script, errors, close } = await openKinds();
    const background = [16, 20, 28];
    const all = covered(await shot(page), background);
    await choose(page, "kind-0", "hidden");
    const hidden = await script.until((one) => one.hidden.join() === "0", "kind 0 hidden");
    await presented(page, hidden.revision);
    assert.ok(covered(await shot(page), background) < all, "less is drawn");
    await choose(page, "kind-1", "faded");
    const both = await script.until((one) => one.faded.join() === "1", "kind 1 faded");
    assert.deepEqual(both.hidden, [0]);
    await page.focus('#tools [name="kind-0"][value=hidden]');
    await page.keyboard.press("ArrowLeft");
    await script.until((one) => one.hidden.length === 0 && one.faded.join() === "0,1", "both faded");
    await page.keyboard.press("ArrowLeft");
    await script.until((one) => one.faded.join() === "1", "kind 0 shown");
    await script.request({ type: "command", line: "hide 0 1" });
    await page.waitForFunction(() => document.querySelectorAll('.kinds [data-visibility="hidden"]').length === 2);
    assert.equal(await checked(page, "kind-1"), "hidden");
    await script.request({ type: "undo" });
    await page.waitForFunction(() => document.querySelectorAll('.kinds [data-visibility="hidden"]').length === 0);
    await script.request({ type: "set", polytope: "8-cell" });
    await page.waitForFunction(() => document.querySelectorAll(".kinds > div").length === 1);
    assert.equal(await checked(page, "kind-0"), "shown", "another polytope shows all kinds");
    assert.deepEqual(errors, []);
    await close();
});

test("colors: changes are announced", async () => {
    const { page, script, close } = await openKinds();
    const { kinds } = (await script.state()).polytope;
    await spoken(page, "truncated 5-cell");
    await choose(page, "color", "w");
    await spoken(page, "colored by w");
    await choose(page, "kind-1", "faded");
    await spoken(page, `${kinds[1].name} faded`);
    await choose(page, "kind-1", "shown");
    await spoken(page, "all kinds of cells shown");
    await close();
});
