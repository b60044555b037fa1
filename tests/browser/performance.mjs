// How long a user waits for a picture. The test compares this with the times of the steps, measured in the same run.
import assert from "node:assert/strict";

import { common, openWithScript, presented, stateAfter } from "./support/browser.mjs";
import { joinSession } from "./support/script.mjs";
import { test } from "./support/suite.mjs";

const kSamples = 100;

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** Runs in the page. Turns the wheel a little, and returns the milliseconds until the moved picture is drawn. */
async function timeDrawing() {
    const start = performance.now();
    document.getElementById("drawing").dispatchEvent(new WheelEvent("wheel", { deltaY: 1, cancelable: true }));
    for (let k = 0; k < 2; ++k) await new Promise((resolve) => requestAnimationFrame(resolve));
    return performance.now() - start;
}

for (const polytope of ["8-cell", "600-cell"]) {
    test(`performance: the page shows a picture of the ${polytope} about as soon as it can`, async () => {
        const { page, script, press, close } = await openWithScript({ viewport: { width: 640, height: 400 } });
        const { revision } = await script.request({ type: "set", polytope });
        await presented(page, revision);
        const size = await page.evaluate(() => {
            const { clientWidth: width, clientHeight: height } = document.getElementById("drawing");
            return { width, height };
        });
        const alone = await joinSession((await common()).url); // a session without a page
        await alone.request({ type: "set", polytope });
        const [answers, drawings] = [[], []];
        for (let i = 0; i < kSamples; ++i) {
            await press("y");
            // The control measurement: the server makes such a picture, and the page draws one.
            const start = performance.now();
            await alone.request({ type: "key", key: "y" });
            await alone.request({ type: "get", what: "slices", ...size });
            answers.push(performance.now() - start);
            drawings.push(await page.evaluate(timeDrawing));
            await presented(page, (await stateAfter(page, script)).revision);
        }
        alone.leave();
        const latencies = await page.evaluate(() =>
            performance.getEntriesByName("oval4d key to picture").map(({ duration }) => duration),
        );
        assert.ok(latencies.length >= kSamples);
        const [latency, control] = [median(latencies), median(answers) + median(drawings)];
        const text = `${latency.toFixed(1)} ms, the control ${control.toFixed(1)} ms`;
        console.log(`    ${polytope}: ${text}`);
        assert.ok(latency < 2.5 * control, text);
        await close();
    });
}
