"""Moving observers: what the slices of fields, polytopes and clouds show in other frames of reference; pictures, storage."""

import asyncio
import contextlib
import math
from urllib.parse import quote, urlencode

import png
import pytest
from harness import Server, run_oval4d
from surfaces import field_client, random_rotation, surface_centroid, surface_volume
from test_geometry import volume as slice_volume
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}
MOVING_BALL = "(x-0.3*t)^2 + y^2 + z^2 - 0.04"
MOVING_BOX = [[-1.2, 1.2], [-0.6, 0.6], [-0.6, 0.6], [-2, 2]]


async def state_of(client):
    return await client.request("get", what="state")


async def slices_of(client):
    return await client.request("get", what="slices", **SIZE)


async def test_what_is_followed_stands_still_at_every_pace(server):
    async with field_client(server, MOVING_BALL, MOVING_BOX) as client:
        for pace in (0.5, 1, 2):
            for follow in ([0, 0, 0], [0.3, 0, 0]):
                await client.request("set", pace=pace, follow=follow, slices={"count": 11, "spacing": 0.3 * pace})
                state = await state_of(client)
                assert (state["pace"], state["follow"], state["boost"]) == (pace, follow, [0, 0, 0])
                pieces = [piece for piece in (await slices_of(client))["slices"] if "surface" in piece]
                assert len(pieces) == 11
                for piece in pieces:
                    expected = (0.3 - follow[0]) * piece["w"] / pace
                    assert surface_centroid(piece["surface"]) == pytest.approx([expected, 0, 0], abs=0.005)


@pytest.mark.parametrize("speed", [0.3, 0.6, -0.8])
async def test_a_rod_contracts_and_a_polytope_keeps_its_hypervolume(server, speed):
    gamma = 1 / math.sqrt(1 - speed ** 2)
    async with field_client(server, "0*x < 1", [[-1, 1], [-0.5, 0.5], [-0.5, 0.5], [-3, 3]]) as client:  # fills its box
        await client.request("command", line=f"boost x {speed}")
        await client.request("set", slices={"count": 5, "spacing": 0.1})
        for piece in (await slices_of(client))["slices"]:
            ends = [x for x, _, _ in piece["vertices"]]
            assert max(ends) - min(ends) == pytest.approx(2 / gamma, abs=1e-6)
            assert (max(ends) + min(ends)) / 2 == pytest.approx(-speed * piece["w"], abs=1e-6)
            assert surface_volume(piece) == pytest.approx(2 / gamma, rel=0.01)
        await client.request("set", polytope="24-cell", orientation=random_rotation(7))
        radius = (await slices_of(client))["scene"]["circumradius"]
        assert radius > 2, "that of the image"
        spacing = 2 * radius / 200
        await client.request("set", slices={"count": 201, "spacing": spacing})
        total = sum(slice_volume(piece) for piece in (await slices_of(client))["slices"]) * spacing
        assert total == pytest.approx(32, rel=1e-3)


async def test_a_cloud_moves_with_its_observer(server):
    async with Client(server) as client:
        events = [[0.3 * t, 0.1, 0, t] for t in (-2, -1, 0, 1, 2)]
        await client.request("load", name="events", format="cloud",
                             data="\n".join(" ".join(map(str, event)) for event in events))
        await client.request("set", follow=[0.3, 0, 0], pace=2, slices={"count": 5, "spacing": 2})
        for piece in (await slices_of(client))["slices"]:
            assert piece["vertices"] == [pytest.approx([0, 0.1, 0], abs=1e-6)]


async def test_changes_are_undone_and_a_state_restores_them(server):
    async with Client(server) as client:
        await client.request("set", polytope="24-cell")
        before = await state_of(client)
        await client.request("set", pace=2, follow=[0.1, 0, -0.2], boost=[0, 0.5, 0.3])
        changed = await state_of(client)
        assert changed["slices"]["spacing"] != before["slices"]["spacing"], "the slices span the image"
        await client.request("undo")
        assert {**await state_of(client), "revision": 0, "id": 0} == {**before, "revision": 0, "id": 0}
        await client.request("redo")
        assert {**await state_of(client), "revision": 0, "id": 0} == {**changed, "revision": 0, "id": 0}
        picture = await client.request_frame(**SIZE)
        restored = {name: value for name, value in png.state_in(picture).items() if name not in ("type", "id")}
        async with Client(server) as other:
            await other.request("set", **restored)
            assert png.pixels(await other.request_frame(**SIZE)) == png.pixels(picture)


@pytest.mark.parametrize("settings, code, text", [
    ({"pace": 0}, "out_of_range", "from 0.001 to 1000"), ({"pace": 1001}, "out_of_range", "from 0.001 to 1000"),
    ({"pace": "2"}, "bad_message", "pace"), ({"follow": [1, 2]}, "bad_message", "follow"),
    ({"follow": [1, 2, 1001]}, "out_of_range", "from −1000 to 1000"), ({"boost": 0.5}, "bad_message", "boost"),
    ({"boost": [1, 0, 0]}, "out_of_range", "from −0.999 to 0.999"),
    ({"boost": [0.8, 0.8, 0]}, "out_of_range", "from 0 to 0.999"), ({"boost": [0, 0, 0, 0]}, "bad_message", "boost"),
])
async def test_wrong_frames_are_refused(server, settings, code, text):
    async with Client(server) as client:
        await client.request("set", boost=[0.5, 0, 0])
        with pytest.raises(Refused) as refused:
            await client.request("set", **settings)
        assert refused.value.code == code and text in str(refused.value)
        state = await state_of(client)
        assert (state["revision"], state["boost"]) == (1, [0.5, 0, 0])


# --- Pictures of moving observers: the rasterizer process and the command line derive the moved object themselves

QUERIES = [
    {"polytope": "24-cell", "boost": "0.6,0,0", "rotate": "xw,yz:pi/8,0.4"},
    {"polytope": "small stellated 120-cell", "follow": "0.2,0,0.3", "pace": "0.5", "projection": "perspective"},
    {"formula": MOVING_BALL, "box": "-1,1,-1,1,-1,1,-3,3", "follow": "0.3,0,0", "pace": "0.4", "color": "growth"},
    {"formula": "x^2+y^2+z^2 < w^2", "boost": "0.3,0.3,0", "rotate": "xw:pi/6"},
]


async def frame_of(server, query):
    answer = await asyncio.to_thread(server.get, f"/api/v1/frame.png?{urlencode({**query, **SIZE}, quote_via=quote)}")
    assert answer.status == 200, answer.body
    return png.pixels(answer.body)


@pytest.mark.parametrize("query", QUERIES)
async def test_pictures_of_the_server_and_of_the_command_line_are_equal(server, query, tmp_path):
    expected = await frame_of(server, query)
    at_rest = {name: value for name, value in query.items() if name not in ("pace", "follow", "boost")}
    assert await frame_of(server, at_rest) != expected
    picture = tmp_path / "picture.png"
    words = [f"--{name}={value}" for name, value in {**query, **SIZE}.items()]
    done = await asyncio.to_thread(run_oval4d, "render", "-o", picture, *words)
    assert done.returncode == 0, done.stderr
    assert png.pixels(picture.read_bytes()) == expected


async def test_pictures_follow_changes_of_frames_and_objects(server):
    """A rasterizer process keeps objects and their images: none is confused with another."""
    frames = [[0, 0, 0], [0.6, 0, 0], [0, 0.6, 0]]
    seen = {}
    async with Client(server) as client:
        for name in ("24-cell", "16-cell", "24-cell", "8-cell", "16-cell"):
            for boost in frames + frames[::-1]:
                await client.request("set", polytope=name, boost=boost, slices={"spacing": 0.2})
                picture = png.pixels(await client.request_frame(**SIZE))
                assert seen.setdefault((name, str(boost)), picture) == picture
    assert len(set(seen.values())) == len(seen)


async def test_a_frame_survives_a_restart(tmp_path):
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as server:
        async with field_client(server, MOVING_BALL, MOVING_BOX) as client:
            await client.request("set", follow=[0.3, 0, 0])
            await client.request("set", polytope="16-cell", boost=[0.2, 0, 0.7], pace=3)
            before = [await state_of(client), await slices_of(client)]
            welcome = client.welcome
    with Server("--store", store) as server:
        async with Client(server, session=welcome["session"], token=welcome["token"]) as client:
            for one, other in zip(before, [await state_of(client), await slices_of(client)]):
                assert {**one, "id": 0, "object_serial": 0} == {**other, "id": 0, "object_serial": 0}
            await client.request("undo")
            state = await state_of(client)
            assert (state["polytope"]["name"], state["follow"], state["pace"]) == ("field", [0.3, 0, 0], 1)


async def test_exported_files_contain_the_image(server):
    answer = await asyncio.to_thread(server.get, "/api/v1/file.off?polytope=8-cell&boost=0.6,0,0&pace=2")
    rows = [line.split() for line in answer.body.decode().splitlines() if line and not line.startswith("#")]
    vertices = sorted(tuple(round(float(word), 9) for word in row) for row in rows[2:18])
    expected = sorted((1.25 * (x - 0.6 * w), y, z, 1.25 * (w - 0.6 * x))
                      for x in (-1, 1) for y in (-1, 1) for z in (-1, 1) for w in (-2, 2))
    for one, other in zip(vertices, expected, strict=True):
        assert one == pytest.approx(other, abs=1e-9)


async def test_images_count_toward_the_bytes_of_a_client():
    with Server("--max-client-bytes", "40M") as server:
        async with contextlib.AsyncExitStack() as sessions:
            refusals = []
            for _ in range(20):
                client = await sessions.enter_async_context(Client(server))
                await client.request("set", polytope="omnitruncated 120-cell")  # all sessions share this polytope
                try:
                    await client.request("set", boost=[0.5, 0, 0])
                except Refused as refusal:
                    refusals.append(refusal.code)
                    assert (await state_of(client))["boost"] == [0, 0, 0]
            assert 0 < len(refusals) < 20 and set(refusals) == {"too_many"}
