// The first visit of a browser: its view, the welcome line, and the tour.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, named, openPage, openWithScript, presented, ready, scriptFor, stateAfter } from "./support/browser.mjs";
import { covered, decode } from "./support/pixels.mjs";

const kBackground = [16, 20, 28];

const isShown = (page, selector) => page.locator(selector).isVisible();
const step = (page) => page.locator("#tour [data-target]:visible").innerText();
const focused = (page) => page.evaluate(() => document.activeElement.id);

test("first visit: a turned polytope fills the oval, and the welcome says what is seen", async () => {
    const { page, script, errors, close } = await openWithScript({ firstVisit: true });
    await named(page, "24-cell");
    const { orientation, last, revision } = await script.state();
    await presented(page, revision);
    assert.ok(orientation[3][3] < 0.99, "it is turned");
    assert.ok(last.angles.every((angle) => Math.abs(angle) < 0.1), "the space bar turns it slowly");
    assert.match(await page.locator("#welcome p").innerText(), /slice.*4-D object.*y.*turn.*h.*l.*focus/s);
    await page.click("#welcome-close");
    assert.equal(await isShown(page, "#welcome"), false);
    assert.equal(await focused(page), "drawing");
    const first = covered(decode(await page.locator("#drawing").screenshot()), kBackground);
    const usual = await openPage();
    const initial = covered(decode(await usual.page.locator("#drawing").screenshot()), kBackground);
    assert.ok(first > 1.5 * initial, `${first} of the picture is covered, usually ${initial}`);
    await usual.close();
    assert.deepEqual(errors, []);
    await close();
});

test("first visit: the second visit of a browser is an ordinary one", async () => {
    const { url } = await common();
    const { page, context, close } = await openPage({ firstVisit: true });
    await named(page, "24-cell");
    const second = await context.newPage();
    await second.goto(url);
    await named(second, "5-cell");
    assert.equal(await isShown(second, "#welcome"), false);
    await page.reload();
    await ready(page);
    await named(page, "24-cell");
    assert.equal(await isShown(page, "#welcome"), false, "a reload keeps the session, without the welcome");
    await close();
});

test("first visit: an address with a view or a session is shown as it is", async () => {
    const { url } = await common();
    const query = await openPage({ firstVisit: true, url: `${url}?polytope=16-cell` });
    await named(query.page, "16-cell");
    assert.equal(await isShown(query.page, "#welcome"), false);
    const { session, token } = (await scriptFor(query.page)).client.credentials;
    const shared = await openPage({ firstVisit: true, url: `${url}#session=${session}&token=${token}` });
    await named(shared.page, "16-cell");
    assert.equal(await isShown(shared.page, "#welcome"), false);
    await shared.close();
    await query.close();
});

test("first visit: the page works if the browser forbids storage", async () => {
    const before = () => {
        for (const name of ["localStorage", "sessionStorage"]) {
            Object.defineProperty(window, name, {
                get() {
                    throw new DOMException("forbidden", "SecurityError");
                },
            });
        }
    };
    const { page, errors, close } = await openPage({ firstVisit: true, before });
    await named(page, "5-cell");
    assert.equal(await isShown(page, "#welcome"), false);
    assert.deepEqual(errors, []);
    await close();
});

test("first visit: Escape closes the welcome, which another key alone leaves", async () => {
    const { page, press, close } = await openWithScript({ firstVisit: true });
    await named(page, "24-cell");
    const { slices } = await press("l");
    assert.equal(slices.focus, 1);
    assert.equal(await isShown(page, "#welcome"), true);
    await page.keyboard.press("Escape");
    assert.equal(await isShown(page, "#welcome"), false);
    await close();
});

test("first visit: the welcome covers nothing, and leaves when its advice was followed or by a gesture", async () => {
    const visits = [
        async ({ press }) => {
            await press("y");
            await press("l");
        },
        async ({ press }) => {
            await press("h");
            await press("4");
        },
        async ({ page }) => {
            const { x, y, width, height } = await page.locator("#drawing").boundingBox();
            await page.mouse.move(x + width / 2, y + height / 2);
            await page.mouse.down();
            await page.mouse.move(x + width / 2 + 30, y + height / 2);
            await page.mouse.up();
        },
        async ({ page }) => {
            await page.mouse.move(400, 400);
            await page.mouse.wheel(0, 100);
        },
    ];
    for (const [i, visit] of visits.entries()) {
        const viewport = [{ width: 1280, height: 800 }, { width: 320, height: 256 }][i % 2];
        const opened = await openWithScript({ firstVisit: true, ...(i < 2 && { viewport }) });
        const { page, close } = opened;
        await named(page, "24-cell");
        const [welcome, drawing] = await Promise.all(
            ["#welcome", "#drawing"].map((selector) => page.locator(selector).boundingBox()),
        );
        assert.ok(welcome.y + welcome.height <= drawing.y && drawing.height > 40, JSON.stringify({ welcome, drawing }));
        await visit(opened);
        await page.waitForSelector("#welcome", { state: "hidden" });
        await close();
    }
});

test("tour: five steps point at what they explain, forward and back", async () => {
    const { page, errors, close } = await openWithScript({ firstVisit: true, viewport: { width: 1440, height: 900 } });
    await page.click("#welcome-tour");
    assert.equal(await isShown(page, "#welcome"), false);
    const targets = ["#drawing", "[data-group=turn]", "#drawing", "#drawing", "#header-files"];
    const texts = [];
    for (const [i, target] of targets.entries()) {
        assert.equal(await page.locator("#tour-number").innerText(), `${i + 1} of 5`);
        texts.push(await step(page));
        const [at, ring, panel] = await Promise.all(
            [target, "#tour-ring", "#tour"].map((selector) => page.locator(selector).boundingBox()),
        );
        assert.ok(Math.abs(ring.x - at.x) <= 5 && Math.abs(ring.x + ring.width - at.x - at.width) <= 5, target);
        assert.ok(ring.y >= at.y - 5 && ring.y + ring.height <= at.y + at.height + 5, target);
        assert.ok(panel.x >= 0 && panel.y >= 0 && panel.x + panel.width <= 1440 && panel.y + panel.height <= 900);
        const apart = (axis, size) => panel[axis] >= ring[axis] + ring[size] || ring[axis] >= panel[axis] + panel[size];
        const isAround = panel.width < ring.width && panel.height < ring.height;
        assert.ok(apart("x", "width") || apart("y", "height") || isAround, `the panel does not cover ${target}`);
        if (i < 4) await page.click("#tour-next");
    }
    assert.equal(new Set(texts).size, 5);
    assert.equal(await isShown(page, "#tour-next"), false);
    for (let i = 3; i >= 0; --i) {
        await page.click("#tour-back");
        assert.equal(await step(page), texts[i]);
    }
    assert.equal(await page.locator("#tour-back").isDisabled(), true);
    await page.click("#tour-end");
    assert.equal(await isShown(page, "#tour"), false);
    assert.equal(await isShown(page, "#tour-ring"), false);
    assert.equal(await focused(page), "drawing");
    assert.deepEqual(errors, []);
    await close();
});

test("tour: one step shows a field, and the user's object and view return after it", async () => {
    const { page, script, press, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "16-cell", slices: { count: 11 } });
    await press("y");
    const before = await script.state();
    await page.keyboard.press("?");
    await page.click("#help-tour");
    const goTo = async (number, button) => {
        while (!(await page.locator("#tour-number").innerText()).startsWith(number)) await page.click(button);
    };
    const leaveBy = async (button) => {
        await page.click(button);
        const { polytope, orientation, slices } = await script.until((one) => one.polytope.name === "16-cell", button);
        assert.deepEqual([polytope, slices], [before.polytope, before.slices]);
        const difference = (row, column) => Math.abs(orientation[row][column] - before.orientation[row][column]);
        const axes = [0, 1, 2, 3];
        const isTurnedBack = axes.every((row) => axes.every((column) => difference(row, column) < 1e-12));
        assert.ok(isTurnedBack, "it is turned as before");
    };
    for (const leave of ["#tour-next", "#tour-back"]) {
        await goTo("4", leave === "#tour-next" ? "#tour-next" : "#tour-back");
        await script.until((one) => one.polytope.name === "tiger" && one.field, "the field");
        await press("4"); // the rotation applies to the field
        await leaveBy(leave);
    }
    await goTo("4", "#tour-next");
    await script.until((one) => one.polytope.name === "tiger", "the field");
    await script.request({ type: "set", polytope: "24-cell" });
    await page.click("#tour-end");
    assert.equal((await stateAfter(page, script)).polytope.name, "24-cell", "what is chosen during the tour stays");
    assert.deepEqual(errors, []);
    await close();
});

test("first visit: a button of the welcome shows a field", async () => {
    const { page, script, errors, close } = await openWithScript({ firstVisit: true });
    await named(page, "24-cell");
    await page.click("#welcome-field");
    const { field, revision } = await script.until((one) => one.polytope.name === "tiger", "the field");
    assert.match(field.formula, /sqrt/);
    await presented(page, revision);
    assert.equal(await isShown(page, "#welcome"), true, "its advice also applies to a field");
    assert.deepEqual(errors, []);
    await close();
});

test("tour: works with the keyboard alone, while keys still turn the polytope", async () => {
    const { page, script, close } = await openWithScript();
    await page.keyboard.press("?");
    await page.focus("#help-tour");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#tour-next:focus");
    assert.equal(await isShown(page, "#help"), false);
    await page.keyboard.press("y");
    const { last } = await script.until((one) => one.last !== null, "the rotation");
    assert.deepEqual(last.planes, ["xy", "zw"]);
    for (const key of ["Enter", "Space", "Enter", "Space"]) await page.keyboard.press(key);
    assert.equal(await page.locator("#tour-number").innerText(), "5 of 5");
    assert.equal(await focused(page), "tour-end", "the button that disappears passes the focus on");
    assert.equal((await script.state()).turning, false);
    for (let i = 0; i < 4; ++i) await page.locator("#tour-back").press("Enter");
    assert.equal(await focused(page), "tour-next");
    await page.keyboard.press("Escape");
    assert.equal(await isShown(page, "#tour"), false);
    assert.equal(await focused(page), "drawing");
    await close();
});

test("tour: on a phone and zoomed in, its panel and buttons are in the window", async () => {
    for (const [width, height] of [[390, 844], [320, 256], [667, 375]]) {
        const { page, close } = await openWithScript({ firstVisit: true, viewport: { width, height } });
        const welcome = await page.locator("#welcome").boundingBox();
        assert.ok(welcome.x >= 0 && welcome.x + welcome.width <= width);
        await page.click("#welcome-tour");
        for (let i = 0; i < 5; ++i) {
            for (const part of ["#tour", "#tour-end", "#tour-ring"]) {
                const box = await page.locator(part).boundingBox();
                const [right, bottom] = [box.x + box.width, box.y + box.height].map((end) => end - 0.01); // rounded
                const isWithin = box.x >= 0 && box.y >= 0 && right <= width && bottom <= height;
                assert.ok(isWithin, `${width} × ${height}, step ${i + 1}: ${part} ${JSON.stringify(box)}`);
            }
            if (i < 4) await page.click("#tour-next");
        }
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
        await close();
    }
});
