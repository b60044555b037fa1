"""Loading of files: what is read, repaired and refused; a load does not delay other clients."""

import asyncio
import csv
import io
import itertools
import math
import random
from pathlib import Path

import meshes
import pytest
from harness import Server, run_oval4d
from wire import Client, Refused

WILD = Path(__file__).parents[1] / "wild"
SIZE = {"width": 640, "height": 360}


def point_lines(points):
    return "".join(" ".join(f"{x:.12g}" for x in point) + "\n" for point in points)


def tesseract_vertices():
    return [point for point in itertools.product((-1, 1), repeat=4)]


def tesseract_file(edges=32, move=None):
    """Returns a tesseract as 4OFF; a 2-face consists of the four vertices that share two coordinates. `move` maps each
    coordinate to that in the file."""
    points = tesseract_vertices()
    faces, faces_of = [], {}
    for fixed in itertools.combinations(range(4), 2):
        for values in itertools.product((-1, 1), repeat=2):
            corners = [i for i, p in enumerate(points) if all(p[a] == v for a, v in zip(fixed, values))]
            faces_of[frozenset(zip(fixed, values))] = len(faces)
            faces.append([corners[0], corners[1], corners[3], corners[2]])
    cells = [[n for fixed, n in faces_of.items() if (axis, value) in fixed] for axis in range(4) for value in (-1, 1)]
    records = "".join(f"{len(r)} {' '.join(map(str, r))}\n" for r in faces + cells)
    lines = point_lines(points) if move is None else "".join(f"{' '.join(repr(move(x)) for x in p)}\n" for p in points)
    return f"4OFF\n16 {len(faces)} {edges} {len(cells)}\n" + lines + records


async def element_counts(client):
    polytope = (await client.request("get", what="state"))["polytope"]
    return [polytope[part] for part in ("vertices", "edges", "faces", "cells")]


async def load_file(client, format_, data, name="mine"):
    return await client.request("load", name=name, format=format_, data=data)


async def get_file(client, **members):
    """Returns the bytes of an exported file, which arrives right before `done`."""
    done = await client.request("get", what="file", **members)
    return client.messages[client.messages.index(done) - 1]


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
                done = await load_file(client, "points", point_lines(points))
                assert all("far from the origin" in warning for warning in done.get("warnings", []))
                assert await element_counts(client) == [24, 96, 96, 24]


@pytest.mark.parametrize("format_, data, expected_text", [
    ("off", "4OFF\n3 1 3\n", "line 2: the file is too short for its numbers of vertices, 2-faces and cells"),
    ("off", tesseract_file().replace("-1 -1 -1 1\n", "-1 -1 -1 nan\n", 1), "line 4: 'nan' is not a finite number"),
    ("off", tesseract_file().replace("-1 -1 -1 1\n", "-1 -1 -1 1.2\n", 1), "is not flat"),
    ("off", tesseract_file().rsplit("\n", 2)[0] + "\n", "the file ends before cell 7 of 8"),
    ("off", "\n".join(line for line in tesseract_file().splitlines() if line) + "\n4 0 1 2 3", "follows the last cell"),
    ("points", "1 2 3 4\n1 2 3\n", "line 2: a point has 3 coordinates"),
    ("points", point_lines(p[:3] + (0,) for p in tesseract_vertices()), "all points lie in one hyperplane"),
    ("points", "1 2 3 4\n", "at least 5 points"),
], ids=["only counts", "NaN", "nonplanar face", "truncated", "data after the end", "three coordinates",
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
    text[-1] = " ".join(["5", *last[1:6]])  # a cube that lacks one of its squares
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
            await load_file(client, "points", moment_curve_points(40))  # a hull of 40 · 37 / 2 cells
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
            await asyncio.to_thread(server.stop)  # during the load, the server would not notice that the client closes


async def test_messages_wait_for_the_load_before_them(server):
    async with Client(server) as client:
        await client.send("load", id=500, name="mine", format="points", data=moment_curve_points(250))
        state = await client.request("get", what="state")
        assert state["polytope"]["name"] == "mine" and client.answer_to(500)["type"] == "done"


def cross_vertices(center):
    """Returns the vertices of a 16-cell of circumradius 1."""
    return [[c + sign * (i == axis) for i, c in enumerate(center)] for axis in range(4) for sign in (1, -1)]


async def shape_of_slices(client):
    """Returns the numbers of elements of all slices, the spacing, and the triangles of the focus slice as STL."""
    slices = (await client.request("get", what="slices", **SIZE))["slices"]
    counts = [[len(one[part]) for part in ("vertices", "edges", "faces")] for one in slices]
    spacing = (await client.request("get", what="state"))["slices"]["spacing"]
    return counts, spacing, (await get_file(client, format="stl"))[80:]


@pytest.mark.parametrize("center", [[10, 10, 0, 0], [5e6, 0, 0, -5e6], [0, 0, 123.5, 0]], ids=str)
async def test_an_object_far_away_is_seen_like_one_at_the_origin(server, center):
    async with Client(server, stream="none") as client:
        assert "warnings" not in await load_file(client, "points", point_lines(cross_vertices([0, 0, 0, 0])))
        near = await shape_of_slices(client)
        assert sum(counts[2] > 0 for counts in near[0]) == 19
        done = await load_file(client, "points", point_lines(cross_vertices(center)))
        assert len(done["warnings"]) == 1 and "far from the origin" in done["warnings"][0]
        assert await shape_of_slices(client) == near


async def test_what_is_told_of_an_object_is_in_the_coordinates_of_its_file(server):
    center = [5e6, 0, 0, -5e6]
    async with Client(server, stream="none") as client:
        await load_file(client, "points", point_lines(cross_vertices(center)))
        await client.request("rotate", planes=["xy"], angles=[0.3])
        state = await client.request("get", what="state")
        assert state["polytope"]["center"] == center
        assert state["point"] == [5e6, 0, 0, -5e6] and state["section"]["w"] == -5e6
        assert state["slices"]["offset"] == 0
        slices = await client.request("get", what="slices", **SIZE)
        assert next(one["label"] for one in slices["slices"] if one["focus"]).startswith("w = −5000000.00")

        # Vertex 6 is (0, 0, 0, 1) relative to the center. Its lines are at this place in the parallel coordinates.
        layout = slices["scene"]["coordinates"]
        x = layout["left"] + 6 * layout["column_step"] + 1.5 * layout["line_step"]
        at = await client.request("get", what="at", x=x * 360, y=(1 - layout["zero"]) * 360, **SIZE)
        assert at["highlight"] == {"element": "vertex", "number": 6}
        assert at["place"] == at["coordinates"] == [5e6, 0, 0, -4999999] and at["least_w"] == at["most_w"] == -4999999

        critical = await client.request("get", what="critical")
        assert [section["w"] for section in critical["sections"]] == [-5000001, -5e6, -4999999]
        await client.request("set", slices={"w": -4999999.5})
        row = next(csv.DictReader(io.StringIO((await get_file(client, format="csv")).decode())))
        assert float(row["w"]) == -4999999.5
        assert float(row["centroid_x"]) == pytest.approx(5e6, abs=1e-6)
        exported = (await get_file(client, format="off")).decode()
        assert "0 0 -4999999\n" in exported
        done = await load_file(client, "off", exported, "again")
        assert len(done["warnings"]) == 1
        assert (await client.request("get", what="state"))["polytope"]["center"] == pytest.approx(center)

        before = await client.request("get", what="state")
        await client.request("set", **{name: value for name, value in before.items() if name not in ("type", "id")})
        after = await client.request("get", what="state")
        assert {**after, "id": 0, "revision": 0} == {**before, "id": 0, "revision": 0}


async def test_a_load_may_choose_the_center(server):
    async with Client(server, stream="none") as client:
        async def center_of(points, center):
            done = await client.request("load", name="mine", format="points", data=point_lines(points), center=center)
            assert "warnings" not in done
            return (await client.request("get", what="state"))["polytope"].get("center")

        far, near = cross_vertices([10, 10, 0, 0]), cross_vertices([0.5, 0, 0, 0])
        assert await center_of(far, "origin") is None
        assert await center_of(far, [9, 9, 0, 1]) == [9, 9, 0, 1]
        assert await center_of(near, "object") == [0.5, 0, 0, 0]
        await client.request("undo")
        assert (await client.request("get", what="state"))["polytope"]["center"] == [9, 9, 0, 1]
        with pytest.raises(Refused, match="/center must be"):
            await center_of(near, "middle")
        with pytest.raises(Refused, match="only polytopes, surfaces and points take a center"):
            await client.request("load", name="f", format="formula", data="x", center="origin")


def test_the_command_line_may_choose_the_center(tmp_path):
    path = tmp_path / "far.txt"
    path.write_text(point_lines(cross_vertices([5e6, 5e6, 0, 0])))
    done = run_oval4d("export", "--load", path, "--format", "stl", "-o", "-")
    assert done.returncode == 0 and b"far from the origin" in done.stderr
    done = run_oval4d("export", "--load", path, "--center", "origin", "--format", "stl", "-o", "-")
    assert done.returncode != 0 and b"too small in comparison with its distance from the origin" in done.stderr
    done = run_oval4d("export", "--load", path, "--center", "5e6,5e6,0,0", "--format", "stl", "-o", "-")
    assert done.returncode == 0 and done.stderr == b""


@pytest.mark.parametrize(
    ("option", "files"),
    [("axes", "arrays"), ("region", "arrays"), ("variable", "arrays"), ("values_variable", "arrays"), ("center", "polytopes, surfaces and points")],
)
def test_an_option_of_reading_needs_a_file_of_its_kind(tmp_path, option, files):
    points, picture = tmp_path / "points.txt", tmp_path / "picture.png"
    points.write_text(point_lines(cross_vertices([0, 0, 0, 0])))
    for file in [(), ("--load", points)] if files == "arrays" else [()]:
        done = run_oval4d("render", *file, f"--{option}", "origin", "-o", picture)
        assert done.returncode != 0 and not picture.exists()
        assert f"--{option} is only for {files} that --load opens" in done.stderr.decode()


def assert_closed(one):
    """Asserts that the faces of a slice pass every edge once in each direction."""
    passes = [(a, b) for face in one["faces"] for a, b in zip(face, face[1:] + face[:1])]
    assert sorted(passes) == sorted((b, a) for a, b in passes)


@pytest.mark.parametrize("noise", [0, 1e-9, 1e-6, 1e-4])
async def test_cells_that_are_nearly_flat_have_closed_sections(server, noise):
    """CSV, slices and STL agree about a tesseract with noise, of which the hyperplanes w = const are parallel to cells."""
    rng = random.Random(5)
    async with Client(server, stream="none") as client:
        done = await load_file(client, "off", tesseract_file(move=lambda x: x + rng.uniform(-noise, noise)))
        assert ("warnings" in done) == (noise > 0)
        for w in [0.3, 1, -1, 1 + noise / 2, 1 - noise / 2, 1 - 2 * noise - 1e-7, -1 + noise / 3]:
            await client.request("set", slices={"w": w, "count": 1})
            one, = (await client.request("get", what="slices", **SIZE))["slices"]
            if len(one["faces"]) > 1:
                assert_closed(one)
            if abs(w) < 1 - noise:
                assert [len(one[part]) for part in ("vertices", "edges", "faces")] == [8, 12, 6]
                row = next(csv.DictReader(io.StringIO((await get_file(client, format="csv")).decode())))
                assert float(row["volume"]) == pytest.approx(8, rel=10 * noise + 1e-9)
                triangles = meshes.stl_triangles(await get_file(client, format="stl", size=60))
                assert len(triangles) == 12
                millimeters = pytest.approx(float(row["volume"]) * 15**3, rel=1e-4 + 10 * noise)
                assert abs(meshes.volume_of(triangles)) == millimeters


async def test_a_nearly_flat_pyramid_has_closed_sections(server):
    async with Client(server, stream="none") as client:
        done = await load_file(client, "off", (WILD / "nearly-flat-cell.off").read_text())
        assert len(done["warnings"]) == 1 and "moved by up to 0.00005" in done["warnings"][0]
        for w in (0, 2e-5, 5e-5, 8e-5, 1e-4, 1.2e-4, 0.3):
            await client.request("set", slices={"w": w, "count": 1})
            one, = (await client.request("get", what="slices", **SIZE))["slices"]
            if len(one["faces"]) > 1:
                assert_closed(one)
