"""Drawing processes that hang: no client waits long for them, no session is lost, and they leave nothing behind."""

import asyncio
import concurrent.futures
import contextlib
import ctypes
import os
import random
import signal
import threading
from pathlib import Path

import png
import pytest
from harness import SLOW, Server, has_ended, wait_until, wait_for_processes_to_end
from test_drawing import DEATHS, LARGE, LONG, SIZE, signal_busy_drawing_process
from wire import Client, Refused

TIMEOUT = max(2, round(0.8 * SLOW))  # seconds; enough for a process to start on a busy machine
PTRACE_SEIZE = 0x4206
HANGS = 'oval4d_drawing_losses_total{cause="hung"}'


class SuspendsDrawers(Server):
    """A server whose drawing processes are suspended (SIGSTOP) as soon as they appear, while `suspending` is set."""

    def start(self, command, environment):
        self.suspending, self.suspended, self.finished = threading.Event(), set(), False
        self.process = super().start(command, environment)
        self.suspender = threading.Thread(target=self.suspend_drawers)
        self.suspender.start()
        return self.process

    def suspend_drawers(self):
        while not self.finished:
            if self.suspending.wait(0.1):
                self.suspended.update(self.signal_drawing_processes(signal.SIGSTOP))

    def close(self):
        self.finished = True
        self.suspender.join()
        self.kill()


class SuspendsFirstDrawers(SuspendsDrawers):
    """Suspends the first drawing processes as soon as they appear."""

    def suspend_drawers(self):
        while len(self.suspended) < 3 and not self.finished:
            self.suspended.update(self.signal_drawing_processes(signal.SIGSTOP))


async def test_a_drawing_process_suspended_between_pictures_is_replaced():
    with Server("--draw-timeout", TIMEOUT) as server:
        async with Client(server, stream="frames", **SIZE) as client:
            first = await client.wait_for_frame(0)
            done = await client.request("key", key="r")
            await client.wait_for_frame(done["revision"])
            stopped = server.signal_drawing_processes(signal.SIGSTOP)
            done = await client.request("undo")
            again = await client.wait_for_frame(done["revision"])
            assert png.pixels(again) == png.pixels(first)
            assert png.state_in(again)["revision"] == done["revision"]
            assert server.metric(HANGS) >= 1 and server.metric(DEATHS) == 0
            assert f"hung: no answer in {TIMEOUT} s" in server.log()
            assert len(server.drawing_processes()) == len(stopped) and any(map(has_ended, stopped))
        server.signal_drawing_processes(signal.SIGCONT)


async def test_a_hanging_drawing_process_does_not_delay_other_clients():
    with Server("--draw-timeout", 3 * TIMEOUT) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            await client.request("set", **LONG)
            whole = await client.request_frame(**LARGE)
            while True:
                asked = asyncio.ensure_future(client.request_frame(**LARGE))
                pid = await signal_busy_drawing_process(server, signal.SIGSTOP)
                await asyncio.wait([asked], timeout=0.3 * SLOW)
                if not asked.done():
                    break
                os.kill(pid, signal.SIGCONT)  # it had already finished the picture
            for _ in range(5):
                await other.request("key", key="r")
                await other.request_frame(**SIZE)
            assert not asked.done()
            assert png.pixels(await asked) == png.pixels(whole)
            assert server.metric(HANGS) == 1 and server.metric(DEATHS) == 0 and has_ended(pid)


async def test_a_picture_that_hangs_two_processes_is_refused():
    with contextlib.closing(SuspendsDrawers("--draw-timeout", TIMEOUT)) as server:
        async with Client(server, stream="none") as client:
            before = await client.request_frame(**SIZE)
            await client.request("key", key="r")
            server.signal_drawing_processes(signal.SIGSTOP)
            server.suspending.set()
            with pytest.raises(Refused, match="internal"):
                await client.request_frame(**SIZE)
            server.suspending.clear()
            server.signal_drawing_processes(signal.SIGCONT)
            assert server.metric(HANGS) >= 2 and server.metric(DEATHS) == 0
            assert 'fault="two processes were lost in a row, the second hung' in server.log()
            await client.request("undo")
            assert png.pixels(await client.request_frame(**SIZE)) == png.pixels(before)
        assert server.stop()[0] == 0
        wait_for_processes_to_end(server.suspended)


async def test_drawing_processes_that_hang_at_the_start_are_replaced():
    with contextlib.closing(SuspendsFirstDrawers("--draw-timeout", TIMEOUT)) as server:
        assert server.metric(HANGS) >= 1 and server.metric(DEATHS) == 0
        async with Client(server, stream="none") as client:
            await client.request_frame(**SIZE)
        assert server.stop()[0] == 0
        wait_for_processes_to_end(server.suspended)


@pytest.mark.parametrize("drawing", [True, False])
async def test_a_server_stop_does_not_wait_for_hanging_processes(drawing):
    with Server("--draw-timeout", 1000, "--stop-timeout", 0.5) as server:
        async with Client(server, stream="none") as client:
            pids = server.signal_drawing_processes(signal.SIGSTOP)
            if drawing:
                received = server.metric("oval4d_messages_received_total")
                await client.send("get", what="frame")
                wait_until(lambda: server.metric("oval4d_messages_received_total") > received, "the request")
                await asyncio.sleep(0.1)
            status, _ = await asyncio.get_running_loop().run_in_executor(None, server.stop)
        assert status == 0 and "stopped" in server.log()
        wait_for_processes_to_end(pids)


async def test_hanging_processes_end_when_the_server_is_killed():
    server = Server()
    try:
        pids = server.signal_drawing_processes(signal.SIGSTOP)
        assert pids
    finally:
        server.kill()
    wait_for_processes_to_end(pids)


async def test_the_server_does_not_wait_for_a_killed_process_to_end():
    """The kernel keeps a killed process that is traced until its tracer has waited for it."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    with Server("--draw-timeout", TIMEOUT) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            before = await client.request_frame(**SIZE)
            traced = server.drawing_processes()
            for pid in traced:
                assert libc.ptrace(PTRACE_SEIZE, pid, None, None) == 0, os.strerror(ctypes.get_errno())
                os.kill(pid, signal.SIGSTOP)
            assert png.pixels(await client.request_frame(**SIZE)) == png.pixels(before)
            killed = set(traced) - set(server.drawing_processes())
            assert killed and server.metric(HANGS) == len(killed)
            server.signal_drawing_processes(signal.SIGKILL)
            for pid in traced:
                assert os.WTERMSIG(os.waitpid(pid, 0)[1]) == signal.SIGKILL
            assert all(Path(f"/proc/{pid}").exists() for pid in killed)
            while any(Path(f"/proc/{pid}").exists() for pid in killed):  # until new processes have replaced them
                server.signal_drawing_processes(signal.SIGKILL)
                await asyncio.gather(client.request_frame(**SIZE), other.request_frame(**SIZE))


async def frame_after_retries(client):
    """Requests a frame until it is drawn; it is refused if two processes in a row hang or die while they draw it."""
    while True:
        try:
            return png.pixels(await client.request_frame(**SIZE))
        except Refused as refusal:
            assert refusal.code == "internal"


async def test_randomly_killed_and_suspended_processes_leave_no_trace():
    """Processes are suspended and killed at random moments, also while they receive a polytope."""
    names = ["120-cell", "omnitruncated 24-cell", "600-cell", "omnitruncated tesseract"]
    rng = random.Random(4)
    # Not `with Server(…)`, which fails if the log contains faults.
    harmed = contextlib.closing(SuspendsDrawers("--draw-timeout", TIMEOUT, "--polytope-cache", 0))
    with harmed as server, Server() as other:
        async with Client(server, stream="none") as client, Client(other, stream="none") as unharmed:
            await client.request_frame(**SIZE)
            usual = len(server.open_files()), len(server.drawing_processes())
            for name in names if SLOW > 1 else names * 2:
                await client.request("set", polytope=name)
                await unharmed.request("set", polytope=name)
                asked = asyncio.ensure_future(frame_after_retries(client))
                await asyncio.sleep(rng.uniform(0, 0.04))
                server.signal_drawing_processes(rng.choice([signal.SIGSTOP, signal.SIGKILL]))
                assert await asked == await frame_after_retries(unharmed)
            assert server.metric(HANGS) + server.metric(DEATHS) >= len(names) / 2  # a process may be hit twice

            def is_as_before():
                # A worker replaces a lost process only when it draws again, so all workers draw at the same time.
                with concurrent.futures.ThreadPoolExecutor(4) as pool:
                    for answer in pool.map(lambda _: server.get("/api/v1/frame.png?width=640&height=360"), range(4)):
                        assert answer.status in (200, 500)
                return len(server.open_files()) == usual[0]

            wait_until(is_as_before, "as many open files as before")
            assert len(server.drawing_processes()) <= usual[1]
        server.signal_drawing_processes(signal.SIGCONT)
