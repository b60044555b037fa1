"""How a run judges its tests: with checks that fail once, always, or never."""

import os
import subprocess
import sys

import pytest
from checks import Check, GoogleTest, ListedTests, Pytest, end_group
from judgment import LINES_AT_THE_END, Part, judge, summary

# A test file for pytest. Its tests test_once[k] fail only in the first run; its tests test_always[k] fail in every run.
TESTS = """
import pathlib
import pytest

FOLDER = pathlib.Path(__file__).parent

FAIL_ONCE, FAIL_ALWAYS = {once}, {always}

@pytest.mark.parametrize("case", range(FAIL_ONCE))
def test_once(case):
    flag = FOLDER / f"ran-{case}"
    if not flag.exists():
        flag.touch()
        assert False, f"the first run of {case}"

@pytest.mark.parametrize("case", range(FAIL_ALWAYS))
def test_always(case):
    assert False, f"never works: {case}"

def test_never():
    with (FOLDER / "runs-of-test-never").open("a") as runs:
        runs.write("x")
"""


def check_with(folder, once, always):
    """Returns a check of pytest with this number of tests that fail once, and that fail always; one more passes."""
    folder.mkdir()
    file = folder / "test_them.py"
    file.write_text(TESTS.replace("{once}, {always}", f"{once}, {always}"), encoding="utf-8")
    return Pytest("them", [sys.executable, "-m", "pytest", "-q", file])


def run(tmp_path, *checks, budget=1000.0):
    """Runs the checks as one part. Returns the last lines of output, and the exit status."""
    part = Part("part", budget, lambda _: checks)
    results, _ = judge([part], tmp_path / "results", lambda _: None)
    return summary(results, {"builds": 1}, tmp_path, tmp_path / "report.txt")


def row(lines):
    """Returns the numbers of passed, unstable and failed tests in the part's row of the table. pytest reports a test
    without cases as skipped."""
    return [int(word) for word in next(line for line in lines if line.startswith("part  ") and "passed" not in line).split()[1:4]]


def test_a_run_in_which_everything_passes_succeeds(tmp_path):
    lines, status = run(tmp_path, check_with(tmp_path / "tests", once=0, always=0))
    assert (status, lines[-1]) == (0, "1 passed, 0 failed")
    assert not any("unstable:" in line or "FAILED" in line for line in lines)


def test_a_test_that_fails_once_is_unstable_and_the_run_succeeds(tmp_path):
    lines, status = run(tmp_path, check_with(tmp_path / "tests", once=1, always=0))
    assert (status, lines[-1]) == (0, "2 passed, 0 failed")
    assert row(lines) == [1, 1, 0]
    start = next(k for k, line in enumerate(lines) if line.startswith("unstable:"))
    assert "test_once[0]" in lines[start + 1]
    assert any("the first run of 0" in line for line in lines[start:])
    logs = [tmp_path / word for line in lines for word in line.split() if word.endswith(".log")]
    assert len(logs) == 2 and "the first run of 0" in logs[0].read_text() and "1 passed" in logs[1].read_text()
    assert (tmp_path / "tests/runs-of-test-never").read_text() == "x", "only what failed is run again"


def test_a_test_that_fails_twice_has_failed(tmp_path):
    lines, status = run(tmp_path, check_with(tmp_path / "tests", once=1, always=1))
    assert (status, lines[-1]) == (1, "2 passed, 1 failed")
    assert row(lines) == [1, 1, 1]
    start = lines.index("FAILED:")
    assert "test_always[0]" in lines[start + 1]
    assert any("never works: 0" in line for line in lines[start:])


def test_two_unstable_tests_are_reported_and_three_are_a_failure(tmp_path):
    for count in (2, 3):
        folder = tmp_path / str(count)
        folder.mkdir()
        lines, status = run(folder, check_with(folder / "tests", once=count, always=0))
        assert row(lines) == [1, count, 0]
        assert (status, lines[-1]) == ((0, "3 passed, 0 failed") if count == 2 else (1, "1 passed, 3 failed"))


def test_unstable_tests_of_all_checks_count_together(tmp_path):
    checks = [check_with(tmp_path / name, once=1, always=0) for name in ("first", "second", "third")]
    for check, name in zip(checks, ("first", "second", "third")):
        check.name = name
    lines, status = run(tmp_path, *checks)
    assert (status, lines[-1]) == (1, "3 passed, 3 failed")


def test_the_end_shows_failures_and_table_within_its_lines(tmp_path):
    lines, status = run(tmp_path, check_with(tmp_path / "tests", once=2, always=60))
    assert status == 1 and len(lines) <= LINES_AT_THE_END
    assert lines[-1] == "3 passed, 60 failed"
    assert any("more: see report.txt" in line for line in lines)
    report = (tmp_path / "report.txt").read_text()
    assert all(f"never works: {case}\n" in report for case in range(60))


def test_parts_can_run_side_by_side(tmp_path):
    """Each of the two parts waits for what the other one does."""
    os.mkfifo(tmp_path / "there")
    os.mkfifo(tmp_path / "back")

    def in_folder(script):
        return Check("waiting", ["env", "-C", tmp_path, "bash", "-c", script])

    first = Part("first", 1000, lambda _: [in_folder("echo > there; read < back")])
    second = Part("second", 1000, lambda _: [in_folder("read < there; echo > back")], beside_previous=True)
    results, _ = judge([first, second], tmp_path / "results", lambda _: None)
    assert [(found.part.name, found.passed) for found in results] == [("first", 1), ("second", 1)]


def test_a_part_over_its_budget_is_named_and_does_not_fail(tmp_path):
    lines, status = run(tmp_path, Check("slow", ["sleep", "0.01"]), budget=0)
    assert status == 0
    assert any("over its budget of 0 s" in line for line in lines)


@pytest.mark.parametrize("script, words", [
    ("echo before; exit 3", ("exit status 3", "before")),
    ("kill -SEGV $$", ("ended by SIGSEGV",)),
])
def test_a_check_without_test_cases_fails_as_a_whole(tmp_path, script, words):
    lines, status = run(tmp_path, Check("script", ["bash", "-c", script]))
    assert (status, lines[-1]) == (1, "0 passed, 1 failed")
    assert all(any(word in line for line in lines) for word in words)


def test_a_check_that_hangs_fails(tmp_path):
    lines, status = run(tmp_path, Check("hanging", ["sleep", "infinity"], limit=0.1))
    assert (status, lines[-1]) == (1, "0 passed, 1 failed")
    assert any("did not end in time" in line for line in lines)


def test_a_check_ends_with_all_its_processes(tmp_path):
    """The child process ignores SIGTERM, and holds the writing end of a pipe: reading ends when it has ended."""
    script = 'bash -c "trap : TERM; echo ready; while :; do sleep 1; done" & wait'
    process = subprocess.Popen(["bash", "-c", script], stdout=subprocess.PIPE, start_new_session=True)
    assert process.stdout.readline() == b"ready\n"
    end_group(process)
    assert process.stdout.read() == b""
    process.stdout.close()


def test_a_command_that_cannot_be_started_fails(tmp_path):
    lines, status = run(tmp_path, Check("absent", [tmp_path / "absent"]))
    assert status == 1 and any("cannot be started" in line for line in lines)


def test_a_crash_between_tests_is_a_failure_even_if_the_report_has_none(tmp_path):
    report = '<testsuites><testsuite><testcase classname="a" name="b"/></testsuite></testsuites>'
    script = f"for word; do [[ $word == --gtest_output=xml:* ]] && echo '{report}' > \"${{word#*:}}\"; done; exit 1"
    lines, status = run(tmp_path, GoogleTest("program", ["bash", "-c", script, "program"]))
    assert (status, lines[-1]) == (1, "1 passed, 1 failed")


# A program with the options of GoogleTest. Its test "Suite.fails-once" fails in the first run.
PROGRAM = r"""
import pathlib, sys
options = dict(word[2:].split("=", 1) for word in sys.argv[1:] if "=" in word)
flag = pathlib.Path(__file__).with_name("ran")
chosen = options.get("gtest_filter", "*")
names = ["fails-once", "passes"] if chosen == "*" else ["fails-once"] if chosen == "Suite.fails?once" else []
def case(name):
    fails = name == "fails-once" and not flag.exists()
    return f'<testcase classname="Suite" name="{name}">' + ("<failure message='not yet'/>" if fails else "") + "</testcase>"
text = "".join(map(case, names))
pathlib.Path(options["gtest_output"][4:]).write_text(f"<testsuites>{text}</testsuites>")
flag.touch()
sys.exit("failure" in text)
"""


def test_only_the_failed_tests_of_a_google_test_program_are_run_again(tmp_path):
    (tmp_path / "program.py").write_text(PROGRAM, encoding="utf-8")
    lines, status = run(tmp_path, GoogleTest("program", [sys.executable, tmp_path / "program.py"]))
    assert (status, lines[-1], row(lines)) == (0, "2 passed, 0 failed", [1, 1, 0])


def test_names_with_blanks_are_listed_for_the_second_run(tmp_path):
    script = """
while [[ $1 ]]; do [[ $1 == --junit ]] && report=$2; [[ $1 == --only ]] && only=$2; shift 2; done
if [[ ! $only ]]; then
    echo '<t><testcase classname="c" name="a &amp; b"><failure message="m"/></testcase></t>' > "$report"; exit 1
fi
[[ $(cat "$only") == "a & b" ]] && echo '<t><testcase classname="c" name="a &amp; b"/></t>' > "$report"
"""
    lines, status = run(tmp_path, ListedTests("listed", ["bash", "-c", script, "listed"]))
    assert (status, lines[-1], row(lines)) == (0, "1 passed, 0 failed", [0, 1, 0])
