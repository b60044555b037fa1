// The screen on which a page is shown.
import { inFirefox } from "./suite.mjs";

/** Options of a page that moveToScreen() moves: in Chromium, a size of its own would separate it from the screen. */
export const kOnScreen = inFirefox ? {} : { viewport: null };

/** Moves a page to a screen with this many pixels per CSS pixel; its size in CSS pixels stays the same. */
export async function moveToScreen(page, deviceScaleFactor) {
    if (inFirefox) return page.setPixelRatio(deviceScaleFactor);
    const { width, height } = await page.evaluate(() => ({ width: innerWidth, height: innerHeight }));
    const session = await page.context().newCDPSession(page);
    return session.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor, mobile: false });
}
