"""Invalid messages: the error tells the sender what is wrong, and other sessions are not affected."""

import json

import pytest
from harness import Server
from wire import Client, connect, hello_refusal

HUGE = 10_000_000


@pytest.mark.parametrize("message, code, expected_text", [
    ({"type": "keys"}, "unknown_type", "key"),
    ({"type": 3}, "", "type"),
    ({}, "bad_message", "type"),
    ([], "bad_message", ""),
    ({"type": "key"}, "bad_message", "key"),
    ({"type": "key", "key": "y", "shfit": True}, "bad_message", "shift"),
    ({"type": "key", "key": "q"}, "unknown_key", "q"),
    ({"type": "key", "key": 5}, "bad_message", "key"),
    ({"type": "key", "key": ":"}, "unknown_key", ":"),
    ({"type": "rotate", "planes": ["xw", "xw"], "angles": [1, 1]}, "bad_message", "different planes"),
    ({"type": "rotate", "planes": ["xw"], "angles": ["1"]}, "bad_message", "angles"),
    ({"type": "rotate", "planes": ["xw"], "angles": []}, "bad_message", ""),
    ({"type": "rotate", "planes": ["ww"], "angles": [1]}, "bad_message", "xy"),
    ({"type": "rotate", "planes": ["xw"], "angles": [1e300]}, "out_of_range", "angles"),
    ({"type": "set", "polytope": "25-cell"}, "unknown_polytope", "5-cell"),
    ({"type": "set", "slices": {"count": 20}}, "out_of_range", "20"),
    ({"type": "set", "slices": {"count": 203}}, "out_of_range", "201"),
    ({"type": "set", "view": "round"}, "bad_message", "oval"),
    ({"type": "set", "orientation": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, -1]]}, "not_a_rotation", ""),
    ({"type": "command", "line": "plytope 5-cell"}, "unknown_command", "polytope"),
    ({"type": "command", "line": "rotate xw 1/0"}, "bad_expression", ""),
    ({"type": "load", "name": "x", "format": "off", "data": "OFF 1 2"}, "bad_polytope", ""),
    ({"type": "load", "name": "x", "format": "stl", "data": ""}, "unsupported_format", "off"),
    ({"type": "undo"}, "nothing_to_undo", ""),
    ({"type": "get", "what": "everything"}, "bad_message", "state"),
    ({"type": "get", "what": "frame", "width": 0, "height": 10}, "", "width"),
    ({"type": "get", "what": "frame", "width": 100_000, "height": 100_000}, "out_of_range", "8192"),
    ({"type": "get", "what": "slices", "width": 100_000, "height": 100}, "out_of_range", "8192"),
    ({"type": "get", "what": "frame", "width": 8192, "height": 8192}, "out_of_range", "16777216"),
    ({"type": "hello", "stream": "frames", "width": 100_000, "height": 10}, "out_of_range", "8192"),
    ({"type": "hello", "stream": "frames", "width": 15, "height": 100}, "out_of_range", "16"),
    ({"type": "hello", "stream": "film"}, "bad_message", "geometry"),
    ({"type": "shown", "revision": -1}, "out_of_range", "revision"),
])
async def test_an_invalid_message_gets_an_explanatory_error(server, message, code, expected_text):
    async with Client(server, stream="geometry") as client:
        before = await client.request("get", what="state")
        if isinstance(message, dict):
            message = {**message, "id": 4711}
        await client.socket.send(json.dumps(message))
        error = await client.wait_until(lambda: next(
            (m for m in client.messages if isinstance(m, dict) and m["type"] == "error"), None))
        assert code in error["code"] and expected_text in error["message"], error
        if isinstance(message, dict):
            assert error["id"] == 4711
        after = await client.request("get", what="state")
        assert {**after, "id": 0} == {**before, "id": 0}


@pytest.mark.parametrize("angle", ["NaN", "Infinity", "-Infinity", "1e999"])
async def test_nonfinite_angles_are_refused(server, angle):
    """NaN and Infinity are not JSON; 1e999 is valid JSON, but out of range."""
    async with Client(server) as client:
        await client.socket.send('{"type":"rotate","id":4711,"planes":["xw"],"angles":[%s]}' % angle)
        error = await client.wait_until(lambda: next((m for m in client.messages if m["type"] == "error"), None))
        assert error["code"] in ("bad_json", "bad_message", "out_of_range")
        if error["code"] == "bad_json":
            assert await client.wait_for_close_code() == 1007


@pytest.mark.parametrize("data, error, close", [
    ("{", "bad_json", 1007),
    ("hello", "bad_json", 1007),
    ("", "bad_json", 1007),
    (b'{"type":"hello"}', "bad_message", 1003),
    ('{"type":"load","name":"x","format":"off","data":"' + "0 " * (HUGE // 2) + '"}', None, 1009),
])
async def test_malformed_messages_end_the_connection(server, data, error, close):
    async with Client(server) as bystander, connect(server) as socket:
        try:
            await socket.send(data)
            async for answer in socket:
                assert json.loads(answer)["code"] == error
        except Exception as end:  # whether a close raises an exception depends on the library's version
            assert type(end).__name__.startswith("ConnectionClosed"), end
        assert socket.close_code == close
        await bystander.request("key", key="y")


@pytest.mark.parametrize("text", ["\\ud800", "\\udc00", "\\ud83d!", "\\ud83d\\ud83d\\ude00", "\\\\\\udfff"])
async def test_a_lone_surrogate_is_refused_with_the_id(server, text):
    async with Client(server) as client:
        await client.socket.send('{"type":"set","id":4711,"polytope":"%s"}' % text)
        error = await client.wait_until(lambda: next((m for m in client.messages if m["type"] == "error"), None))
        assert error["code"] == "bad_json" and error["id"] == 4711 and "lone surrogate" in error["message"]
        await client.socket.send('{"type":"set","id":4712,"polytope":"\\ud83d\\ude00"}')
        error = await client.wait_until(lambda: next((m for m in client.messages if m.get("id") == 4712), None))
        assert error["code"] == "unknown_polytope"
        await client.request("key", key="y")


async def test_invalid_utf8_ends_the_connection(server):
    from test_pacing import open_nonreading_socket, masked_frame

    raw = open_nonreading_socket(server)
    raw.sendall(masked_frame(b'{"type":"hello\xff"}'))
    received = b""
    while chunk := raw.recv(4096):
        received += chunk
    raw.close()
    assert (1007).to_bytes(2, "big") in received


async def test_too_deeply_nested_json_is_refused(server):
    async with Client(server) as client:
        await client.socket.send('{"type":"key","key":' + "[" * 30_000 + "]" * 30_000 + "}")
        error = await client.wait_until(lambda: next((m for m in client.messages if m["type"] == "error"), None))
        assert error["code"] == "bad_json" and "32" in error["message"]
        await client.request("key", key="y")


async def test_requests_before_hello_are_refused(server):
    async with connect(server) as socket:
        await socket.send('{"type":"key","key":"y","id":1}')
        error = json.loads(await socket.recv())
        assert error["code"] == "hello_first" and error["id"] == 1
        await socket.send('{"type":"hello"}')
        assert json.loads(await socket.recv())["type"] == "welcome"


async def test_a_token_without_a_session_is_refused(server):
    assert await hello_refusal(server, token="abc") == ("bad_token", 4401)


async def test_errors_reveal_no_implementation_details(server):
    async with Client(server) as client:
        for text in ('{"type":"get","what":"state","id":"x"}', '{"type":"set","polytope":7}', '{"type":null}',
                     '{"type":"command","line":"\\u0000"}', '{"type":"command","line":"set slices=9e99"}'):
            await client.socket.send(text)
        await client.request("get", what="state")
        errors = [m for m in client.messages if m["type"] == "error"]
        assert len(errors) == 5
        for error in errors:
            assert error["code"] != "internal"
            for inside in ("nlohmann", "exception", ".cpp", "std::", "0x", "json."):
                assert inside not in error["message"]


async def test_invalid_messages_do_not_affect_other_clients():
    with Server() as server:
        async with Client(server, stream="geometry") as bystander:
            for text in ["[" * 1000, '{"type":"' + "x" * 60_000 + '"}', "null", '"key"', '{"type":"hello","id":{}}']:
                async with connect(server) as socket:
                    await socket.send(text)
                    await socket.recv()
            done = await bystander.request("key", key="y")
            await bystander.wait_for_slices(done["revision"])
