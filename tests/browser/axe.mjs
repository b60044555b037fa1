// The page obeys the rules of axe-core: WCAG 2.2, levels A and AA, and best practices.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

import { openWithScript } from "./support/browser.mjs";
import { test } from "./support/suite.mjs";

const source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/**
 * Returns the rules that the page breaks, and the rules that axe cannot decide, with the elements. Axe cannot decide
 * about the contrast and the name of a button that shows only a symbol; accessibility.mjs tests these.
 */
async function faults(page) {
    await page.evaluate(source);
    return page.evaluate(async () => {
        const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22a", "wcag22aa", "best-practice"];
        const rules = { "label-content-name-mismatch": { enabled: true }, "target-size": { enabled: true } };
        const { violations, incomplete } = await axe.run(document, { runOnly: { type: "tag", values: tags }, rules });
        const untold = incomplete.filter(({ id }) => !["color-contrast", "label-content-name-mismatch"].includes(id));
        return [...violations, ...untold].flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html}`));
    });
}

const settings = {
    "a wide window": {},
    "a phone": { viewport: { width: 375, height: 667 }, hasTouch: true, isMobile: true },
    "a window zoomed to 400%": { viewport: { width: 320, height: 256 } },
};

for (const [setting, options] of Object.entries(settings)) {
    test(`axe: finds no fault in ${setting}`, async () => {
        const { page, press, close } = await openWithScript(options);
        const examine = async (state) => assert.deepEqual(await faults(page), [], state);
        /** Waits until an element contains a text. */
        const says = (id) => page.waitForFunction((one) => document.getElementById(one).textContent !== "", id);

        await examine("at the start");
        for (const tab of await page.locator(".tabs button:visible").all()) {
            await tab.click();
            await examine(`the tools: ${await tab.textContent()}`);
        }
        await page.focus("#drawing");
        await press("w");
        await examine("the projection");
        await press("m");
        await examine("the matrix");
        for (const [keys, id] of Object.entries({ s: "picker", x: "export", "?": "help", ":share\n": "phone" })) {
            await page.keyboard.type(keys);
            await page.waitForSelector(`#${id}[open]`);
            if (id === "picker") await page.waitForSelector("#picker-list [role=option]");
            await examine(id);
            if (id === "picker") {
                await page.fill("#picker-search", "25-cell");
                await page.keyboard.press("Enter");
                await says("picker-error");
                await examine("the picker with an error");
            }
            await page.keyboard.press("Escape");
            await page.waitForSelector("#drawing:focus");
        }
        await page.keyboard.press(":");
        await page.waitForSelector("#command:focus");
        await page.keyboard.type("polytope 25-cell");
        await page.keyboard.press("Enter");
        await says("command-error");
        await examine("the command line with an error");
        await page.keyboard.press("Escape");
        await page.locator("[data-page-tool=field]").dispatchEvent("click");
        await page.waitForSelector("#field:not([hidden])");
        await page.waitForFunction(() => !document.getElementById("field-levels").disabled);
        await examine("the panel of a field");
        await page.fill("#field-formula", "x^2 + $");
        await page.fill("#field-levels", "one");
        await page.fill("[data-end='w to']", "none");
        for (const id of ["field-error", "field-levels-error", "field-box-error"]) await says(id);
        await examine("the panel of a field with errors");
        await page.click("#field-close");
        const simplex = "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
        for (const [outcome, text] of Object.entries({ failed: "4OFF\n1 2 three\n", done: `${simplex}0 0 0 1\n` })) {
            await page.setInputFiles("#file", { name: "mine.txt", mimeType: "", buffer: Buffer.from(text) });
            await page.waitForSelector(`#loading[data-outcome=${outcome}]`);
            await examine(`the report of a file: ${outcome}`);
        }
        await close();
    });
}

test("axe: finds faults", async () => {
    const { page, close } = await openWithScript();
    await page.evaluate(() => {
        const unnamed = document.createElement("button");
        const misnamed = Object.assign(document.createElement("button"), { ariaLabel: "Send", textContent: "Start" });
        const faint = Object.assign(document.createElement("p"), { textContent: "Hardly readable" });
        Object.assign(faint.style, { color: "gray", background: "dimgray" }); // the page forbids styles in HTML
        document.getElementById("tools").prepend(unnamed, misnamed, faint);
    });
    const found = await faults(page);
    for (const rule of ["button-name", "label-content-name-mismatch", "color-contrast"]) {
        assert.ok(
            found.some((fault) => fault.startsWith(rule)),
            `${rule}: ${found}`,
        );
    }
    await close();
});
