"""Which commands get the options of sanitizers: those of their own build, and no others."""

import os

import pytest
from checks import Check
from judgment import Part, judge
from parts import DEEP, GATE, SANITIZED_UNITS

OPTIONS = {"ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"}


@pytest.mark.parametrize("part", GATE + DEEP, ids=lambda part: part.name)
def test_only_commands_of_builds_with_sanitizers_get_their_options(part, tmp_path):
    before = dict(os.environ)
    checks = part.checks(tmp_path)
    assert dict(os.environ) == before
    assert checks
    for check in checks:
        if part.name != "sanitizers":
            assert not OPTIONS & check.variables.keys(), check.name
            continue
        preset = next(preset for preset in SANITIZED_UNITS if check.name.startswith(f"{preset}-"))
        other = next(other for other in SANITIZED_UNITS if other != preset)
        words = " ".join(map(str, [*check.command, *check.variables.values()]))
        assert f"/{preset}.report" in words, "the reports of a build have files of their own"
        assert f"/{other}.report" not in words and f"/{other}/" not in words
        assert check.variables.keys() >= OPTIONS or check.name == f"{preset}-reports"


def test_the_variables_of_a_command_reach_no_command_beside_or_after_it(tmp_path):
    given = {name: "log_path=/nowhere" for name in OPTIONS}
    script = 'env > "$0"; until [ -e "$1" ] || [ -z "$1" ]; do sleep 0.01; done'
    first = Check("first", ["bash", "-c", script, tmp_path / "first", tmp_path / "beside"], given)
    beside = Check("beside", ["bash", "-c", script, tmp_path / "beside", ""])
    after = Check("after", ["bash", "-c", script, tmp_path / "after", ""])
    parts = [Part("part", 1000, lambda _: [first, beside], at_once=2), Part("next", 1000, lambda _: [after])]
    judge(parts, tmp_path / "results", lambda _: None)
    found = {name: {line.partition("=")[0] for line in (tmp_path / name).read_text(encoding="utf-8").splitlines()} & OPTIONS
             for name in ("first", "beside", "after")}
    inherited = OPTIONS & os.environ.keys()
    assert found == {"first": OPTIONS, "beside": inherited, "after": inherited}
