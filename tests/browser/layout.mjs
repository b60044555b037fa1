// The layout of the page, its dialogs and panels at many window sizes: nothing sticks out of its box, and nothing is
// cut off.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, stateAfter } from "./support/browser.mjs";
import { openPanel } from "./support/field.mjs";
import { kOnScreen, moveToScreen } from "./support/screen.mjs";

// Sizes of desktops, of a phone upright and lying, and of desktops at a zoom of 200 and 400 % (which have fewer CSS
// pixels).
const kSizes = [[1440, 900], [1280, 800], [1024, 600], [800, 600], [390, 844], [667, 375], [720, 450], [360, 225], [512, 300]];

/**
 * Runs in the page. Finds what sticks out of its box within an element: content wider than its container, and content
 * beyond the edges of the container or the window that cannot be scrolled into view.
 */
function faultsWithin(selector) {
    const kRounding = 1.5; // pixels
    const nameOf = (one) => {
        const text = one.textContent.trim().replace(/\s+/g, " ").slice(0, 30);
        return `${one.tagName.toLowerCase()}${one.id && `#${one.id}`} “${text}”`;
    };
    const scrolls = (one, axis) => ["auto", "scroll"].includes(getComputedStyle(one)[`overflow${axis}`]);
    const root = document.querySelector(selector);
    const faults = [];
    for (const one of [root, ...root.querySelectorAll("*")]) {
        const { width, height } = one.getBoundingClientRect();
        if (width === 0 || height === 0 || !one.checkVisibility({ visibilityProperty: true })) continue;
        if (one.closest(".spoken-only, svg, canvas, [aria-hidden=true]")) continue;
        const style = getComputedStyle(one);
        const isCut = style.overflowX === "hidden" && style.textOverflow === "ellipsis";
        if (style.display !== "inline" && !scrolls(one, "X") && !isCut && one.scrollWidth > one.clientWidth + kRounding) {
            if (one.clientWidth > 0) faults.push(`${nameOf(one)} is ${one.scrollWidth - one.clientWidth} too wide`);
        }
        for (const axis of ["X", "Y"]) {
            const [from, to] = axis === "X" ? ["left", "right"] : ["top", "bottom"];
            const box = one.getBoundingClientRect();
            let outer = one;
            while (outer !== root && !scrolls(outer, axis)) outer = outer.parentElement;
            if (outer !== root || scrolls(root, axis)) continue;
            if (axis === "Y" && root === document.body) continue; // the page itself scrolls
            const edges = root.getBoundingClientRect();
            const least = Math.max(0, edges[from]) - kRounding;
            const most = Math.min(axis === "X" ? innerWidth : innerHeight, edges[to]) + kRounding;
            if (box[from] < least || box[to] > most) {
                faults.push(`${nameOf(one)}: ${from} ${box[from]}, ${to} ${box[to]}, not from ${least} to ${most}`);
            }
        }
    }
    return faults;
}

/**
 * Asserts that nothing sticks out of its box within the element, at any size. Calls `each` at each size before the
 * check.
 */
async function assertFits(page, selector, each = async () => {}) {
    for (const [width, height] of kSizes) {
        await page.setViewportSize({ width, height });
        await each();
        assert.deepEqual(await page.evaluate(faultsWithin, selector), [], `${selector} at ${width} × ${height}`);
    }
}

test("layout: the page and all its tools fit into every window", async () => {
    const { page, close } = await openWithScript();
    const assertPageFits = async () =>
        assert.deepEqual(await page.evaluate(faultsWithin, "body"), [], JSON.stringify(page.viewportSize()));
    await assertFits(page, "body", async () => {
        for (const tab of await page.locator(".tabs button:visible").all()) {
            await tab.click();
            await assertPageFits();
        }
    });
    await close();
});

test("layout: the dialogs fit into every window", async () => {
    const { page, close } = await openWithScript();
    for (const [key, selector] of [["?", "#help"], ["s", "#picker"], ["x", "#export"]]) {
        await page.focus("#drawing");
        await page.keyboard.press(key);
        await page.waitForSelector(`${selector}[open]`);
        if (key === "s") await page.waitForSelector("#picker-list [role=option]");
        await assertFits(page, selector);
        await page.keyboard.press("Escape");
    }
    await close();
});

test("layout: the choices of every format fit into the export dialog", async () => {
    const { page, script, close } = await openWithScript();
    await script.request({ type: "set", polytope: "great grand stellated 120-cell", view: "single" }); // a long name
    await page.focus("#drawing");
    await page.keyboard.press("x");
    await page.waitForSelector("#export[open]");
    const formats = await page.locator("#export-formats label:visible input").evaluateAll((all) => all.map(({ value }) => value));
    assert.ok(formats.length > 10);
    await assertFits(page, "#export", async () => {
        for (const format of formats) {
            await page.evaluate((one) => document.querySelector(`#export [name=format][value="${one}"]`).click(), format);
            assert.deepEqual(await page.evaluate(faultsWithin, "#export"), [], `${format}, ${JSON.stringify(page.viewportSize())}`);
        }
    });
    await close();
});

test("layout: the panel of a field fits into every window", async () => {
    const { page, close } = await openPanel();
    await assertFits(page, "#field");
    await close();
});

test("layout: a long name leaves room for the last rotation", async () => {
    const { page, script, close } = await openWithScript({ viewport: { width: 1280, height: 800 } });
    await script.request({ type: "set", polytope: "great grand stellated 120-cell" });
    const { revision } = await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.41, -2.1] });
    await presented(page, revision);
    const hidden = await page
        .locator(".state-field:last-child button")
        .evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth);
    assert.ok(hidden <= 0, `${hidden} pixels of the last rotation are hidden`);
    await close();
});

/** The angle by which a short drag orbits the camera. */
async function angleOfDrag(page, script) {
    const { camera } = await script.state();
    await page.mouse.move(300, 300);
    await page.mouse.down();
    await page.mouse.move(310, 300, { steps: 4 });
    await page.mouse.up();
    return Math.abs((await stateAfter(page, script)).camera.azimuth - camera.azimuth);
}

test("layout: a page that moves to a screen with smaller pixels draws its picture anew, and drags orbit as far", async () => {
    const { page, script, close } = await openWithScript(kOnScreen);
    const ratio = () =>
        page.evaluate(() => {
            return document.querySelector("canvas.overlay").height / document.getElementById("drawing").clientHeight;
        });
    assert.equal(await ratio(), 1);
    const angle = await angleOfDrag(page, script);
    await moveToScreen(page, 2);
    await page.waitForFunction(() => {
        return document.querySelector("canvas.overlay").height === 2 * document.getElementById("drawing").clientHeight;
    });
    assert.ok(Math.abs((await angleOfDrag(page, script)) - angle) < 1e-9, "the drag orbits as far");
    await close();
});

test("layout: drags orbit as far where the picture has fewer pixels than the screen", async () => {
    const angles = [];
    for (const deviceScaleFactor of [1, 4]) {
        const { page, script, close } = await openWithScript({ deviceScaleFactor });
        angles.push(await angleOfDrag(page, script));
        await close();
    }
    assert.ok(Math.abs(angles[0] - angles[1]) < 1e-9, angles.join(" and "));
});
