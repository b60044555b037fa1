// Runs the browser tests: `node run.mjs [options] [FILE.mjs …]`. Without files, runs all files that the options allow:
//   --latencies    runs only the tests that measure speed
//   --firefox      runs the tests in Firefox instead of Chromium
//   --only FILE    runs only the tests whose names are the lines of FILE, one after another in one process
//   --junit FILE   writes the results as JUnit XML
//   --processes N  runs N files at the same time
//   --slowdown N   slows the pages down N times, to find tests that depend on speed
// OVAL4D names the server's binary, OVAL4D_WEB_ROOT the built page, OVAL4D_CHROMIUM and OVAL4D_FIREFOX the browsers.
import { readdirSync, readFileSync } from "node:fs";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";

import { bundleClient } from "./support/bundle_client.mjs";
import { writeJunit } from "./support/junit.mjs";
import { runJobs, runningTests } from "./support/pool.mjs";

const kLatencies = "performance.mjs";
const kLongest = ["fields.mjs", "picture.mjs", "axe.mjs", "field_panel.mjs", "slider.mjs", "accessibility.mjs"]; // these begin

const here = dirname(fileURLToPath(import.meta.url));
const { values: options, positionals } = parseArgs({
    options: {
        latencies: { type: "boolean" },
        firefox: { type: "boolean" },
        only: { type: "string" },
        junit: { type: "string" },
        processes: { type: "string", default: "3" },
        slowdown: { type: "string" },
    },
    allowPositionals: true,
});

function chosenFiles() {
    if (positionals.length > 0) return positionals.map((path) => path.split("/").at(-1));
    if (options.latencies) return [kLatencies];
    const all = readdirSync(here).filter((name) => name.endsWith(".mjs") && !["run.mjs", kLatencies].includes(name));
    return all.sort((a, b) => kLongest.includes(b) - kLongest.includes(a));
}

const results = [];

function finished(result) {
    const { name, seconds, failure, skipped } = result;
    results.push(result);
    if (skipped !== undefined) console.log(`skipped  ${name}: ${skipped}`);
    else if (failure === undefined) console.log(`ok ${seconds.toFixed(1)} s  ${name}`);
    else console.log(`FAILED ${seconds.toFixed(1)} s  ${name}\n${failure.replace(/^/gm, "    ")}`);
}

function finish() {
    if (options.junit) writeJunit(options.junit, results);
    const failed = results.filter(({ failure }) => failure !== undefined);
    const skipped = results.filter((one) => one.skipped !== undefined);
    const passed = results.length - failed.length - skipped.length;
    console.log(`${passed} passed, ${failed.length} failed, ${skipped.length} skipped`);
    for (const { name } of failed) console.log(`  ${name}`);
    process.exit(failed.length === 0 && results.length > 0 ? 0 : 1);
}

for (const signal of ["SIGINT", "SIGTERM"]) {
    process.on(signal, () => {
        const names = [...runningTests, "the run is completed"];
        for (const name of names) finished({ name, seconds: 0, failure: `interrupted by ${signal}` });
        finish(); // the test processes end with this process
    });
}

bundleClient();
if (options.firefox) process.env.OVAL4D_BROWSER = "firefox";
if (options.slowdown) process.env.OVAL4D_SLOWDOWN = options.slowdown;
const files = chosenFiles();
if (options.only) {
    const only = readFileSync(options.only, "utf8").split(/\r?\n/).filter((line) => line !== "");
    await runJobs([{ files, only }], { processes: 1, finished });
    for (const name of only.filter((one) => !results.some((result) => result.name === one))) {
        finished({ name, seconds: 0, failure: "no test has this name" });
    }
} else {
    // Several files at the same time would disturb the tests that measure speed.
    const processes = options.latencies ? 1 : Number(options.processes);
    await runJobs(files.map((file) => ({ files: [file] })), { processes, finished });
}
const names = results.map(({ name }) => name);
for (const name of new Set(names.filter((one, i) => names.indexOf(one) !== i))) {
    finished({ name: `${name} (again)`, seconds: 0, failure: "two tests have this name" });
}
finish();
