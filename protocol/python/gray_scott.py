#!/usr/bin/env python3
"""Simulates a reaction of two substances in a cube (Gray and Scott, 1984), and shows the reaction while it runs: each
new moment is added to a field at the end of its axis w. Takes a minute or two. Open the printed address to watch. Needs
python3-numpy."""
import sys

import numpy
from oval4d_client import connect

URL = "http://127.0.0.1:8080/"
SIZE, MOMENTS, STEPS = 64, 100, 40  # samples along each axis; number of moments; time steps between two
DIFFUSION_U, DIFFUSION_V, FEED, KILL = 0.16, 0.08, 0.035, 0.060


def laplacian(values):
    """Returns for each sample the sum of its six neighbors minus six times its value. The samples on opposite sides of
    the cube are neighbors."""
    return sum(numpy.roll(values, step, axis) for axis in range(3) for step in (1, -1)) - 6 * values


def step(u, v):
    reaction = u * v * v
    return (u + DIFFUSION_U * laplacian(u) - reaction + FEED * (1 - u),
            v + DIFFUSION_V * laplacian(v) + reaction - (FEED + KILL) * v)


def initial_substances(random):
    u, v = numpy.ones((SIZE,) * 3, "f4"), numpy.zeros((SIZE,) * 3, "f4")
    for corner in random.integers(SIZE // 4, SIZE // 2, (4, 3)):
        part = tuple(slice(low, low + SIZE // 8) for low in corner)
        u[part], v[part] = 0.5, 0.25
    return u, v


def simulate(moments, steps):
    """Yields for each moment the array of the amounts of the second substance."""
    substances = initial_substances(numpy.random.default_rng(4))
    yield substances[1]
    for _ in range(1, moments):
        for _ in range(steps):
            substances = step(*substances)
        yield substances[1]


def main():
    moments, steps = (int(word) for word in sys.argv[1:3]) if len(sys.argv) > 2 else (MOMENTS, STEPS)
    with connect(URL) as oval:
        welcome = oval.hello()
        print(f"{URL}#session={welcome['session']}&token={welcome['token']}")
        for moment, values in enumerate(simulate(moments, steps)):
            if moment == 0:
                oval.field("Gray–Scott", values[None], levels=[0.15])
                oval.rotate("xw", 0.4)
            else:
                oval.append("Gray–Scott", values)
            print(f"\rmoment {moment + 1} of {moments}", end="", flush=True)
        print()
        with open("gray_scott.png", "wb") as picture:
            picture.write(oval.frame(1280, 720))


if __name__ == "__main__":
    main()
