// Runs test files in several processes, each with its own server and browser. A process that has finished a file gets
// the next one. If a process crashes or hangs, its current test counts as failed, and another process runs the rest.
import { fork } from "node:child_process";
import { fileURLToPath } from "node:url";

import { kHangLimit } from "./hang_limit.mjs";

const kWorker = fileURLToPath(new URL("worker.mjs", import.meta.url));
const kWaitsOfTest = 20; // the most waits in a test; each of them ends after kHangLimit

/** The names of the tests that are running at present. */
export const runningTests = new Set();

/**
 * Runs jobs, given as {files, only}, and resolves when all are done. Calls `finished` with {name, file, seconds,
 * failure, skipped} for each test. `file` is undefined for a job of several files; `skipped` is the reason why a test
 * was not run.
 */
export async function runJobs(jobs, { processes, finished }) {
    const waiting = [...jobs];
    await Promise.all(Array.from({ length: Math.min(processes, jobs.length) }, () => work(waiting, finished)));
}

/** Runs jobs in one process, until no job waits. After a crash, starts another process. */
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

/** Runs one job. Resolves to whether the process has crashed, and to the rest of the job in that case. */
function runJob(worker, job, finished) {
    const file = job.files.length === 1 ? job.files[0] : undefined;
    const done = [...(job.skip ?? [])];
    let running; // the name of the running test
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
    const child = fork(kWorker, { detached: true }); // leads a process group, which its servers join
    let [received, crashed] = [() => {}, () => {}];
    let killed; // why the process was killed; undefined if it was not
    const kill = () => {
        try {
            process.kill(-child.pid, "SIGKILL");
        } catch {
            // No process of the group is left.
        }
    };
    child.on("message", (message) => received(message));
    const ended = new Promise((resolve) => {
        child.on("exit", (code, signal) => {
            kill(); // also ends the process's servers, if any are left
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
