"""A picture, or a state as JSON, is shown again: over HTTP, by the Python client and on the command line."""

import asyncio
import contextlib
import http.client
import io
import json
import subprocess
import sys
from pathlib import Path

import numpy
import png
import pytest
from harness import DEADLINE, PROGRAM, Server
from PIL import Image
from wire import Client

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402

SIZE = {"width": 320, "height": 200}


def put_state(server, welcome, body, path="state", token=None):
    """Sends a file that contains a state; returns the status and the message of the answer."""
    connection = http.client.HTTPConnection(server.host, server.port, timeout=DEADLINE)
    with contextlib.closing(connection):
        connection.request("PUT", f"/api/v1/sessions/{welcome['session']}/{path}", body,
                           {"Session-Token": welcome["token"] if token is None else token})
        answer = connection.getresponse()
        return answer.status, json.loads(answer.read())


@contextlib.asynccontextmanager
async def session_with(server, body):
    """Yields a client of a new session into which a picture, or a state as JSON, has been put."""
    async with Client(server, stream="none") as client:
        status, done = await asyncio.to_thread(put_state, server, client.welcome, body)
        assert status == 200 and done["type"] == "done", done
        yield client


def settings(state):
    """Returns the settings of a state, with the orientation rounded: a matrix and its rotation differ by about 1e-16."""
    others = ("revision", "object_serial", "id", "type", "moving", "draft")
    kept = {name: value for name, value in state.items() if name not in others}
    return kept | {"orientation": numpy.round(state["orientation"], 12).tolist()}


def difference(first, second):
    """Returns the mean difference of the values of two pictures, of 0 to 255."""
    (size, values), (other_size, other_values) = png.pixels(first), png.pixels(second)
    assert size == other_size
    return numpy.abs(numpy.frombuffer(values, numpy.uint8).astype(int) - numpy.frombuffer(other_values, numpy.uint8)).mean()


async def turned_polytope(client):
    await client.request("set", polytope="24-cell", hidden=[], color="w")
    await client.request("rotate", planes=["xw", "yz"], angles=[0.4, 1.1])
    await client.request("set", slices={"count": 7, "focus": 2}, camera={"azimuth": 0.3, "elevation": 0.2, "zoom": 1.5})


async def field_with_levels(client):
    await client.request("load", name="mine", format="formula", data="x^2 + y^2 + a*z^2 - w^2 < 0.2; a=0.4", values="x*w",
                         box=[[-1, 1], [-1, 1], [-1, 1], [-2, 1]])
    await client.request("set", levels=[0.1, 0.3], inside="above", color="value", pace=1.5)
    await client.request("rotate", planes=["zw"], angles=[0.5])


@pytest.mark.parametrize("prepare", [turned_polytope, field_with_levels])
async def test_a_picture_and_its_state_are_restored_in_another_session(server, prepare):
    async with Client(server, stream="none") as client:
        await prepare(client)
        state = await client.request("get", what="state")
        picture = await client.request_frame(**SIZE)
    for body in (picture, json.dumps(state).encode()):
        async with session_with(server, body) as other:
            assert settings(await other.request("get", what="state")) == settings(state)
            assert difference(await other.request_frame(**SIZE), picture) < 0.01
            await other.request("undo")
            assert (await other.request("get", what="state"))["polytope"]["name"] == "5-cell"


async def test_a_file_without_a_state_is_refused(server):
    plain = io.BytesIO()
    Image.new("RGB", (4, 4)).save(plain, "PNG")
    async with Client(server, stream="none") as client:
        before = await client.request("get", what="state")

        async def refusal(body, **options):
            status, message = await asyncio.to_thread(put_state, server, client.welcome, body, **options)
            return status, message["code"], message["message"]

        status, code, text = await refusal(plain.getvalue())
        assert (status, code) == (400, "bad_message") and "contains no state" in text
        for body, code in ((b"", "bad_field"), (b"OFF", "bad_json"), (b"{", "bad_json"), (b"[]", "bad_message"),
                           (b"{}", "bad_message"), (b'{"type":"state","alpha":"x"}', "bad_message"),
                           (b'{"type":"state","polytope":{"name":"no such thing"}}', "unknown_polytope"),
                           (b'{"type":"state","slices":{"count":2}}', "out_of_range")):
            assert (await refusal(body))[1] == code, body
        assert (await refusal(b"{}", token="wrong"))[:2] == (401, "bad_token")
        assert (await refusal(b"{}", path="state?axes=tzyx"))[:2] == (400, "bad_message")
        assert (await refusal(b"{}", path="states"))[:2] == (404, "not_found")
        after = await client.request("get", what="state")
        assert settings(before) == settings(after) and before["revision"] == after["revision"]


async def test_the_size_of_a_state_is_limited():
    with Server("--max-message", 4096) as limited:
        async with Client(limited, stream="none") as client:
            state = await client.request("get", what="state")
            for spaces, expected in ((0, 200), (5000, 413)):
                body = json.dumps(state).encode() + b" " * spaces
                assert (await asyncio.to_thread(put_state, limited, client.welcome, body))[0] == expected


async def test_the_python_client_restores_files_and_states(server, tmp_path):
    async with Client(server, stream="none") as client:
        await field_with_levels(client)
        state = await client.request("get", what="state")
        picture = await client.request_frame(**SIZE)
    (tmp_path / "view.png").write_bytes(picture)
    (tmp_path / "view.json").write_text(json.dumps(state), encoding="utf-8")

    def restore_all():
        for source in (tmp_path / "view.png", str(tmp_path / "view.json"), picture, state):
            with oval4d_client.connect(server.url) as oval:
                oval.hello()
                oval.restore(source)
                assert settings(oval.state()) == settings(state)
        with oval4d_client.connect(server.url) as oval:
            oval.hello()
            for nothing in (b"", b"{}", {"type": "done"}, b"\x89PNG\r\n\x1a\n", b"[]", b"[" * 50_000):
                with pytest.raises(ValueError):
                    oval.restore(nothing)

    await asyncio.to_thread(restore_all)


def rendered(*options):
    return subprocess.run([PROGRAM, "render", "-o", "-", *options], capture_output=True, timeout=DEADLINE, check=False)


@pytest.mark.parametrize("options", [["--polytope=24-cell", "--rotate=xw,yz:0.4,1.1", "--slices=7", "--color=w"],
                                     ["--formula=x^2+y^2-z^2<w", "--box=-1,1,-1,1,-1,1,0,2", "--levels=0.1,0.3"]])
def test_the_command_line_shows_a_picture_again(tmp_path, options):
    size = ["--width=320", "--height=200"]
    first = rendered(*size, *options)
    assert first.returncode == 0, first.stderr
    (tmp_path / "view.png").write_bytes(first.stdout)
    (tmp_path / "view.json").write_text(json.dumps(png.state_in(first.stdout)), encoding="utf-8")
    for name in ("view.png", "view.json"):
        again = rendered(*size, "--load", tmp_path / name)
        assert again.returncode == 0, again.stderr
        assert difference(again.stdout, first.stdout) < 0.01
    other = rendered(*size, "--load", tmp_path / "view.png", "--slices=3")
    assert png.state_in(other.stdout)["slices"]["count"] == 3
    Image.new("RGB", (4, 4)).save(tmp_path / "plain.png")
    refused = rendered("--load", tmp_path / "plain.png")
    assert refused.returncode != 0 and b"plain.png: the picture contains no state" in refused.stderr
