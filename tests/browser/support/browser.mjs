// Starts headless Chromium; helpers for tests of the page.
import { existsSync } from "node:fs";

import { chromium } from "playwright-core";

import { joinSession } from "./script.mjs";
import { startServer } from "./server.mjs";
import { atEnd } from "./suite.mjs";

const kArguments = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

const kBrowsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const executablePath = process.env.OVAL4D_CHROMIUM ?? kBrowsers.find((path) => existsSync(path));

/** Starts a browser; it is closed after all tests. */
export async function startBrowser(args = []) {
    const browser = await chromium.launch({ executablePath, args: [...kArguments, ...args] });
    atEnd(() => browser.close());
    return browser;
}

let shared;

/** The server and the browser that most tests share. */
export function common() {
    shared ??= (async () => {
        const server = await startServer();
        return { server, url: server.url, browser: await startBrowser() };
    })();
    return shared;
}

/**
 * Opens the page and waits for its first picture. `before` runs in the page before its scripts; `seen` is called with
 * each response; `errors` collects the console's errors and uncaught exceptions. The browser has opened the page before,
 * unless this is the `firstVisit`.
 */
export async function openPage({ url, browser, picture = true, before, seen, firstVisit = false, ...options } = {}) {
    const usual = await common();
    const context = await (browser ?? usual.browser).newContext({ viewport: { width: 1280, height: 720 }, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(30_000);
    const errors = [];
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(error.message));
    if (!firstVisit) await page.addInitScript(() => localStorage.setItem("oval4d.visited", "1"));
    if (before) await page.addInitScript(before);
    if (seen) page.on("response", seen);
    await page.goto(url ?? usual.url);
    if (picture) await presented(page, 0);
    return { page, context, errors, close: () => context.close() };
}

/** Waits until the page has presented this revision or a newer one. */
export async function presented(page, revision) {
    await page.waitForFunction(
        (least) => Number(document.getElementById("drawing").dataset.revision ?? -1) >= least,
        revision,
    );
}

/** Waits until the key table has arrived and the tools are shown. */
export async function ready(page) {
    await page.waitForSelector("[data-action=help]", { state: "attached" });
}

/** Joins the page's session with a script. */
export async function scriptFor(page, url) {
    const credentials = await page.evaluate(() => {
        return JSON.parse(sessionStorage.getItem(`oval4d.session ${location.pathname}`)).credentials;
    });
    return joinSession(url ?? (await common()).url, credentials);
}

/** Waits until the page shows the name of this polytope. */
export async function named(page, polytope) {
    await page.waitForFunction((name) => document.querySelector("#polytope b").textContent === name, polytope);
}

/** The values of the state that the page displays. */
export async function readings(page) {
    return page.evaluate(() => {
        const outputs = [...document.querySelectorAll("[data-reading]")];
        const values = Object.fromEntries(outputs.map((output) => [output.dataset.reading, output.textContent]));
        return { ...values, polytope: document.querySelector("#polytope b").textContent };
    });
}

/** Opens the page, and joins its session with a script. */
export async function openWithScript(options) {
    const opened = await openPage(options);
    await ready(opened.page);
    const script = await scriptFor(opened.page, options?.url);
    return {
        ...opened,
        script,
        /** Presses keys; resolves to the changed state once its picture has been presented. */
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
