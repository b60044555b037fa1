"""Arrays in uploads: formats, names, tokens, limits, and broken requests."""

import asyncio
import concurrent.futures
import contextlib
import re
import socket
import time
from urllib.parse import quote, quote_plus

import numpy
import pytest
from array_clients import SIZE, load, put, state_of, unnumbered, upload
from array_files import WRITERS, netcdf, npy, quadratic
from harness import DEADLINE, Server
from surfaces import surface_volume
from wire import Client, Refused


@pytest.mark.parametrize("format_", WRITERS)
@pytest.mark.parametrize("named", [True, False])
async def test_every_format_can_be_uploaded(server, format_, named):
    async with Client(server, stream="geometry") as client, \
            Client(server, client.welcome["session"], token=client.welcome["token"]) as other:
        answer = await put(client, "ball", WRITERS[format_](quadratic()), **({"format": format_} if named else {}))
        assert answer.status == 200, answer.body
        assert answer.message["type"] == "done" and answer.message["revision"] == 1
        for each in (client, other):
            await each.wait_until(lambda c=each: any(isinstance(m, dict) and m["type"] == "state" and
                                                     m["polytope"]["name"] == "ball" for m in c.messages))
        uploaded = (await client.request("get", what="slices", **SIZE))["slices"]
        await load(client, "ball", WRITERS[format_](quadratic()), format_)
        loaded = (await client.request("get", what="slices", **SIZE))["slices"]
        assert any("surface" in piece for piece in loaded) and uploaded == loaded


async def test_an_uploaded_ball_has_the_volume_of_a_ball(server):
    """The body where 1 − |p|² is above 1 − r² is a 4-ball; its middle slice is a ball of radius r."""
    radius = 0.8
    async with Client(server) as client:
        box = ",".join(["-1,1"] * 4)
        answer = await put(client, "ball", npy(quadratic((33, 34, 35, 36))), box=box, axes="tzyx", format="npy")
        assert answer.status == 200, answer.body
        await client.request("set", levels=[1 - radius**2], slices={"count": 1, "w": 0})
        piece = (await client.request("get", what="slices", **SIZE))["slices"][0]
        assert surface_volume(piece) == pytest.approx(4 / 3 * numpy.pi * radius**3, rel=0.02)


async def test_an_upload_may_be_larger_than_a_message(server):
    values = numpy.random.default_rng(2).random((20, 48, 48, 60), dtype="f4")  # 11 MB
    async with Client(server) as client:
        assert values.nbytes > client.welcome["limits"]["message"]
        answer = await put(client, "large", npy(values), box="0,1,0,1,0,1,0,1")
        assert answer.status == 200, answer.body
        assert (await state_of(client))["polytope"]["name"] == "large"


@pytest.mark.parametrize("change, status, code", [
    ({"token": "wrong"}, 401, "bad_token"),
    ({"token": None}, 401, "bad_token"),
    ({"token": ""}, 401, "bad_token"),
    ({"session": "nobody"}, 404, "not_found"),
    ({"name": "24-cell"}, 400, "bad_polytope"),
    ({"name": ""}, 400, "bad_message"),
    ({"name": "x" * 65}, 400, "bad_message"),
    ({"name": "a\nb"}, 400, "bad_message"),
    ({"name": b"\xff\xfe"}, 400, "bad_message"),
    ({"body": b"hello"}, 415, "unsupported_format"),
    ({"body": b""}, 400, "bad_field"),
    ({"body": npy(quadratic())[:-1]}, 400, "bad_field"),
    ({"format": "off"}, 415, "unsupported_format"),
    ({"format": "formula"}, 415, "unsupported_format"),
    ({"format": "jpeg"}, 415, "unsupported_format"),
    ({"axes": "tzy"}, 400, "out_of_range"),
    ({"axes": "tzyy"}, 400, "out_of_range"),
    ({"box": "0,1,0,1"}, 400, "bad_expression"),
    ({"box": "0,1,0,1,0,1,1,1"}, 400, "out_of_range"),
    ({"box": "0,1,0,1,0,1,0,1e999"}, 400, None),
    ({"axis": "tzyx"}, 400, "bad_message"),
    ({"method": "POST"}, 404, "not_found"),
    ({"method": "POST", "moments": True}, 404, "not_found"),
])
async def test_a_wrong_upload_is_refused_and_changes_nothing(server, change, status, code):
    async with Client(server) as client:
        before = unnumbered(await state_of(client))
        arguments = {"session": client.welcome["session"], "token": client.welcome["token"], "name": "ball",
                     "body": npy(quadratic())} | change
        answer = await asyncio.to_thread(lambda: upload(server, **arguments))
        assert answer.status == status, answer.body
        assert code is None or answer.message["code"] == code
        assert unnumbered(await state_of(client)) == before
        assert (await put(client, "ball", npy(quadratic()))).status == 200


async def test_names_are_decoded(server):
    async with Client(server) as client:
        for name in ("run 7", "a/b", "moments", "a/moments", "ψ=½ & more?", "x" * 64, "π" * 64):
            answer = await put(client, name, npy(quadratic()))
            assert answer.status == 200, (name, answer.body)
            assert (await state_of(client))["polytope"]["name"] == name
        answer = await put(client, "one too many", npy(quadratic())), await put(client, "another", npy(quadratic()))
        assert answer[1].status == 429 and answer[1].message["code"] == "too_many"


async def test_an_upload_opens_a_session_that_nobody_has_open(server):
    async with Client(server) as client:
        await client.request("key", key="y")
        welcome = client.welcome
    answer = await asyncio.to_thread(upload, server, welcome["session"], welcome["token"], "ball", npy(quadratic()))
    assert answer.status == 200
    async with Client(server, welcome["session"], token=welcome["token"]) as again:
        assert (await state_of(again))["polytope"]["name"] == "ball"


def raw_request(session, token, length, path="/fields/a", method="PUT", lines=()):
    return "\r\n".join([f"{method} /api/v1/sessions/{session}{path} HTTP/1.1", "Host: localhost",
                        f"Session-Token: {token}", *([f"Content-Length: {length}"] if length is not None else []),
                        *lines, "", ""]).encode()


def exchange(server, data, finish=True):
    """Sends bytes, and returns everything that the server sends until it closes the connection."""
    with socket.create_connection((server.host, server.port), timeout=DEADLINE) as raw:
        raw.sendall(data)
        if finish:
            raw.shutdown(socket.SHUT_WR)
        answer = b""
        with contextlib.suppress(ConnectionResetError):
            while data := raw.recv(65536):
                answer += data
        return answer


async def test_a_truncated_body_changes_nothing(server):
    body = npy(quadratic())
    async with Client(server) as client:
        welcome = client.welcome
        for sent in (0, 1, 1000, len(body) - 1):
            request = raw_request(welcome["session"], welcome["token"], len(body)) + body[:sent]
            assert await asyncio.to_thread(exchange, server, request) == b""
        assert (await state_of(client))["revision"] == 0


@pytest.mark.parametrize("lines, length, status", [
    ([], None, b"411"), (["Transfer-Encoding: chunked"], None, b"411"), (["Transfer-Encoding: gzip"], None, b"400"),
    (["Transfer-Encoding: chunked"], 5, b"400"), (["Content-Length: 5"], 6, b"400"), ([], "+5", b"400"),
    ([], 99999999999999999999999, b"400"), ([], 2**64 - 1, b"413"), (["Expect: something"], 5, b"417"),
])
async def test_the_length_of_a_body_must_be_certain(server, lines, length, status):
    async with Client(server) as client:
        request = raw_request(client.welcome["session"], client.welcome["token"], length, lines=lines)
        answer = await asyncio.to_thread(exchange, server, request + b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n", False)
        assert answer.startswith(b"HTTP/1.1 " + status) and len(re.findall(rb"HTTP/1\.1 \d", answer)) == 1, answer


async def test_a_request_may_follow_an_upload(server):
    body = npy(quadratic())
    async with Client(server) as client:
        welcome = client.welcome
        request = raw_request(welcome["session"], welcome["token"], len(body), lines=["Expect: 100-continue"])
        with socket.create_connection((server.host, server.port), timeout=DEADLINE) as raw:
            raw.sendall(request)
            assert raw.recv(1000) == b"HTTP/1.1 100 Continue\r\n\r\n"
            raw.sendall(body + b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            answers = b""
            while part := await asyncio.to_thread(raw.recv, 65536):
                answers += part
        assert answers.startswith(b"HTTP/1.1 200") and answers.endswith(b"\r\n\r\nok\n")


async def test_too_large_files_are_refused_before_they_are_read():
    with Server("--max-upload", "20k", "--max-field-bytes", "64k") as server:
        async with Client(server) as client:
            assert client.welcome["limits"]["upload"] == 20 << 10
            request = raw_request(client.welcome["session"], client.welcome["token"], (20 << 10) + 1)
            answer = await asyncio.to_thread(exchange, server, request, False)
            assert answer.startswith(b"HTTP/1.1 413") and b'"too_large"' in answer
            flat = numpy.arange(16 << 10, dtype="u1")  # becomes 64 KiB of floats
            assert (await put(client, "a", npy(flat.reshape(16, 1024)))).status == 200
            answer = await put(client, "b", npy(numpy.arange(17 << 10, dtype="u1").reshape(17, 1024)))
            assert answer.status == 413 and "too many samples" in answer.message["message"]
            with pytest.raises(Refused, match="too many samples"):
                await load(client, "b", npy(numpy.arange(17 << 10, dtype="u1").reshape(17, 1024)))


async def test_a_slow_upload_is_dropped():
    with Server("--write-timeout", 0.5, "--min-read-rate", "64k") as server:
        async with Client(server) as client:
            request = raw_request(client.welcome["session"], client.welcome["token"], 1 << 20)
            assert await asyncio.to_thread(exchange, server, request + b"x", False) == b""

            def drip():  # sends bytes just in time for each read, but far below the minimum rate
                with socket.create_connection((server.host, server.port), timeout=DEADLINE) as raw:
                    raw.sendall(request)
                    raw.settimeout(0.1)
                    limit = time.monotonic() + DEADLINE
                    while time.monotonic() < limit:
                        try:
                            raw.sendall(b"x")
                            if raw.recv(1) == b"":
                                return
                        except TimeoutError:
                            continue
                        except OSError:
                            return
                    pytest.fail("the upload is not dropped")

            await asyncio.to_thread(drip)
            await asyncio.to_thread(server.wait_for, lambda: server.metric("oval4d_slow_readers_total") >= 2)
            await client.request("key", key="y")


async def test_the_bytes_of_uploads_are_counted():
    """Two unfinished uploads hold as many bytes as a client may; the third is refused, until one of them ends."""
    with Server("--max-client-bytes", "10340k", "--max-upload", "8M") as server:
        async with Client(server) as client:
            request = raw_request(client.welcome["session"], client.welcome["token"], 6 << 20)
            held = lambda: server.metric("oval4d_client_bytes")
            with contextlib.ExitStack() as stack:
                for _ in range(2):
                    raw = stack.enter_context(socket.create_connection((server.host, server.port), timeout=DEADLINE))
                    raw.sendall(request + bytes(5 << 20))
                await asyncio.to_thread(server.wait_for, lambda: held() >= 10 << 20)
                answer = await put(client, "third", npy(numpy.zeros(50_000, "f4")))
                assert answer.status == 429 and answer.message["code"] == "too_many"
                assert answer.getheader("Retry-After")
            await asyncio.to_thread(server.wait_for, lambda: held() <= 1 << 20)
            assert (await put(client, "third", npy(quadratic()))).status == 200


async def test_many_uploads_at_once(server):
    async with Client(server) as client:
        welcome = client.welcome
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            answers = list(pool.map(lambda n: upload(server, welcome["session"], welcome["token"], f"run {n % 4}",
                                                     npy(quadratic() + n)), range(16)))
        assert [answer.status for answer in answers] == [200] * 16
        assert sorted(answer.message["revision"] for answer in answers) == list(range(1, 17))


@pytest.mark.parametrize("encoding", [quote, quote_plus])
async def test_a_variable_with_a_plus_and_a_blank_is_found(server, encoding):
    async with Client(server) as client:
        file = netcdf(quadratic(), "u+v mean")
        answer = await put(client, "u+v mean", file, quote_via=encoding, variable="u+v mean", axes="tzyx")
        assert answer.status == 200, answer.body
        assert (await state_of(client))["polytope"]["name"] == "u+v mean"


async def test_an_upload_needs_the_token_of_the_server_too():
    with Server("--token", "sesame") as server:
        async with Client(server, address=None, session="?token=sesame") as client:
            welcome = client.welcome
            body = npy(quadratic())
            answer = await asyncio.to_thread(upload, server, welcome["session"], welcome["token"], "a", body)
            assert answer.status == 401
            answer = await asyncio.to_thread(upload, server, welcome["session"], welcome["token"], "a", body,
                                             server_token="sesame")
            assert answer.status == 200, answer.body


async def test_wrong_tokens_are_counted():
    with Server("--max-wrong-tokens", 3) as server:
        async with Client(server) as client:
            session, token = client.welcome["session"], client.welcome["token"]
            statuses = [upload(server, session, "wrong", "a", npy(quadratic())).status for _ in range(4)]
            assert statuses == [401, 401, 401, 429]
            assert upload(server, session, token, "a", npy(quadratic())).status == 429
