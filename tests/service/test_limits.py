"""Each limit, set so low that a test can reach it."""

import asyncio
import contextlib
import json
import socket
import threading
import time

import pytest
import websockets
from harness import DEADLINE, Server, run_oval4d
from png import pixels
from schemas import SCHEMAS
from test_import import get_file, tesseract_file
from test_pacing import masked_frame, open_nonreading_socket
from wire import Client, Refused, connect, credentials_of, handshake_status


async def request_refusal(client, type_, **members):
    with pytest.raises(Refused) as caught:
        await client.request(type_, **members)
    return caught.value


async def test_the_welcome_message_states_the_limits():
    with Server("--max-message", "64k", "--max-depth", 9, "--max-requests", 77, "--min-side", 20, "--max-width", 900,
                "--max-height", 800, "--max-pixels", 500_000, "--max-slices", 41, "--shown-timeout", 2.5,
                "--max-file-triangles", 5000, "--max-file-bytes", "1M", "--max-file-time", 7, "--max-upload", "1G",
                "--max-field-bytes", "3M", "--max-slice-edges", 123_456) as server:
        async with Client(server, width=900, height=500) as client:
            assert client.welcome["limits"] == {
                "message": 65536, "request_bytes": 65536, "upload": 1 << 30, "field_bytes": 3 << 20, "depth": 9, "requests_per_second": 77, "min_side": 20, "max_width": 900,
                "max_height": 800, "max_pixels": 500_000, "slice_edges": 123_456, "slices": 41, "shown_timeout": 2.5,
                "file_triangles": 5000, "file_bytes": 1 << 20, "file_time": 7}
            described = SCHEMAS["welcome.schema.json"]["properties"]["limits"]["properties"]
            assert set(client.welcome["limits"]) == set(described), "the schema describes each limit"
            assert (await request_refusal(client, "set", slices={"count": 43})).code == "out_of_range"
            for width, height in ((901, 100), (100, 801), (19, 100), (900, 800)):
                assert (await request_refusal(client, "get", what="frame", width=width, height=height)).code == "out_of_range"
            await client.request_frame(width=900, height=20)
            await client.socket.send('{"type":"set","slices":' + '{"a":' * 9 + "1" + "}" * 10)
            await client.wait_until(lambda: any(m.get("code") == "bad_json" for m in client.messages if isinstance(m, dict)))
            await client.socket.send(" " * 65537)
            assert await client.wait_for_close_code() == 1009


@pytest.mark.parametrize("options, size", [
    (("--max-pixels", 57_600), (320, 180)),
    (("--max-width", 640), (640, 720)),
    (("--min-side", 400, "--max-pixels", 200_000), (500, 400)),
])
async def test_pictures_without_a_size_are_within_the_limits(options, size):
    with Server(*options) as server:
        async with Client(server) as client:
            frame = await client.request_frame()
        answer = await asyncio.to_thread(server.get, "/api/v1/frame.png")
        assert answer.status == 200
        assert pixels(frame)[0] == pixels(answer.body)[0] == size


async def test_the_number_of_edges_of_slices_is_limited():
    """A picture or a file of too many edges is refused, however it is asked for. The session goes on."""
    with Server("--max-slice-edges", 1000) as server:
        async with Client(server, stream="geometry") as client:
            await client.wait_for_slices(0)
            done = await client.request("set", polytope="120-cell")
            refused = lambda: [m for m in client.messages if m["type"] == "error"]
            await client.wait_until(refused)
            assert refused()[0]["code"] == "too_large" and "at most 1000 are allowed" in refused()[0]["message"]
            for what in ({"what": "frame"}, {"what": "slices"}, {"what": "at", "x": 300, "y": 200},
                         {"what": "file", "format": "csv", "of": "oval"}):
                assert (await request_refusal(client, "get", **what)).code == "too_large", what
            query = "polytope=120-cell&of=oval"
            for path in ("frame.png?polytope=120-cell", f"file.svg?{query}", f"file.stl?{query}"):
                answer = await asyncio.to_thread(server.get, f"/api/v1/{path}")
                assert answer.status == 413 and b"--max-slice-edges" in answer.body, path
            done = await client.request("set", polytope="24-cell")
            await client.wait_for_slices(done["revision"])


async def slice_fills(server, **settings):
    """Returns the triangles of each slice's fill, each as its three points."""
    async with Client(server) as client:
        await client.request("set", **settings)
        await client.request_frame(width=160, height=90)
        slices = (await client.request("get", what="slices"))["slices"]
        return [[[piece["fill"]["points"][i] for i in t] for t in piece["fill"]["triangles"]]
                for piece in slices if "fill" in piece]


def total_area(triangles):
    total = 0
    for a, b, c in triangles:
        u, v = ([q - p for p, q in zip(a, end)] for end in (b, c))
        total += sum((u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2]) ** 2 for i in range(3)) ** 0.5 / 2
    return total


async def test_faces_beyond_the_fill_limit_are_filled_approximately():
    star = {"polytope": "{5/2,5,3}", "slices": {"count": 5}}
    with Server() as server:
        exact = await slice_fills(server, **star)
    with Server("--max-fill", 1) as server:
        rough = await slice_fills(server, **star)
    assert len(exact) == len(rough) > 0
    for triangles, roughly in zip(exact, rough):
        assert total_area(roughly) > 1.01 * total_area(triangles), "the cores of the stars are covered more than once"
    failed = run_oval4d("--max-fill", "0")
    assert failed.returncode != 0 and b"max-fill" in failed.stderr + failed.stdout


def two_tesseracts(x=0):
    """Returns a tesseract, and behind it, at smaller w, one half as large, moved by `x` along x, as 4OFF."""
    lines = tesseract_file().splitlines()

    def moved(size, *by):
        for point in lines[2:18]:
            yield " ".join(str(size * float(own) + more) for own, more in zip(point.split(), by))

    def renumbered(records, by):
        for count, *items in (map(int, record.split()) for record in records):
            yield " ".join(map(str, [count, *(i + by for i in items)]))

    faces, cells = lines[18:42], lines[42:50]
    records = [*moved(1, 0, 0, 0, 3), *moved(0.5, x, 0, 0, -3), *faces, *renumbered(faces, 16), *cells, *renumbered(cells, 24)]
    return "\n".join(["4OFF", "32 48 64 16", *records]) + "\n"


async def test_beyond_the_limit_of_occlusion_only_cells_turned_away_are_left_out():
    async def made(server):
        """Returns whether nothing hidden is left, how many elements the projection has, a picture, a drawing and a mesh."""
        async with Client(server) as client:
            await client.request("load", name="boxes", format="off", data=two_tesseracts())
            await client.request("set", projection="orthogonal", shown={"back": False, "cells": True},
                                 orientation=[[int(i == j) for j in range(4)] for i in range(4)])
            projection = (await client.request("get", what="slices"))["projection"]
            part = projection["parts"][0]
            return ("only_turned_away" not in projection,
                    [len(part[kind]) for kind in ("vertices", "edges", "faces")],
                    pixels(await client.request_frame(width=320, height=180)),
                    await get_file(client, format="svg", of="projection"),
                    await get_file(client, format="stl", of="projection", body="skeleton"))

    with Server() as server:
        visible = await made(server)
    with Server("--max-occlusion", 1) as server:
        facing = await made(server)
    assert visible[:2] == (True, [8, 12, 6]), "the upper cell of the nearer tesseract"
    assert facing[:2] == (False, [16, 24, 12]), "and that of the farther one"
    assert all(one != other for one, other in zip(visible, facing))
    failed = run_oval4d("--max-occlusion", "0")
    assert failed.returncode != 0 and b"max-occlusion" in failed.stderr + failed.stdout


async def test_the_number_of_sessions_is_limited():
    with Server("--max-sessions", 2) as server:
        async with Client(server), Client(server):
            async with connect(server) as third:
                await third.send('{"type":"hello","id":1}')
                error = json.loads(await third.recv())
                assert error["code"] == "too_many" and "2" in error["message"]
                await (await third.ping())


async def test_a_session_is_not_evicted_for_one_that_another_limit_refuses():
    with Server("--max-client-sessions", 1, "--max-new-sessions", 1) as server:
        async with Client(server) as client:
            credentials = credentials_of(client)
        async with connect(server) as second:
            await second.send('{"type":"hello","id":1}')
            error = json.loads(await second.recv())
            assert error["code"] == "too_many" and "per minute" in error["message"]
        async with Client(server, **credentials):
            pass


async def connect_when_possible(server):
    """Connects as soon as the limit allows it: connections of earlier requests take a moment to end."""
    limit = time.monotonic() + DEADLINE
    while True:
        try:
            return await connect(server)
        except websockets.InvalidHandshake as full:
            assert handshake_status(full) == 503 and time.monotonic() < limit
            await asyncio.sleep(0.01)


async def test_the_number_of_connections_is_limited():
    with Server("--max-connections", 3) as server:
        clients = []
        for _ in range(3):
            clients.append(await connect_when_possible(server))
            # A new connection does not replace a connection that has said hello.
            await clients[-1].send('{"type":"hello"}')
            await clients[-1].recv()
        with pytest.raises(websockets.InvalidHandshake) as full:
            await connect(server)
        assert handshake_status(full.value) == 503
        assert server.get("/healthz").status == 503
        for client in clients:
            await (await client.ping())
            await client.close()
        server.wait_for(lambda: server.get("/healthz").status == 200)


async def test_requests_per_second_are_limited():
    with Server("--max-requests", 10) as server:
        async with Client(server) as client, Client(server) as bystander:
            start = time.monotonic()
            for number in range(30):
                await client.send("key", key="y", id=1000 + number)
            await client.wait_until(lambda: client.answer_to(1029))
            allowed = sum(client.answer_to(1000 + n)["type"] == "done" for n in range(30))
            errors = {client.answer_to(1000 + n).get("code") for n in range(30)} - {None}
            earned = 10 * (time.monotonic() - start)
            assert 19 <= allowed <= 21 + earned  # a burst may have 20 messages, including the hello
            assert errors <= {"too_many"} and (errors or earned > 9)
            try:
                for _ in range(2000):
                    await client.send("key", key="y")
            except websockets.ConnectionClosed:
                pass
            assert await client.wait_for_close_code() == 1008
            await bystander.request("key", key="y")


async def test_the_number_of_undo_steps_is_limited():
    with Server("--max-undo", 3) as server:
        async with Client(server) as client:
            for _ in range(5):
                await client.request("key", key="y")
            for _ in range(3):
                await client.request("undo")
            assert (await request_refusal(client, "undo")).code == "nothing_to_undo"


async def test_loaded_polytopes_and_their_vertices_are_limited():
    simplex = ("4OFF\n5 10 10 5\n1 1 1 -0.447214\n1 -1 -1 -0.447214\n-1 1 -1 -0.447214\n-1 -1 1 -0.447214\n"
               "0 0 0 1.788854\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 2 3\n3 0 2 4\n3 0 3 4\n3 1 2 3\n3 1 2 4\n3 1 3 4\n"
               "3 2 3 4\n4 0 1 3 6\n4 0 2 4 7\n4 1 2 5 8\n4 3 4 5 9\n4 6 7 8 9\n")
    with Server("--max-loaded", 1) as server:
        async with Client(server) as client:
            await client.request("load", name="one", format="off", data=simplex)
            assert (await request_refusal(client, "load", name="two", format="off", data=simplex)).code == "too_many"
    with Server("--max-vertices", 4) as server:
        async with Client(server) as client:
            assert (await request_refusal(client, "load", name="one", format="off", data=simplex)).code == "too_large"
            error = await request_refusal(client, "set", polytope="7,9-duoprism")
            assert error.code == "too_large" and "63 vertices" in error.text
            await client.request("set", polytope="5,7-duoprism")  # polytopes of the catalogue are exempt from the limit
            await client.request("set", polytope="600-cell")


async def test_the_size_of_the_polytope_cache_is_limited():
    names = ["omnitruncated 120-cell", "runcitruncated 120-cell", "runcitruncated 600-cell", "50,60-duoprism"]
    for option, least, most in ((0, 0, 0), ("2M", 1, 2 << 20), ("64M", 4 << 20, 64 << 20)):
        with Server("--polytope-cache", option) as server:
            async with Client(server) as client:
                for name in names:
                    await client.request("set", polytope=name)
                    state = await client.request("get", what="state")
                    assert state["polytope"]["name"] == name
            server.wait_for(lambda: least <= server.metric("oval4d_polytope_cache_bytes") <= most)


def answer_pings(raw, most):
    """Answers pings until `most` have come or the server ends the connection; returns how many have come."""
    ping, pong, count = 9, 10, 0
    with raw.makefile("rb") as frames, contextlib.suppress(ConnectionError):
        while count < most and len(head := frames.read(2)) == 2:
            size = head[1]
            if size > 125:  # longer sizes follow (RFC 6455, section 5.2)
                size = int.from_bytes(frames.read(2 if size == 126 else 8), "big")
            content = frames.read(size)
            if head[0] & 15 == ping:
                raw.sendall(masked_frame(content, opcode=pong))
                count += 1
    return count


def read_to_end(raw):
    with contextlib.suppress(ConnectionError):
        while raw.recv(1 << 16):
            pass


async def test_clients_that_answer_no_ping_are_disconnected():
    """A client that has said hello and is silent afterward."""
    with Server("--ping-interval", 0.5) as server:
        gone = open_nonreading_socket(server, '{"type":"hello"}')
        await asyncio.to_thread(read_to_end, gone)
        await asyncio.to_thread(server.wait_for, lambda: server.metric("oval4d_websockets") == 0)
        gone.close()


async def test_clients_that_answer_pings_stay():
    for interval in (0.5, 2, 8, 32):  # increases until this machine can answer a ping in time
        with Server("--ping-interval", interval) as server:
            silent = open_nonreading_socket(server, '{"type":"hello"}')
            # The server sends a second ping only after the client has answered the first.
            answered = await asyncio.to_thread(answer_pings, silent, 3)
            silent.close()
            if answered == 3:
                return
    pytest.fail("a client that answers pings is disconnected")


async def test_the_server_stops_reading_while_its_answers_are_unread():
    with Server("--max-unsent", "16k", "--io-threads", 1) as server:
        nonreading = open_nonreading_socket(server, '{"type":"hello"}')

        def flood():
            with contextlib.suppress(OSError):  # the socket is closed below
                while True:
                    nonreading.sendall(masked_frame('{"type":"get","what":"keymap"}') * 1000)

        flooding = threading.Thread(target=flood)
        flooding.start()
        async with Client(server) as other:
            async def messages_of_flood():
                """Returns how many messages of the flood arrive while the server serves 50 others."""
                before = server.metric("oval4d_messages_received_total")
                for _ in range(50):
                    await other.request("get", what="state")
                return server.metric("oval4d_messages_received_total") - before - 50

            while await messages_of_flood():
                pass
            received = server.metric("oval4d_messages_received_total")
            assert received > 52, "none of the flood was read"
            assert await messages_of_flood() == 0
            assert flooding.is_alive()
        nonreading.shutdown(socket.SHUT_RDWR)
        flooding.join()
        nonreading.close()


@pytest.mark.parametrize("words, expected_text", [
    (["--port", "99999"], "port"), (["--max-message", "lots"], "max-message"), (["--max-depth", "0"], "max-depth"),
    (["--ping-interval", "-1"], "ping-interval"), (["--nonsense"], "nonsense"), (["--log-level", "loud"], "log-level"),
    (["--workers", "many"], "workers"), (["dance"], "dance"),
])
def test_an_invalid_option_is_explained(words, expected_text):
    done = run_oval4d(*words)
    assert done.returncode != 0 and expected_text in (done.stderr + done.stdout).decode()


async def test_environment_variables_set_options():
    with Server(OVAL4D_MAX_SLICES="31", OVAL4D_MAX_MESSAGE="1M") as server:
        async with Client(server) as client:
            assert client.welcome["limits"]["slices"] == 31 and client.welcome["limits"]["message"] == 1 << 20
    with Server("--max-slices", 33, OVAL4D_MAX_SLICES="31") as server:
        async with Client(server) as client:
            assert client.welcome["limits"]["slices"] == 33
