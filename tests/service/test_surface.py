"""Surfaces in R⁴: loading, slicing, drawing, exporting and storing them."""

import io
import math

import meshes
import png
import pytest
from harness import Server, run_oval4d
from PIL import Image
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}


def clifford_torus(columns, rows, header="{vertices} {faces} {edges} 0"):
    """Returns a mesh of quads with vertices on the Clifford torus as 4OFF, and its vertices."""
    points = [[math.cos(a), math.sin(a), math.cos(b), math.sin(b)]
              for a in (2 * math.pi * i / columns for i in range(columns))
              for b in (2 * math.pi * j / rows for j in range(rows))]
    faces = [[i * rows + j, k * rows + j, k * rows + n, i * rows + n]
             for i in range(columns) for j in range(rows)
             for k, n in [((i + 1) % columns, (j + 1) % rows)]]
    counts = header.format(vertices=len(points), faces=len(faces), edges=2 * len(faces))
    records = [" ".join(map(repr, p)) for p in points] + ["4 " + " ".join(map(str, f)) for f in faces]
    return "\n".join(["4OFF", counts, *records]) + "\n", points


@pytest.mark.parametrize("header", ["{vertices} {faces} {edges} 0", "{vertices} {faces} {edges}"],
                         ids=["four counts", "the counts of Geomview"])
async def test_a_surface_is_cut_in_closed_curves(server, header):
    text, _ = clifford_torus(12, 16, header)
    async with Client(server, stream="none") as client:
        done = await client.request("load", name="torus", format="off", data=text)
        assert "warnings" not in done
        polytope = (await client.request("get", what="state"))["polytope"]
        assert [polytope[name] for name in ("vertices", "edges", "faces", "cells")] == [192, 384, 192, 0]
        assert polytope["kinds"] == []
        await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 1.1])
        slices = await client.request("get", what="slices", **SIZE)
        edges = 0
        for one in slices["slices"]:
            ends = [0] * len(one["vertices"])
            for edge in one["edges"]:
                for end in edge:
                    ends[end] += 1
            assert set(ends) <= {2} and len(one["faces"]) == 0
            # A hyperplane can contain a vertex or an edge of the surface. Its number then follows the numbers of the
            # edges or the 2-faces.
            assert all(0 <= source < 384 + 192 for source in one["of"]["vertices"])
            assert all(0 <= source < 192 + 384 for source in one["of"]["edges"])
            edges += len(one["edges"])
        assert edges > 100


async def test_a_surface_is_drawn_turned_projected_and_highlighted(server):
    text, _ = clifford_torus(12, 16)
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="off", data=text)
        last = png.pixels(await client.request_frame(**SIZE))
        await client.request("key", key="y")
        assert png.pixels(await client.request_frame(**SIZE)) != last
        await client.request("undo")
        assert png.pixels(await client.request_frame(**SIZE)) == last
        for change in ({"highlight": {"element": "face", "number": 20}},
                       {"highlight": {"element": "edge", "number": 7}}, {"shown": {"balls": False}},
                       {"shown": {"coordinates": False}}, {"projection": "perspective"}, {"shown": {"bars": False}},
                       {"view": "matrix"}):
            await client.request("set", **change)
            picture = png.pixels(await client.request_frame(**SIZE))
            assert picture != last, change
            last = picture


async def test_the_projection_shows_the_faces_of_a_surface(server):
    text, points = clifford_torus(12, 16)
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="off", data=text)
        await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 1.1])
        pictures = []
        for change, faces, colors in (({"projection": "orthogonal"}, 0, 0), ({"shown": {"cells": True}}, 192, 1),
                                      ({"shown": {"back": False}}, 192, 1), ({"color": "w"}, 192, 192)):
            await client.request("set", **change)
            slices = await client.request("get", what="slices", **SIZE)
            whole, section = slices["projection"]["parts"]
            assert (len(whole["faces"]), len(section["faces"])) == (faces, 0), change
            assert len(slices["scene"]["colors"]["cells"]) == colors, change
            assert whole["of"]["faces"] == list(range(faces)), change
            assert set(whole.get("tints", whole["of"]["faces"])) == set(range(colors))
            pictures.append(png.pixels(await client.request_frame(**SIZE)))
        plain, with_faces, without_back, colored = pictures
        assert without_back == with_faces, "a surface has no side that the eye cannot see"
        assert len({hash(picture) for picture in (plain, with_faces, colored)}) == 3


async def test_a_surface_has_elements_but_no_cells(server):
    text, _ = clifford_torus(12, 16)
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="off", data=text)
        with pytest.raises(Refused, match="no cells"):
            await client.request("set", hidden=[0])
        with pytest.raises(Refused):
            await client.request("set", highlight={"element": "cell", "number": 0})
        measured = await client.request("measure", element="edge", number=0)
        assert measured["length"] == pytest.approx(2 * math.sin(math.pi / 12))
        critical = await client.request("get", what="critical")
        assert [one["vertices"] for one in critical["sections"]] == [12] + 7 * [24] + [12]


async def test_the_bars_of_curves_need_a_depth_buffer(server):
    """The curves frame no convex body, so that no order of drawing is right for all views."""
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="off", data=clifford_torus(12, 16)[0])
        assert (await client.request("get", what="slices", **SIZE))["scene"]["opacity"] == 1


async def test_the_nearer_of_two_crossing_bars_is_in_front(server):
    """The slice w = 0 has a bar from z = −1 to 1, which passes through (0, 0, 0), and in two of three cases a bar that
    passes through (0, 0, z)."""
    def crossing(z, reach, w):
        vertices = ["-1 -0.2 -1 0", "1 0.2 1 0", "0 0 0 1", f"0 {-reach} {z} {w}", f"0 {reach} {z} {w}", f"0 0 {z} 1"]
        return "\n".join(["4OFF", "6 2 6", *vertices, "3 0 1 2", "3 3 4 5"]) + "\n"

    async with Client(server, stream="none") as client:
        seen = {}
        for case, data in {"behind": crossing(-0.5, 1, 0), "in front": crossing(0.5, 1, 0),
                           "absent": crossing(0.5, 0.6, 0.8)}.items():
            await client.request("load", name="bars", format="off", data=data)
            await client.request("set", view="single", shown={"balls": False, "coordinates": False}, thickness=3,
                                 slices={"count": 1}, highlight={"element": "face", "number": 0})
            picture = Image.open(io.BytesIO(await client.request_frame(width=400, height=400))).convert("RGB")
            seen[case] = sum(red > green + 60 for red, green, _ in picture.getdata())  # counts highlighted pixels
        assert seen["behind"] > 0.99 * seen["absent"] > 1.1 * seen["in front"] > 100, seen


async def test_the_area_of_a_face_that_is_not_flat_does_not_depend_on_its_first_vertex(server):
    corners = ["1 0 0 1", "0 1 0 -1", "-1 0 0 1", "0 -1 0 -1"]
    async with Client(server, stream="none") as client:
        for first in range(4):
            loop = " ".join(str((first + i) % 4) for i in range(4))
            await client.request("load", name="saddle", format="off", center="origin",
                                 data="\n".join(["4OFF", "4 1 4", *corners, f"4 {loop}"]) + "\n")
            measured = await client.request("measure", element="face", number=0)
            assert measured["area"] == pytest.approx(2)  # its projection to the xy plane is a square of area 2


async def test_a_planar_section_shows_the_curves_in_its_plane(server):
    """The slice w = 0 of the graph of w = x² − y², z = 2xy, is two lines, each in one plane of two axes."""
    steps = [-1, -0.5, 0, 0.5, 1]
    points = [f"{x} {y} {2 * x * y} {x * x - y * y}" for x in steps for y in steps]
    faces = [f"4 {5 * i + j} {5 * i + j + 5} {5 * i + j + 6} {5 * i + j + 1}" for i in range(4) for j in range(4)]
    data = "\n".join(["4OFF", f"{len(points)} {len(faces)} 0", *points, *faces]) + "\n"
    async with Client(server, stream="none") as client:
        await client.request("load", name="square", format="off", data=data, center="origin")
        await client.request("set", view="matrix")
        matrix = (await client.request("get", what="slices", **SIZE))["matrix"]
        found = {"".join("xyzw"[axis] if isinstance(axis, int) else axis for axis in section["axes"]):
                 len(section["points"]) for section in matrix["sections"]}
        assert found["xw"] >= 5 and found["yw"] >= 5, found


async def test_vtp_contains_the_curves(server):
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="off", data=clifford_torus(12, 16)[0])
        await client.request("rotate", planes=["xw", "yz"], angles=[0.39, 1.42])
        slices = (await client.request("get", what="slices"))["slices"]
        done = await client.request("get", what="file", format="vtp", of="oval")
        data = meshes.read_vtk(client.messages[client.messages.index(done) - 1], "PolyData")
        assert len(data["Lines"]["offsets"]) == sum(len(one["edges"]) for one in slices) == len(data["CellData"]["w"])
        assert set(data["CellData"]) == {"n", "w"} and len(data["Points"]["points"]) > 100


@pytest.mark.parametrize("data, message", [
    ("4OFF\n3 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n", "the file lists neither 2-faces nor cells"),
    ("4OFF\n3 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 3\n",
     "line 6: 2-face 0 refers to vertex 3, but the last is vertex 2"),
    ("4OFF\n3 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 1\n", "line 6: 2-face 0 lists a vertex twice"),
    ("4OFF\n3 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n2 0 1\n", "line 6: 2-face 0 has 2 vertices; 3 to 3 are allowed"),
    ("4OFF\n3 1 3\n1 0 0 0\n0 1 0\n0 0 1 0\n3 0 1 2\n", "line 4: vertex 1 has 3 of 4 coordinates"),
    ("4OFF\n3 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 2\n3 0 1 2\n", "line 7: '3' follows the last 2-face"),
    ("4OFF\n3 1 3\n0 0 0 0\n0 0 0 0\n0 0 0 0\n3 0 1 2\n", "all vertices are at the origin"),
], ids=["no faces", "vertex out of range", "vertex twice", "two vertices", "three coordinates", "data after the end",
        "no extent"])
async def test_invalid_surfaces_are_refused(server, data, message):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused) as refused:
            await client.request("load", name="s", format="off", data=data)
        assert refused.value.code == "bad_polytope" and message in refused.value.text
        assert (await client.request("get", what="state"))["polytope"]["name"] == "5-cell"


async def test_the_number_of_vertices_is_limited():
    text, _ = clifford_torus(12, 16)
    with Server("--max-vertices", "191") as server:
        async with Client(server, stream="none") as client:
            with pytest.raises(Refused, match="at most 191 are allowed") as refused:
                await client.request("load", name="s", format="off", data=text)
            assert refused.value.code == "too_large"


async def test_repairs_are_reported_as_warnings(server):
    data = "4OFF\n5 1 7\n1 0 0 0\n9 9 9 9\n0 1 0 0\n0 0 1 0\n8 8 8 8\n3 0 2 3\n"
    async with Client(server, stream="none") as client:
        done = await client.request("load", name="s", format="off", data=data)
        assert done["warnings"] == ["2 vertices lie on no 2-face and were left out",
                                    "the file states 7 edges, but its 2-faces have 3"]
        polytope = (await client.request("get", what="state"))["polytope"]
        assert [polytope[name] for name in ("vertices", "edges", "faces", "cells")] == [3, 3, 1, 0]


async def test_a_surface_is_restored_from_the_store(tmp_path):
    text, _ = clifford_torus(5, 7)
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as server:
        async with Client(server, stream="none") as client:
            await client.request("load", name="torus", format="off", data=text, center=[0, 0, 0.25, 0])
            picture = png.pixels(await client.request_frame(**SIZE))
            welcome = client.welcome
        server.stop()
    with Server("--store", store) as server:
        async with Client(server, stream="none", session=welcome["session"], token=welcome["token"]) as client:
            assert png.pixels(await client.request_frame(**SIZE)) == picture
            state = await client.request("get", what="state")
            assert state["polytope"]["center"] == [0, 0, 0.25, 0]


async def test_an_exported_surface_loads_as_the_same_surface(server):
    text, _ = clifford_torus(9, 8)
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="off", data=text)
        await client.request("rotate", planes=["xw", "yz"], angles=[0.39, 1.42])
        first = await client.request("get", what="slices")
        done = await client.request("get", what="file", format="off")
        file = client.messages[client.messages.index(done) - 1]
    async with Client(server, stream="none") as client:
        await client.request("load", name="again", format="off", data=file.decode())
        again = await client.request("get", what="slices")
    for one, other in zip(first["slices"], again["slices"], strict=True):
        assert one["of"] == other["of"] and one["edges"] == other["edges"]


def test_the_command_line_renders_and_exports_a_surface(tmp_path):
    file = tmp_path / "torus.off"
    file.write_text(clifford_torus(12, 16)[0], encoding="utf-8")
    done = run_oval4d("render", "-o", tmp_path / "picture.png", "--load", file, "--width", 480, "--height", 270)
    assert done.returncode == 0, done.stderr
    turn = ("--load", file, "--rotate", "xw,yz:0.39,1.42")
    done = run_oval4d("export", *turn, "--format", "stl", "-o", "-")
    assert done.returncode != 0 and b"no cells" in done.stderr and b"body=skeleton" in done.stderr
    done = run_oval4d("export", *turn, "--body", "skeleton", "-o", tmp_path / "curves.stl")
    assert done.returncode == 0, done.stderr
    meshes.assert_closed_mesh(tmp_path / "curves.stl")
    for name in ("slices.csv", "slices.svg", "slices.pdf"):
        done = run_oval4d("export", *turn, "--of", "oval", "-o", tmp_path / name)
        assert done.returncode == 0, done.stderr
    for contents in ("coordinates", "projection", "matrix"):
        done = run_oval4d("export", *turn, "--of", contents, "-o", tmp_path / f"{contents}.svg")
        assert done.returncode == 0, done.stderr
    for shown, polygons in (("--cells=off", 0), ("--cells=on", 192)):
        done = run_oval4d("export", *turn, shown, "--of", "projection", "-o", tmp_path / "faces.svg")
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "faces.svg").read_text().count("<polygon") == polygons
