// Collects the tests of the files that a process imports, and what is to be closed after them.
import { within } from "./hang_limit.mjs";

const tests = new Map(); // functions by name
const closings = { test: [], process: [] };

/** Adds a test. Its name is unique among all files, because it identifies the test in reports and in `--only`. */
export function test(name, run) {
    if (tests.has(name)) throw new Error(`two tests are called “${name}”`);
    tests.set(name, run);
}

/** The tests that have been added since the last call. */
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
