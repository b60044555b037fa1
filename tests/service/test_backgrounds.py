"""Backgrounds of pictures: for all clients of a session, for one of them, and for one picture."""

import io
import json

import pytest
from PIL import Image
from harness import run_oval4d
from png import pixels, state_in
from wire import Client

GROUNDS = {"dark": 0x10141C, "light": 0xF4F6F9, "white": 0xFFFFFF}
SIZE = {"width": 160, "height": 90}


def corner(png):
    """The color of the pixel in the upper left corner, where no slice is; it has an opacity if the picture has one."""
    return Image.open(io.BytesIO(png)).getpixel((0, 0))


def rgb(color):
    return color >> 16, color >> 8 & 255, color & 255


@pytest.mark.parametrize("background, ground", [*GROUNDS.items(), ("auto", GROUNDS["dark"])])
def test_a_query_chooses_the_background(server, background, ground):
    png = server.get(f"/api/v1/frame.png?background={background}&width=160&height=90").body
    assert corner(png) == rgb(ground)
    assert state_in(png)["background"] == background


def test_a_transparent_picture_has_alpha_and_the_colors_of_a_white_one(server):
    query = "/api/v1/frame.png?polytope=24-cell&rotate=xw:0.3&width=320&height=180&background="
    clear = Image.open(io.BytesIO(server.get(query + "transparent").body))
    assert clear.mode == "RGBA" and clear.getpixel((0, 0))[3] == 0
    paper = Image.new("RGBA", clear.size, "white")
    paper.alpha_composite(clear)
    white = pixels(server.get(query + "white").body)[1]
    composed = paper.convert("RGB").tobytes()
    assert max(abs(a - b) for a, b in zip(composed, white)) <= 8


def test_an_unknown_background_is_explained(server):
    answer = server.get("/api/v1/frame.png?background=black")
    assert answer.status == 400
    assert "auto, dark, light, white or transparent" in json.loads(answer.body)["message"]


async def test_each_client_sees_its_scheme_until_the_session_has_a_background(server):
    async with Client(server, stream="geometry") as dark:
        session, token = dark.welcome["session"], dark.welcome["token"]
        async with Client(server, session, stream="geometry", token=token, scheme="light") as light:
            def seen(client, message):
                colors = message["scene"]["colors"]
                state = client.states()[-1]
                return colors["background"], colors["cells"], state["polytope"]["kinds"][0]["color"]

            first = await dark.wait_for_slices(0), await light.wait_for_slices(0)
            (ground, cells, kind), (pale, deep, other) = seen(dark, first[0]), seen(light, first[1])
            assert (ground, pale) == (GROUNDS["dark"], GROUNDS["light"])
            assert all(a != b for a, b in zip(cells, deep)) and kind != other
            assert [client.states()[-1]["background"] for client in (dark, light)] == ["auto", "auto"]
            done = await dark.request("set", background="white")
            both = [seen(client, await client.wait_for_slices(done["revision"])) for client in (dark, light)]
            assert both[0] == both[1] and both[0][0] == GROUNDS["white"]
            await light.request("undo")
            assert (await dark.request("get", what="state"))["background"] == "auto"
            await light.request("command", line=":set background=dark")
            assert corner(await light.request_frame(**SIZE)) == rgb(GROUNDS["dark"])


async def test_one_picture_may_have_another_background(server):
    async with Client(server, stream="none", scheme="light", **SIZE) as client:
        for choice in ({}, {"background": "auto"}):
            own = await client.request_frame(**choice)
            assert corner(own) == rgb(GROUNDS["light"]) and state_in(own)["background"] == "auto"
        white = await client.request_frame(background="white")
        assert corner(white) == rgb(GROUNDS["white"]) and state_in(white)["background"] == "white"
        assert corner(await client.request_frame(background="transparent"))[3] == 0
        slices = await client.request("get", what="slices", background="dark")
        assert slices["scene"]["colors"]["background"] == GROUNDS["dark"]
        state = await client.request("get", what="state")
        assert (state["background"], state["revision"]) == ("auto", 0)


def test_the_command_line_draws_every_background(tmp_path):
    file = tmp_path / "clear.png"
    done = run_oval4d("render", "--background", "transparent", "--width", 160, "--height", 90, "-o", file)
    assert done.returncode == 0, done.stderr
    assert corner(file.read_bytes())[3] == 0
