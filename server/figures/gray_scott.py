#!/usr/bin/python3
"""Writes all moments of the simulation in protocol/python/gray_scott.py as one array: gray_scott.py FILE.npy"""

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol" / "python"))
from gray_scott import MOMENTS, STEPS, simulate  # noqa: E402

numpy.save(sys.argv[1], numpy.stack(list(simulate(MOMENTS, STEPS))).astype("f4"))
