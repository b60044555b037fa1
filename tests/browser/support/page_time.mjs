// The time in the page. A test can stop it and let any number of milliseconds pass. What the page does after a delay
// then does not depend on how fast the machine is.

/**
 * Runs in the page before its scripts. Stops timers and clocks. Animation frames continue, but report the stopped time.
 */
export function stopTime() {
    const { setTimeout: later, clearTimeout: forget } = window;
    const ask = window.requestAnimationFrame.bind(window);
    const timers = new Map(); // by number: when a timer is due, what it runs, and how often
    let now = performance.now();
    let lastNumber = 2 ** 30; // the browser's own numbers are lower
    const start = (run, delay, interval) => {
        timers.set(++lastNumber, { due: now + delay, run, interval });
        return lastNumber;
    };
    window.setTimeout = (run, delay = 0, ...given) =>
        delay > 0 ? start(() => run(...given), delay) : later.call(window, run, 0, ...given);
    window.setInterval = (run, delay = 0, ...given) => start(() => run(...given), delay, Math.max(1, delay));
    window.clearTimeout = window.clearInterval = (number) => void (timers.delete(number) || forget.call(window, number));
    window.requestAnimationFrame = (run) => ask(() => run(now));
    performance.now = () => now;
    Object.defineProperty(Event.prototype, "timeStamp", { get: () => now });

    window.passTime = async (milliseconds) => {
        const end = now + milliseconds;
        for (;;) {
            const [next] = [...timers].sort(([, a], [, b]) => a.due - b.due);
            if (!next || next[1].due > end) break;
            const [number, timer] = next;
            now = Math.max(now, timer.due);
            if (timer.interval === undefined) timers.delete(number);
            else timer.due += timer.interval;
            timer.run();
            await new Promise((resolve) => later.call(window, resolve)); // what awaits the timer can continue
        }
        now = end;
    };
}

/** Lets time pass in a page whose time is stopped. */
export const passTime = (page, milliseconds) => page.evaluate((time) => window.passTime(time), milliseconds);
