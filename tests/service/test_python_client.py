"""The client in protocol/python, used as in a script."""

import asyncio
import base64
import importlib.util
import os
import re
import subprocess
import sys
import threading
from pathlib import Path

import numpy
import pytest
from array_files import npy
from harness import DEADLINE, Server, free_port, wait_until
from png import pixels

PYTHON = Path(__file__).resolve().parents[2] / "protocol/python"
sys.path.insert(0, str(PYTHON))
import oval4d_client  # noqa: E402
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


def without_typed_arrays(value):
    """Converts typed arrays and numpy arrays to lists."""
    if hasattr(value, "tolist"):  # array.array or a numpy array
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


FIELD = "formula x^2 + y^2 - z^2 < w"


@pytest.mark.parametrize("lines", [
    ["polytope 5-cell"],
    ["polytope 8-cell"],                                              # whole cells in hyperplanes: `tints`
    ["polytope 120-cell", "rotate xw,yz 0.3 0.4"],                    # a density strip
    ["polytope truncated tesseract", "hide 1", "rotate xw 0.2"],      # hidden cells: `seen`
    ["polytope grand 600-cell", "set slices=3", "rotate xw 0.2"],     # crossing faces: `fill`
    ["polytope truncated tesseract", "hide 1", "project perspective", "set cells=on sections=on"],
    ["polytope 5-cell", "focus 100"],                                 # no slice
    [FIELD, "rotate xw 0.3", "set levels=1,0.5"],                     # surfaces, with caps
    [FIELD, "rotate xw 0.3", "color growth"],
    [FIELD, "rotate xw 0.3", "color w"],
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
    assert_approximately_equal(cbor_slices_as_json(packed), without_typed_arrays(text))
    kinds = {kind for piece in text["slices"] for kind in ("tints", "seen", "fill", "surface") if kind in piece}
    assert kinds == {"polytope 8-cell": {"tints"}, "polytope truncated tesseract": {"seen"},
                     "polytope grand 600-cell": {"fill"}, FIELD: {"surface"}}.get(lines[0], set())


def test_cbor_arrays_have_the_documented_types(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello("geometry", encoding="cbor")
        oval.wait(0)
        focus = oval.newest_slices["slices"][10]
        assert focus["focus"]
        assert focus["vertices"].typecode == "f"
        assert len(focus["vertices"]) == 3 * 4
        assert list(focus["faces"]["begin"]) == [0, 3, 6, 9, 12]


BALL = "x^2 + y^2 + z^2 + w^2 < a; a=1"


@pytest.mark.parametrize("encoding", ["json", "cbor"])
@pytest.mark.parametrize("with_numpy", [True, False])
def test_surfaces_are_numpy_arrays_or_lists(server, monkeypatch, encoding, with_numpy):
    numpy = pytest.importorskip("numpy") if with_numpy else None
    monkeypatch.setattr(oval4d_client, "numpy", numpy)
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello(encoding=encoding)
        oval.formula(BALL, box=[(-1, 1)] * 4, levels=[0, -0.5])
        oval.set(slices={"spacing": 0.2})
        for color in ("growth", "w"):
            oval.set(color=color)
            pieces = oval.slices()["slices"]
            assert any("surface" in piece for piece in pieces) and "surface" not in pieces[0]
            for piece in pieces:
                if "surface" not in piece:
                    continue
                surface = piece["surface"]
                arrays = {name: value for name, value in surface.items() if name != "color"}
                assert ("colors" in arrays, "color" in surface) == (color == "growth", color == "w")
                for value in arrays.values():
                    assert isinstance(value, list if numpy is None else numpy.ndarray)
                for name in ("points", "normals", "triangles"):
                    if numpy is None:
                        assert all(len(row) == 3 for row in arrays[name])
                    else:
                        assert arrays[name].shape == (len(arrays[name]), 3)
                lengths = {name: len(value) for name, value in arrays.items()}
                assert lengths["points"] == lengths["normals"] == lengths.get("colors", lengths["points"])
                assert lengths["triangles"] == lengths["level"] == lengths["cap"]
                assert max(map(max, arrays["triangles"])) < lengths["points"]


def test_a_field_is_one_step_of_undo(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        oval.formula(BALL, box=[(-1, 1), (-1, 1), (-1, 1), (0, 3)], levels=(0, 0.5), inside="above", name="ball")
        state = oval.state()
        assert (state["polytope"]["name"], state["levels"], state["inside"]) == ("ball", [0, 0.5], "above")
        oval.undo()
        assert oval.state()["polytope"]["name"] == "5-cell"
        oval.formula(BALL)
        state = oval.state()
        assert (state["polytope"]["name"], state["levels"], state["inside"]) == ("formula", [0], "below")
        with pytest.raises(Refused, match="position 3") as refused:
            oval.formula("x y")
        assert refused.value.code == "bad_expression"
        with pytest.raises(Refused, match="along w"):
            oval.formula(BALL, box=[(-1, 1), (-1, 1), (-1, 1), (1, 1)])
        with pytest.raises(Refused, match="levels"):
            oval.formula(BALL, levels=[1, 1])


def ball(moments, size=12):
    """Returns 1 − x² − y² − z² − w² for coordinates from −1 to 1, with the axes tzyx."""
    numpy = pytest.importorskip("numpy")
    axes = [numpy.linspace(-1, 1, count) for count in (moments, size, size, size)]
    return 1 - sum(axis**2 for axis in numpy.meshgrid(*axes, indexing="ij"))


@pytest.mark.parametrize("size", [12, 40])  # a message, an upload
def test_arrays_are_fields(server, monkeypatch, size):
    uploads = []
    monkeypatch.setattr(oval4d_client.Client, "upload", lambda *arguments, upload=oval4d_client.Client.upload, **members:
                        uploads.append(arguments[1]) or upload(*arguments, **members))
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        values = ball(10, size)
        oval.field("ball", values, spacing=2 / (size - 1), origin=(-1, -1, -1, 0), levels=[0.36])
        assert uploads == ([] if size == 12 else ["ball"])
        state = oval.state()
        assert (state["polytope"]["name"], state["levels"], state["inside"]) == ("ball", [0.36], "above")
        named = oval.slices()["slices"]
        oval.field("ball", values.transpose(3, 1, 0, 2), axes="xzty", spacing=2 / (size - 1),
                   origin=(-1, -1, -1, 0), levels=[0.36])
        other = oval.slices()["slices"]
        assert len(named) == len(other) and any("surface" in piece for piece in named)
        for one, two in zip(named, other):
            assert without_typed_arrays(one) == without_typed_arrays(two)


def test_a_simulation_appends_moments(server):
    values = ball(12)
    with connect(server.url, timeout=DEADLINE) as oval, connect(server.url, timeout=DEADLINE) as whole:
        oval.hello()
        whole.hello()
        oval.field("run ½", values[:2], spacing=1, levels=[0.3])
        oval.rotate("xw", 0.4)
        for moment in values[2:10]:
            oval.append("run ½", moment)
        oval.append("run ½", values[10:])
        whole.field("run ½", values, spacing=1, levels=[0.3])
        whole.rotate("xw", 0.4)
        for one, two in zip(oval.slices()["slices"], whole.slices()["slices"], strict=True):
            assert without_typed_arrays(one) == without_typed_arrays(two)
        assert oval.slices()["slices"][10]["surface"]["points"].shape[1] == 3
        with pytest.raises(Refused, match="no field called 'run'") as refused:
            oval.append("run", values[0])
        assert refused.value.code == "not_found"


def test_refused_uploads_are_raised(server, tmp_path):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        with pytest.raises(Refused) as refused:
            oval.upload("24-cell", b"\x93NUMPY")
        assert refused.value.code == "bad_polytope"
        path = tmp_path / "not.nc"
        path.write_bytes(b"hello")
        with open(path, "rb") as file, pytest.raises(Refused) as refused:
            oval.upload("mine", file, "netcdf")
        assert refused.value.code == "unsupported_format"
        with pytest.raises(Refused) as refused:
            oval.upload("mine", bytes(oval.welcome["limits"]["upload"] + 1))
        assert refused.value.code == "too_large"


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
    reconnects = threading.Event()
    original = oval4d_client.Client._open

    async def open_late(self, *arguments):
        reconnects.set()
        while not self._closing:
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.1)  # meanwhile, the lost connection is closed
        return await original(self, *arguments)

    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        monkeypatch.setattr(oval4d_client.Client, "_open", open_late)
        oval._loop.call_soon_threadsafe(oval._socket.transport.abort)
        assert reconnects.wait(DEADLINE)


def test_the_example_writes_its_picture(server, tmp_path):
    script = (PYTHON / "example.py").read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, timeout=DEADLINE,
                   env=os.environ | {"PYTHONPATH": str(PYTHON)})
    picture = (tmp_path / "24-cell.png").read_bytes()
    assert png_state(picture)["polytope"]["name"] == "24-cell"
    assert png_state(picture)["revision"] == 6


@pytest.mark.parametrize("with_numpy", [True, False])
def test_the_example_prints_the_volumes_of_the_tiger(server, with_numpy):
    script = (PYTHON / "tiger.py").read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    if not with_numpy:
        script = "import sys; sys.modules['numpy'] = None\n" + script
    done = subprocess.run([sys.executable, "-c", script], check=True, timeout=DEADLINE, capture_output=True, text=True,
                          env=os.environ | {"PYTHONPATH": str(PYTHON)})
    *slices, summary = done.stdout.splitlines()
    assert len(slices) > 20 and all(re.fullmatch(r"w = +-?\d\.\d\d   volume \d+\.\d{3}", line) for line in slices)
    got, expected = map(float, re.findall(r"\d+\.\d+", summary))
    assert got == pytest.approx(expected, rel=0.05)


def run_example(server, name, folder, *arguments):
    script = (PYTHON / name).read_text(encoding="utf-8").replace("http://127.0.0.1:8080/", server.url)
    return subprocess.run([sys.executable, "-c", script, *map(str, arguments)], cwd=folder, check=True, timeout=DEADLINE,
                          capture_output=True, text=True, env=os.environ | {"PYTHONPATH": os.pathsep.join(
                              filter(None, [str(PYTHON), os.environ.get("PYTHONPATH")]))})


def test_the_simulation_draws_its_moments(server, tmp_path):
    pytest.importorskip("numpy")
    done = run_example(server, "gray_scott.py", tmp_path, 4, 2)
    assert "moment 4 of 4" in done.stdout
    state = png_state((tmp_path / "gray_scott.png").read_bytes())
    assert (state["polytope"]["name"], state["levels"], state["revision"]) == ("Gray–Scott", [0.15], 6)


def test_the_flow_is_written_and_opened_again(server, tmp_path):
    pytest.importorskip("numpy")
    if importlib.util.find_spec("netCDF4") is None:
        pytest.importorskip("scipy.io")
    done = run_example(server, "ethier_steinman.py", tmp_path)
    state = png_state((tmp_path / "ethier_steinman.png").read_bytes())
    assert state["polytope"]["name"] == "Ethier–Steinman" and not done.stdout


def test_the_package_has_the_version_of_the_server():
    root = Path(__file__).resolve().parents[2]
    (version,) = re.findall(r"project\(oval4d VERSION (\S+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))
    package = (root / "protocol/python/pyproject.toml").read_text(encoding="utf-8")
    assert f'version = "{version}"' in package


def test_a_notebook_shows_the_picture(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        assert png_state(oval._repr_png_())["polytope"]["name"] == "5-cell"


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
            oval.frame(320, 200, "white")  # an answer is not shown
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
