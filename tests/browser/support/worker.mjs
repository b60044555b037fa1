// A process that runs tests one after another. run.mjs sends it the files, and the names of tests to run or to skip. It
// answers with {started} and {finished} for each test, with {finished, skipped} for a test that is not run in this
// browser, and with {done} at the end. If no further test can pass, it answers with {broken}.
import { broken, closeAll, takeTests } from "./suite.mjs";

let strayErrors = []; // errors of promises that nothing awaits

for (const event of ["uncaughtException", "unhandledRejection"]) process.on(event, (error) => strayErrors.push(error));
process.on("disconnect", () => process.exit(1)); // run.mjs has ended

const report = (message) => new Promise((resolve) => process.send(message, resolve));
const messageOf = (error) => error?.stack ?? String(error);

async function runTest(name, run) {
    await report({ started: name });
    const start = performance.now();
    const errors = [];
    try {
        await run();
    } catch (error) {
        errors.push(error);
    }
    await closeAll("test");
    await new Promise(setImmediate); // by now, Node.js has reported such errors
    errors.push(...strayErrors.splice(0));
    const failure = errors.map(messageOf).join("\n\n");
    await report({ finished: name, seconds: (performance.now() - start) / 1000, ...(failure && { failure }) });
}

async function run({ files, only, skip = [] }) {
    for (const file of files) {
        const name = `${file}: the file is imported`;
        const start = import(new URL(`../${file}`, import.meta.url));
        const failure = await start.then(() => undefined, messageOf);
        if (failure !== undefined || only?.includes(name)) await report({ finished: name, seconds: 0, failure });
    }
    for (const [name, { run, skipped }] of takeTests()) {
        if (broken !== undefined) return report({ broken }); // another process runs the rest
        if (!(only?.includes(name) ?? true) || skip.includes(name)) continue;
        if (skipped !== undefined) await report({ finished: name, seconds: 0, skipped });
        else await runTest(name, run);
    }
    await report({ done: true });
}

process.on("message", async (message) => {
    if (!message.end) return run(message);
    await closeAll("process");
    return process.exit(0);
});
