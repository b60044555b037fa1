"""Checks: commands that run tests. A check can run all of its tests, or once more only those that failed."""

import os
import signal
import subprocess
import time
from dataclasses import dataclass, field

from results import Result, read_junit

# After this time, a check counts as hanging and is ended. Single tests have their own limit, in
# tests/hang_limit_seconds.
LIMIT_SECONDS = 1800
LINES_OF_LOG = 25  # so many last lines of the log explain a failure without a test case


@dataclass
class Check:
    """A command that succeeds or fails as a whole. Derived classes run programs that report single test cases in a
    JUnit file."""

    name: str
    command: list
    variables: dict = field(default_factory=dict)  # environment variables for this command only
    limit: float = LIMIT_SECONDS

    def options(self, report, failed):
        """Returns options to add to the command, with which it writes the JUnit file `report`. `failed` are the results
        of the tests that have failed in the first run and are run again; None in the first run."""
        del report, failed
        return []

    def run(self, folder, failed=None):
        """Runs the command with its output in a log file in the folder. Returns the results and the path of the log."""
        stem = self.name if failed is None else f"{self.name}.again"
        report, log = folder / f"{stem}.xml", folder / f"{stem}.log"
        if failed is not None and not all(result.case for result in failed):
            failed = None  # the check failed as a whole, so all of it runs again
        status = execute([*self.command, *self.options(report, failed)], log, self.variables, self.limit)
        results = read_junit(report, f"{self.name}: ") or []
        if status != 0 and not any(result.outcome == "failed" for result in results):
            results.append(Result(self.name, "failed", f"{in_words(status)}\n{end_of(log)}"))
        return results or [Result(self.name, "passed")], log


class GoogleTest(Check):
    """A program of GoogleTest."""

    def options(self, report, failed):
        again = [] if failed is None else ["--gtest_filter=" + ":".join(map(self.pattern, failed))]
        return ["--gtest_brief=1", f"--gtest_output=xml:{report}", *again]

    @staticmethod
    def pattern(result):
        """Returns a filter that matches the test case. It has "?" for "-", because a "-" would begin the patterns to
        exclude."""
        return ".".join(result.case).replace("-", "?")


class Pytest(Check):
    """Files of pytest. In the second run, pytest itself knows what failed in the first one."""

    def options(self, report, failed):
        again = [] if failed is None else ["--last-failed", "--last-failed-no-failures=none", "--numprocesses=0"]
        return ["-o", f"cache_dir={report.parent / self.name}.cache", f"--junitxml={report}", *again]


class ListedTests(Check):
    """A command with the options `--junit FILE`, and `--only FILE` with the names of the test cases to run, one a line."""

    def options(self, report, failed):
        if failed is None:
            return ["--junit", report]
        only = report.with_suffix(".only")
        only.write_text("".join(f"{result.case[1]}\n" for result in failed), encoding="utf-8")
        return ["--junit", report, "--only", only]


running = set()  # the leading processes of the process groups of running checks


def execute(command, log, variables, limit):
    """Runs a command in a process group of its own, which ends with it. Returns its exit status, or "hung" if it does
    not end within `limit` seconds."""
    with log.open("wb") as output:
        try:
            process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=subprocess.STDOUT, env=os.environ | variables, start_new_session=True)
        except OSError as error:
            output.write(f"cannot be started: {error}\n".encode())
            return 127
    running.add(process)
    try:
        return process.wait(limit)
    except subprocess.TimeoutExpired:
        return "hung"
    finally:
        end_group(process)
        running.discard(process)


def end_group(process):
    """Ends all processes of the group, and waits until its leader has ended."""
    try:
        os.killpg(process.pid, signal.SIGTERM)
        limit = time.monotonic() + 5
        while process.poll() is None and time.monotonic() < limit:
            time.sleep(0.05)
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


def end_all():
    """Ends all checks that run now."""
    for process in list(running):
        end_group(process)


def in_words(status):
    """Says how a command that failed has ended, given what execute() returned."""
    if status == "hung":
        return "did not end in time"
    return f"ended by {signal.Signals(-status).name}" if status < 0 else f"exit status {status}"


def end_of(log):
    """Returns the last lines of a log."""
    return "\n".join(log.read_text(encoding="utf-8", errors="replace").splitlines()[-LINES_OF_LOG:])
