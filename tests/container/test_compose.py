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
from harness import DEADLINE, wait_until  # noqa: E402
from pressing_clients import PressingClient, wait_until_all_press  # noqa: E402

SESSIONS = 40


@pytest.fixture(name="running_composition")
def start_composition(built_image, tmp_path):
    reason = composition.reason_to_skip()
    if reason:
        warnings.warn(f"COMPOSE IS NOT TESTED: {reason}")
        pytest.skip(reason)
    with composition.Composition(tmp_path, built_image.files, built_image.variables) as running_composition:
        yield running_composition


def metric(server, name):
    with urllib.request.urlopen(f"http://{server.host}:8080/metrics", timeout=DEADLINE) as answer:
        lines = answer.read().decode().splitlines()
    return next(float(line.rsplit(" ", 1)[1]) for line in lines if line.rsplit(" ", 1)[0] == name)


async def wait_for_open_sessions(running_composition, count):
    """Waits until the servers together have this many open sessions."""
    counts = lambda: [metric(server, "oval4d_open_sessions") for server in running_composition.servers()]
    await asyncio.to_thread(wait_until, lambda: sum(counts()) == count, f"{count} open sessions")


def serves_page(proxy):
    try:
        with urllib.request.urlopen(f"http://{proxy.host}:{proxy.port}/", timeout=DEADLINE) as answer:
            return b"<title>" in answer.read()
    except OSError:
        return False  # the proxy has not found the servers yet


async def add_stop_and_kill_servers(running_composition):
    servers = running_composition.servers()
    clients, tasks = [], []
    in_thread = asyncio.get_running_loop().run_in_executor

    def start_session():
        clients.append(PressingClient(len(clients), running_composition.proxy))
        tasks.append(asyncio.ensure_future(clients[-1].run()))

    async def start_sessions_until_shared(servers_):
        while min(metric(server, "oval4d_open_sessions") for server in servers_) == 0:
            start_session()
            await wait_until_all_press(clients)
            assert len(clients) < 5 * SESSIONS
            await asyncio.sleep(0.2)

    try:
        for _ in range(SESSIONS):
            start_session()
        await wait_until_all_press(clients)
        # The proxy may have found only one of the servers when the first sessions began.
        await start_sessions_until_shared(servers)
        await wait_for_open_sessions(running_composition, len(clients))

        # The proxy finds an added server through the service's name, and sends it new sessions.
        added = running_composition.add_server()
        await in_thread(None, wait_until, lambda: added.is_listening(8080), "the added server")
        await start_sessions_until_shared([added])

        # One server is stopped: its sessions continue at once on the others, from the last acknowledged state.
        assert await in_thread(None, servers[0].stop) == 0
        running_composition.remove_container(servers[0])
        await wait_until_all_press(clients)
        moved = [client for client in clients if client.interruptions]
        assert moved
        await wait_for_open_sessions(running_composition, len(clients))

        # One server is killed, and its address remains in the name server.
        await in_thread(None, servers[1].stop, signal.SIGKILL)
        await wait_until_all_press(clients)
        for client in clients:
            client.stopping = True
        await asyncio.wait_for(asyncio.gather(*tasks), DEADLINE)
    finally:
        for task in tasks:
            task.cancel()


def test_sessions_continue_while_servers_are_added_stopped_and_killed(running_composition):
    wait_until(lambda: serves_page(running_composition.proxy), "the page through the proxy")
    asyncio.run(add_stop_and_kill_servers(running_composition))
    for server in running_composition.servers():
        assert "fault=" not in server.log()
