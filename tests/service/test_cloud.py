"""Finite sets of points in R⁴: loading, slicing, drawing and storing them."""

import math
import random

import png
import pytest
from harness import Server, run_oval4d
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}


def torus_points(count, seed=1):
    """Returns random points on the Clifford torus, as text and as numbers."""
    source = random.Random(seed)
    numbers = []
    for _ in range(count):
        a, b = source.uniform(0, 2 * math.pi), source.uniform(0, 2 * math.pi)
        numbers.append((math.cos(a), math.sin(a), math.cos(b), math.sin(b)))
    return "\n".join(" ".join(f"{x:.9f}" for x in point) for point in numbers), numbers


async def test_a_cloud_is_shown_as_balls():
    text, numbers = torus_points(400)
    with Server() as server:
        async with Client(server, stream="none") as client:
            await client.request("load", name="torus", format="cloud", data=text)
            state = await client.request("get", what="state")
            assert state["polytope"]["name"] == "torus" and state["polytope"]["vertices"] == 400
            assert state["polytope"]["cells"] == 0 and state["polytope"]["kinds"] == []
            slices = await client.request("get", what="slices", **SIZE)
            spacing, found = state["slices"]["spacing"], set()
            for one in slices["slices"]:
                assert one["edges"] == [] and one["faces"] == []
                balls = one["balls"]
                assert len(balls["scale"]) == len(balls["opacity"]) == len(one["vertices"])
                for vertex, source, opacity in zip(one["vertices"], one["of"]["vertices"], balls["opacity"]):
                    assert vertex == pytest.approx(numbers[source][:3], abs=1e-6)
                    distance = abs(numbers[source][3] - one["w"])
                    assert distance <= spacing / 2 + 1e-6
                    assert opacity == pytest.approx(1 - 0.8 * distance / (spacing / 2), abs=1e-3)
                    found.add(source)
            assert len(found) == 400
            before = png.pixels(await client.request_frame(**SIZE))
            await client.request("key", key="y")
            assert png.pixels(await client.request_frame(**SIZE)) != before
            await client.request("undo")
            assert png.pixels(await client.request_frame(**SIZE)) == before
            with pytest.raises(Refused, match="no cells"):
                await client.request("set", hidden=[0])
            await client.request("command", line="polytope 24-cell")
            await client.request("command", line="polytope torus")
            assert (await client.request("get", what="state"))["polytope"]["name"] == "torus"


@pytest.mark.parametrize("data", ["0 0 0 0", "0 0 0 0 0.5\n0 0 0 0 0.2"])
async def test_points_at_the_origin_are_shown(server, data):
    async with Client(server, stream="none") as client:
        await client.request("load", name="c", format="cloud", data=data)
        slices = (await client.request("get", what="slices", **SIZE))["slices"]
        assert [one["w"] for one in slices if one["vertices"]] == [0]
        await client.request("rotate", planes=["xw"], angles=[0.3])
        shown = await client.request_frame(**SIZE)
        await client.request("set", shown={"balls": False})
        assert png.pixels(await client.request_frame(**SIZE)) != png.pixels(shown)


async def test_the_points_of_a_cloud_are_shown_without_balls_and_bars(server):
    async with Client(server, stream="none") as client:
        await client.request("load", name="c", format="cloud", data=torus_points(40)[0])
        await client.request("set", shown=dict.fromkeys(("faces", "bars", "balls", "coordinates", "labels"), False))
        before = png.pixels(await client.request_frame(**SIZE))
        await client.request("rotate", planes=["xy"], angles=[0.3])
        assert png.pixels(await client.request_frame(**SIZE)) != before


@pytest.mark.parametrize("data, message", [
    ("", "the file is empty"), ("1 2 3", "line 1: a point has 3 coordinates"),
    ("1 0 0 0\n1 2 x 4", "line 2"), ("1 2 3 4 -1", "radius is negative"), ("1 2 3 4 5 6", "follows a point's radius"),
    ("1 2 3 1e300", "line 1"),
])
async def test_invalid_clouds_are_refused(data, message):
    with Server() as server:
        async with Client(server, stream="none") as client:
            with pytest.raises(Refused, match=message) as refused:
                await client.request("load", name="c", format="cloud", data=data)
            assert refused.value.code == "bad_polytope"
            assert (await client.request("get", what="state"))["polytope"]["name"] == "5-cell"


def test_the_command_line_renders_a_cloud(tmp_path):
    text, _ = torus_points(200)
    cloud, hull = tmp_path / "cloud.txt", tmp_path / "hull.txt"
    cloud.write_text("CLOUD\n" + text)
    hull.write_text(text)
    pictures = []
    for file in (cloud, hull):
        picture = tmp_path / "picture.png"
        done = run_oval4d("render", "-o", picture, "--load", file, "--width", 480, "--height", 270)
        assert done.returncode == 0, done.stderr
        pictures.append(png.pixels(picture.read_bytes()))
    assert pictures[0] != pictures[1]


async def test_a_cloud_is_restored_from_the_store(tmp_path):
    text, _ = torus_points(50)
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as server:
        async with Client(server, stream="none") as client:
            await client.request("load", name="torus", format="cloud", data=text + "\n0.5 0.5 0.5 0.5 0.2")
            picture = png.pixels(await client.request_frame(**SIZE))
            welcome = client.welcome
        server.stop()
    with Server("--store", store) as server:
        async with Client(server, stream="none", session=welcome["session"], token=welcome["token"]) as client:
            assert png.pixels(await client.request_frame(**SIZE)) == picture


@pytest.mark.parametrize("points", ["0 0 0 0\n", "0 0 0 0\n1 0 0 0\n", "1 0 0 0.5\n0 1 0 0\n"])
def test_a_cloud_has_no_solid(tmp_path, points):
    (tmp_path / "points.txt").write_text("CLOUD\n" + points)
    done = run_oval4d("export", "--load", tmp_path / "points.txt", "--format", "stl", "-o", "-")
    assert done.returncode != 0 and b"points have no volume; choose body=skeleton" in done.stderr
    done = run_oval4d("export", "--load", tmp_path / "points.txt", "--format", "stl", "-o", "-", "--body", "skeleton")
    assert done.returncode == 0, done.stderr
