"""The opacity of translucent faces: the setting and its keys, both streams, and drawings."""

import json
from xml.etree import ElementTree

import png
import pytest
from exports import ROTATION, SVG, fetch_file
from wire import Client, Refused

SIZE = {"width": 640, "height": 360}
ON_DARK, ON_WHITE = 0.46, 0.55  # opacities of the faces of slices, as in protocol/colors.json


async def opacity_of(client):
    return (await client.request("get", what="state"))["opacity"]


async def test_keys_messages_and_commands_agree(server):
    async with Client(server, stream="none") as client:
        assert await opacity_of(client) == 1
        for key, steps in zip("DDddd", (1, 2, 1, 0, -1)):
            await client.request("key", key=key)
            assert await opacity_of(client) == pytest.approx(2 ** (steps / 4))
        await client.request("command", line=":set opacity=1/2")
        assert await opacity_of(client) == 0.5
        await client.request("undo")
        assert await opacity_of(client) == pytest.approx(2 ** -0.25)
        await client.request("set", opacity=3)
        await client.request("reset")
        await client.request("set", polytope="24-cell")
        assert await opacity_of(client) == 3, "it belongs to the view"
        assert "opacity=3" in (await client.request("get", what="address"))["query"].split("&")


@pytest.mark.parametrize("opacity", [0, 0.2, 4.1, -1, "2", True])
async def test_bad_values_are_refused(server, opacity):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused, match="from 0.25 to 4"):
            await client.request("set", opacity=opacity)
        with pytest.raises(Refused, match="the opacity must be from 0.25 to 4, not 9"):
            await client.request("command", line=":set opacity=9")
        assert await opacity_of(client) == 1
    answer = server.get("/api/v1/frame.png?opacity=0.2")
    assert answer.status == 400 and "the opacity must be from 0.25 to 4" in json.loads(answer.body)["message"]


async def test_both_streams_have_it(server):
    async with Client(server, stream="none") as client:
        async def opacities():
            """Returns the opacities of the faces of slices, of the whole polytope and of its section."""
            message = await client.request("get", what="slices", **SIZE)
            return [message["scene"]["opacity"], *(part["opacity"] for part in message["projection"]["parts"])]

        await client.request("set", polytope="24-cell", projection="perspective", shown={"cells": True})
        plain, picture = await opacities(), png.pixels(await client.request_frame(**SIZE))
        assert plain == pytest.approx([ON_DARK, 0.25, 0.5])
        pictures = [picture]
        for opacity in (0.5, 1.5, 4):
            await client.request("set", opacity=opacity)
            found = await opacities()
            assert found == pytest.approx([min(opacity * each, 1) for each in plain], abs=0.002)
            assert max(found) < 1, "1 means that faces may cross each other"
            frame = await client.request_frame(**SIZE)
            assert png.pixels(frame) not in pictures and png.state_in(frame)["opacity"] == opacity
            pictures.append(png.pixels(frame))
        await client.request("set", opacity=1)
        assert png.pixels(await client.request_frame(**SIZE)) == picture


@pytest.mark.parametrize("polytope, changes", [("24-cell", True), ("small stellated 120-cell", False)])
async def test_only_translucent_faces_have_it(server, polytope, changes):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope=polytope, view="single", shown={"labels": False})
        picture = png.pixels(await client.request_frame(**SIZE))
        await client.request("set", opacity=0.5)
        assert (png.pixels(await client.request_frame(**SIZE)) != picture) == changes
        scene = (await client.request("get", what="slices", **SIZE))["scene"]
        assert scene["opacity"] == pytest.approx(0.5 * ON_DARK if changes else 1)


@pytest.mark.parametrize("of, plain", [("oval", ON_WHITE), ("focus", ON_WHITE), ("projection", 0.5)])
def test_drawings_have_it(server, of, plain):
    for opacity in (0.25, 1, 1.5, 4):
        query = f"polytope=tesseract&{ROTATION}&of={of}&opacity={opacity}"
        root = ElementTree.fromstring(fetch_file(server, "svg", query))
        # Opaque shapes, such as the tips of the axes, have no attribute for the opacity.
        found = {float(one.get("fill-opacity")) for one in root.iter(SVG + "polygon") if one.get("fill-opacity")}
        assert len(found) == 1
        assert found.pop() == pytest.approx(min(opacity * plain, 1), abs=0.002)
