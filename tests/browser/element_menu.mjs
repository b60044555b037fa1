// The menu of the element under the pointer: what it offers, and what its items do.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { presented } from "./support/browser.mjs";
import { faceIn, openTurned } from "./support/pointing.mjs";
import { touchOf } from "./support/touch.mjs";

test("element menu: a right click or a long press opens it, and its items act on the element", async () => {
    const { page, script, size, picture, moveTo, errors, close } = await openTurned({}, { hasTouch: true });
    const menu = page.locator("#element-menu");
    const { source: cell, at } = faceIn(await picture(), size, 1);
    const open = async () => {
        await moveTo(...at);
        await page.mouse.down({ button: "right" });
        await page.mouse.up({ button: "right" });
        await menu.waitFor();
    };
    await open();
    assert.equal(await menu.getAttribute("aria-label"), `Cell ${cell}`);
    await script.until(({ highlight }) => highlight?.number === cell && highlight.element === "cell", "its light");
    const items = await menu.locator("button").allTextContents();
    assert.deepEqual(items.length, 6, items.join());
    await page.keyboard.press("ArrowUp"); // moves to the last item
    await page.keyboard.press("Enter");
    await script.until(({ highlight }) => highlight === null, "the end of the light");
    assert.equal(await menu.isVisible(), false);
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing");

    await open();
    await page.keyboard.press("Escape");
    assert.equal(await menu.isVisible(), false);
    await open();
    await menu.getByText("Export it").click();
    await page.waitForSelector("#export[open]");
    assert.equal(await page.locator("#export [name=of]:checked").inputValue(), "highlight");
    assert.equal(await page.locator("#export-highlight").textContent(), `cell ${cell}`);
    await page.evaluate(() => {
        document.getElementById("export").close();
        const key = new KeyboardEvent("keydown", { key: "x", code: "KeyX", bubbles: true, cancelable: true });
        document.activeElement.dispatchEvent(key); // in the same task, and therefore before the closing's event
    });
    await page.waitForSelector("#export[open]");
    assert.equal(await page.locator("#export [name=of]:checked").inputValue(), "focus", "the usual choice is back");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    await open();
    await menu.getByText("Hide its kind of cell").click();
    await script.until(({ hidden }) => hidden.length === 1, "hidden cells");
    await script.request({ type: "command", line: "show" });
    await presented(page, (await script.state()).revision);

    const touch = await touchOf(page);
    const { x, y } = await page.locator("#drawing").boundingBox();
    await touch("touchStart", [x + at[0], y + at[1]]);
    await menu.waitFor();
    const { camera } = await script.state();
    await touch("touchMove", [x + at[0] + 40, y + at[1]]);
    await touch("touchEnd");
    await menu.getByText("Turn it toward +w").click();
    const turned = await script.until(({ moving }) => !moving, "the cell at +w");
    assert.deepEqual(turned.camera, camera, "a finger that moves on does not move the camera behind the menu");
    await touch("touchStart", [x + 4, y + 4]);
    await touch("touchEnd");
    assert.deepEqual(errors, []);
    await close();
});

test("element menu: it stays in the window when this becomes smaller", async () => {
    const { page, size, picture, moveTo, close } = await openTurned();
    const menu = page.locator("#element-menu");
    await moveTo(...faceIn(await picture(), size, 1).at);
    await page.mouse.down({ button: "right" });
    await page.mouse.up({ button: "right" });
    await menu.waitFor();
    for (const [width, height] of [[640, 360], [320, 256]]) {
        await page.setViewportSize({ width, height });
        await page.waitForFunction(() => {
            const [inner, outer] = ["element-menu", "drawing"].map((id) => document.getElementById(id).getBoundingClientRect());
            return inner.right <= outer.right && inner.bottom <= outer.bottom && inner.top >= outer.top;
        });
    }
    await page.keyboard.press("End");
    const isVisible = await page.evaluate(() => {
        const [item, around] = [document.activeElement, document.getElementById("element-menu")].map((one) => one.getBoundingClientRect());
        return item.top >= around.top && item.bottom <= around.bottom;
    });
    assert.ok(isVisible, "the last item can be reached");
    await close();
});
