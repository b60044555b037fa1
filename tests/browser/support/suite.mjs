// Collects the tests of the files that a process imports, and what is to be closed after them.
import { within } from "./hang_limit.mjs";

/** Whether the tests run in Firefox instead of Chromium. */
export const inFirefox = process.env.OVAL4D_BROWSER === "firefox";

/** What tests cannot do in Firefox, which WebDriver BiDi controls: by what a test needs, why it is skipped there. */
const kMissingInFirefox = {
    "repetition of a key whose character changes": "The driver says that a key repeats only if its character is the same.",
};

const tests = new Map(); // {run, skipped} by name
const closings = { test: [], process: [] };

/**
 * Adds a test. Its name is unique among all files, because it identifies the test in reports and in `--only`. What it
 * `needs` is a key of kMissingInFirefox.
 */
export function test(name, run, { needs } = {}) {
    if (tests.has(name)) throw new Error(`two tests are called “${name}”`);
    if (needs && !kMissingInFirefox[needs]) throw new Error(`“${name}” needs “${needs}”, which is not in the table`);
    tests.set(name, { run, skipped: inFirefox && needs ? kMissingInFirefox[needs] : undefined });
}

/** The tests that have been added since the last call, [name, {run, skipped}]; `skipped` says why a test cannot run. */
export function takeTests() {
    const taken = [...tests];
    tests.clear();
    return taken;
}

/** Why no further test can pass in this process, such as that its browser has crashed; undefined if they can. */
export let broken;

export function setBroken(reason) {
    broken ??= reason;
}

/** Registers a function that is called after all tests of this process. */
export function atEnd(close) {
    closings.process.push(close);
}

/** Registers a function that is called after the current test, whether it fails or not. */
export function afterTest(close) {
    closings.test.push(close);
}

/** Calls the functions registered with afterTest ("test") or atEnd ("process"), the last one first. */
export async function closeAll(after) {
    for (const close of closings[after].splice(0).reverse()) {
        await within(close(), "the end").catch((error) => console.error(error.message));
    }
}
