const kTimeout = 30_000; // milliseconds, long enough for a busy machine

/** Returns the promise's value; throws an error that names `what` if the promise is not resolved in time. */
export async function within(promise, what) {
    let timer;
    const late = new Promise((_, reject) => {
        timer = setTimeout(() => reject(new Error(`timed out waiting for ${what}`)), kTimeout);
    });
    try {
        return await Promise.race([promise, late]);
    } finally {
        clearTimeout(timer);
    }
}
