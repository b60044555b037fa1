"""Exported files, read back with other programs."""

import asyncio
import collections
import contextlib
import csv
import http.client
import io
import json
import random
import re
import subprocess
import time
from pathlib import Path
from xml.etree import ElementTree

import meshes
import numpy
import png
import pytest
from harness import DEADLINE, Server, run_oval4d
from test_pacing import open_nonreading_socket
from wire import Client, Refused

ROOT = Path(__file__).resolve().parent.parent.parent
TABLE = json.loads((ROOT / "protocol/export_formats.json").read_text(encoding="utf-8"))["formats"]
FORMATS = [row["name"] for row in TABLE if row.get("objects") != "fields"]
ROTATION = "rotate=xw,yz:0.39,1.42"


def fetch_file(server, format_, query, status=200):
    answer = server.get(f"/api/v1/file.{format_}?{query}")
    assert answer.status == status, answer.body[:500]
    return answer.body


def fetch_file_to(server, path, query):
    path.write_bytes(fetch_file(server, path.suffix[1:], query))
    return path


def export_refusal(server, format_, query, status=400):
    return json.loads(fetch_file(server, format_, query, status))


def csv_rows(server, query):
    """Returns the rows of a CSV file, as mappings from the names of the columns."""
    return list(csv.DictReader(io.StringIO(fetch_file(server, "csv", query).decode())))


async def file_over_websocket(client, **members):
    done = await client.request("get", what="file", **members)
    return client.messages[client.messages.index(done) - 1]


@pytest.mark.parametrize("format_", FORMATS)
async def test_websocket_http_and_command_export_the_same_file(server, tmp_path, format_):
    (contents,) = (row["of"] for row in TABLE if row["name"] == format_)
    of = "oval" if "oval" in contents else contents[0]
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        await client.request("rotate", planes=["xw", "yz"], angles=[0.39, 1.42])
        by_websocket = await file_over_websocket(client, format=format_, of=of, size=40)
    by_http = fetch_file(server, format_, f"polytope=24-cell&{ROTATION}&of={of}&size=40")
    path = tmp_path / f"slices.{format_}"
    done = run_oval4d("export", "-o", path, "--polytope", "24-cell", "--rotate", "xw,yz:0.39,1.42", "--of", of, "--size=40")
    assert done.returncode == 0, done.stderr
    if format_ == "3mf":  # a 3MF file contains its time of creation
        assert meshes.read_three_mf(by_websocket) == meshes.read_three_mf(by_http) == meshes.read_three_mf(path.read_bytes())
    else:
        assert by_websocket == by_http == path.read_bytes()
    assert by_websocket[0] not in {0x89, *range(0xa0, 0xc0)}


@pytest.mark.parametrize("polytope", ["5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"])
def test_admesh_finds_nothing_to_repair_after_any_rotation(server, tmp_path, polytope):
    rng = random.Random(polytope)
    turns = [""] + [f"&rotate=xw,yz:{rng.uniform(0, 6)},{rng.uniform(0, 6)}&rotate=xy,zw:{rng.uniform(0, 6)},"
                    f"{rng.uniform(0, 6)}" for _ in range(8)]
    for turn in turns:
        query = f"polytope={polytope}{turn}&focus={rng.randint(-4, 4)}"
        report = meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "solid.stl", query), parts=1)
        (row,), levels = csv_rows(server, query), csv_rows(server, query + "&of=critical")
        # The circumscribed sphere has a diameter of 60 mm; the 4OFF file gives its radius in the polytope's units.
        points = off_points(fetch_file(server, "off", query))
        scale = 30 / max(sum(c * c for c in p) ** 0.5 for p in points)
        assert report["volume"] == pytest.approx(float(row["volume"]) * scale**3, rel=1e-3)
        assert sum(int(level["vertices"]) for level in levels) == len(points)


def off_points(data):
    words = " ".join(line.split("#")[0] for line in data.decode().splitlines()).split()
    assert words[0] == "4OFF"
    count = int(words[1])
    return [tuple(map(float, words[5 + 4 * i:9 + 4 * i])) for i in range(count)]


@pytest.mark.parametrize("polytope", ["5-cell", "24-cell", "600-cell"])
@pytest.mark.parametrize("body", ["solid", "skeleton"])
def test_bodies_of_the_oval_stand_separately_on_the_build_plate(server, tmp_path, polytope, body):
    query = f"polytope={polytope}&{ROTATION}&of=oval&slices=7&size=50"
    slices = csv_rows(server, query)
    full = [row for row in slices if float(row["volume"]) > 1e-6]
    path = fetch_file_to(server, tmp_path / "oval.stl", query + f"&body={body}")
    # Balls and bars are also exported for flat slices, which have no solid.
    parts = len(full) if body == "solid" else sum(1 for row in slices if int(row["vertices"]) > 0)
    report = meshes.assert_closed_mesh(path, parts)
    assert all(low == pytest.approx(0, abs=1e-3) for low, _ in report["box"])
    assert report["box"][2][1] < 60
    if body == "skeleton" and polytope != "5-cell":
        return  # too many triangles to check in Python
    # In 3MF each part is an object, and the bounding boxes are disjoint.
    objects = meshes.read_three_mf(fetch_file(server, "3mf", query + f"&body={body}"))
    assert len(objects) == parts
    boxes = []
    for name, points, triangles in objects:
        assert name.startswith(polytope + ", w = ")
        meshes.assert_manifold(triangles)
        assert meshes.volume(points, triangles) > 0
        low, high = [[f(p[axis] for p in points) for axis in range(3)] for f in (min, max)]
        assert low[2] == pytest.approx(0, abs=1e-3)
        assert all(any(low[a] > h[a] + 1.9 or high[a] < l[a] - 1.9 for a in (0, 1)) for l, h in boxes)
        boxes.append((low, high))


def test_the_former_name_of_skeletons_is_accepted(server):
    query = "polytope=5-cell&size=20"
    skeleton = fetch_file(server, "stl", query + "&body=skeleton")
    assert fetch_file(server, "stl", query + "&body=frame") == skeleton != fetch_file(server, "stl", query)
    done = run_oval4d("export", "-o", "-", "--format", "stl", "--polytope", "5-cell", "--size", "20", "--body", "frame")
    assert done.stdout == skeleton


def test_assimp_reads_the_same_bodies_from_every_format(server, tmp_path):
    volumes = {"solid": [], "skeleton": []}
    for format_, unit in (("stl", 1), ("obj", 1), ("ply", 1), ("glb", 1000), ("x3d", 1000)):
        for body in ("solid", "skeleton"):
            path = fetch_file_to(server, tmp_path / f"slice.{format_}", f"polytope=24-cell&{ROTATION}&body={body}")
            corners = meshes.stl_triangles(meshes.convert_with_assimp(path, tmp_path / "again.stl").read_bytes())
            volumes[body].append(meshes.volume_of(corners) * unit**3)
    for found in volumes.values():
        assert found == pytest.approx([found[0]] * len(found), rel=1e-3) and found[0] > 0


@pytest.mark.parametrize("query", [
    f"polytope=24-cell&{ROTATION}", f"polytope=24-cell&{ROTATION}&of=oval", "polytope=120-cell&of=oval&label=separate",
    "polytope=5-cell&body=frame", "polytope=600-cell&focus=2&label=engraved&size=150"])
def test_khronos_validator_finds_no_errors(server, tmp_path, query):
    report = meshes.validate_glb(fetch_file_to(server, tmp_path / "slice.glb", query))
    assert report["issues"]["numErrors"] == report["issues"]["numWarnings"] == 0, report["issues"]
    assert report["info"]["totalTriangleCount"] > 0


def test_ply_faces_have_the_colors_of_their_cells(server):
    data = fetch_file(server, "ply", f"polytope=24-cell&{ROTATION}")
    head, _, body = data.partition(b"end_header\n")
    vertices, faces = (int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element"))
    records = body[12 * vertices:]
    assert len(records) == 16 * faces
    colors = {records[16 * i + 13:16 * i + 16] for i in range(faces)}
    assert len(colors) == 14  # each of the 14 faces of the slice comes from another cell


def test_labels_are_engraved_or_separate_bodies(server, tmp_path):
    query = f"polytope=24-cell&{ROTATION}"
    plain = meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "plain.stl", query), 1)
    cut = meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "cut.stl", query + "&label=engraved"), 1)
    assert 0 < plain["volume"] - cut["volume"] < 0.01 * plain["volume"]
    assert cut["box"] == plain["box"]
    both = meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "both.stl", query + "&label=separate"), 2)
    assert both["volume"] > plain["volume"]
    (slice_, label) = meshes.read_three_mf(fetch_file(server, "3mf", query + "&label=separate&body=frame"))
    assert label[0] == slice_[0] + " (label)"
    error = export_refusal(server, "stl", query + "&label=engraved&body=frame")
    assert error["code"] == "no_body" and "separate" in error["message"]
    error = export_refusal(server, "stl", query + "&label=engraved&size=5")
    assert error["code"] == "no_body" and "1 mm" in error["message"]


def test_csv_measurements_match_the_16_cell(server):
    slices = csv_rows(server, "polytope=16-cell&of=oval&slices=5&spacing=0.5")
    levels = csv_rows(server, "polytope=16-cell&of=critical")
    assert [row["n"] for row in slices] == ["-2", "-1", "0", "1", "2"]
    for row in slices:
        # At ±w the 16-cell's slice is the octahedron of radius √2 − |w|.
        radius = 2**0.5 - abs(float(row["w"]))
        assert float(row["volume"]) == pytest.approx(4 / 3 * radius**3)
        assert float(row["area"]) == pytest.approx(4 * 3**0.5 * radius**2)
        assert [row[name] for name in ("vertices", "edges", "faces")] == ["6", "12", "8"]
        assert all(abs(float(row["centroid_" + axis])) < 1e-9 for axis in "xyz")
    assert [int(row["vertices"]) for row in levels] == [1, 6, 1]
    assert [float(row["w"]) for row in levels] == pytest.approx([-(2**0.5), 0, 2**0.5])


async def test_an_exported_4off_file_loads_as_the_same_polytope(server):
    query = f"polytope=24-cell&{ROTATION}"
    data = fetch_file(server, "off", query).decode()
    async with Client(server) as client:
        await client.request("load", name="again", format="off", data=data)
        state = await client.request("get", what="state")
        counts = {name: state["polytope"][name] for name in ("vertices", "edges", "faces", "cells")}
        assert counts == {"vertices": 24, "edges": 96, "faces": 96, "cells": 24}
        again = await client.request("get", what="slices")
        await client.request("set", polytope="24-cell")
        await client.request("rotate", planes=["xw", "yz"], angles=[0.39, 1.42])
        first = await client.request("get", what="slices")
    for one, other in zip(first["slices"], again["slices"]):
        assert one["of"] == other["of"] and one["faces"] == other["faces"]


def test_svg_has_a_line_for_each_coordinate(server, tmp_path):
    path = fetch_file_to(server, tmp_path / "coordinates.svg", f"polytope=600-cell&{ROTATION}")
    subprocess.run(["xmllint", "--noout", str(path)], check=True, timeout=DEADLINE)
    root = ElementTree.fromstring(path.read_bytes())
    space = "{http://www.w3.org/2000/svg}"
    groups = {group.get("id"): group for group in root.iter(space + "g")}
    assert all(len(groups[axis]) == 120 for axis in "xyzw")
    width, height = map(float, root.get("viewBox").split()[2:])
    for line in root.iter(space + "line"):
        assert 0 <= float(line.get("x1")) <= width and 0 <= float(line.get("y2")) <= height


def test_svg_of_many_vertices_shows_their_density(server, tmp_path):
    path = fetch_file_to(server, tmp_path / "density.svg", f"polytope=120-cell&{ROTATION}")
    assert path.stat().st_size < 300_000
    subprocess.run(["xmllint", "--noout", str(path)], check=True, timeout=DEADLINE)
    root = ElementTree.fromstring(path.read_bytes())
    space = "{http://www.w3.org/2000/svg}"
    assert [line.get("id") for line in root.iter(space + "line")] == list("xyzw")
    drawn = {}
    for tone in root.iter(space + "path"):
        for column, row, height in re.findall(r"M(\d+) (\d+)h1v(\d+)h-1z", tone.get("d")):
            for place in range(int(row), int(row) + int(height)):
                assert drawn.setdefault((int(column), place), float(tone.get("fill-opacity"))) > 0
    assert {column for column, _ in drawn} == set(range(193)) and max(drawn.values()) == 1
    for (column, row), opacity in drawn.items():  # the 120-cell is symmetric under point reflection
        assert abs(drawn.get((column, 64 - row), 0) - opacity) < 0.1


@pytest.mark.parametrize("query, code, expected_text", [
    ("focus=90", "no_body", "is empty"), ("of=all", "bad_message", "focus"), ("body=wood", "bad_message", "skeleton"),
    ("size=0.5", "out_of_range", "from 1 to 10000 millimeters"), ("size=thick", "out_of_range", "thick"),
    ("size=nan", "out_of_range", "nan"),
    ("label=gold", "bad_message", "engraved"), ("width=30", "unknown_command", "width is a parameter of pictures"),
    ("rotat=xw:1", "unknown_command", "did you mean 'rotate'?"), ("lable=none", "unknown_command", "did you mean 'label'?"),
    ("focus=90", "no_body", "extends from w = −"),
    ("polytope=25-cell", "unknown_polytope", "24-cell"),
])
def test_invalid_export_parameters_are_explained(server, query, code, expected_text):
    error = export_refusal(server, "stl", query)
    assert error["code"] == code and expected_text in error["message"]
    done = run_oval4d("export", "-o", "-", "--format", "stl", *("--" + part for part in query.split("&")))
    assert done.returncode == 1 and expected_text.encode() in done.stderr and not done.stdout


def test_export_command_lists_the_formats(tmp_path):
    for words in (["-o", tmp_path / "slice.step"], ["-o", "-"], ["--format", "doc"]):
        done = run_oval4d("export", *words)
        assert done.returncode == 1 and b"3mf" in done.stderr
    assert run_oval4d("export", "-o", tmp_path / "no" / "where.stl").returncode == 1


async def test_invalid_file_requests_are_refused(server):
    async with Client(server) as client:
        for members in ({}, {"format": "doc"}, {"format": "stl", "size": "large"},
                        {"format": "stl", "of": "all"}, {"format": "stl", "label": True}):
            with pytest.raises(Refused) as refused:
                await client.request("get", what="file", **members)
            assert refused.value.code == "bad_message"
        with pytest.raises(Refused) as refused:
            await client.request("get", what="file", format="stl", size=0)
        assert refused.value.code == "out_of_range"
        await client.request("set", slices={"focus": 1000})
        with pytest.raises(Refused) as refused:
            await client.request("get", what="file", format="stl")
        assert refused.value.code == "no_body" and "empty" in refused.value.text
        assert (await client.request("get", what="state"))["slices"]["focus"] == 1000


async def test_export_limits_are_enforced():
    query = "polytope=120-cell&of=oval&body=frame"
    with Server("--max-file-triangles", 5000) as server:
        error = export_refusal(server, "stl", query, 413)
        assert error["code"] == "too_large" and "5000 are allowed" in error["message"]
        fetch_file(server, "stl", "polytope=120-cell")
    with Server("--max-file-bytes", "2k") as server:
        assert "2048 bytes" in export_refusal(server, "off", "polytope=120-cell", 413)["message"]
        async with Client(server) as client:
            with pytest.raises(Refused) as refused:
                await client.request("get", what="file", format="off")
                await client.request("get", what="file", format="stl", body="frame")
            assert refused.value.code == "too_large"
    with Server("--max-file-time", 0.001) as server:
        assert "takes longer than" in export_refusal(server, "stl", query, 413)["message"]


# A server takes a hundred times as long to make this file as to answer a few requests for pictures.
LONG_FILE = "/api/v1/file.3mf?polytope=120-cell&of=oval&body=frame"


@contextlib.asynccontextmanager
async def requested_files(server, count):
    """Requests long files, and waits until the server makes one of them. The server must stop before they are done."""
    files = [asyncio.ensure_future(asyncio.to_thread(server.get, LONG_FILE)) for _ in range(count)]
    await asyncio.to_thread(server.wait_for, lambda: server.metric("oval4d_files_under_way") == 1)
    yield files
    ends = await asyncio.gather(*files, return_exceptions=True)
    assert any(isinstance(end, (http.client.HTTPException, OSError)) for end in ends), ends


async def test_pictures_do_not_wait_for_files():
    with Server("--max-file-triangles", 20_000_000, "--stop-timeout", 0.2) as server:
        async with requested_files(server, 3) as files:
            async with Client(server, stream="geometry") as client:
                for _ in range(5):
                    done = await client.request("key", key="r")
                    await client.wait_for_slices(done["revision"])
                assert not all(file.done() for file in files)
            assert server.stop()[0] == 0


async def test_a_server_stop_does_not_wait_for_a_file():
    with Server("--max-file-triangles", 20_000_000, "--stop-timeout", 0.2) as server:
        async with requested_files(server, 1):
            assert server.stop()[0] == 0


def receive_slowly(raw, size, duration):
    """Receives up to this many bytes within no less than `duration`, in seconds, and with many short pauses."""
    received = 0
    with contextlib.suppress(ConnectionResetError):
        while received < size and (part := raw.recv(1 << 18)):
            received += len(part)
            time.sleep(duration * len(part) / size)
    return received


def test_a_slow_reader_receives_a_whole_long_file():
    """It takes longer in total than the time limit of one write, but never pauses that long."""
    for limit in (0.5, 2, 8, 32):  # until the pauses of this machine are shorter
        with Server("--write-timeout", limit) as server:
            whole = server.get("/api/v1/file.stl?polytope=24-cell&of=oval&body=frame").body
            assert len(whole) > 20_000_000
            request = '{"type":"get","what":"file","format":"stl","of":"oval","body":"frame"}'
            raw = open_nonreading_socket(server, '{"type":"hello"}', '{"type":"set","polytope":"24-cell"}', request,
                                         buffer=1 << 18)
            with contextlib.closing(raw):
                server.wait_for(lambda: server.metric("oval4d_file_seconds_count") == 2)
                if receive_slowly(raw, len(whole), 3 * limit) >= len(whole):
                    assert server.metric("oval4d_slow_readers_total") == 0
                    return
    pytest.fail("a slow reader is dropped")


@pytest.mark.parametrize("polytope", ["tesseract", "24-cell", "600-cell", "3,5-duoprism"])
@pytest.mark.parametrize("kind", ["perspective", "orthogonal"])
def test_the_projection_is_a_closed_body_of_balls_and_bars(server, tmp_path, polytope, kind):
    query = f"polytope={polytope}&{ROTATION}&of=projection&projection={kind}&size=100"
    meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "projection.stl", query))  # crossing bars enclose voids


def test_the_projection_has_the_size_of_the_object(server, tmp_path):
    """The vertices of a tesseract at w = ±1 lie on concentric cubes with the half edges d / (d ∓ 1), d: the eye's w."""
    path = fetch_file_to(server, tmp_path / "cubes.stl", "polytope=tesseract&of=projection&eye=3&size=100")
    corners = meshes.stl_triangles(path.read_bytes()).reshape(-1, 3)
    radius = 50 / 2  # millimeters per unit: the circumradius of a tesseract with edge length 2 is 2
    outer = radius * 6 / (6 - 1)
    balls = numpy.ptp(corners, axis=0) / 2 - outer
    assert (balls > 0).all() and (balls < 0.15 * outer).all()


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row["name"])
def test_what_a_format_cannot_contain_is_refused(server, row):
    """The message says what files of this format contain, and which formats contain what was asked for."""
    all_contents = {of for other in TABLE for of in other["of"]}
    for of in sorted(all_contents - set(row["of"])):
        error = export_refusal(server, row["name"], f"polytope=24-cell&of={of}")
        assert error["code"] == "no_body"
        contents, others = error["message"].split("; ")
        assert f", not {of}" in contents and all(own in contents for own in row["of"])
        assert all(other["name"] in others for other in TABLE if of in other["of"])


def test_drawings_show_the_coordinates_unless_another_is_asked_for(server):
    query = "polytope=24-cell"
    assert fetch_file(server, "svg", query) == fetch_file(server, "svg", query + "&of=coordinates")


SVG = "{http://www.w3.org/2000/svg}"


def svg_of(server, tmp_path, query):
    """Returns the root element of a drawing, whose shapes are all within its page."""
    path = fetch_file_to(server, tmp_path / "drawing.svg", query)
    subprocess.run(["xmllint", "--noout", str(path)], check=True, timeout=DEADLINE)
    root = ElementTree.fromstring(path.read_bytes())
    width, height = map(float, root.get("viewBox").split()[2:])
    for line in root.iter(SVG + "line"):
        assert all(0 <= float(line.get(x)) <= width and 0 <= float(line.get(y)) <= height
                   for x, y in (("x1", "y1"), ("x2", "y2")))
    return root


def size_of_svg(data):
    """Returns the width and the height of a drawing in millimeters."""
    root = ElementTree.fromstring(data)
    width, height = (float(re.fullmatch(r"([\d.]+)mm", root.get(name))[1]) for name in ("width", "height"))
    left, top, across, down = map(float, root.get("viewBox").split())
    assert left == top == 0 and across / down == pytest.approx(width / height, rel=1e-3)
    return width, height


def size_of_pdf(data):
    """Returns the width and the height of the only page in millimeters."""
    (box,) = re.findall(rb"/MediaBox\s*\[([^\]]*)\]", data)
    left, bottom, right, top = map(float, box.split())
    assert left == bottom == 0
    return right * 25.4 / 72, top * 25.4 / 72


@pytest.mark.parametrize("query", [
    "polytope=24-cell", "polytope=600-cell", "polytope=120-cell", "polytope=24-cell&of=projection",
    "polytope=24-cell&of=matrix", "formula=x^2%2By^2%2Bz^2-w^2"])
@pytest.mark.parametrize("size", [None, 100, 10, 5000])
def test_svg_and_pdf_have_the_same_size_in_millimeters(server, query, size):
    query += "" if size is None else f"&size={size}"
    by_svg, by_pdf = size_of_svg(fetch_file(server, "svg", query)), size_of_pdf(fetch_file(server, "pdf", query))
    assert by_svg == pytest.approx(by_pdf, rel=1e-4, abs=0.002)
    assert max(by_svg) == pytest.approx(size or 170)


@pytest.mark.parametrize("format_", ["svg", "pdf"])
@pytest.mark.parametrize("size", [0.5, 9, 5001])
def test_the_size_of_a_drawing_is_bounded(server, format_, size):
    error = export_refusal(server, format_, f"polytope=5-cell&size={size}")
    assert error["code"] == "out_of_range" and "from 10 to 5000 millimeters" in error["message"]


HOSTILE_NAMES = ["R&D.off", "a < b > c", "\"quoted\" 'twice'", "]]>", "<!--", "&amp;", "\ufffe\uffff nothing", "π ≈ 3.14 é",
                 "\U0001f9ca ice", "100 % $ ` \\ /", "a, b; c", "=1+1"]


@pytest.mark.parametrize("name", HOSTILE_NAMES, ids=ascii)
async def test_files_of_objects_with_any_name_can_be_parsed(server, tmp_path, name):
    shown = name.replace("\ufffe", "").replace("\uffff", "")  # XML cannot contain these
    async with Client(server, stream="none") as client:
        await client.request("load", name=name, format="points", data="1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n-1 -1 -1 -1\n")
        files = {row["name"]: await file_over_websocket(client, format=row["name"])
                 for row in TABLE if row.get("objects") != "fields"}
    for format_ in ("svg", "x3d", "vtp"):
        ElementTree.fromstring(files[format_])
    assert ElementTree.fromstring(files["svg"]).find(SVG + "title").text.endswith(shown)
    ((object_name, _, _),) = meshes.read_three_mf(files["3mf"])
    assert object_name.startswith(shown)
    path = tmp_path / "body.glb"
    path.write_bytes(files["glb"])
    assert meshes.validate_glb(path)["issues"]["numErrors"] == 0
    assert list(csv.DictReader(io.StringIO(files["csv"].decode())))
    assert off_points(files["off"])
    assert meshes.stl_triangles(files["stl"]).size
    for format_ in ("ply", "obj"):
        path = tmp_path / f"body.{format_}"
        path.write_bytes(files[format_])
        subprocess.run(["assimp", "info", str(path)], capture_output=True, check=True, timeout=DEADLINE)
    path = tmp_path / "drawing.pdf"
    path.write_bytes(files["pdf"])
    info = subprocess.run(["mutool", "show", str(path), "trailer/Info/Title"], capture_output=True, text=True, check=True,
                          timeout=DEADLINE)
    assert info.returncode == 0
    if not name.isascii():  # only PDF 2.0 has UTF-8
        assert files["pdf"].startswith(b"%PDF-1.")
        (written,) = re.findall(rb"/Title <FEFF([0-9A-F]+)>", files["pdf"])
        assert bytes.fromhex(written.decode()).decode("utf-16-be").endswith(name)


@pytest.mark.parametrize("polytope, vertices, edges", [("tesseract", 16, 32), ("120-cell", 600, 1200)])
def test_a_drawing_of_the_projection_has_all_edges(server, tmp_path, polytope, vertices, edges):
    query = f"polytope={polytope}&{ROTATION}&of=projection&focus=99&faces=off"
    root = svg_of(server, tmp_path, query)
    lines = [line for line in root.iter(SVG + "line") if line.get("stroke-linecap") == "round"]
    assert (len(lines), len(list(root.iter(SVG + "circle")))) == (edges, vertices), "the focus slice is beside the object"
    assert not list(root.iter(SVG + "polygon"))
    root = svg_of(server, tmp_path, f"{query}&back=off")
    assert len([line for line in root.iter(SVG + "line") if line.get("stroke-linecap") == "round"]) < edges
    root = svg_of(server, tmp_path, f"polytope={polytope}&{ROTATION}&of=projection&cells=on&faces=off")
    assert len(list(root.iter(SVG + "polygon"))) == {"tesseract": 24, "120-cell": 720}[polytope]


def test_a_drawing_of_the_matrix_has_the_sections(server, tmp_path):
    root = svg_of(server, tmp_path, "polytope=tesseract&of=matrix&point=0.1,0.2,0.3,-0.1")
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    assert set(groups) == {a + b for a in "xyzw" for b in "xyzw" if a != b} | {"names", "numbers"}
    assert [text.text for text in groups["names"].iter(SVG + "text")] == list("xyzw")
    # The tesseract has the circumradius 2, so the panels reach a little farther, below four columns and beside four rows.
    assert collections.Counter(text.text for text in groups["numbers"].iter(SVG + "text")) == dict.fromkeys(
        ("-2", "-1", "0", "1", "2"), 8)
    for name, group in groups.items():
        if name not in ("names", "numbers"):
            polygon, = group.iter(SVG + "polygon")
            corners = [tuple(map(float, corner.split(","))) for corner in polygon.get("points").split()]
            assert len({x for x, _ in corners}) == len({y for _, y in corners}) == 2, "a square"
            assert len(list(group.iter(SVG + "circle"))) == 4


def contrast_to_white(color):
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
              for c in (int(color[i:i + 2], 16) / 255 for i in (1, 3, 5))]
    return 1.05 / (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05)


@pytest.mark.parametrize("of, slices", [("oval", 7), ("focus", 1)])
def test_a_drawing_of_slices_has_their_elements_and_holds_on_white(server, tmp_path, of, slices):
    query = f"polytope=24-cell&{ROTATION}&slices=7&of={of}&background=dark"  # paper is white in any case
    root = svg_of(server, tmp_path, query)
    rows = [row for row in csv_rows(server, f"polytope=24-cell&{ROTATION}&slices=7&of={of}") if int(row["vertices"])]
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    assert len([name for name in groups if name.startswith("slice_")]) == slices
    for row in rows:
        group = groups[f"slice_{row['n']}"]
        count = {shape: len(list(group.iter(SVG + shape))) for shape in ("polygon", "line", "circle")}
        assert (count["polygon"], count["circle"]) == (int(row["faces"]), int(row["vertices"]))
        assert count["line"] <= int(row["edges"])  # those inside balls are not drawn
    labels = [text.text for text in groups["labels"]]
    assert any(label.startswith("w = 0") for label in labels) and (of == "focus" or "-" in "".join(labels))
    assert sorted(text.text for text in groups["axes"].iter(SVG + "text")) == list("xyz")
    for shape in root.iter():
        color = shape.get("fill") or shape.get("stroke")
        least = 4.5 if shape.tag == SVG + "text" else 2.9  # a light brightens some faces
        assert color is None or contrast_to_white(color) >= least, color
    only = svg_of(server, tmp_path, f"{query}&faces=off&balls=off&labels=off")
    assert not list(only.iter(SVG + "polygon")) and not list(only.iter(SVG + "circle"))[3:], "only the tips of the axes"
    assert [len(group) for group in only.iter(SVG + "g") if group.get("id") == "labels"] == [0]
    assert any(line.get("stroke-linecap") == "round" for line in only.iter(SVG + "line")), "bars meet without balls"


def test_a_drawing_of_the_focus_slice_marks_the_focus_point(server, tmp_path):
    query = "polytope=tesseract&of=focus"
    points = []
    for point in ("0,0,0,0", "0.2,0.1,-0.3,0", "-0.2,0.1,-0.3,0"):
        root = svg_of(server, tmp_path, f"{query}&point={point}")
        marks = [group for group in root.iter(SVG + "g") if group.get("id") == "focus-point"]
        points.append([float(line.get("x1")) + float(line.get("x2")) for line in marks[0]] if marks else None)
    assert points[0] is None and len(points[1]) == 3
    assert all(right > left for right, left in zip(points[1], points[2])), "the first point is farther right"


def test_a_drawing_of_the_slices_of_a_star_has_its_faces_and_one_of_a_field_is_refused(server, tmp_path):
    root = svg_of(server, tmp_path, "polytope={5/2,5,3}&of=focus&rotate=xw:0.3")
    assert len(list(root.iter(SVG + "polygon"))) > 100
    error = export_refusal(server, "svg", "formula=x^2%2By^2%3C1&of=oval")
    assert error["code"] == "no_body" and "field" in error["message"]


@pytest.mark.parametrize("query, words", [
    ("polytope=5-cell", ["P0", "P4"]), ("polytope=24-cell", ["P0", *"xyzw"]), ("polytope=24-cell&of=oval", list("xyz")),
    ("polytope=24-cell&of=focus", list("xyz")), ("polytope=120-cell", list("xyzw")), ("polytope=24-cell&of=matrix", list("xyzw")),
    ("polytope=24-cell&of=projection&cells=on&hidden=none", []), ("polytope={5/2,5,3}&of=matrix", list("xyzw")),
    ("polytope={5/2,5,3}&of=projection", []),
])
def test_a_pdf_document_has_the_drawing_on_one_page(server, tmp_path, query, words):
    """MuPDF, an independent reader, opens the document without a complaint and sees what the SVG image shows."""
    path = fetch_file_to(server, tmp_path / "drawing.pdf", f"{query}&{ROTATION}")
    assert path.read_bytes().startswith(b"%PDF-1.")
    info = subprocess.run(["mutool", "info", str(path)], check=True, timeout=DEADLINE, capture_output=True, text=True)
    assert "Pages: 1" in info.stdout and "error" not in info.stderr
    text = subprocess.run(["mutool", "draw", "-F", "txt", str(path)], check=True, timeout=DEADLINE, capture_output=True, text=True)
    assert "error" not in text.stderr and all(word in text.stdout.split() for word in words)
    picture = tmp_path / "drawing.png"
    subprocess.run(["mutool", "draw", "-q", "-r", "72", "-o", str(picture), str(path)], check=True, timeout=DEADLINE)
    root = svg_of(server, tmp_path, f"{query}&{ROTATION}")
    size, data = png.pixels(picture.read_bytes())
    assert size == pytest.approx([float(root.get(name)[:-2]) * 72 / 25.4 for name in ("width", "height")], abs=1)
    dark = sum(min(rgb) < 200 for rgb in zip(data[::3], data[1::3], data[2::3]))
    assert dark > 0.01 * size[0] * size[1]
