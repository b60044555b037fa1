#!/usr/bin/env python3
"""Turns a tiger, which is a tube around the product of two circles, and prints the volume of each slice that is not
empty."""
from math import pi

from oval4d_client import connect

A, B, TUBE = 1, 0.8, 0.3  # the radii of the circles and of the tube


def volume(surface):
    """Returns the volume inside a closed surface of triangles: the sum of the signed volumes of the tetrahedra between
    the triangles and the origin."""
    points, total = surface["points"], 0
    for a, b, c in surface["triangles"]:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = points[a], points[b], points[c]
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


with connect("http://127.0.0.1:8080/") as oval:
    oval.hello()
    oval.formula(f"(sqrt(x^2+y^2)-a)^2 + (sqrt(z^2+w^2)-b)^2 < c^2; a={A}, b={B}, c={TUBE}", name="tiger",
                 box=[(-1.4, 1.4), (-1.4, 1.4), (-1.2, 1.2), (-1.2, 1.2)])
    oval.set(slices={"count": 61, "spacing": 0.06})
    oval.rotate("xw,yz", pi / 5, pi / 7)
    whole = 0
    for piece in oval.slices()["slices"]:
        if "surface" in piece:
            part = volume(piece["surface"])
            whole += 0.06 * part
            print(f"w = {piece['w']:5.2f}   volume {part:.3f}")
    print(f"The slices add up to {whole:.2f}; the tiger has the volume {4 * pi**3 * A * B * TUBE**2:.2f}.")
