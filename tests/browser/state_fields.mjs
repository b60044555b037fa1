// The values in the header of the page, and the text fields that change them.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, stateAfter } from "./support/browser.mjs";

const close = (a, b) => Math.abs(a - b) < 1e-9;
const kRadian = Math.PI / 180;

/** Opens the text field of a value with the mouse. */
async function openField(page, name) {
    await page.click(`button:has([data-state-field=${name}])`);
    await page.waitForSelector(`[data-field=${name}]:focus`);
}

/** Types a value into its text field, and waits until the field is closed. */
async function enter(page, name, text) {
    await openField(page, name);
    await page.keyboard.type(text);
    await page.keyboard.press("Enter");
    await page.waitForSelector(`[data-field=${name}]`, { state: "hidden" });
}

const messageAt = (page, name) => page.locator(`#state-field-error-${name}`);

test("state fields: an angle is typed in degrees or as an expression, and is shown in degrees", async () => {
    const { page, script, errors, close: closePage } = await openWithScript();
    const cases = {
        10: 10 * kRadian,
        "12.5": 12.5 * kRadian,
        "-30": -30 * kRadian,
        "10°": 10 * kRadian,
        "10 deg": 10 * kRadian,
        "10º": 10 * kRadian, // the ordinal indicator, which Spanish keyboards type
        "pi/8": Math.PI / 8,
        "pi / sqrt(3) - pi / 8": Math.PI / Math.sqrt(3) - Math.PI / 8,
        "90/4": 22.5 * kRadian,
        "pi/6+5°": 35 * kRadian,
        "deg(40)": 40 * kRadian,
        "0.3 rad": 0.3,
        "1e1": 10 * kRadian,
    };
    for (const [text, radians] of Object.entries(cases)) {
        for (const name of ["alpha", "beta"]) {
            await script.request({ type: "set", [name]: 0.01 });
            await page.waitForFunction(
                (one) => document.querySelector(`[data-state-field=${one}]`).textContent === "0.57°",
                name,
            );
            await enter(page, name, text);
            const state = await script.state();
            assert.ok(close(state[name], radians), `${text}: ${state[name]}`);
            await page.waitForSelector("#drawing:focus");
        }
    }
    assert.equal(await page.locator("[data-state-field=alpha]").textContent(), "10°");
    assert.deepEqual(errors, []);
    await closePage();
});

test("state fields: a rotation is applied once, even if the field is left before the answer", async () => {
    const { page, script, errors, close: closePage } = await openWithScript();
    const before = await script.state();
    await openField(page, "last");
    await page.keyboard.type("xw 10°");
    await page.evaluate(() => {
        // All at once, so that no answer arrives in between.
        const input = document.querySelector("[data-field=last]");
        for (let i = 0; i < 2; ++i) input.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
        input.blur();
    });
    await page.waitForSelector("[data-field=last]", { state: "hidden" });
    const after = await stateAfter(page, script);
    assert.equal(after.revision, before.revision + 1);
    assert.ok(close(Math.abs(after.orientation[0][3]), Math.sin(10 * kRadian)));
    assert.deepEqual(errors, []);
    await closePage();
});

test("state fields: a field offers the exact value, and sends nothing if it is not changed", async () => {
    const { page, script, close: closePage } = await openWithScript();
    const cases = [
        [22.5 * kRadian, "22.5°"],
        [Math.PI / 7, "pi/7"],
        [-Math.PI / 7, "−pi/7"],
        [(-3 * Math.PI) / 7, "−3*pi/7"],
        [(11 * Math.PI) / 7, "11*pi/7"],
        [0.1, "5.7295779513°"],
    ];
    for (const [alpha, text] of cases) {
        await script.request({ type: "set", alpha });
        const { revision } = await script.state();
        const degrees = `${Number((alpha / kRadian).toFixed(2))}°`.replace("-", "−");
        await page.waitForFunction(
            (wanted) => document.querySelector("[data-state-field=alpha]").textContent === wanted,
            degrees,
        );
        await openField(page, "alpha");
        assert.equal(await page.inputValue("[data-field=alpha]"), text);
        await page.keyboard.press("Enter");
        await page.waitForSelector("#drawing:focus");
        assert.equal((await script.state()).revision, revision);
        await openField(page, "alpha");
        await page.keyboard.type("1");
        await page.keyboard.press("Escape");
        await page.waitForSelector("#drawing:focus");
        assert.equal((await script.state()).revision, revision, "Escape discards the text");
    }
    await closePage();
});

test("state fields: w moves the focus and all hyperplanes; δ and the number of slices are set", async () => {
    const { page, script, close: closePage } = await openWithScript();
    await enter(page, "spacing", "1/8");
    assert.equal((await script.state()).slices.spacing, 0.125);
    for (const [text, focus] of [["0.49", 4], ["-0.25", -2], ["−0.4", -3], ["0", 0]]) {
        await enter(page, "w", text);
        const { slices, section } = await script.state();
        assert.equal(slices.focus, focus, text);
        assert.ok(close(section.w, Number(text.replace("−", "-"))), text);
    }
    await enter(page, "slices", "31");
    assert.equal((await script.state()).slices.count, 31);
    await closePage();
});

test("state fields: the last rotation is replaced by another one", async () => {
    const { page, script, press, close: closePage } = await openWithScript();
    const cases = {
        "xw 10°": { planes: ["xw"], angles: [10 * kRadian] },
        "xw 10, yz pi/8": { planes: ["xw", "yz"], angles: [10 * kRadian, Math.PI / 8] },
        "xy,zw 20 30": { planes: ["xy", "zw"], angles: [20 * kRadian, 30 * kRadian] },
        "xw 0.2 rad": { planes: ["xw"], angles: [0.2] },
        "xw 30 °, yz 20 deg": { planes: ["xw", "yz"], angles: [30 * kRadian, 20 * kRadian] },
        "xw,yz pi / 8 -5": { planes: ["xw", "yz"], angles: [Math.PI / 8, -5 * kRadian] },
        xz: { planes: ["xz"], angles: [5 * kRadian] },
    };
    for (const [text, { planes, angles }] of Object.entries(cases)) {
        await enter(page, "last", text);
        const { last } = await script.state();
        assert.deepEqual(last.planes, planes, text);
        assert.ok(last.angles.every((angle, i) => close(angle, angles[i])) && last.angles.length === angles.length);
    }
    await press("y");
    await openField(page, "last");
    assert.equal(await page.inputValue("[data-field=last]"), "xy 5°, zw 5°");
    await closePage();
});

test("state fields: an error is shown at the field, which keeps the text; Escape restores the value", async () => {
    const { page, script, errors, close: closePage } = await openWithScript();
    const { revision } = await script.state();
    const cases = {
        alpha: ["abc", /nothing is called.*abc/],
        beta: ["1000", /radians/],
        w: ["far", /nothing is called.*far/],
        spacing: ["-1", /spacing|δ/],
        slices: ["4", /odd.*4/],
        last: ["xq 1", /No plane.*xq/],
    };
    for (const [name, [text, message]] of Object.entries(cases)) {
        await openField(page, name);
        await page.keyboard.type(text);
        await page.keyboard.press("Enter");
        await page.waitForFunction((id) => document.getElementById(id).textContent !== "", `state-field-error-${name}`);
        assert.match(await messageAt(page, name).textContent(), message);
        const field = page.locator(`[data-field=${name}]`);
        assert.equal(await field.inputValue(), text);
        assert.equal(await field.getAttribute("aria-invalid"), "true");
        assert.ok((await field.getAttribute("aria-describedby")).includes(`state-field-error-${name}`));
        const [box, at] = [await messageAt(page, name).boundingBox(), await field.boundingBox()];
        const isBelow = box.y >= at.y + at.height && box.y < at.y + 90 && Math.abs(box.x - at.x) < 140;
        assert.ok(isBelow, "the message is below the field");
        const shown = await page.locator(`[data-state-field=${name}]`).textContent();
        await page.keyboard.press("Escape");
        await page.waitForSelector("#drawing:focus");
        assert.equal(await page.locator(`[data-state-field=${name}]`).textContent(), shown);
        assert.equal(await page.locator(`button:has([data-state-field=${name}])`).isVisible(), true);
    }
    assert.equal((await script.state()).revision, revision);
    assert.deepEqual(errors, []);
    await closePage();
});

test("state fields: works with the keyboard alone; leaving a field applies its text", async () => {
    const { page, script, close: closePage } = await openWithScript();
    await page.focus("button:has([data-state-field=alpha])");
    await page.keyboard.press("Enter");
    await page.waitForSelector("[data-field=alpha]:focus");
    await page.keyboard.type("20");
    await page.keyboard.press("Enter");
    await page.waitForSelector("button:has([data-state-field=alpha]):focus");
    assert.ok(close((await script.state()).alpha, 20 * kRadian));
    await page.keyboard.press("Enter");
    await page.keyboard.type("25");
    await script.request({ type: "set", beta: 1 });
    await page.waitForFunction(() => document.querySelector("[data-state-field=beta]").textContent === "57.3°");
    await page.keyboard.press("Tab");
    await page.waitForSelector("#state-fields:not(:focus-within)"); // the values are one tab stop
    await script.until((one) => close(one.alpha, 25 * kRadian), "the angle of the field that was left");
    await page.focus("button:has([data-state-field=beta])");
    await page.keyboard.press("Space");
    await page.keyboard.type("none");
    await page.keyboard.press("Tab");
    await page.waitForFunction(() => document.getElementById("state-field-error-beta").textContent !== "");
    assert.equal(await page.inputValue("[data-field=beta]"), "none", "a wrong text stays");
    await page.focus("[data-field=beta]");
    await page.keyboard.press("Escape");
    await page.waitForSelector("button:has([data-state-field=beta]):focus");
    await closePage();
});

test("state fields: a field keeps its text while the state changes", async () => {
    const { page, script, close: closePage } = await openWithScript();
    await openField(page, "alpha");
    await page.keyboard.type("4");
    await script.request({ type: "set", alpha: 1 });
    await page.waitForFunction(() => document.querySelector("[data-state-field=alpha]").textContent === "57.3°");
    await page.keyboard.type("5");
    assert.equal(await page.inputValue("[data-field=alpha]"), "45");
    await page.keyboard.press("Enter");
    await script.until((one) => close(one.alpha, Math.PI / 4), "45°");
    await closePage();
});

test("state fields: on a phone, a field and its message fit into the window", async () => {
    const phone = { viewport: { width: 375, height: 667 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };
    const { page, close: closePage } = await openWithScript(phone);
    for (const name of ["alpha", "slices", "last"]) {
        await page.tap(`button:has([data-state-field=${name}])`);
        await page.waitForSelector(`[data-field=${name}]:focus`);
        await page.keyboard.type("nonsense");
        await page.keyboard.press("Enter");
        await page.waitForFunction((id) => document.getElementById(id).textContent !== "", `state-field-error-${name}`);
        for (const part of [page.locator(`[data-field=${name}]`), messageAt(page, name)]) {
            const { x, width } = await part.boundingBox();
            assert.ok(x >= 0 && x + width <= 375, `${name}: ${x} + ${width}`);
        }
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
        await page.keyboard.press("Escape");
    }
    await closePage();
});

test("state fields: Tab leaves a field that the mouse has opened for what is beside the fields", async () => {
    const { page, press, close } = await openWithScript();
    await press("y");
    const focused = () => page.evaluate(() => document.activeElement.id);
    const field = (name) => page.locator(`.state-field:has([data-field=${name}]) button`);
    for (const name of ["beta", "w", "spacing", "slices", "last"]) {
        await page.locator("#drawing").focus();
        await field(name).click();
        await page.waitForSelector(`[data-field=${name}]:focus`);
        await page.keyboard.press("Shift+Tab");
        assert.equal(await focused(), "polytope", `backward from ${name}`);
    }
    await field("last").focus();
    await page.keyboard.press("Escape");
    await field("alpha").click();
    await page.waitForSelector("[data-field=alpha]:focus");
    await field("w").click(); // opens another field while the first is open
    await page.waitForSelector("[data-field=w]:focus");
    await page.keyboard.press("Tab");
    assert.equal(await focused(), "export-button", "forward");
    await close();
});

test("state fields: the note below a field stays in the window when this becomes smaller", async () => {
    const { page, press, close } = await openWithScript();
    await press("y");
    await page.click(".state-field:has([data-field=last]) button");
    for (const [width, height] of [[640, 360], [1280, 720], [800, 600]]) {
        await page.setViewportSize({ width, height });
        await page.waitForFunction(() => {
            const { left, right } = document.querySelector(".state-field-note:not([hidden])").getBoundingClientRect();
            return left >= 0 && right <= innerWidth;
        });
    }
    await close();
});
