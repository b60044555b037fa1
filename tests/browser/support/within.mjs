const kPatience = 30_000; // milliseconds: how long a condition may take to come true on a busy machine

/** The promise's value, or an error that says what was waited for. */
export async function within(promise, what) {
    let timer;
    const late = new Promise((_, reject) => {
        timer = setTimeout(() => reject(new Error(`waited in vain for ${what}`)), kPatience);
    });
    try {
        return await Promise.race([promise, late]);
    } finally {
        clearTimeout(timer);
    }
}
