"""The thickness of balls and bars: the setting and its keys, both streams, and exported files."""

import json
from xml.etree import ElementTree

import png
import pytest
from exports import ROTATION, SVG, fetch_file
from wire import Client, Refused

SIZE = {"width": 640, "height": 360}


async def thickness_of(client):
    return (await client.request("get", what="state"))["thickness"]


async def test_keys_messages_and_commands_agree(server):
    async with Client(server, stream="none") as client:
        assert await thickness_of(client) == 1
        reached = {0: 1, 4: 2}
        for key, steps in zip(">><<>>>><", (1, 2, 1, 0, 1, 2, 3, 4, 3)):
            await client.request("key", key=key)
            thickness = await thickness_of(client)
            assert thickness == pytest.approx(2 ** (steps / 4))
            assert thickness == reached.setdefault(steps, thickness), "exactly the same number as before"
        await client.request("command", line=":set thickness=1/2")
        assert await thickness_of(client) == 0.5
        await client.request("undo")
        assert await thickness_of(client) == pytest.approx(2 ** 0.75)
        await client.request("set", thickness=3)
        await client.request("reset")
        await client.request("set", polytope="24-cell")
        assert await thickness_of(client) == 3, "it belongs to the view"
        assert "thickness=3" in (await client.request("get", what="address"))["query"].split("&")


@pytest.mark.parametrize("thickness", [0, 0.2, 4.1, -1, "2", True])
async def test_bad_values_are_refused(server, thickness):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused, match="from 0.25 to 4"):
            await client.request("set", thickness=thickness)
        with pytest.raises(Refused, match="the thickness must be from 0.25 to 4, not 9"):
            await client.request("command", line=":set thickness=9")
        assert await thickness_of(client) == 1
    answer = server.get("/api/v1/frame.png?thickness=0.2")
    assert answer.status == 400 and "the thickness must be from 0.25 to 4" in json.loads(answer.body)["message"]


async def test_both_streams_have_it(server):
    async with Client(server, stream="none") as client:
        async def radii():
            """Returns the radii of balls and bars of slices and of the projection, in units of the polytope."""
            message = await client.request("get", what="slices", **SIZE)
            scene, projection = message["scene"], message["projection"]
            return [scene[one] / scene["scale"] for one in ("ball", "bar")] + [
                part[one] / projection["scale"] for part in projection["parts"] for one in ("ball", "bar")]

        await client.request("set", polytope="24-cell", projection="perspective", shown={"sections": True})
        plain, picture = await radii(), png.pixels(await client.request_frame(**SIZE))
        await client.request("set", thickness=2)
        assert await radii() == pytest.approx([2 * radius for radius in plain], rel=1e-4)
        thick = await client.request_frame(**SIZE)
        assert png.pixels(thick) != picture and png.state_in(thick)["thickness"] == 2
        await client.request("set", thickness=1)
        assert png.pixels(await client.request_frame(**SIZE)) == picture


@pytest.mark.parametrize("of, group", [("oval", "slice_0"), ("focus", "slice_0"), ("projection", "projection")])
def test_drawings_have_it(server, of, group):
    def relative_radius(thickness):
        """Returns the radius of the largest ball of the group, relative to the extent of the balls' centers."""
        query = f"polytope=tesseract&{ROTATION}&of={of}&thickness={thickness}"
        root = ElementTree.fromstring(fetch_file(server, "svg", query))
        balls = [ball for one in root.iter(SVG + "g") if one.get("id") == group for ball in one.iter(SVG + "circle")]
        across = [float(ball.get("cx")) for ball in balls]
        return max(float(ball.get("r")) for ball in balls) / (max(across) - min(across))

    plain = relative_radius(1)
    for thickness in (0.25, 2, 4):
        assert relative_radius(thickness) == pytest.approx(thickness * plain, rel=0.01)


def test_bodies_do_not_depend_on_it(server):
    query = "polytope=5-cell&of=oval&body=skeleton"
    assert fetch_file(server, "stl", f"{query}&thickness=4") == fetch_file(server, "stl", query)
