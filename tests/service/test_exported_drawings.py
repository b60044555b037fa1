"""Exported drawings, SVG images and PDF documents: coordinates, the projection, the matrix and slices."""

import collections
import re
import subprocess
from xml.etree import ElementTree

import png
import pytest
from exports import ROTATION, SVG, csv_rows, export_refusal, fetch_file, fetch_file_to
from harness import DEADLINE


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


def contrast_to_white(color):
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
              for c in (int(color[i:i + 2], 16) / 255 for i in (1, 3, 5))]
    return 1.05 / (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05)


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
    for (column, row), opacity in drawn.items():  # the 120-cell is symmetric about its center
        assert abs(drawn.get((column, 64 - row), 0) - opacity) < 0.1


def test_drawings_show_the_coordinates_unless_another_is_asked_for(server):
    query = "polytope=24-cell"
    assert fetch_file(server, "svg", query) == fetch_file(server, "svg", query + "&of=coordinates")


@pytest.mark.parametrize("query", [
    "polytope=24-cell", "polytope=600-cell", "polytope=120-cell", "polytope=24-cell&of=projection",
    "polytope=24-cell&of=matrix", "polytope=5-cell&slices=5&of=oval&view=column", "formula=x^2%2By^2%2Bz^2-w^2"])
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


@pytest.mark.parametrize("polytope, vertices, edges", [
    ("tesseract", 16, 32), ("120-cell", 600, 1200), ("{5/2,5,3}", 120, 1200),
])
def test_a_drawing_of_the_projection_has_all_edges(server, tmp_path, polytope, vertices, edges):
    query = f"polytope={polytope}&{ROTATION}&of=projection&focus=99&faces=off"
    root = svg_of(server, tmp_path, query)
    lines = [line for line in root.iter(SVG + "line") if line.get("stroke-linecap") == "round"]
    assert (len(lines), len(list(root.iter(SVG + "circle")))) == (edges, vertices), "the focus slice is beside the object"
    assert not list(root.iter(SVG + "polygon"))
    root = svg_of(server, tmp_path, f"{query}&back=off")
    assert len([line for line in root.iter(SVG + "line") if line.get("stroke-linecap") == "round"]) < edges
    root = svg_of(server, tmp_path, f"polytope={polytope}&{ROTATION}&of=projection&cells=on&faces=off")
    assert len(list(root.iter(SVG + "polygon"))) == {"tesseract": 24}.get(polytope, 720)


@pytest.mark.parametrize("polytope", ["tesseract", "{5/2,5,3}"])
def test_a_drawing_of_the_projection_has_the_faces_of_the_focus_section(server, tmp_path, polytope):
    query = f"polytope={polytope}&{ROTATION}&of=projection"
    assert len(list(svg_of(server, tmp_path, query).iter(SVG + "polygon"))) >= 4
    assert not list(svg_of(server, tmp_path, f"{query}&faces=off").iter(SVG + "polygon"))


def test_a_drawing_of_the_matrix_has_the_sections(server, tmp_path):
    root = svg_of(server, tmp_path, "polytope=tesseract&of=matrix&point=0.1,0.2,0.3,-0.1")
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    assert set(groups) == {a + b for a in "xyzw" for b in "xyzw" if a != b} | {"names", "numbers"}
    assert [text.text for text in groups["names"].iter(SVG + "text")] == list("xyzw")
    # The tesseract has the circumradius 2. The panels reach a little farther, and have numbers below four columns and
    # beside four rows.
    assert collections.Counter(text.text for text in groups["numbers"].iter(SVG + "text")) == dict.fromkeys(
        ("-2", "-1", "0", "1", "2"), 8)
    for name, group in groups.items():
        if name not in ("names", "numbers"):
            polygon, = group.iter(SVG + "polygon")
            corners = [tuple(map(float, corner.split(","))) for corner in polygon.get("points").split()]
            assert len({x for x, _ in corners}) == len({y for _, y in corners}) == 2, "a square"
            assert len(list(group.iter(SVG + "circle"))) == 4


def test_a_drawing_of_the_matrix_of_a_field_has_the_contours_in_the_colors_of_the_levels(server, tmp_path):
    query, point, levels = "formula=sqrt(x^2%2By^2%2Bz^2%2Bw^2)&of=matrix", [0.1, 0.2, 0.3, -0.1], [1, 1.5]
    shown = f"{query}&levels=1,1.5&point=0.1,0.2,0.3,-0.1&background=dark"
    root = svg_of(server, tmp_path, shown)
    colors = set()
    panels = [group for group in root.iter(SVG + "g") if group.get("id") not in ("names", "numbers")]
    assert len(panels) == 12
    for group in panels:
        frame = [line for line in group.iter(SVG + "line")][:4]
        across, down = [[float(line.get(name)) for line in frame] for name in ("x1", "y1")]
        center = (min(across) + max(across)) / 2, (min(down) + max(down)) / 2
        unit = (max(across) - min(across)) / 2 / (1.08 * 4)  # the box from -2 to 2 has the circumradius 4
        beside = sum(value**2 for axis, value in zip("xyzw", point) if axis not in group.get("id"))
        lines = list(group.iter(SVG + "polyline"))
        assert len(lines) == len(levels) and all(line.get("fill") == "none" for line in lines)
        colors.add(tuple(line.get("stroke") for line in lines))
        for line, level in zip(lines, levels):
            points = [[float(number) for number in pair.split(",")] for pair in line.get("points").split()]
            assert points[0] == points[-1] and len(points) > 30
            for x, y in points:
                radius = ((x - center[0]) ** 2 + (y - center[1]) ** 2) ** 0.5 / unit
                assert radius == pytest.approx((level**2 - beside) ** 0.5, abs=0.01)
    (pair,) = colors
    assert len(set(pair)) == 2 and all(contrast_to_white(color) > 3 for color in pair)
    assert not list(svg_of(server, tmp_path, f"{shown}&faces=off").iter(SVG + "polyline"))
    assert len(fetch_file(server, "pdf", shown)) > len(fetch_file(server, "pdf", f"{shown}&faces=off")) + 1000


@pytest.mark.parametrize("of, slices", [("oval", 7), ("focus", 1)])
def test_a_drawing_of_slices_has_their_elements_and_holds_on_white(server, tmp_path, of, slices):
    query = f"polytope=24-cell&{ROTATION}&slices=7&of={of}&background=dark"  # drawings are for white paper in any case
    root = svg_of(server, tmp_path, query)
    rows = [row for row in csv_rows(server, f"polytope=24-cell&{ROTATION}&slices=7&of={of}") if int(row["vertices"])]
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    assert len([name for name in groups if name.startswith("slice_")]) == slices
    for row in rows:
        group = groups[f"slice_{row['n']}"]
        count = {shape: len(list(group.iter(SVG + shape))) for shape in ("polygon", "line", "circle")}
        assert (count["polygon"], count["circle"]) == (int(row["faces"]), int(row["vertices"]))
        assert count["line"] <= int(row["edges"])  # lines inside balls are not drawn
    labels = [text.text for text in groups["labels"]]
    assert any(label.startswith("w = 0") for label in labels) and (of == "focus" or "-" in "".join(labels))
    assert sorted(text.text for text in groups["axes"].iter(SVG + "text")) == list("xyz")
    for shape in root.iter():
        color = shape.get("fill") or shape.get("stroke")
        least = 4.5 if shape.tag == SVG + "text" else 2.9  # the light brightens some faces
        assert color is None or contrast_to_white(color) >= least, color
    only = svg_of(server, tmp_path, f"{query}&faces=off&balls=off&labels=off")
    assert not list(only.iter(SVG + "polygon")) and not list(only.iter(SVG + "circle"))[3:], "only the tips of the axes"
    assert [len(group) for group in only.iter(SVG + "g") if group.get("id") == "labels"] == [0]
    assert any(line.get("stroke-linecap") == "round" for line in only.iter(SVG + "line")), "bars meet without balls"


def test_a_drawing_of_a_column_is_in_portrait_format(server, tmp_path):
    query = "polytope=24-cell&slices=7&of=oval"
    wide, tall = (size_of_svg(fetch_file(server, "svg", f"{query}&view={view}")) for view in ("strip", "column"))
    assert wide[0] > wide[1] and tall == pytest.approx(wide[::-1])
    heights = {}
    for group in svg_of(server, tmp_path, f"{query}&view=column").iter(SVG + "g"):
        balls = [float(ball.get("cy")) for ball in group.iter(SVG + "circle")]
        if group.get("id").startswith("slice_") and balls:
            heights[int(group.get("id").removeprefix("slice_"))] = sum(balls) / len(balls)
    assert len(heights) > 3
    assert [heights[n] for n in sorted(heights)] == sorted(heights.values(), reverse=True), "w rises upward"


def test_a_drawing_of_a_grid_has_rows(server, tmp_path):
    centers = {}
    for group in svg_of(server, tmp_path, "polytope=24-cell&slices=7&of=oval&view=grid").iter(SVG + "g"):
        balls = [(float(ball.get("cx")), float(ball.get("cy"))) for ball in group.iter(SVG + "circle")]
        if group.get("id").startswith("slice_") and balls:
            centers[int(group.get("id").removeprefix("slice_"))] = [sum(each) / len(balls) for each in zip(*balls)]
    upper, lower = ([centers[n] for n in sorted(centers) if (n > 0) == below] for below in (False, True))
    assert len(upper) > 1 and len(lower) > 1, "slices 1, 2 and 3 are in the second row"
    for row in (upper, lower):
        assert [x for x, _ in row] == sorted(x for x, _ in row), "w rises to the right"
    assert max(y for _, y in upper) < min(y for _, y in lower)


def test_a_drawing_of_the_focus_slice_marks_the_focus_point(server, tmp_path):
    query = "polytope=tesseract&of=focus"
    points = []
    for point in ("0,0,0,0", "0.2,0.1,-0.3,0", "-0.2,0.1,-0.3,0"):
        root = svg_of(server, tmp_path, f"{query}&point={point}")
        marks = [group for group in root.iter(SVG + "g") if group.get("id") == "focus-point"]
        points.append([float(line.get("x1")) + float(line.get("x2")) for line in marks[0]] if marks else None)
    assert points[0] is None and len(points[1]) == 3
    assert all(right > left for right, left in zip(points[1], points[2])), "the first point is farther right"



def test_a_drawing_marks_the_focus_point_where_the_picture_does(server, tmp_path):
    for query, marked in [("of=focus&view=matrix", True), ("of=oval&view=oval&point=0.2,0.1,-0.3,0", False),
                          ("of=oval&view=matrix&point=0.2,0.1,-0.3,0", False)]:
        root = svg_of(server, tmp_path, f"polytope=tesseract&{query}")
        assert any(group.get("id") == "focus-point" for group in root.iter(SVG + "g")) == marked, query


def test_a_drawing_of_the_slices_of_a_star_has_its_faces_and_one_of_a_field_is_refused(server, tmp_path):
    root = svg_of(server, tmp_path, "polytope={5/2,5,3}&of=focus&rotate=xw:0.3")
    assert len(list(root.iter(SVG + "polygon"))) > 100
    error = export_refusal(server, "svg", "formula=x^2%2By^2%3C1&of=oval")
    assert error["code"] == "no_body" and "field" in error["message"]


@pytest.mark.parametrize("query, words", [
    ("polytope=5-cell", ["P0", "P4"]), ("polytope=24-cell", ["P0", *"xyzw"]), ("polytope=24-cell&of=oval", list("xyz")),
    ("polytope=24-cell&of=focus", list("xyz")), ("polytope=120-cell", list("xyzw")), ("polytope=24-cell&of=matrix", list("xyzw")),
    ("polytope=24-cell&of=projection&cells=on&hidden=none", []), ("polytope={5/2,5,3}&of=matrix", list("xyzw")),
    ("polytope={5/2,5,3}&of=projection", []), ("formula=x*y%2Bz*w&levels=0.5,1,-1&of=matrix", list("xyzw")),
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
