// The picture on the page, and the two streams that it can be drawn from.
import assert from "node:assert/strict";

import { compare, decode } from "./pixels.mjs";

/** The picture without the frame around the focused drawing. */
export async function picture(page) {
    await page.evaluate(() => document.activeElement.blur());
    return decode(await page.locator("#drawing").screenshot());
}

/** Switches to "geometry" or "frames", and waits for a picture that is drawn from that stream. */
export async function drawBy(page, stream) {
    await page.locator(`[data-page-tool=${stream}]`).dispatchEvent("click"); // in a narrow window it may be in a closed tab
    await page.waitForSelector(`#drawing[data-drawn-by=${stream}]`);
}

/** Asserts that two pictures have a mean difference below `mean` of 255, and that less than `far` of the pixels differ much. */
export function assertSimilar(first, second, { mean, far }) {
    const difference = compare(first, second);
    assert.ok(difference.mean < mean, `mean difference ${difference.mean.toFixed(2)} of 255`);
    assert.ok(difference.far < far, `${(100 * difference.far).toFixed(2)} % of the pixels differ much`);
}

/** Asserts that the page and the server draw the same picture. Afterwards, the page shows the server's. */
export async function assertStreamsAgree(page, limits) {
    const geometry = await picture(page);
    await drawBy(page, "frames");
    assertSimilar(geometry, await picture(page), limits);
}
