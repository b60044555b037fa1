"""The server's drawing processes: when one dies, no session is lost."""

import asyncio
import os
import re
import resource
import signal
import socket
import struct
import subprocess
from pathlib import Path

import png
import pytest
from harness import DEADLINE, PROGRAM, Server, sanitized, until, wait_for_end
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}
DEATHS = 'oval4d_drawing_losses_total{cause="died"}'
# A picture that takes so long to draw that a test can interrupt it.
LONG = {"polytope": "omnitruncated 120-cell", "slices": {"count": 101}}
LARGE = {"width": 2400, "height": 1350}


class Ignoring(Server):
    """A server started by a program that ignores SIGCHLD, a setting that child processes inherit."""

    def start(self, words, environment):
        before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
        try:
            return super().start(words, environment)
        finally:
            signal.signal(signal.SIGCHLD, before)


def seconds_of(pid):
    """Returns the CPU time of a process in seconds."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def signal_the_one_at_work(server, number):
    """Sends a signal to the process that is drawing, and returns its ID. It may have finished by then."""
    started = {pid: seconds_of(pid) for pid in server.drawing()}
    while True:
        for pid, seconds in started.items():
            if seconds_of(pid) > seconds + 0.02:
                os.kill(pid, number)
                return pid
        await asyncio.sleep(0.002)


async def test_pictures_go_on_when_the_processes_that_draw_them_are_killed():
    with Server() as server:
        async with Client(server, stream="frames", **SIZE) as client:
            first = await client.frame_of(0)
            done = await client.request("key", key="r")
            await client.frame_of(done["revision"])
            assert server.metric(DEATHS) == 0
            assert len(server.signal_drawing(signal.SIGKILL)) >= 2
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
            while server.metric(DEATHS) == 0:
                asked = asyncio.ensure_future(client.frame(**LARGE))
                await signal_the_one_at_work(server, signal.SIGKILL)
                assert png.pixels(await asked) == png.pixels(whole)


async def test_a_picture_that_kills_its_process_again_and_again_is_refused_and_the_session_goes_on():
    server = Server()
    try:
        async with Client(server, stream="none", **SIZE) as client:
            before = await client.frame()
            await client.request("set", **LONG)
            asked = asyncio.ensure_future(client.frame(**LARGE))
            while not asked.done():
                server.signal_drawing(signal.SIGKILL)
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
        server.signal_drawing(signal.SIGTERM)  # a terminal or a container sends these to all processes
        server.signal_drawing(signal.SIGINT)
        async with Client(server, stream="none", **SIZE) as client:
            await client.frame()
        assert server.drawing() == pids and server.metric(DEATHS) == 0
        server.kill()
        wait_for_end(pids)
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
    """A restarted drawing process inherits none of the server's file descriptors."""
    with Server() as server:
        async with Client(server, stream="frames", **SIZE) as client:
            await client.frame_of(0)
            server.signal_drawing(signal.SIGKILL)
            done = await client.request("key", key="r")
            await client.frame_of(done["revision"])
            for pid in server.drawing():
                files = [os.readlink(file) for file in Path(f"/proc/{pid}/fd").iterdir()]
                assert sum(name.startswith("socket:") for name in files) == 1, files


async def test_one_that_has_no_room_for_a_picture_draws_none(tmp_path):
    """The kernel drops a file descriptor that is sent to a process whose limit on open files is reached; the process
    then ends with an error."""
    ours, theirs = socket.socketpair()
    with ours, theirs, open(tmp_path / "log", "wb") as log:
        drawing = subprocess.Popen([PROGRAM, "draw"], stderr=log, preexec_fn=lambda: os.dup2(theirs.fileno(), 3),
                                   pass_fds=[3])
        ours.settimeout(DEADLINE)
        assert struct.unpack("=I4xQ", ours.recv(16)) == (0, 0)  # the process reports that it is ready
        ours.sendall(struct.pack("=I4xQ", 1, 0))  # a draw request without its contents and without the shared memory
        assert drawing.wait(DEADLINE) == 1
    assert b"a draw request arrived without the memory to draw into" in (tmp_path / "log").read_bytes()


@pytest.mark.skipif(sanitized(), reason="sanitizers open files, too")
@pytest.mark.parametrize("files", range(8, 20, 3))
def test_a_server_that_may_open_too_few_files_says_so(files, tmp_path):
    def limit():
        resource.setrlimit(resource.RLIMIT_NOFILE, (files, files))

    with open(tmp_path / "log", "wb") as log:
        words = [PROGRAM, "--port", "0", "--workers", "4"]
        server = subprocess.Popen(words, stderr=log, preexec_fn=limit)
    until(lambda: server.poll() is not None or re.search("ready|cannot be drawn", (tmp_path / "log").read_text()), "it")
    server.terminate()
    assert server.wait(DEADLINE) in (0, 1)
    assert "Too many open files" in (tmp_path / "log").read_text()


async def test_their_ends_are_seen_though_whoever_began_the_server_ignored_such():
    with Ignoring() as server:
        async with Client(server, stream="none", **SIZE) as client:
            await client.frame()
            server.signal_drawing(signal.SIGKILL)
            await client.frame()
        assert 'how="died: signal 9"' in server.log()
