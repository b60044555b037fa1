// Starts Firefox. Puppeteer drives it over WebDriver BiDi. This module offers the part of Playwright's interface that
// the tests use, so that the tests are the same in both browsers.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import puppeteer from "puppeteer-core";

import { Download, FirefoxPage } from "./firefox_page.mjs";
import { kHangLimit, within } from "./hang_limit.mjs";
import { atEnd } from "./suite.mjs";

const kBrowsers = ["/usr/bin/firefox-esr", "/usr/bin/firefox"];
const executablePath = process.env.OVAL4D_FIREFOX ?? kBrowsers.find((path) => existsSync(path));

/** Starts an X server without a screen, because headless Firefox has no WebGL. Returns the number of the display. */
async function startDisplay() {
    const server = spawn("Xvfb", ["-displayfd", "3", "-screen", "0", "1600x1200x24", "-nolisten", "tcp"], {
        stdio: ["ignore", "ignore", "ignore", "pipe"],
    });
    const kill = () => server.kill();
    atEnd(kill);
    process.on("exit", kill);
    const number = new Promise((resolve, reject) => {
        server.once("error", reject);
        server.once("exit", (code) => reject(new Error(`Xvfb ended with ${code}`)));
        server.stdio[3].once("data", (text) => resolve(Number(text)));
    });
    return within(number, "Xvfb to start");
}

/** Starts Firefox with additional preferences. */
export async function startFirefox(preferences = {}) {
    const downloads = mkdtempSync(join(tmpdir(), "oval4d-firefox-"));
    atEnd(() => rmSync(downloads, { recursive: true, force: true }));
    const display = await startDisplay();
    const browser = await puppeteer.launch({
        ...{ timeout: kHangLimit, protocolTimeout: kHangLimit },
        ...{ browser: "firefox", executablePath, headless: false, env: { ...process.env, DISPLAY: `:${display}` } },
        args: ["--remote-allow-system-access"], // to set the user's preferences and the touch screen
        defaultViewport: null,
        extraPrefsFirefox: {
            "browser.download.folderList": 2,
            "browser.download.dir": downloads,
            "browser.download.alwaysOpenPanel": false,
            "browser.download.viewableInternally.enabledTypes": "", // so that downloads are not shown in tabs
            "pdfjs.disabled": true,
            "dom.events.testing.asyncClipboard": true, // pages may read the clipboard without asking
            "dom.w3c_touch_events.enabled": 1,
            "ui.key.menuAccessKeyFocuses": false, // Alt alone does not open the browser's menu
            ...preferences,
        },
    });
    const started = new FirefoxBrowser(browser, downloads);
    await started.begin();
    return started;
}

/** Maps options of Playwright's emulateMedia() to the properties of Firefox's BrowsingContext that they set. */
const kMedia = {
    media: ["mediumOverride", (value) => (value === "print" ? "print" : "")],
    colorScheme: ["prefersColorSchemeOverride", (value) => value],
    forcedColors: ["forcedColorsOverride", (value) => value],
};

const kFingers = 1; // a coarse pointer that cannot hover

/** The preferences that the options of an open context set for all pages. */
const kPreferences = {
    colorScheme: (value) => ({ "layout.css.prefers-color-scheme.content-override": value === "light" ? 1 : 0 }),
    hasTouch: (has) => has && { "ui.primaryPointerCapabilities": kFingers, "ui.allPointerCapabilities": kFingers },
    reducedMotion: (value) => ({ "ui.prefersReducedMotion": Number(value === "reduce") }),
};

class FirefoxBrowser {
    #browser;
    #chrome; // the window of the browser's own user interface
    #folder; // for temporary files
    #contexts = new Set(); // the open contexts
    #pages = new Map(); // by the identifiers of their browsing contexts

    constructor(browser, folder) {
        this.#browser = browser;
        this.#folder = folder;
    }

    /** Finds the window of the browser's own user interface, and listens to events that Puppeteer does not report. */
    async begin() {
        const { contexts } = await this.send("browsingContext.getTree", { "moz:scope": "chrome" });
        this.#chrome = contexts[0].context;
        const { connection } = this.#browser;
        const events = ["browsingContext.downloadWillBegin", "browsingContext.downloadEnd"];
        await this.send("session.subscribe", { events });
        connection.on("browsingContext.downloadWillBegin", ({ context, suggestedFilename, url }) => {
            const ended = new Promise((resolve, reject) => {
                const listen = (end) => {
                    if (end.url !== url) return; // each file has its own URL
                    connection.off("browsingContext.downloadEnd", listen);
                    if (end.status === "complete") resolve(end.filepath);
                    else reject(new Error(`the download was ${end.status}`));
                };
                connection.on("browsingContext.downloadEnd", listen);
            });
            this.#pages.get(context)?.emit("download", new Download(suggestedFilename, ended));
        });
    }

    /** Sends a command of WebDriver BiDi. */
    async send(method, parameters) {
        const { result } = await this.#browser.connection.send(method, parameters);
        return result;
    }

    /**
     * Evaluates an expression in the window of the browser's own user interface. Resolves to the value, which must be a
     * text.
     */
    async evaluateInBrowser(expression) {
        const target = { context: this.#chrome };
        const answer = await this.send("script.evaluate", { expression, target, awaitPromise: true });
        if (answer.type === "exception") throw new Error(answer.exceptionDetails.text);
        return answer.result.value;
    }

    /**
     * What assistive technology is told about each matching element, as {role, name}; undefined if nothing. `isDrawn`
     * tells which elements are drawn. WebDriver BiDi can only search by role and name; Firefox's older driver tells
     * both.
     */
    async accessible(page, selector, isDrawn) {
        const found = await this.evaluateInBrowser(`(async () => {
            const load = (path) => ChromeUtils.importESModule("chrome://remote/content/" + path);
            const { RemoteAgent } = load("components/RemoteAgent.sys.mjs");
            const { NavigableManager } = load("shared/NavigableManager.sys.mjs");
            const older = load("marionette/actors/MarionetteCommandsParent.sys.mjs");
            older.registerCommandsActor(RemoteAgent.webDriverBiDi.session.id);
            const context = NavigableManager.getBrowsingContextById(${JSON.stringify(page.id)});
            const commands = older.getMarionetteCommandsActorProxy(() => context);
            const elements = await commands.findElements("css selector", ${JSON.stringify(selector)}, {});
            const isDrawn = ${JSON.stringify(isDrawn)};
            if (elements.length !== isDrawn.length) throw new Error("the page has changed meanwhile");
            const found = [];
            for (const [i, element] of elements.entries()) {
                const role = isDrawn[i] ? await commands.getComputedRole(element) : "none";
                found.push(role === "none" ? null : { role, name: await commands.getComputedLabel(element) });
            }
            return JSON.stringify(found);
        })()`);
        return JSON.parse(found).map((one) => one ?? undefined);
    }

    /** Sets preferences of Firefox, given as pairs [name, number]. */
    async prefer(preferences) {
        const set = ([name, number]) => `Services.prefs.setIntPref(${JSON.stringify(name)}, ${number});`;
        if (preferences.length > 0) await this.evaluateInBrowser(preferences.map(set).join(" "));
    }

    /** Adds a key to WebDriver's American keyboard. `value` names the key; its events have `key` and `code`. */
    async defineKey(value, { key, code }) {
        const path = "chrome://remote/content/shared/webdriver/KeyData.sys.mjs";
        const added = { key, code, location: 0, printable: true, shifted: false };
        await this.evaluateInBrowser(`{
            const { keyData } = ChromeUtils.importESModule(${JSON.stringify(path)});
            const [added, american] = [${JSON.stringify(added)}, (keyData.american ??= keyData.getData)];
            keyData.getData = (value) => (value === ${JSON.stringify(value)} ? added : american(value));
        }`);
    }

    /** Removes the preferences of a closed context, and sets those of the other contexts again. */
    async closedContext(context) {
        this.#contexts.delete(context);
        const reset = ([name]) => `Services.prefs.clearUserPref(${JSON.stringify(name)});`;
        if (context.preferences.length > 0) await this.evaluateInBrowser(context.preferences.map(reset).join(" "));
        for (const other of this.#contexts) await this.prefer(other.preferences);
    }

    on(event, listener) {
        this.#browser.on(event, listener);
    }

    async newContext(options = {}) {
        const context = new FirefoxContext(this, await this.#browser.createBrowserContext(), options);
        this.#contexts.add(context);
        return context;
    }

    opened(page) {
        this.#pages.set(page.id, page);
    }

    closed(page) {
        this.#pages.delete(page.id);
    }

    /** Whether a new page needs its own window to be drawn. In a window, only the front tab is drawn. */
    get isShowing() {
        return this.#pages.size > 1;
    }

    /** Writes files, given as {name, buffer}, to a temporary folder. Returns their paths. */
    async written(files) {
        const folder = mkdtempSync(join(this.#folder, "chosen-"));
        return files.map(({ name, buffer }) => {
            const path = join(folder, name);
            writeFileSync(path, buffer);
            return path;
        });
    }

    close() {
        return this.#browser.close();
    }
}

/**
 * Pages with the same options and storage. Two of Playwright's options do nothing here. `permissions` is not needed,
 * because all pages may use the clipboard. `isMobile` is meaningless in a desktop browser, which is then only as narrow
 * as a phone.
 */
class FirefoxContext {
    #context;
    #pages = new Set();

    constructor(browser, context, options) {
        this.browser = browser;
        this.options = options;
        this.#context = context;
    }

    async newPage() {
        const { viewport, deviceScaleFactor = 1 } = this.options;
        const opened = await this.#context.newPage({ type: this.browser.isShowing ? "window" : "tab" });
        const page = new FirefoxPage(opened, this, viewport);
        this.browser.opened(page);
        this.#pages.add(page);
        if (viewport) await opened.setViewport({ ...viewport, deviceScaleFactor });
        await this.browser.prefer(this.preferences);
        return page;
    }

    /** The preferences that the options set, as pairs [name, number]. */
    get preferences() {
        const given = Object.entries(kPreferences).filter(([option]) => this.options[option] !== undefined);
        return given.flatMap(([option, of]) => Object.entries(of(this.options[option]) || {}));
    }

    /** Sets the page's media features. Firefox forgets them when a page from another site follows. */
    async emulateMedia(page, media) {
        const path = "chrome://remote/content/shared/NavigableManager.sys.mjs";
        for (const [name, value] of Object.entries(media)) {
            const [property, valueOf] = kMedia[name];
            await this.browser.evaluateInBrowser(`{
                const { NavigableManager } = ChromeUtils.importESModule(${JSON.stringify(path)});
                const context = NavigableManager.getBrowsingContextById(${JSON.stringify(page.id)});
                context[${JSON.stringify(property)}] = ${JSON.stringify(valueOf(value))};
            }`);
        }
    }

    async closePage(page) {
        this.#pages.delete(page);
        this.browser.closed(page);
        await page.closeTab();
    }

    async close() {
        for (const page of this.#pages) this.browser.closed(page);
        await this.browser.closedContext(this);
        await this.#context.close();
    }
}
