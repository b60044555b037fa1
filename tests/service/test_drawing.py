"""The processes that draw for a server: whatever becomes of one, no session is lost."""

import asyncio
import os
import signal
from pathlib import Path

import png
import pytest
from harness import Server
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}
DEATHS = "oval4d_drawing_deaths_total"
# A picture that takes long enough to be met in the making.
LONG = {"polytope": "omnitruncated 120-cell", "slices": {"count": 101}}
LARGE = {"width": 2400, "height": 1350}


def has_ended(pid):
    """Also where nobody has asked for its status."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(") ", 1)[1].startswith("Z")
    except FileNotFoundError:
        return True


def kill_all(server, number=signal.SIGKILL):
    pids = server.drawing()
    for pid in pids:
        os.kill(pid, number)
    return len(pids)


async def test_pictures_go_on_when_the_processes_that_draw_them_are_killed():
    with Server() as server:
        async with Client(server, stream="frames", **SIZE) as client:
            first = await client.frame_of(0)
            done = await client.request("key", key="r")
            await client.frame_of(done["revision"])
            assert server.metric(DEATHS) == 0
            assert kill_all(server) >= 2
            done = await client.request("undo")
            again = await client.frame_of(done["revision"])
            assert png.pixels(again) == png.pixels(first)
            assert png.state_in(again)["revision"] == done["revision"]
            assert server.metric(DEATHS) >= 1


async def test_a_picture_is_drawn_again_when_its_process_is_killed_at_it():
    with Server() as server:
        async with Client(server, stream="none", **SIZE) as client:
            await client.request("set", **LONG)
            whole = await client.frame(**LARGE)
            asked = asyncio.ensure_future(client.frame(**LARGE))
            await asyncio.sleep(0.1)
            assert not asked.done() and kill_all(server) >= 1
            assert png.pixels(await asked) == png.pixels(whole)
            assert server.metric(DEATHS) >= 1


async def test_a_picture_that_kills_its_process_again_and_again_is_refused_and_the_session_goes_on():
    server = Server()
    try:
        async with Client(server, stream="none", **SIZE) as client:
            before = await client.frame()
            await client.request("set", **LONG)
            asked = asyncio.ensure_future(client.frame(**LARGE))
            while not asked.done():
                kill_all(server)
                await asyncio.sleep(0.02)
            with pytest.raises(Refused, match="internal"):
                await asked
            await client.request("undo")
            assert png.pixels(await client.frame()) == png.pixels(before)
        assert server.stop()[0] == 0
    finally:
        server.kill()


async def test_they_end_with_the_server_and_not_before():
    server = Server()
    try:
        pids = server.drawing()
        assert len(pids) >= 2
        kill_all(server, signal.SIGTERM)  # as a terminal or a container sends it to all
        kill_all(server, signal.SIGINT)
        async with Client(server, stream="none", **SIZE) as client:
            await client.frame()
        assert server.drawing() == pids and server.metric(DEATHS) == 0
        server.kill()
        for _ in range(500):
            if all(map(has_ended, pids)):
                break
            await asyncio.sleep(0.02)
        assert all(map(has_ended, pids))
    finally:
        server.kill()


async def test_polytopes_in_turns_though_none_is_kept(server):
    names = ["5-cell", "24-cell", "{5/2,3,5}"]
    with Server("--polytope-cache", 0) as forgetful:
        async with Client(forgetful, stream="none", **SIZE) as client, Client(server, stream="none", **SIZE) as other:
            for name in names + names:
                await client.request("set", polytope=name)
                await other.request("set", polytope=name)
                assert png.pixels(await client.frame()) == png.pixels(await other.frame())


async def test_sizes_in_turns(server):
    async with Client(server, stream="none") as client:
        first = {}
        for width, height in [(64, 48), (1920, 1080), (64, 48), (300, 200), (1920, 1080), (64, 48)]:
            pixels = png.pixels(await client.frame(width=width, height=height))
            assert pixels == first.setdefault((width, height), pixels) and pixels[0] == (width, height)


async def test_no_connection_is_kept_open_by_them():
    """A process that is started anew has none of the server's files."""
    with Server() as server:
        async with Client(server, stream="frames", **SIZE) as client:
            await client.frame_of(0)
            kill_all(server)
            done = await client.request("key", key="r")
            await client.frame_of(done["revision"])
            for pid in server.drawing():
                files = [os.readlink(file) for file in Path(f"/proc/{pid}/fd").iterdir()]
                assert sum(name.startswith("socket:") for name in files) == 1, files
