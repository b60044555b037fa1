"""The client of protocol/python, as a script uses it."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from harness import DEADLINE, Server

PYTHON = Path(__file__).resolve().parents[2] / "protocol/python"
sys.path.insert(0, str(PYTHON))
from oval4d_client import Closed, Refused, connect, png_state, socket_url  # noqa: E402


def test_addresses():
    assert socket_url("http://host:1/") == "ws://host:1/ws"
    assert socket_url("https://host/prefix/?token=x#y", "abc") == "wss://host/prefix/ws/abc?token=x"
    assert socket_url("ws://host") == "ws://host/ws"


def test_every_message(server):
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
        assert oval.file("off").startswith(b"4OFF") and oval.file("stl", body="frame", size=20)[:6] == b"oval4d"
        assert png_state(picture)["revision"] == 9
        assert [polytope["name"] for polytope in oval.catalogue()][0] == "5-cell"
        assert any(key["name"] == "Ctrl-r" for key in oval.keymap())


def test_errors_are_raised_and_harm_nothing(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        with pytest.raises(Refused, match="hello") as refused:
            oval.key("y")
        assert refused.value.code == "hello_first"
        oval.hello()
        with pytest.raises(Refused, match="did you mean '24-cell'") as refused:
            oval.set(polytope="25-cell")
        assert refused.value.code == "unknown_polytope"
        with pytest.raises(Refused, match="not JSON") as refused:
            oval.rotate("xw", float("nan"))
        assert oval.state()["revision"] == 0
        oval.send({"type": "undo"})
        oval.state()
        assert [error["code"] for error in oval.errors] == ["nothing_to_undo"]


@pytest.mark.parametrize("stream", ["none", "geometry", "frames"])
def test_waits_for_what_another_client_does(server, stream):
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


def test_cbor(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello("geometry", encoding="cbor")
        oval.wait(0)
        focus = oval.newest_slices["slices"][10]
        assert focus["focus"]
        assert focus["vertices"].typecode == "f"
        assert len(focus["vertices"]) == 3 * 4
        assert list(focus["faces"]["begin"]) == [0, 3, 6, 9, 12]


def test_a_connection_that_ends_says_how(server):
    with connect(server.url, session="nobody", timeout=DEADLINE) as oval:
        with pytest.raises(Refused) as refused:
            oval.hello()
        assert refused.value.code == "not_found"
        with pytest.raises(Closed) as closed:
            oval.wait(1)
        assert closed.value.code == 4404
    with pytest.raises(OSError):
        connect("http://127.0.0.1:1/", timeout=DEADLINE)


def test_comes_back_to_its_session(tmp_path):
    port = None
    for round_ in range(3):
        with Server("--store", f"sqlite:{tmp_path / 'sessions'}", *([] if port is None else ["--port", port])) as server:
            if port is None:
                port = server.port
                oval = connect(server.url, timeout=DEADLINE)
                session = oval.hello("geometry", encoding="cbor")["session"]
            assert oval.key("y")["revision"] == round_ + 1
            assert oval.state()["revision"] == round_ + 1
            assert oval.wait(round_ + 1)
            assert oval.welcome["session"] == session
    oval.close()


def test_the_example_makes_its_picture(server, tmp_path):
    script = (PYTHON / "example.py").read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, timeout=DEADLINE,
                   env=os.environ | {"PYTHONPATH": str(PYTHON)})
    picture = (tmp_path / "24-cell.png").read_bytes()
    assert png_state(picture)["polytope"]["name"] == "24-cell"
    assert png_state(picture)["revision"] == 6
