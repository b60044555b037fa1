"""The client in protocol/python: arrays that it receives in slices and surfaces, and arrays that it sends as fields."""

import sys
from pathlib import Path

import pytest
from harness import DEADLINE
from wire import BINARY_ENCODINGS, ENCODINGS

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402
from oval4d_client import Refused, connect  # noqa: E402


def without_typed_arrays(value):
    """Converts typed arrays and numpy arrays to lists."""
    if hasattr(value, "tolist"):  # an array.array or a numpy array
        return value.tolist()
    if isinstance(value, dict):
        return {name: without_typed_arrays(member) for name, member in value.items()}
    return [without_typed_arrays(item) for item in value] if isinstance(value, list) else value


def binary_slices_as_json(message):
    """Converts a decoded binary `slices` message to the form of the JSON message."""
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
STAR = "polytope small stellated 120-cell"  # has a projection with a `fill`


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
@pytest.mark.parametrize("lines", [
    ["polytope 5-cell"],
    ["polytope 8-cell"],                                              # whole cells in hyperplanes: `tints`
    ["polytope 120-cell", "rotate xw,yz 0.3 0.4"],                    # a density strip
    ["polytope truncated tesseract", "hide 1", "rotate xw 0.2"],      # hidden cells: `seen`
    ["polytope grand 600-cell", "set slices=3", "rotate xw 0.2"],     # crossing faces: `fill`
    ["polytope truncated tesseract", "hide 1", "project perspective", "set cells=on sections=on"],
    [STAR, "rotate xw,yz 0.3 0.4", "set faces=off slices=3", "project perspective", "set cells=on"],
    ["polytope 5-cell", "focus 100"],                                 # no slice
    [FIELD, "rotate xw 0.3", "set levels=1,0.5"],                     # surfaces, with caps
    [FIELD, "rotate xw 0.3", "color growth"],
    [FIELD, "rotate xw 0.3", "color w"],
])
def test_all_encodings_have_the_same_slices(server, lines, encoding):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        for line in lines:
            oval.command(line)
        text = oval.slices()
        oval.hello(encoding=encoding)
        packed = oval.slices()
    assert packed.pop("id") > text.pop("id")
    assert_approximately_equal(binary_slices_as_json(packed), without_typed_arrays(text))
    kinds = {kind for piece in text["slices"] for kind in ("tints", "seen", "fill", "surface") if kind in piece}
    assert kinds == {"polytope 8-cell": {"tints"}, "polytope truncated tesseract": {"seen"},
                     "polytope grand 600-cell": {"fill"}, FIELD: {"surface"}}.get(lines[0], set())
    parts = text["projection"]["parts"] if "projection" in text else []
    assert ["fill" in part for part in parts] == ([True, False] if lines[0] == STAR else [False] * len(parts))


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
def test_binary_arrays_have_the_documented_types(server, encoding):
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello("geometry", encoding=encoding)
        oval.wait(0)
        focus = oval.newest_slices["slices"][10]
        assert focus["focus"]
        assert focus["vertices"].typecode == "f"
        assert len(focus["vertices"]) == 3 * 4
        assert list(focus["faces"]["begin"]) == [0, 3, 6, 9, 12]


BALL = "x^2 + y^2 + z^2 + w^2 < a; a=1"


@pytest.mark.parametrize("encoding", ENCODINGS)
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


@pytest.mark.parametrize("size", [12, 40])  # sent in a message, and uploaded
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


def test_origins_and_masks_are_numpy_arrays(server):
    numpy = pytest.importorskip("numpy")
    values = ball(10)
    mask = numpy.arange(values.size).reshape(values.shape) % 7 == 0
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()

        def shown(array, origin):
            oval.field("ball", array, spacing=2 / 11, origin=origin, levels=[0.36])
            return [without_typed_arrays(piece) for piece in oval.slices()["slices"]]

        whole = shown(values, (-1, -1, -1, 0))
        assert shown(values, numpy.array([-1, -1, -1, 0])) == whole
        assert shown(values, numpy.zeros(4)) == shown(values, (0, 0, 0, 0))
        missing = shown(numpy.where(mask, numpy.nan, values), (-1, -1, -1, 0))
        assert missing != whole
        assert shown(numpy.ma.masked_array(values, mask), (-1, -1, -1, 0)) == missing


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


def test_the_page_of_a_proxy_is_not_shown(server, monkeypatch):
    class ProxyAnswer:
        status, reason = 413, "Request Entity Too Large"

        def getheader(self, _name):
            return "text/html"

        def read(self):
            return b"<html><h1>nginx</h1></html>"

    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        monkeypatch.setattr(oval4d_client.http.client.HTTPConnection, "getresponse", lambda _self: ProxyAnswer())
        with pytest.raises(Refused, match=r"^413: Request Entity Too Large: .* at most \d+ bytes$"):
            oval.upload("mine", b"\x93NUMPY")
