// For those who do not see the picture, or use no mouse.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openPage, openWithScript, ready } from "./support/browser.mjs";

test("accessibility: every control has a name", async () => {
    const { page, close } = await openWithScript();
    const session = await page.context().newCDPSession(page);
    const { nodes } = await session.send("Accessibility.getFullAXTree");
    const controls = nodes.filter(({ ignored, role }) => {
        return !ignored && ["button", "combobox", "textbox", "application", "dialog"].includes(role?.value);
    });
    assert.ok(controls.length > 40);
    for (const { role, name } of controls) assert.ok(name?.value?.trim(), `a ${role.value} has no name`);
    const names = controls.filter(({ role }) => role.value === "button").map(({ name }) => name.value);
    assert.equal(new Set(names).size, names.length, "no two buttons have the same name");
    await close();
});

test("accessibility: the focus is visible wherever Tab leads, and Tab leads everywhere", async () => {
    const { page, close } = await openWithScript();
    const count = await page.locator("button:visible, select:visible, #drawing").count();
    const seen = new Set();
    for (let i = 0; i < count + 2; ++i) {
        await page.keyboard.press("Tab");
        const focus = await page.evaluate(() => {
            const at = document.activeElement;
            if (at === document.body) return undefined;
            const { outlineStyle, outlineWidth } = getComputedStyle(at);
            const { borderTopWidth, content } = getComputedStyle(at, "::after");
            const framed = content !== "none" && parseFloat(borderTopWidth) >= 1;
            const name = at.id || at.title || at.textContent;
            return { name, visible: framed || (outlineStyle !== "none" && parseFloat(outlineWidth) >= 2) };
        });
        if (!focus) continue;
        assert.ok(focus.visible, `${focus.name} shows its focus`);
        seen.add(focus.name);
    }
    assert.ok(seen.has("drawing") && seen.has("polytope") && seen.size >= count - 1, `${seen.size} of ${count}`);
    await close();
});

test("accessibility: buttons work by keyboard", async () => {
    const { page, script, close } = await openWithScript();
    await page.focus('[data-action="alpha_up"]');
    await page.keyboard.press("Enter");
    await script.until((one) => one.alpha > Math.PI / 36, "Enter on a button");
    assert.equal(await page.evaluate(() => document.activeElement.dataset.action), "alpha_up", "the focus stays");
    await close();
});

test("accessibility: changes are spoken once they have settled", async () => {
    const { page, press, close } = await openWithScript();
    const spoken = (text) =>
        page.waitForFunction((wanted) => document.getElementById("spoken").textContent.includes(wanted), text);
    assert.equal(await page.getAttribute("#spoken", "aria-live"), "polite");
    await spoken("5-cell");
    await press("k");
    await spoken("α 6°");
    await press("n");
    await spoken("8-cell");
    await press("4");
    await spoken("turned xw 6°");
    await press("o");
    await spoken("single view");
    await press("f");
    await spoken("faces off");
    await close();
});

test("accessibility: who wants less motion gets none of the page's own", async () => {
    const longest = (page) =>
        page.evaluate(() => {
            const times = [...document.querySelectorAll("*")].flatMap((one) => {
                const { transitionDuration, animationDuration } = getComputedStyle(one);
                return `${transitionDuration},${animationDuration}`.split(",").map(parseFloat);
            });
            return Math.max(...times);
        });
    const calm = await openPage({ reducedMotion: "reduce" });
    await ready(calm.page);
    assert.equal(await longest(calm.page), 0);
    await calm.close();
    const lively = await openPage({ reducedMotion: "no-preference" });
    await ready(lively.page);
    assert.ok((await longest(lively.page)) > 0);
    await lively.close();
});

test("accessibility: text stands out from its ground", async () => {
    const { page, press, close } = await openWithScript();
    await press("4");
    const faint = await page.evaluate(() => {
        const parse = (colour) => colour.match(/[\d.]+/g).map(Number);
        const light = (rgb) => {
            const [r, g, b] = rgb.map((value) =>
                value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4,
            );
            return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const ground = (element) => {
            for (let at = element; at; at = at.parentElement) {
                const [r, g, b, a = 1] = parse(getComputedStyle(at).backgroundColor);
                if (a === 1) return [r, g, b];
            }
            return [255, 255, 255];
        };
        const texts = [...document.querySelectorAll("body *")].filter((element) => {
            const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim() !== "");
            return (
                own && element.checkVisibility() && !element.closest(":disabled, noscript, script, dialog:not([open])")
            );
        });
        return texts.flatMap((element) => {
            const [a, b] = [parse(getComputedStyle(element).color).slice(0, 3), ground(element)]
                .map(light)
                .sort((x, y) => y - x);
            const ratio = (a + 0.05) / (b + 0.05);
            return ratio < 4.5 ? [`${element.textContent}: ${ratio.toFixed(1)}`] : [];
        });
    });
    assert.deepEqual(faint, []);
    await close();
});
