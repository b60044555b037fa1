"""The example scripts in protocol/python, run as they are."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from harness import DEADLINE

PYTHON = Path(__file__).resolve().parents[2] / "protocol/python"
sys.path.insert(0, str(PYTHON))
from oval4d_client import png_state  # noqa: E402


def test_the_example_writes_its_picture(server, tmp_path):
    script = (PYTHON / "example.py").read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, timeout=DEADLINE,
                   env=os.environ | {"PYTHONPATH": str(PYTHON)})
    picture = (tmp_path / "24-cell.png").read_bytes()
    assert png_state(picture)["polytope"]["name"] == "24-cell"
    assert png_state(picture)["revision"] == 6


@pytest.mark.parametrize("with_numpy", [True, False])
def test_the_example_prints_the_volumes_of_the_tiger(server, with_numpy):
    script = (PYTHON / "tiger.py").read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    if not with_numpy:
        script = "import sys; sys.modules['numpy'] = None\n" + script
    done = subprocess.run([sys.executable, "-c", script], check=True, timeout=DEADLINE, capture_output=True, text=True,
                          env=os.environ | {"PYTHONPATH": str(PYTHON)})
    *slices, summary = done.stdout.splitlines()
    assert len(slices) > 20 and all(re.fullmatch(r"w = +-?\d\.\d\d   volume \d+\.\d{3}", line) for line in slices)
    got, expected = map(float, re.findall(r"\d+\.\d+", summary))
    assert got == pytest.approx(expected, rel=0.05)


def run_example(server, name, folder, *arguments):
    script = (PYTHON / name).read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    return subprocess.run([sys.executable, "-c", script, *map(str, arguments)], cwd=folder, check=True, timeout=DEADLINE,
                          capture_output=True, text=True, env=os.environ | {"PYTHONPATH": os.pathsep.join(
                              filter(None, [str(PYTHON), os.environ.get("PYTHONPATH")]))})


def test_the_simulation_draws_its_moments(server, tmp_path):
    pytest.importorskip("numpy")
    done = run_example(server, "gray_scott.py", tmp_path, 4, 2)
    assert "moment 4 of 4" in done.stdout
    state = png_state((tmp_path / "gray_scott.png").read_bytes())
    assert (state["polytope"]["name"], state["levels"], state["revision"]) == ("Gray–Scott", [0.15], 6)


def test_the_flow_is_written_and_opened_again(server, tmp_path):
    pytest.importorskip("numpy")
    if importlib.util.find_spec("netCDF4") is None:
        pytest.importorskip("scipy.io")
    done = run_example(server, "ethier_steinman.py", tmp_path)
    state = png_state((tmp_path / "ethier_steinman.png").read_bytes())
    assert state["polytope"]["name"] == "Ethier–Steinman" and not done.stdout
