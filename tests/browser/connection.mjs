// A session survives the loss of its connection, and the page shows the status of the connection.
import assert from "node:assert/strict";
import { test } from "./support/suite.mjs";

import { common, idle, named, openPage, openWithScript, presented, ready, scriptFor } from "./support/browser.mjs";
import { restart } from "./support/browser.mjs";
import { holdSent } from "./support/held.mjs";
import { passTime, stopTime } from "./support/page_time.mjs";
import { startProxy, startReplaceableServer } from "./support/proxy.mjs";
import { startServer } from "./support/server.mjs";

const kLate = 1000; // milliseconds without an answer after which the page says that it waits
const kOpening = 5000; // milliseconds within which a WebSocket must open
const kWelcome = 30000; // milliseconds within which the server must answer the first message
const kLost = 8000; // milliseconds without an answer after which the page gives up the connection

const connection = (page) => page.locator("#connection").textContent();
const isOpen = (page) => page.waitForSelector("#connection[data-kind=open]");

test("connection: a reload keeps the session", async () => {
    const { page, script, press, errors, close } = await openWithScript();
    const state = await press("y");
    await page.reload();
    await presented(page, state.revision);
    await ready(page);
    assert.equal((await script.state()).revision, state.revision);
    const again = await scriptFor(page);
    assert.equal(again.client.credentials.session, script.client.credentials.session);
    again.leave();
    const { orientation } = await press("Shift+Y");
    assert.ok(Math.abs(orientation[0][0] - 1) < 1e-9);
    assert.deepEqual(errors, []);
    await close();
});

test("connection: a lost connection is reported and restored, and the session continues", async () => {
    const { url } = await common();
    const proxy = await startProxy(url, "/deep/inside");
    const { page, close } = await openPage({ url: proxy.url });
    await ready(page);
    const script = await scriptFor(page, url);
    proxy.cut();
    await page.waitForFunction(() => /trying again/.test(document.getElementById("connection").textContent));
    assert.equal(await page.locator("#stale").isVisible(), true);
    assert.match(await page.locator("#stale").textContent(), /Not connected.*picture is from .*\d/);
    proxy.restore();
    await isOpen(page);
    assert.equal(await page.locator("#stale").isVisible(), false);
    assert.equal(await connection(page), "Connected");
    await page.locator("#drawing").focus();
    await page.keyboard.press("y");
    const { revision } = await script.until((one) => one.last !== null, "a key in the old session");
    await presented(page, revision);
    script.leave();
    await close();
    await proxy.stop();
});

test("connection: the page says that the server does not answer, or that the network is offline", async () => {
    const { url } = await common();
    const proxy = await startProxy(url, "/frozen");
    const { page, errors, close } = await openPage({ url: proxy.url, isStopped: true });
    await ready(page);
    const actions = [
        () => page.keyboard.press("y"),
        () => page.mouse.wheel(0, 100),
        () => page.evaluate(() => window.dispatchEvent(new Event("offline"))),
    ];
    await page.hover("#drawing");
    await page.focus("#drawing");
    for (const act of actions) {
        proxy.freeze();
        await act();
        await page.waitForSelector("#connection:not([data-unanswered='0'])");
        await passTime(page, kLate);
        await page.waitForSelector("#connection[data-kind=late]");
        assert.equal(await connection(page), "Waiting…");
        assert.equal(await page.locator("#connection-spoken").textContent(), "Waiting…");
        proxy.thaw();
        await idle(page);
        await isOpen(page);
        assert.equal(await connection(page), "Connected");
    }
    assert.deepEqual(errors, []);
    proxy.freeze();
    await page.evaluate(() => window.dispatchEvent(new Event("offline")));
    await passTime(page, kLost);
    await page.waitForSelector("#connection[data-kind=waiting]");
    assert.match(await connection(page), /does not answer|No answer/);
    await close();
    await proxy.stop();
});

test("connection: pictures are within the limits of a server that allows only small ones", async () => {
    const server = await startServer({ options: ["--max-pixels", "100000"] });
    const { page, errors, close } = await openPage({ url: server.url });
    await ready(page);
    const drawing = page.locator("#drawing");
    const sizeOf = (one) => [one.clientWidth, one.clientHeight, one.querySelector("canvas.solids").width];
    const [width, height, pixels] = await drawing.evaluate(sizeOf);
    assert.ok(width * height > 100000, "the window is larger");
    assert.ok(pixels > 256 && pixels * pixels * (height / width) <= 100000, `${pixels} pixels wide`);
    assert.equal(await connection(page), "Connected");
    assert.deepEqual(errors, []);
    await close();
    await server.stop();
});

test("connection: pictures are within the limits of a server that allows no small ones", async () => {
    const server = await startServer({ options: ["--min-side", "300", "--max-width", "400", "--max-height", "400"] });
    const { page, errors, close } = await openPage({ url: server.url });
    await ready(page);
    const sizeOf = (one) => [one.width, one.height];
    const sides = await page.locator("#drawing canvas.solids").evaluate(sizeOf);
    assert.ok(sides.every((side) => side >= 300 && side <= 400), `${sides} pixels`);
    assert.equal(await connection(page), "Connected");
    assert.deepEqual(errors, []);
    await close();
    await server.stop();
});

test("connection: the page shows why the server refuses its session", async () => {
    const server = await startServer({ options: ["--max-sessions", "1"] });
    const first = await openPage({ url: server.url });
    const { page, errors, close } = await openPage({ url: server.url, picture: false });
    await page.waitForFunction(() => /sessions.*trying again/.test(document.getElementById("connection").textContent));
    assert.deepEqual(errors, []);
    await close();
    await first.close();
    await server.stop();
});

test("connection: a server that accepts a WebSocket but does not answer is reported", async () => {
    const proxy = await startProxy((await common()).url, "/mute");
    proxy.swallow();
    const { page, close } = await openPage({ url: proxy.url, before: stopTime, picture: false });
    await page.waitForSelector("#connection[data-unanswered='1']");
    await passTime(page, kWelcome);
    await page.waitForFunction(() => /does not answer/.test(document.getElementById("connection").textContent));
    await close();
    await proxy.stop();
});

test("connection: a file that takes long to load is no lost connection", async () => {
    const { url } = await common();
    const proxy = await startProxy(url, "/long");
    const { page, script, errors, close } = await openWithScript({ url: proxy.url, isStopped: true });
    proxy.freeze();
    const data = Buffer.from("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n-1 -1 -1 -1\n");
    await page.setInputFiles("#file", { name: "slow.txt", mimeType: "text/plain", buffer: data });
    await page.waitForSelector("#connection:not([data-unanswered='0'])");
    await page.evaluate(() => window.dispatchEvent(new Event("offline"))); // makes the page test the connection
    await passTime(page, 2 * kLost);
    await page.waitForSelector("#connection[data-kind=late]");
    proxy.thaw();
    await named(page, "slow.txt");
    await idle(page);
    assert.equal(await connection(page), "Connected");
    assert.deepEqual(errors, []);
    script.leave();
    await close();
    await proxy.stop();
});

test("connection: the page says that a proxy passes no WebSockets on", async () => {
    const { url } = await common();
    for (const refuse of ["dropUpgrades", "holdUpgrades"]) {
        const proxy = await startProxy(url, "/tunnel");
        proxy[refuse]();
        const { page, close } = await openPage({ url: proxy.url, isStopped: true, picture: false });
        await passTime(page, kOpening);
        const says = () => /no WebSocket opens.* Upgrade/.test(document.getElementById("stale").textContent);
        await page.waitForFunction(says);
        assert.equal(await page.locator("#stale").isVisible(), true);
        await close();
        await proxy.stop();
    }
});

test("connection: the page stops and says that the server requires a token, as after a restart with another", async () => {
    const proxy = await startProxy((await common()).url, "/token");
    const { page, close } = await openPage({ url: proxy.url });
    await page.route("**", (route) => route.fulfill({ status: 401 }));
    proxy.cut();
    await page.waitForSelector("#connection[data-kind=closed]");
    assert.match(await connection(page), /requires its token/);
    await close();
    await proxy.stop();
});

test("connection: behind a path prefix, all requests are under the prefix", async () => {
    const proxy = await startProxy((await common()).url, "/maths/oval");
    const { page, errors, close } = await openPage({ url: `${proxy.url}?polytope=8-cell` });
    await ready(page);
    await named(page, "8-cell");
    const saving = page.waitForEvent("download");
    await page.click("[data-page-tool=save]");
    await saving;
    assert.deepEqual(proxy.outside, []);
    assert.deepEqual(errors, []);
    await close();
    await proxy.stop();
});

test("connection: the page works under a strict content security policy", async () => {
    const policy = { "content-security-policy": "default-src 'self'; object-src 'none'; base-uri 'none'" };
    const proxy = await startProxy((await common()).url, "/strict", policy);
    const { page, errors, close } = await openPage({ url: proxy.url });
    await ready(page);
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    for (const press of ["[data-page-tool=save]", "#export-submit"]) {
        const saving = page.waitForEvent("download");
        if (press === "#export-submit") await page.click("#export-button");
        await page.click(press);
        await saving;
    }
    await page.click("#tools label:has([name=color][value=kind])");
    await page.click("#polytope");
    await page.click('#picker-list [data-name="8-cell"]');
    await named(page, "8-cell");
    assert.deepEqual(errors, []);
    await close();
    await proxy.stop();
});

test("connection: after a restart of the server, a new session has the same view, and the page says so", async () => {
    const server = await startReplaceableServer();
    const { page, close } = await openPage({ url: server.url });
    await ready(page);
    const script = await scriptFor(page, server.url);
    await script.request({ type: "set", polytope: "24-cell", alpha: 0.25 });
    const { revision } = await script.request({ type: "rotate", planes: ["xw"], angles: [0.5] });
    await presented(page, revision);
    const before = await script.state();
    script.leave();
    await server.stop();
    await page.waitForSelector("#connection[data-kind=waiting]");
    assert.equal(await page.locator("#stale").isVisible(), true);
    await page.evaluate(() => {
        document.getElementById("drawing").focus();
    });
    await page.keyboard.press("y");
    await page.waitForFunction(() => /no connection/.test(document.getElementById("notice").textContent));

    await server.startAnother();
    await isOpen(page);
    await page.waitForFunction(() => /new one/.test(document.getElementById("notice").textContent));
    const second = await scriptFor(page, server.url);
    assert.notEqual(second.client.credentials.session, script.client.credentials.session);
    const after = await second.until((one) => one.polytope.name === "24-cell", "the view in the new session");
    assert.equal(after.alpha, 0.25);
    after.orientation.flat().forEach((value, i) => assert.ok(Math.abs(value - before.orientation.flat()[i]) < 1e-9));
    await page.keyboard.press("4");
    const pressed = await second.until((one) => one.revision > after.revision, "a key in the new session");
    await presented(page, pressed.revision);
    second.leave();
    await close();
    await server.stop();
});

test("connection: the view is restored, too, if the new session ends before", async () => {
    const server = await startReplaceableServer();
    const { page, script, close } = await openWithScript({ url: server.url, before: holdSent });
    await script.request({ type: "set", polytope: "24-cell" });
    await named(page, "24-cell");
    script.leave();
    await page.evaluate(() => void (window.isHeld = ({ type }) => type === "set"));
    await restart(server, page);
    await named(page, "5-cell");
    await server.stop();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await page.evaluate(() => window.release());
    await server.startAnother();
    await isOpen(page);
    await named(page, "24-cell");
    await close();
    await server.stop();
});

test("connection: the view of an address is complete, too, if the connection breaks before", async () => {
    const { url } = await common();
    const proxy = await startProxy(url, "/view");
    const holds = "window.isHeld = ({ line }) => /alpha/.test(line) && (window.isHolding = true);";
    const query = "?polytope=24-cell&rotate=xw:0.3&alpha=0.25";
    const before = `(${holdSent})(); ${holds}`;
    const { page, close } = await openPage({ url: proxy.url + query, before, picture: false });
    await page.waitForFunction(() => window.isHolding);
    proxy.cut();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await page.evaluate(() => void (window.isHeld = undefined));
    proxy.restore();
    await ready(page);
    const script = await scriptFor(page, url);
    const { polytope, alpha, orientation } = await script.state();
    assert.deepEqual([polytope.name, alpha], ["24-cell", 0.25]);
    assert.ok(Math.abs(orientation[3][3] - Math.cos(0.3)) < 1e-9, "it is turned once");
    assert.equal(await page.locator("#notice").textContent(), "");
    script.leave();
    await close();
    await proxy.stop();
});

test("connection: an unreachable server is reported", async () => {
    const server = await startReplaceableServer();
    const { page, close } = await openPage({ url: server.url });
    await server.stop();
    await page.waitForSelector("#connection[data-kind=waiting]");
    // The first reason is the server's own; the next attempt finds another reason.
    await page.waitForFunction(() => /No answer/.test(document.getElementById("connection").textContent));
    await close();
});

test("connection: a hidden page requests no pictures", async () => {
    const { page, script, close } = await openWithScript();
    const asked = (hidden) =>
        page.evaluate((value) => {
            const sent = new Promise((resolve) => {
                const { send } = WebSocket.prototype;
                WebSocket.prototype.send = function (text) {
                    const message = JSON.parse(text);
                    if (message.type === "hello") ((WebSocket.prototype.send = send), resolve(message.stream));
                    return send.call(this, text);
                };
            });
            Object.defineProperty(document, "hidden", { value, configurable: true });
            document.dispatchEvent(new Event("visibilitychange"));
            return sent;
        }, hidden);
    assert.equal(await asked(true), "none");
    const { revision } = await script.request({ type: "rotate", planes: ["xy"], angles: [1] });
    assert.equal(await asked(false), "geometry");
    await presented(page, revision);
    await close();
});
