"""Frames are complete PNG files that contain the state; all ways to request one give the same pixels."""

import png
import pytest
from harness import run_oval4d
from wire import Client

SIZE = {"width": 480, "height": 270}
QUERY = "polytope=24-cell&rotate=xw,yz:pi/8,pi/sqrt(3)-pi/8&rotate=xy:0.2&width=480&height=270"


async def test_a_frame_is_a_png_that_contains_its_state(server):
    async with Client(server, stream="frames", **SIZE) as client:
        frame = await client.wait_for_frame(0)
        names = [name for name, _ in png.chunks(frame)]
        assert names[:2] == ["IHDR", "iTXt"] and set(names[2:-1]) == {"IDAT"}
        state = png.state_in(frame)
        assert state == client.states()[0]
        size, colors = png.pixels(frame)
        assert size == (480, 270) and len(set(zip(*[iter(colors)] * 3))) > 200


async def test_a_key_changes_the_picture_and_undo_restores_it(server):
    async with Client(server, stream="frames", **SIZE) as client:
        first = await client.wait_for_frame(0)
        done = await client.request("key", key="r")
        second = await client.wait_for_frame(done["revision"])
        assert png.state_in(second)["revision"] == done["revision"]
        assert png.pixels(second) != png.pixels(first)
        done = await client.request("undo")
        assert png.pixels(await client.wait_for_frame(done["revision"])) == png.pixels(first)


async def test_frames_have_the_requested_size(server):
    async with Client(server, stream="frames", width=33, height=16) as client:
        assert png.pixels(await client.wait_for_frame(0))[0] == (33, 16)
        assert png.pixels(await client.request_frame(width=1001, height=700))[0] == (1001, 700)
        await client.request("hello", stream="frames")
        assert png.pixels(await client.request_frame())[0] == (1280, 720)


async def test_websocket_http_and_command_draw_the_same_picture(server, tmp_path):
    async with Client(server, stream="none", **SIZE) as client:
        await client.request("set", polytope="24-cell")
        await client.request("command", line="rotate xw,yz pi/8 pi/sqrt(3)-pi/8")
        await client.request("rotate", planes=["xy"], angles=[0.2])
        by_websocket = await client.request_frame()
    answer = server.get("/api/v1/frame.png?" + QUERY)
    assert answer.status == 200 and answer.getheader("Content-Type") == "image/png"
    file = tmp_path / "frame.png"
    done = run_oval4d("render", "--polytope", "24-cell", "--rotate", "xw,yz:pi/8,pi/sqrt(3)-pi/8", "--rotate=xy:0.2",
                      "--width", 480, "--height", 270, "-o", file)
    assert done.returncode == 0, done.stderr
    assert png.pixels(answer.body) == png.pixels(by_websocket)
    assert png.pixels(file.read_bytes()) == png.pixels(by_websocket)


async def test_a_picture_restores_the_state_of_a_session(server):
    state = png.state_in(server.get("/api/v1/frame.png?" + QUERY).body)
    async with Client(server, stream="none", **SIZE) as client:
        state.pop("type")
        await client.request("set", **state)
        again = await client.request_frame()
    assert png.pixels(again) == png.pixels(server.get("/api/v1/frame.png?" + QUERY).body)


@pytest.mark.parametrize("polytope", ["5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"])
def test_regular_polytopes_are_drawn(server, polytope):
    size, colors = png.pixels(server.get(f"/api/v1/frame.png?polytope={polytope}&width=320&height=180").body)
    assert size == (320, 180)
    background = colors[:3]
    drawn = sum(colors[i:i + 3] != background for i in range(0, len(colors), 3))
    assert drawn > 0.05 * 320 * 180


@pytest.mark.parametrize("query, code, expected_text", [
    ("width=0", "out_of_range", "16"), ("width=100000&height=100000", "out_of_range", "8192"),
    ("width=many", "out_of_range", "many"), ("polytope=25-cell", "unknown_polytope", "5-cell"),
    ("rotate=xw:1/0", "bad_expression", ""), ("rotate=xx:1", "", "xx"), ("color=red", "", "color"),
    ("slices=4", "out_of_range", "4"),
])
def test_an_invalid_query_gets_an_explanatory_error(server, query, code, expected_text):
    import json

    answer = server.get("/api/v1/frame.png?" + query)
    error = json.loads(answer.body)
    assert answer.status == 400 and error["type"] == "error"
    assert code in error["code"] and expected_text in error["message"]
