// Runs test files in several processes, each with a server and a browser of its own. A process that has run a file gets
// the next one. What a process was doing when it crashed or hung counts as failed, and another process does the rest.
import { fork } from "node:child_process";
import { fileURLToPath } from "node:url";

import { kHangLimit } from "./hang_limit.mjs";

const kWorker = fileURLToPath(new URL("worker.mjs", import.meta.url));
const kWaitsOfTest = 20; // the most waits that a test chains; each of them ends after kHangLimit

/** The names of the tests that are running now. */
export const runningTests = new Set();

/**
 * Runs jobs, {files, only}, and resolves when all are done. `finished` is called with {name, file, seconds, failure,
 * skipped} for each test, where `file` is undefined for a job of several files, and `skipped` says why a test was not run.
 */
export async function runJobs(jobs, { processes, finished }) {
    const waiting = [...jobs];
    await Promise.all(Array.from({ length: Math.min(processes, jobs.length) }, () => work(waiting, finished)));
}

/** Runs jobs in one process, and in further ones after crashes, until no job waits. */
async function work(waiting, finished) {
    let worker;
    for (let job = waiting.shift(); job; ) {
        worker ??= startWorker();
        const { isCrashed, rest } = await runJob(worker, job, finished);
        if (isCrashed) worker = undefined;
        job = rest ?? waiting.shift();
    }
    await worker?.end();
}

/** Runs a job. Resolves to whether the process has crashed, and what is left of the job then. */
function runJob(worker, job, finished) {
    const file = job.files.length === 1 ? job.files[0] : undefined;
    const done = [...(job.skip ?? [])];
    let running; // the name of a test
    let hanging;
    return new Promise((resolve) => {
        const watch = () => {
            clearTimeout(hanging);
            hanging = setTimeout(() => worker.kill("it hung"), kWaitsOfTest * kHangLimit);
        };
        const received = (message) => {
            watch();
            runningTests.delete(running);
            running = message.started;
            if (running !== undefined) runningTests.add(running);
            if (message.finished) {
                const { finished: name, seconds, failure, skipped } = message;
                done.push(name);
                finished({ name, file, seconds, failure, skipped });
            } else if (message.done) {
                clearTimeout(hanging);
                resolve({ isCrashed: false });
            } else if (message.broken) {
                clearTimeout(hanging);
                console.log(`another process continues: ${message.broken}`);
                resolve({ isCrashed: true, rest: { ...job, skip: done } });
                void worker.end();
            }
        };
        const crashed = (reason) => {
            clearTimeout(hanging);
            runningTests.delete(running);
            const failure = `the process of the tests ended: ${reason}`;
            finished({ name: running ?? `${job.files.join(", ")}: the file is run`, file, seconds: 0, failure });
            resolve({ isCrashed: true, rest: running && { ...job, skip: [...done, running] } });
        };
        worker.listen(received, crashed);
        worker.send(job);
        watch();
    });
}

function startWorker() {
    const child = fork(kWorker, { detached: true }); // a group of processes, with its servers
    let [received, crashed] = [() => {}, () => {}];
    let killed; // why the process was killed; undefined if it was not
    const kill = () => {
        try {
            process.kill(-child.pid, "SIGKILL");
        } catch {
            // Nothing of the group is left.
        }
    };
    child.on("message", (message) => received(message));
    const ended = new Promise((resolve) => {
        child.on("exit", (code, signal) => {
            kill(); // its servers, if it has left any
            crashed(killed ?? `exit status ${code ?? signal}`);
            resolve();
        });
    });
    return {
        listen: (onMessage, onCrash) => void ([received, crashed] = [onMessage, onCrash]),
        send: (message) => child.send(message),
        kill(reason) {
            killed = reason;
            kill();
        },
        async end() {
            crashed = () => {};
            child.send({ end: true });
            const hanging = setTimeout(kill, kHangLimit);
            await ended;
            clearTimeout(hanging);
        },
    };
}
