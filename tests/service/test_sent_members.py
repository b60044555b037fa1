"""The server sends each member that the schemas of its messages describe in some case, and no other member."""

import collections

import pytest
from array_clients import load
from array_files import netcdf_with_units, quadratic
from harness import LONG_TIME
from schemas import SCHEMAS
from surfaces import load_field
from test_drafts import TIGER, turn_until_a_draft
from test_surface import clifford_torus
from wire import Client, Refused

TYPES = ["welcome", "state", "at", "critical", "catalogue", "keymap", "error", "done", "slices"]
SIZE = {"width": 640, "height": 360}
FOG = [{"value": -1, "opacity": 0.9}, {"value": 0, "opacity": 0.5, "color": 0xff8000}, {"value": 1, "opacity": 0}]
# The eight vertices of a 16-cell whose center is not the origin, and a point inside it, about which the server warns.
POINTS = [[0.5 + sign * (axis == 0), *(sign * (axis == k) for k in (1, 2, 3))] for axis in range(4) for sign in (-1, 1)]
POINTS.append([0.5, 0, 0, 0.1])
# Members that these messages do not have. Some are only in `set` messages. Some are sent only for arrays too large for
# a test. Some are sent only for parts of arrays in a data folder (see test_zarr.py). One is sent only if the server has
# a low limit (see test_limits.py).
NOT_SENT = {"state": {"/slices/w", "/field/estimated", "/field/region", "/field/resolution", "/field/resolution/level",
                      "/field/resolution/levels", "/field/resolution/refining"},
            "slices": {"/projection/only_turned_away"}}


def described(schema, file, path=""):
    """Yields the paths of all members that a schema in this file describes, such as "/scene/camera/eye". The items of
    an array have the path of the array."""
    if "$ref" in schema:
        name, _, pointer = schema["$ref"].partition("#")
        part = SCHEMAS[name or file]
        for key in pointer.split("/")[1:]:
            part = part[key]
        yield from described(part, name or file, path)
    for name, member in schema.get("properties", {}).items():
        yield f"{path}/{name}"
        yield from described(member, file, f"{path}/{name}")
    if "items" in schema:
        yield from described(schema["items"], file, path)


def members_of(value, path=""):
    """Yields the paths of all members of a value."""
    if isinstance(value, dict):
        for name, member in value.items():
            yield f"{path}/{name}"
            yield from members_of(member, f"{path}/{name}")
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for item in value:
            yield from members_of(item, path)


async def show(client, **settings):
    """Changes settings, and requests the state and the slices; returns the slices."""
    await client.request("set", **settings)
    await client.request("get", what="state")
    return await client.request("get", what="slices", **SIZE)


async def polytopes(client):
    for what in ("catalogue", "keymap", "critical"):
        await client.request("get", what=what)
    with pytest.raises(Refused):
        await client.request("key", key="q")
    lines = "\n".join(" ".join(map(str, point)) for point in POINTS)
    assert "warnings" in await client.request("load", name="mine", format="points", data=lines, center="object")
    await show(client, view="oval")
    await client.request("rotate", planes=["xw"], angles=[0.2])
    await client.request("set", polytope="truncated tesseract")
    await show(client, hidden=[1], projection="perspective", shown={"cells": True})
    await show(client, view="matrix")


async def points_of_pictures(client):
    """What is at a point of a slice, of the parallel coordinates and of the matrix."""
    layout = (await show(client, polytope="tesseract", projection="perspective",
                         highlight={"element": "cell", "number": 0}))["scene"]["coordinates"]
    height = SIZE["height"]
    vertex = [layout["left"] + 1.5 * layout["line_step"], 1 - layout["zero"]]
    await client.request("get", what="at", x=vertex[0] * height, y=vertex[1] * height, **SIZE)
    matrix = (await show(client, view="matrix"))["matrix"]
    corner = [matrix["left"] + 0.01, 1 - matrix["bottom"] - 0.01]
    await client.request("get", what="at", x=corner[0] * height, y=corner[1] * height, **SIZE)
    await show(client, view="single", projection="off", shown={"coordinates": False})
    await client.request("get", what="at", x=SIZE["width"] / 2, y=height / 2, **SIZE)


async def stars(client):
    await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 0.4])
    await client.request("set", polytope="small stellated 120-cell", slices={"count": 3})
    await show(client, faded=[0], projection="perspective", shown={"cells": True})


async def clouds(client):
    await client.request("load", name="stars", format="cloud", data="0 0 0 0 1\n1 0 0 0.5 2\n0 1 0 -0.5 1\n")
    await show(client, projection="perspective")
    await show(client, view="matrix")


async def surfaces(client):
    await client.request("load", name="torus", format="off", data=clifford_torus(12, 16)[0])
    await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 1.1])
    await show(client, projection="perspective")
    await show(client, view="matrix")


async def arrays(client):
    body = netcdf_with_units(quadratic(), "temperature", "K", {"x": "m", "y": "m", "z": "km", "t": "s"})
    await load(client, "run", body, "netcdf", variable="v", values_variable="v")
    await show(client, projection="perspective", levels=[0], color="cell", caps="value", fog=FOG)
    for color in ("value", "w"):
        await show(client, color=color)
    await show(client, view="matrix")


async def formulas(client):
    await load_field(client, "x^2 + y^2 + z^2 + w^2 < 1", values="x*w")
    await show(client, color="value")
    await client.request("get", what="critical", deadline=LONG_TIME)
    await show(client, view="single", shown={"coordinates": False})
    await client.request("get", what="at", x=SIZE["width"] / 2, y=SIZE["height"] / 2, **SIZE)


async def drafts(client):
    await load_field(client, TIGER)
    await client.request("hello", stream="geometry", **SIZE)
    await client.wait_for_slices(await turn_until_a_draft(client))


@pytest.mark.release_only
async def test_the_members_of_all_messages_are_those_of_the_schemas(server):
    sent = collections.defaultdict(set)
    for case in (polytopes, points_of_pictures, stars, clouds, surfaces, arrays, formulas, drafts):
        async with Client(server, stream="none") as client:
            await case(client)
            for message in client.messages:
                type_ = message["type"]
                sent[type_].update(members_of(message))
    for type_ in TYPES:
        file = f"{type_}.schema.json"
        assert sent[type_] == set(described(SCHEMAS[file], file)) - NOT_SENT.get(type_, set()), type_
