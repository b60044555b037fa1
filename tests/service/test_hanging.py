"""Processes that draw, and hang: nobody waits for one for long, no session is lost, and nothing is left of it."""

import asyncio
import contextlib
import ctypes
import os
import random
import signal
import threading
from pathlib import Path

import png
import pytest
from harness import SLOW, Server, has_ended, until, wait_for_end
from test_drawing import DEATHS, LARGE, LONG, SIZE, signal_the_one_at_work
from wire import Client, Refused

TIMEOUT = max(2, round(0.8 * SLOW))  # a process begins within it, however busy the machine
PTRACE_SEIZE = 0x4206
HANGS = 'oval4d_drawing_losses_total{cause="hung"}'


class Stopping(Server):
    """A server whose processes that draw are stopped when they are seen, while `stops` is set."""

    def start(self, words, environment):
        self.stops, self.seen, self.over = threading.Event(), set(), False
        self.process = super().start(words, environment)
        self.stopper = threading.Thread(target=self.stop_them)
        self.stopper.start()
        return self.process

    def stop_them(self):
        while not self.over:
            if self.stops.wait(0.1):
                self.seen.update(self.signal_drawing(signal.SIGSTOP))

    def close(self):
        self.over = True
        self.stopper.join()
        self.kill()


class StoppingAtFirst(Stopping):
    """The first of them are stopped as they begin."""

    def stop_them(self):
        while len(self.seen) < 3 and not self.over:
            self.seen.update(self.signal_drawing(signal.SIGSTOP))


async def test_a_process_that_is_stopped_between_pictures_is_replaced():
    with Server("--draw-timeout", TIMEOUT) as server:
        async with Client(server, stream="frames", **SIZE) as client:
            first = await client.frame_of(0)
            done = await client.request("key", key="r")
            await client.frame_of(done["revision"])
            stopped = server.signal_drawing(signal.SIGSTOP)
            done = await client.request("undo")
            again = await client.frame_of(done["revision"])
            assert png.pixels(again) == png.pixels(first)
            assert png.state_in(again)["revision"] == done["revision"]
            assert server.metric(HANGS) >= 1 and server.metric(DEATHS) == 0
            assert f"hung: no answer in {TIMEOUT} s" in server.log()
            assert len(server.drawing()) == len(stopped) and any(map(has_ended, stopped))
        server.signal_drawing(signal.SIGCONT)


async def test_one_that_hangs_holds_up_nobody_else_and_its_picture_comes():
    with Server("--draw-timeout", 3 * TIMEOUT) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            await client.request("set", **LONG)
            whole = await client.frame(**LARGE)
            while True:
                asked = asyncio.ensure_future(client.frame(**LARGE))
                pid = await signal_the_one_at_work(server, signal.SIGSTOP)
                await asyncio.wait([asked], timeout=0.3 * SLOW)
                if not asked.done():
                    break
                os.kill(pid, signal.SIGCONT)  # it had drawn already
            for _ in range(5):
                await other.request("key", key="r")
                await other.frame(**SIZE)
            assert not asked.done()
            assert png.pixels(await asked) == png.pixels(whole)
            assert server.metric(HANGS) == 1 and server.metric(DEATHS) == 0 and has_ended(pid)


async def test_a_picture_at_which_two_hang_is_refused_and_the_session_goes_on():
    with contextlib.closing(Stopping("--draw-timeout", TIMEOUT)) as server:
        async with Client(server, stream="none") as client:
            before = await client.frame(**SIZE)
            await client.request("key", key="r")
            server.signal_drawing(signal.SIGSTOP)
            server.stops.set()
            with pytest.raises(Refused, match="internal"):
                await client.frame(**SIZE)
            server.stops.clear()
            server.signal_drawing(signal.SIGCONT)
            assert server.metric(HANGS) >= 2 and server.metric(DEATHS) == 0
            assert 'fault="two processes were lost in a row, the second hung' in server.log()
            await client.request("undo")
            assert png.pixels(await client.frame(**SIZE)) == png.pixels(before)
        assert server.stop()[0] == 0
        wait_for_end(server.seen)


async def test_processes_that_hang_as_they_begin_are_replaced():
    with contextlib.closing(StoppingAtFirst("--draw-timeout", TIMEOUT)) as server:
        assert server.metric(HANGS) >= 1 and server.metric(DEATHS) == 0
        async with Client(server, stream="none") as client:
            await client.frame(**SIZE)
        assert server.stop()[0] == 0
        wait_for_end(server.seen)


@pytest.mark.parametrize("drawing", [True, False])
async def test_a_server_that_is_to_stop_waits_for_none(drawing):
    with Server("--draw-timeout", 1000, "--stop-timeout", 0.5) as server:
        async with Client(server, stream="none") as client:
            pids = server.signal_drawing(signal.SIGSTOP)
            if drawing:
                received = server.metric("oval4d_messages_received_total")
                await client.send("get", what="frame")
                until(lambda: server.metric("oval4d_messages_received_total") > received, "the request")
                await asyncio.sleep(0.1)
            status, _ = await asyncio.get_running_loop().run_in_executor(None, server.stop)
        assert status == 0 and "stopped" in server.log()
        wait_for_end(pids)


async def test_they_end_with_a_server_that_is_killed_though_they_hang():
    server = Server()
    try:
        pids = server.signal_drawing(signal.SIGSTOP)
        assert pids
    finally:
        server.kill()
    wait_for_end(pids)


async def test_one_that_does_not_end_though_it_is_killed_is_not_waited_for():
    """The system lets a process that is traced go only when its tracer has seen its end."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    with Server("--draw-timeout", TIMEOUT) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            before = await client.frame(**SIZE)
            traced = server.drawing()
            for pid in traced:
                assert libc.ptrace(PTRACE_SEIZE, pid, None, None) == 0, os.strerror(ctypes.get_errno())
                os.kill(pid, signal.SIGSTOP)
            assert png.pixels(await client.frame(**SIZE)) == png.pixels(before)
            killed = set(traced) - set(server.drawing())
            assert killed and server.metric(HANGS) == len(killed)
            server.signal_drawing(signal.SIGKILL)
            for pid in traced:
                assert os.WTERMSIG(os.waitpid(pid, 0)[1]) == signal.SIGKILL
            assert all(Path(f"/proc/{pid}").exists() for pid in killed)
            while any(Path(f"/proc/{pid}").exists() for pid in killed):  # until others begin in their places
                server.signal_drawing(signal.SIGKILL)
                await asyncio.gather(client.frame(**SIZE), other.frame(**SIZE))


async def picture(client):
    """Asked for until it comes: it is refused where two hang or die at it."""
    while True:
        try:
            return png.pixels(await client.frame(**SIZE))
        except Refused as refusal:
            assert refusal.code == "internal"


async def test_nothing_is_lost_or_left_whatever_befalls_them():
    """Processes are stopped and killed at any moment, also while they are told a polytope that they do not have."""
    names = ["120-cell", "omnitruncated 24-cell", "600-cell", "omnitruncated tesseract"]
    chance = random.Random(4)
    # Not `with Server(…)`: its log may have refusals.
    harmed = contextlib.closing(Stopping("--draw-timeout", TIMEOUT, "--polytope-cache", 0))
    with harmed as server, Server() as other:
        async with Client(server, stream="none") as client, Client(other, stream="none") as unharmed:
            await client.frame(**SIZE)
            usual = len(server.files()), len(server.drawing())
            for name in names if SLOW > 1 else names * 2:
                await client.request("set", polytope=name)
                await unharmed.request("set", polytope=name)
                asked = asyncio.ensure_future(picture(client))
                await asyncio.sleep(chance.uniform(0, 0.04))
                server.signal_drawing(chance.choice([signal.SIGSTOP, signal.SIGKILL]))
                assert await asked == await picture(unharmed)
            await picture(client)
            assert server.metric(HANGS) + server.metric(DEATHS) >= len(names) / 2  # some are met twice
            until(lambda: len(server.files()) == usual[0], "as many open files as before")
            assert len(server.drawing()) <= usual[1]
        server.signal_drawing(signal.SIGCONT)
