"""The server's drawing processes: when one dies, no session is lost."""

import asyncio
import os
import resource
import signal
import socket
import struct
import subprocess
from pathlib import Path

import png
import pytest
from harness import DEADLINE, PROGRAM, Server, cpu_seconds, is_sanitizer_build, wait_until, wait_for_processes_to_end
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}
DEATHS = 'oval4d_drawing_losses_total{cause="died"}'
# A picture that takes so long to draw that a test can interrupt the drawing.
LONG = {"polytope": "omnitruncated 120-cell", "slices": {"count": 101}}
LARGE = {"width": 2400, "height": 1350}


class ServerIgnoringSigchld(Server):
    """A server started by a program that ignores SIGCHLD, a setting that child processes inherit."""

    def start(self, command, environment):
        before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
        try:
            return super().start(command, environment)
        finally:
            signal.signal(signal.SIGCHLD, before)


async def signal_busy_drawing_process(server, number, asked):
    """Sends a signal to the process that draws the picture of the task `asked`, and may have finished by then; returns
    its process ID. Returns None if the task ends before a process is seen to be busy."""
    started = {pid: cpu_seconds(pid) for pid in server.drawing_processes()}
    while not asked.done():
        for pid, seconds in started.items():
            if cpu_seconds(pid) > seconds + 0.02:
                os.kill(pid, number)
                return pid
        await asyncio.sleep(0.002)
    return None


async def test_pictures_continue_after_drawing_processes_are_killed():
    with Server() as server:
        async with Client(server, stream="frames", **SIZE) as client:
            first = await client.wait_for_frame(0)
            done = await client.request("key", key="r")
            await client.wait_for_frame(done["revision"])
            assert server.metric(DEATHS) == 0
            killed = server.signal_drawing_processes(signal.SIGKILL)
            assert len(killed) >= 2
            wait_for_processes_to_end(killed)
            done = await client.request("undo")
            again = await client.wait_for_frame(done["revision"])
            assert png.pixels(again) == png.pixels(first)
            assert png.state_in(again)["revision"] == done["revision"]
            assert server.metric(DEATHS) >= 1


async def test_a_picture_is_drawn_again_if_its_process_is_killed():
    with Server() as server:
        async with Client(server, stream="none", **SIZE) as client:
            await client.request("set", **LONG)
            whole = await client.request_frame(**LARGE)
            while server.metric(DEATHS) == 0:
                asked = asyncio.ensure_future(client.request_frame(**LARGE))
                await signal_busy_drawing_process(server, signal.SIGKILL, asked)
                assert png.pixels(await asked) == png.pixels(whole)


async def test_a_picture_whose_processes_keep_dying_is_refused():
    server = Server()
    try:
        async with Client(server, stream="none", **SIZE) as client:
            before = await client.request_frame()
            await client.request("set", **LONG)
            with pytest.raises(Refused, match="internal"):
                while True:  # until a process is killed before it has finished
                    asked = asyncio.ensure_future(client.request_frame(**LARGE))
                    while not asked.done():
                        server.signal_drawing_processes(signal.SIGKILL)
                        await asyncio.sleep(0.02)
                    await asked
            await client.request("undo")
            assert png.pixels(await client.request_frame()) == png.pixels(before)
        assert server.stop()[0] == 0
    finally:
        server.kill()


async def test_drawing_processes_end_only_with_the_server():
    server = Server()
    try:
        pids = server.drawing_processes()
        assert len(pids) >= 2
        server.signal_drawing_processes(signal.SIGTERM)  # terminals and containers send these signals to all processes
        server.signal_drawing_processes(signal.SIGINT)
        async with Client(server, stream="none", **SIZE) as client:
            await client.request_frame()
        assert set(server.drawing_processes()) == set(pids) and server.metric(DEATHS) == 0
        server.kill()
        wait_for_processes_to_end(pids)
    finally:
        server.kill()


async def test_pictures_are_the_same_without_a_polytope_cache(server):
    names = ["5-cell", "24-cell", "{5/2,3,5}"]
    with Server("--polytope-cache", 0) as forgetful:
        async with Client(forgetful, stream="none", **SIZE) as client, Client(server, stream="none", **SIZE) as other:
            for name in names + names:
                await client.request("set", polytope=name)
                await other.request("set", polytope=name)
                assert png.pixels(await client.request_frame()) == png.pixels(await other.request_frame())


async def test_pictures_are_the_same_after_changes_of_size(server):
    async with Client(server, stream="none") as client:
        first = {}
        for width, height in [(64, 48), (1920, 1080), (64, 48), (300, 200), (1920, 1080), (64, 48)]:
            pixels = png.pixels(await client.request_frame(width=width, height=height))
            assert pixels == first.setdefault((width, height), pixels) and pixels[0] == (width, height)


async def test_drawing_processes_inherit_no_connections():
    """A restarted drawing process inherits none of the server's file descriptors."""
    with Server() as server:
        async with Client(server, stream="frames", **SIZE) as client:
            await client.wait_for_frame(0)
            wait_for_processes_to_end(server.signal_drawing_processes(signal.SIGKILL))
            done = await client.request("key", key="r")
            await client.wait_for_frame(done["revision"])
            for pid in server.drawing_processes():
                files = [os.readlink(file) for file in Path(f"/proc/{pid}/fd").iterdir()]
                assert sum(name.startswith("socket:") for name in files) == 1, files


async def test_a_drawing_process_without_shared_memory_ends_with_an_error(tmp_path):
    """The kernel drops a file descriptor that is sent to a process whose limit on open files is reached; the process
    then ends with an error."""
    ours, theirs = socket.socketpair()
    with ours, theirs, open(tmp_path / "log", "wb") as log:
        drawing = subprocess.Popen([PROGRAM, "draw"], stderr=log, preexec_fn=lambda: os.dup2(theirs.fileno(), 3),
                                   pass_fds=[3])
        ours.settimeout(DEADLINE)
        assert struct.unpack("=I4xQ", ours.recv(16)) == (0, 0)  # the process is ready
        ours.sendall(struct.pack("=I4xQ", 1, 0))  # a draw request without contents and without shared memory
        assert drawing.wait(DEADLINE) == 1
    assert b"a draw request arrived without the memory to draw into" in (tmp_path / "log").read_bytes()


@pytest.mark.skipif(is_sanitizer_build(), reason="sanitizers open files of their own")
@pytest.mark.parametrize("files", [8, 11, 14, 16])  # when idle, the server with four workers has 17 open files
def test_a_too_low_limit_on_open_files_is_reported(files, tmp_path):
    def limit_open_files():
        resource.setrlimit(resource.RLIMIT_NOFILE, (files, files))

    with open(tmp_path / "log", "wb") as log:
        command = [PROGRAM, "--port", "0", "--workers", "4"]
        server = subprocess.Popen(command, stderr=log, preexec_fn=limit_open_files)
    reports = lambda: "Too many open files" in (tmp_path / "log").read_text(encoding="utf-8")
    wait_until(lambda: server.poll() is not None or reports(), "the report or the end of the server")
    server.terminate()
    # A server that does not handle signals yet, or no longer, is ended by the signal itself.
    assert server.wait(DEADLINE) in (0, 1, -signal.SIGTERM)
    assert reports()


async def test_child_exits_are_noticed_even_if_the_parent_ignored_sigchld():
    with ServerIgnoringSigchld() as server:
        async with Client(server, stream="none", **SIZE) as client:
            await client.request_frame()
            wait_for_processes_to_end(server.signal_drawing_processes(signal.SIGKILL))
            await client.request_frame()
        assert 'how="died: signal 9"' in server.log()
