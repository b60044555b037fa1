"""Runs the checks of parts, runs once more what failed, and says which tests passed, failed or are unstable."""

import concurrent.futures
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

from results import Result

# If more tests than this are unstable, the whole run fails.
MOST_UNSTABLE = 2
# The most lines of the summary, the most lines of a message in it, and the most characters of a line. They are few,
# because a reader may see only the end of the output.
LINES_AT_THE_END = 60
LINES_OF_A_MESSAGE = 6
LENGTH_OF_A_LINE = 240


@dataclass
class Part:
    """A part of the tests. `checks` makes its checks; `presets` are the builds that they need. `budget` is the time in
    seconds that the part takes at most on two idle cores when everything is built and cached."""

    name: str
    budget: float
    checks: Callable
    presets: tuple = ()
    at_once: int = 1  # how many checks of the part run at the same time
    beside_previous: bool = False  # whether the part runs at the same time as the part before it


@dataclass
class Failure:
    """A test case that failed in the first run."""

    first: Result
    logs: list[Path]
    second: Result | None = None  # the result of the second run, alone; None before it

    @property
    def unstable(self):
        return self.second is not None and self.second.outcome == "passed"


@dataclass
class PartResults:
    """The results of the tests of a part."""

    part: Part
    seconds: float = 0
    passed: int = 0
    skipped: int = 0
    failures: list[Failure] = field(default_factory=list)


def run_part(part, folder, say):
    """Runs all checks of a part once. Returns its results, and the checks with failures: (check, failures)."""
    folder.mkdir(parents=True, exist_ok=True)
    found, again, start = PartResults(part), [], time.monotonic()

    def run(check):
        began = time.monotonic()
        results, log = check.run(folder)
        failed = [Failure(result, [log]) for result in results if result.outcome == "failed"]
        say(f"{part.name}: {check.name}: {f'{len(failed)} FAILED' if failed else 'passed'}, {time.monotonic() - began:.0f} s")
        return check, results, failed

    with concurrent.futures.ThreadPoolExecutor(part.at_once) as pool:
        for check, results, failed in pool.map(run, part.checks(folder)):
            found.passed += sum(result.outcome == "passed" for result in results)
            found.skipped += sum(result.outcome == "skipped" for result in results)
            found.failures += failed
            if failed:
                again.append((check, failed))
    found.seconds = time.monotonic() - start
    return found, again


def run_again(check, failed, folder, say):
    """Runs the failed tests of a check once more, with nothing beside them, and stores the results in `failed`."""
    results, log = check.run(folder, [failure.first for failure in failed])
    by_name = {result.name: result for result in results}
    whole = None if any(result.outcome == "failed" for result in results) else Result(check.name, "passed")
    for failure in failed:
        failure.second = by_name.get(failure.first.name, whole if failure.first.case is None else None)
        failure.logs.append(log)
        say(f"again: {failure.first.name}: {'passed this time' if failure.unstable else 'FAILED again'}")


def side_by_side(parts):
    """Returns lists of parts: the parts of each list run at the same time."""
    groups = []
    for part in parts:
        if part.beside_previous and groups:
            groups[-1].append(part)
        else:
            groups.append([part])
    return groups


def judge(parts, results_folder, say):
    """Runs the parts, and at the end once more the tests that failed. Returns the results of each part, and the seconds
    that the second runs took."""
    all_results, again = [], []
    for group in side_by_side(parts):
        with concurrent.futures.ThreadPoolExecutor(len(group)) as pool:
            for found, failed_checks in pool.map(lambda part: run_part(part, results_folder / part.name, say), group):
                all_results.append(found)
                again += [(check, failed, results_folder / found.part.name) for check, failed in failed_checks]
    start = time.monotonic()
    for check, failed, folder in again:
        run_again(check, failed, folder, say)
    return all_results, time.monotonic() - start


def verdict(all_results):
    """Returns the numbers of passed and failed tests, the unstable failures and the failed ones. Up to MOST_UNSTABLE
    unstable tests count as passed; more of them count as failed."""
    failures = [failure for found in all_results for failure in found.failures]
    unstable = [failure for failure in failures if failure.unstable]
    failed = [failure for failure in failures if not failure.unstable]
    passed = sum(found.passed for found in all_results)
    if len(unstable) <= MOST_UNSTABLE:
        return passed + len(unstable), len(failed), unstable, failed
    return passed, len(failures), unstable, failed


def table(all_results, other_seconds):
    """Returns the lines of the table: numbers of tests and the time of each part. `other_seconds` maps names of further
    rows, which have only a time, to seconds."""
    lines = [f"{'part':<12}{'passed':>8}{'unstable':>9}{'failed':>8}{'skipped':>9}{'time':>8}"]
    lines += [f"{name:<12}{'':>34}{seconds:>6.0f} s" for name, seconds in other_seconds.items()]
    for found in all_results:
        unstable = sum(failure.unstable for failure in found.failures)
        late = found.seconds > found.part.budget
        lines.append(f"{found.part.name:<12}{found.passed:>8}{unstable:>9}{len(found.failures) - unstable:>8}{found.skipped:>9}"
                     f"{found.seconds:>6.0f} s" + (f"  over its budget of {found.part.budget:.0f} s" if late else ""))
    return lines


def explain(failure, root, lines_of_message):
    """Returns the lines about a failure: its name, the message of its last run that failed, and the files of its logs."""
    last = failure.second if failure.second and not failure.unstable else failure.first
    message = [line for line in last.message.splitlines() if line.strip()]
    # The message of a test case begins with the fault. The message of a whole check is the end of its log.
    message = message[:lines_of_message] if last.case else message[-lines_of_message:]
    logs = " and ".join(str(log.relative_to(root) if log.is_relative_to(root) else log) for log in failure.logs)
    return ([f"  {failure.first.name}"[:LENGTH_OF_A_LINE]] +
            [f"      {line}"[:LENGTH_OF_A_LINE] for line in message] + [f"      {logs}"])


def summary(all_results, other_seconds, root, report):
    """Returns the last lines of output, at most LINES_AT_THE_END, and the exit status. If not all failures fit in, the
    rest is only in the file `report`, which has all of them with whole messages."""
    passed, count, unstable, failed = verdict(all_results)
    lines = [*table(all_results, other_seconds), ""]
    groups = [("FAILED", failed), ("unstable: failed, and passed when run again alone", unstable)]
    whole = [line for title, failures in groups if failures
             for line in [title, *(text for failure in failures for text in explain(failure, root, 10_000))]]
    report.write_text("\n".join([*lines, *whole, ""]), encoding="utf-8")
    room = LINES_AT_THE_END - len(lines) - len(groups) - 3
    for title, failures in groups:
        if failures:
            lines.append(f"{title}:")
        for k, failure in enumerate(failures):
            text = explain(failure, root, LINES_OF_A_MESSAGE)
            if len(text) > room:
                lines.append(f"  … and {len(failures) - k} more: see {report.relative_to(root)}")
                room = 0
                break
            lines += text
            room -= len(text)
    if len(unstable) > MOST_UNSTABLE:
        lines.append(f"{len(unstable)} tests are unstable; more than {MOST_UNSTABLE} are a failure")
    return [*lines, f"{passed} passed, {count} failed"], 1 if count else 0
