// All tests run in one suite, one after the other, and what they opened is closed at its end, however they ended.
import { after, describe, it } from "node:test";

const kLongest = 90_000; // milliseconds a test

const tests = [];
const closings = [];

export function test(name, run) {
    tests.push([name, run]);
}

/** Has `close` called at the end. */
export function atEnd(close) {
    closings.push(close);
}

export function runAll(name) {
    describe(name, () => {
        for (const [title, run] of tests) it(title, { timeout: kLongest }, run);
        after(async () => {
            for (const close of closings.reverse()) await close();
        });
    });
}
