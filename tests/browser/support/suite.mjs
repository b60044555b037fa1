// Collects the tests in the files that a process imports, and the functions that clean up after them.
import { within } from "./hang_limit.mjs";

/** Whether the tests run in Firefox instead of Chromium. */
export const inFirefox = process.env.OVAL4D_BROWSER === "firefox";

/**
 * What tests cannot do in Firefox under WebDriver BiDi. Maps what a test needs to the reason why it is skipped there.
 */
const kMissingInFirefox = {
    "repetition of a key whose character changes": "The driver says that a key repeats only if its character is the same.",
};

const tests = new Map(); // by name: {run, skipped}
const closings = { test: [], process: [] };

/**
 * Adds a test. Its name must be unique among all files, because it identifies the test in reports and in `--only`.
 * `needs` is a key of kMissingInFirefox; in Firefox, such a test is skipped.
 */
export function test(name, run, { needs } = {}) {
    if (tests.has(name)) throw new Error(`two tests are called “${name}”`);
    if (needs && !kMissingInFirefox[needs]) throw new Error(`“${name}” needs “${needs}”, which is not in the table`);
    tests.set(name, { run, skipped: inFirefox && needs ? kMissingInFirefox[needs] : undefined });
}

/**
 * The tests added since the last call, as pairs [name, {run, skipped}]. `skipped` is the reason why a test cannot run.
 */
export function takeTests() {
    const taken = [...tests];
    tests.clear();
    return taken;
}

/** The reason why no further test can pass in this process, such as a crashed browser. Undefined if tests can run. */
export let broken;

export function setBroken(reason) {
    broken ??= reason;
}

/** Registers a function that is called after all tests of this process. */
export function atEnd(close) {
    closings.process.push(close);
}

/** Registers a function that is called after the current test, even if the test fails. */
export function afterTest(close) {
    closings.test.push(close);
}

/** Calls the functions registered with afterTest() ("test") or atEnd() ("process"), the last registered first. */
export async function closeAll(after) {
    for (const close of closings[after].splice(0).reverse()) {
        await within(close(), "the end").catch((error) => console.error(error.message));
    }
}
