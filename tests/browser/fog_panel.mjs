// The controls of fog in the field panel.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { accurateBrowser, presented, spoken } from "./support/browser.mjs";
import { drawBy } from "./support/drawing.mjs";
import { openPanel, write } from "./support/field.mjs";

test("field panel: fog can be shown, edited by dragging and typing, and taken back", async () => {
    const { page, script, errors, close } = await openPanel({ browser: await accurateBrowser() });
    const fogOf = async () => (await script.state()).fog;
    await spoken(page, "formula"); // announcements begin after the first one
    await page.waitForSelector("#fog-show");
    assert.equal(await page.locator("#fog-curve").isVisible(), false);
    await page.click("#fog-show");
    const first = await script.until(({ fog }) => fog.length === 3, "fog");
    await presented(page, first.revision);
    assert.deepEqual(first.fog.map(({ opacity }) => opacity), [0.95, 0.5, 0]);
    await spoken(page, ", fog from ");

    // A drag moves one point in many steps. Undo takes all of them back at once.
    const handle = page.locator("#fog-curve [data-point='1'] .reach");
    const { x, y, width, height } = await handle.boundingBox();
    const [left, top] = [x + width / 2, y + height / 2];
    await page.evaluate(() => void (window.released = new Promise((then) => addEventListener("pointerup", then))));
    await page.mouse.move(left, top);
    await page.mouse.down();
    for (let i = 1; i <= 8; ++i) await page.mouse.move(left + 2 * i, top - 3 * i);
    await page.mouse.up();
    await page.evaluate(async () => void (await window.released)); // the browser may deliver the last moves later
    const shown = await page.inputValue("[data-fog='opacity 2']");
    assert.ok(Number(shown) > 0.6);
    const dragged = await script.until(({ fog }) => String(fog[1]?.opacity) === shown, "the last place of the drag");
    assert.ok(dragged.fog[1].value > first.fog[1].value);
    assert.deepEqual([dragged.fog[0], dragged.fog[2]], [first.fog[0], first.fog[2]]);
    await script.request({ type: "undo" });
    assert.deepEqual(await fogOf(), first.fog, "one undo takes back the whole drag");
    await page.waitForFunction(() => document.querySelector("[data-fog='opacity 2']").value === "0.5");

    // Without a mouse: typing numbers, adding a point, removing a point.
    await page.fill("[data-fog='opacity 1']", "0.25");
    await script.until(({ fog }) => fog[0]?.opacity === 0.25, "a typed opacity");
    const { revision } = await script.state();
    for (const [field, text] of [["opacity 1", "2"], ["value 1", "1e9"], ["opacity 3", "none"]]) {
        const before = await page.inputValue(`[data-fog='${field}']`);
        await page.fill(`[data-fog='${field}']`, text);
        await page.waitForFunction(() => /least to the greatest/.test(document.getElementById("fog-error").textContent));
        await page.fill(`[data-fog='${field}']`, before);
        await page.waitForFunction(() => document.getElementById("fog-error").textContent === "");
    }
    await page.focus("#fog-add");
    await page.keyboard.press("Enter");
    const four = await script.until(({ fog }) => fog.length === 4, "a fourth point");
    assert.ok(four.revision > revision);
    assert.ok(four.fog.every(({ value }, i) => i === 0 || value > four.fog[i - 1].value));
    await page.focus("[aria-label='Remove point 2']");
    await page.keyboard.press("Enter");
    const label = await page.evaluate(() => document.activeElement.ariaLabel);
    assert.equal(label, "Remove point 2", "the focus stays in the list");
    const three = await script.until(({ fog }) => fog.length === 3, "three points");
    await page.locator("[data-fog='color 1']").evaluate((input) => {
        // Both colors of the drag arrive before the page sends the first.
        for (const color of ["#00ff00", "#00ff80"]) {
            input.value = color;
            input.dispatchEvent(new Event("input"));
        }
        input.dispatchEvent(new Event("change"));
    });
    await script.until(({ fog }) => fog[0].color === 0x00ff80, "a color");
    await script.request({ type: "undo" });
    assert.deepEqual(await fogOf(), three.fog, "a color is an undo step of its own");
    await script.request({ type: "redo" });
    const colored = await script.until(({ fog }) => fog[0].color === 0x00ff80, "the color again");

    // Points without a color have the colors of the picture.
    await presented(page, colored.revision);
    const { scene } = await script.request({ type: "get", what: "slices" });
    const last = await page.inputValue("[data-fog='color 3']");
    const near = (a, b) => [16, 8, 0].every((shift) => Math.abs(((a >> shift) & 255) - ((b >> shift) & 255)) <= 6);
    assert.ok(near(parseInt(last.slice(1), 16), scene.fog.table[255] & 0xffffff), last);
    assert.equal(scene.fog.table[1] & 0xffffff, 0x00ff80);

    await page.click("#fog-off");
    await script.until(({ fog }) => fog.length === 0, "no fog");
    assert.equal(await page.evaluate(() => document.activeElement.id), "fog-show");
    await script.request({ type: "undo" });
    await page.waitForFunction(() => document.querySelector("[data-fog='color 1']")?.value === "#00ff80");
    assert.deepEqual(await fogOf(), colored.fog);
    await write(page, script, "x^2+y^2+z^2+w^2*2");
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: behind the curve of fog is the distribution of the values of this field", async () => {
    const { page, script, errors, close } = await openPanel();
    const outline = () => page.locator("#fog-curve .values").getAttribute("d");
    await write(page, script, "max(-1, min(1, x))");
    await page.click("#fog-show");
    await script.until(({ fog }) => fog.length > 0, "fog");
    const first = await outline();
    assert.match(first, /^M.*Z$/);
    const { fog } = await write(page, script, "max(-1, min(1, x^3/4))"); // the values have the same range as before
    assert.ok(fog.length > 0, "the fog stays");
    const second = await outline();
    assert.match(second, /^M.*Z$/);
    assert.notEqual(second, first);

    // While the server draws the pictures, the page does not know the value distribution of the next field.
    await drawBy(page, "frames");
    await write(page, script, "max(-1, min(1, x^3/2))");
    assert.equal(await outline(), "");
    await drawBy(page, "geometry");
    await page.waitForFunction(() => document.querySelector("#fog-curve .values").getAttribute("d") !== "");
    assert.ok(![first, second].includes(await outline()));
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: fog is shown and edited where the values differ little from each other", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, "1027.5 + x/4"); // like the density of seawater in kilograms per cubic meter
    await page.click("#fog-show");
    const { fog } = await script.until((state) => state.fog.length === 3, "fog");
    assert.ok(fog[0].value >= 1027 && fog[2].value <= 1028, JSON.stringify(fog));
    await page.click("#fog-add");
    await script.until((state) => state.fog.length === 4, "a fourth point");
    assert.equal(await page.textContent("#fog-error"), "");
    assert.deepEqual(errors, []);
    await close();
});
