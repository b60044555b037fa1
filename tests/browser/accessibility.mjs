// Accessibility of the page: screen readers, the keyboard, reduced motion, contrast.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { controlsOf, namesOf } from "./support/accessible.mjs";
import { openPage, openWithScript, ready, spoken } from "./support/browser.mjs";
import { eventually } from "./support/hang_limit.mjs";
import { decode, distance, pixelAt } from "./support/pixels.mjs";

/** The dialogs by id, with the keys that open each dialog. */
const dialogs = { picker: "s", export: "x", help: "?", phone: ":share\n" };

/** Opens each dialog in turn, and calls `look` while it is open. */
async function withDialogs(page, look) {
    for (const [id, keys] of Object.entries(dialogs)) {
        await page.keyboard.type(keys);
        await page.waitForSelector(`#${id}[open]`);
        if (id === "picker") await page.waitForSelector("#picker-list [role=option]");
        await look(id);
        await page.keyboard.press("Escape");
        await page.waitForSelector("#drawing:focus");
    }
}

/** What opens over the page but leaves the page usable: panels by name, each with a function that opens it. */
const panels = {
    async completions(page) {
        await page.keyboard.press(":");
        await page.waitForSelector("#command:focus");
        await page.keyboard.type("color ");
        for (let i = 0; i < 2; ++i) await page.keyboard.press("Tab");
        await page.waitForSelector("#command-options [aria-selected=true]");
    },
    async "error on the command line"(page) {
        await page.keyboard.press(":");
        await page.keyboard.type("nonsense");
        await page.keyboard.press("Enter");
        await page.waitForFunction(() => document.getElementById("command-error").textContent !== "");
    },
    async "error at a value"(page) {
        await page.click("button:has([data-state-field=alpha])");
        await page.keyboard.type("nonsense");
        await page.keyboard.press("Enter");
        await page.waitForFunction(() => document.getElementById("state-field-error-alpha").textContent !== "");
    },
    async tour(page) {
        await page.keyboard.press("?");
        await page.click("#help-tour");
        await page.waitForSelector("#tour-next:focus");
        await page.keyboard.press("Enter");
    },
};

/** Opens each panel in turn, and calls `look` while it is open. */
async function withPanels(page, look) {
    for (const [name, open] of Object.entries(panels)) {
        await open(page);
        await look(name);
        await eventually(async () => {
            await page.keyboard.press("Escape");
            return page.evaluate(() => document.activeElement.id === "drawing");
        }, "the focus on the drawing");
    }
}

test("accessibility: every control has a name", async () => {
    const { page, close } = await openWithScript();
    const roles = [
        "button",
        "combobox",
        "textbox",
        "spinbutton",
        "radio",
        "slider",
        "listbox",
        "option",
        "application",
        "dialog",
    ];
    const named = async () => {
        const controls = await controlsOf(page, roles);
        for (const { role, name } of controls) assert.ok(name.trim(), `a ${role} has no name`);
        return controls;
    };
    const assertDistinct = (controls, where) => {
        const names = controls.filter(({ role }) => role === "button").map(({ name }) => name);
        assert.ok(names.length > 40);
        const repeated = names.filter((name, i) => names.indexOf(name) !== i);
        assert.deepEqual(repeated, [], `${where}: no two buttons have the same name`);
    };
    assertDistinct(await named(), "the page");
    await withPanels(page, async (name) => assertDistinct(await named(), name));
    await withDialogs(page, async (id) => {
        const controls = await named();
        assert.ok(
            controls.some(({ role }) => role === "dialog"),
            id,
        );
        assert.ok(controls.length > 1, "the dialog has controls");
        assert.ok(
            controls.every(({ role }) => role !== "application"),
            "the drawing under the dialog is not reachable",
        );
    });
    await close();
});

test("accessibility: the name of a control contains its visible label", async () => {
    const { page, close } = await openWithScript();
    const normalized = (text) => text.toLowerCase().match(/[\p{L}\p{N}]+/gu)?.join(" ") ?? "";
    /**
     * The texts of the buttons without their keys, which are not part of the accessible names. Undefined for an
     * invisible button.
     */
    const labelsOf = (buttons) => {
        const keys = [...document.querySelectorAll("button kbd[aria-hidden=true]")];
        for (const key of keys) key.style.display = "none";
        const labels = buttons.map((button) => (button.checkVisibility() ? button.innerText : undefined));
        for (const key of keys) key.style.removeProperty("display");
        return labels;
    };
    /**
     * The buttons whose accessible name does not contain their visible label (axe's rule label-content-name-mismatch).
     */
    const mismatches = async () => {
        const names = await namesOf(page, "button");
        const labels = await page.locator("button").evaluateAll(labelsOf);
        assert.equal(labels.length, names.length);
        const pairs = labels.map((text, i) => ({ text, name: names[i] }));
        return pairs
            .filter(({ text, name }) => text !== undefined && name !== undefined)
            .filter(({ text, name }) => !normalized(name).includes(normalized(text)))
            .map(({ text, name }) => `${text}: ${name}`);
    };
    assert.deepEqual(await mismatches(), []);
    await withPanels(page, async (name) => assert.deepEqual(await mismatches(), [], name));
    await withDialogs(page, async (id) => assert.deepEqual(await mismatches(), [], id));
    await close();
});

/** Presses a key. Resolves to a description of the element that then has the focus; undefined for the page itself. */
async function focusAfter(page, key) {
    await page.keyboard.press(key);
    return page.evaluate(() => {
        const at = document.activeElement;
        if (at === document.body) return undefined;
        const seen = at.type === "radio" ? at.nextElementSibling : at; // a radio button is shown by the span after it
        const { outlineStyle, outlineWidth } = getComputedStyle(seen);
        const { borderTopWidth, content } = getComputedStyle(at, "::after");
        const framed = content !== "none" && parseFloat(borderTopWidth) >= 1;
        const name = at.id || at.name || at.title || at.textContent;
        const toolbar = at.closest("[role=toolbar]")?.ariaLabel;
        const place = [...document.querySelectorAll("*")].indexOf(at);
        return { name, toolbar, place, visible: framed || (outlineStyle !== "none" && parseFloat(outlineWidth) >= 2) };
    });
}

test("accessibility: Tab and the arrows reach every control, and the focus is always visible", async () => {
    const { page, close } = await openWithScript();
    const toolbars = await page.locator("[role=toolbar]:visible:has(button:visible)").count();
    const others = await page.locator("button:visible, #drawing, #tools input:checked, #focus-bar :is(input, select)").evaluateAll((all) => {
        return all.filter((one) => !one.closest("[role=toolbar]")).length;
    });
    const buttons = await page.locator("button:visible:enabled").count();
    assert.ok(toolbars > 8 && toolbars + others < 30, `${toolbars} toolbars and ${others} other tab stops`);
    const seen = new Set();
    const record = (focus) => {
        assert.ok(focus.visible, `${focus.name} shows its focus`);
        seen.add(focus.name);
    };
    const visited = new Set();
    // Tabs from the start of the page to its end. In some browsers, Tab also goes to the browser's own controls, or
    // stops at scrollable areas.
    await page.evaluate(() => (document.activeElement.blur(), getSelection().collapse(document.body, 0)));
    const stops = new Set();
    for (let i = 0; i < 2 * (toolbars + others); ++i) {
        const focus = await focusAfter(page, "Tab");
        if (!focus) continue;
        if (stops.has(focus.place)) break;
        stops.add(focus.place);
        record(focus);
        if (!focus.toolbar || visited.has(focus.toolbar)) continue;
        visited.add(focus.toolbar);
        for (let next = await focusAfter(page, "ArrowRight"); next.name !== focus.name;) {
            assert.equal(next.toolbar, focus.toolbar, "the arrows stay in the toolbar");
            record(next);
            next = await focusAfter(page, "ArrowRight");
        }
    }
    assert.equal(visited.size, toolbars);
    assert.ok(seen.has("drawing") && seen.has("polytope"));
    assert.ok(seen.size >= buttons, `${seen.size} of ${buttons}`);
    await close();
});

test("accessibility: in a toolbar, the arrows, Home and End move the focus, and disabled buttons are skipped", async () => {
    const { page, script, close } = await openWithScript();
    const { camera } = await script.state();
    const at = (key) => `#tools [data-group=turn] [data-key="${key}"]`;
    const focusIs = (selector) => page.waitForSelector(`${selector}:focus`);
    await page.focus(at("2"));
    for (const [key, to] of [
        ["ArrowRight", at("Shift+3")],
        ["ArrowLeft", at("2")],
        ["ArrowDown", at("7")],
        ["ArrowUp", at("2")],
        ["ArrowUp", at("2")],
        ["Home", at("Shift+2")],
        ["ArrowLeft", at("r")], // at the lower right
        ["End", at("r")],
        ["ArrowRight", at("Shift+2")],
    ]) {
        await page.keyboard.press(key);
        await focusIs(to);
    }
    assert.deepEqual((await script.state()).camera, camera, "the arrows do not move the camera");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Shift+Tab");
    await focusIs(at("2")); // the tab stop is the button that had the focus last
    await page.evaluate((selector) => (document.querySelector(selector).disabled = true), at("Shift+3"));
    await page.keyboard.press("ArrowRight");
    await focusIs(at("3"));
    await page.focus("#drawing");
    await page.evaluate((selector) => (document.querySelector(selector).disabled = true), at("3"));
    await page.waitForSelector(`${at("Shift+2")}[tabindex="0"]`);
    assert.equal(await page.locator("#tools [data-group=turn] [tabindex='0']").count(), 1);
    await close();
});

test("accessibility: the arrows move the focus among the rotations as they are seen", async () => {
    const { page, close } = await openWithScript();
    const buttons = page.locator("[data-group=turn] button");
    await buttons.first().focus();
    const place = () =>
        page.evaluate(() => {
            const { left, top } = document.activeElement.getBoundingClientRect();
            return { left, top };
        });
    for (let i = 1, before = await place(); i < (await buttons.count()); ++i) {
        await page.keyboard.press("ArrowRight");
        const after = await place();
        const isNext = after.top === before.top ? after.left > before.left : after.top > before.top;
        assert.ok(isNext, `button ${i}: ${JSON.stringify([before, after])}`);
        before = after;
    }
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

test("accessibility: changes are announced after a pause", async () => {
    const { page, press, close } = await openWithScript();
    assert.equal(await page.getAttribute("#spoken", "aria-live"), "polite");
    await spoken(page, "5-cell");
    await press("k");
    await spoken(page, "α 6°");
    await press("n");
    await spoken(page, "8-cell");
    await press("4");
    await spoken(page, "turned xw 6°");
    await press("o");
    await spoken(page, "single view");
    await press("m");
    await spoken(page, "matrix view, focus point 0, 0, 0, 0");
    await press("f");
    await spoken(page, "faces off");
    await close();
});

test("accessibility: with reduced motion, the page has no transitions or animations", async () => {
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

/** Finds the texts whose contrast to their background is too small. */
function faintTexts(page) {
    return page.evaluate(() => {
        // Converts a CSS color in any notation to the color on the screen.
        const pen = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
        const parse = (color) => {
            pen.clearRect(0, 0, 1, 1);
            pen.fillStyle = color;
            pen.fillRect(0, 0, 1, 1);
            return [...pen.getImageData(0, 0, 1, 1).data];
        };
        const luminance = (rgb) => {
            const [r, g, b] = rgb.map((value) =>
                value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4,
            );
            return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const backgroundOf = (element) => {
            for (let at = element; at; at = at.parentElement) {
                const [r, g, b, a] = parse(getComputedStyle(at).backgroundColor);
                if (a === 255) return [r, g, b];
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
            const [a, b] = [parse(getComputedStyle(element).color).slice(0, 3), backgroundOf(element)]
                .map(luminance)
                .sort((x, y) => y - x);
            const ratio = (a + 0.05) / (b + 0.05);
            return ratio < 4.5 ? [`${element.textContent}: ${ratio.toFixed(1)}`] : [];
        });
    });
}

for (const colorScheme of ["dark", "light"]) {
    test(`accessibility: text has enough contrast on a ${colorScheme} page`, () => assertContrast(colorScheme));
}

async function assertContrast(colorScheme) {
    const { page, press, close } = await openWithScript({ firstVisit: true, colorScheme });
    await press("4");
    assert.equal(await page.locator("#welcome").isVisible(), true);
    assert.deepEqual(await faintTexts(page), []);
    await withPanels(page, async (name) => assert.deepEqual(await faintTexts(page), [], name));
    await withDialogs(page, async (id) => {
        if (id === "picker") {
            await page.fill("#picker-search", "25-cell");
            await page.keyboard.press("Enter");
            await page.waitForFunction(() => document.getElementById("picker-error").textContent !== "");
            assert.deepEqual(await faintTexts(page), []);
            await page.fill("#picker-search", "");
        }
        assert.deepEqual(await faintTexts(page), [], id);
    });
    await page.setInputFiles("#file", { name: "a.off", mimeType: "", buffer: Buffer.from("4OFF\n1 2 three\n") });
    await page.waitForSelector("#loading[data-outcome=failed]");
    assert.deepEqual(await faintTexts(page), []);
    await close();
}

/** Finds the texts in pressed, chosen or disabled controls that do not have the theme's colors for such controls. */
async function otherColors(page) {
    return page.evaluate(() => {
        const probe = document.body.appendChild(document.createElement("span"));
        probe.style.forcedColorAdjust = "none";
        const theme = (name) => ((probe.style.color = name), getComputedStyle(probe).color);
        const [chosen, text, gray] = ["SelectedItem", "SelectedItemText", "GrayText"].map(theme);
        probe.remove();
        const controls = document.querySelectorAll("button[aria-pressed=true], button:disabled, .segments :checked + span");
        return [...controls].filter((one) => one.checkVisibility()).flatMap((one) => {
            const isGray = one.matches(":disabled");
            const isGround = getComputedStyle(one).backgroundColor === chosen;
            const parts = [one, ...one.querySelectorAll("*")];
            const wrong = parts.filter((part) => getComputedStyle(part).color !== (isGray ? gray : text));
            return [...wrong.map((part) => part.textContent), ...(isGround === isGray ? [`${one.textContent}: ground`] : [])];
        });
    });
}

test("accessibility: forced colors show which controls are pressed and which row is active", async () => {
    const { page, close } = await openWithScript({ forcedColors: "active", viewport: { width: 1280, height: 1100 } });
    /** The color of an element near its lower left corner. */
    const groundOf = async (selector) => {
        const picture = decode(await page.locator(selector).first().screenshot({ animations: "disabled" }));
        return pixelAt(picture, 7, picture.height - 4);
    };
    const differs = async (chosen, other) => {
        assert.ok(distance(await groundOf(chosen), await groundOf(other)) > 40, `${chosen} looks like ${other}`);
    };
    await page.waitForSelector("[data-action=faces][aria-pressed=true]");
    await differs("[data-action=faces]", "[data-action=view]");
    await differs("[data-page-tool=geometry]", "[data-page-tool=frames]");
    await differs("#tools label:has([value=cell]) span", "#tools label:has([value=plain]) span");
    await differs(".visibility label:has([value=shown])", ".visibility label:has([value=hidden])");
    await differs(".visibility .shown", ".visibility .hidden");
    await panels.completions(page);
    await differs("#command-options [aria-selected=true]", "#command-options [aria-selected=false]");
    for (let i = 0; i < 2; ++i) await page.keyboard.press("Escape");
    await withDialogs(page, async (id) => {
        if (id === "picker") await differs("[role=option][aria-selected=true]", "[role=option][aria-selected=false]");
        if (id === "export") await differs("#export :checked + span", "#export input:not(:checked) + span");
        if (id === "export") assert.deepEqual(await otherColors(page), []);
    });
    await page.waitForSelector("[data-action=back][aria-pressed=true]:disabled"); // needs a projection
    assert.deepEqual(await otherColors(page), []);
    await close();
});
