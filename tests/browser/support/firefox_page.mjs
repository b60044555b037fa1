// This file is long, because it has a method for each method of Playwright's interface that the tests use.
//
// A page in Firefox with the part of Playwright's interface that the tests use, on top of Puppeteer over WebDriver
// BiDi.
import { readFile, rm } from "node:fs/promises";
import { Readable } from "node:stream";

import { within } from "./hang_limit.mjs";
import { ofElements } from "./in_page.mjs";

/** Throws an Error for options of Playwright that this file does not know, because they must not be ignored. */
function assertNone(options) {
    const [unknown] = Object.keys(options);
    if (unknown !== undefined) throw new Error(`support/firefox_page.mjs does not know the option ${unknown}`);
}

/** Reports events by name to listeners. */
class Events {
    #listeners = new Map();

    on(event, listener) {
        this.#listeners.set(event, [...(this.#listeners.get(event) ?? []), listener]);
    }

    off(event, listener) {
        this.#listeners.set(event, (this.#listeners.get(event) ?? []).filter((one) => one !== listener));
    }

    emit(event, value) {
        for (const listener of this.#listeners.get(event) ?? []) listener(value);
    }

    /** A promise of the value of the next event with this name. */
    next(event) {
        return new Promise((resolve) => {
            const listener = (value) => (this.off(event, listener), resolve(value));
            this.on(event, listener);
        });
    }
}

export class FirefoxPage {
    #page;
    #context;
    #events = new Events();
    #routes = new Map(); // handlers by URL patterns
    #viewport;

    /** `page` is a page of Puppeteer. */
    constructor(page, context, viewport) {
        this.#page = page;
        this.#context = context;
        this.#viewport = viewport;
        this.keyboard = new Keyboard(this);
        this.mouse = new Mouse(this);
        this.touchscreen = { tap: (x, y) => this.touch("touchStart", [x, y]).then(() => this.touch("touchEnd")) };
        page.on("console", (message) => this.#events.emit("console", message));
        page.on("pageerror", (error) => this.#events.emit("pageerror", error));
        page.on("response", (response) => this.#events.emit("response", response));
        page.on("request", (request) => this.#routes.size > 0 && this.#answer(request));
    }

    get id() {
        return this.#page.mainFrame()._id;
    }

    context() {
        return this.#context;
    }

    on(event, listener) {
        this.#events.on(event, listener);
    }

    emit(event, value) {
        this.#events.emit(event, value);
    }

    waitForEvent(event) {
        if (event === "filechooser") return this.#nextFileChooser();
        const next = this.#events.next(event);
        return within(next, `the event ${event}`);
    }

    async #nextFileChooser() {
        const chooser = await this.#page.waitForFileChooser();
        return { setFiles: async (files) => chooser.accept(await this.#context.browser.written(files)) };
    }

    // Functions that Puppeteer has with the same meaning.

    setDefaultTimeout(limit) {
        this.#page.setDefaultTimeout(limit);
    }

    url() {
        return this.#page.url();
    }

    async goto(url) {
        const answer = await this.#page.goto(url);
        const { forcedColors } = this.#context.options;
        if (forcedColors) await this.emulateMedia({ forcedColors });
        return answer;
    }

    reload() {
        return this.#page.reload();
    }

    goBack() {
        return this.#traverseHistory(-1);
    }

    goForward() {
        return this.#traverseHistory(1);
    }

    /**
     * Moves in the browser's history. Puppeteer would wait for the event "load", which a document kept by Firefox does
     * not have.
     */
    async #traverseHistory(delta) {
        await this.evaluate(() => {
            window.isLeaving = true;
            const forget = () => delete window.isLeaving;
            addEventListener("pagehide", forget, { once: true }); // another document follows
            addEventListener("popstate", forget, { once: true }); // the document stays
        });
        await this.#context.browser.send("browsingContext.traverseHistory", { context: this.id, delta });
        await this.waitForFunction(() => !window.isLeaving && document.readyState === "complete");
    }

    bringToFront() {
        return this.#page.bringToFront();
    }

    async close() {
        await this.#context.closePage(this);
    }

    async closeTab() {
        await this.#page.close();
    }

    workers() {
        return this.#page.workers();
    }

    async pdf() {
        return Buffer.from(await this.#page.pdf());
    }

    /** Runs a function in the page before its scripts. Does not run it in the browser's initial blank page. */
    addInitScript(run, given) {
        const argument = given === undefined ? "" : JSON.stringify(given);
        const call = typeof run === "string" ? `{ ${run} }` : `(${run})(${argument})`;
        return this.#page.evaluateOnNewDocument(`if (location.host !== "") ${call}`);
    }

    evaluate(run, given) {
        return this.#page.evaluate(run, ...(given === undefined ? [] : [given]));
    }

    evaluateHandle(run, given) {
        return this.#page.evaluateHandle(run, ...(given === undefined ? [] : [given]));
    }

    waitForFunction(run, given) {
        return this.#page.waitForFunction(run, {}, ...(given === undefined ? [] : [given]));
    }

    viewportSize() {
        return this.#viewport;
    }

    async setViewportSize({ width, height }) {
        this.#viewport = { width, height };
        const { deviceScaleFactor = 1 } = this.#context.options;
        await this.#page.setViewport({ width, height, deviceScaleFactor });
        await this.waitForFunction(([w, h]) => innerWidth === w && innerHeight === h, [width, height]);
    }

    /** Sets the number of device pixels per CSS pixel. Puppeteer's own function would also set the page's size. */
    setPixelRatio(devicePixelRatio) {
        return this.#context.browser.send("browsingContext.setViewport", { context: this.id, devicePixelRatio });
    }

    emulateMedia(media) {
        return this.#context.emulateMedia(this, media);
    }

    async screenshot() {
        return Buffer.from(await this.#page.screenshot());
    }

    async screenshotOf(handle) {
        return Buffer.from(await handle.screenshot());
    }

    /** Lets `handle` answer the requests whose URLs match a pattern; ** in it stands for any text. */
    async route(pattern, handle) {
        const parts = pattern.split("**").map((part) => part.replace(/[.?+^$()[\]{}|\\]/g, "\\$&"));
        this.#routes.set(pattern, { matches: new RegExp(`^${parts.join(".*")}$`), handle });
        await this.#page.setRequestInterception(true);
    }

    async unroute(pattern) {
        this.#routes.delete(pattern);
        if (this.#routes.size === 0) await this.#page.setRequestInterception(false);
    }

    async #answer(request) {
        const route = [...this.#routes.values()].find(({ matches }) => matches.test(request.url()));
        if (!route) return request.continue();
        return route.handle({ fulfill: (answer) => request.respond(answer) });
    }

    // Methods about elements.

    locator(selector, options) {
        return new Locator(this, []).locator(selector, options);
    }

    getByText(text) {
        return this.locator("body").getByText(text);
    }

    waitForSelector(selector, { state = "visible" } = {}) {
        return this.locator(selector).waitFor({ state });
    }

    click(selector, options) {
        return this.locator(selector).click(options);
    }

    tap(selector) {
        return this.locator(selector).tap();
    }

    hover(selector) {
        return this.locator(selector).hover();
    }

    focus(selector) {
        return this.locator(selector).focus();
    }

    fill(selector, text) {
        return this.locator(selector).fill(text);
    }

    press(selector, stroke) {
        return this.locator(selector).press(stroke);
    }

    selectOption(selector, value) {
        return this.locator(selector).selectOption(value);
    }

    dispatchEvent(selector, type, init) {
        return this.locator(selector).dispatchEvent(type, init);
    }

    inputValue(selector) {
        return this.locator(selector).inputValue();
    }

    textContent(selector) {
        return this.locator(selector).textContent();
    }

    innerText(selector) {
        return this.locator(selector).innerText();
    }

    getAttribute(selector, name) {
        return this.locator(selector).getAttribute(name);
    }

    isChecked(selector) {
        return this.locator(selector).isChecked();
    }

    setInputFiles(selector, files) {
        return this.locator(selector).setInputFiles(files);
    }

    /** Calls ofElements() once in the page. */
    find(...given) {
        return this.#page.evaluate(ofElements, ...given);
    }

    findHandle(...given) {
        return this.#page.evaluateHandle(ofElements, ...given);
    }

    /** Calls ofElements() in the page repeatedly, until it returns something true. */
    async until(...given) {
        const handle = await this.#page.waitForFunction(ofElements, {}, ...given);
        return handle.jsonValue();
    }

    /** What assistive technology is told about each matching element, as {role, name}; undefined if nothing. */
    async accessible(selector) {
        const isDrawn = await this.evaluate(async (wanted) => {
            // Firefox tells assistive technology about changes when it draws the page.
            for (let frames = 0; frames < 2; ++frames) await new Promise((resolve) => requestAnimationFrame(resolve));
            return [...document.querySelectorAll(wanted)].map((one) => one.checkVisibility());
        }, selector);
        return this.#context.browser.accessible(this, selector, isDrawn);
    }

    // Methods for input.

    defineKey(value, events) {
        return this.#context.browser.defineKey(value, events);
    }

    /** Performs actions of input devices, given as for WebDriver BiDi's command input.performActions. */
    perform(actions) {
        return this.#context.browser.send("input.performActions", { context: this.id, actions });
    }

    #fingers = 0;

    /**
     * Sends a touch event with one finger at each of the points, like the DevTools command Input.dispatchTouchEvent.
     */
    async touch(type, ...points) {
        const sources = (actionsOf) =>
            Array.from({ length: points.length || this.#fingers }, (_, id) => ({
                ...{ type: "pointer", id: `finger ${id}`, parameters: { pointerType: "touch" } },
                actions: actionsOf(points[id]),
            }));
        const moved = ([x, y]) => ({ type: "pointerMove", x, y });
        if (type === "touchStart") {
            this.#fingers = points.length;
            await this.perform(sources((at) => [moved(at), { type: "pointerDown", button: 0 }]));
        } else if (type === "touchMove") {
            await this.perform(sources((at) => [moved(at)]));
        } else {
            await this.perform(sources(() => [{ type: "pointerUp", button: 0 }]));
            this.#fingers = 0;
        }
    }
}

/**
 * A description of elements in a page, which are searched anew at each use. All methods except count(), all() and
 * isVisible() wait until an element exists.
 */
class Locator {
    #page;
    #steps;

    constructor(page, steps) {
        this.#page = page;
        this.#steps = steps;
    }

    #then(step) {
        return new Locator(this.#page, [...this.#steps, step]);
    }

    get steps() {
        return this.#steps;
    }

    locator(selector, { hasText, ...others } = {}) {
        assertNone(others);
        const condition = hasText === undefined ? "" : `:has-text(${JSON.stringify(hasText)})`;
        return this.#then({ selector: selector + condition });
    }

    getByText(text) {
        return this.#then({ text });
    }

    filter({ has, visible, ...others }) {
        assertNone(others);
        return this.#then(has ? { has: has.steps } : { visible });
    }

    first() {
        return this.nth(0);
    }

    nth(at) {
        return this.#then({ at });
    }

    count() {
        return this.#page.find(this.#steps, "count");
    }

    async all() {
        return Array.from({ length: await this.count() }, (_, i) => this.nth(i));
    }

    async waitFor({ state = "visible" } = {}) {
        await this.#page.until(this.#steps, "isIn", state);
    }

    async #whenAttached(operation, given = null) {
        await this.waitFor({ state: "attached" });
        return this.#page.find(this.#steps, operation, given);
    }

    isVisible() {
        return this.#page.find(this.#steps, "isVisible");
    }

    isDisabled() {
        return this.#whenAttached("isDisabled");
    }

    async isEnabled() {
        return !(await this.isDisabled());
    }

    isChecked() {
        return this.#whenAttached("get", "checked");
    }

    textContent() {
        return this.#whenAttached("get", "textContent");
    }

    innerText() {
        return this.#whenAttached("get", "innerText");
    }

    inputValue() {
        return this.#whenAttached("get", "value");
    }

    getAttribute(name) {
        return this.#whenAttached("attribute", name);
    }

    allTextContents() {
        return this.#page.find(this.#steps, "texts", "textContent");
    }

    allInnerTexts() {
        return this.#page.find(this.#steps, "texts", "innerText");
    }

    boundingBox() {
        return this.#whenAttached("box");
    }

    scrollIntoViewIfNeeded() {
        return this.#whenAttached("show");
    }

    focus() {
        return this.#whenAttached("focus");
    }

    async dispatchEvent(type, { dataTransfer, ...others } = {}) {
        assertNone(others);
        await this.waitFor({ state: "attached" });
        const element = await this.#page.findHandle(this.#steps, "first");
        await element.evaluate(
            (one, name, data) => {
                const usual = { bubbles: true, cancelable: true, composed: true };
                const dropping = () => new DragEvent(name, { ...usual, dataTransfer: data });
                one.dispatchEvent(data ? dropping() : new MouseEvent(name, usual));
            },
            ...[type, dataTransfer],
        );
    }

    async evaluate(run, given) {
        await this.waitFor({ state: "attached" });
        const element = await this.#page.findHandle(this.#steps, "first");
        return element.evaluate(run, given);
    }

    async evaluateAll(run, given) {
        const elements = await this.#page.findHandle(this.#steps, "all");
        return elements.evaluate(run, given);
    }

    async screenshot({ animations } = {}) {
        await this.waitFor();
        if (animations === "disabled") {
            await this.#page.evaluate(() => document.getAnimations().forEach((one) => one.finish()));
        }
        return this.#page.screenshotOf(await this.#page.findHandle(this.#steps, "first"));
    }

    /** Waits until a user could press the element. Returns the point to press. */
    #pressablePoint(position = null) {
        return this.#page.until(this.#steps, "pressablePoint", position);
    }

    async click({ position, button, ...others } = {}) {
        assertNone(others);
        const { x, y } = await this.#pressablePoint(position);
        await this.#page.mouse.click(x, y, { button });
    }

    async hover() {
        const { x, y } = await this.#pressablePoint();
        await this.#page.mouse.move(x, y);
    }

    async tap() {
        const { x, y } = await this.#pressablePoint();
        await this.#page.touchscreen.tap(x, y);
    }

    async press(stroke) {
        await this.focus();
        await this.#page.keyboard.press(stroke);
    }

    async fill(text) {
        await this.#page.until(this.#steps, "fill", text);
    }

    async selectOption(value) {
        await this.#page.until(this.#steps, "choose", value);
    }

    async setInputFiles(given) {
        const files = [given].flat().map(({ name, mimeType, buffer }) => {
            return { name, type: mimeType, base64: buffer.toString("base64") };
        });
        await this.#whenAttached("setFiles", files);
    }
}

// WebDriver's codes for keys without a character: https://www.w3.org/TR/webdriver2/#keyboard-actions
const kKeys = {
    ...{ Backspace: "\ue003", Tab: "\ue004", Enter: "\ue007", Shift: "\ue008", Control: "\ue009", Alt: "\ue00a" },
    ...{ Escape: "\ue00c", Space: " ", PageUp: "\ue00e", PageDown: "\ue00f", End: "\ue010", Home: "\ue011" },
    ...{ ArrowLeft: "\ue012", ArrowUp: "\ue013", ArrowRight: "\ue014", ArrowDown: "\ue015" },
    ...{ Insert: "\ue016", Delete: "\ue017", Meta: "\ue03d", "\n": "\ue007" },
    ...{ Minus: "-", Equal: "=", BracketLeft: "[", BracketRight: "]", Comma: ",", Period: ".", Slash: "/" },
    ...{ Semicolon: ";", Quote: "'", Backquote: "`", Backslash: "\\" },
};

const kOtherKey = "\ue100"; // a code that WebDriver does not use

/** The WebDriver code of the key with this name in Playwright. */
function valueOf(name) {
    if (kKeys[name]) return kKeys[name];
    const [, letter, digit, pad, f] = /^(?:Key([A-Z])|Digit(\d)|Numpad(\d)|F(\d+))$/.exec(name) ?? [];
    if (letter) return letter.toLowerCase();
    if (digit) return digit;
    if (pad) return String.fromCharCode(0xe01a + Number(pad));
    if (f) return String.fromCharCode(0xe030 + Number(f));
    if ([...name].length !== 1) throw new Error(`support/firefox_page.mjs must say which key ${name} is`);
    return name;
}

/** A keyboard that takes keys in Playwright's notation, such as "Shift+Digit4". */
class Keyboard {
    #page;

    constructor(page) {
        this.#page = page;
    }

    #perform(actions) {
        return this.#page.perform([{ type: "key", id: "keyboard", actions }]);
    }

    down(key) {
        return this.#perform([{ type: "keyDown", value: valueOf(key) }]);
    }

    up(key) {
        return this.#perform([{ type: "keyUp", value: valueOf(key) }]);
    }

    press(stroke) {
        const [, held, key] = /^((?:(?:Shift|Control|Alt|Meta)\+)*)(.+)$/s.exec(stroke);
        return this.#pressTogether([...held.split("+").filter(Boolean), key].map(valueOf));
    }

    /**
     * Presses a key of a keyboard with another layout. `key` is what the key types; `code` is its place on the
     * keyboard.
     */
    async pressOther({ key, code, shift }) {
        await this.#page.defineKey(kOtherKey, { key, code });
        await this.#pressTogether([...(shift ? [kKeys.Shift] : []), kOtherKey]);
    }

    #pressTogether(values) {
        return this.#perform([
            ...values.map((value) => ({ type: "keyDown", value })),
            ...[...values].reverse().map((value) => ({ type: "keyUp", value })),
        ]);
    }

    type(text) {
        const ofKey = (value) => [{ type: "keyDown", value }, { type: "keyUp", value }];
        return this.#perform([...text].map(valueOf).flatMap(ofKey));
    }
}

const kButtons = { left: 0, middle: 1, right: 2 };

class Mouse {
    #page;
    #at = { x: 0, y: 0 };

    constructor(page) {
        this.#page = page;
    }

    #perform(actions) {
        return this.#page.perform([{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions }]);
    }

    #moveTo(x, y) {
        this.#at = { x, y };
        return { type: "pointerMove", x, y };
    }

    move(x, y, { steps = 1 } = {}) {
        const from = this.#at;
        const part = (i) => this.#moveTo(from.x + ((x - from.x) * i) / steps, from.y + ((y - from.y) * i) / steps);
        return this.#perform(Array.from({ length: steps }, (_, i) => part(i + 1)));
    }

    down({ button = "left" } = {}) {
        return this.#perform([{ type: "pointerDown", button: kButtons[button] }]);
    }

    up({ button = "left" } = {}) {
        return this.#perform([{ type: "pointerUp", button: kButtons[button] }]);
    }

    click(x, y, { button = "left", count = 1 } = {}) {
        const press = ["pointerDown", "pointerUp"].map((type) => ({ type, button: kButtons[button] }));
        return this.#perform([this.#moveTo(x, y), ...Array.from({ length: count }, () => press).flat()]);
    }

    dblclick(x, y) {
        return this.click(x, y, { count: 2 });
    }

    wheel(deltaX, deltaY) {
        const { x, y } = this.#at;
        const scroll = { type: "scroll", x: Math.round(x), y: Math.round(y), deltaX, deltaY };
        return this.#page.perform([{ type: "wheel", id: "wheel", actions: [scroll] }]);
    }
}

/** A file that a page downloads. `ended` resolves to the file's path. */
export class Download {
    #name;
    #bytes;

    constructor(name, ended) {
        this.#name = name;
        this.#bytes = this.#take(ended);
        this.#bytes.catch(() => {}); // the reader of the file gets the error
    }

    /** Reads the file, then removes it. Otherwise Firefox would rename the next file with the same name. */
    async #take(ended) {
        const path = await within(ended, `the download of ${this.#name}`);
        const bytes = await readFile(path);
        await rm(path);
        return bytes;
    }

    suggestedFilename() {
        return this.#name;
    }

    async createReadStream() {
        return Readable.from([await this.#bytes]);
    }
}
