// The screen on which a page is shown.
import { inFirefox } from "./suite.mjs";

/**
 * Options for a page that moveToScreen() can move. In Chromium, a fixed size would make the page independent of the
 * screen.
 */
export const kOnScreen = inFirefox ? {} : { viewport: null };

/** Moves a page to a screen with this many device pixels per CSS pixel. The page keeps its size in CSS pixels. */
export async function moveToScreen(page, deviceScaleFactor) {
    if (inFirefox) return page.setPixelRatio(deviceScaleFactor);
    const { width, height } = await page.evaluate(() => ({ width: innerWidth, height: innerHeight }));
    const session = await page.context().newCDPSession(page);
    return session.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor, mobile: false });
}
