// The only time limit of the tests: what has not happened after it counts as hanging. No test depends on how fast the
// machine is below this limit.
import { readFileSync } from "node:fs";

/** In milliseconds. The tests in every language read the same file. */
export const kHangLimit = 1000 * Number(readFileSync(new URL("../../hang_limit_seconds", import.meta.url), "utf8"));

/** Returns the promise's value; throws an error that names `what` if the promise hangs. */
export async function within(promise, what) {
    let timer;
    const late = new Promise((_, reject) => {
        timer = setTimeout(() => reject(new Error(`hung while waiting for ${what}`)), kHangLimit);
    });
    try {
        return await Promise.race([promise, late]);
    } finally {
        clearTimeout(timer);
    }
}

/** Calls `find` again and again until it returns something true, and returns that; `what` names it in the error. */
export async function eventually(find, what) {
    const deadline = Date.now() + kHangLimit;
    for (;;) {
        const found = await find();
        if (found) return found;
        if (Date.now() > deadline) throw new Error(`hung while waiting for ${what}`);
    }
}
