// Starts Firefox over WebDriver BiDi; helpers for tests of the page in Firefox.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import puppeteer from "puppeteer-core";

import { common, ready, scriptFor } from "./browser.mjs";
import { atEnd } from "./suite.mjs";
import { kHangLimit, within } from "./hang_limit.mjs";

const kBrowsers = ["/usr/bin/firefox-esr", "/usr/bin/firefox"];
const executablePath = process.env.OVAL4D_FIREFOX ?? kBrowsers.find((path) => existsSync(path));

/** Starts an X server without a screen: headless Firefox has no WebGL. Returns the number of the display. */
async function startDisplay() {
    const server = spawn("Xvfb", ["-displayfd", "3", "-screen", "0", "1600x1200x24", "-nolisten", "tcp"], {
        stdio: ["ignore", "ignore", "ignore", "pipe"],
    });
    atEnd(() => server.kill());
    const number = new Promise((resolve, reject) => {
        server.once("error", reject);
        server.once("exit", (code) => reject(new Error(`Xvfb ended with ${code}`)));
        server.stdio[3].once("data", (text) => resolve(Number(text)));
    });
    return within(number, "Xvfb to start");
}

let shared;

/** Firefox, which all tests share, and the folder to which it downloads. */
function firefox() {
    shared ??= (async () => {
        const downloads = mkdtempSync(join(tmpdir(), "oval4d-firefox-"));
        atEnd(() => rmSync(downloads, { recursive: true, force: true }));
        const display = await startDisplay();
        const browser = await puppeteer.launch({
            ...{ timeout: kHangLimit, protocolTimeout: kHangLimit },
            ...{ browser: "firefox", executablePath, headless: false, env: { ...process.env, DISPLAY: `:${display}` } },
            defaultViewport: { width: 1000, height: 640 },
            extraPrefsFirefox: {
                "browser.download.folderList": 2,
                "browser.download.dir": downloads,
                "browser.download.alwaysOpenPanel": false,
                "dom.events.testing.asyncClipboard": true, // pages may read the clipboard without asking the user
                "layout.css.prefers-color-scheme.content-override": 0, // dark
            },
        });
        atEnd(() => browser.close());
        return { browser, downloads };
    })();
    return shared;
}

/** Opens the page in a new tab and waits for its first picture. The members are as in openWithScript. */
export async function openInFirefox({ url, viewport } = {}) {
    const { browser, downloads } = await firefox();
    const page = await browser.newPage();
    page.setDefaultTimeout(kHangLimit);
    if (viewport) await page.setViewport(viewport);
    const errors = [];
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(error.message));
    await page.goto(url ?? (await common()).url);
    await presented(page, 0);
    await ready(page);
    const script = await scriptFor(page);
    return {
        ...{ page, errors, script, downloads },
        /** Presses keys in Playwright's notation; resolves to the changed state once its picture has been presented. */
        async press(...strokes) {
            const { revision } = await script.state();
            for (const stroke of strokes) await type(page, stroke);
            const state = await script.until((one) => one.revision > revision, `a change by ${strokes.join(" ")}`);
            await presented(page, state.revision);
            return state;
        },
        async close() {
            script.leave();
            await page.close();
        },
    };
}

/** Presses a key with modifiers, as in "Shift+Digit4". */
export async function type(page, stroke) {
    const [, held, key] = /^((?:\w+\+)*)(.+)$/.exec(stroke);
    const modifiers = held.split("+").filter(Boolean);
    for (const modifier of modifiers) await page.keyboard.down(modifier);
    await page.keyboard.press(key === "Space" ? " " : key);
    for (const modifier of modifiers.reverse()) await page.keyboard.up(modifier);
}

/** Waits until the page has presented this revision or a newer one. */
export async function presented(page, revision) {
    await page.waitForFunction(
        (least) => {
            const { revision = -1, draft } = document.getElementById("drawing").dataset;
            return Number(revision) >= least && draft === undefined;
        },
        {},
        revision,
    );
}
