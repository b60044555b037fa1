// URLs that open a field, and the field panel, which copies such URLs.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, named, openPage, ready, scriptFor } from "./support/browser.mjs";
import { change, formula, openPanel, write } from "./support/field.mjs";

test("field panel: an address opens a field, and the panel copies such an address", async () => {
    const permissions = ["clipboard-read", "clipboard-write"];
    const { page, script, close } = await openPanel({ permissions });
    await write(page, script, "x^2+y^2 + 1/10 <= w*z; a=0.5");
    await change(page, script, "[data-end='w to']", "3");
    await script.request({ type: "set", levels: [0, 0.5], inside: "above" });
    await page.waitForFunction(() => document.getElementById("field-levels").value === "0, 0.5");
    await page.click("#field-link");
    await page.waitForFunction(() => /copied/.test(document.getElementById("notice").textContent));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.includes("formula=x^2%2By^2%20%2B%201/10%20%3C=%20w*z;%20a=0.5&box=-2,2,-2,2,-2,2,-2,3&"), link);
    const second = await openPage({ url: `${link}&slices=11` });
    await ready(second.page);
    await named(second.page, "formula");
    const other = await scriptFor(second.page);
    const state = await other.until(({ slices }) => slices.count === 11, "the rest of the address");
    assert.deepEqual([state.levels, state.inside], [[0, 0.5], "above"]);
    await second.page.click("[data-page-tool=field]");
    assert.equal(await formula(second.page), "x^2+y^2 + 1/10 <= w*z; a=0.5");
    assert.equal(await second.page.inputValue("[data-end='w to']"), "3");
    assert.deepEqual(second.errors, []);
    other.leave();
    await second.close();
    await close();
});

test("field panel: the mistakes of an address are reported", async () => {
    const { url } = await common();
    const { page, close } = await openPage({ url: `${url}?formula=x^2%2B$&box=1,2&slices=11` });
    await page.waitForFunction(() => /box=1,2/.test(document.getElementById("notice").textContent));
    const notice = await page.locator("#notice").textContent();
    assert.match(notice, /“formula=x\^2\+\$”.*position 5/);
    assert.match(notice, /“box=1,2”: it must be eight numbers/);
    await page.waitForFunction(() => document.querySelector("[data-state-field=slices]").textContent === "11");
    await close();
});

test("field panel: an address opens a field by its name", async () => {
    const { url } = await common();
    const { page, errors, close } = await openPage({ url: `${url}?field=two+warm+spots&slices=11` });
    await named(page, "two warm spots");
    const script = await scriptFor(page);
    const { field } = await script.until(({ slices }) => slices.count === 11, "the rest of the address");
    assert.match(field.formula, /exp/);
    assert.equal(await page.locator("#notice").textContent(), "");
    assert.deepEqual(errors, []);
    script.leave();
    await close();
});

test("field panel: an address with a box and a second function, but no formula, is reported", async () => {
    const { url } = await common();
    const { page, close } = await openPage({ url: `${url}?box=-1,1,-1,1,-1,1,0,2&values=x*y&slices=11` });
    await page.waitForFunction(() => /values needs a formula/.test(document.getElementById("notice").textContent));
    const lines = (await page.locator("#notice").textContent()).split("\n");
    assert.equal(lines.length, 2);
    assert.match(lines[0], /“box=-1,1,-1,1,-1,1,0,2”: box needs a formula/);
    assert.match(lines[1], /“values=x\*y”/);
    await page.waitForFunction(() => document.querySelector("[data-state-field=slices]").textContent === "11");
    await close();
});

test("field panel: an address has the fog", async () => {
    const { page, script, close } = await openPanel({ permissions: ["clipboard-read", "clipboard-write"] });
    const fog = [{ value: -1, opacity: 0.5 }, { value: 0.25, opacity: 1, color: 0x00ff80 }];
    await script.request({ type: "set", fog });
    await page.waitForSelector("[data-fog='value 2']");
    await page.click("#field-link");
    await page.waitForFunction(() => /copied/.test(document.getElementById("notice").textContent));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.includes("&fog=-1:0.5,0.25:1:00ff80"), link);
    const second = await openPage({ url: link });
    await ready(second.page);
    const other = await scriptFor(second.page);
    assert.deepEqual((await other.until((state) => state.fog?.length === 2, "the fog")).fog, fog);
    other.leave();
    await second.close();
    await close();
});
