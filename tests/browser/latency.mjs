// The latencies that the page itself measures: how the page shows and saves them.
import assert from "node:assert/strict";

import { openWithScript, ready } from "./support/browser.mjs";
import { bytesOf } from "./support/downloads.mjs";
import { test } from "./support/suite.mjs";

const kMeasure = "oval4d key to picture";

async function command(page, line) {
    await page.keyboard.press(":");
    await page.waitForSelector("#command:focus");
    await page.fill("#command", line);
    await page.keyboard.press("Enter");
}

test("latency: the time from key to picture is shown and saved on request", async () => {
    const start = Date.now();
    const { page, press, errors, close } = await openWithScript();
    await command(page, "export latency");
    await page.waitForFunction(() => /measured yet/.test(document.getElementById("command-error").textContent));
    await page.keyboard.press("Escape");
    const output = page.locator("#latency");
    assert.equal(await output.isVisible(), false);
    await command(page, "set latency");
    await output.waitFor();
    await page.waitForSelector("#drawing:focus");
    for (const key of ["y", "y", "4", "]", "n"]) await press(key);
    await page.waitForFunction(() => /5 measured/.test(document.getElementById("latency").textContent));
    assert.match(await output.textContent(), /Key-to-picture latency [\d.]+ ms · median [\d.]+ ms · 99th percentile [\d.]+ ms/);
    await press("0", "4"); // the focus is already at 0: no picture follows
    await page.waitForFunction(() => /6 measured/.test(document.getElementById("latency").textContent));

    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await page.focus("#drawing");
    await press("y");
    const measures = await page.evaluate(
        (name) => performance.getEntriesByName(name).map(({ duration, detail }) => ({ duration, ...detail })),
        kMeasure,
    );
    assert.equal(measures.length, 7);
    assert.ok(measures.every(({ duration }) => duration > 0));

    const waiting = page.waitForEvent("download");
    await command(page, "export latency");
    const download = await waiting;
    assert.equal(download.suggestedFilename(), "latency.csv");
    const [head, ...rows] = (await bytesOf(download)).toString().trim().split("\n");
    assert.equal(head, "sent,milliseconds,revision,request,drawn_by");
    assert.equal(rows.length, 7);
    rows.forEach((row, i) => {
        const [sent, milliseconds, revision, request, by] = row.split(",");
        assert.ok(Date.parse(sent) >= start - 1000 && Date.parse(sent) <= Date.now() + 1000, sent); // clocks are rounded
        assert.ok(Math.abs(Number(milliseconds) - measures[i].duration) < 0.02);
        assert.deepEqual([Number(revision), request, by], [measures[i].revision, "key", i < 6 ? "geometry" : "frames"]);
    });

    await page.reload();
    await ready(page);
    assert.ok(await output.isVisible(), "the setting survives a reload");
    await page.focus("#drawing");
    await command(page, "set nolatency");
    await output.waitFor({ state: "hidden" });
    assert.deepEqual(errors, []);
    await close();
});

test("latency: a measurement ends after the animation frame that drew the picture, whoever draws it", async () => {
    /** Runs in the page. Records when the callbacks that draw a picture have returned. */
    const watchDrawing = () => {
        window.drawn = [];
        const record = () => {
            const now = performance.now();
            while (performance.now() === now); // waits for the next tick of the rounded clock
            window.drawn.push(performance.now());
        };
        const watch = (owner, method) => {
            const plain = owner[method];
            owner[method] = function (...given) {
                queueMicrotask(record);
                return plain.apply(this, given);
            };
        };
        watch(WebGL2RenderingContext.prototype, "drawElements");
        watch(ImageBitmapRenderingContext.prototype, "transferFromImageBitmap");
    };
    const { page, press, close } = await openWithScript({ before: watchDrawing });
    for (const key of ["y", "4"]) await press(key);
    await page.click("[data-page-tool=frames]");
    await page.waitForSelector("#drawing[data-drawn-by=frames]");
    await page.focus("#drawing");
    for (const key of ["y", "4"]) await press(key);
    await page.waitForFunction((name) => performance.getEntriesByName(name).length === 4, kMeasure);
    const { measures, drawn } = await page.evaluate((name) => {
        const entries = performance.getEntriesByName(name);
        return { measures: entries.map(({ startTime, duration }) => [startTime, startTime + duration]), drawn: window.drawn };
    }, kMeasure);
    for (const [start, end] of measures) {
        const within = drawn.filter((time) => time > start && time <= end + 1e-6);
        assert.ok(within.length > 0, `nothing was drawn from ${start} to ${end}`);
    }
    await close();
});
