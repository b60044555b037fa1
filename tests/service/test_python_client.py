"""The client in protocol/python, used as in a script: its messages, errors, connection, and pictures in notebooks."""

import asyncio
import base64
import json
import re
import socket
import sys
import threading
from pathlib import Path

import numpy
import pytest
import websockets
from array_files import npy
from harness import DEADLINE, Server, free_port, wait_until
from png import pixels

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402
from oval4d_client import Closed, Refused, connect, png_state, socket_url  # noqa: E402


def test_page_addresses_become_websocket_addresses():
    assert socket_url("http://host:1/") == "ws://host:1/ws"
    assert socket_url("https://host/prefix/?token=x#y", "abc") == "wss://host/prefix/ws/abc?token=x"
    assert socket_url("ws://host") == "ws://host/ws"


def test_the_methods_send_their_messages(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        assert oval.hello()["session"] == oval.welcome["session"]
        assert oval.key("y")["revision"] == 1
        assert oval.key("y", shift=True)["revision"] == 2
        assert oval.rotate("xw", 0.1)["revision"] == 3
        assert oval.rotate("xw,yz", 0.1, 0.2)["revision"] == 4
        assert oval.set(polytope="8-cell", slices={"count": 11})["revision"] == 5
        assert oval.command(":set alpha=pi/12")["revision"] == 6
        oval.undo()
        oval.redo()
        oval.reset()
        state = oval.wait(9)
        assert state["polytope"]["name"] == "8-cell"
        assert oval.state()["slices"]["count"] == 11
        assert len(oval.slices()["slices"]) == 11
        assert oval.slices(640, 480)["scene"]["viewport"] == {"width": 640, "height": 480}
        picture = oval.frame(320, 200)
        assert oval.file("off").startswith(b"4OFF") and oval.file("stl", body="skeleton", size=20)[:6] == b"oval4d"
        assert png_state(picture)["revision"] == 9
        assert [polytope["name"] for polytope in oval.catalogue()][0] == "5-cell"
        assert any(key["name"] == "Ctrl-r" for key in oval.keymap())


def test_request_sends_any_message(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        assert oval.request("hello")["type"] == "welcome"
        assert oval.request("ping")["type"] == "pong"
        assert oval.request("rotate", planes=["xw"], angles=[0.1])["revision"] == 1
        assert oval.request("measure", element="edge", number=7)["length"] == pytest.approx(2)
        assert oval.request("get", what="state")["revision"] == 1


@pytest.mark.parametrize("timeout", [0.1, 20])  # the default of the WebSocket library is 10
def test_the_timeout_applies_to_the_opening(monkeypatch, timeout):
    limits = []
    opening = websockets.connect

    def record(*arguments, **options):
        limits.append(options["open_timeout"])
        return opening(*arguments, **options | {"open_timeout": 0.1})

    monkeypatch.setattr(websockets, "connect", record)
    with socket.create_server(("127.0.0.1", 0)) as silent, pytest.raises(TimeoutError):
        connect(f"http://127.0.0.1:{silent.getsockname()[1]}/", timeout=timeout)
    assert limits == [timeout]


def test_errors_are_raised_and_change_nothing(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        with pytest.raises(Refused, match="hello") as refused:
            oval.key("y")
        assert refused.value.code == "hello_first"
        oval.hello()
        with pytest.raises(Refused, match="did you mean '24-cell'") as refused:
            oval.set(polytope="25-cell")
        assert refused.value.code == "unknown_polytope"
        for unsendable in (float("nan"), numpy.array([0, float("inf")]), "\ud800"):
            with pytest.raises(ValueError, match="a message cannot contain"):
                oval.set(point=[0, 0, 0, unsendable])
        circle = []
        circle.append(circle)
        with pytest.raises(ValueError, match="a list or dict that contains itself"):
            oval.set(point=circle)
        assert oval.state()["revision"] == 0
        oval.send({"type": "undo"})
        oval.state()
        assert [error["code"] for error in oval.errors] == ["nothing_to_undo"]


def test_numbers_and_arrays_of_numpy_are_sent(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        with pytest.raises(TypeError, match="a message cannot contain"):
            oval.set(alpha=numpy.clongdouble(1))
        oval.rotate("xw", numpy.float32(0.25))
        oval.set(alpha=numpy.longdouble(0.5), point=numpy.zeros(4, numpy.longdouble))
        oval.set(orientation=numpy.eye(4), slices={"count": numpy.int64(5)})
        state = oval.state()
        assert state["last"]["angles"] == [0.25] and state["slices"]["count"] == 5
        assert state["orientation"] == numpy.eye(4).tolist()


@pytest.mark.parametrize("stream", ["none", "geometry", "frames"])
def test_wait_returns_after_changes_by_another_client(server, stream):
    with connect(server.url, timeout=DEADLINE) as one:
        welcome = one.hello(stream, width=320, height=200)
        with connect(server.url, session=welcome["session"], timeout=DEADLINE) as two:
            two.hello(token=welcome["token"])

            def turn():
                for _ in range(50):
                    two.key("y")

            presses = threading.Thread(target=turn)
            presses.start()
            state = one.wait(50)
            presses.join()
            assert state["revision"] == 50
            if stream == "frames":
                assert png_state(one.newest_frame)["revision"] == 50
                assert one.key("2") == {"type": "done", "id": one.state()["id"] - 1, "revision": 51}


def test_an_ended_connection_raises_its_close_code(server):
    with connect(server.url, session="nobody", timeout=DEADLINE) as oval:
        with pytest.raises(Refused) as refused:
            oval.hello()
        assert refused.value.code == "not_found"
        with pytest.raises(Closed) as closed:
            oval.wait(1)
        assert closed.value.code == 4404
    with pytest.raises(OSError):
        connect("http://127.0.0.1:1/", timeout=DEADLINE)


def test_the_client_rejoins_its_session_after_restarts(tmp_path):
    port = free_port()
    for round_ in range(3):
        with Server("--store", f"sqlite:{tmp_path / 'sessions'}", "--port", port) as server:
            if round_ == 0:
                oval = connect(server.url, timeout=DEADLINE)
                session = oval.hello("geometry", encoding="cbor")["session"]
            assert oval.key("y")["revision"] == round_ + 1
            assert oval.state()["revision"] == round_ + 1
            assert oval.wait(round_ + 1)
            assert oval.welcome["session"] == session
    oval.close()


def test_a_client_can_be_closed_while_it_reconnects(server, monkeypatch):
    reconnects, closed = threading.Event(), asyncio.Event()
    original = oval4d_client.Client._open_socket

    async def open_late(self, *arguments):
        reconnects.set()
        await closed.wait()
        return await original(self, *arguments)

    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        close_lost_connection = oval._socket.close

        async def close():  # Client.close() calls this before it waits for the reader, which reconnects
            await close_lost_connection()
            closed.set()

        monkeypatch.setattr(oval._socket, "close", close)
        monkeypatch.setattr(oval4d_client.Client, "_open_socket", open_late)
        oval._loop.call_soon_threadsafe(oval._socket.transport.abort)
        assert reconnects.wait(DEADLINE)


class RefusingSocket:
    """A connection to a server that cannot open the session of a hello."""

    async def send(self, _):
        pass

    async def recv(self):
        return json.dumps({"type": "error", "code": "later_version", "message": "a later version has stored it"})

    async def close(self):
        pass


def test_the_client_waits_for_a_server_that_can_open_its_session(server, monkeypatch):
    attempts = []
    really_open = oval4d_client.Client._open_socket

    async def open_refused_twice(self, url, headers):
        attempts.append(url)
        return RefusingSocket() if len(attempts) < 3 else await really_open(self, url, headers)

    with connect(server.url, timeout=DEADLINE) as oval:
        session = oval.hello()["session"]
        oval.key("y")
        monkeypatch.setattr(oval4d_client.Client, "_open_socket", open_refused_twice)
        oval._loop.call_soon_threadsafe(oval._socket.transport.abort)
        wait_until(lambda: len(attempts) == 3, "the third attempt")
        assert oval.key("y")["revision"] == 2
        assert oval.welcome["session"] == session
        assert all(url.endswith("/ws/" + session) for url in attempts)


def test_the_package_has_the_version_of_the_server():
    root = Path(__file__).resolve().parents[2]
    (version,) = re.findall(r"project\(oval4d VERSION (\S+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))
    package = (root / "protocol/python/pyproject.toml").read_text(encoding="utf-8")
    assert f'version = "{version}"' in package


def test_a_notebook_shows_the_picture(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        assert png_state(oval._repr_png_())["polytope"]["name"] == "5-cell"


def test_only_pictures_of_the_stream_are_acknowledged(server, monkeypatch):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        sent = []
        send = oval._socket.send

        async def record(text):
            sent.append(json.loads(text))
            await send(text)

        monkeypatch.setattr(oval._socket, "send", record)
        oval.frame(32, 18)
        oval.slices(32, 18)
        oval.file("csv")
        assert [message["type"] for message in sent] == ["get", "get", "get"]
        oval.hello("frames", width=64, height=36)
        wait_until(lambda: {"type": "shown", "revision": 0} in sent, "the picture of the stream to be acknowledged")


def test_a_picture_of_the_stream_right_after_the_answer_to_a_call_is_not_held(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        frame = oval.frame(32, 18)
        oval._waiting[1000] = None  # a call whose thread does not run before the next picture arrives
        oval._wants_bytes.add(1000)
        assert oval._handle_message(frame) == []
        assert oval._handle_message('{"type":"done","id":1000,"revision":0}') == []
        assert oval._handle_message(frame) == [(0, frame)]


def test_a_notebook_shows_every_change(server, tmp_path, monkeypatch):
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    from IPython.core.displaypub import CapturingDisplayPublisher
    from IPython.core.interactiveshell import InteractiveShell
    from traitlets.config import Config

    shell = InteractiveShell.instance(config=Config(HistoryManager={"enabled": False}))
    shown = shell.display_pub = CapturingDisplayPublisher()

    def name_in(output):
        return png_state(base64.b64decode(output["data"]["image/png"]))["polytope"]["name"]

    try:
        with connect(server.url, timeout=DEADLINE) as oval:
            oval.live(320, 200)
            assert name_in(shown.outputs[0]) == "5-cell" and not shown.outputs[0]["update"]
            oval.frame(320, 200, "white")  # the notebook does not show an answer
            oval.set(polytope="24-cell")
            wait_until(lambda: name_in(shown.outputs[-1]) == "24-cell", "the picture of the change")
            assert all(output["update"] for output in shown.outputs[1:])
            assert len({output["transient"]["display_id"] for output in shown.outputs}) == 1
            grounds = {pixels(base64.b64decode(output["data"]["image/png"]))[1][:3] for output in shown.outputs}
            assert len(grounds) == 1, "all have the background of the stream"
    finally:
        InteractiveShell.clear_instance()


def test_a_script_joins_the_session_of_a_shared_link(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        session, token = (oval.hello()[name] for name in ("session", "token"))
        oval.set(polytope="24-cell")
        with connect(f"{server.url}#session={session}&token={token}", timeout=DEADLINE) as other:
            assert other.hello()["session"] == session
            assert other.state()["polytope"]["name"] == "24-cell"
    for fragment in (f"session={session}", f"token={token}", "session=&token="):
        with pytest.raises(ValueError, match="damaged"):
            connect(f"{server.url}#{fragment}")


def test_an_address_opens_its_view(server):
    with connect(server.url + "?polytope=24-cell&rotate=xw:0.1+pi/8&slices=11&utm_source=x", timeout=DEADLINE) as oval:
        oval.hello()
        state = oval.state()
        assert (state["polytope"]["name"], state["slices"]["count"], state["revision"]) == ("24-cell", 11, 1)
        oval.hello()
        assert oval.state()["revision"] == 1
        oval.rotate("yz", 0.2)
        view = oval.address()
        state = oval.state()
    with connect(server.url + "?" + view, timeout=DEADLINE) as other:
        other.hello()
        shown = other.state()
        assert (shown["polytope"], shown["slices"]) == (state["polytope"], state["slices"])
        assert numpy.allclose(shown["orientation"], state["orientation"], rtol=0, atol=1e-12)
        other.upload("noise", npy(numpy.random.default_rng(1).random((8, 8, 8))), axes="zyx")
        assert other.state()["polytope"]["name"] == "noise"
    with connect(server.url + "?polytope=25-cell", timeout=DEADLINE) as oval, pytest.raises(Refused, match="24-cell"):
        oval.hello()
