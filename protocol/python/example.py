#!/usr/bin/env python3
"""Rotates the 24-cell as figure 6 of Kageyama's paper rotates the 5-cell, and saves the picture as 24-cell.png."""
from math import pi, sqrt

from oval4d_client import connect

with connect("http://127.0.0.1:8080/") as oval:
    oval.hello()
    oval.set(polytope="24-cell")
    for _ in range(5):
        oval.rotate("xw,yz", pi / 8, pi / sqrt(3) - pi / 8)
    with open("24-cell.png", "wb") as file:
        file.write(oval.frame(1280, 720))
