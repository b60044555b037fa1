"""Drawing processes that hang: no client waits long for them, no session is lost, and they leave nothing behind."""

import asyncio
import concurrent.futures
import contextlib
import ctypes
import math
import os
import random
import signal
import threading
import time
from pathlib import Path

import png
import pytest
from harness import DEADLINE, LONG_TIME, Server, cpu_seconds, has_ended, is_sanitizer_build, process_state, wait_for_processes_to_end, wait_until
from test_drawing import DEATHS, LARGE, LONG, SIZE, signal_busy_drawing_process
from wire import Client, Refused

PTRACE_SEIZE = 0x4206
HANGS = 'oval4d_drawing_losses_total{cause="hung"}'


@pytest.fixture(scope="module", name="timeout")
def measured_timeout():
    """A --draw-timeout in whole seconds. A process that runs does not reach it: this machine starts a server and draws a
    large picture in a third of it. The tests pass, too, if such a process reaches it by chance."""
    async def draw_once(server):
        async with Client(server, stream="none") as client:
            await client.request("set", **LONG)
            await client.request_frame(**LARGE)

    start = time.monotonic()
    with Server() as server:
        asyncio.run(draw_once(server))
    return max(2, min(DEADLINE // 3, math.ceil(3 * (time.monotonic() - start))))


class SuspendsDrawers(Server):
    """A server whose drawing processes are suspended (SIGSTOP) as soon as they appear, from begin() to end()."""

    most = math.inf  # how many processes to suspend
    suspender = None

    def begin(self):
        self.suspended, self.finished = set(), False
        self.suspender = threading.Thread(target=self.suspend_drawers)
        self.suspender.start()

    def suspend_drawers(self):
        while not self.finished and len(self.suspended) < self.most:
            self.suspended.update(self.signal_drawing_processes(signal.SIGSTOP))

    def end(self):
        self.finished = True
        self.suspender.join()
        self.signal_drawing_processes(signal.SIGCONT)

    def close(self):
        if self.suspender:
            self.end()
        self.kill()


class SuspendsFirstDrawers(SuspendsDrawers):
    """Suspends the first drawing processes as soon as they appear."""

    most = 3

    def start(self, command, environment):
        self.process = super().start(command, environment)
        self.begin()
        return self.process


async def frame_after_retries(client, **size):
    """Requests a frame until it is drawn; it is refused if two processes in a row hang or die while they draw it."""
    while True:
        try:
            return await client.request_frame(**(size or SIZE))
        except Refused as refusal:
            assert refusal.code == "internal"


async def test_a_drawing_process_suspended_between_pictures_is_replaced(timeout):
    with Server("--draw-timeout", timeout) as server:
        async with Client(server, stream="frames", **SIZE) as client:
            first = await client.wait_for_frame(0)
            done = await client.request("key", key="r")
            await client.wait_for_frame(done["revision"])
            stopped = server.suspend_drawing_processes()
            done = await client.request("undo")
            again = await client.wait_for_frame(done["revision"])
            assert png.pixels(again) == png.pixels(first)
            assert png.state_in(again)["revision"] == done["revision"]
            assert server.metric(HANGS) >= 1 and server.metric(DEATHS) == 0
            assert f"hung: no answer in {timeout} s" in server.log()
            wait_until(lambda: any(map(has_ended, stopped)), "the end of the process that hung")
            wait_until(lambda: len(server.drawing_processes()) == len(stopped), "its successor")
        server.signal_drawing_processes(signal.SIGCONT)


async def test_a_process_that_hangs_while_it_draws_is_replaced(timeout):
    with Server("--draw-timeout", timeout) as server:
        async with Client(server, stream="none") as client:
            await client.request("set", **LONG)
            whole = await client.request_frame(**LARGE)
            while server.metric(HANGS) == 0:
                asked = asyncio.ensure_future(frame_after_retries(client, **LARGE))
                pid = await signal_busy_drawing_process(server, signal.SIGSTOP, asked)
                assert png.pixels(await asked) == png.pixels(whole)
                if pid is not None and not has_ended(pid):
                    os.kill(pid, signal.SIGCONT)  # the process had already finished the picture
            assert server.metric(DEATHS) == 0


async def test_a_hanging_drawing_process_does_not_delay_other_clients():
    with Server("--draw-timeout", LONG_TIME) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            await client.request("set", **LONG)
            whole = await client.request_frame(**LARGE)
            drew_after = False
            while not drew_after:  # until a process is suspended before it has finished
                asked = asyncio.ensure_future(client.request_frame(**LARGE))
                pid = await signal_busy_drawing_process(server, signal.SIGSTOP, asked)
                if pid is not None:
                    await asyncio.to_thread(wait_until, lambda: process_state(pid) == "T", "the suspended process")
                    seconds = cpu_seconds(pid)
                    for _ in range(5):
                        await other.request("key", key="r")
                        await other.request_frame(**SIZE)
                    waited = not asked.done()
                    os.kill(pid, signal.SIGCONT)
                    await asyncio.wait([asked])
                    drew_after = waited and cpu_seconds(pid) > seconds
                assert png.pixels(await asked) == png.pixels(whole)
            assert server.metric(HANGS) == 0 and server.metric(DEATHS) == 0


async def test_a_picture_that_hangs_two_processes_is_refused(timeout):
    with contextlib.closing(SuspendsDrawers("--draw-timeout", timeout)) as server:
        async with Client(server, stream="none") as client:
            before = await client.request_frame(**SIZE)
            await client.request("set", **LONG)
            server.begin()
            with pytest.raises(Refused, match="internal"):
                while True:  # until a process is suspended before it has finished
                    await client.request_frame(**LARGE)
            server.end()
            assert server.metric(HANGS) >= 2 and server.metric(DEATHS) == 0
            assert 'fault="two processes were lost in a row, the second hung' in server.log()
            await client.request("undo")
            assert png.pixels(await frame_after_retries(client)) == png.pixels(before)
        assert server.stop()[0] == 0
        wait_for_processes_to_end(server.suspended)


async def test_drawing_processes_that_hang_at_the_start_are_replaced(timeout):
    hangs = 0
    while hangs == 0:  # until a process is suspended before it has started
        with contextlib.closing(SuspendsFirstDrawers("--draw-timeout", timeout)) as server:
            hangs = server.metric(HANGS)
            assert server.metric(DEATHS) == 0
            async with Client(server, stream="none") as client:
                await frame_after_retries(client)
            assert server.stop()[0] == 0
            wait_for_processes_to_end(server.suspended)


@pytest.mark.parametrize("drawing", [True, False])
async def test_a_server_stop_does_not_wait_for_hanging_processes(drawing):
    with Server("--draw-timeout", LONG_TIME, "--stop-timeout", 0.5) as server:
        async with Client(server, stream="none") as client:
            asked = None
            if drawing:
                await client.request("set", **LONG)
                asked = asyncio.ensure_future(client.request_frame(**LARGE))
                await signal_busy_drawing_process(server, signal.SIGSTOP, asked)
            pids = server.suspend_drawing_processes()
            status, _ = await asyncio.to_thread(server.stop)
            if asked:
                await asyncio.wait([asked])
                asked.exception()  # the connection's end, unless the picture was finished before
        assert status == 0 and "stopped" in server.log()
        wait_for_processes_to_end(pids)


async def test_hanging_processes_end_when_the_server_is_killed():
    server = Server()
    try:
        pids = server.suspend_drawing_processes()
        assert pids
    finally:
        server.kill()
    wait_for_processes_to_end(pids)


async def test_the_server_does_not_wait_for_a_killed_process_to_end(timeout):
    """The kernel keeps a killed process that is traced until its tracer has waited for it."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    with Server("--draw-timeout", timeout) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            before = await client.request_frame(**SIZE)
            traced = server.drawing_processes()
            for pid in traced:
                assert libc.ptrace(PTRACE_SEIZE, pid, None, None) == 0, os.strerror(ctypes.get_errno())
                os.kill(pid, signal.SIGSTOP)
            assert png.pixels(await frame_after_retries(client)) == png.pixels(before)
            wait_until(lambda: set(traced) - set(server.drawing_processes()), "a process that is killed")
            killed = set(traced) - set(server.drawing_processes())
            assert server.metric(HANGS) >= len(killed)
            server.signal_drawing_processes(signal.SIGKILL)
            for pid in traced:
                while not os.WIFSIGNALED(status := os.waitpid(pid, 0)[1]):
                    pass  # the process had been suspended before it was killed
                assert os.WTERMSIG(status) == signal.SIGKILL
            assert all(Path(f"/proc/{pid}").exists() for pid in killed)
            while any(Path(f"/proc/{pid}").exists() for pid in killed):  # until new processes have replaced them
                server.signal_drawing_processes(signal.SIGKILL)
                await asyncio.gather(frame_after_retries(client), frame_after_retries(other))


async def test_randomly_killed_and_suspended_processes_leave_no_trace(timeout):
    """Processes are suspended and killed at random moments, also while they receive a polytope."""
    names = ["120-cell", "omnitruncated 24-cell", "600-cell", "omnitruncated tesseract"]
    rng = random.Random(4)
    # `with Server(…)` would fail here, because the log contains faults.
    harmed = contextlib.closing(SuspendsDrawers("--draw-timeout", timeout, "--polytope-cache", 0))
    with harmed as server, Server() as other:
        async with Client(server, stream="none") as client, Client(other, stream="none") as unharmed:
            await client.request_frame(**SIZE)
            usual = len(server.open_files()), len(server.drawing_processes())
            for name in names if is_sanitizer_build() else names * 2:
                await client.request("set", polytope=name)
                await unharmed.request("set", polytope=name)
                asked = asyncio.ensure_future(frame_after_retries(client))
                await asyncio.sleep(rng.uniform(0, 0.04))
                server.signal_drawing_processes(rng.choice([signal.SIGSTOP, signal.SIGKILL]))
                assert png.pixels(await asked) == png.pixels(await unharmed.request_frame(**SIZE))
            assert server.metric(HANGS) + server.metric(DEATHS) >= 1  # may be less than the number of kills

            def is_as_before():
                # A worker replaces a lost process only when it draws again. Therefore all workers draw at the same
                # time.
                with concurrent.futures.ThreadPoolExecutor(4) as pool:
                    for answer in pool.map(lambda _: server.get("/api/v1/frame.png?width=640&height=360"), range(4)):
                        assert answer.status in (200, 500)
                return len(server.open_files()) == usual[0]

            wait_until(is_as_before, "as many open files as before")
            wait_until(lambda: len(server.drawing_processes()) <= usual[1], "the end of the replaced processes")
        server.signal_drawing_processes(signal.SIGCONT)
