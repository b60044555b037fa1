"""Compares ways to use several cores: bench_drawing in one or two processes, with and without llvmpipe's threads."""

import json
import os
import statistics
import subprocess

# The ways of drawing, by name: the number of processes, drawing threads per process, 1 if separate threads encode, and
# LP_NUM_THREADS (None if unset).
WAYS = {
    "one, threads unset": (1, 1, 0, None), "one, 0 threads": (1, 1, 0, 0), "one, 1 thread": (1, 1, 0, 1),
    "one, 2 threads": (1, 1, 0, 2),
    "one, threads unset, encoding beside": (1, 1, 1, None), "one, 0 threads, encoding beside": (1, 1, 1, 0),
    "two contexts, threads unset": (1, 2, 0, None), "two contexts, 0 threads": (1, 2, 0, 0),
    "two processes, threads unset": (2, 1, 0, None), "two processes, 0 threads": (2, 1, 0, 0),
}
TURNS = 5
SECONDS = 0.4


def run(program, polytope, processes, drawers, encoders, threads):
    """Returns the pictures per second of all processes together, and the median milliseconds per picture."""
    environment = {name: value for name, value in os.environ.items() if name != "LP_NUM_THREADS"}
    if threads is not None:
        environment["LP_NUM_THREADS"] = str(threads)
    words = [program, polytope, str(drawers), str(encoders), str(SECONDS)]
    running = [subprocess.Popen(words, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
               for _ in range(processes)]
    for process in running:
        process.stdout.readline()  # waits until the process has warmed up
    for process in running:
        process.stdin.write("\n")
        process.stdin.flush()
    said = [json.loads(process.communicate()[0]) for process in running]
    return sum(each["rate"] for each in said), statistics.median(each["median"] for each in said)


def rows(program, polytope):
    """Returns a row for each entry of WAYS: name, pictures per second, this rate relative to that of the first entry,
    milliseconds per picture."""
    turns = [{name: run(program, polytope, *way) for name, way in WAYS.items()} for _ in range(TURNS)]
    first = next(iter(WAYS))
    return [[name, statistics.median(turn[name][0] for turn in turns),
             statistics.median(turn[name][0] / turn[first][0] for turn in turns),
             statistics.median(turn[name][1] for turn in turns)] for name in WAYS]
