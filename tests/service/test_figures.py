"""The script that draws the pictures of the documentation, with a program that only notes how it is called."""

import re
import subprocess
from pathlib import Path

import pytest

FIGURES = Path(__file__).parents[2] / "server" / "figures"
NOTES = """#!/bin/sh
for one; do
    [ "$before" = -o ] && out=$one
    before=$one
done
printf '%s\\n' "$@" >"$out"
"""


def run_make(*arguments):
    return subprocess.run([FIGURES / "make", *arguments], capture_output=True, text=True)


@pytest.fixture(name="program")
def program_that_notes(tmp_path):
    program = tmp_path / "program"
    program.write_text(NOTES)
    program.chmod(0o755)
    return program


def test_every_picture_of_the_gallery_has_a_name():
    names = run_make("--list").stdout.split()
    assert len(names) == len(set(names))
    assert sorted(f"{name}.png" for name in names) == sorted(path.name for path in FIGURES.glob("*.png"))
    shown = re.findall(r"\]\(([^)/]+\.png)\)", (FIGURES / "README.md").read_text(encoding="utf-8"))
    assert sorted(shown) == sorted(f"{name}.png" for name in names)


def test_pictures_are_drawn_one_by_one(program, tmp_path):
    folder = tmp_path / "pictures"
    folder.mkdir()
    # The other figures are composed by Python from several pictures, or need an array that Python computes.
    names = [name for name in run_make("--list").stdout.split()
             if not re.match("figure|julia|gray-scott|ladder", name)]
    for some in [["tiger.png", "24-cell"], names]:
        done = run_make("--program", program, "--into", folder, *some)
        assert done.returncode == 0, done.stderr
        assert sorted(path.stem for path in folder.iterdir()) == sorted(name.removesuffix(".png") for name in some)
        for path in folder.iterdir():
            words = path.read_text(encoding="utf-8").splitlines()
            assert words[:3] == ["render", "-o", str(path)] and {"--polytope", "--formula"} & set(words), words
    words = (folder / "5-7-duoprism.png").read_text(encoding="utf-8").splitlines()
    assert words[words.index("--polytope") + 1] == "5,7-duoprism"


def test_unknown_pictures_are_refused(program, tmp_path):
    done = run_make("--program", program, "--into", tmp_path, "24-cell", "tigr")
    assert done.returncode == 1 and "no picture is called tigr; the names are figure-2" in done.stderr
    assert not (tmp_path / "24-cell.png").exists()
