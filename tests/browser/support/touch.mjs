// Fingers on a touch screen.
import { inFirefox } from "./suite.mjs";

/**
 * Returns a function that sends a touch event: "touchStart", "touchMove" or "touchEnd". One finger is at each of the
 * given points. "touchEnd" has no points, because all fingers leave the screen.
 */
export async function touchOf(page) {
    if (inFirefox) return (type, ...points) => page.touch(type, ...points);
    const session = await page.context().newCDPSession(page);
    return (type, ...points) =>
        session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
}
