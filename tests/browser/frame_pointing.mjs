// The element under the pointer in the server's pictures: when the page asks for its name, and when the page shows it.
import assert from "node:assert/strict";

import { assertSame, columnsOf, faceIn, frames, label, labeled, named } from "./support/pointing.mjs";
import { openTurned, rounded, shot } from "./support/pointing.mjs";
import { idle, presented } from "./support/browser.mjs";
import { passTime } from "./support/page_time.mjs";
import { project, worldPoints } from "./support/scene.mjs";
import { test } from "./support/suite.mjs";

const kRest = 200; // milliseconds without a new picture after which the page asks the server
const kLong = 1000; // milliseconds after which every due request has been sent
const kBackground = [4, 4];

/**
 * Runs in the page. Logs the questions about points, and the elements in the requested pictures. Can hold back the
 * answers, the keys or the requests for pictures.
 */
function watchRequests() {
    /** Moves a pointer of this type over the drawing immediately, without the browser's input queue. */
    window.movePointer = (pointerType, [x, y]) => {
        const drawing = document.getElementById("drawing");
        const { left, top } = drawing.getBoundingClientRect();
        const place = { clientX: left + x, clientY: top + y };
        drawing.dispatchEvent(new PointerEvent("pointermove", { pointerType, pointerId: 7, ...place }));
    };
    window.asked = [];
    window.lit = [];
    window.isHeld = { answers: false, keys: false, pictures: false };
    window.held = { answers: [], keys: [], pictures: [] };
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
        const message = JSON.parse(text);
        const time = performance.now();
        if (message.type === "shown") window.shownAt = time;
        if (message.what === "at") window.asked.push({ ...message, time, rested: time - window.shownAt });
        if (message.what === "frame") window.lit.push(message.highlight);
        const kind = message.type === "key" ? "keys" : message.what === "frame" ? "pictures" : "";
        if (!window.isHeld[kind]) return send.call(this, text);
        return void window.held[kind].push(() => send.call(this, text));
    };
    const { set } = Object.getOwnPropertyDescriptor(WebSocket.prototype, "onmessage");
    Object.defineProperty(WebSocket.prototype, "onmessage", {
        set(handler) {
            set.call(this, (event) => {
                const isHeld = window.isHeld.answers && /^\{"type":"at"/.test(event.data);
                if (isHeld) window.held.answers.push(() => handler?.call(this, event));
                else handler?.call(this, event);
            });
        },
    });
}

/** Opens the page with a picture that the server has drawn and that rests. */
async function openServed() {
    const opened = await openTurned({}, { before: watchRequests, isStopped: true });
    const { page } = opened;
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    /**
     * Lets time pass in the page, and waits until the page has reacted. If `isHeld` is true, an answer is held back,
     * and the function does not wait for it.
     */
    const pass = async (milliseconds, { isHeld = false } = {}) => {
        await frames(page);
        await passTime(page, milliseconds);
        await (isHeld ? frames(page) : idle(page));
    };
    await idle(page);
    await presented(page, (await opened.script.state()).revision);
    await pass(kLong);
    return {
        ...opened,
        pass,
        /** Moves the mouse, then waits until the page has asked and shown the answer. */
        async hoverAt(x, y) {
            await opened.moveTo(x, y);
            await pass(kLong);
        },
        asked: () => page.evaluate(() => window.asked),
        forget: () => page.evaluate(() => void (window.asked.length = 0)),
        /** Waits until the page has asked at least `times` times. */
        untilAsked: (times) => page.waitForFunction((least) => window.asked.length >= least, times),
        /** Starts to hold back the answers about points, the keys, or the requests for pictures. */
        hold: (what) => page.evaluate((name) => void (window.isHeld[name] = true), what),
        /** Waits for something to be held back, passes on the first of it, and returns the label's text after that. */
        async passFirst(what) {
            await page.waitForFunction((name) => window.held[name].length > 0, what);
            await page.evaluate((name) => void window.held[name].shift()(), what);
            return label(page);
        },
        /** Passes on everything that is held back, and holds back nothing more. */
        release: (what) =>
            page.evaluate((name) => {
                window.isHeld[name] = false;
                window.held[name].splice(0).forEach((passOn) => passOn());
            }, what),
    };
}

test("frame pointing: the server names what is under the mouse, with the words of the page's own picture", async () => {
    const { page, script, errors, size, picture, hoverAt, asked, close } = await openServed();
    const seen = await picture();
    const { at, source } = faceIn(seen, size, 1);
    const { revision } = await script.state();
    await hoverAt(...at);
    const text = await labeled(page, /volume/);
    const sizes = "volume 3.77 · w −?[\\d.]+ … −?[\\d.]+";
    assert.match(text, new RegExp(`^Cell ${source} · octahedron · ${sizes} · slice w 0.20$`));
    const [{ type, what, width, height, x, y }] = await asked();
    assert.deepEqual([type, what, width, height], ["get", "at", size.width, size.height]);
    assert.ok(Math.hypot(x - at[0], y - at[1]) < 1);

    const vertex = 7;
    const numbers = [...seen.coordinates.slice(4 * vertex, 4 * vertex + 4)].map(rounded);
    await hoverAt(...columnsOf(seen.scene, size)(vertex));
    assert.equal(await labeled(page, /^Vertex/), `Vertex ${vertex} (${numbers.join(", ")})`);

    const [whole] = seen.projection.parts;
    const placed = { position: seen.projection.position, vertices: whole.vertices };
    const points = worldPoints({ scale: seen.projection.scale }, placed);
    const { eye } = seen.scene.camera;
    const near = points.map((point) => Math.hypot(...point.map((value, k) => value - eye[k])));
    const nearest = near.indexOf(Math.min(...near));
    await hoverAt(...project(seen.scene, points[nearest], size));
    await labeled(page, new RegExp(`^Vertex ${whole.of.vertices[nearest] - 96} \\((−?[\\d.]+(, )?){4}\\)$`));

    await hoverAt(...kBackground);
    await labeled(page, /^$/);
    assert.equal((await script.state()).revision, revision, "pointing changes nothing");
    await page.click("[data-page-tool=geometry]");
    await page.waitForSelector("#drawing[data-drawn-by=geometry]");
    await hoverAt(...at);
    assert.equal(await labeled(page, /volume/), text);
    assert.deepEqual(errors, []);
    await close();
});

test("frame pointing: the element under the mouse is highlighted as by the setting, until the mouse leaves", async () => {
    const { page, script, errors, size, picture, hoverAt, close } = await openServed();
    const { at, source } = faceIn(await picture(), size, 1);
    await hoverAt(...kBackground);
    const before = await shot(page);
    const { revision } = await script.state();
    const noLabel = [-1000, 0];
    await hoverAt(...at);
    await page.waitForSelector("#drawing[data-pointed-frame]");
    const lit = await shot(page);
    assert.throws(() => assertSame(before, lit, noLabel));
    await page.hover("#help-button");
    await page.waitForSelector("#drawing:not([data-pointed-frame])");
    assertSame(before, await shot(page), noLabel);
    assert.equal((await script.state()).revision, revision, "pointing changes nothing");

    const kept = await script.request({ type: "set", highlight: { element: "cell", number: source } });
    await presented(page, kept.revision);
    assertSame(lit, await shot(page), noLabel);
    assert.deepEqual(errors, []);
    await close();
});

test("frame pointing: the label goes when the mouse leaves, drags or touches, and the page asks nothing then", async () => {
    const { page, script, size, picture, moveTo, hoverAt, pass, asked, forget, close } = await openServed();
    const { at, source } = faceIn(await picture(), size, 1);
    const assertNamed = () => labeled(page, new RegExp(`^Cell ${source} `));
    await hoverAt(...at);
    await assertNamed();
    await page.hover("#help-button");
    await labeled(page, /^$/);
    await hoverAt(...at);
    await assertNamed();
    await forget();
    await page.mouse.down();
    await labeled(page, /^$/);
    await moveTo(at[0] + 2, at[1]);
    await moveTo(at[0] + 1, at[1]);
    await pass(kLong);
    assert.deepEqual(await asked(), [], "while a button is down");
    await moveTo(...at);
    await page.mouse.up(); // a click: highlights the cell in a new picture
    const { revision } = await script.until(({ highlight }) => highlight !== null, "the highlight");
    await presented(page, revision);
    await pass(kLong);
    assert.ok((await asked()).length > 0);
    await assertNamed();

    await page.hover("#help-button");
    await forget();
    await page.evaluate((place) => window.movePointer("touch", place), at);
    await pass(kLong);
    assert.deepEqual(await asked(), [], "a finger");
    assert.equal(await label(page), "");
    await close();
});

test("frame pointing: one request is in flight, and the next one is about the newest place", async () => {
    const { page, size, picture, moveTo, pass, asked, untilAsked, hold, passFirst, close } = await openServed();
    const { at, source } = faceIn(await picture(), size, 1);
    await hold("answers");
    await moveTo(...at);
    await untilAsked(1);
    for (let i = 0; i <= 20; ++i) await moveTo(at[0] + (kBackground[0] - at[0]) * (i / 20), at[1] * (1 - i / 20) + 4);
    await pass(kLong, { isHeld: true });
    assert.equal((await asked()).length, 1, "one in flight");
    assert.equal(await passFirst("answers"), "", "the pointer is far from the cell of this answer");
    await untilAsked(2);
    const { x, y } = (await asked())[1];
    assert.deepEqual([x, y], kBackground, "the places between are skipped");
    assert.equal(await passFirst("answers"), "");
    await pass(kLong);
    assert.equal((await asked()).length, 2);

    // When the answer arrives, the pointer has moved by a few pixels.
    await moveTo(...at);
    await untilAsked(3);
    await moveTo(at[0] + 3, at[1] + 2);
    await frames(page);
    assert.match(await passFirst("answers"), new RegExp(`^Cell ${source} `));
    await untilAsked(4);

    // Without an answer, the label follows the pointer for some pixels, but not farther.
    const top = async () => {
        await frames(page);
        return (await page.locator("#pointed").boundingBox()).y;
    };
    const before = await top();
    await moveTo(at[0] + 3, at[1] + 12);
    const after = await top();
    assert.ok(Math.abs(after - before - 10) <= 1, `from ${before} to ${after}`);
    await moveTo(at[0] + 60, at[1] + 2);
    await labeled(page, /^$/);
    await close();
});

test("frame pointing: a pointer that is back before the next request is answered", async () => {
    const { page, size, picture, pass, hold, release, close } = await openServed();
    const { at, source } = faceIn(await picture(), size, 1);
    await hold("answers");
    await page.evaluate(
        async ([place, away]) => {
            const turnOfLoop = () => new Promise((resolve) => setTimeout(resolve));
            window.movePointer("mouse", place);
            while (window.held.answers.length === 0) await turnOfLoop();
            window.movePointer("mouse", away);
            window.held.answers.shift()();
            await turnOfLoop();
            window.movePointer("mouse", place);
        },
        [at, kBackground],
    );
    await release("answers");
    await pass(kLong);
    await labeled(page, new RegExp(`^Cell ${source} `));
    await close();
});

test("frame pointing: it follows the pointer without a delay, but asks at most once per animation frame", async () => {
    const { page, size, picture, moveTo, hoverAt, asked, forget, close } = await openServed();
    const { at } = faceIn(await picture(), size, 1);
    const kMoves = 20;
    for (let i = 1; i <= kMoves; ++i) {
        await moveTo(at[0] + i - kMoves, at[1]); // no time passes
        await idle(page);
    }
    assert.equal((await asked()).length, kMoves);

    await forget();
    const count = await page.evaluate(
        async ([x, y]) => {
            const { dataset } = document.getElementById("connection");
            const turnOfLoop = () => new Promise((resolve) => setTimeout(resolve));
            let passed = 0;
            const countFrame = () => (++passed, requestAnimationFrame(countFrame));
            requestAnimationFrame(countFrame);
            for (let i = 0; i < 150; ++i) {
                window.movePointer("mouse", [x + (i % 40) - 20, y]);
                await turnOfLoop();
                while (dataset.unanswered !== "0") await turnOfLoop();
            }
            return passed;
        },
        at,
    );
    const times = (await asked()).length;
    assert.ok(times <= count + 1, `${times} requests in ${count} animation frames`);

    await hoverAt(Math.round(at[0]), Math.round(at[1]));
    await labeled(page, /./);
    await forget();
    await hoverAt(Math.round(at[0]) + 0.3, Math.round(at[1]) - 0.3);
    assert.deepEqual(await asked(), [], "only another pixel is worth a request");
    await hoverAt(Math.round(at[0]) + 1, Math.round(at[1]));
    assert.equal((await asked()).length, 1);
    await close();
});

test("frame pointing: names do not wait for pictures, which are requested one at a time, of the newest element", async () => {
    const { page, size, picture, moveTo, hold, release, close } = await openServed();
    const seen = await picture();
    const { at, source } = faceIn(seen, size, 1);
    const lit = () => page.evaluate(() => window.lit);
    await hold("pictures");
    await moveTo(...at);
    await named(page, new RegExp(`^Cell ${source} `));
    for (const vertex of [3, 7]) {
        await moveTo(...columnsOf(seen.scene, size)(vertex));
        await named(page, new RegExp(`^Vertex ${vertex} `));
    }
    const cell = { element: "cell", number: source };
    assert.deepEqual(await lit(), [cell], "one in flight");
    await release("pictures");
    await page.waitForSelector("#drawing[data-pointed-frame]");
    assert.deepEqual(await lit(), [cell, { element: "vertex", number: 7 }]);
    await close();
});

test("frame pointing: a new picture ends the label, and the page asks again when the picture rests", async () => {
    const { page, script, size, picture, press, hoverAt, pass, asked, forget, untilAsked, hold, passFirst, release, close } =
        await openServed();
    const { at } = faceIn(await picture(), size, 0);
    await hoverAt(...at);
    await labeled(page, /^Cell/);
    await hold("answers");
    const turn = async () => {
        const { revision } = await script.request({ type: "rotate", planes: ["xw"], angles: [0.001] });
        await presented(page, revision);
    };
    await turn();
    assert.equal(await label(page), "");
    await pass(kRest, { isHeld: true });
    await page.waitForFunction(() => window.held.answers.length === 1);
    await turn();
    assert.equal(await passFirst("answers"), "", "the answer is about the picture before");
    await release("answers");
    await pass(kLong);
    await labeled(page, /^Cell/);
    for (const { rested } of await asked()) assert.ok(rested >= kRest - 2, `${rested} ms after a picture`);

    // While the polytope turns, no label is shown.
    await press("Space");
    await labeled(page, /^$/);
    await forget();
    const { revision: first } = await script.state();
    await script.until((state) => state.revision > first + 5, "the turning");
    await hoverAt(at[0] + 2, at[1]);
    assert.deepEqual(await asked(), []);
    await press("Space");
    const { revision: last } = await script.until(({ turning }) => !turning, "the end of the turning");
    await presented(page, last); // the page counts its rest from the last picture
    await pass(kLong);
    await untilAsked(1);
    await close();
});

test("frame pointing: commands go first, and the requests of pointing fail silently", async () => {
    const { page, errors, size, picture, moveTo, hoverAt, pass, asked, untilAsked, hold, release, close } = await openServed();
    const { at } = faceIn(await picture(), size, 0);
    await page.focus("#drawing");
    await hold("keys");
    await page.keyboard.press("0"); // the focus is already at 0, so no new picture follows
    await page.waitForFunction(() => window.held.keys.length === 1);
    await moveTo(...at);
    await pass(kLong, { isHeld: true });
    assert.deepEqual(await asked(), [], "while a key is unanswered");
    await release("keys");
    await untilAsked(1);
    await labeled(page, /./);

    await page.evaluate(() => {
        const { send } = WebSocket.prototype;
        WebSocket.prototype.send = function (text) {
            WebSocket.prototype.send = send;
            return send.call(this, text.replace(/"x":\d+/, '"x":"left"'));
        };
    });
    await hoverAt(at[0] + 1, at[1]);
    await untilAsked(2);
    assert.equal((await asked())[1].x, "left", "the server has refused this one");
    assert.equal(await page.locator("#notice").isVisible(), false);
    await hoverAt(at[0] + 2, at[1]);
    await untilAsked(3);
    await labeled(page, /./);
    assert.deepEqual(errors, []);
    await close();
});
