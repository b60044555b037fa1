"""The parts of the tests."""

import functools
import subprocess
import sys
from pathlib import Path

from checks import Check, GoogleTest, ListedTests, Pytest
from judgment import Part

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"

# The folders whose unit tests run with sanitizers. The service tests run the code of the other folders. With
# ThreadSanitizer, only code that uses threads runs, and only some service tests, because the others use the same
# threads in the same way.
SANITIZED_UNITS = {
    "asan-ubsan": ("fields", "file_reading", "geometry", "image", "parallel", "polytopes", "process", "raster", "render", "slicing"),
    "tsan": ("parallel", "polytopes", "raster", "store"),
}
SANITIZED_FILTERS = {("tsan", "polytopes"): "PolytopeCache*"}
SANITIZED_SERVICE = {
    "asan-ubsan": ("",),
    "tsan": ("conversation", "critical", "data_folder", "drafts", "drawing", "frames", "growing_fields", "hanging", "large_fields",
             "limits", "loaded_arrays", "pacing", "sessions", "store", "uploads"),
}


def program(name, preset="release"):
    return ROOT / "build" / preset / "bin" / name


def pytest(name, *arguments, preset="release", wrapper=(), variables=None):
    """Returns a check by pytest. `preset` names the build whose server the tests start."""
    command = [*wrapper, sys.executable, "-m", "pytest", "-q", "-o", "faulthandler_timeout=600", *arguments]
    return Pytest(name, command, {"OVAL4D": str(program("oval4d", preset))} | (variables or {}))


def page(name, *options):
    """Returns a check of the page in a browser."""
    return ListedTests(name, ["node", TESTS / "browser/run.mjs", *options], {"OVAL4D": str(program("oval4d"))})


def runner(_):
    return [pytest("runner", TESTS / "runner")]


def lint(_):
    return [ListedTests("lint", [TESTS / "lint"])]


LONGEST_UNITS = ("slicing", "export", "polytopes")  # these start first, so that no processor waits for them at the end


def unit(_):
    folders = [folder.name for folder in sorted((TESTS / "unit").iterdir()) if folder.is_dir()]
    return [GoogleTest(f"unit_{name}", [program(f"unit_{name}")])
            for name in [*LONGEST_UNITS, *(name for name in folders if name not in LONGEST_UNITS)]]


def corpus(_):
    return [GoogleTest("corpus", [program("corpus_tests")])]


def service(_):
    return [pytest("service", TESTS / "service", "--numprocesses=3")]


def attack(_):
    return [pytest("attack", TESTS / "attack", "--numprocesses=2")]


def failover(_):
    return [pytest("failover", TESTS / "failover")]


def browser(_):
    return [page("browser")]


def latencies(_):
    return [pytest("latencies", TESTS / "latencies"), page("page", "--latencies")]


def container(_):
    return [pytest("container", TESTS / "container")]


def firefox(_):
    return [page("firefox", "--firefox", "--processes", "2")]


def fuzz(folder):
    """Each fuzzer searches for 15 seconds, beginning with its corpus, to find faults of parsers soon; tests/fuzz/long
    searches for hours. Findings are left in the folder."""
    checks = []
    for source in sorted((TESTS / "fuzz").glob("*_fuzz.cpp")):
        subject = source.stem.removesuffix("_fuzz")
        found = folder / "corpus" / subject
        found.mkdir(parents=True, exist_ok=True)
        checks.append(Check(subject, [TESTS / "fuzz/one", subject, folder, "-max_total_time=15", found]))
    return checks


@functools.cache
def without_address_randomization():
    """Returns a command that runs another command without address space randomization, with which GCC 12's
    ThreadSanitizer fails on newer kernels; empty if this machine does not allow the command."""
    wrapper = ("setarch", "--addr-no-randomize")
    return wrapper if subprocess.run([*wrapper, "true"], check=False, stderr=subprocess.DEVNULL).returncode == 0 else ()


# Parts of messages with which LeakSanitizer reports that a thread has ended during its search for leaks.
OF_LEAK_SEARCH = ("Unable to get registers from thread", "Tracer caught signal 11",
                  "LeakSanitizer has encountered a fatal error", "HINT: For debugging, try setting environment variable LSAN",
                  "HINT: LeakSanitizer does not work under ptrace")


def sanitized(preset, folder):
    """Returns the checks of a build with sanitizers. The last one fails if any process has written a report."""
    reports = folder / f"{preset}.report"
    variables = {
        "LP_NUM_THREADS": "0",  # no threads in llvmpipe, which is not instrumented
        "LSAN_OPTIONS": f"suppressions={TESTS}/sanitizers/lsan.supp:print_suppressions=0",
        "ASAN_OPTIONS": f"detect_stack_use_after_return=1:log_path={reports}",
        "UBSAN_OPTIONS": f"print_stacktrace=1:log_path={reports}",
        "TSAN_OPTIONS": f"suppressions={TESTS}/sanitizers/tsan.supp:log_path={reports}",
    }
    wrapper = without_address_randomization()
    checks = []
    for unit_folder in SANITIZED_UNITS[preset]:
        command = [*wrapper, program(f"unit_{unit_folder}", preset)]
        chosen = SANITIZED_FILTERS.get((preset, unit_folder))
        checks.append(GoogleTest(f"{preset}-unit-{unit_folder}", command, variables | ({"GTEST_FILTER": chosen} if chosen else {})))
    files = [TESTS / "service" / (f"test_{subject}.py" if subject else "") for subject in SANITIZED_SERVICE[preset]]
    checks.append(pytest(f"{preset}-service", *files, "--numprocesses=2", preset=preset, wrapper=wrapper, variables=variables))
    # LeakSanitizer searches for leaks at the end of a process. If a thread ends during the search, LeakSanitizer may
    # report this, or fail to read the thread's memory. This is no fault of the process.
    script = f'! head -qn 50 "$0".* 2>/dev/null | grep -Ev "{"|".join(OF_LEAK_SEARCH)}"'
    checks.append(Check(f"{preset}-reports", ["bash", "-c", script, reports]))
    return checks


def sanitizers(folder):
    return [check for preset in SANITIZED_UNITS for check in sanitized(preset, folder)]


# The parts of the gate. They are deterministic and need one build. The numbers are budgets in seconds: see Part.
GATE = [
    Part("runner", 15, runner),
    Part("lint", 60, lint, ("release",)),
    Part("unit", 60, unit, ("release",), at_once=2),
    Part("corpus", 20, corpus, ("release",)),
    Part("service", 180, service, ("release",)),
    Part("attack", 180, attack, ("release",), beside_previous=True),  # mostly waits for time limits of the server
    Part("failover", 60, failover, ("release",), beside_previous=True),
    Part("browser", 220, browser, ("release",)),
]
# The further parts. They measure, search, or need other builds.
DEEP = [
    Part("latencies", 300, latencies, ("release",)),
    Part("container", 400, container, ("release",)),
    Part("firefox", 500, firefox, ("release",)),
    Part("fuzz", 120, fuzz, ("asan-ubsan",), at_once=2),
    Part("sanitizers", 1200, sanitizers, ("asan-ubsan", "tsan")),
]
