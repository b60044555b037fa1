"""Pacing: pictures of the newest state arrive as fast as they are acknowledged, and no client delays another."""

import asyncio
import base64
import os
import socket

import png
import pytest
from harness import DEADLINE, LONG_TIME, Server, is_sanitizer_build
from wire import Client, credentials_of


def slices_revisions(client):
    return [m["revision"] for m in client.streamed_messages("slices")]


async def test_at_most_two_pictures_are_in_flight():
    with Server("--shown-timeout", LONG_TIME) as server:
        async with Client(server, stream="geometry", acknowledges=False) as client:
            await client.wait_for_slices(0)
            for _ in range(20):
                last = await client.request("key", key="r")
            # Answers come in order, so all pictures have arrived. There are two; a third one would need a `shown`.
            await client.wait_until(lambda: len(client.pictures()) == 2)
            for _ in range(20):
                last = await client.request("key", key="r")
            assert len(client.pictures()) == 2
            await client.send("shown", revision=slices_revisions(client)[0])
            await client.wait_until(lambda: len(client.pictures()) == 3)
            assert slices_revisions(client)[-1] == last["revision"] == 40
            await client.send("shown", revision=40)
            done = await client.request("key", key="r")
            await client.wait_for_slices(done["revision"])
            assert len(client.pictures()) == len(client.states()) == 4


@pytest.mark.parametrize("stream", ["geometry", "frames", "none"])
async def test_every_key_of_a_flood_is_applied(server, stream):
    count = 1000
    async with Client(server, stream=stream, width=160, height=90) as client:
        for number in range(count):
            await client.send("key", key="y" if number % 4 else "k")
        state = await client.wait_for_state(count)
        assert state["revision"] == count
        if stream == "geometry":
            await client.wait_for_slices(count)
        if stream == "frames":
            assert png.state_in(await client.wait_for_frame(count))["revision"] == count
        seen = [m["revision"] for m in client.states()]
        assert seen == sorted(set(seen))
        # α increases by 250 steps, up to 2π. The result shows that no key was lost.
        step, start = state["step"], 5 * state["step"]
        assert state["alpha"] == pytest.approx(min(start + 250 * step, 6.283185307179586))
    assert server.metric("oval4d_slow_readers_total") == 0


async def test_floods_of_keys_from_two_clients_are_applied(server):
    async with Client(server, stream="geometry") as one, Client(server, stream="geometry", **credentials_of(one)) as two:
        async def flood(client, key):
            for _ in range(300):
                await client.send("key", key=key)
        await asyncio.gather(flood(one, "r"), flood(two, "t"))
        for client in (one, two):
            assert (await client.wait_for_slices(600))["revision"] == 600
        assert one.states()[-1] == two.states()[-1]


async def test_continuous_turning_is_one_undo_step(server):
    async with Client(server, stream="geometry") as client:
        await client.request("key", key="r")
        await client.request("key", key=" ")
        await client.wait_for_slices(8)
        await client.request("key", key=" ")
        stopped = await client.request("get", what="state")
        assert stopped["turning"] is False
        seen = [tuple(m["orientation"][0]) for m in client.states()]
        assert len(set(seen)) >= 5
        await client.request("undo")
        assert (await client.request("get", what="state"))["orientation"][0] == pytest.approx(
            [0.9961946980917455, 0, 0, -0.08715574274765817])


async def test_all_clients_see_the_focus_play_and_undo_returns_to_its_start(server):
    async with Client(server, stream="geometry") as one, Client(server, stream="geometry", **credentials_of(one)) as two:
        await one.request("set", polytope="24-cell", slices={"w": 0.1})
        await one.request("command", line="play 2")
        for client in (one, two):
            playing = await client.wait_until(
                lambda: next((s for s in client.states() if s["playing"] and s["section"]["w"] > 0.5), None))
            assert playing["moving"] and playing["speed"] == 2
        await two.request("key", key="P")
        stopped = await one.request("get", what="state")
        assert not stopped["playing"] and not stopped["moving"]
        await two.request("undo")
        undone = await one.request("get", what="state")
        assert undone["section"]["w"] == pytest.approx(0.1) and not undone["playing"]


async def test_continuous_turning_waits_for_acknowledgments():
    with Server("--shown-timeout", LONG_TIME) as server:
        async with Client(server, stream="geometry", acknowledges=False) as client:
            await client.request("key", key="r")
            await client.request("key", key=" ")
            await client.wait_until(lambda: len(client.pictures()) == 2)
            still = (await client.request("get", what="state"))["revision"]
            assert (await client.request("get", what="state"))["revision"] == still
            await client.send("shown", revision=still)
            await client.wait_until(lambda: len(client.pictures()) > 2)
            assert slices_revisions(client)[2] <= still + 1  # until then, the object did not turn


def open_nonreading_socket(server, *messages, buffer=4096):
    """Returns a raw socket with a small receive buffer that has sent messages and will never read."""
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
    raw.settimeout(DEADLINE)
    raw.connect((server.host, server.port))
    raw.sendall(f"GET /ws HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nUpgrade: websocket\r\n"
                "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n\r\n".encode())
    answer = b""
    while not answer.endswith(b"\r\n\r\n"):  # sends no frame before the handshake's answer
        answer += raw.recv(1)
    try:
        for message in messages:
            raw.sendall(masked_frame(message))
    except ConnectionError:  # the server has already dropped the connection
        pass
    return raw


def masked_frame(text, opcode=1, final=True):
    """Returns a WebSocket frame, masked as a client must send it."""
    data, mask = text.encode() if isinstance(text, str) else text, os.urandom(4)
    size = len(data)
    header = bytes([(0x80 if final else 0) | opcode])
    header += bytes([0x80 | size]) if size < 126 else b"\xfe" + size.to_bytes(2, "big")
    return header + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data))


async def test_clients_that_never_read_are_disconnected():
    # The pictures of the reading client are so small that they fit into the kernel's buffers, so they need not wait for
    # it.
    with Server("--write-timeout", 0.5, "--max-unsent", "64k") as server:
        hello = '{"type":"hello","stream":"frames","width":1600,"height":1200}'
        requests = ['{"type":"set","polytope":"600-cell"}'] + ['{"type":"get","what":"slices"}'] * 200
        before = server.peak_memory()
        nonreading = [open_nonreading_socket(server, hello, *requests) for _ in range(5)]
        async with Client(server, stream="geometry") as client:
            loop = asyncio.get_running_loop()
            dropped = loop.run_in_executor(
                None, lambda: server.wait_for(lambda: server.metric("oval4d_slow_readers_total") >= 5))
            while not dropped.done():
                done = await client.request("key", key="r")
                await client.wait_for_slices(done["revision"])
            await dropped
        await loop.run_in_executor(None, lambda: server.wait_for(lambda: server.metric("oval4d_websockets") == 0))
        # Buffering 200 answers of 200 kB for each of five clients would take 200 MB.
        assert server.peak_memory() - before < 100e6 * (6 if is_sanitizer_build() else 1)
        for raw in nonreading:
            raw.close()


async def test_the_server_survives_sockets_closed_within_a_message(server):
    raw = open_nonreading_socket(server, '{"type":"hello","stream":"frames"}')
    raw.sendall(masked_frame('{"type":"key","key":"y"}')[:9])
    raw.close()
    raw = open_nonreading_socket(server)
    raw.sendall(masked_frame('{"type":"hel', final=False))
    raw.close()
    async with Client(server, stream="geometry") as client:
        await client.request("key", key="y")
