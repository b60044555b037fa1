// The page on the small touch screen of a phone.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript } from "./support/browser.mjs";
import { covered, decode } from "./support/pixels.mjs";

const phone = { viewport: { width: 375, height: 667 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };

test("phone: the picture has room, nothing overflows, every button is large enough to tap", async () => {
    const { page, script, errors, close } = await openWithScript(phone);
    const { width, height } = await page.locator("#drawing").boundingBox();
    assert.equal(width, 375);
    assert.ok(height > 0.4 * 667, `the picture is ${height} high`);
    assert.ok(covered(decode(await page.locator("#drawing").screenshot()), [16, 20, 28]) > 0.02);
    const overflow = () => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok((await overflow()) <= 0);
    const readings = await page
        .locator("[data-reading]")
        .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().right));
    assert.ok(
        readings.every((right) => right <= 375),
        "the state is visible",
    );

    const { keys } = await script.request({ type: "get", what: "keymap" });
    const found = new Set();
    for (const tab of await page.locator(".tabs button").all()) {
        await tab.tap();
        assert.ok((await overflow()) <= 0);
        for (const button of await page
            .locator("#tools section :is(button, .segments input, .presence input):visible")
            .all()) {
            await button.scrollIntoViewIfNeeded();
            const box = await button.boundingBox();
            assert.ok(
                box.height >= 38 && box.width >= 30,
                `${await button.getAttribute("title")}: ${box.width} × ${box.height}`,
            );
            assert.ok(box.x >= 0 && box.x + box.width <= 375);
            found.add(await button.getAttribute("data-action"));
        }
    }
    for (const { action } of keys) assert.ok(found.has(action), action);
    assert.deepEqual(errors, []);
    await close();
});

test("phone: a tap on a button turns the polytope", async () => {
    const { page, script, close } = await openWithScript(phone);
    await page.locator('[data-action="rotate"][data-key="y"]').tap();
    const { last } = await script.until((one) => one.last !== null, "the rotation");
    assert.deepEqual(last.planes, ["xy", "zw"]);
    await close();
});

test("phone: it is usable in landscape orientation", async () => {
    const { page, close } = await openWithScript({ ...phone, viewport: { width: 667, height: 375 } });
    const { width, height } = await page.locator("#drawing").boundingBox();
    assert.ok(width >= 375 && height >= 280, `${width} × ${height}`);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
    await close();
});

test("phone: the dialogs fill the screen and scroll, and their controls are large enough to tap", async () => {
    const { page, script, errors, close } = await openWithScript(phone);
    const dialogs = [
        { id: "picker", open: () => page.tap("#polytope"), first: "#picker-list [role=option]" },
        {
            id: "export",
            first: "#export-submit",
            async open() {
                await page.locator(".tabs button", { hasText: "More" }).tap();
                await page.tap("[data-action=export]");
            },
        },
    ];
    for (const { id, open, first } of dialogs) {
        await open();
        await page.waitForSelector(first);
        const box = await page.locator(`#${id}`).boundingBox();
        assert.deepEqual([box.x, box.y, box.width, box.height], [0, 0, 375, 667], id);
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
        const targets = page.locator(`#${id} :is(button, input, [role=option]):visible`);
        for (const target of (await targets.all()).slice(0, 40)) {
            await target.scrollIntoViewIfNeeded();
            const { x, width, height } = await target.boundingBox();
            assert.ok(
                height >= 38 && width >= 38,
                `${await target.evaluate((one) => one.outerHTML)}: ${width} × ${height}`,
            );
            assert.ok(x >= 0 && x + width <= 375);
        }
        await page.tap(`#${id} [data-close]`);
        assert.equal(await page.locator(`#${id}`).isVisible(), false);
    }
    await page.tap("#polytope");
    await page.tap('#picker-list [data-name="24-cell"]');
    await script.until((one) => one.polytope.name === "24-cell", "the 24-cell");
    assert.deepEqual(errors, []);
    await close();
});
