// Gestures on the drawing with a mouse or with fingers.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { openWithScript, presented, stateAfter } from "./support/browser.mjs";
import { drawBy } from "./support/drawing.mjs";
import { compare, decode } from "./support/pixels.mjs";
import { project, worldPoints } from "./support/scene.mjs";
import { assertMatrix, isNear, turned } from "./support/rotation.mjs";
import { touchOf } from "./support/touch.mjs";

const shot = async (page) => decode(await page.locator("#drawing").screenshot());

/** Drags the mouse from one point to another while `keys` are held. */
async function dragWith(page, keys, from, to) {
    for (const key of keys) await page.keyboard.down(key);
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(...to, { steps: 8 });
    await page.mouse.up();
    for (const key of keys) await page.keyboard.up(key);
}

/** Waits until the polytope has this orientation, up to a tolerance. */
const orientationOf = (script, expected, tolerance, what) =>
    script.until(({ orientation }) => isNear(orientation, expected, tolerance), what);

/** The angle in radians by which a drag of one pixel turns the object. */
const perPixel = (page) => page.evaluate(() => Math.PI / document.getElementById("drawing").clientHeight);

test("pointer: dragging orbits the view, at once and in the session", async () => {
    const { page, script, errors, close } = await openWithScript();
    const before = await shot(page);
    await page.mouse.move(500, 300);
    await page.mouse.down();
    await page.mouse.move(440, 330, { steps: 6 });
    await page.mouse.up();
    const { camera, revision } = await script.until((one) => one.camera.azimuth > 0.1, "the orbit in the session");
    assert.ok(camera.elevation > 0.05, "dragging down raises the camera");
    await presented(page, revision);
    const after = await shot(page);
    assert.ok(compare(before, after).mean > 1);
    // The server's picture of this state is the same.
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await page.locator("#drawing").focus();
    assert.ok(compare(await shot(page), after).mean < 1);
    assert.deepEqual(errors, []);
    await close();
});

test("pointer: the view follows the mouse before the server has answered", async () => {
    const { page, close } = await openWithScript();
    const before = await shot(page);
    await page.evaluate(() => (WebSocket.prototype.send = () => {})); // from now on, the server receives nothing
    await page.mouse.move(500, 300);
    await page.mouse.down();
    await page.mouse.move(380, 300, { steps: 4 });
    await page.mouse.up();
    assert.ok(compare(before, await shot(page)).mean > 1);
    await close();
});

test("pointer: the wheel zooms, a double click resets the viewpoint, undo does not affect it", async () => {
    const { page, script, press, close } = await openWithScript();
    await press("4");
    await page.mouse.move(500, 300);
    await page.mouse.wheel(0, -300);
    await script.until((one) => one.camera.zoom > 1.2, "zooming in");
    await page.mouse.wheel(0, 900);
    await script.until((one) => one.camera.zoom < 0.8, "zooming out");
    const { camera } = await press("u");
    assert.ok(camera.zoom < 0.8, "undo reverts the rotation, not the zoom");
    await page.mouse.dblclick(500, 300);
    await script.until((one) => one.camera.zoom === 1 && one.camera.azimuth === 0, "the initial viewpoint");
    await close();
});

test("pointer: one finger orbits, two fingers zoom", async () => {
    const { page, script, close } = await openWithScript({ hasTouch: true });
    const send = await touchOf(page);
    await send("touchStart", [500, 300]);
    for (const x of [480, 450, 420]) await send("touchMove", [x, 300]);
    await send("touchEnd");
    const orbited = await script.until((one) => one.camera.azimuth > 0.1, "the orbit by a finger");
    assert.equal(orbited.camera.zoom, 1);
    const { revision } = await script.request({ type: "set", view: "single" });
    await presented(page, revision); // the slices in this picture limit the zoom
    await send("touchStart", [480, 300], [520, 300]);
    for (const d of [30, 45, 60]) await send("touchMove", [500 - d, 300], [500 + d, 300]);
    await send("touchEnd");
    const { last } = await script.until(({ camera }) => Math.abs(camera.zoom - 3) < 0.01, "a zoom of 3");
    assert.equal(last, null, "a pinch does not turn the polytope");
    await close();
});

test("pointer: orbiting and zooming keep half of the slices in the picture, and the way back is free", async () => {
    const { page, script, close } = await openWithScript();
    const share = async () => {
        const size = await sizeOf(page);
        const { scene, slices } = await script.request({ type: "get", what: "slices", ...size });
        const { eye, target } = scene.camera;
        const { zero, amplitude } = scene.coordinates;
        const lowest = (1 - zero - amplitude) * size.height; // the parallel coordinates cover the slices below
        const inFront = ({ position }) => eye.reduce((sum, e, k) => sum + (e - target[k]) * (e - position[k]), 0) > 0;
        const visible = slices.filter((slice) => {
            const [x, y] = project(scene, slice.position, size);
            return inFront(slice) && x >= 0 && x <= size.width && y >= 0 && y <= lowest;
        });
        return visible.length / slices.length;
    };
    const far = {
        left: () => dragWith(page, [], [900, 300], [100, 300]),
        right: () => dragWith(page, [], [100, 300], [900, 300]),
        up: () => dragWith(page, [], [500, 600], [500, 60]),
        down: () => dragWith(page, [], [500, 60], [500, 600]),
        in: () => page.mouse.wheel(0, -4000),
        out: () => page.mouse.wheel(0, 9000),
    };
    for (const mode of ["geometry", "frames"]) {
        await page.click(`[data-page-tool=${mode}]`);
        await page.waitForSelector(`#drawing[data-drawn-by=${mode}]`);
        await page.mouse.move(500, 300);
        for (const [direction, move] of Object.entries(far)) {
            const { revision } = await script.state();
            await move();
            await script.until((one) => one.revision > revision, `moving the camera ${direction}`);
            const { camera } = await stateAfter(page, script);
            assert.ok((await share()) >= 0.5, `${await share()} of the slices after moving ${direction} in ${mode}`);
            assert.ok(camera.zoom >= 0.25 && camera.zoom < 3);
            await script.request({ type: "set", camera: { azimuth: 0, elevation: 0, zoom: 1 } });
        }
    }
    await page.click("[data-page-tool=geometry]");
    await page.waitForSelector("#drawing[data-drawn-by=geometry]");
    await page.mouse.move(500, 300);
    // A command can move the camera beyond the limit. The page can then move it back.
    await script.request({ type: "set", camera: { azimuth: 0, elevation: 0, zoom: 8 } });
    const { revision } = await stateAfter(page, script);
    await presented(page, revision);
    await page.mouse.wheel(0, 300);
    const { camera } = await script.until((one) => one.camera.zoom < 8, "zooming out");
    assert.ok(camera.zoom > 4);
    await close();
});

const sizeOf = (page) =>
    page.evaluate(() => {
        const { clientWidth: width, clientHeight: height } = document.getElementById("drawing");
        return { width, height };
    });

test("pointer: Alt-drag rolls the 4-D ball, Alt-Shift-drag the ball of every slice", async () => {
    const { page, script, errors, close } = await openWithScript();
    const part = await perPixel(page);
    const { orientation: start, slices, camera } = await script.state();
    // The side of the object that faces the 4-D eye, +w, follows the pointer. A drag to the right turns +w toward +x.
    await dragWith(page, ["Alt"], [500, 300], [600, 300]);
    let expected = turned(start, ["xw"], [-100 * part]);
    const right = await orientationOf(script, expected, 1e-6, "a drag to the right");
    assert.ok(right.orientation[0][3] > 0, "+w moves toward +x");
    await dragWith(page, ["Alt"], [500, 300], [500, 240]);
    expected = turned(expected, ["yw"], [-60 * part]);
    assert.ok((await orientationOf(script, expected, 1e-6, "a drag up")).orientation[1][3] > 0, "+w moves toward +y");
    await dragWith(page, ["Alt", "Shift"], [500, 300], [460, 300]);
    expected = turned(expected, ["xz"], [40 * part]);
    await orientationOf(script, expected, 1e-6, "a drag to the left with Shift");
    await dragWith(page, ["Alt", "Shift"], [500, 300], [500, 350]);
    expected = turned(expected, ["yz"], [50 * part]);
    const after = await orientationOf(script, expected, 1e-6, "a drag down with Shift");
    assert.deepEqual([after.slices, after.camera], [slices, camera], "no click, no orbit");
    assert.deepEqual(errors, []);
    await close();
});

test("pointer: Alt-wheel turns in zw, Alt-Shift-wheel in xy, neither zooms", async () => {
    const { page, script, close } = await openWithScript();
    const { orientation: start } = await script.state();
    await page.mouse.move(500, 300);
    await page.keyboard.down("Alt");
    await page.mouse.wheel(0, -100);
    let expected = turned(start, ["zw"], [0.15]);
    await orientationOf(script, expected, 1e-6, "Alt-wheel");
    await page.keyboard.down("Shift");
    await page.mouse.wheel(0, -100);
    expected = turned(expected, ["xy"], [0.15]);
    const { camera } = await orientationOf(script, expected, 1e-6, "Alt-Shift-wheel");
    assert.equal(camera.zoom, 1);
    await close();
});

test("pointer: a gesture is one undo step", async () => {
    const { page, script, press, close } = await openWithScript();
    const { orientation: start } = await script.state();
    await dragWith(page, ["Alt"], [500, 300], [600, 250]);
    const { orientation: between } = await stateAfter(page, script);
    await dragWith(page, ["Alt"], [500, 300], [420, 330]);
    const { orientation: end } = await stateAfter(page, script);
    assert.ok(!isNear(start, between) && !isNear(between, end));
    assertMatrix((await press("u")).orientation, between);
    assertMatrix((await press("u")).orientation, start);
    assertMatrix((await press("Control+y")).orientation, between);
    await close();
});

test("pointer: turns wait for the answer to the previous ones, and are then sent together", async () => {
    const { page, script, close } = await openWithScript();
    await page.evaluate(() => {
        window.sent = [];
        window.held = [];
        const { send } = WebSocket.prototype;
        WebSocket.prototype.send = function (text) {
            const message = JSON.parse(text);
            if (message.type !== "rotate") return send.call(this, text);
            window.sent.push(message);
            return void window.held.push(() => send.call(this, text)); // the server receives it later
        };
        window.release = () => window.held.splice(0).forEach((sendNow) => sendNow());
    });
    const { orientation: start } = await script.state();
    const part = await perPixel(page);
    await page.keyboard.down("Alt");
    await page.mouse.move(500, 300);
    await page.mouse.down();
    for (let i = 1; i <= 20; ++i) {
        await page.mouse.move(500 + 5 * i, 300);
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
    }
    assert.equal(await page.evaluate(() => window.sent.length), 1);
    await page.evaluate(() => window.release());
    await page.waitForFunction(() => window.sent.length === 2);
    await page.evaluate(() => window.release());
    await page.mouse.up();
    await orientationOf(script, turned(start, ["xw"], [-100 * part]), 1e-6, "the whole drag");
    const sent = await page.evaluate(() => window.sent);
    assert.deepEqual(
        sent.map(({ planes, continues }) => ({ planes, continues })),
        [
            { planes: ["xw"], continues: undefined },
            { planes: ["xw"], continues: true },
        ],
    );
    await close();
});

test("pointer: dragging two fingers rolls the 4-D ball, twisting them turns in zw", async () => {
    const { page, script, press, close } = await openWithScript({ hasTouch: true });
    const send = await touchOf(page);
    const { orientation: start } = await script.state();
    await send("touchStart", [460, 300], [540, 300]);
    for (let x = 10; x <= 100; x += 10) await send("touchMove", [460 + x, 300], [540 + x, 300]);
    await send("touchEnd");
    const dragged = await stateAfter(page, script);
    assert.ok(dragged.orientation[0][3] > 0.2, "+w moves toward +x");
    assert.ok(Math.abs(dragged.orientation[2][3]) < 1e-9 && Math.abs(dragged.orientation[0][1]) < 1e-9);
    assert.ok(Math.abs(dragged.camera.zoom - 1) < 1e-6, "fingers that keep their distance do not zoom");
    assert.equal(dragged.camera.azimuth, 0);
    assertMatrix((await press("u")).orientation, start);
    const around = (angle) => [
        [500 - 60 * Math.cos(angle), 300 - 60 * Math.sin(angle)],
        [500 + 60 * Math.cos(angle), 300 + 60 * Math.sin(angle)],
    ];
    await send("touchStart", ...around(0));
    for (let angle = 0.05; angle <= 0.8; angle += 0.05) await send("touchMove", ...around(angle));
    await send("touchEnd");
    const { orientation } = await stateAfter(page, script);
    const angle = Math.atan2(orientation[3][2], orientation[2][2]);
    assert.ok(angle > 0.4 && angle < 0.8, `a turn by ${angle}`);
    assert.ok(isNear(orientation, turned(start, ["zw"], [angle]), 1e-6));
    await close();
});

test("pointer: dragging three fingers rolls the ball of every slice, twisting them turns in xy, neither zooms", async () => {
    const { page, script, press, errors, close } = await openWithScript({ hasTouch: true });
    const send = await touchOf(page);
    const { orientation: start, camera } = await script.state();
    const around = (x, y, angle = 0, radius = 60) =>
        [0, 1, 2].map((k) => {
            const direction = angle + (k * 2 * Math.PI) / 3;
            return [x + radius * Math.cos(direction), y + radius * Math.sin(direction)];
        });
    await send("touchStart", ...around(460, 300));
    for (let x = 5; x <= 100; x += 5) await send("touchMove", ...around(460 + x, 300));
    await send("touchEnd");
    const dragged = await stateAfter(page, script);
    const part = await perPixel(page);
    const angle = Math.asin(dragged.orientation[0][2]);
    assert.ok(angle > 70 * part && angle < 100 * part, `+z moves toward +x by ${angle}`);
    assert.ok(isNear(dragged.orientation, turned(start, ["xz"], [-angle]), 1e-6));
    assert.deepEqual(dragged.camera, camera);
    assertMatrix((await press("u")).orientation, start);

    await send("touchStart", ...around(500, 300));
    for (let twist = 0.05; twist <= 0.8; twist += 0.05) {
        await send("touchMove", ...around(500, 300, twist, 60 + 20 * twist));
    }
    await send("touchEnd");
    const twisted = await stateAfter(page, script);
    const clockwise = -Math.atan2(twisted.orientation[1][0], twisted.orientation[0][0]);
    assert.ok(clockwise > 0.4 && clockwise < 0.8, `a turn by ${clockwise}`);
    assert.ok(isNear(twisted.orientation, turned(start, ["xy"], [-clockwise]), 1e-6));
    assert.deepEqual(twisted.camera, camera, "fingers that spread do not zoom");
    assert.deepEqual(errors, []);
    await close();
});

test("pointer: two fingers that keep their distance are not told that zooming stops", async () => {
    const { page, script, close } = await openWithScript({ hasTouch: true });
    const send = await touchOf(page);
    await page.evaluate(() => {
        window.notices = [];
        const note = (changes) => changes.forEach(({ addedNodes }) => window.notices.push(...addedNodes));
        new MutationObserver(note).observe(document.getElementById("notice"), { childList: true });
    });
    await send("touchStart", [460, 300], [540, 300]);
    for (let y = 301; y <= 308; ++y) await send("touchMove", [460, y], [540, y]);
    await send("touchEnd");
    const { camera } = await stateAfter(page, script);
    assert.ok(Math.abs(camera.zoom - 1) < 1e-6);
    assert.deepEqual(await page.evaluate(() => window.notices.map((text) => text.data)), []);
    await close();
});

test("pointer: dragging with the right or the middle button rolls the 4-D ball", async () => {
    const { page, script, errors, close } = await openWithScript();
    await page.evaluate(() => {
        window.menus = [];
        window.addEventListener("contextmenu", (event) => window.menus.push(event.defaultPrevented));
    });
    const part = await perPixel(page);
    for (const button of ["right", "middle"]) {
        const { orientation } = await script.state();
        await page.mouse.move(500, 300);
        await page.mouse.down({ button });
        await page.mouse.move(560, 300, { steps: 4 });
        await page.mouse.up({ button });
        await orientationOf(script, turned(orientation, ["xw"], [-60 * part]), 1e-6, `a drag with the ${button} button`);
    }
    assert.ok((await page.evaluate(() => window.menus)).every((isPrevented) => isPrevented), "no menu opens over the drag");
    assert.deepEqual((await script.state()).highlight, null);
    assert.deepEqual(errors, []);
    await close();
});

/** The point of the page at which a slice's center is drawn. */
async function pointOf(page, script, index) {
    const size = await sizeOf(page);
    const { scene, slices } = await script.request({ type: "get", what: "slices", ...size });
    const slice = slices.find((one) => one.index === index);
    assert.ok(worldPoints(scene, slice).length > 0);
    const [x, y] = project(scene, slice.position, size);
    const box = await page.locator("#drawing").boundingBox();
    return [box.x + x, box.y + y];
}

test("pointer: a click on a slice makes it the focus, whoever draws the picture", async () => {
    const { page, script, errors, close } = await openWithScript();
    for (const mode of ["geometry", "frames"]) {
        await page.click(`[data-page-tool=${mode}]`);
        await page.waitForSelector(`#drawing[data-drawn-by=${mode}]`);
        for (const index of [2, -1, 6]) {
            const { revision } = await script.request({ type: "set", slices: { focus: 0 }, camera: { azimuth: 0.05 } });
            await presented(page, revision);
            await page.mouse.click(...(await pointOf(page, script, index)));
            await script.until(({ slices }) => slices.focus === index, `the focus at ${index} in ${mode}`);
        }
    }
    assert.deepEqual(errors, []);
    await close();
});

test("pointer: a drag, a click beside the slices and a click with a modifier leave the focus", async () => {
    const { page, script, close } = await openWithScript();
    const [x, y] = await pointOf(page, script, 2);
    await dragWith(page, [], [x, y], [x + 30, y]);
    await dragWith(page, ["Alt"], [x, y], [x + 30, y]);
    await script.request({ type: "set", camera: { azimuth: 0 } });
    const { revision } = await stateAfter(page, script);
    await presented(page, revision);
    await page.mouse.click(500, 70);
    await page.mouse.click(x, y, { button: "right" });
    await page.keyboard.down("Shift");
    await page.mouse.click(x, y);
    await page.keyboard.up("Shift");
    assert.equal((await stateAfter(page, script)).slices.focus, 0);
    await page.mouse.click(x, y);
    await script.until(({ slices }) => slices.focus === 2, "a click without a modifier");
    await close();
});

test("pointer: a word is said when zooming stops", async () => {
    const { page, script, close } = await openWithScript();
    await page.focus("#drawing");
    const said = () => page.locator("#notice").textContent();
    const press = async (key, pattern) => {
        for (let i = 0; i < 60 && !pattern.test(await said()); i++) {
            assert.equal(i < 59, true, `${key}: ${await said()}`);
            await page.keyboard.press(key);
        }
    };
    await press("+", /most slices would leave the picture/);
    await press("-", /as far away as it can be/);
    const { camera } = await script.state();
    assert.ok(camera.zoom < 0.5, String(camera.zoom));
    await close();
});

/** Runs in the page. Makes the server refuse the page's cameras and its questions about clicks. */
function spoilRequests() {
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
        const message = JSON.parse(text);
        if (message.camera) message.camera = { zoom: 1000 };
        if (message.what === "slices") message.width = message.height = 1;
        return send.call(this, JSON.stringify(message));
    };
}

test("pointer: the page says why the server refuses the camera, or does not tell what is clicked", async () => {
    const { page, errors, close } = await openWithScript({ before: spoilRequests });
    const told = (text) =>
        page.waitForFunction((part) => document.getElementById("notice").textContent.includes(part), text);
    await page.focus("#drawing");
    await page.keyboard.press("ArrowLeft");
    await told("zoom");
    await drawBy(page, "frames");
    await page.click("#drawing", { position: { x: 300, y: 200 } });
    await told("1×1 pixels");
    assert.deepEqual(errors, []);
    await close();
});
