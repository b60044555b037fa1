"""The matrix view: sections of the object by the planes through the focus point."""

import itertools
import math

import png
import pytest
from surfaces import field_client, load_field, random_rotation
from test_python_client_arrays import assert_approximately_equal
from wire import ENCODINGS, Client, Refused

PLANES = [[0, 1], [0, 2], [1, 2], [0, 3], [1, 3], [2, 3]]


async def test_messages_commands_queries_and_undo_agree(server):
    async with Client(server, stream="none") as client:
        async def point():
            return (await client.request("get", what="state"))["point"]

        await client.request("set", polytope="24-cell", view="matrix")
        assert await point() == [0, 0, 0, 0]
        await client.request("set", point=[0.1, 0.2, -0.3, 0.25])
        state = await client.request("get", what="state")
        assert state["point"] == state["point"][:3] + [state["section"]["w"]] == pytest.approx([0.1, 0.2, -0.3, 0.25])
        await client.request("command", line=":set point=1/2,0,0,-0.1")
        assert await point() == pytest.approx([0.5, 0, 0, -0.1])
        await client.request("key", key="l")
        assert (await point())[:3] == [0.5, 0, 0] and (await point())[3] > -0.1, "w follows the focus slice"
        for _ in range(2):
            await client.request("undo")
        assert await point() == pytest.approx([0.1, 0.2, -0.3, 0.25])
        for key, view in ("m", "oval"), ("m", "matrix"), ("o", "single"), ("o", "oval"), ("m", "matrix"):
            await client.request("key", key=key)
            assert (await client.request("get", what="state"))["view"] == view
        await client.request("set", **{name: value for name, value in state.items() if name not in ("type", "id")})
        assert await point() == pytest.approx([0.1, 0.2, -0.3, 0.25]), "a state is a valid set"
        await client.request("set", polytope="tesseract")
        assert (await point())[:3] == [0, 0, 0]


@pytest.mark.parametrize("slices", [
    {"spacing": 0.1, "focus": 1, "offset": 1}, {"spacing": 0.3, "focus": -7, "offset": 0.14}, {"spacing": 0.2, "focus": 3, "offset": -0.75},
    {"spacing": 2, "focus": 1_000_000, "offset": 0},
])
async def test_a_state_is_a_valid_set(server, slices):
    async with Client(server, stream="none") as client, Client(server, stream="none") as other:
        await client.request("set", polytope="24-cell", view="matrix", point=[0.1, 0.2, 0.3, 0.4])
        await client.request("set", slices=slices)
        state = await client.request("get", what="state")
        assert {name: state["slices"][name] for name in slices} == slices
        await other.request("set", **{name: value for name, value in state.items() if name not in ("type", "id")})
        again = await other.request("get", what="state")
        assert all(again[name] == state[name] for name in state if name not in ("id", "revision", "object_serial"))


@pytest.mark.parametrize("value, says", [
    ([0, 0, 0], "point"), ([0, 0, 0, "w"], "point"), ("origin", "point"), ([0, 100, 0, 0], "the point's y must be from"),
    ([0, 0, 0, 1e9], "the point's w must be from"),
])
async def test_wrong_points_are_refused(server, value, says):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused, match=says):
            await client.request("set", point=value)
        assert (await client.request("get", what="state"))["point"] == [0, 0, 0, 0]


async def test_sections_of_a_tesseract_are_squares_and_rectangles(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract", view="matrix", point=[0.1, 0.2, 0.3, -0.1])
        slices = await client.request("get", what="slices", width=1280, height=720)
        matrix = slices["matrix"]
        assert matrix["point"] == pytest.approx([0.1, 0.2, 0.3, -0.1])
        assert matrix["reach"] > slices["scene"]["circumradius"]
        assert [section["axes"] for section in matrix["sections"]] == PLANES
        half = slices["scene"]["circumradius"] / 2
        for section in matrix["sections"]:
            corners = sorted(itertools.product([-half, half], repeat=2))
            assert sorted(map(tuple, section["points"])) == [pytest.approx(corner) for corner in corners]
            assert sorted(section["boundary"]) == [0, 1, 2, 3] and len(set(section["of"]["edges"])) == 4
            assert section["tints"] == section["of"]["edges"]
        await client.request("set", view="oval")
        assert "matrix" not in await client.request("get", what="slices")


async def test_all_encodings_have_the_same_matrix(server):
    matrices = {encoding: [] for encoding in ENCODINGS}
    for encoding in ENCODINGS:
        async with Client(server, stream="none", encoding=encoding) as client:
            for setting in {"polytope": "600-cell", "view": "matrix", "point": [0.1, 0.05, 0, 0.2]}, {"hidden": [0]}:
                await client.request("set", **setting)
                await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 0.7])
                matrices[encoding].append((await client.request("get", what="slices"))["matrix"])
        assert_approximately_equal(matrices["json"], matrices[encoding])
    assert all(set(section["seen"]["edges"]) <= {0} for section in matrices["json"][1]["sections"])


async def test_a_list_of_points_has_the_points_near_the_planes(server):
    async with Client(server, stream="none") as client:
        grid = [-1, -0.5, 0, 0.5, 1]
        data = "CLOUD\n" + "\n".join(" ".join(map(str, p)) for p in itertools.product(grid, repeat=4))
        await client.request("load", name="grid", format="cloud", data=data)
        await client.request("set", view="matrix", slices={"spacing": 0.4}, point=[0.5, 0, 0, -0.5])
        for section in (await client.request("get", what="slices"))["matrix"]["sections"]:
            assert sorted((round(a, 9), round(b, 9)) for a, b in section["points"]) == sorted(itertools.product(grid, repeat=2))
            assert len(section["balls"]["opacity"]) == 25 and section["edges"] == []


async def test_what_is_at_a_point_of_a_panel(server):
    width, height = 1280, 720
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell", view="matrix", point=[0.1, 0.05, -0.1, 0.2])
        await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 0.7])
        matrix = (await client.request("get", what="slices", width=width, height=height))["matrix"]
        for section in matrix["sections"]:
            column, row = section["axes"]
            center = [matrix["left"] + column * matrix["step"] + matrix["panel"] / 2,
                      matrix["bottom"] + (3 - row) * matrix["step"] + matrix["panel"] / 2]
            scale = matrix["panel"] / 2 / matrix["reach"]
            edge = max(range(len(section["edges"])), key=lambda e: math.dist(*(section["points"][p] for p in section["edges"][e])))
            a, b = (section["points"][p] for p in section["edges"][edge])
            middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
            x, y = (center[k] + scale * middle[k] for k in (0, 1))
            at = await client.request("get", what="at", x=x * height, y=height * (1 - y), width=width, height=height)
            assert at["in"] == "matrix" and at["highlight"] == {"element": "cell", "number": section["of"]["edges"][edge]}
            expected = list(matrix["point"])
            expected[column], expected[row] = middle
            assert at["point"] == pytest.approx(expected, abs=1e-6)
        at = await client.request("get", what="at", x=(matrix["left"] + 0.01) * height, y=height * (1 - matrix["bottom"] - 0.01))
        assert at["highlight"] is None and "point" in at, "the corner of a panel is empty"


def test_a_frame_shows_the_matrix(server):
    base = "/api/v1/frame.png?polytope=24-cell&width=640&height=360"
    oval, matrix, moved = (server.get(base + more).body for more in ("", "&view=matrix", "&view=matrix&point=0.3,0,0,0"))
    panels = [png.pixels(picture)[1] for picture in (oval, matrix, moved)]
    assert panels[0] != panels[1] != panels[2]


SPHERE = "sqrt(x^2 + y^2 + z^2 + w^2)"


async def test_the_contours_of_a_sphere_are_circles(server):
    point = [0.1, 0.2, 0.3, -0.1]
    async with field_client(server, SPHERE, stream="none") as client:
        for seed in None, 5, 6:
            if seed is not None:
                await client.request("set", orientation=random_rotation(seed))
            await client.request("set", view="matrix", levels=[1, 1.5], point=point)
            slices = await client.request("get", what="slices", width=1280, height=720)
            assert {look["level"] for look in slices["scene"]["surfaces"]} == {0, 1}
            for section in slices["matrix"]["sections"]:
                beside = sum(point[axis] ** 2 for axis in range(4) if axis not in section["axes"])
                assert [line["level"] for line in section["contours"]] == [0, 1]
                for line, level in zip(section["contours"], [1, 1.5]):
                    radius = math.sqrt(level**2 - beside)
                    assert line["points"][0] == line["points"][-1], "a closed line"
                    assert all(math.hypot(*p) == pytest.approx(radius, abs=0.02) for p in line["points"])
                assert section["boundary"], "the outline of the box"
        await client.request("set", shown={"faces": False})
        hidden = await client.request("get", what="slices")
        assert not any("contours" in section for section in hidden["matrix"]["sections"])
        await client.request("set", polytope="24-cell", shown={"faces": True})
        polytope = await client.request("get", what="slices")
        assert not any("contours" in section for section in polytope["matrix"]["sections"])


async def test_contours_end_at_a_hole(server):
    async with field_client(server, "x + s - s; s=sqrt(x^2 + y^2 + z^2 + w^2 - 0.25)", stream="none") as client:
        await client.request("set", view="matrix", levels=[0.013])
        sections = (await client.request("get", what="slices", width=1280, height=720))["matrix"]["sections"]
        for section in sections:
            if 0 in section["axes"]:
                assert len(section["contours"]) == 2
                assert all(math.hypot(*p) > 0.49 for line in section["contours"] for p in line["points"])
            else:
                assert section["contours"] == []


async def test_all_encodings_have_the_same_contours(server):
    sections = {}
    for encoding in ENCODINGS:
        async with Client(server, stream="none", encoding=encoding) as client:
            await load_field(client, "x*y + z*w + sqrt(x + 1.2)")
            await client.request("set", view="matrix", levels=[0.7, 1.4, 2], point=[0.1, 0.05, 0, 0.2])
            await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 0.7])
            sections[encoding] = (await client.request("get", what="slices"))["matrix"]["sections"]
        assert_approximately_equal(sections[encoding], sections["json"])
    assert sum(len(section["contours"]) for section in sections["json"]) >= 3


async def test_a_frame_shows_the_contours(server):
    width, height = 1280, 720
    async with field_client(server, SPHERE, stream="none") as client:
        await client.request("set", view="matrix", levels=[1, 1.5], point=[0.1, 0.2, 0.3, -0.1],
                             shown={"bars": False, "balls": False})
        slices = await client.request("get", what="slices", width=width, height=height)
        size, data = png.pixels(await client.request_frame(width=width, height=height))
        assert size == (width, height)
        matrix, colors = slices["matrix"], {look["level"]: look["color"] for look in slices["scene"]["surfaces"]}
        near = total = 0
        for section, transposed in itertools.product(matrix["sections"], (False, True)):
            column, row = reversed(section["axes"]) if transposed else section["axes"]
            for line in section["contours"]:
                expected = [colors[line["level"]] >> shift & 255 for shift in (16, 8, 0)]
                for point in line["points"]:
                    across, up = reversed(point) if transposed else point
                    scale = matrix["panel"] / 2 / matrix["reach"]
                    x = (matrix["left"] + column * matrix["step"] + matrix["panel"] / 2 + scale * across) * height
                    y = (1 - matrix["bottom"] - (3 - row) * matrix["step"] - matrix["panel"] / 2 - scale * up) * height
                    around = [3 * (width * (int(y) + dy) + int(x) + dx) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
                    near += any(max(abs(data[at + k] - expected[k]) for k in range(3)) < 64 for at in around)
                    total += 1
        assert total > 500 and near > 0.95 * total
