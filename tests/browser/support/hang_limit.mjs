// The only time limit of the tests. What takes longer counts as hanging. No test depends on how fast the machine is.
import { readFileSync } from "node:fs";

/** The time limit in milliseconds. Tests in all languages read the same file. */
export const kHangLimit = 1000 * Number(readFileSync(new URL("../../hang_limit_seconds", import.meta.url), "utf8"));

/**
 * Resolves to the promise's value. Throws an error that names `what` if the promise takes longer than the time limit.
 */
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

/**
 * Calls `find` repeatedly until it returns something true, and resolves to this. `what` names it in the error message.
 */
export async function eventually(find, what) {
    const deadline = Date.now() + kHangLimit;
    for (;;) {
        const found = await find();
        if (found) return found;
        if (Date.now() > deadline) throw new Error(`hung while waiting for ${what}`);
    }
}
