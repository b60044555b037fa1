// The panel in which the user writes the formula of a field.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { idle, named, openPage, openWithScript, presented, restart, scriptFor, spoken, stateAfter } from "./support/browser.mjs";
import { picture } from "./support/drawing.mjs";
import { change, focusSurface, formula, openPanel, surfacePixels, write } from "./support/field.mjs";
import { passTime } from "./support/page_time.mjs";
import { distance } from "./support/pixels.mjs";
import { rgb } from "./support/scene.mjs";
import { startReplaceableServer } from "./support/proxy.mjs";

const kTyping = 150; // milliseconds without further typing before the page sends a change

test("field panel: the button opens the panel and shows a field, and what is typed is shown", async () => {
    const { page, script, errors, close } = await openPanel({ isStopped: true });
    assert.equal(await page.evaluate(() => document.activeElement.id), "field-formula");
    assert.equal(await page.locator("#tools").isVisible(), false, "the panel takes the place of the tools");
    const before = await script.state();
    await page.keyboard.press("Control+A");
    await page.keyboard.type("x^2+y^2+z^2+w^2 < 1.5^2");
    await passTime(page, kTyping);
    const { revision } = await script.until((state) => state.revision > before.revision, "the sphere");
    await presented(page, revision);
    const focus = await focusSurface(page, script);
    for (let i = 0; i < focus.surface.points.length; i += 3) {
        const radius = Math.hypot(...focus.surface.points.slice(i, i + 3));
        assert.ok(Math.abs(radius - 1.5) < 0.01, `a point at the distance ${radius} of the center`);
    }
    const shown = await picture(page);
    const background = rgb(focus.scene.colors.background);
    const pixels = surfacePixels(shown, focus);
    assert.ok(pixels.length > 20);
    assert.ok(pixels.every((pixel) => distance(pixel, background) > 24), "the sphere is seen");
    await page.click("#field-close");
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing");
    assert.equal(await page.locator("#tools").isVisible(), true);
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: a mistake is explained, and the wrong character is marked", async () => {
    const { page, script, errors, close } = await openPanel();
    const before = await script.state();
    const says = (pattern) =>
        page.waitForFunction(
            (source) => new RegExp(source).test(document.getElementById("field-error").textContent),
            pattern.source,
        );
    for (const [text, position, character] of [
        ["x^2 + $ + y", 7, "$"],
        ["x^2 + 2 (y", 9, "("],
        ["sqrt(x", 7, "\u00a0"],
    ]) {
        await page.fill("#field-formula", text);
        await says(new RegExp(`^Character ${position}: `));
        assert.equal(await page.locator("#field-excerpt mark").textContent(), character);
        assert.equal(await page.getAttribute("#field-formula", "aria-invalid"), "true");
    }
    assert.equal((await script.state()).revision, before.revision, "the last field is still shown");
    await write(page, script, "x^2 + y^2 < 1");
    await says(/^$/);
    assert.equal(await page.locator("#field-excerpt").isVisible(), false);
    assert.equal(await page.getAttribute("#field-formula", "aria-invalid"), "false");
    await page.fill("#field-formula", "");
    await says(/expected/);
    await page.fill("[data-end='x to']", "-3");
    assert.match(await page.locator("#field-box-error").textContent(), /^x: /);
    assert.equal(await page.getAttribute("[data-end='x to']", "aria-invalid"), "true");
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: a slider changes a named value in the text and the picture, and nothing else", async () => {
    const { page, script, errors, close } = await openPanel({ isStopped: true });
    await write(page, script, "x^2+y^2+z^2+w^2 < a^2; a=0.7, b=pi");
    await script.request({ type: "set", slices: { focus: 1 }, levels: [0, 0.5], color: "w" });
    await page.waitForFunction(() => document.getElementById("field-levels").value === "0, 0.5");
    const before = await focusSurface(page, script);
    await page.focus("[data-constant=a]");
    for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
    await page.waitForFunction(() => /a=0\.(75|8)/.test(document.getElementById("field-formula").value));
    assert.match(await formula(page), /^x\^2\+y\^2\+z\^2\+w\^2 < a\^2; a=0\.\d+, b=pi$/);
    const value = Number(/a=([\d.]+)/.exec(await formula(page))[1]);
    assert.equal(await page.locator("[data-constant=a] + output").textContent(), String(value));
    const reach = ({ surface }) => Math.max(...surface.points.filter((_, i) => i % 3 === 0));
    const state = await stateAfter(page, script);
    const after = await focusSurface(page, script);
    const outermost = (a) => Math.sqrt(a * a + 0.5 - after.slice.w ** 2);
    assert.ok(reach(after) > reach(before) + 0.01);
    assert.ok(Math.abs(reach(after) - outermost(value)) < 0.03, `${reach(after)}, not ${outermost(value)}`);
    assert.deepEqual([state.slices.focus, state.levels, state.color], [1, [0, 0.5], "w"]);
    await script.request({ type: "undo" });
    await page.waitForFunction(() => document.getElementById("field-formula").value.endsWith("; a=0.7, b=pi"));
    assert.match((await script.state()).field.formula, /; a=0\.7, b=3\.14\d*$/, "one undo takes back the whole drag");
    assert.equal(await page.locator("[data-constant=a] + output").textContent(), "0.7");
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: constants that are not typed as numbers have sliders, too, and expressions have none", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, "x^2+y^2+z^2+w^2 < a*p; a=pi/2, b=max(1, 2), p=b+0*x");
    await page.waitForSelector("[data-constant=b]");
    const sliders = page.locator("#field-constants input");
    const names = () => sliders.evaluateAll((all) => all.map(({ dataset }) => dataset.constant));
    assert.deepEqual(await names(), ["a", "b"]);
    assert.deepEqual(await page.locator("#field-constants output").allTextContents(), ["1.571", "2"]);
    await page.focus("[data-constant=a]");
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(() => / a=1\.58, b=max/.test(document.getElementById("field-formula").value));
    assert.deepEqual(await names(), ["a", "b"]);
    await script.until(({ field }) => /a=1\.58/.test(field.formula), "the value of the slider");
    assert.deepEqual(errors, []);
    await close();
});

/**
 * Runs in the page. Records the requests that load formulas, and the most such requests on their way at the same time.
 */
function recordLoads() {
    window.loads = [];
    window.most = 0;
    const waiting = new Set();
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
        const message = JSON.parse(text);
        if (message.type === "load") {
            window.loads.push(message.data);
            waiting.add(message.id);
            window.most = Math.max(window.most, waiting.size);
            this.addEventListener("message", ({ data }) => {
                if (typeof data === "string") waiting.delete(JSON.parse(data).id);
            });
        }
        return send.call(this, text);
    };
}

test("field panel: one formula is on its way at a time, the last one wins, and typing is waited for", async () => {
    const { page, errors, close } = await openPanel({ before: recordLoads, isStopped: true });
    await page.evaluate(async () => {
        window.loads = [];
        const field = document.getElementById("field-formula");
        field.value = "";
        for (const character of "x^2+y^2+z^2-w") {
            field.value += character;
            field.dispatchEvent(new InputEvent("input", { bubbles: true }));
            await window.passTime(100);
        }
    });
    await idle(page);
    const loads = () => page.evaluate(() => window.loads);
    assert.deepEqual(await loads(), [], "not what was typed on the way");
    await passTime(page, kTyping);
    await idle(page);
    assert.deepEqual(await loads(), ["x^2+y^2+z^2-w"]);
    const last = await page.evaluate(async () => {
        const field = document.getElementById("field-formula");
        const enter = () => field.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
        for (let i = 1; i <= 30; ++i) {
            field.value = `x^2+y^2+z^2-w-${i}/10`;
            enter();
            await new Promise((resolve) => setTimeout(resolve));
        }
        return field.value;
    });
    await idle(page);
    assert.equal((await loads()).at(-1), last);
    assert.equal(await page.evaluate(() => window.most), 1);
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: levels and their inside can be set, and follow the session", async () => {
    const { page, script, errors, close } = await openPanel();
    await write(page, script, "x^2+y^2+z^2+w^2");
    await spoken(page, "formula");
    await page.fill("#field-levels", "0.5, 1.5 2.5");
    const set = await script.until(({ levels }) => levels?.length === 3, "three levels");
    assert.deepEqual(set.levels, [0.5, 1.5, 2.5]);
    await presented(page, set.revision);
    const { surface } = await focusSurface(page, script);
    assert.deepEqual([...new Set(surface.level)].sort(), [0, 1, 2]);
    await page.locator("#field-inside label", { hasText: "above" }).click();
    await script.until(({ inside }) => inside === "above", "the inside above");
    const before = (await script.state()).revision;
    for (const [text, expected] of [["1, 2, 3, 4, 5", /1 to 4/], ["one", /1 to 4/], ["", /1 to 4/], ["1, 1", /different/]]) {
        await page.fill("#field-levels", text);
        await page.waitForFunction(
            (source) => new RegExp(source).test(document.getElementById("field-levels-error").textContent),
            expected.source,
        );
        assert.equal(await page.getAttribute("#field-levels", "aria-invalid"), "true");
    }
    assert.equal((await script.state()).revision, before);
    await page.focus("#field-formula");
    await script.request({ type: "set", levels: [0.25], inside: "below" });
    await page.waitForFunction(() => document.getElementById("field-levels").value === "0.25");
    assert.equal(await page.locator("#field-levels-error").textContent(), "");
    assert.equal(await page.isChecked("#field [value=below]"), true);
    await spoken(page, "level 0.25, inside below");
    await write(page, script, "x^2+y^2+z^2+w^2*2");
    assert.deepEqual((await script.state()).levels, [0.25], "editing the formula keeps the levels");
    await write(page, script, "x^2+y^2+z^2+w^2 < 1");
    await script.until(({ levels }) => levels?.join() === "0", "a comparison has the level 0");
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: keys act on the drawing while the panel is open", async () => {
    const { page, script, errors, close } = await openPanel();
    await page.keyboard.press("Escape");
    assert.equal(await page.evaluate(() => document.activeElement.id), "drawing");
    await page.keyboard.press("y");
    await script.until(({ last }) => last !== null, "a rotation");
    assert.equal(await page.locator("#field").isVisible(), true);
    const reached = new Set();
    await page.focus("#field-close");
    for (let i = 0; i < 30; ++i) {
        reached.add(
            await page.evaluate(() => {
                const at = document.activeElement;
                return at.closest("#field") ? at.id || at.dataset.end || at.dataset.velocity || at.dataset.constant || at.name : "";
            }),
        );
        await page.keyboard.press("Tab");
    }
    const ends = ["x", "y", "z", "w"].flatMap((axis) => [`${axis} from`, `${axis} to`]);
    const velocities = ["follow", "boost"].flatMap((name) => ["x", "y", "z"].map((axis) => `${name} ${axis}`));
    const others = ["field-close", "field-example", "field-formula", "field-levels", "observer-pace", "field-link"];
    for (const name of [...others, "a", "b", "c", "inside", ...ends, ...velocities]) {
        assert.ok(reached.has(name), `${name} is reached with Tab`);
    }
    await page.focus("#field [value=below]");
    await page.keyboard.press("ArrowRight");
    await script.until(({ inside }) => inside === "above", "the inside above");
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: every example is a field with a surface", async () => {
    const { page, script, errors, close } = await openPanel();
    const examples = await page.locator("#field-example option").count();
    assert.ok(examples > 5);
    for (let i = examples - 2; i >= 0; --i) {
        const { revision } = await script.state();
        await page.selectOption("#field-example", String(i));
        const state = await script.until((one) => one.revision > revision, `example ${i}`);
        await presented(page, state.revision);
        const { slices } = await script.request({ type: "get", what: "slices" });
        assert.ok(slices.filter(({ surface }) => surface).length >= 3, `example ${i}`);
        assert.equal(await page.locator("#field-error").textContent(), "");
    }
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: another formula colors the surfaces, and has the names of the first one", async () => {
    const permissions = ["clipboard-read", "clipboard-write"];
    const { page, script, errors, close } = await openPanel({ permissions, isStopped: true });
    await write(page, script, "x^2+y^2+z^2+w^2 < a^2; a=1.5");
    const colored = await change(page, script, "#field-values", "a*x");
    assert.equal(colored.color, "value");
    assert.equal(colored.field.values.formula, "a*x");
    assert.deepEqual(colored.field.values.range, [-3, 3]);
    const { surface } = await focusSurface(page, script);
    for (let i = 0; i < surface.colors.length; ++i) {
        const [r, , b] = rgb(surface.colors[i]);
        const x = surface.points[3 * i];
        if (Math.abs(x) > 0.1) assert.equal(x > 0, r > b, `at x = ${x}: ${r}, ${b}`);
    }
    // The page shows a mistake at the character where it is.
    const before = (await script.state()).revision;
    await page.fill("#field-values", "a*x + q");
    await passTime(page, kTyping);
    await page.waitForFunction(() => /^Character 7: /.test(document.getElementById("field-values-error").textContent));
    assert.equal(await page.locator("#field-values-excerpt mark").textContent(), "q");
    assert.equal(await page.getAttribute("#field-values", "aria-invalid"), "true");
    assert.equal(await page.textContent("#field-error"), "");
    assert.equal((await script.state()).revision, before);
    await page.fill("#field-formula", "x^2+$ < a^2; a=1.5");
    await passTime(page, kTyping);
    await page.waitForFunction(() => /^Character 5: /.test(document.getElementById("field-error").textContent));
    assert.equal(await page.textContent("#field-values-error"), "", "only the first mistake is known");
    await script.request({ type: "set", levels: [0, 0.5] }); // so that the next change is another undo step
    await page.waitForFunction(() => document.getElementById("field-levels").value === "0, 0.5");
    await page.fill("#field-values", "a*y");
    await write(page, script, "x^2+y^2+z^2+w^2 < a^2; a=1.2");
    assert.equal(await page.textContent("#field-values-error"), "");
    await page.locator("#field-caps label", { hasText: "Open" }).click();
    await script.until(({ caps }) => caps === "open", "open surfaces");
    await page.click("#field-link");
    await page.waitForFunction(() => /copied/.test(document.getElementById("notice").textContent));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.includes("values=a*y&") && link.includes("caps=open"), link);
    const second = await openPage({ url: link });
    await named(second.page, "formula");
    const other = await scriptFor(second.page);
    const opened = await other.until(({ caps }) => caps === "open", "the rest of the address");
    assert.deepEqual([opened.field.values.formula, opened.color], ["a*y", "value"]);
    await second.page.waitForFunction(() => /\u22122\.4\s*2\.4/.test(document.querySelector(".scale")?.textContent));
    await second.page.click("[data-page-tool=field]");
    assert.equal(await second.page.inputValue("#field-values"), "a*y");
    other.leave();
    await second.close();
    // Undo shows the previous formula of the colors.
    await page.click("#field-close");
    for (let i = 0; i < 2; ++i) await page.keyboard.press("u");
    await page.waitForFunction(() => document.getElementById("field-values").value === "a*x");
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: the panel continues with a formula of the command line", async () => {
    const { page, script, errors, close } = await openWithScript();
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.keyboard.type("formula x^2+y^2-z < a*w; a=0.5 colored by a*z");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#command-line", { state: "hidden" });
    const { revision } = await script.until(({ levels }) => levels !== undefined, "the field");
    await page.click("[data-page-tool=field]");
    assert.equal(await formula(page), "x^2+y^2-z < a*w; a=0.5");
    assert.equal(await page.inputValue("#field-values"), "a*z");
    assert.equal(await page.locator("#field-constants output").textContent(), "0.5");
    assert.equal((await script.state()).revision, revision, "the panel shows the field that is there");
    assert.deepEqual(errors, []);
    await close();
});

/**
 * Runs in the page. While `window.isRefused` is true, spoils the levels in messages, so that the server refuses them.
 */
function spoilLevels() {
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
        const message = JSON.parse(text);
        return send.call(this, window.isRefused && message.levels ? JSON.stringify({ ...message, levels: [1, 1] }) : text);
    };
}

test("field panel: if only the levels of a formula are refused, the formula is shown, and the reason is told", async () => {
    const { page, script, errors, close } = await openPanel({ before: spoilLevels });
    await write(page, script, "x^2+y^2+z^2+w^2 < 1");
    await page.evaluate(() => void (window.isRefused = true));
    const { field } = await write(page, script, "x^2+y^2+z^2+w^2 < 2");
    assert.match(field.formula, /< ?2$/);
    await page.waitForFunction(() => /levels/.test(document.getElementById("notice").textContent));
    assert.deepEqual(errors, []);
    await close();
});

test("field panel: after a restart of the server, the formula is loaded again", async () => {
    const server = await startReplaceableServer();
    const { page, script, close } = await openPanel({ url: server.url });
    await write(page, script, "x^2+y^2+z^2+w^2 < 1");
    await script.request({ type: "set", levels: [0, 0.5] });
    await page.waitForFunction(() => document.getElementById("field-levels").value === "0, 0.5");
    script.leave();
    await restart(server, page);
    const second = await scriptFor(page, server.url);
    await second.until(({ levels }) => levels?.join() === "0,0.5", "the field in the new session");
    second.leave();
    await close();
    await server.stop();
});

test("field panel: on a phone, the panel has large controls below the picture", async () => {
    const phone = { viewport: { width: 375, height: 667 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };
    const { page, errors, close } = await openPanel(phone);
    const { height } = await page.locator("#drawing").boundingBox();
    assert.ok(height > 180, `the picture is ${height} high`);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0);
    for (const control of await page.locator("#field :is(button, select, textarea, input):visible").all()) {
        await control.scrollIntoViewIfNeeded();
        const box = await control.boundingBox();
        const name = await control.evaluate((one) => one.outerHTML);
        assert.ok(box.height >= 38 && box.width >= 38, `${name}: ${box.width} × ${box.height}`);
        assert.ok(box.x >= 0 && box.x + box.width <= 375, name);
    }
    await page.tap("#field-close");
    assert.equal(await page.locator("#tools").isVisible(), true);
    assert.deepEqual(errors, []);
    await close();
});
