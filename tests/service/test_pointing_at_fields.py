"""What is at a point of a picture of a field, and the values of a field at a point."""

import math

import numpy
import pytest
from array_clients import load
from array_files import netcdf_with_units, quadratic
from surfaces import dot, field_client, load_field, random_rotation
from wire import Client, Refused

SIZE = {"width": 640, "height": 360}
BALL = "x^2 + y^2 + z^2 + w^2"
BOX = [[-1, 1]] * 4
MIDDLE = {"x": SIZE["width"] / 2, "y": SIZE["height"] / 2}
BARE = {"balls": False, "bars": False, "coordinates": False}


def pixel_of(scene, position, point):
    """Returns the pixel at which a point of the slice at this position is drawn."""
    camera = scene["camera"]
    eye, target, up = (numpy.array(camera[name], float) for name in ("eye", "target", "up"))
    back = (eye - target) / numpy.linalg.norm(eye - target)
    right = numpy.cross(up, back)
    right /= numpy.linalg.norm(right)
    from_eye = numpy.array(position) + scene["scale"] * numpy.array(point) - eye
    depth = -from_eye @ back
    focal = SIZE["height"] / 2 / math.tan(camera["fov"] / 2)
    x = SIZE["width"] * (0.5 + camera["shift"][0]) + focal * (from_eye @ right) / depth
    y = SIZE["height"] * (0.5 - camera["shift"][1]) - focal * (from_eye @ numpy.cross(back, right)) / depth
    return {"x": x, "y": y}


async def at_point(client, **point):
    return await client.request("get", what="at", **point, **SIZE)


@pytest.mark.parametrize("seed", [None, 4])
async def test_a_point_of_a_sphere(server, seed):
    """The point is where the picture has a point of the surface that faces the viewer, but exactly on the level."""
    async with field_client(server, BALL, BOX, stream="none") as client:
        await client.request("set", levels=[0.25, 0.64], shown=BARE, view="strip", slices={"spacing": 0.1})
        if seed is not None:
            await client.request("set", orientation=random_rotation(seed))
        matrix = (await client.request("get", what="state"))["orientation"]
        slices = await client.request("get", what="slices", **SIZE)
        eye = slices["scene"]["camera"]["eye"]
        for piece in slices["slices"]:
            if piece["index"] not in (0, 3):
                continue
            surface = piece["surface"]
            outer = {corner for triangle, level in zip(surface["triangles"], surface["level"]) if level == 1 for corner in triangle}
            world = {p: [c + slices["scene"]["scale"] * x for c, x in zip(piece["position"], surface["points"][p])] for p in outer}
            nearest = min(outer, key=lambda p: math.dist(world[p], eye))
            point = surface["points"][nearest]
            at = await at_point(client, **pixel_of(slices["scene"], piece["position"], point))
            assert at["highlight"] is None and at["in"] == "slice" and at["slice"] == piece["index"]
            assert at["w"] == pytest.approx(piece["w"]) and at["level"] == 1 and at["cap"] is False
            assert at["value"] == 0.64 and dot(at["place"], at["place"]) == pytest.approx(0.64, abs=1e-5)
            # The rows of the rotation matrix turn a place in the box to the point in the picture.
            shown = [dot(row, at["place"]) for row in matrix]
            assert shown == pytest.approx([*point, piece["w"]], abs=0.01)
            assert "second_value" not in at and "least_w" not in at
        nothing = await at_point(client, x=1, y=1)
        assert nothing["highlight"] is None and "level" not in nothing


async def test_a_cap_has_the_value_of_the_function(server):
    """The half x < 0.2 of a box, in which the front of the slice is a cap."""
    async with field_client(server, "x", [[-1, 1], [-1, 1], [-1, 1], [-1, 1]], stream="none") as client:
        await client.request("set", levels=[0.2], shown=BARE, view="single")
        slices = await client.request("get", what="slices", **SIZE)
        focus = next(piece for piece in slices["slices"] if piece["focus"])
        front = await at_point(client, **pixel_of(slices["scene"], focus["position"], [-0.5, 0.1, 1]))
        assert front["cap"] is True and front["level"] == 0
        assert front["place"] == pytest.approx([-0.5, 0.1, 1, focus["w"]], abs=1e-3) and front["value"] == pytest.approx(-0.5, abs=1e-3)
        await client.request("set", caps="open")
        through = await at_point(client, **pixel_of(slices["scene"], focus["position"], [-0.5, 0.1, 1]))
        assert "level" not in through


async def test_the_surface_of_the_focus_slice_in_the_projection(server):
    async with field_client(server, BALL, BOX, stream="none") as client:
        settings = {"view": "single", "projection": "perspective", "slices": {"spacing": 0.1, "focus": 4}}
        await client.request("set", levels=[0.64], shown=BARE, **settings)
        slices = await client.request("get", what="slices", **SIZE)
        w = next(piece for piece in slices["slices"] if piece["focus"])["w"]
        projection, scene = slices["projection"], slices["scene"]
        to_eye = numpy.array(scene["camera"]["eye"]) - projection["position"]
        point = math.sqrt(0.64 - w**2) * to_eye / numpy.linalg.norm(to_eye)
        magnified = {**scene, "scale": projection["surface_scale"]}
        at = await at_point(client, **pixel_of(magnified, projection["position"], point))
        assert at["highlight"] is None and at["in"] == "projection" and "slice" not in at and "w" not in at
        assert at["level"] == 0 and at["cap"] is False and at["value"] == 0.64
        assert at["place"] == pytest.approx([*point, w], abs=1e-3)


async def test_the_second_function_is_evaluated_and_hidden_surfaces_are_not_found(server):
    async with Client(server, stream="none") as client:
        await load_field(client, BALL, BOX, values="10 + x - w")
        await client.request("set", levels=[0.64], shown=BARE, view="single")
        at = await at_point(client, **MIDDLE)
        assert at["level"] == 0 and at["second_value"] == pytest.approx(10 + at["place"][0] - at["place"][3], abs=1e-5)
        await client.request("set", shown={"faces": False})
        assert "level" not in await at_point(client, **MIDDLE)
        # The bars of the box are elements, as usual.
        await client.request("set", shown={"faces": True, "bars": True})
        slices = await client.request("get", what="slices", **SIZE)
        focus = next(piece for piece in slices["slices"] if piece["focus"])
        front = max(focus["vertices"], key=lambda v: v[1] + v[2])
        bar = await at_point(client, **pixel_of(slices["scene"], focus["position"], [0.5 * front[0], front[1], front[2]]))
        assert bar["highlight"]["element"] == "face" and "level" not in bar


async def test_the_contours_of_the_matrix(server):
    point = [0.1, 0.2, 0.05, 0]
    async with field_client(server, BALL, BOX, stream="none") as client:
        await client.request("set", view="matrix", levels=[0.16, 0.64], point=point)
        matrix = (await client.request("get", what="slices", **SIZE))["matrix"]
        scale = matrix["panel"] / 2 / matrix["reach"] * SIZE["height"]
        for section in matrix["sections"]:
            column, row = section["axes"]
            center = [(matrix["left"] + column * matrix["step"] + matrix["panel"] / 2) * SIZE["height"],
                      (1 - matrix["bottom"] - (3 - row) * matrix["step"] - matrix["panel"] / 2) * SIZE["height"]]
            radius = math.sqrt(0.64 - sum(point[k]**2 for k in range(4) if k not in (column, row)))
            at = await at_point(client, x=center[0] + 0.6 * radius * scale, y=center[1] - 0.8 * radius * scale)
            assert at["in"] == "matrix" and at["level"] == 1 and at["value"] == 0.64 and at["cap"] is False
            expected = list(point)
            expected[column], expected[row] = 0.6 * radius, 0.8 * radius
            assert at["place"] == pytest.approx(expected, abs=0.03) and "point" in at and "slice" not in at


async def test_the_values_at_a_point(server):
    async with Client(server, stream="none") as client:
        await load_field(client, "x + 2*y", [[0, 1], [0, 2], [0, 3], [0, 4]], values="w")
        # The coordinates of points start at the center of the box.
        at = await client.request("get", what="at", point=[0.25, 0.5, 0, -1])
        assert at["type"] == "at" and at["highlight"] is None and "in" not in at
        assert at["place"] == pytest.approx([0.75, 1.5, 1.5, 1]) and at["value"] == pytest.approx(3.75) and at["second_value"] == 1
        revision = (await client.request("get", what="state"))["revision"]
        assert at["revision"] == revision, "nothing changes"
        rotation = random_rotation(5)
        await client.request("set", orientation=rotation)
        turned = [dot(row, [0.25, 0.5, 0, -1]) for row in rotation]
        again = await client.request("get", what="at", point=turned)
        assert again["place"] == pytest.approx(at["place"], abs=1e-6) and again["value"] == pytest.approx(3.75, abs=1e-5)
        await client.request("set", orientation=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], pace=2)
        moment = await client.request("get", what="at", point=[0.25, 0.5, 0, -2])
        assert moment["place"] == pytest.approx([0.75, 1.5, 1.5, 1]), "in the frame of reference"
        outside = await client.request("get", what="at", point=[3, 0, 0, 0])
        assert "value" not in outside and "second_value" not in outside and outside["place"][0] == pytest.approx(3.5)
        await load_field(client, "sqrt(x)", BOX)
        assert "value" not in await client.request("get", what="at", point=[-0.5, 0, 0, 0]), "the function has none"


async def test_the_values_of_an_array(server):
    async with Client(server, stream="none") as client:
        units = {"x": "m", "y": "m", "z": "km", "t": "s"}
        await load(client, "run", netcdf_with_units(quadratic((3, 4, 5, 6)), "temperature", "K", units), "netcdf")
        state = await client.request("get", what="state")
        least, greatest = state["field"]["range"]
        at = await client.request("get", what="at", point=[0, 0, 0, 0])
        assert least <= at["value"] <= greatest
        assert at["place"] == pytest.approx([sum(ends) / 2 for ends in state["field"]["box"]])


@pytest.mark.parametrize("members, says, code", [
    ({"point": [0, 0, 0]}, "point", "bad_message"), ({"point": [0, 0, 0, 1e32]}, "point", "out_of_range"),
    ({"point": "0,0,0,0"}, "point", "bad_message"),
    ({"point": [0, 0, 0, 0], "x": 1, "y": 1}, "either /point, or /x and /y", "bad_message"),
    ({}, "needs /x and /y", "bad_message"),
])
async def test_wrong_points_are_refused(server, members, says, code):
    async with field_client(server, BALL, BOX, stream="none") as client:
        with pytest.raises(Refused, match=says) as refused:
            await client.request("get", what="at", **members)
        assert refused.value.code == code


async def test_only_fields_have_values(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        with pytest.raises(Refused, match="the 24-cell is not a field, so it has no values") as refused:
            await client.request("get", what="at", point=[0, 0, 0, 0])
        assert refused.value.code == "out_of_range"
