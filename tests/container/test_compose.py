"""Runs docker/compose.yaml without a Docker engine: sessions continue while servers are added, stopped and killed."""

import asyncio
import signal
import sys
import urllib.request
import warnings

import composition
import image
import pytest

sys.path.insert(0, str(image.ROOT / "tests/failover"))
sys.path.insert(0, str(image.ROOT / "tests/service"))
from harness import DEADLINE, until  # noqa: E402
from sessions import Session, all_press  # noqa: E402

SESSIONS = 40


@pytest.fixture(name="composed")
def running_composition(built, tmp_path):
    why = composition.missing()
    if why:
        warnings.warn(f"COMPOSE IS NOT TESTED: {why}")
        pytest.skip(why)
    with composition.Composition(tmp_path, built.files, built.variables) as composed:
        yield composed


def metric(server, name):
    with urllib.request.urlopen(f"http://{server.host}:8080/metrics", timeout=DEADLINE) as answer:
        lines = answer.read().decode().splitlines()
    return next(float(line.rsplit(" ", 1)[1]) for line in lines if line.rsplit(" ", 1)[0] == name)


def open_sessions(composed):
    return [metric(server, "oval4d_open_sessions") for server in composed.servers()]


def has_page(proxy):
    try:
        with urllib.request.urlopen(f"http://{proxy.host}:{proxy.port}/", timeout=DEADLINE) as answer:
            return b"<title>" in answer.read()
    except OSError:
        return False  # the proxy has not found the servers yet


async def scene(composed):
    servers = composed.servers()
    sessions, tasks = [], []
    in_thread = asyncio.get_running_loop().run_in_executor

    def begin():
        sessions.append(Session(len(sessions), composed.proxy))
        tasks.append(asyncio.ensure_future(sessions[-1].run()))

    async def begin_until_shared(by):
        while min(metric(server, "oval4d_open_sessions") for server in by) == 0:
            begin()
            await all_press(sessions)
            assert len(sessions) < 5 * SESSIONS
            await asyncio.sleep(0.2)

    try:
        for _ in range(SESSIONS):
            begin()
        await all_press(sessions)
        # The proxy may have found only one of the servers when the first sessions began.
        await begin_until_shared(servers)
        assert sum(open_sessions(composed)) == len(sessions)

        # The proxy finds an added server through the service's name, and sends it new sessions.
        added = composed.scale()
        await in_thread(None, until, lambda: added.answers(8080), "the server added")
        await begin_until_shared([added])

        # One server is stopped: its sessions continue at once on the others, from the last acknowledged state.
        assert await in_thread(None, servers[0].stop) == 0
        composed.gone(servers[0])
        await all_press(sessions)
        moved = [session for session in sessions if session.away]
        assert moved and sum(open_sessions(composed)) == len(sessions)

        # One server is killed, and its address remains in the name server.
        await in_thread(None, servers[1].stop, signal.SIGKILL)
        await all_press(sessions)
        for session in sessions:
            session.ended = True
        await asyncio.wait_for(asyncio.gather(*tasks), DEADLINE)
    finally:
        for task in tasks:
            task.cancel()


def test_sessions_go_on_while_servers_come_and_go(composed):
    until(lambda: has_page(composed.proxy), "the page through the proxy")
    asyncio.run(scene(composed))
    for server in composed.servers():
        assert "fault=" not in server.log()
