// The slider of the focus slice, its marks, and the playing of the focus.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, stateAfter } from "./support/browser.mjs";
import { type } from "./support/command_line.mjs";

const kSlider = "#focus-w";
const kGolden = (1 + Math.sqrt(5)) / 2;

/** The different w of the vertices of a 600-cell with a vertex toward +w, in circumradii (Coxeter, table V(iii)). */
const k600CellLevels = [-1, -kGolden / 2, -1 / 2, (1 - kGolden) / 2, 0, (kGolden - 1) / 2, 1 / 2, kGolden / 2, 1];
const kRadius = 2 * kGolden; // the circumradius of a 600-cell whose edges have length 2

/** Opens the page with the 600-cell and a vertex toward +w. */
async function openSlider(options) {
    const opened = await openWithScript(options);
    await opened.script.request({ type: "set", polytope: "600-cell" });
    const { revision } = await opened.script.request({ type: "toward", element: "vertex", immediately: true });
    await presented(opened.page, revision);
    // Waits until exact values have replaced the rounded ones.
    await opened.page.waitForFunction(
        (most) => Math.abs(document.getElementById("focus-w").max - most) < 1e-12,
        kRadius,
    );
    return opened;
}

/** The places of the marks, from 0 at the slider's lowest w to 1 at its highest. */
const marks = (page) =>
    page.evaluate(() => {
        const outline = document.querySelector("#focus-marks path").getAttribute("d");
        return [...outline.matchAll(/M(\S+) 0V1/g)].map(([, x]) => Number(x));
    });

/** Waits until the slider has `count` marks. */
const marked = (page, count) =>
    page.waitForFunction((wanted) => {
        const outline = document.querySelector("#focus-marks path").getAttribute("d") ?? "";
        return outline.split("M").length - 1 === wanted;
    }, count);

/** The point of the page at the fraction `part` of the slider, from its lowest to its highest w. */
async function pointAt(page, part) {
    const { x, y, width, height } = await page.locator(kSlider).boundingBox();
    const thumb = await page.evaluate(() =>
        parseFloat(getComputedStyle(document.getElementById("focus-bar")).getPropertyValue("--thumb")),
    );
    return [x + thumb / 2 + part * (width - thumb), y + height / 2, width - thumb];
}

const near = (actual, expected, tolerance = 1e-9) => Math.abs(actual - expected) <= tolerance;
const partOf = (w) => (w / kRadius + 1) / 2;
const valueOf = (page) => page.locator(kSlider).evaluate((one) => one.valueAsNumber);
const untilAt = (script, w, tolerance, what) => script.until(({ section }) => near(section.w, w, tolerance), what);
const untilPlaying = (page, isOn = true) => page.waitForSelector(`#focus-play[aria-pressed=${isOn}]`);

/** Waits until the slider is at this w. */
const untilSliderAt = (page, w) =>
    page.waitForFunction((wanted) => Math.abs(document.getElementById("focus-w").valueAsNumber - wanted) < 1e-6, w);

test("slider: the marks are where vertices lie, and the thumb stands on them", async () => {
    const { page, script, errors, close } = await openSlider();
    const found = await marks(page);
    const expected = k600CellLevels.map((level) => (level + 1) / 2);
    assert.ok(found.length === 9 && found.every((x, i) => near(x, expected[i], 1e-12)), String(found));
    const { min, max } = await page
        .locator(kSlider)
        .evaluate(({ min, max }) => ({ min: Number(min), max: Number(max) }));
    assert.ok(near(min, -kRadius) && near(max, kRadius), `${min} to ${max}`);
    const [left, , width] = await pointAt(page, 0);
    const box = await page.locator("#focus-marks").boundingBox();
    assert.ok(near(box.x, left, 0.5) && near(box.width, width, 0.5), "an end of the marks is the thumb's center there");
    // A turned 600-cell would need a mark for each of its 120 vertices. These are too many, so their density is shown.
    await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.123, 0.456] });
    await script.request({ type: "rotate", planes: ["zw"], angles: [0.789] });
    await page.waitForSelector("#focus-marks [data-density][d^='M0 1V']", { state: "attached" });
    assert.deepEqual(errors, []);
    await close();
});

test("slider: the marks follow a turn before the exact values are there, and the server's pictures have marks", async () => {
    const { page, script, close } = await openSlider();
    await page.evaluate(() => {
        const { send } = WebSocket.prototype;
        const held = [];
        window.letSearchesPass = () => {
            WebSocket.prototype.send = send;
            for (const [socket, text] of held) socket.send(text);
        };
        WebSocket.prototype.send = function (text) {
            if (JSON.parse(text).what === "critical") held.push([this, text]);
            else send.call(this, text);
        };
    });
    await script.request({ type: "toward", element: "cell", immediately: true });
    await marked(page, 15); // sections of the 600-cell that begin with a cell: Coxeter, table V(iii)
    await page.evaluate(() => window.letSearchesPass());
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await script.request({ type: "toward", element: "vertex", number: 5, immediately: true });
    await marked(page, 9);
    await close();
});

test("slider: the marks follow another object of the same name and with as many elements", async () => {
    const { page, script, errors, close } = await openWithScript();
    // The value is 0.7 only if it is exact: the picture has float32 numbers.
    const untilMost = (most) =>
        page.waitForFunction((w) => Math.abs(document.getElementById("focus-w").max - w) < 1e-12, most);
    const load = async (...lengths) => {
        const pointOn = (axis, end) => [0, 1, 2, 3].map((k) => (k === axis ? end : 0)).join(" ");
        const data = lengths.flatMap((end, axis) => [pointOn(axis, end), pointOn(axis, -end)]).join("\n");
        await script.request({ type: "load", name: "mine", format: "points", data, center: "origin" });
        await untilMost(lengths[3]);
    };
    await load(2, 0.7, 0.7, 0.7);
    await script.request({ type: "set", slices: { focus: 1 } });
    await load(0.7, 0.7, 0.7, 2);
    assert.equal((await marks(page)).length, 3);
    await script.request({ type: "undo" }); // restores the first object with its focus
    await untilMost(0.7);
    assert.deepEqual(errors, []);
    await close();
});

test("slider: dragging moves the focus, and the values and the section are shown", async () => {
    const { page, script, errors, close } = await openSlider();
    const [x, y, width] = await pointAt(page, 0.5);
    const perPixel = (2 * kRadius) / width;
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (const part of [0.55, 0.62, 0.7]) {
        await page.mouse.move((await pointAt(page, part))[0], y, { steps: 3 });
        await untilAt(script, (2 * part - 1) * kRadius, 1.5 * perPixel, `a drag to ${part}`);
    }
    await page.mouse.up();
    const { section, slices } = await script.state();
    assert.ok(near(slices.offset + slices.focus * slices.spacing, section.w));
    assert.ok(near(await valueOf(page), section.w));
    await page.waitForFunction(
        (text) => document.querySelector("[data-state-field=w]").textContent === text,
        section.w.toFixed(2),
    );
    assert.equal(await page.getAttribute(kSlider, "aria-valuetext"), `w = ${section.w.toFixed(2)}`);
    assert.equal(await page.textContent("#focus-section"), "");
    assert.deepEqual(errors, []);
    await close();
});

test("slider: near a mark the drag snaps to it, except with Shift or Alt", async () => {
    const { page, script, close } = await openSlider();
    const drag = async (part, pixels, ...keys) => {
        const [x, y] = await pointAt(page, 0.02);
        await page.mouse.move(x, y);
        for (const key of keys) await page.keyboard.down(key);
        await page.mouse.down();
        await page.mouse.move((await pointAt(page, part))[0] + pixels, y, { steps: 5 });
        await page.mouse.up();
        for (const key of keys) await page.keyboard.up(key);
    };
    await drag(partOf(kGolden), 3);
    await script.until(({ section }) => section.vertices === "dodecahedron", "the exact section");
    await page.waitForFunction(() => document.getElementById("focus-section").textContent === "vertices: dodecahedron");
    assert.ok(near((await script.state()).section.w, kGolden, 1e-12));
    await drag(partOf(1 + kGolden), -3);
    await script.until(({ section }) => section.name === "icosahedron", "the icosahedron");
    await page.waitForSelector(`${kSlider}[aria-valuetext="w = 2.62, icosahedron"]`);
    const perPixel = (2 * kRadius) / (await pointAt(page, 0))[2];
    for (const key of ["Shift", "Alt"]) {
        await drag(partOf(kGolden), 3, key);
        const { section } = await untilAt(script, kGolden + 3 * perPixel, perPixel, `a drag with ${key}`);
        assert.ok(!near(section.w, kGolden, 1e-3) && section.vertices === "", `${key}: ${section.w}`);
    }
    await drag(partOf(kGolden), 8);
    const { section } = await untilAt(script, kGolden + 8 * perPixel, perPixel, "a drag that ends farther away");
    assert.ok(!near(section.w, kGolden, 1e-3));
    await close();
});

test("slider: works with the keyboard", async () => {
    const { page, script, errors, close } = await openSlider();
    const { camera } = await script.state();
    await page.focus(kSlider);
    const step = (2 * kRadius) / 200;
    for (const [key, w] of [
        ["ArrowRight", step],
        ["ArrowUp", 2 * step],
        ["ArrowLeft", step],
        ["ArrowDown", 0],
        ["PageUp", 1],
        ["PageUp", kGolden],
        ["PageDown", 1],
        ["End", kRadius],
        ["ArrowRight", kRadius],
        ["Home", -kRadius],
        ["PageUp", -1 - kGolden],
    ]) {
        await page.keyboard.press(key);
        await untilAt(script, w, 1e-9, `${key} to ${w}`);
        await untilSliderAt(page, w);
    }
    await page.waitForSelector(`${kSlider}[aria-valuetext="w = \u22122.62, icosahedron"]`);
    assert.deepEqual((await script.state()).camera, camera, "the arrows do not move the camera");
    const { alpha } = await script.state();
    await page.keyboard.press("k");
    await script.until((one) => one.alpha > alpha, "another key");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#drawing:focus");
    assert.deepEqual(errors, []);
    await close();
});

test("slider: a move waits for the answer to the previous one", async () => {
    const { page, script, close } = await openSlider();
    await page.evaluate(() => {
        window.sent = [];
        window.held = [];
        const { send } = WebSocket.prototype;
        WebSocket.prototype.send = function (text) {
            const message = JSON.parse(text);
            if (message.type !== "set") return send.call(this, text);
            window.sent.push(message.slices.w);
            return void window.held.push(() => send.call(this, text)); // the server receives it later
        };
        window.release = () => window.held.splice(0).forEach((sendNow) => sendNow());
    });
    await page.focus(kSlider);
    for (let i = 0; i < 20; ++i) {
        await page.keyboard.press("ArrowRight");
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
    }
    assert.equal(await page.evaluate(() => window.sent.length), 1);
    const last = 20 * ((2 * kRadius) / 200);
    assert.ok(near(await valueOf(page), last), "the slider is ahead of the answers");
    await page.evaluate(() => window.release());
    await page.waitForFunction(() => window.sent.length === 2);
    await page.evaluate(() => window.release());
    await untilAt(script, last, 1e-9, "all steps");
    await close();
});

test("slider: follows keys, undo and other clients", async () => {
    const { page, script, press, close } = await openSlider();
    await page.focus(kSlider);
    await page.keyboard.press("End");
    await untilAt(script, kRadius, 1e-9, "End");
    await page.focus("#drawing");
    await untilSliderAt(page, (await press("h")).section.w);
    await untilSliderAt(page, (await press("(")).section.w);
    await script.request({ type: "set", slices: { w: 0.25 } });
    await untilSliderAt(page, 0.25);
    await script.request({ type: "set", slices: { w: kRadius } });
    await untilSliderAt(page, kRadius);
    await page.focus(kSlider);
    await page.keyboard.press("Home");
    await untilSliderAt(page, -kRadius);
    await untilAt(script, -kRadius, 1e-9, "Home");
    await press("u");
    await untilSliderAt(page, kRadius);
    await close();
});

test("slider: Play moves the focus to and fro until it is pressed again, at the speed that is chosen", async () => {
    const { page, script, errors, close } = await openSlider();
    await script.request({ type: "set", slices: { w: 0.95 * kRadius } });
    await untilSliderAt(page, 0.95 * kRadius);
    assert.equal(await page.locator("#focus-speed").inputValue(), "1");
    await page.focus("#drawing");
    await page.click("#focus-play");
    await untilPlaying(page);
    assert.equal((await page.locator("#focus-play").innerText()).trim(), "Pause");
    await page.waitForSelector("#drawing:focus"); // a click does not move the focus
    await page.selectOption("#focus-speed", "4");
    await script.until(({ playing, speed }) => playing && speed === 4, "the speed");
    await script.until(({ section }) => section.w < 0.9 * kRadius, "the way back from the top");
    await page.click("#focus-play");
    await untilPlaying(page, false);
    assert.equal((await page.locator("#focus-play").innerText()).trim(), "Play");
    const { section, playing } = await stateAfter(page, script);
    assert.equal(playing, false);
    await untilSliderAt(page, section.w);
    assert.deepEqual(errors, []);
    await close();
});

test("slider: Play and its speed follow keys and other clients", async () => {
    const { page, script, close } = await openSlider();
    const shownSpeed = (text) =>
        page.waitForFunction((wanted) => {
            return document.getElementById("focus-speed").selectedOptions[0]?.textContent === wanted;
        }, text);
    await script.request({ type: "command", line: "play 3/2" });
    await untilPlaying(page);
    await shownSpeed("1.5×");
    await page.locator("#drawing").press("Shift+F");
    await script.until(({ speed }) => speed > 1.5, "the next power of two");
    await script.request({ type: "set", speed: 2 });
    await shownSpeed("2×");
    await page.locator("#drawing").press("Shift+P");
    await untilPlaying(page, false);
    await close();
});

test("slider: in the list of speeds, letters are the keys of the page, and arrows choose a speed", async () => {
    const { page, script, errors, close } = await openSlider();
    await page.focus("#focus-speed");
    await page.keyboard.press("k");
    const { alpha, revision } = await stateAfter(page, script);
    assert.ok(alpha > Math.PI / 36);
    await page.keyboard.press("Control+z");
    await script.until((state) => state.revision > revision && state.alpha < alpha, "the undo");
    await page.keyboard.press("Shift+F");
    await script.until(({ speed }) => speed === 2, "the key of the speed");
    const before = await script.state();
    await page.keyboard.press("2"); // the list gets this key: it may choose a speed, but turns nothing
    await page.keyboard.press("0"); // the list gets this key, too: the focus does not move
    const { orientation, slices } = await stateAfter(page, script);
    assert.deepEqual([orientation, slices], [before.orientation, before.slices]);
    assert.deepEqual(errors, []);
    await close();
});

/** The w of the focus slice as a text, with as many decimals as the page shows. */
function shownW({ section, slices }) {
    return section.w.toFixed(Math.max(2, Math.ceil(-Math.log10(slices.spacing)) + 1));
}

test("slider: playing stops at a drag, a key that moves the focus, a click, another client, and an export", async () => {
    const { page, script, close } = await openSlider();
    const ways = {
        async drag() {
            const [x, y] = await pointAt(page, 0.3);
            await page.mouse.click(x, y);
        },
        "arrow key": () => page.locator(kSlider).press("ArrowLeft"),
        key: () => page.locator("#drawing").press("h"),
        "click on a slice": () => page.click("#drawing", { position: { x: 60, y: 60 } }),
        script: () => script.request({ type: "set", slices: { w: -2 } }),
        async export() {
            await page.click("#export-button");
            await untilPlaying(page, false);
            const w = shownW(await stateAfter(page, script)).replace("-", "\u2212");
            await page.waitForSelector(`#export-focus:text-is("w = ${w}")`);
            await page.keyboard.press("Escape");
        },
        async "export command"() {
            const saving = page.waitForEvent("download");
            await type(page, "export stl");
            await untilPlaying(page, false);
            const w = shownW(await stateAfter(page, script));
            assert.equal((await saving).suggestedFilename(), `600-cell-w-${w}.stl`);
        },
    };
    for (const [name, stop] of Object.entries(ways)) {
        const { section } = await script.state();
        await page.click("#focus-play");
        await untilPlaying(page);
        await script.until((one) => one.playing && one.section.w !== section.w, `${name}: playing`);
        await stop();
        await untilPlaying(page, false).catch((error) => assert.fail(`${name}: ${error.message}`));
        assert.equal((await stateAfter(page, script)).playing, false, name);
    }
    await close();
});

const phone = { viewport: { width: 375, height: 667 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };

test("slider: covers nothing, is not covered, and is large enough, in every window", async () => {
    const windows = {
        wide: { viewport: { width: 1440, height: 900 } },
        "a phone": phone,
        "a phone on its side": { ...phone, viewport: { width: 667, height: 375 } },
        "zoomed to 400%": { viewport: { width: 320, height: 256 } },
    };
    for (const [name, options] of Object.entries(windows)) {
        const { page, script, close } = await openSlider(options);
        await script.request({ type: "set", slices: { w: kGolden } });
        await page.waitForFunction(() => document.getElementById("focus-section").textContent !== "");
        await page.locator("#focus-bar").scrollIntoViewIfNeeded();
        const faults = await page.evaluate(() => {
            const within = (a, b) => a.left >= b.left && a.right <= b.right && a.top >= b.top && a.bottom <= b.bottom;
            const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
            const boxOf = (selector) => document.querySelector(selector).getBoundingClientRect();
            const bar = boxOf("#focus-bar");
            const parts = ["#focus-play", "#focus-speed", "#focus-bar .track", "#focus-section"];
            return [
                ...["#drawing", "#tools", "header"].filter((one) => overlap(boxOf(one), bar)),
                ...parts.filter((one) => !within(boxOf(one), bar)),
                ...parts.filter((one) => parts.some((other) => other !== one && overlap(boxOf(one), boxOf(other)))),
                ...(document.documentElement.scrollWidth > innerWidth ? ["the page is too wide"] : []),
            ];
        });
        assert.deepEqual(faults, [], name);
        const { width } = await page.locator(kSlider).boundingBox();
        assert.ok(width >= 140, `${name}: the slider is ${width} wide`);
        const part = partOf(1 + kGolden);
        if (options.hasTouch) await page.touchscreen.tap(...(await pointAt(page, part)).slice(0, 2));
        else await page.mouse.click(...(await pointAt(page, part)).slice(0, 2));
        await script.until(({ section }) => section.name === "icosahedron", `${name}: a tap on a mark`);
        await close();
    }
});

test("slider: the marks of a field are where its body changes its topology, and the keys move there", async () => {
    const { page, script, press, close } = await openWithScript();
    const data = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09";
    await script.request({ type: "load", name: "tiger", format: "formula", data });
    await marked(page, 4);
    const expected = [-1, -0.4, 0.4, 1].map((w) => (w + 2) / 4); // ±b ± r, in the box from −2 to 2
    (await marks(page)).forEach((at, i) => assert.ok(near(at, expected[i], 1e-3), `${at}`));
    const { sections } = await script.request({ type: "get", what: "critical" });
    await press("Shift+Digit0"); // )
    await untilAt(script, sections[2].w, 1e-9, "the focus at the next change");
    await press("Shift+Digit9"); // (
    await untilAt(script, sections[1].w, 1e-9, "the focus at the change before");
    await close();
});
