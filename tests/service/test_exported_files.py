"""Exported files of every format, read back with other programs: bodies, measurements, and names of objects."""

import csv
import io
import random
import re
import subprocess
from xml.etree import ElementTree

import meshes
import numpy
import pytest
from binary_kinds import kind_of
from exports import ROTATION, SVG, TABLE, csv_rows, export_refusal, fetch_file, fetch_file_to
from harness import DEADLINE, run_oval4d
from PIL import Image
from wire import Client

FORMATS = [row["name"] for row in TABLE if row.get("objects") != "fields"]


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
    if format_ == "3mf":  # 3MF files contain their time of creation
        assert meshes.read_three_mf(by_websocket) == meshes.read_three_mf(by_http) == meshes.read_three_mf(path.read_bytes())
    else:
        assert by_websocket == by_http == path.read_bytes()
    assert kind_of(by_websocket) == "file"


@pytest.mark.parametrize("polytope", ["5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"])
def test_admesh_finds_nothing_to_repair_after_any_rotation(server, tmp_path, polytope):
    rng = random.Random(polytope)
    turns = [""] + [f"&rotate=xw,yz:{rng.uniform(0, 6)},{rng.uniform(0, 6)}&rotate=xy,zw:{rng.uniform(0, 6)},"
                    f"{rng.uniform(0, 6)}" for _ in range(8)]
    for turn in turns:
        query = f"polytope={polytope}{turn}&focus={rng.randint(-4, 4)}"
        report = meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "solid.stl", query), parts=1)
        (row,), levels = csv_rows(server, query), csv_rows(server, query + "&of=critical")
        # The sphere around the polytope has a diameter of 60 mm. The 4OFF file gives its radius in the polytope's
        # units.
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
    # Flat slices have no solid, but their balls and bars are exported.
    parts = len(full) if body == "solid" else sum(1 for row in slices if int(row["vertices"]) > 0)
    report = meshes.assert_closed_mesh(path, parts)
    assert all(low == pytest.approx(0, abs=1e-3) for low, _ in report["box"])
    assert report["box"][2][1] < 60
    if body == "skeleton" and polytope != "5-cell":
        return  # there are too many triangles to check in Python
    # In 3MF, each part is an object. The bounding boxes of the objects are disjoint.
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
    assert len(colors) == 14  # the slice has 14 faces, each from another cell


def test_openscad_modules_are_the_bodies_of_3mf_with_clockwise_faces(server):
    query = f"polytope=24-cell&{ROTATION}&of=oval&slices=5&label=separate"
    modules = meshes.read_scad(fetch_file(server, "scad", query))
    objects = meshes.read_three_mf(fetch_file(server, "3mf", query))
    assert [name for name, _, _ in modules] == [name for name, _, _ in objects]
    for (_, points, faces), (_, printed_points, triangles) in zip(modules, objects):
        meshes.assert_manifold(faces)
        assert meshes.volume(points, faces) == pytest.approx(-meshes.volume(printed_points, triangles), rel=1e-3)


def test_pov_scenes_have_what_the_picture_shows(server):
    def scene(query):
        return fetch_file(server, "pov", "polytope=8-cell&slices=3&spacing=0.5" + query).decode()

    def shapes(text):
        return [text.count("\n" + shape) for shape in ("sphere {", "cylinder {", "mesh2 {", "Label(")]

    assert shapes(scene("")) == [24, 36, 3, 3]
    assert shapes(scene("&of=focus")) == [8, 12, 1, 1]
    assert shapes(scene("&faces=off&labels=off")) == [24, 36, 0, 0]
    assert shapes(scene("&projection=perspective"))[0] == 24 + 16 + 8, "and the tesseract with a section"
    assert "background { rgbt <1, 1, 1, 0> }" in scene("&background=white")
    right, turned = (re.search(r"Right = <(.*)>", scene(query))[1] for query in ("", "&azimuth=0.5"))
    assert right != turned, "the camera is that of the picture"


@pytest.mark.parametrize("query", ["polytope=8-cell&of=focus", "formula=x^2%2By^2%2Bz^2%2Bw^2%3C1&of=focus"])
def test_povray_draws_the_scene(server, tmp_path, query):
    (tmp_path / "scene.pov").write_bytes(fetch_file(server, "pov", query + "&background=white&labels=off"))
    done = subprocess.run(["povray", "+Iscene.pov", "+Oscene.png", "+W64", "+H64", "+WT1", "-D"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=DEADLINE)
    assert done.returncode == 0, done.stderr
    pixels = numpy.array(Image.open(tmp_path / "scene.png").convert("RGB"))
    assert (pixels[[0, 0, -1, -1], [0, -1, 0, -1]] == 255).all(), "the corners show the background"
    assert 0.02 < (pixels != 255).any(axis=2).mean() < 0.9, "the slice is in the picture, and fits into it"


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
        # The slice of the 16-cell at ±w is an octahedron of radius √2 − |w|.
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


@pytest.mark.parametrize("polytope", ["tesseract", "24-cell", "600-cell", "3,5-duoprism"])
@pytest.mark.parametrize("kind", ["perspective", "orthogonal"])
def test_the_projection_is_a_closed_body_of_balls_and_bars(server, tmp_path, polytope, kind):
    query = f"polytope={polytope}&{ROTATION}&of=projection&projection={kind}&size=100"
    meshes.assert_closed_mesh(fetch_file_to(server, tmp_path / "projection.stl", query))  # crossing bars enclose voids


def test_the_projection_has_the_size_of_the_object(server, tmp_path):
    """The vertices of a tesseract at w = ±1 lie on concentric cubes with the half edges d / (d ∓ 1), d: the eye's w."""
    path = fetch_file_to(server, tmp_path / "cubes.stl", "polytope=tesseract&of=projection&eye=3&size=100")
    corners = meshes.stl_triangles(path.read_bytes()).reshape(-1, 3)
    radius = 50 / 2  # millimeters per unit; a tesseract with edges of length 2 has the circumradius 2
    outer = radius * 6 / (6 - 1)
    balls = numpy.ptp(corners, axis=0) / 2 - outer
    assert (balls > 0).all() and (balls < 0.15 * outer).all()


HOSTILE_NAMES = ["R&D.off", "a < b > c", "\"quoted\" 'twice'", "]]>", "<!--", "&amp;", "\ufffe\uffff nothing", "π ≈ 3.14 é",
                 "\U0001f9ca ice", "100 % $ ` \\ /", "a, b; c", "=1+1"]


@pytest.mark.parametrize("name", HOSTILE_NAMES, ids=ascii)
async def test_files_of_objects_with_any_name_can_be_parsed(server, tmp_path, name):
    shown = name.replace("\ufffe", "").replace("\uffff", "")  # XML cannot contain these characters
    async with Client(server, stream="none") as client:
        await client.request("load", name=name, format="points", data="1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n-1 -1 -1 -1\n")
        files = {row["name"]: await file_over_websocket(client, format=row["name"])
                 for row in TABLE if row.get("objects") != "fields"}
    for format_ in ("svg", "x3d", "vtp"):
        ElementTree.fromstring(files[format_])
    assert ElementTree.fromstring(files["svg"]).find(SVG + "title").text.endswith(shown)
    ((object_name, _, _),) = meshes.read_three_mf(files["3mf"])
    assert object_name.startswith(shown)
    ((module_name, _, _),) = meshes.read_scad(files["scad"])
    assert module_name == object_name
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
