const kTimeout = 30_000; // milliseconds, long enough for a busy machine

/** The promise's value; throws an error that names `what` if it takes too long. */
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
