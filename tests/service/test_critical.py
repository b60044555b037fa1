"""Critical w: where the sections of fields and polytopes change their type."""

import asyncio
import math
import sys
from pathlib import Path

import pytest
from harness import DEADLINE, LONG_TIME, Server, cpu_seconds, wait_until
from surfaces import field_client
from wire import Client

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402

BALL = "x^2 + y^2 + z^2 + w^2 < 1"
TIGER = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09"


async def critical_of(client):
    # Some searches take many seconds even on a fast machine. The server ends a search that hangs.
    return await client.request("get", what="critical", deadline=LONG_TIME)


async def begin_search(client):
    """Sends a request for the critical w; returns its number, for client.answer_to(). The server executes what the client
    sends afterward after it has begun the search."""
    await client.send("get", id=500, what="critical")
    return 500


async def canceled(client, number):
    """Waits for the answer that the search has been canceled."""
    answer = await client.wait_until(lambda: client.answer_to(number))
    assert (answer["type"], answer.get("code")) == ("error", "canceled")


@pytest.mark.release_only
async def test_the_changes_of_a_field(server):
    async with field_client(server, TIGER) as client:
        message = await critical_of(client)
        assert (message["least_w"], message["most_w"]) == (-2, 2)
        assert message["tolerance"] == pytest.approx(4e-4) and message["resolution"] == pytest.approx(4e-3)
        sections = message["sections"]
        assert [section["w"] for section in sections] == pytest.approx([-1, -0.4, 0.4, 1], abs=4e-4)
        assert [section["change"] for section in sections] == ["appears", "split", "merge", "vanishes"]
        assert [section["components"] for section in sections] == [[0, 1], [1, 2], [2, 1], [1, 0]]
        assert all(section["euler"] == [0, 0] and section["level"] == 0 for section in sections)


@pytest.mark.release_only
async def test_the_changes_follow_orientation_levels_and_inside(server):
    async with field_client(server, "1 - (x^2 + y^2 + z^2 + w^2)") as client:
        await client.request("set", levels=[0.75], inside="above")  # a ball of radius 0.5
        await client.request("rotate", planes=["xw"], angles=[0.3])
        message = await critical_of(client)
        assert message["most_w"] == pytest.approx(2 * (math.cos(0.3) + math.sin(0.3)))
        assert [s["w"] for s in message["sections"]] == pytest.approx([-0.5, 0.5], abs=1e-4)
        assert [s["change"] for s in message["sections"]] == ["appears", "vanishes"]


async def test_the_changes_of_a_polytope_are_its_vertices(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract")
        sections = (await critical_of(client))["sections"]
        assert [s["w"] for s in sections] == pytest.approx([-1, 1])
        assert [(s["change"], s["vertices"]) for s in sections] == [("vertices", 8)] * 2


@pytest.mark.release_only
async def test_keys_move_the_focus(server):
    async with field_client(server, TIGER) as client:
        async def press(key):
            await client.request("key", key=key, deadline=LONG_TIME)
            return (await client.request("get", what="state"))["section"]["w"]

        assert [await press(")") for _ in range(3)] == pytest.approx([0.4, 1, 1], abs=4e-4)
        assert [await press("(") for _ in range(5)] == pytest.approx([0.4, -0.4, -1, -1, -1], abs=4e-4)


# Each sine takes time to compute: a search takes minutes, and ends only when it is canceled.
SLOW_FIELD = " + ".join(f"sin({n}*x*y+w)*cos({n}*z*w-x)" for n in range(1, 40)) + " < 0"


async def test_requests_are_answered_during_a_search(server):
    async with field_client(server, SLOW_FIELD) as client:
        search = await begin_search(client)
        for _ in range(3):
            await client.request("set", slices={"spacing": 0.1})
            await client.request("key", key="a")
        assert not client.answer_to(search)


@pytest.mark.parametrize("command", [{"type_": "rotate", "planes": ["xw"], "angles": [0.1]},
                                     {"type_": "set", "levels": [0.1]}, {"type_": "set", "inside": "above"},
                                     {"type_": "set", "pace": 2}, {"type_": "set", "polytope": "24-cell"}])
async def test_a_search_ends_when_it_is_obsolete(server, command):
    async with field_client(server, SLOW_FIELD) as client:
        search = await begin_search(client)
        await client.request(**command)
        await canceled(client, search)


async def test_another_client_ends_the_search_of_a_key(server):
    async with field_client(server, SLOW_FIELD) as client:
        welcome = client.welcome
        async with Client(server, welcome["session"], token=welcome["token"], stream="none") as other:
            await client.send("key", id=500, key=")")
            while not client.answer_to(500):  # a rotation may be executed before the key
                await other.request("rotate", planes=["xw"], angles=[0.1])
                await asyncio.sleep(0.05)
            await canceled(client, 500)


@pytest.mark.parametrize("request_", [{"type_": "get", "what": "critical"}, {"type_": "key", "key": ")"}])
async def test_a_search_ends_when_its_client_leaves(request_):
    # There is only one worker for searches. If the first search went on, the second session would have to wait.
    with Server("--file-workers", 1) as server:
        async with field_client(server, SLOW_FIELD) as client:
            before = cpu_seconds(server.process.pid)
            await client.send(**request_)
            await asyncio.to_thread(wait_until, lambda: cpu_seconds(server.process.pid) > before + 0.1, "the search")
        async with Client(server, stream="none") as client:
            await client.request("set", polytope="120-cell")
            await critical_of(client)


@pytest.mark.release_only
async def test_results_are_kept_up_to_a_limit():
    for size, keeps in [("4M", True), (0, False)]:
        with Server("--critical-cache", size) as server:
            async with field_client(server, BALL) as client:
                await critical_of(client)
            assert (server.metric("oval4d_critical_cache_bytes") > 0) == keeps


async def test_a_search_does_not_delay_other_sessions(server):
    async with field_client(server, SLOW_FIELD) as client, Client(server, stream="none") as other:
        search = await begin_search(client)
        await client.request("get", what="state")  # the search has begun before this answer
        for _ in range(5):
            await other.request("key", key="y")
        assert not client.answer_to(search)


@pytest.mark.release_only
async def test_a_client_that_waits_for_a_search_is_not_dropped():
    """A client that is silent for twice the interval is dropped, and the search takes longer; but it answers pings."""
    for interval in (0.5, 2, 8, 32):  # increases until this machine can answer a ping in time
        with Server("--ping-interval", interval) as server:
            async with field_client(server, SLOW_FIELD) as client:
                # The client's later messages wait for the search that the key starts.
                await client.send("key", id=500, key=")")
                await asyncio.sleep(4 * interval)
                if client.close_code is None and not client.answer_to(500):
                    return
    pytest.fail("a client that waits for a search is dropped")


def test_from_python(server):
    with oval4d_client.connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        sections = oval.critical()["sections"]
        assert sum(section["vertices"] for section in sections) == 5  # the vertices of the 5-cell
