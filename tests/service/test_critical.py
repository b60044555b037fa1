"""Critical w: where the sections of fields and polytopes change their type."""

import asyncio
import math
import sys
import time
from pathlib import Path

import pytest
from harness import DEADLINE, Server
from surfaces import field_client
from wire import Client, Refused

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402

BALL = "x^2 + y^2 + z^2 + w^2 < 1"
TIGER = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09"


async def critical_of(client):
    # A search takes up to one and a half times --max-file-time.
    return await client.request("get", what="critical", deadline=2 * DEADLINE)


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
    async with field_client(server, BALL) as client:
        await client.request("set", levels=[-0.75])  # x² + … − 1 = −0.75: the radius is 0.5
        await client.request("rotate", planes=["xw"], angles=[0.3])
        message = await critical_of(client)
        assert message["most_w"] == pytest.approx(2 * (math.cos(0.3) + math.sin(0.3)))
        assert [s["w"] for s in message["sections"]] == pytest.approx([-0.5, 0.5], abs=1e-4)
        assert [s["change"] for s in message["sections"]] == ["appears", "vanishes"]
        await client.request("set", inside="above")
        assert [s["change"] for s in (await critical_of(client))["sections"]] == ["cavity", "cavity"]


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
            await client.request("key", key=key)
            return (await client.request("get", what="state"))["section"]["w"]

        assert [await press(")") for _ in range(3)] == pytest.approx([0.4, 1, 1], abs=4e-4)
        assert [await press("(") for _ in range(5)] == pytest.approx([0.4, -0.4, -1, -1, -1], abs=4e-4)


# Each sine takes its time; a search takes many seconds.
SLOW_FIELD = " + ".join(f"sin({n}*x*y+w)*cos({n}*z*w-x)" for n in range(1, 40)) + " < 0"


async def test_requests_are_answered_during_a_search(server):
    async with field_client(server, SLOW_FIELD) as client:
        search = asyncio.create_task(critical_of(client))
        await asyncio.sleep(0.1)
        for _ in range(3):
            await client.request("set", slices={"spacing": 0.1})
            await client.request("key", key="a")
        assert not search.done()
        search.cancel()


@pytest.mark.parametrize("command", [{"type_": "rotate", "planes": ["xw"], "angles": [0.1]},
                                     {"type_": "set", "levels": [0.1]}, {"type_": "set", "inside": "above"},
                                     {"type_": "set", "pace": 2}, {"type_": "set", "polytope": "24-cell"}])
async def test_a_search_ends_when_it_is_obsolete(server, command):
    async with field_client(server, SLOW_FIELD) as client:
        search = asyncio.create_task(critical_of(client))
        await asyncio.sleep(0.1)
        await client.request(**command)
        with pytest.raises(Refused) as refused:
            await asyncio.wait_for(search, DEADLINE / 4)
        assert refused.value.code == "canceled"


async def test_another_client_ends_the_search_of_a_key(server):
    async with field_client(server, SLOW_FIELD) as client:
        welcome = client.welcome
        async with Client(server, welcome["session"], token=welcome["token"], stream="none") as other:
            press = asyncio.create_task(client.request("key", key=")", deadline=2 * DEADLINE))
            await asyncio.sleep(0.1)
            await other.request("rotate", planes=["xw"], angles=[0.1])
            with pytest.raises(Refused) as refused:
                await press
            assert refused.value.code == "canceled"


@pytest.mark.parametrize("request_", [{"type_": "get", "what": "critical"}, {"type_": "key", "key": ")"}])
async def test_a_search_ends_when_its_client_leaves(request_):
    # There is one worker for searches. If it went on, the second session would wait for it.
    with Server("--file-workers", 1, "--max-file-time", 3 * DEADLINE) as server:
        async with field_client(server, SLOW_FIELD) as client:
            await client.send(**request_)
            await asyncio.sleep(0.2)
        async with Client(server, stream="none") as client:
            await client.request("set", polytope="120-cell")
            await asyncio.wait_for(critical_of(client), DEADLINE)


@pytest.mark.release_only
async def test_results_are_kept_up_to_a_limit():
    for size, keeps in [("4M", True), (0, False)]:
        with Server("--critical-cache", size) as server:
            async with field_client(server, BALL) as client:
                await critical_of(client)
            assert (server.metric("oval4d_critical_cache_bytes") > 0) == keeps


async def test_a_search_does_not_delay_other_sessions(server):
    async with field_client(server, BALL) as client, Client(server, stream="none") as other:
        search = asyncio.create_task(critical_of(client))
        await asyncio.sleep(0.05)
        await other.request("key", key="y")
        assert not search.done()
        assert len((await search)["sections"]) == 2


@pytest.mark.release_only
async def test_a_client_that_waits_for_a_search_is_not_dropped():
    # A client that is silent for twice this time is dropped, and the search takes longer; but the client answers pings.
    with Server("--ping-interval", 0.4) as server:
        async with field_client(server, TIGER) as client:
            start = time.monotonic()
            assert len((await critical_of(client))["sections"]) == 4
            assert time.monotonic() - start > 0.8


def test_from_python(server):
    with oval4d_client.connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        sections = oval.critical()["sections"]
        assert sum(section["vertices"] for section in sections) == 5  # the 5-cell
