// The page in small windows: on a phone's touch screen, zoomed in, and on a small desktop.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented } from "./support/browser.mjs";
import { hasTool } from "./support/keys.mjs";
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
    const values = await page
        .locator("[data-state-field]")
        .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().right));
    assert.ok(
        values.every((right) => right <= 375),
        "the state is visible",
    );

    const { keys } = await script.request({ type: "get", what: "keymap" });
    const found = new Set();
    for (const tab of await page.locator(".tabs button").all()) {
        await tab.tap();
        assert.ok((await overflow()) <= 0);
        for (const button of await page
            .locator("#tools section :is(button, .segments input, .visibility input):visible")
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
    for (const { action } of keys.filter(hasTool)) assert.ok(found.has(action), action);
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

test("phone: the page is usable in landscape orientation", async () => {
    const { page, close } = await openWithScript({ ...phone, viewport: { width: 667, height: 375 } });
    const { width, height } = await page.locator("#drawing").boundingBox();
    assert.ok(width >= 375 && height >= 280, `${width} × ${height}`);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
    await close();
});

test("phone: zoomed to 400%, the picture is as wide as the window, and every control can be reached", async () => {
    const viewport = { width: 320, height: 256 }; // CSS pixels of a window of 1280 × 1024 at 400 %
    const { page, script, errors, close } = await openWithScript({ viewport });
    const { width, height } = await page.locator("#drawing").boundingBox();
    assert.ok(width === 320 && height >= 180, `${width} × ${height}`);
    assert.ok(covered(decode(await page.locator("#drawing").screenshot()), [16, 20, 28]) > 0.02);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
    await page.locator(".tabs button", { hasText: "More" }).click();
    await page.click("[data-action=export]");
    await page.click("#export [data-close]");
    await page.locator(".tabs button", { hasText: "Turn" }).click();
    await page.click('[data-action="rotate"][data-key="y"]');
    await script.until((one) => one.last !== null, "the rotation");
    assert.deepEqual(errors, []);
    await close();
});

test("phone: in small pictures, no name below the parallel coordinates is cut", async () => {
    /** Runs in the page. Records the texts that the page draws. */
    const record = () => {
        const { fillText } = CanvasRenderingContext2D.prototype;
        window.drawn = [];
        CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
            const half = this.measureText(text).width / 2;
            const { width, height } = this.canvas;
            window.drawn.push({ text, isWhole: y <= height && x >= half - 1 && x <= width - half + 1 });
            fillText.call(this, text, x, y);
        };
    };
    for (const [width, height] of [[320, 256], [320, 568], [800, 600]]) {
        const { page, script, close } = await openWithScript({ viewport: { width, height }, before: record });
        const named = { polytope: "5-cell", array: "x^2 + y^2 + z^2 + w^2 < 1" };
        for (const [kind, value] of Object.entries(named)) {
            await page.evaluate(() => void (window.drawn = []));
            const load = { type: "load", name: "ball", format: "formula", data: value };
            const { revision } = await script.request(kind === "array" ? load : { type: "set", [kind]: value, alpha: 0.5 });
            await presented(page, revision);
            const names = await page.evaluate(() => window.drawn.filter(({ text }) => /^(P\d+|[xyzw])$/.test(text)));
            assert.deepEqual(names.filter(({ isWhole }) => !isWhole), [], `${value} at ${width} × ${height}`);
            if (width === 800) assert.ok(names.some(({ text }) => /^P|w/.test(text)), "there are names where they fit");
        }
        await close();
    }
});

test("phone: in the narrowest window, the buttons of the header are in its first line", async () => {
    const { page, script, close } = await openWithScript({ viewport: { width: 320, height: 568 } });
    for (const polytope of ["24-cell", "omnitruncated 120-cell"]) {
        const { revision } = await script.request({ type: "set", polytope });
        await presented(page, revision);
        const tops = await page
            .locator("header > button:visible")
            .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().top));
        assert.equal(tops.length, 3);
        assert.equal(new Set(tops).size, 1, `${polytope}: ${tops}`);
    }
    await close();
});

test("phone: the header is not cut at any width", async () => {
    const { page, script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "omnitruncated 120-cell", alpha: 2.1432, beta: 2.9876 });
    await script.request({ type: "set", slices: { spacing: 0.0123, focus: -7 } });
    const { revision } = await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [2.1432, 2.9876] });
    await presented(page, revision);
    for (const width of [320, 480, 768, 1000, 1024, 1200, 1201, 1280, 1440]) {
        await page.setViewportSize({ width, height: 768 });
        const cut = await page.evaluate(() => {
            const header = document.querySelector("header").getBoundingClientRect();
            const parts = [...document.querySelectorAll("header > :not(#state-fields), #state-fields button")];
            const boxes = parts.map((one) => one.getBoundingClientRect());
            const isWithin = ({ left, right, bottom }) => left >= 0 && right <= innerWidth && bottom <= header.bottom;
            const overlap = (a, b) =>
                a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
            return parts
                .filter((_, i) => !isWithin(boxes[i]) || boxes.some((other, k) => k > i && overlap(boxes[i], other)))
                .map((one) => one.textContent);
        });
        assert.deepEqual(cut, [], `${width} pixels wide`);
    }
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
