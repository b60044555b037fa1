"""Loading of files: what is read, repaired and refused; a load does not delay other clients."""

import asyncio
import itertools
import math
import random

import pytest
from harness import Server
from wire import Client, Refused


def point_lines(points):
    return "".join(" ".join(f"{x:.12g}" for x in point) + "\n" for point in points)


def tesseract_vertices():
    return [point for point in itertools.product((-1, 1), repeat=4)]


def tesseract_file(edges=32):
    """Returns a tesseract as 4OFF; a 2-face consists of the four vertices that share two coordinates."""
    points = tesseract_vertices()
    faces, faces_of = [], {}
    for fixed in itertools.combinations(range(4), 2):
        for values in itertools.product((-1, 1), repeat=2):
            corners = [i for i, p in enumerate(points) if all(p[a] == v for a, v in zip(fixed, values))]
            faces_of[frozenset(zip(fixed, values))] = len(faces)
            faces.append([corners[0], corners[1], corners[3], corners[2]])
    cells = [[n for fixed, n in faces_of.items() if (axis, value) in fixed] for axis in range(4) for value in (-1, 1)]
    records = "".join(f"{len(r)} {' '.join(map(str, r))}\n" for r in faces + cells)
    return f"4OFF\n16 {len(faces)} {edges} {len(cells)}\n" + point_lines(points) + records


async def element_counts(client):
    polytope = (await client.request("get", what="state"))["polytope"]
    return [polytope[part] for part in ("vertices", "edges", "faces", "cells")]


async def load_file(client, format_, data, name="mine"):
    return await client.request("load", name=name, format=format_, data=data)


async def load_refusal(client, format_, data):
    with pytest.raises(Refused) as caught:
        await load_file(client, format_, data)
    return caught.value


async def test_a_valid_file_loads_without_warnings(server):
    async with Client(server) as client:
        done = await load_file(client, "off", tesseract_file())
        assert "warnings" not in done
        assert await element_counts(client) == [16, 32, 24, 8]


async def test_repairs_are_reported_as_warnings(server):
    async with Client(server) as client:
        done = await load_file(client, "off", tesseract_file(edges=7))
        assert done["warnings"] == ["the file states 7 edges, but its 2-faces have 32"]
        stray = tesseract_file().replace("16 24", "17 24").replace("\n4 0", "\n9 9 9 9\n4 0", 1)
        assert (await load_file(client, "off", stray))["warnings"] == ["1 vertex lies on no 2-face and was left out"]
        assert await element_counts(client) == [16, 32, 24, 8]


async def test_points_are_replaced_by_their_convex_hull(server):
    rng = random.Random(1)
    async with Client(server) as client:
        inside = [[rng.uniform(-0.9, 0.9) for _ in range(4)] for _ in range(20)]
        points = tesseract_vertices() + inside
        rng.shuffle(points)
        done = await load_file(client, "points", "x,y,z,w\n" + point_lines(points).replace(" ", ","))
        assert done["warnings"] == ["20 of 36 points are not hull vertices and were left out"]
        assert await element_counts(client) == [16, 32, 24, 8]


async def test_the_convex_hull_is_independent_of_position_and_scale(server):
    cell24 = [[x, y, z, w] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) for w in (-1, 0, 1)
              if x * x + y * y + z * z + w * w == 2]
    async with Client(server) as client:
        for by in (0, 10, -100000):
            for size in (1, 1e-9, 0.5, 1e4):
                points = [[size * (x + by), *(size * c for c in rest)] for x, *rest in cell24]
                assert "warnings" not in await load_file(client, "points", point_lines(points))
                assert await element_counts(client) == [24, 96, 96, 24]


@pytest.mark.parametrize("format_, data, expected_text", [
    ("off", "4OFF\n3 1 3\n", "line 2: the file has three counts, as in Geomview's 4OFF"),
    ("off", tesseract_file().replace("-1 -1 -1 1\n", "-1 -1 -1 nan\n", 1), "line 4: 'nan' is not a finite number"),
    ("off", tesseract_file().replace("-1 -1 -1 1\n", "-1 -1 -1 1.2\n", 1), "is not flat"),
    ("off", tesseract_file().rsplit("\n", 2)[0] + "\n", "the file ends before cell 7 of 8"),
    ("off", "\n".join(line for line in tesseract_file().splitlines() if line) + "\n4 0 1 2 3", "follows the last cell"),
    ("points", "1 2 3 4\n1 2 3\n", "line 2: a point has 3 coordinates"),
    ("points", point_lines(p[:3] + (0,) for p in tesseract_vertices()), "all points lie in one hyperplane"),
    ("points", "1 2 3 4\n", "at least 5 points"),
], ids=["counts of Geomview", "NaN", "nonplanar face", "truncated", "data after the end", "three coordinates",
        "one hyperplane", "too few points"])
async def test_invalid_files_are_refused_and_change_nothing(server, format_, data, expected_text):
    async with Client(server) as client:
        await client.request("set", polytope="24-cell")
        error = await load_refusal(client, format_, data)
        assert error.code == "bad_polytope" and expected_text in error.text
        assert await element_counts(client) == [24, 96, 96, 24]


async def test_an_invalid_cell_is_reported_with_its_line(server):
    text = tesseract_file().rstrip("\n").split("\n")
    last = text[-1].split()
    text[-1] = " ".join(["5", *last[1:6]])  # a cube without one of its squares
    async with Client(server) as client:
        error = await load_refusal(client, "off", "\n".join(text) + "\n")
        assert f"line {len(text)}: cell 7 is not closed" in error.text or "does not lie in two cells" in error.text
        assert "line " in error.text


def moment_curve_points(count):
    angles = [2 * math.pi * i / count for i in range(count)]
    return point_lines((math.cos(t), math.sin(t), math.cos(2 * t), math.sin(2 * t)) for t in angles)


async def test_the_size_of_the_convex_hull_is_limited():
    with Server("--max-hull-cells", 800) as server:
        async with Client(server) as client:
            await load_file(client, "points", moment_curve_points(40))  # 40 · 37 / 2 cells
            assert await element_counts(client) == [40, 780, 1480, 740]
            error = await load_refusal(client, "points", moment_curve_points(50))
            assert error.code == "too_large" and "more than 800 cells" in error.text
    with Server("--max-vertices", 30) as server:
        async with Client(server) as client:
            assert (await load_refusal(client, "points", moment_curve_points(31))).code == "too_large"


async def test_a_load_does_not_delay_other_clients():
    """While a convex hull is computed for one client, another client's keys are answered."""
    with Server("--max-hull-cells", 10**9, "--stop-timeout", 0.5) as server:
        async with Client(server) as busy, Client(server) as other:
            await busy.send("load", id=500, name="mine", format="points", data=moment_curve_points(2000))
            for _ in range(10):
                await other.request("key", key="y")
            assert not busy.answer_to(500)  # the hull has two million cells
            await asyncio.to_thread(server.stop)  # the server would not read the client's close during the load


async def test_messages_wait_for_the_load_before_them(server):
    async with Client(server) as client:
        await client.send("load", id=500, name="mine", format="points", data=moment_curve_points(250))
        state = await client.request("get", what="state")
        assert state["polytope"]["name"] == "mine" and client.answer_to(500)["type"] == "done"
