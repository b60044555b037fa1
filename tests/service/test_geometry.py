"""Compares the `slices` message with independently computed geometry."""

import itertools
import math

import pytest
from wire import Client

PLANES = {"xy": (0, 1), "xz": (0, 2), "xw": (0, 3), "yz": (1, 2), "yw": (1, 3), "zw": (2, 3)}


def rotate_points(points, plane, angle):
    a, b = PLANES[plane]
    result = []
    for point in points:
        moved = list(point)
        moved[a] = point[a] * math.cos(angle) - point[b] * math.sin(angle)
        moved[b] = point[a] * math.sin(angle) + point[b] * math.cos(angle)
        result.append(moved)
    return result


def simplex_section(vertices, w):
    """Returns the 3-D points in which the edges of a 5-cell (all pairs of vertices) meet a hyperplane."""
    points = []
    for p, q in itertools.combinations(vertices, 2):
        if (p[3] - w) * (q[3] - w) < 0:
            part = (w - p[3]) / (q[3] - p[3])
            points.append([p[i] + part * (q[i] - p[i]) for i in range(3)])
    return points


def volume(piece):
    """Returns the volume by the divergence theorem, positive if the faces are counterclockwise seen from outside."""
    total = 0
    for face in piece["faces"]:
        a, *others = (piece["vertices"][v] for v in face)
        for b, c in zip(others, others[1:]):
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                      + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


def assert_closed_surface(piece):
    """Asserts Euler's formula, and that the faces traverse each edge once in each direction."""
    if not piece["faces"]:
        return
    assert len(piece["vertices"]) - len(piece["edges"]) + len(piece["faces"]) == 2
    sides = [side for face in piece["faces"] for side in zip(face, face[1:] + face[:1])]
    assert len(set(sides)) == len(sides) == 2 * len(piece["edges"])
    assert {tuple(sorted(side)) for side in sides} == {tuple(sorted(edge)) for edge in piece["edges"]}
    assert volume(piece) > 0


async def test_slices_of_the_5_cell_are_correct_after_each_rotation_key(server):
    keys = {"2": ["xy"], "3": ["xz"], "4": ["xw"], "5": ["yz"], "6": ["yw"], "7": ["zw"],
            "r": ["xw", "yz"], "t": ["xz", "yw"], "y": ["xy", "zw"]}
    alpha, beta = 0.3, 0.7
    async with Client(server, stream="geometry") as client:
        expected = (await client.wait_for_slices(0))["coordinates"]
        await client.request("set", alpha=alpha, beta=beta)
        for key, planes in keys.items():
            for plane, angle in zip(planes, (alpha, beta)):
                expected = rotate_points(expected, plane, angle)
            done = await client.request("key", key=key)
            slices = await client.wait_for_slices(done["revision"])
            assert len(slices["slices"]) == 21
            for got, point in zip(slices["coordinates"], expected):
                assert got == pytest.approx(point, abs=1e-6)
            spacing = (await client.wait_for_state(done["revision"]))["slices"]["spacing"]
            for piece in slices["slices"]:
                assert piece["w"] == pytest.approx(piece["index"] * spacing)
                assert_closed_surface(piece)
                if min(abs(p[3] - piece["w"]) for p in expected) < 1e-5:
                    continue  # the hyperplane contains a vertex, which other tests cover
                points = simplex_section(expected, piece["w"])
                assert len(points) == len(piece["vertices"])
                for point in points:
                    assert min(math.dist(point, vertex) for vertex in piece["vertices"]) < 1e-5
                assert len(piece["of"]["faces"]) == len(piece["faces"]) and len(set(piece["of"]["faces"])) == len(
                    piece["faces"])


@pytest.mark.parametrize("polytope, content", [
    ("5-cell", math.sqrt(5) / 96 * 2**4), ("8-cell", 16), ("16-cell", 2**4 / 6), ("24-cell", 2 * 2**4),
])
async def test_slice_volumes_sum_to_the_known_hypervolume(server, polytope, content):
    async with Client(server, stream="geometry") as client:
        await client.request("set", polytope=polytope, slices={"count": 201})
        await client.request("rotate", planes=["xw", "yz"], angles=[0.71, 1.93])
        done = await client.request("rotate", planes=["xz", "yw"], angles=[1.17, 0.45])
        slices = (await client.wait_for_slices(done["revision"]))["slices"]
        for piece in slices:
            assert_closed_surface(piece)
        total = sum(volume(piece) for piece in slices) * (slices[1]["w"] - slices[0]["w"])
        assert total == pytest.approx(content, rel=2e-3)


async def test_slices_through_cells_and_vertices_are_exact(server):
    async with Client(server, stream="geometry") as client:
        done = await client.request("set", polytope="8-cell", slices={"count": 3, "spacing": 1})
        pieces = (await client.wait_for_slices(done["revision"]))["slices"]
        assert [(len(p["vertices"]), len(p["edges"]), len(p["faces"])) for p in pieces] == [(8, 12, 6)] * 3
        done = await client.request("set", polytope="16-cell")
        middle = (await client.wait_for_slices(done["revision"]))["slices"][1]
        assert (len(middle["vertices"]), len(middle["edges"]), len(middle["faces"])) == (6, 12, 8)


async def test_the_slices_message_contains_the_layout(server):
    async with Client(server, stream="geometry", width=800, height=600) as client:
        slices = await client.wait_for_slices(0)
        scene = slices["scene"]
        assert scene["viewport"] == {"width": 800, "height": 600}
        assert len(scene["colors"]["cells"]) == 5
        places = [piece["position"] for piece in slices["slices"]]
        assert places[10] == [0, 0, 0] and slices["slices"][10]["focus"] is True
        assert all(a[0] < b[0] for a, b in zip(places, places[1:]))  # w increases to the right
        # z grows with the square of the distance from the focus slice.
        assert places[0][2] == pytest.approx(100 * places[9][2])
        done = await client.request("key", key="o")
        single = await client.wait_for_slices(done["revision"])
        assert [p["index"] for p in single["slices"] if p["drawn"]] == [0]


async def test_in_a_column_w_rises_upward_in_equal_steps(server):
    async with Client(server, stream="geometry", width=375, height=667) as client:
        done = await client.request("key", key="I")
        slices = await client.wait_for_slices(done["revision"])
        assert slices["scene"]["view"] == "column" and all(piece["drawn"] for piece in slices["slices"])
        assert [piece["w"] for piece in slices["slices"]] == sorted(piece["w"] for piece in slices["slices"])
        places = [piece["position"] for piece in slices["slices"]]
        assert places[10] == [0, 0, 0] and all(place[0] == place[2] == 0 for place in places)
        steps = [b[1] - a[1] for a, b in zip(places, places[1:])]
        assert min(steps) > 0 and max(steps) == pytest.approx(min(steps), rel=1e-4)
        await client.request("key", key="I")
        assert (await client.request("get", what="state"))["view"] == "oval"


async def test_a_grid_is_read_from_left_to_right_and_from_top_to_bottom(server):
    async with Client(server, stream="geometry", width=1280, height=720) as client:
        done = await client.request("key", key="M")
        slices = await client.wait_for_slices(done["revision"])
        assert slices["scene"]["view"] == "grid" and all(piece["drawn"] for piece in slices["slices"])
        assert [piece["w"] for piece in slices["slices"]] == sorted(piece["w"] for piece in slices["slices"])
        places = [piece["position"] for piece in slices["slices"]]
        assert places[10] == [0, 0, 0] and all(place[2] == 0 for place in places)
        rows = [list(row) for _, row in itertools.groupby(places, key=lambda place: place[1])]
        assert len(rows) == 3 and [place[0] for place in rows[0]] == sorted(place[0] for place in rows[0])
        assert all([place[0] for place in row] == [place[0] for place in rows[0]] for row in rows)
        assert rows[0][0][1] > 0 > rows[2][0][1]
        await client.request("key", key="M")
        assert (await client.request("get", what="state"))["view"] == "oval"
