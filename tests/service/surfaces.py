"""Loads fields; the surfaces of their slices, and what mathematics says about them."""

import contextlib
import math
import random
from types import SimpleNamespace

import numpy
from meshes import assert_manifold, volume
from wire import Client


@contextlib.asynccontextmanager
async def field_client(server, formula, box=None, **hello):
    """Opens a session that shows the field of a formula."""
    async with Client(server, **hello) as client:
        await load_field(client, formula, box)
        yield client


async def load_field(client, formula, box=None, name="field", **members):
    domain = {"box": box} if box else {}
    return await client.request("load", name=name, format="formula", data=formula, **domain, **members)


def random_rotation(seed):
    """Returns the rows of a random 4×4 rotation matrix: normal deviates, made orthonormal with determinant 1."""
    source = random.Random(seed)
    deviates = [[source.gauss(0, 1) for _ in range(4)] for _ in range(4)]
    columns, triangle = numpy.linalg.qr(numpy.transpose(deviates))
    rows = (columns * numpy.sign(numpy.diag(triangle))).T
    if numpy.linalg.det(rows) < 0:
        rows[0] = -rows[0]
    return rows.tolist()


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def closed_parts(surface, level=0, caps=True):
    """Returns the triangles of one level after asserting that they form closed, consistently oriented surfaces.
    `caps` tells whether a cap may be among them."""
    chosen = [t for t, (own, cap) in enumerate(zip(surface["level"], surface["cap"])) if own == level]
    assert caps or not any(surface["cap"][t] for t in chosen)
    triangles = [surface["triangles"][t] for t in chosen]
    if triangles:
        assert_manifold(triangles)
    return triangles


def surface_volume(piece, level=0, caps=True):
    """Returns the volume of a slice's body at a level, 0 for a slice without a surface; asserts a closed surface."""
    surface = piece.get("surface")
    return volume(surface["points"], closed_parts(surface, level, caps)) if surface else 0


def surface_centroid(surface):
    """Returns the centroid of the body of level 0, as the weighted mean of tetrahedra with a corner at the origin."""
    corners = numpy.asarray(surface["points"])[numpy.asarray(closed_parts(surface))]
    volumes = numpy.linalg.det(corners) / 6
    return list(volumes @ corners.sum(axis=1) / 4 / volumes.sum())


def components_and_euler(surface):
    """Returns the number of connected surfaces, and the sum of their Euler characteristics (2 − 2 genus each)."""
    triangles = closed_parts(surface)
    parent = {p: p for triangle in triangles for p in triangle}

    def root(p):
        while parent[p] != p:
            parent[p] = parent[parent[p]]
            p = parent[p]
        return p

    for a, b, c in triangles:
        parent[root(a)] = parent[root(b)] = root(c)
    return len({root(p) for p in parent}), len(parent) - len(triangles) // 2


def lattice_step(message):
    """Returns the side of a lattice cube: 48 cubes span the diameter of the field's domain."""
    return 2 * message["scene"]["circumradius"] / 48


def ellipsoid_slice(axes, center, orientation, w):
    """Returns the volume and the centroid of the slice at `w` of an ellipsoid with these semi-axes and this center,
    after the rotation; None if the hyperplane misses it. `scale` is the size of the slice relative to the parallel
    slice through the center."""
    rotated = [dot(row, center) for row in orientation]
    spread = [[dot([a * a * p for a, p in zip(axes, row)], other) for other in orientation] for row in orientation]
    height = math.sqrt(spread[3][3])
    part = (w - rotated[3]) / height
    if abs(part) >= 1:
        return None
    return SimpleNamespace(
        volume=4 / 3 * math.pi * math.prod(axes) / height * (1 - part * part) ** 1.5,
        centroid=[rotated[i] + (w - rotated[3]) * spread[i][3] / spread[3][3] for i in range(3)],
        scale=math.sqrt(1 - part * part))


def tiger_slice(a, b, r, w, steps=4000):
    """Returns the volume of the slice of a tiger that is not rotated, (√(x²+y²) − a)² + (√(z²+w²) − b)² < r²: by
    Pappus's theorem, the integral of 2πa times the width of the ring at each z."""
    def width(z):
        return 2 * math.sqrt(max(0, r * r - (math.hypot(z, w) - b) ** 2))
    end = b + r
    return 2 * math.pi * a * sum(width(-end + (i + 0.5) * 2 * end / steps) for i in range(steps)) * 2 * end / steps
