// Runs all tests in one suite, one after the other. Functions registered with atEnd run at the end, even if tests fail.
import { after, describe, it } from "node:test";

const kTimeout = 90_000; // milliseconds per test

const tests = [];
const closings = [];

export function test(name, run) {
    tests.push([name, run]);
}

/** Registers a function that is called after all tests. */
export function atEnd(close) {
    closings.push(close);
}

export function runAll(name) {
    describe(name, () => {
        for (const [title, run] of tests) it(title, { timeout: kTimeout }, run);
        after(async () => {
            for (const close of closings.reverse()) await close();
        });
    });
}
