// The picture on the page, which is drawn from one of two streams: geometry or frames.
import assert from "node:assert/strict";

import { compare, decode } from "./pixels.mjs";

/** The picture, without the line around the focused drawing. */
export async function picture(page) {
    await page.evaluate(() => document.activeElement.blur());
    return decode(await page.locator("#drawing").screenshot());
}

/** Switches to "geometry" (the page draws) or "frames" (the server draws), and waits for such a picture. */
export async function drawBy(page, stream) {
    await page.locator(`[data-page-tool=${stream}]`).dispatchEvent("click"); // may be in a closed tab
    await page.waitForSelector(`#drawing[data-drawn-by=${stream}]`);
}

/**
 * Asserts that two pictures are similar: their mean difference is below `mean` (of 255), and less than the fraction
 * `far` of their pixels differs much.
 */
export function assertSimilar(first, second, { mean, far }) {
    const difference = compare(first, second);
    assert.ok(difference.mean < mean, `mean difference ${difference.mean.toFixed(2)} of 255`);
    assert.ok(difference.far < far, `${(100 * difference.far).toFixed(2)} % of the pixels differ much`);
}

/** Asserts that the page and the server draw the same picture. Afterward, the page shows the server's picture. */
export async function assertStreamsAgree(page, limits) {
    const geometry = await picture(page);
    await drawBy(page, "frames");
    assertSimilar(geometry, await picture(page), limits);
}
