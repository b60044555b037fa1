// Every key of the key table has its effect, as the page and a second client see it.
import assert from "node:assert/strict";
import { inFirefox, test } from "./support/suite.mjs";

import { idle, openWithScript, presented, shownValues, stateAfter } from "./support/browser.mjs";
import { effectOf, prepare, strokes, table } from "./support/keys.mjs";
import { assertMatrix, turned } from "./support/rotation.mjs";

test("keys: no two keys are the same, and the server has the same table", async () => {
    const names = table.map(({ name }) => name);
    assert.equal(new Set(names).size, names.length);
    const { script, close } = await openWithScript();
    assert.deepEqual((await script.request({ type: "get", what: "keymap" })).keys, table);
    await close();
});

let shared; // one page for all keys

for (const binding of table.filter(({ client }) => !client)) {
    test(`keys: ${binding.name} – ${binding.text}`, async () => {
        shared ??= await openWithScript({ lasting: true });
        const { page, script, press, errors } = shared;
        const before = await prepare(script, binding);
        await press(...strokes(binding));
        const after = await script.until((one) => one.turning || one.playing || !one.moving, "the end of the motion");
        effectOf(binding)(before, after, binding);
        const shown = await shownValues(page);
        assert.equal(shown.polytope, after.polytope.name);
        assert.equal(Number(shown.slices), after.slices.count);
        assert.ok(Math.abs(parseFloat(shown.alpha) - (after.alpha * 180) / Math.PI) <= 0.005, shown.alpha);
        assert.ok(Math.abs(parseFloat(shown.beta) - (after.beta * 180) / Math.PI) <= 0.005, shown.beta);
        // During playing, the page may show a later w than the state.
        const w = Number(shown.w.replace("\u2212", "-"));
        assert.ok(after.playing || Math.abs(w - after.section.w) <= 0.005, shown.w);
        if (binding.shift === "inverse") {
            const back = await press(...strokes(binding, true));
            assertMatrix(back.orientation, before.orientation);
        }
        if (binding.action === "turn") {
            const later = await script.until((one) => one.revision > after.revision + 2, "the turning to continue");
            assert.notDeepEqual(later.orientation, after.orientation);
            await page.keyboard.press("Space");
            await script.until((one) => !one.turning, "the turning to stop");
        }
        if (binding.action === "play") {
            await script.until((one) => one.section.w > after.section.w, "the focus to move");
            await page.keyboard.press("Shift+P");
            await script.until((one) => !one.playing, "the playing to stop");
        }
        assert.deepEqual(errors, []);
    });
}

test("keys: w changes from the perspective to the orthogonal projection, and then ends the projection", async () => {
    const { script, press, errors, close: end } = await openWithScript();
    assert.equal((await script.state()).projection, "off");
    const kinds = [];
    for (let i = 0; i < 4; ++i) kinds.push((await press("w")).projection);
    assert.deepEqual(kinds, ["perspective", "orthogonal", "off", "perspective"]);
    assert.deepEqual(errors, []);
    await end();
});

test("keys: elements are highlighted one after another, except hidden ones, and a notice says why not", async () => {
    const { page, script, press, errors, close: end } = await openWithScript();
    const highlighted = async (...keys) => (await press(...keys)).highlight;
    await script.request({ type: "set", polytope: "rectified 5-cell" });
    const { polytope } = await script.state();
    const octahedron = polytope.kinds.findIndex(({ name }) => name === "octahedron");
    await script.request({ type: "set", hidden: [octahedron] });
    const first = await highlighted("v", "c");
    assert.equal(first.element, "cell");
    const numbers = [first.number];
    while (numbers.length < 5) numbers.push((await highlighted("v", "c")).number);
    assert.equal(new Set(numbers).size, 5, `the five tetrahedra: ${numbers}`);
    assert.deepEqual(await highlighted("v", "Shift+C"), { element: "cell", number: numbers[3] });
    assert.deepEqual(await highlighted("v", "c"), { element: "cell", number: numbers[4] });
    assert.deepEqual(await highlighted("v", "c"), first, "the first one follows the last one");
    assert.deepEqual(await highlighted("u"), { element: "cell", number: numbers[4] });
    assert.equal((await highlighted("v", "v")).element, "vertex");
    assert.equal(await highlighted("Escape"), null);

    const points = { name: "points", format: "cloud", data: "0 0 0 0\n0 0 0 1" };
    const { revision } = await script.request({ type: "load", ...points });
    await presented(page, revision);
    for (const key of ["v", "c"]) await page.keyboard.press(key);
    await page.waitForFunction(() => /points has no cell/.test(document.getElementById("notice").textContent));
    assert.deepEqual(await highlighted("v", "v"), { element: "vertex", number: 0 }, "the refused keys are forgotten");
    assert.equal(await page.textContent("#notice"), "");
    assert.deepEqual(errors, []);
    await end();
});

/**
 * Presses a digit key of a keyboard with another layout. `key` is what the key types; `code` is its place on the
 * keyboard.
 */
async function dispatch(page, { key, code, shift = false }) {
    if (inFirefox) return page.keyboard.pressOther({ key, code, shift });
    const session = await page.context().newCDPSession(page);
    const digit = code.charCodeAt("Digit".length);
    const event = { key, text: key, code, windowsVirtualKeyCode: digit, modifiers: shift ? 8 : 0 };
    for (const type of ["keyDown", "keyUp"]) await session.send("Input.dispatchKeyEvent", { type, ...event });
    return session.detach();
}

test("keys: a digit is recognized by the physical key, so Shift with it is the inverse on every layout", async () => {
    const layouts = [
        { shifted: '"', plain: "2" }, // British, German
        { shifted: "2", plain: "é" }, // French
        { shifted: "2", plain: "ě" }, // Czech
    ];
    for (const { shifted, plain } of layouts) {
        const { page, script, close: end } = await openWithScript();
        const start = await script.state();
        await dispatch(page, { key: plain, code: "Digit2" });
        const there = await script.until((one) => one.revision > start.revision, `a change by ${plain}`);
        assertMatrix(there.orientation, turned(start.orientation, ["xy"], [start.alpha]));
        await dispatch(page, { key: shifted, code: "Digit2", shift: true });
        const back = await script.until((one) => one.revision > there.revision, `a change by Shift and ${shifted}`);
        assertMatrix(back.orientation, start.orientation);
        await end();
    }
});

test("keys: parentheses typed with Shift and a digit move the focus to the next vertex", async () => {
    const { page, script, close: end } = await openWithScript();
    const layouts = { American: ["Digit0", "Digit9"], German: ["Digit9", "Digit8"] };
    for (const [layout, [closing, opening]] of Object.entries(layouts)) {
        const { section } = await script.state();
        await dispatch(page, { key: ")", code: closing, shift: true });
        const above = await script.until((one) => one.section.w > section.w, `a higher w, ${layout}`);
        assert.notEqual(above.section.vertices, "", "a vertex lies there");
        await dispatch(page, { key: "(", code: opening, shift: true });
        await script.until((one) => one.section.w < above.section.w, `a lower w, ${layout}`);
    }
    await end();
});

test("keys: brackets typed with AltGr, and letters typed on keyboards of another script, are recognized", async () => {
    const { page, script, close: end } = await openWithScript();
    const type = async (event, holds) => {
        await page.evaluate((init) => {
            const typed = new KeyboardEvent("keydown", { bubbles: true, cancelable: true, ...init });
            document.getElementById("drawing").dispatchEvent(typed);
        }, event);
        await script.until(holds, JSON.stringify(event));
    };
    const altGr = { modifierAltGraph: true, ctrlKey: true, altKey: true }; // as Windows reports AltGr
    await type({ key: "{", code: "Digit7", ...altGr }, (one) => one.slices.count === 19); // German
    await type({ key: "}", code: "Digit0", ...altGr }, (one) => one.slices.count === 21);
    await type({ key: "}", code: "Digit9", altKey: true }, (one) => one.slices.count === 23); // German, Mac
    await type({ key: "к", code: "KeyR" }, (one) => one.last?.planes.join() === "xw,yz"); // Russian
    await type({ key: "Т", code: "KeyN", shiftKey: true }, (one) => one.polytope.name !== "5-cell");
    await end();
});

test("keys: a sequence of two keys ends at Escape, at a click, and when the command line opens", async () => {
    const { page, script, close: end } = await openWithScript();
    const { x, y, height } = await page.locator("#drawing").boundingBox();
    const interruptions = {
        Escape: () => page.keyboard.press("Escape"),
        click: () => page.mouse.click(x + 8, y + height / 2 + 60),
        "command line": async () => {
            await page.keyboard.press(":");
            await page.keyboard.press("Escape");
        },
    };
    for (const [name, interrupt] of Object.entries(interruptions)) {
        await script.request({ type: "set", slices: { focus: 2 } });
        await page.keyboard.press("g");
        await interrupt();
        await page.keyboard.press("g");
        assert.equal((await stateAfter(page, script)).slices.focus, 2, name);
        await page.keyboard.press("g");
        await script.until(({ slices }) => slices.focus < 0, `the first slice after ${name}`);
    }
    await end();
});

test("keys: other keys are left to the browser", async () => {
    const { page, script, close: end } = await openWithScript();
    const { revision } = await script.state();
    await page.evaluate(() => {
        window.prevented = [];
        window.addEventListener("keydown", (event) => window.prevented.push(event.defaultPrevented));
    });
    const foreign = ["Control+k", "Control+2", "Alt+y", "Meta+k", "Control+Shift+R", "F3", "Shift+ArrowUp", "Tab"];
    for (const stroke of [...foreign, "Control+Home"]) await page.keyboard.press(stroke);
    await page.evaluate(() => {
        const composing = new KeyboardEvent("keydown", { key: "y", code: "KeyY", isComposing: true, bubbles: true });
        document.getElementById("drawing").dispatchEvent(composing);
    });
    assert.ok((await page.evaluate(() => window.prevented)).every((prevented) => !prevented));
    // A known key follows over the same connection. When it takes effect, everything before it has been processed.
    await page.keyboard.press("k");
    const after = await script.until((one) => one.revision > revision, "a change by k");
    assert.equal(after.revision, revision + 1);
    await end();
});

/**
 * Asserts that keys have no effect. Then sends a key that acts: when it takes effect, everything before it has been
 * processed.
 */
async function assertNoEffect(page, script, ...keys) {
    const { revision } = await script.state();
    for (const key of keys) await page.keyboard.press(key);
    await page.evaluate(() => document.querySelector("dialog[open]")?.close());
    await page.focus("#drawing");
    await page.keyboard.press("Shift+K");
    const after = await script.until((one) => one.revision > revision, "a change by K");
    assert.equal(after.revision, revision + 1, `${keys} changed the state`);
}

test("keys: keys act wherever the focus is, which is on the drawing at the start", async () => {
    const { page, script, press, close: end } = await openWithScript();
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing");
    for (const at of ["#drawing", "#help-button", "#polytope", "[data-action=faces]", "[name=color][value=cell]"]) {
        await page.focus(at);
        const { alpha } = await script.state();
        assert.ok((await press("k")).alpha > alpha, `k at ${at}`);
    }
    await page.evaluate(() => document.activeElement.blur());
    const { alpha } = await script.state();
    assert.ok((await press("k")).alpha > alpha, "k without a focus");
    await end();
});

test("keys: a control keeps its own keys; in text fields and dialogs, no key acts", async () => {
    const { page, script, press, close: end } = await openWithScript();
    await press("4");
    await page.focus("[data-action=alpha_up]");
    const { alpha } = await press("Space");
    assert.ok(alpha > Math.PI / 36 && !(await script.state()).turning, "the space bar presses the button");
    await page.focus("[name=color]:checked");
    const { camera, color } = await press("ArrowRight");
    assert.notEqual(color, "cell");
    assert.equal(camera.azimuth, 0, "the arrow is the radio button's");
    await page.keyboard.press(":");
    await assertNoEffect(page, script, "k", "Control+z", "ArrowLeft", "Space");
    await page.evaluate(() => {
        for (const html of ["input type=range", "input type=number", "select", "textarea", "p contenteditable"]) {
            document.querySelector(".stage").insertAdjacentHTML("beforeend", `<${html} class="added">`);
        }
    });
    const [slider, ...fields] = await page.locator(".added").all();
    await slider.focus();
    assert.ok((await press("k")).alpha > alpha, "a slider leaves other keys to the drawing");
    await slider.focus();
    await assertNoEffect(page, script, "ArrowLeft", "ArrowUp", "Home", "Space");
    for (const field of fields) {
        await field.focus();
        await assertNoEffect(page, script, "k", "4", "Control+z", "ArrowLeft", "Space", "Home");
    }
    await page.keyboard.press("?");
    await page.waitForSelector("#help[open]");
    await assertNoEffect(page, script, "k", "4", "Control+z", "ArrowLeft");
    await end();
});

test("keys: Escape returns the focus to the drawing", async () => {
    const { page, close: end } = await openWithScript();
    const focused = () => page.evaluate(() => document.activeElement.id);
    for (const at of ["#help-button", "[data-action=faces]", "[name=color]:checked"]) {
        await page.focus(at);
        assert.notEqual(await focused(), "drawing");
        await page.keyboard.press("Escape");
        assert.equal(await focused(), "drawing", at);
    }
    await page.focus("#help-button");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#help[open]");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#help:not([open])", { state: "attached" });
    assert.equal(await focused(), "help-button", "Escape in a dialog only closes the dialog");
    await end();
});

test("keys: Ctrl-Z undoes, Ctrl-Shift-Z and Ctrl-Y redo, Cmd does so on a Mac", async () => {
    const { script, press, close: end } = await openWithScript();
    const { orientation: start } = await script.state();
    const { orientation: there } = await press("4");
    for (const [undo, redo] of [
        ["Control+z", "Control+Shift+z"],
        ["Control+z", "Control+y"],
        ["Meta+z", "Meta+Shift+z"],
    ]) {
        assertMatrix((await press(undo)).orientation, start);
        assertMatrix((await press(redo)).orientation, there);
    }
    await end();
});

test("keys: arrows orbit, + and - zoom, Home moves the camera back, and so do the buttons", async () => {
    const { page, script, press, close: end } = await openWithScript();
    const increases = (name) => (before, after) => assert.ok(after[name] > before[name], name);
    const decreases = (name) => (before, after) => assert.ok(after[name] < before[name], name);
    const cameraEffects = {
        orbit_right: increases("azimuth"),
        orbit_left: decreases("azimuth"),
        orbit_up: increases("elevation"),
        orbit_down: decreases("elevation"),
        zoom_in: increases("zoom"),
        zoom_out: decreases("zoom"),
        reset_view: (_, after) => assert.deepEqual(after, { azimuth: 0, elevation: 0, zoom: 1 }),
    };
    const bindings = table.filter(({ group }) => group === "camera");
    assert.deepEqual(bindings.map(({ action }) => action).sort(), Object.keys(cameraEffects).sort());
    const camera = { azimuth: 0.1, elevation: 0.1, zoom: 1.05 };
    const restore = async () => {
        const { revision } = await script.request({ type: "set", camera });
        await presented(page, revision);
        return revision;
    };
    for (const { key, action } of bindings) {
        await restore();
        cameraEffects[action](camera, (await press(key)).camera);
        const revision = await restore();
        await page.click(`[data-action=${action}]`);
        const after = await script.until((one) => one.revision > revision, `a change by the button ${action}`);
        cameraEffects[action](camera, after.camera);
    }
    await end();
});

test("keys: a held key repeats no faster than pictures arrive, and stops when released", async () => {
    const { page, script, close: end } = await openWithScript();
    await page.evaluate(() => {
        window.sent = 0;
        window.held = [];
        const { send } = WebSocket.prototype;
        WebSocket.prototype.send = function (text) {
            if (JSON.parse(text).type !== "key") return send.call(this, text);
            ++window.sent;
            return void window.held.push(() => send.call(this, text)); // the server receives it later
        };
    });
    const sent = () => page.evaluate(() => window.sent);
    for (let times = 1; times <= 3; ++times) {
        for (let i = 0; i < 20; ++i) await page.keyboard.down("y"); // as a held key repeats
        assert.equal(await sent(), times, "a key is sent only after the previous one's picture was presented");
        const { revision } = await script.state();
        await page.evaluate(() => window.held.shift()());
        await script.until((one) => one.revision > revision, "the turn");
        await presented(page, (await stateAfter(page, script)).revision);
    }
    await page.keyboard.up("y");
    await idle(page);
    assert.equal(await sent(), 3, "nothing is sent any more");
    await end();
});

test("keys: a held second key of a sequence repeats the sequence if it may, and does not act by itself", async () => {
    const { page, script, press, close: end } = await openWithScript();
    await press("4");
    const { shown } = await press("w"); // with a projection, only c shows or hides its cells
    const numbers = [];
    await page.keyboard.press("v");
    for (let times = 0; times < 3; ++times) {
        const { revision } = await script.state();
        await page.keyboard.down("c"); // from the second time on, as a held key repeats
        const after = await script.until((one) => one.revision > revision, "the next cell");
        numbers.push(after.highlight?.number);
        assert.deepEqual(after.shown, shown);
        await presented(page, (await stateAfter(page, script)).revision);
    }
    await page.keyboard.up("c");
    const [first] = numbers;
    assert.deepEqual(numbers, [first, (first + 1) % 5, (first + 2) % 5]);
    await press("Escape");
    await page.keyboard.press("z");
    for (let times = 0; times < 2; ++times) {
        await page.keyboard.down("c");
        const { revision } = await stateAfter(page, script);
        const after = await script.until((one) => one.revision >= revision && !one.moving, "the end of the turn");
        await presented(page, after.revision);
        assert.deepEqual(after.shown, shown);
    }
    await page.keyboard.up("c");
    await end();
});

test("keys: the second key of a sequence is not the key of the page, even if it is held", async () => {
    const { page, script, press, close: end } = await openWithScript();
    const { slices } = await script.state();
    const isNear = (x, expected) => Math.abs(x - expected) < 1e-9;
    await page.keyboard.press("g");
    for (let times = 1; times <= 3; ++times) {
        const { revision } = await script.state();
        await page.keyboard.down("x"); // from the second time on, as a held key repeats
        const after = await script.until((one) => one.revision > revision, "a step of the point");
        assert.ok(isNear(after.point[0], times * slices.spacing), `${after.point}`);
        await presented(page, (await stateAfter(page, script)).revision);
    }
    await page.keyboard.up("x");
    const { point } = await press("g", "Shift+X");
    assert.ok(isNear(point[0], 2 * slices.spacing), `${point}`);
    assert.equal(await page.locator("dialog[open]").count(), 0);
    await page.keyboard.press("x");
    await page.waitForSelector("#export[open]");
    await end();
});

test("keys: the second key of a sequence is no other key when Shift is released while it is held", async () => {
    const { page, script, close: end } = await openWithScript();
    const { slices, point } = await script.state();
    await page.keyboard.press("g");
    await page.keyboard.down("Shift");
    await page.keyboard.down("X");
    await page.keyboard.up("Shift");
    await page.keyboard.down("x");
    const { point: later } = await stateAfter(page, script);
    await page.keyboard.up("x");
    assert.ok(Math.abs(later[0] - (point[0] - slices.spacing)) < 1e-9, `${later}`);
    assert.equal(await page.locator("dialog[open]").count(), 0);
    await end();
}, { needs: "repetition of a key whose character changes" });

test("keys: single keys can be turned off, which the browser remembers", async () => {
    const { page, script, close: end } = await openWithScript({ viewport: { width: 1280, height: 800 } });
    const button = () => page.locator("[data-page-tool=single_keys]");
    const { revision } = await script.state();
    await button().click();
    assert.equal(await button().getAttribute("aria-pressed"), "false");
    await page.focus("#drawing");
    for (const key of ["y", "Y", "k", "2", ":", "?", "n"]) await page.keyboard.press(key);
    await page.keyboard.press("ArrowRight"); // has no character
    await script.until((one) => one.camera.azimuth !== 0, "an arrow orbits");
    const { last, alpha, polytope, ...state } = await stateAfter(page, script);
    assert.deepEqual([last, alpha, polytope.name], [null, Math.PI / 36, "5-cell"]);
    assert.ok(state.revision > revision);
    assert.equal(await page.locator("dialog[open]").count(), 0);
    await script.request({ type: "rotate", planes: ["xw"], angles: [1] });
    await page.keyboard.press("Control+z");
    await script.until((one) => one.last === null, "Ctrl-Z");
    await page.reload();
    await page.waitForSelector("[data-page-tool=single_keys][aria-pressed=false]");
    await button().click();
    await page.focus("#drawing");
    await page.keyboard.press("y");
    await script.until(({ last }) => last !== null, "a key that acts again");
    await end();
});
