"""Fog: the values of a field on the lattices of its slices, the setting, and the server's pictures of it."""

import itertools
import math
import sys
from pathlib import Path

import numpy
import png
import pytest
from harness import Server
from surfaces import field_client, load_field, random_rotation
from wire import BINARY_ENCODINGS, ENCODINGS, Client

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402

SIZE = {"width": 480, "height": 270}
FOG = [{"value": -1, "opacity": 0.9}, {"value": 0, "opacity": 0.5, "color": 0xff8000}, {"value": 1, "opacity": 0}]


async def slices_of(client):
    return await client.request("get", what="slices", **SIZE)


def lattice(fog):
    """Returns the points and the values of a slice's lattice in JSON, as arrays of shape (points, 3) and (points)."""
    nx, ny, nz = fog["size"]
    values = numpy.asarray(fog["values"])
    assert values.shape == (ny * nz, nx)
    steps = numpy.indices((nz, ny, nx)).reshape(3, -1)[::-1].T
    return fog["min"] + fog["step"] * steps, values.ravel()


async def test_the_lattices_have_the_values_of_the_field(server):
    async with field_client(server, "x + 2*y - z + w", [[-1, 1]] * 4) as client:
        assert (await client.request("get", what="state"))["fog"] == []
        message = await slices_of(client)
        assert "fog" not in message["scene"] and not any("fog" in piece for piece in message["slices"])
        rows = random_rotation(5)
        await client.request("set", orientation=rows, fog=[{"value": -2, "opacity": 0}, {"value": 2, "opacity": 1}])
        message = await slices_of(client)
        assert len(message["scene"]["fog"]["table"]) == 256
        count = 0
        for piece in (piece for piece in message["slices"] if "fog" in piece):
            points, values = lattice(piece["fog"])
            count += len(values)
            own = numpy.column_stack([points, numpy.full(len(points), piece["w"])]) @ numpy.asarray(rows)
            value = own @ [1, 2, -1, 1]
            assert numpy.abs(values - numpy.clip(1 + (value + 2) / 4 * 254, 1, 255)).max() < 0.6
            walls = numpy.asarray(piece["fog"]["walls"])
            heights = numpy.asarray(piece["vertices"]) @ walls[:, :3].T - walls[:, 3]
            assert numpy.abs(heights.max(axis=1)).max() < 1e-5
        assert 100_000 < count <= 2_200_000


async def test_the_table_is_the_transfer_function(server):
    async with field_client(server, "x") as client:
        await client.request("set", fog=FOG)
        table = (await slices_of(client))["scene"]["fog"]["table"]
        assert table[0] == 0
        for entry in range(1, 256):
            value = (entry - 1) / 127 - 1
            opacity = 0.5 - 0.4 * value if value < 0 else 0.5 * (1 - value)
            assert table[entry] >> 24 == pytest.approx(255 * opacity, abs=0.6)
        assert table[128] & 0xffffff == 0xff8000


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
async def test_all_encodings_have_the_same_fog(server, encoding, monkeypatch):
    monkeypatch.setattr(oval4d_client, "numpy", None)
    async with Client(server) as client:
        await load_field(client, "sqrt(x) + y*z - w")  # has no values where x < 0
        await client.request("set", fog=FOG, orientation=random_rotation(2), slices={"count": 5, "spacing": 1.5})
        text = await slices_of(client)
        await client.request("hello", encoding=encoding)
        packed = await slices_of(client)
        assert list(packed["scene"]["fog"]["table"]) == text["scene"]["fog"]["table"]
        holes = []
        for piece, own in zip(text["slices"], packed["slices"]):
            assert ("fog" in piece) == ("fog" in own)
            if "fog" not in piece:
                continue
            expected, got = piece["fog"], own["fog"]
            assert (got["size"], got["step"]) == (expected["size"], expected["step"])
            assert got["min"] == pytest.approx(expected["min"])
            for wall, other in zip(got["walls"], expected["walls"], strict=True):
                assert wall == pytest.approx(other)
            flat = list(itertools.chain(*expected["values"]))
            assert list(got["values"]) == flat
            holes.append(flat.count(0) / len(flat))
        assert len(holes) == 5 and 0.4 < sum(holes) / 5 < 0.6, "half of the box has no values"


async def test_the_python_client_has_the_lattices_as_arrays(server):
    async with Client(server) as client:
        await load_field(client, "x")
        await client.request("set", fog=[{"value": -2, "opacity": 0}, {"value": 2, "opacity": 1}])
        client.decode = oval4d_client.decode
        for encoding in ENCODINGS:
            await client.request("hello", encoding=encoding)
            for piece in (await slices_of(client))["slices"]:
                fog = piece["fog"]
                assert fog["values"].shape == tuple(reversed(fog["size"])) and fog["values"].dtype == numpy.uint8
                along = fog["min"][0] + fog["step"] * numpy.arange(fog["size"][0])
                expected = numpy.clip(1 + (along + 2) / 4 * 254, 1, 255)
                assert numpy.abs(fog["values"] - expected).max() < 0.6


async def test_the_fog_belongs_to_the_state(server, tmp_path):
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as other:
        async with field_client(other, "x*y - z*w") as client:
            await client.request("set", fog=FOG)
            state = await client.request("get", what="state")
            assert state["fog"] == FOG
            picture = png.pixels(await client.request_frame(**SIZE))
            await client.request("command", line="fog off")
            assert png.pixels(await client.request_frame(**SIZE)) != picture
            await client.request("undo")
            assert (await client.request("get", what="state"))["fog"] == FOG
            await client.request("set", **{name: state[name] for name in state.keys() - {"type", "id"}})
            await client.request("load", name="field", format="formula", data="x*y - z*w*2", continues=True)
            assert (await client.request("get", what="state"))["fog"] == FOG, "the formula is edited"
            await client.request("undo")
            await client.request("redo")
            welcome = client.welcome
    with Server("--store", store) as other:
        async with Client(other, session=welcome["session"], token=welcome["token"]) as client:
            assert (await client.request("get", what="state"))["fog"] == FOG
            await client.request("set", polytope="24-cell")
            assert "fog" not in await client.request("get", what="state")


def project(camera, point):
    """Returns the pixel of a world position, from the upper left corner."""
    def minus(a, b):
        return [p - q for p, q in zip(a, b)]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    def unit(a):
        return [p / math.hypot(*a) for p in a]

    back = unit(minus(camera["eye"], camera["target"]))
    right = unit(cross(camera["up"], back))
    axes = [right, cross(back, right), back]
    x, y, z = (sum(map(lambda p, q: p * q, axis, minus(point, camera["eye"]))) for axis in axes)
    width, height = SIZE["width"], SIZE["height"]
    unit_height = height / (2 * math.tan(camera["fov"] / 2))
    return (int((0.5 + camera["shift"][0]) * width + unit_height * x / -z),
            int((0.5 - camera["shift"][1]) * height - unit_height * y / -z))


async def test_fog_is_as_opaque_as_the_way_through_it_is_long(server):
    red = (255, 0, 0)
    async with field_client(server, "x - x", [[-1, 1]] * 4) as client:
        parts = ("faces", "bars", "balls", "coordinates", "labels")
        await client.request("set", view="single", shown=dict.fromkeys(parts, False),
                             fog=[{"value": value, "opacity": 0.8, "color": 0xff0000} for value in (-1, 1)])
        message = await slices_of(client)
        scene = message["scene"]
        (middle,) = [piece for piece in message["slices"] if piece["focus"]]
        (width, _), data = png.pixels(await client.request_frame(**SIZE))
        background = scene["colors"]["background"]
        for place in ((0.01, 0.02, 0), (0.5, 0.2, 0.3), (-0.6, 0.4, -0.2), (0.1, -0.7, 0.8)):
            world = [at + scene["scale"] * p for at, p in zip(middle["position"], place)]
            eye = [(e - at) / scene["scale"] for e, at in zip(scene["camera"]["eye"], middle["position"])]
            way = [p - e for p, e in zip(place, eye)]
            ends = [sorted(((side - e) / w) for side in (-1, 1)) for e, w in zip(eye, way)]
            length = (min(end for _, end in ends) - max(begin for begin, _ in ends)) * math.hypot(*way)
            opacity = 1 - 0.2 ** (length / scene["circumradius"])
            x, y = project(scene["camera"], world)
            got = data[3 * (y * width + x):3 * (y * width + x) + 3]
            for own, fog, shift in zip(got, red, (16, 8, 0)):
                assert own == pytest.approx(opacity * fog + (1 - opacity) * (background >> shift & 255), abs=4), place


async def test_draft_and_full_lattices_are_bounded(server):
    async with field_client(server, "x*y - z*w", stream="geometry", **SIZE) as client:
        await client.request("set", fog=FOG, slices={"count": 101, "spacing": 0.05})
        for _ in range(25):
            done = await client.request("rotate", planes=["xw"], angles=[0.02])
        complete = await client.wait_for_slices(done["revision"])

        def points(message):
            return sum(math.prod(piece["fog"]["size"]) for piece in message["slices"] if "fog" in piece)

        assert 1_000_000 < points(complete) < 2_300_000
        for message in client.streamed_messages("slices"):
            if "draft" in message and any("fog" in piece for piece in message["slices"]):
                assert points(message) < 300_000
