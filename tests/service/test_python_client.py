"""The client in protocol/python, used as in a script."""

import array
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


def test_page_addresses_become_websocket_addresses():
    assert socket_url("http://host:1/") == "ws://host:1/ws"
    assert socket_url("https://host/prefix/?token=x#y", "abc") == "wss://host/prefix/ws/abc?token=x"
    assert socket_url("ws://host") == "ws://host/ws"


def test_the_client_sends_every_message(server):
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


def test_errors_are_raised_and_change_nothing(server):
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


def without_typed_arrays(value):
    """Converts typed arrays to lists."""
    if isinstance(value, array.array):
        return value.tolist()
    if isinstance(value, dict):
        return {name: without_typed_arrays(member) for name, member in value.items()}
    return [without_typed_arrays(item) for item in value] if isinstance(value, list) else value


def cbor_slices_as_json(message):
    """Converts a decoded CBOR `slices` message to the form of the JSON message."""
    def groups(flat, size):
        return [list(group) for group in zip(*[iter(flat)] * size)]

    message = without_typed_arrays(message)
    if "coordinates" in message:
        message["coordinates"] = groups(message["coordinates"], 4)
    if "density" in message:
        message["density"] = groups(message["density"], message["scene"]["coordinates"]["columns"])
    for piece in message["slices"] + message.get("projection", {}).get("parts", []):
        begin, corners = piece["faces"]["begin"], piece["faces"]["corners"]
        piece["vertices"] = groups(piece["vertices"], 3)
        piece["edges"] = groups(piece["edges"], 2)
        piece["faces"] = [corners[a:b] for a, b in zip(begin, begin[1:])]
        if "fill" in piece:
            piece["fill"] |= {name: groups(piece["fill"][name], 3) for name in ("points", "triangles")}
    return message


def assert_approximately_equal(got, expected):
    """Asserts that the values are equal to the precision of float32."""
    if isinstance(expected, dict):
        assert got.keys() == expected.keys()
        for name, member in expected.items():
            assert_approximately_equal(got[name], member)
    elif isinstance(expected, list):
        assert len(got) == len(expected)
        for item, other in zip(got, expected):
            assert_approximately_equal(item, other)
    elif isinstance(expected, float):
        assert got == pytest.approx(expected, rel=1e-6, abs=1e-30)
    else:
        assert got == expected


@pytest.mark.parametrize("lines", [
    ["polytope 5-cell"],
    ["polytope 8-cell"],                                              # whole cells in hyperplanes: `tints`
    ["polytope 120-cell", "rotate xw,yz 0.3 0.4"],                    # a density strip
    ["polytope truncated tesseract", "hide 1", "rotate xw 0.2"],      # hidden cells: `seen`
    ["polytope grand 600-cell", "set slices=3", "rotate xw 0.2"],     # crossing faces: `fill`
    ["polytope truncated tesseract", "hide 1", "project perspective", "set cells=on sections=on"],
    ["polytope 5-cell", "focus 100"],                                 # no slice
])
def test_cbor_and_json_slices_are_equal(server, lines):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        for line in lines:
            oval.command(line)
        text = oval.slices()
        oval.hello(encoding="cbor")
        packed = oval.slices()
    assert packed.pop("id") > text.pop("id")
    assert_approximately_equal(cbor_slices_as_json(packed), text)
    kinds = {kind for piece in text["slices"] for kind in ("tints", "seen", "fill") if kind in piece}
    assert kinds == {"polytope 8-cell": {"tints"}, "polytope truncated tesseract": {"seen"},
                     "polytope grand 600-cell": {"fill"}}.get(lines[0], set())


def test_cbor_arrays_have_the_documented_types(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello("geometry", encoding="cbor")
        oval.wait(0)
        focus = oval.newest_slices["slices"][10]
        assert focus["focus"]
        assert focus["vertices"].typecode == "f"
        assert len(focus["vertices"]) == 3 * 4
        assert list(focus["faces"]["begin"]) == [0, 3, 6, 9, 12]


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


def test_the_example_writes_its_picture(server, tmp_path):
    script = (PYTHON / "example.py").read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, timeout=DEADLINE,
                   env=os.environ | {"PYTHONPATH": str(PYTHON)})
    picture = (tmp_path / "24-cell.png").read_bytes()
    assert png_state(picture)["polytope"]["name"] == "24-cell"
    assert png_state(picture)["revision"] == 6
