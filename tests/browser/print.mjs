// Printing the picture, and full screen.
import assert from "node:assert/strict";

import { openWithScript, presented, ready } from "./support/browser.mjs";
import { drawBy } from "./support/drawing.mjs";
import { covered, decode, pixelAt } from "./support/pixels.mjs";
import { startServer } from "./support/server.mjs";
import { test } from "./support/suite.mjs";
import { recolorForWhite } from "./node_modules/.oval4d/on_white.mjs";

const kWhite = [255, 255, 255];

test("print: the picture alone, on white, with its title and its values", async () => {
    const { page, script, press, errors, close } = await openWithScript();
    await script.request({ type: "set", polytope: "16-cell" });
    const { revision } = await press("y");
    const before = decode(await page.locator("#drawing").screenshot());
    await page.emulateMedia({ media: "print" });
    await page.waitForSelector("#print canvas");
    assert.equal(await page.locator("#print h1").innerText(), "16-cell");
    const values = await page.locator("#print p").first().innerText();
    for (const value of ["α", "β", "w", "δ", "xy", "zw"]) assert.ok(values.includes(value), `${value} in ${values}`);
    const visible = await page.locator("body > :visible").evaluateAll((all) => all.map(({ id }) => id));
    assert.deepEqual(visible, ["print"]);
    const size = await page.locator("#print canvas").evaluate(({ width, height }) => [width, height]);
    assert.ok(Math.max(...size) > 2400, `${size} pixels`);
    const paper = decode(await page.locator("#print canvas").screenshot());
    assert.deepEqual(pixelAt(paper, 3, paper.height - 3), kWhite);
    const ink = covered(paper, kWhite);
    assert.ok(ink > 0.03 && ink < 0.6, `${ink} of the paper is covered`);

    await page.emulateMedia({ media: "screen" });
    await page.waitForFunction(() => document.getElementById("print").childElementCount === 0);
    await presented(page, revision);
    assert.deepEqual(decode(await page.locator("#drawing").screenshot()).data, before.data, "the page is as before");

    await page.evaluate(() => addEventListener("beforeprint", () => (window.printed = !!document.querySelector("#print canvas"))));
    const pdf = await page.pdf();
    assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
    assert.equal(await page.evaluate(() => window.printed), true, "the browser's own command prints the same");
    assert.deepEqual(errors, []);
    await close();
});

test("print: Ctrl-P prints a picture of the server on white, too, within its limits", async () => {
    const server = await startServer({ options: ["--max-pixels", "1200000"] });
    const { page, errors, close } = await openWithScript({
        url: server.url,
        before: () => (window.print = () => void window.dispatchEvent(new Event("beforeprint"))),
    });
    await drawBy(page, "frames");
    await page.locator("#drawing").focus();
    await page.keyboard.press("Control+p");
    await page.waitForSelector("#print canvas", { state: "attached" });
    const corner = await page.locator("#print canvas").evaluate((canvas) => {
        return [...canvas.getContext("2d").getImageData(2, canvas.height - 2, 1, 1).data];
    });
    assert.deepEqual(corner, [...kWhite, 255]);
    const pixels = await page.locator("#print canvas").evaluate(({ width, height }) => width * height);
    assert.ok(pixels > 1_190_000 && pixels <= 1_200_000, `${pixels}`);
    assert.deepEqual(errors, []);
    await close();
    await server.stop();
});

test("print: faces are as opaque as in a picture of the server on white", async () => {
    const { script, errors, close } = await openWithScript();
    const pictureOn = async (background, settings) => {
        await script.request({ type: "set", ...settings, background });
        return script.request({ type: "get", what: "slices" });
    };
    for (const polytope of ["24-cell", "small stellated 120-cell"]) {
        for (const opacity of [0.25, 1, 2, 4]) {
            const settings = { polytope, view: "single", opacity };
            const printed = recolorForWhite(await pictureOn("dark", settings)).scene.opacity;
            const expected = (await pictureOn("white", settings)).scene.opacity;
            assert.ok(Math.abs(printed - expected) < 1e-9, `${polytope}, ${opacity}: ${printed}, not ${expected}`);
        }
    }
    assert.deepEqual(errors, []);
    await close();
});

/** Runs in the page. Records the font sizes, in pixels, of the texts that the page draws on its canvases. */
function recordSizes() {
    const { fillText, clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...area) {
        this.canvas.sizes = [];
        return clearRect.apply(this, area);
    };
    CanvasRenderingContext2D.prototype.fillText = function (...text) {
        this.canvas.sizes?.push(parseFloat(this.font));
        return fillText.apply(this, text);
    };
}

test("full screen: no text beside and in the picture is smaller than 2% of the screen's height", async () => {
    const { page, script, errors, close } = await openWithScript({
        ...{ viewport: { width: 1920, height: 1080 }, before: recordSizes },
    });
    await script.request({ type: "set", polytope: "24-cell" });
    await script.request({ type: "rotate", planes: ["xw", "yz"], angles: [0.3, 1.2] });
    await ready(page);
    await page.click("[data-page-tool=full_screen]");
    await page.waitForSelector(":root[data-full-screen]", { state: "attached" });
    await page.waitForFunction(() => {
        const sizes = document.querySelector("#drawing .overlay").sizes ?? [];
        return sizes.length > 20 && Math.min(...sizes) >= 0.02 * innerHeight;
    });
    assert.equal(await page.locator("#tools").isVisible(), false, "the picture takes their room");
    const small = await page.evaluate(() => {
        const hasText = (one) => [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim() !== "");
        const texts = [...document.querySelectorAll(":is(header, #focus-bar) *")];
        return texts
            .filter((one) => one.checkVisibility() && hasText(one) && !one.closest(".spoken-only"))
            .filter((one) => parseFloat(getComputedStyle(one).fontSize) < 0.02 * innerHeight)
            .map((one) => one.outerHTML);
    });
    assert.deepEqual(small, []);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, "nothing overflows");
    await page.evaluate(() => document.exitFullscreen());
    await page.waitForSelector(":root:not([data-full-screen])", { state: "attached" });
    assert.equal(await page.locator("#tools").isVisible(), true);
    assert.deepEqual(errors, []);
    await close();
});
