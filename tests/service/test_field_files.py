"""Exported files of fields: measurements, bodies, and files for ParaView."""

import csv
import io
import json
import math
import struct
from urllib.parse import quote, urlencode

import meshes
import numpy
import pytest
from harness import run_oval4d
from surfaces import ellipsoid_slice, tiger_slice

BALL = "x^2 + y^2 + z^2 + w^2 < 1"
BALL_BOX = "-1.2,1.2,-1.2,1.2,-1.2,1.2,-1.2,1.2"
TIGER = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.8)^2 < 0.1225"
TIGER_BOX = "-1.4,1.4,-1.4,1.4,-1.2,1.2,-1.2,1.2"
CUT_BOX = "-0.5,1.4,-1.4,1.4,-1.2,1.2,-1.2,1.2"  # cuts through the tiger, so its slices have caps
TURN = "xw,yz:0.7,0.4"


def fetch(server, format_, formula, box, status=200, **query):
    answer = server.get(f"/api/v1/file.{format_}?{urlencode({'formula': formula, 'box': box, **query}, quote_via=quote)}")
    assert answer.status == status, answer.body[:500]
    return answer.body


def fetch_to(path, server, *arguments, **query):
    path.write_bytes(fetch(server, path.suffix[1:], *arguments, **query))
    return path


def rows_of(data):
    rows = list(csv.DictReader(io.StringIO(data.decode())))
    return [{name: float(value) if value else None for name, value in row.items()} for row in rows]


# --- Measurements in CSV files


@pytest.mark.release_only
def test_the_csv_measures_balls(server):
    rows = rows_of(fetch(server, "csv", BALL, BALL_BOX, of="oval", slices=13, spacing=0.2, rotate=TURN))
    assert list(rows[0]) == ["n", "w", "volume", "area", "centroid_x", "centroid_y", "centroid_z", "components", "euler"]
    assert [row["n"] for row in rows] == list(range(-6, 7))
    for row in rows:
        assert row["w"] == pytest.approx(0.2 * row["n"])
        if abs(row["w"]) > 0.99:
            assert (row["volume"], row["area"], row["components"], row["euler"]) == (0, 0, 0, 0)
            assert row["centroid_x"] is None
            continue
        radius = math.sqrt(1 - row["w"] ** 2)
        # The field is a piecewise linear function of 64 cells across the box, so the error is of second order.
        assert row["volume"] == pytest.approx(4 / 3 * math.pi * radius**3, rel=0.01)
        assert row["area"] == pytest.approx(4 * math.pi * radius**2, rel=0.01)
        assert [row[f"centroid_{a}"] for a in "xyz"] == pytest.approx([0, 0, 0], abs=1e-3)
        assert (row["components"], row["euler"]) == (1, 2)


@pytest.mark.release_only
def test_the_csv_of_an_ellipsoid_follows_rotations(server):
    axes, center, angle = (0.9, 0.6, 0.7, 0.8), (0.1, -0.2, 0.15, 0.05), 0.7
    formula = " + ".join(f"(({name}-({c}))/{a})^2" for name, a, c in zip("xyzw", axes, center)) + " < 1"
    orientation = [[math.cos(angle), 0, 0, -math.sin(angle)], [0, 1, 0, 0], [0, 0, 1, 0],
                   [math.sin(angle), 0, 0, math.cos(angle)]]
    measured = 0
    for row in rows_of(fetch(server, "csv", formula, BALL_BOX, of="oval", slices=9, spacing=0.15,
                             rotate=f"xw:{angle}")):
        expected = ellipsoid_slice(axes, center, orientation, row["w"])
        if expected is None or expected.scale < 0.3:
            continue
        assert row["volume"] == pytest.approx(expected.volume, rel=0.02)
        assert [row[f"centroid_{a}"] for a in "xyz"] == pytest.approx(expected.centroid, abs=5e-3)
        measured += 1
    assert measured >= 7


@pytest.mark.release_only
def test_the_csv_shows_the_topology_of_the_tiger(server):
    rows = rows_of(fetch(server, "csv", TIGER, TIGER_BOX, of="oval", slices=21, spacing=0.11))
    for row in rows:
        w = abs(row["w"])
        assert row["volume"] == pytest.approx(tiger_slice(1, 0.8, 0.35, row["w"]), rel=0.03, abs=0.01)
        assert row["euler"] == 0
        if min(abs(w - 0.45), abs(w - 1.15)) > 0.05:
            assert row["components"] == (2 if w < 0.45 else 1 if w < 1.15 else 0)


def test_the_csv_has_a_row_for_each_of_several_levels(server):
    rows = rows_of(fetch(server, "csv", "sqrt(x^2+y^2+z^2+w^2)", BALL_BOX, levels="0.5,1,9", slices=3))
    assert [(row["n"], row["level"]) for row in rows] == [(0, 0.5), (0, 1), (0, 9)]
    for row, radius in zip(rows, (0.5, 1)):
        assert row["volume"] == pytest.approx(4 / 3 * math.pi * radius**3, rel=0.01)
    # The whole box is inside the body, so there is no level surface.
    assert rows[2]["volume"] == pytest.approx(2.4**3) and rows[2]["area"] == 0 and rows[2]["euler"] == 2
    outside = rows_of(fetch(server, "csv", "sqrt(x^2+y^2+z^2+w^2)", BALL_BOX, levels="0.5", inside="above"))
    assert outside[0]["volume"] == pytest.approx(2.4**3 - rows[0]["volume"], rel=1e-9)
    assert (outside[0]["components"], outside[0]["euler"]) == (1, 4)


def test_the_csv_measures_arrays_with_holes(tmp_path):
    numpy = pytest.importorskip("numpy")
    samples = numpy.ones((5, 5, 5, 5), dtype="f4")
    samples[2, 2, 2, 2] = numpy.nan
    numpy.save(tmp_path / "hole.npy", samples)
    done = run_oval4d("export", "--format", "csv", "-o", "-", "--load", tmp_path / "hole.npy", "--levels=0.5",
                      "--inside", "above", "--of", "oval", "--slices", 3, "--spacing", 0.2)
    assert done.returncode == 0, done.stderr
    for row in rows_of(done.stdout):
        assert 7 < row["volume"] < 8 and row["area"] == 0
        assert (row["components"], row["euler"]) == (1, 4), "a cube with a cavity"


@pytest.mark.release_only
def test_the_csv_of_critical_w_says_what_changes_there(server):
    rows = list(csv.DictReader(io.StringIO(fetch(server, "csv", BALL, BALL_BOX, of="critical", rotate=TURN).decode())))
    assert [row.pop("change") for row in rows] == ["appears", "vanishes"]
    first, last = ({name: float(value) for name, value in row.items()} for row in rows)
    ball = {"components": 1, "cavities": 0, "euler": 2}
    for row, w, inside, outside in ((first, -1, "after", "before"), (last, 1, "before", "after")):
        assert row["w"] == pytest.approx(w, abs=1e-3) and row["level"] == 0 and 0 < row["tolerance"] < 1e-2
        for name, value in ball.items():
            assert (row[f"{name}_{inside}"], row[f"{name}_{outside}"]) == (value, 0)


# --- Bodies for printing


@pytest.mark.parametrize("formula, box", [(BALL, BALL_BOX), (TIGER, TIGER_BOX), (TIGER, CUT_BOX)])
@pytest.mark.parametrize("rotate", ["xy:0", TURN])
def test_admesh_finds_nothing_to_repair(server, tmp_path, formula, box, rotate):
    for focus in (0, 3):
        query = {"rotate": rotate, "focus": focus, "spacing": 0.13}
        (row,) = rows_of(fetch(server, "csv", formula, box, **query))
        report = meshes.assert_closed_mesh(fetch_to(tmp_path / "body.stl", server, formula, box, **query),
                                           parts=row["components"])
        (xl, xh, yl, yh, zl, zh, wl, wh) = map(float, box.split(","))
        scale = 30 / (math.hypot(xh - xl, yh - yl, zh - zl, wh - wl) / 2)
        assert report["volume"] == pytest.approx(row["volume"] * scale**3, rel=0.02)


def test_all_slices_are_bodies_with_labels(server):
    objects = meshes.read_three_mf(fetch(server, "3mf", TIGER, CUT_BOX, of="oval", slices=3, spacing=0.3, rotate=TURN,
                                         label="separate"))
    assert sum("label" in name for name, *_ in objects) * 2 == len(objects) >= 6
    for _, points, triangles in objects:
        meshes.assert_manifold(triangles)
        assert meshes.volume(points, triangles) > 0


def test_levels_are_bodies_of_their_own_except_for_printers(server):
    formula, levels = "sqrt(x^2+y^2+z^2+w^2)", "0.5,1"
    text = fetch(server, "obj", formula, BALL_BOX, levels=levels).decode()
    names = [line[2:] for line in text.splitlines() if line.startswith("o ")]
    assert names == ["formula,_w_=_0,_level_1", "formula,_w_=_0,_level_0.5"]
    ((_, points, triangles),) = meshes.read_three_mf(fetch(server, "3mf", formula, BALL_BOX, levels=levels))
    assert meshes.volume(points, triangles) == pytest.approx(4 / 3 * math.pi * (30 / 2.4) ** 3, rel=0.01)


def ply_vertices(data):
    """Returns the header of a PLY file, and (x, y, z, red, green, blue, value) of each vertex."""
    header, rest = data.split(b"end_header\n", 1)
    count = int(header.split(b"element vertex ")[1].split()[0])
    return header.decode(), list(struct.iter_unpack("<fffBBBf", rest[:19 * count]))


def test_ply_has_colors_and_values_at_points(server):
    header, vertices = ply_vertices(fetch(server, "ply", BALL, BALL_BOX, focus=1, spacing=0.5))
    assert "property float value" in header
    scale, radius = 30 / 2.4, math.sqrt(0.75)
    for x, y, z, *color, value in vertices:
        assert abs(math.hypot(x, y, z) / scale - radius) <= 0.01 * radius and abs(value) < 0.01
        assert color == list(vertices[0][3:6])
    growing = "sqrt(x^2+y^2+z^2) < 0.6 + 0.3*x*t"  # grows where x is positive, and shrinks where x is negative
    _, vertices = ply_vertices(fetch(server, "ply", growing, BALL_BOX, color="growth"))
    for x, _, _, red, _, blue, _ in vertices:
        assert red > blue if x > 2 else red < blue if x < -2 else True


def test_viewers_read_the_bodies(server, tmp_path):
    volumes = []
    for format_, unit in (("stl", 1), ("obj", 1), ("ply", 1), ("glb", 1000), ("x3d", 1000)):
        path = fetch_to(tmp_path / f"body.{format_}", server, TIGER, CUT_BOX, rotate=TURN)
        corners = meshes.stl_triangles(meshes.convert_with_assimp(path, tmp_path / "again.stl").read_bytes())
        volumes.append(meshes.volume_of(corners) * unit**3)
    ((_, points, faces),) = meshes.read_scad(fetch(server, "scad", TIGER, CUT_BOX, rotate=TURN))
    volumes.append(-meshes.volume(points, faces))
    assert volumes == pytest.approx([volumes[0]] * len(volumes), rel=1e-3) and volumes[0] > 0
    report = meshes.validate_glb(tmp_path / "body.glb")
    assert report["issues"]["numErrors"] == report["issues"]["numWarnings"] == 0, report["issues"]


# --- Files for ParaView


def test_vtp_contains_the_surfaces(server):
    data = meshes.read_vtk(fetch(server, "vtp", TIGER, CUT_BOX, of="oval", slices=3, spacing=0.3, rotate=TURN,
                                 levels="0,0.05"), "PolyData")
    points, point, cell = data["Points"]["points"], data["PointData"], data["CellData"]
    assert {name: len(values) for name, values in point.items()} == {
        "value": len(points), "normals": len(points), "growth": len(points)}
    ends = data["Polys"]["offsets"]
    assert ends == list(range(3, 3 * len(ends) + 1, 3))
    assert set(cell) == {"level", "cap", "n", "w"} and all(len(values) == len(ends) for values in cell.values())
    assert set(cell["level"]) == {0, 0.05} and set(cell["cap"]) == {0, 1} and set(cell["n"]) == {-1, 0, 1}
    normals = numpy.array(point["normals"])
    assert numpy.linalg.norm(normals, axis=1) == pytest.approx(1, abs=1e-4)
    triangles = numpy.array(data["Polys"]["connectivity"]).reshape(-1, 3)
    a, b, c = numpy.array(data["Points"]["points"])[triangles.T]
    agrees = (numpy.cross(b - a, c - a) * normals[triangles[:, 0]]).sum(axis=1) >= 0
    assert agrees.mean() > 0.99
    deviations = numpy.array(point["value"])[triangles[:, 0]] - cell["level"]
    assert abs(deviations[numpy.array(cell["cap"]) == 0]).max() <= 0.01


def test_vtp_contains_the_faces_of_polytopes(server):
    answer = server.get("/api/v1/file.vtp?polytope=8-cell&of=focus")
    data = meshes.read_vtk(answer.body, "PolyData")
    assert len(data["Points"]["points"]) == 8 and data["Polys"]["offsets"] == [4, 8, 12, 16, 20, 24]
    assert len(set(data["CellData"]["cell"])) == 6 and set(data["CellData"]["w"]) == {0}


def test_vti_samples_the_slice(server):
    data = meshes.read_vtk(fetch(server, "vti", "x + 10*y + 100*z + 1000*w", BALL_BOX, focus=1, spacing=0.5,
                                 rotate="zw:pi/2"), "ImageData")
    low, high = data["extent"][::2], data["extent"][1::2]
    assert low == [0, 0, 0]
    counts = [n + 1 for n in high]
    values = data["PointData"]["value"]
    assert len(values) == math.prod(counts)
    # The hyperplane is w = 0.5 after the rotation, which turns z toward w. The function's z is then w, and its w is −z.
    for i, j, k in ((0, 0, 0), (5, 7, 9), (high[0], high[1], high[2])):
        x, y, z = (o + s * n for o, s, n in zip(data["origin"], data["spacing"], (i, j, k)))
        expected = x + 10 * y + 100 * 0.5 + 1000 * -z
        assert values[i + counts[0] * (j + counts[1] * k)] == pytest.approx(expected, rel=1e-4)
    rotated = meshes.read_vtk(fetch(server, "vti", BALL, BALL_BOX, rotate=TURN), "ImageData")["PointData"]["value"]
    missing = sum(math.isnan(value) for value in rotated)
    assert 0 < missing < 0.8 * len(rotated), "the corners of the bounding box are outside of the domain"


# --- Requests that are refused


@pytest.mark.parametrize("format_, query, reason", [
    ("off", {}, "a field has none"),
    ("vti", {"of": "oval"}, "contain focus, not oval"),
    ("vti", {"focus": 40}, "is empty"),
    ("stl", {"levels": "-5"}, "change the levels"),
    ("stl", {"label": "engraved"}, "separate label"),
    ("csv", {"of": "matrix"}, "svg, pdf or tikz"),
])
def test_what_a_field_has_not_is_refused(server, format_, query, reason):
    error = json.loads(fetch(server, format_, BALL, BALL_BOX, status=400, **query))
    assert error["code"] == "no_body" and reason in error["message"]


def test_a_polytope_has_no_values(server):
    answer = server.get("/api/v1/file.vti?polytope=24-cell")
    error = json.loads(answer.body)
    assert answer.status == 400 and error["code"] == "no_body" and "values of a field" in error["message"]
