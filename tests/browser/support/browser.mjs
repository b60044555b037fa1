// Headless Chromium, and what the tests ask of a page.
import { existsSync } from "node:fs";

import { chromium } from "playwright-core";

import { joinSession } from "./script.mjs";
import { startServer } from "./server.mjs";
import { atEnd } from "./suite.mjs";

const kArguments = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

const kBrowsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const executablePath = process.env.OVAL4D_CHROMIUM ?? kBrowsers.find((path) => existsSync(path));

/** Starts a browser that is closed at the end of all tests. */
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
 * Opens the page and waits for its first picture. `before` runs in the page before its own scripts, `seen` is told of
 * each response; `errors` collects what the console calls an error.
 */
export async function openPage({ url, browser, picture = true, before, seen, ...options } = {}) {
    const our = await common();
    const context = await (browser ?? our.browser).newContext({ viewport: { width: 1280, height: 720 }, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(30_000);
    const errors = [];
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(error.message));
    if (before) await page.addInitScript(before);
    if (seen) page.on("response", seen);
    await page.goto(url ?? our.url);
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

/** Waits until the tools are there: the key table has arrived. */
export async function ready(page) {
    await page.waitForSelector("[data-action=help]", { state: "attached" });
}

/** A script that has joined the page's session. */
export async function scriptFor(page, url) {
    const credentials = await page.evaluate(() => {
        return JSON.parse(sessionStorage.getItem(`oval4d.session ${location.pathname}`)).credentials;
    });
    return joinSession(url ?? (await common()).url, credentials);
}

/** Waits until the page names this polytope as the one shown. */
export async function named(page, polytope) {
    await page.waitForFunction((name) => document.querySelector("#polytope b").textContent === name, polytope);
}

/** What the page shows of the state. */
export async function readings(page) {
    return page.evaluate(() => {
        const outputs = [...document.querySelectorAll("[data-reading]")];
        const values = Object.fromEntries(outputs.map((output) => [output.dataset.reading, output.textContent]));
        return { ...values, polytope: document.querySelector("#polytope b").textContent };
    });
}

/** Opens the page with a script in its session, for one test. */
export async function openWithScript(options) {
    const opened = await openPage(options);
    await ready(opened.page);
    const script = await scriptFor(opened.page, options?.url);
    return {
        ...opened,
        script,
        /** Presses keys; resolves with the state once it has changed and its picture has been presented. */
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
