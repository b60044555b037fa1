// Starts the browser (Chromium or Firefox), and has helpers for tests of the page.
import { existsSync } from "node:fs";

import { chromium } from "playwright-core";

import { startFirefox } from "./firefox.mjs";
import { kHangLimit, within } from "./hang_limit.mjs";
import { passTime, stopTime } from "./page_time.mjs";
import { joinSession } from "./script.mjs";
import { startServer } from "./server.mjs";
import { afterTest, atEnd, inFirefox, setBroken } from "./suite.mjs";

// All pages share one renderer process, because starting a process takes a quarter of the time that opening a page
// takes.
const kArguments = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--renderer-process-limit=1"];

// The first browser is preferred. It draws no windows, so it needs less processor time.
const kBrowsers = ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const executablePath = process.env.OVAL4D_CHROMIUM ?? kBrowsers.find((path) => existsSync(path));

/**
 * Starts a browser, which is closed after all tests. `args` are arguments for Chromium; `preferences` are for Firefox.
 */
export async function startBrowser(args = [], preferences = {}) {
    const browser = inFirefox
        ? await startFirefox(preferences)
        : await chromium.launch({ executablePath, args: [...kArguments, ...args], timeout: kHangLimit });
    let isClosed = false;
    const close = browser.close.bind(browser);
    browser.close = () => ((isClosed = true), close());
    browser.on("disconnected", () => isClosed || setBroken("a browser has crashed"));
    atEnd(() => browser.close());
    return browser;
}

const kOpening = 1000; // milliseconds after which a page has adapted to its size
const kContextOptions = { viewport: { width: 1280, height: 720 }, colorScheme: "dark" };

// Without a graphics card, pages are composed faster if OpenGL is not emulated for it; then only WebGL uses the
// emulation. However, 2-D canvases then have slightly different edges, and large WebGL canvases that change all the
// time are copied.
const kFaster = "--disable-gpu-compositing";

let accurate;

/** A browser that composes pages exactly like a browser with a graphics card. */
export function accurateBrowser() {
    accurate ??= inFirefox ? common().then(({ browser }) => browser) : startBrowser();
    return accurate;
}

let shared;

/**
 * The server and the browser that most tests share, with a browser context that has the usual options. The page starts
 * faster in this context, because the browser already has its files.
 */
export function common() {
    shared ??= (async () => {
        const server = await startServer();
        void server.ended.then(() => setBroken("the server has ended"));
        const browser = await startBrowser([kFaster]);
        const context = await browser.newContext(kContextOptions);
        await context.newPage(); // keeps the context when the page of a test is closed
        return { server, url: server.url, browser, context };
    })();
    return shared;
}

/**
 * Opens the page, and waits for its first picture. `before` runs in the page before its scripts. `seen` is called with
 * each response. `errors` in the result collects the console's errors and uncaught exceptions. Unless `firstVisit` is
 * true, the browser has visited the page before. If `isStopped` is true, time passes in the page only by passTime().
 * The page is closed at the end of the test; a `lasting` page is closed after all tests.
 */
export async function openPage(given = {}) {
    const { url, browser, picture = true, before, seen, firstVisit = false, isStopped, lasting, ...options } = given;
    const usual = await common();
    const own = browser !== undefined || firstVisit || seen !== undefined || Object.keys(options).length > 0;
    const context = own ? await (browser ?? usual.browser).newContext({ ...kContextOptions, ...options }) : usual.context;
    const page = await context.newPage();
    const close = () => (own ? context.close() : page.close());
    (lasting ? atEnd : afterTest)(close);
    page.setDefaultTimeout(kHangLimit);
    const errors = [];
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(error.message));
    if (!firstVisit) await page.addInitScript(() => localStorage.setItem("oval4d.visited", "1"));
    if (isStopped) await page.addInitScript(stopTime);
    if (before) await page.addInitScript(before);
    if (seen) page.on("response", seen);
    if (process.env.OVAL4D_SLOWDOWN) await slowDown(page, Number(process.env.OVAL4D_SLOWDOWN));
    await page.goto(url ?? usual.url);
    if (picture) await presented(page, 0);
    if (isStopped) {
        await passTime(page, kOpening);
        await idle(page);
    }
    return { page, context, errors, close };
}

/** Slows the page's scripts down `rate` times. */
async function slowDown(page, rate) {
    const session = await page.context().newCDPSession(page);
    await session.send("Emulation.setCPUThrottlingRate", { rate });
}

/**
 * Waits until the page has finished all work that earlier input has caused: it has nothing more to send, and all its
 * requests are answered.
 */
export async function idle(page) {
    const quiet = page.evaluate(async () => {
        const { dataset } = document.getElementById("connection");
        // The page may still send a request in the next animation frame, or in a frame after a timer.
        for (let frames = 0; frames < 3; frames = dataset.unanswered === "0" ? frames + 1 : 0) {
            await new Promise((resolve) => setTimeout(resolve));
            await new Promise((resolve) => requestAnimationFrame(resolve));
        }
    });
    await within(quiet, "the answers to all requests of the page");
}

/** The state of the session after the page has done everything that it was asked to do. */
export async function stateAfter(page, script) {
    await idle(page);
    return script.state();
}

/** Waits until the page's texts and controls show this revision or a newer one, or until the page has no connection. */
async function shown(page, revision) {
    await page.waitForFunction((least) => {
        const { kind, revision } = document.getElementById("connection").dataset;
        return kind !== "open" || Number(revision) >= least;
    }, revision);
}

/** Waits until the page has presented the picture of this revision or of a newer one. */
export async function presented(page, revision) {
    await page.waitForFunction(
        (least) => {
            const { revision = -1, draft } = document.getElementById("drawing").dataset;
            return Number(revision) >= least && draft === undefined;
        },
        revision,
    );
}

/** Waits until the key table has arrived and the tools are visible. */
export async function ready(page) {
    await page.waitForSelector("[data-action=help]", { state: "attached" });
}

/** Joins the session of the page with a script, as a second client. */
export async function scriptFor(page, url) {
    const credentials = await page.evaluate(() => {
        return JSON.parse(sessionStorage.getItem(`oval4d.session ${location.pathname}`)).credentials;
    });
    return joinSession(url ?? (await common()).url, credentials);
}

/** Replaces the server of a page by another server. Waits until the page says that its session is new. */
export async function restart(server, page) {
    await server.stop();
    await page.waitForSelector("#connection[data-kind=waiting]");
    await server.startAnother();
    await page.waitForSelector("#connection[data-kind=open]");
    await page.waitForFunction(() => /new one/.test(document.getElementById("notice").textContent));
}

/** Waits until the page shows the name of this polytope. */
export async function named(page, polytope) {
    await page.waitForFunction((name) => document.querySelector("#polytope b")?.textContent === name, polytope);
}

/** Waits until the page announces to screen readers a text that contains `text`. */
export async function spoken(page, text) {
    await page.waitForFunction((wanted) => document.getElementById("spoken").textContent.includes(wanted), text);
}

/** The values of the state that the page displays, by name. */
export async function shownValues(page) {
    return page.evaluate(() => {
        const outputs = [...document.querySelectorAll("[data-state-field]")];
        const values = Object.fromEntries(outputs.map((output) => [output.dataset.stateField, output.textContent]));
        return { ...values, polytope: document.querySelector("#polytope b").textContent };
    });
}

/** Opens the page, and joins its session with a script as a second client. */
export async function openWithScript(options) {
    const opened = await openPage(options);
    await ready(opened.page);
    const joined = await scriptFor(opened.page, options?.url);
    const script = {
        ...joined,
        /** Waits for a state for which `holds` returns true, and until the page shows it or has no connection. */
        async until(holds, what) {
            const state = await joined.until(holds, what);
            await shown(opened.page, state.revision);
            return state;
        },
    };
    return {
        ...opened,
        script,
        /** Presses keys. Resolves to the changed state after the page has presented its picture. */
        async press(...keys) {
            const { revision } = await script.state();
            for (const key of keys) await opened.page.keyboard.press(key);
            const state = await script.until((one) => one.revision > revision, `a change by ${keys.join(" ")}`);
            await presented(opened.page, state.revision);
            return state;
        },
        async close() {
            script.leave();
            await opened.close();
        },
    };
}
