"""Builds what the tests need and runs them: see tests/run, which installs the packages and then starts this program."""

import os
import signal
import subprocess
import sys
import time

from checks import Check, end_all
from judgment import judge, summary
from parts import DEEP, GATE, ROOT, SANITIZED_UNITS

RESULTS = ROOT / "build/results"
NAMES = [part.name for part in GATE + DEEP]
BROWSER_PARTS = {"browser", "latencies", "firefox"}
BUILD_LIMIT = 3600


def say(text):
    print(f"oval4d: {text}", file=sys.stderr, flush=True)


def chosen(names):
    """Returns the parts with these names: the gate if there are none, everything for "all"."""
    unknown = [name for name in names if name not in [*NAMES, "all"]]
    if unknown:
        sys.exit(f"oval4d: unknown part '{unknown[0]}'; the parts are: {' '.join(NAMES)}, and all")
    if "all" in names:
        return GATE + DEEP
    return [part for part in GATE + DEEP if part.name in names] if names else GATE


def prepare(function):
    """Runs a function of server/prepare.sh with its arguments. Returns whether it succeeds."""
    script = f'root={ROOT}; source "$root/server/prepare.sh"; {function}'
    return subprocess.run(["bash", "-c", script], cwd=ROOT, check=False, timeout=BUILD_LIMIT).returncode == 0


def targets(preset, wanted):
    """Returns the targets that the wanted parts need from a build."""
    if preset == "release":
        return ["oval4d", "unit_tests", "corpus_tests"]
    sanitizers = ["oval4d", *(f"unit_{folder}" for folder in SANITIZED_UNITS[preset])]
    return (sanitizers if "sanitizers" in wanted else []) + (["fuzz"] if preset == "asan-ubsan" and "fuzz" in wanted else [])


def build(parts):
    """Installs npm packages and makes all builds that the parts need. Returns the logs of the builds that failed, by
    name."""
    wanted = {part.name for part in parts}
    failed = {}
    if not (prepare("install_npm tests") and prepare("build_web_client") and
            (not wanted & BROWSER_PARTS or prepare("install_npm tests/browser"))):
        failed["npm"] = ROOT / "build/log/web_client.log"
    for preset in dict.fromkeys(preset for part in parts for preset in part.presets):
        made = " ".join(targets(preset, wanted))
        command = (f"configure release -DOVAL4D_TESTS=ON -DOVAL4D_BENCHMARKS=ON && compile release {made}" if preset == "release"
                   else f"build_sanitized {preset} {made}")
        if not prepare(command):
            failed[preset] = ROOT / f"build/log/compile-{preset}.log"
    return failed


def with_build_failures(part, failed):
    """Returns the part. If a build that it needs has failed, replaces its checks by one that fails and shows the end of
    the build's log."""
    logs = [log for name, log in failed.items() if name == "npm" or name in part.presets]
    if logs:
        script = 'tail -n 15 "$@"; echo "$0 cannot run, because the build has failed: see $*"; exit 1'
        part.checks = lambda _: [Check("build", ["bash", "-c", script, part.name, *logs])]
    return part


def git(*arguments):
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def record(parts):
    """Writes what has passed to the file `passed`: the commit, whether the tree was clean, and the parts."""
    changes = git("status", "--porcelain")
    tree = "unknown" if changes is None else "clean" if not changes else "changed"
    (RESULTS / "passed").write_text(f"commit {git('rev-parse', 'HEAD') or 'unknown'}\ntree {tree}\n"
                                    f"parts {' '.join(part.name for part in parts)}\n", encoding="utf-8")


def main(names):
    parts = chosen(names)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: (end_all(), os._exit(130)))
    is_gate = all(part in parts for part in GATE)
    for name in [*(part.name for part in parts), *(["passed"] if is_gate else [])]:
        subprocess.run(["rm", "-rf", RESULTS / name], check=True)
    RESULTS.mkdir(parents=True, exist_ok=True)
    began = time.time()
    started = float(os.environ.get("OVAL4D_TESTS_STARTED", began))
    failed = build(parts)
    built = time.time()
    results, again_seconds = judge([with_build_failures(part, failed) for part in parts], RESULTS, say)
    seconds = {"packages": began - started, "builds": built - began} | ({"again": again_seconds} if again_seconds > 1 else {})
    lines, status = summary(results, seconds, ROOT, RESULTS / "report.txt")
    print("\n" + "\n".join(lines), flush=True)
    if status == 0 and is_gate:
        record(parts)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
