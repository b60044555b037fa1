"""Memory that clients needed is freed after they have left."""

import asyncio

import pytest
from harness import Server, is_sanitizer_build
from wire import ENCODINGS, Client, connect

LARGEST = "omnitruncated 120-cell"
NOISE = 8_000_000  # bytes; memory that a burst does not free would be several times as much


async def receive_pictures(server, polytope, pictures, **hello):
    """Turns a polytope until `pictures` pictures have arrived; returns those that follow."""
    async with Client(server, **hello) as client:
        await client.request("set", polytope=polytope)
        for count in range(pictures):
            await client.wait_until(lambda: len(client.pictures()) > count)
            await client.request("key", key="y")
        return await client.wait_until(lambda: client.pictures()[pictures:])


async def reference_picture(server):
    async with Client(server) as client:
        await client.request("set", polytope="600-cell")
        return await client.request_frame(width=640, height=360), (await client.request("get", what="slices"))["slices"]


async def wait_for_memory_below(server, most):
    condition = lambda: server.anonymous_memory() < most
    await asyncio.get_running_loop().run_in_executor(None, lambda: server.wait_for(condition))


@pytest.mark.skipif(is_sanitizer_build(), reason="sanitizers keep what is freed")
async def test_memory_is_freed_after_a_burst():
    with Server("--session-expiry", 1) as server:
        streams = [{"stream": "frames"}, *({"stream": "geometry", "encoding": encoding} for encoding in ENCODINGS)]
        before = await reference_picture(server)
        for hello in streams:
            await receive_pictures(server, "5-cell", 3, **hello)
        warm = server.anonymous_memory()
        onlookers = [await connect(server) for _ in range(900)]
        theirs = server.anonymous_memory() - warm
        print(f"900 connections take {theirs / 1e6:.1f} MB")

        await asyncio.gather(*(receive_pictures(server, LARGEST, 12, **hello) for hello in 2 * streams))
        await wait_for_memory_below(server, warm + theirs + NOISE)

        # The memory of closed connections is freed, even if no picture is requested afterward.
        await asyncio.gather(*(onlooker.close() for onlooker in onlookers))
        await wait_for_memory_below(server, warm + NOISE)
        assert await reference_picture(server) == before
