// The field panel, and the surfaces of a field's slices.
import { named, openWithScript, presented } from "./browser.mjs";
import { passTime } from "./page_time.mjs";
import { pixelAt } from "./pixels.mjs";
import { project } from "./scene.mjs";

const kLong = 1000; // milliseconds after which the page has sent what was typed
const stoppedPages = new WeakSet();

/** Opens the page and the field panel, and waits for the field. */
export async function openPanel(options) {
    const opened = await openWithScript(options);
    if (options?.isStopped) stoppedPages.add(opened.page);
    await opened.page.locator("[data-page-tool=field]").dispatchEvent("click"); // may be in a closed tab
    const { revision } = await opened.script.until((state) => state.levels !== undefined, "a field");
    await loaded(opened.page);
    await presented(opened.page, revision);
    await named(opened.page, "formula");
    return opened;
}

export const formula = (page) => page.inputValue("#field-formula");

/** Waits until the panel waits for no answer. Loading a field takes several requests. */
const loaded = (page) => page.waitForSelector("#field[aria-busy=false]", { state: "attached" });

/** Writes a formula, and waits until its picture is presented. */
export function write(page, script, text) {
    return change(page, script, "#field-formula", text);
}

/** Fills a control of the field panel. Waits until the field with its settings is loaded and presented. */
export async function change(page, script, selector, text) {
    const before = (await script.state()).revision;
    await page.fill(selector, text);
    if (stoppedPages.has(page)) await passTime(page, kLong);
    await script.until(({ revision }) => revision > before, text);
    await loaded(page);
    const state = await script.state();
    await presented(page, state.revision);
    return state;
}

/** The surface of the focus slice, with the scene and the size of the picture. */
export async function focusSurface(page, script) {
    const { width, height } = await page.locator("#drawing").boundingBox();
    const { scene, slices } = await script.request({ type: "get", what: "slices", width, height });
    const slice = slices.find(({ focus }) => focus);
    return { scene, slice, surface: slice.surface, size: { width, height } };
}

/** The pixels at the points of the focus slice's surface that are nearest to the eye. */
export function surfacePixels(shown, { scene, slice, surface, size }) {
    const pixels = [];
    for (let i = 0; i < surface.points.length; i += 3) {
        if (surface.normals[i + 2] < 0.7) continue; // does not face the eye
        const world = slice.position.map((at, k) => at + scene.scale * surface.points[i + k]);
        const [x, y] = project(scene, world, size);
        pixels.push(pixelAt(shown, Math.floor(x), Math.floor(y)));
    }
    return pixels;
}
