"""Arrays in messages and in uploads: axes, boxes and variables, growing fields, tokens, limits, broken requests."""

import asyncio
import base64
import concurrent.futures
import contextlib
import http.client
import json
import re
import socket
import time
from urllib.parse import quote, urlencode

import numpy
import pytest
from array_files import WRITERS, hdf5, netcdf, npy, quadratic
from harness import DEADLINE, Server
from surfaces import surface_volume
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}


def upload(server, session, token, name, body, method="PUT", moments=False, server_token=None, **query):
    """Uploads a file; returns the http.client response, with the decoded message as `.message`."""
    connection = http.client.HTTPConnection(server.host, server.port, timeout=DEADLINE)
    path = f"/api/v1/sessions/{session}/fields/{quote(name, safe='')}" + ("/moments" if moments else "")
    query = urlencode(query | ({"token": server_token} if server_token else {}), quote_via=quote)
    with contextlib.closing(connection):
        connection.request(method, path + ("?" + query if query else ""), body,
                           {} if token is None else {"Session-Token": token})
        answer = connection.getresponse()
        answer.body = answer.read()
        is_json = answer.getheader("Content-Type") == "application/json"
        answer.message = json.loads(answer.body) if is_json else None
        return answer


async def put(client, name, body, **options):
    welcome = client.welcome
    return await asyncio.to_thread(upload, client.server, welcome["session"], welcome["token"], name, body, **options)


async def load(client, name, body, format_="npy", **members):
    return await client.request("load", name=name, format=format_, data=base64.b64encode(body).decode(), **members)


async def state_of(client):
    return await client.request("get", what="state")


def unnumbered(message):
    return {name: value for name, value in message.items() if name != "id"}


async def domain_of(client):
    """Returns the extents of the box along x, y, z and w, in units of the object: those of the focus slice and of w."""
    await client.request("set", orientation=[[int(i == j) for j in range(4)] for i in range(4)],
                         slices={"count": 1, "focus": 0, "offset": 0})
    message = await client.request("get", what="slices", **SIZE)
    extents = numpy.ptp(numpy.array(message["slices"][0]["vertices"]), axis=0)
    radius = message["scene"]["circumradius"]
    half = numpy.sqrt(radius**2 - numpy.sum((extents / 2) ** 2))
    return [*extents, 2 * half]


@pytest.mark.parametrize("axes, shape, expected", [
    ("tzyx", (3, 4, 5, 9), (2, 1, 0.75, 2)),  # by default, the longest of x, y, z is 2 long, and w as long as it
    ("wzyx", (3, 4, 5, 9), (2, 1, 0.75, 2)),
    ("xyzt", (9, 5, 4, 3), (2, 1, 0.75, 2)),
    ("zyx", (4, 5, 9), (2, 1, 0.75, 1)),  # without w, half as long as the longest
    ("tx", (3, 5), (2, 1, 1, 2)),
])
async def test_axes_name_the_dimensions(server, axes, shape, expected):
    values = numpy.random.default_rng(1).random(shape, dtype="f4")
    async with Client(server) as client:
        await load(client, "a", npy(values), axes=axes)
        assert await domain_of(client) == pytest.approx(expected, rel=1e-5)


async def test_a_box_places_an_array(server):
    async with Client(server) as client:
        await load(client, "a", npy(quadratic()), box=[[0, 4], [0, 2], [-1, 1], [0, 10]])
        assert await domain_of(client) == pytest.approx((4, 2, 2, 4), rel=1e-5)  # w is scaled to the longest


async def test_a_variable_is_chosen_by_its_name(server):
    async with Client(server) as client:
        await load(client, "a", hdf5(quadratic(), "run/p"), "hdf5", variable="run/p")
        await load(client, "b", netcdf(quadratic(), "p"), "netcdf", variable="p")
        for body, format_ in ((hdf5(quadratic()), "hdf5"), (netcdf(quadratic()), "netcdf")):
            with pytest.raises(Refused, match="absent") as refused:
                await load(client, "c", body, format_, variable="absent")
            assert refused.value.code in ("bad_field", "not_found", "out_of_range")


@pytest.mark.parametrize("members, code, text", [
    ({"axes": "tzy"}, "out_of_range", "4 dimensions"),
    ({"axes": "tzyy"}, "out_of_range", "different letters"),
    ({"axes": "wtyx"}, "out_of_range", "different letters"),
    ({"axes": "abcd"}, "out_of_range", "different letters"),
    ({"axes": "TZYX"}, "out_of_range", "different letters"),
    ({"axes": ""}, "bad_message", "axes"),
    ({"axes": "tzyxx"}, "bad_message", "axes"),
    ({"axes": 4}, "bad_message", "axes"),
    ({"variable": 4}, "bad_message", "variable"),
    ({"box": [[0, 1], [0, 1], [0, 1], [1, 1]]}, "out_of_range", "no extent along w"),
    ({"box": [[1, 0], [0, 1], [0, 1], [0, 1]]}, "out_of_range", "no extent along x"),
    ({"box": [[0, 1e31], [0, 1], [0, 1], [0, 1]]}, "bad_field", "1e30"),
    ({"box": [[0, 1]] * 3}, "bad_message", "box"),
    ({"append": 1}, "bad_message", "append"),
])
async def test_wrong_members_of_arrays_are_refused(server, members, code, text):
    async with Client(server) as client:
        before = unnumbered(await state_of(client))
        with pytest.raises(Refused) as refused:
            await load(client, "a", npy(quadratic()), **members)
        assert refused.value.code == code and text in refused.value.text
        assert unnumbered(await state_of(client)) == before


@pytest.mark.parametrize("members", [{"axes": "x"}, {"variable": "v"}, {"append": True}])
@pytest.mark.parametrize("format_, data", [("points", "0 0 0 0"), ("formula", "x")])
async def test_only_arrays_take_these_members(server, format_, data, members):
    async with Client(server) as client:
        with pytest.raises(Refused, match="only arrays|no field called") as refused:
            await client.request("load", name="a", format=format_, data=data, **members)
        assert refused.value.code in ("bad_message", "not_found")


# --- Uploads

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

            def drip():  # a byte in time for each read, but far below the rate
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


# --- Growing fields

@pytest.mark.parametrize("by_http", [True, False])
async def test_appended_moments_equal_the_whole_array(server, by_http):
    values = quadratic((12, 9, 10, 11))
    async with Client(server) as client, Client(server) as whole:
        await load(client, "run", npy(values[:2]), box=[[-1, 1], [-1, 1], [-1, 1], [0, 1]])
        await load(whole, "run", npy(values), box=[[-1, 1], [-1, 1], [-1, 1], [0, 11]])
        settings = {"levels": [0.25], "inside": "above", "slices": {"count": 11, "spacing": 0.2}}
        for each in (client, whole):
            await each.request("set", **settings)
            await each.request("rotate", planes=["xw"], angles=[0.3])
        for moment in range(2, 12):
            if by_http:
                answer = await put(client, "run", npy(values[moment]), method="POST", moments=True)
                assert answer.status == 200, answer.body
            else:
                await load(client, "run", npy(values[moment : moment + 1]), append=True)
        grown, expected = [unnumbered(await state_of(each)) for each in (client, whole)]
        assert grown["revision"] == 13 and expected["revision"] == 3
        assert {**grown, "revision": 0} == {**expected, "revision": 0}
        grown, expected = [(await each.request("get", what="slices", **SIZE))["slices"] for each in (client, whole)]
        assert grown == expected and any("surface" in piece for piece in grown)
        await client.request("undo")  # the rotation, not the moments
        await whole.request("undo")
        grown, expected = [(await each.request("get", what="slices", **SIZE))["slices"] for each in (client, whole)]
        assert grown == expected


async def test_a_field_grows_while_another_object_is_shown(server):
    values = quadratic((4, 5, 6, 7))
    async with Client(server) as client:
        await load(client, "run", npy(values[:1]))
        await client.request("set", polytope="24-cell")
        done = await load(client, "run", npy(values[1:]), append=True)
        assert done["revision"] == 2 and (await state_of(client))["polytope"]["name"] == "24-cell"
        await client.request("set", polytope="run")
        await client.request("set", levels=[0.5])
        welcome = client.welcome
        slices = (await client.request("get", what="slices", **SIZE))["slices"]
    async with Client(server, welcome["session"], token=welcome["token"]) as again:  # from the store
        assert (await again.request("get", what="slices", **SIZE))["slices"] == slices


@pytest.mark.parametrize("name, values, code, text", [
    ("run", quadratic((1, 5, 6, 8)), "bad_field", "8 × 6 × 5 samples along x, y and z, but the field has 7 × 6 × 5"),
    ("nothing", quadratic((1, 5, 6, 7)), "not_found", "no field called 'nothing'"),
    ("formula", quadratic((1, 5, 6, 7)), "bad_field", "only to an array"),
])
async def test_moments_that_do_not_fit_are_refused(server, name, values, code, text):
    async with Client(server) as client:
        await client.request("command", line="formula x")
        await load(client, "run", npy(quadratic((4, 5, 6, 7))))
        before = unnumbered(await state_of(client))
        with pytest.raises(Refused) as refused:
            await load(client, name, npy(values), append=True)
        assert refused.value.code == code and text in refused.value.text
        assert unnumbered(await state_of(client)) == before


async def test_a_growing_field_is_bounded():
    values = quadratic((4, 8, 8, 8))  # 2 KiB a moment
    with Server("--max-field-bytes", "32k") as server:
        async with Client(server) as client:
            await load(client, "run", npy(values))
            for _ in range(3):
                await load(client, "run", npy(values), append=True)
            with pytest.raises(Refused, match="more than 8192 samples") as refused:
                await load(client, "run", npy(values[0]), append=True)
            assert refused.value.code == "too_large"


@pytest.mark.release_only
async def test_a_growing_field_is_held_once(server):
    """The history does not keep the shorter versions."""
    values = quadratic((2, 32, 32, 32))
    with Server("--max-client-bytes", "64M") as own:
        async with Client(own) as client:
            await load(client, "run", npy(values))
            for moment in range(60):
                await client.request("rotate", planes=["xw"], angles=[0.1])
                await load(client, "run", npy(values[moment % 2]), append=True)
            # 62 time steps of 128 KiB, and a margin. What a request reserves is freed shortly after its answer.
            own.wait_for(lambda: own.metric("oval4d_client_bytes") < 20 << 20)
            for _ in range(60):
                await client.request("undo")
            assert (await state_of(client))["polytope"]["name"] == "run"
