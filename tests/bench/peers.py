"""Runs the programs that oval4d is compared with, one in Python with VTK and one in JavaScript. Times are in ms."""

import json
import os
import shutil
import subprocess
from pathlib import Path

FOLDER = Path(os.environ.get("OVAL4D_PEERS", ""))
NAMES = {"5-cell": "5cell", "8-cell": "tesseract", "120-cell": "120cell", "600-cell": "600cell"}
VTK = {
    "peeling": ["--glyph", "mesh", "--bars", "glyph", "--blend", "peel"],
    "fastest": ["--glyph", "impostor", "--bars", "stick", "--blend", "sorted"],
}


def why_no_vtk():
    """Returns why VTK cannot run here, None if it can."""
    if not (FOLDER / "vtk_oval.py").exists():
        return "vtk_oval.py is not in $OVAL4D_PEERS"
    if not shutil.which("xvfb-run"):
        return "xvfb-run is missing (Debian: xvfb, xauth, python3-vtk9, python3-numpy)"
    if subprocess.run(["/usr/bin/python3", "-c", "import vtk, numpy"], capture_output=True, check=False).returncode:
        return "python3-vtk9 or python3-numpy is missing"
    return None


def why_no_js():
    """Returns why the JavaScript program cannot run here, None if it can."""
    if not (FOLDER / "js_slice.mjs").exists():
        return "js_slice.mjs is not in $OVAL4D_PEERS"
    return None if shutil.which("node") else "node is missing"


def vtk(polytope, way, frames=11):
    """Returns the milliseconds per frame of 21 slices at 1280 × 720: rotate, cut, draw, read back, encode as PNG."""
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x720x24", "/usr/bin/python3", str(FOLDER / "vtk_oval.py"),
               "--poly", NAMES[polytope], "--slices", "21", "--frames", str(frames), *VTK[way]]
    done = subprocess.run(command, capture_output=True, text=True, check=True,
                          env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})
    return json.loads(done.stdout.splitlines()[-1])["total1"]


def why_no_fields():
    """Returns why fields cannot be compared with scipy and VTK here, None if they can."""
    if not (FOLDER / "vtk_field.py").exists():
        return "vtk_field.py is not in $OVAL4D_PEERS"
    if subprocess.run(["/usr/bin/python3", "-c", "import scipy.ndimage"], capture_output=True, check=False).returncode:
        return "python3-scipy is missing; where it conflicts with other packages, name its folder in PYTHONPATH"
    return why_no_vtk()


def vtk_field(field, frames=5):
    """Returns the milliseconds per frame of 21 slices of a field of 64⁴ samples, each resampled on 64³ points."""
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x720x24", "/usr/bin/python3", str(FOLDER / "vtk_field.py"),
               "--field", field, "--frames", str(frames)]
    done = subprocess.run(command, capture_output=True, text=True, check=True,
                          env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})
    return json.loads(done.stdout.splitlines()[-1])


def js():
    """Returns for each polytope: the times of slicing by 21 hyperplanes and of JSON.stringify, the bytes of JSON, and
    the number of elements cut."""
    done = subprocess.run(["node", str(FOLDER / "js_slice.mjs")], capture_output=True, text=True, check=True)
    runs = [json.loads(line) for line in done.stdout.splitlines()]
    ours = {theirs: name for name, theirs in NAMES.items()}
    return {ours[run["poly"]]: run for run in runs if run["slices"] == 21}
