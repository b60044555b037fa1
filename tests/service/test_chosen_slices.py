"""Exports of slices that the request chooses: at given w, or spread evenly."""

import csv
import io
import json
import re

import meshes
import numpy
import pytest
from exports import ROTATION
from harness import run_oval4d
from wire import Client, Refused


def fetch(server, format_, query, status=200):
    answer = server.get(f"/api/v1/file.{format_}?{query}")
    assert answer.status == status, answer.body[:500]
    return answer


def rows_of(data):
    return [{name: float(value) if value else None for name, value in row.items()}
            for row in csv.DictReader(io.StringIO(data.decode()))]


def csv_rows(server, query):
    return rows_of(fetch(server, "csv", query).body)


def volume_of(slice_):
    """Returns the volume of a convex slice of a `slices` message."""
    points = numpy.array(slice_["vertices"])
    triangles = [(face[0], *pair) for face in slice_["faces"] for pair in zip(face[1:], face[2:])]
    return meshes.volume(points, triangles)


def test_as_many_bodies_as_asked_for_fit_into_the_120_cell(server, tmp_path):
    answer = fetch(server, "stl", "polytope=120-cell&fit=5")
    assert answer.getheader("Export-Warnings") is None
    path = tmp_path / "five.stl"
    path.write_bytes(answer.body)
    meshes.assert_closed_mesh(path, parts=5)


@pytest.mark.parametrize("query", ["polytope=120-cell", f"polytope=5-cell&{ROTATION}"])
@pytest.mark.parametrize("count", [1, 4, 5])
def test_fitted_slices_are_in_the_middles_of_equal_parts(server, query, count):
    levels = [row["w"] for row in csv_rows(server, f"{query}&of=critical")]
    part = (levels[-1] - levels[0]) / count
    rows = csv_rows(server, f"{query}&fit={count}")
    assert [row["w"] for row in rows] == pytest.approx([levels[0] + (i + 0.5) * part for i in range(count)], abs=1e-9)
    assert [row["n"] for row in rows] == [i - (count - 1) // 2 for i in range(count)]
    assert all(row["volume"] > 0 for row in rows)


def test_sections_of_a_tesseract_are_cubes_wherever_they_are(server):
    rows = csv_rows(server, "polytope=tesseract&at=-1/2,sqrt(2)/2,0,0.3")
    assert [row["w"] for row in rows] == pytest.approx([-0.5, 2**0.5 / 2, 0, 0.3])
    assert [row["n"] for row in rows] == [0, 1, 2, 3]
    assert [row["volume"] for row in rows] == pytest.approx([8] * 4)
    bodies = meshes.read_three_mf(fetch(server, "3mf", "polytope=tesseract&at=-1/2,sqrt(2)/2,0,0.3&size=40").body)
    assert [name for name, _, _ in bodies] == [f"8-cell, w = {w}" for w in ("\u22120.50", "0.71", "0", "0.30")]
    for _, points, triangles in bodies:  # the sphere around the tesseract has the diameter 4
        assert meshes.volume(points, triangles) == pytest.approx(8 * 10**3, rel=1e-3)


async def test_chosen_slices_are_those_of_the_picture(server):
    chosen = [0.3, -0.7]
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        await client.request("rotate", planes=["xw", "yz"], angles=[0.39, 1.42])
        shown = []
        for w in chosen:
            await client.request("set", slices={"w": w})
            picture = await client.request("get", what="slices")
            shown += [volume_of(slice_) for slice_ in picture["slices"] if slice_["focus"]]
        done = await client.request("get", what="file", format="csv", at=chosen)
        rows = rows_of(client.messages[client.messages.index(done) - 1])
        assert (await client.request("get", what="state"))["slices"]["count"] == 21, "the session stays as it is"
    assert [row["volume"] for row in rows] == pytest.approx(shown)


@pytest.mark.parametrize("members, query, words", [
    ({"at": [-1, 0, 0.5]}, "at=-1,0,1/2", ["--at", "-1,0,1/2"]), ({"at": "-1, 0, 1/2"}, "at=-1,0,0.5", ["--at=-1,0,0.5"]),
    ({"fit": 3}, "fit=3", ["--fit", "3"]),
])
async def test_messages_queries_and_the_command_line_choose_the_same_slices(server, members, query, words):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="16-cell")
        done = await client.request("get", what="file", format="obj", of="oval", **members)
        by_websocket = client.messages[client.messages.index(done) - 1]
    assert by_websocket == fetch(server, "obj", f"polytope=16-cell&{query}").body
    done = run_oval4d("export", "-o", "-", "--format", "obj", "--polytope", "16-cell", *words)
    assert done.returncode == 0 and done.stdout == by_websocket and not done.stderr


async def test_what_is_left_out_is_said(server):
    expected = ["1 of 3 slices is empty and left out: w = −2", "1 of 3 slices is flat or too thin and left out: w = 1.41421"]
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="16-cell")
        done = await client.request("get", what="file", format="stl", at="0,-2,sqrt(2)")
        assert done["warnings"] == expected
        done = await client.request("get", what="file", format="csv", at=[0, -2])
        assert "warnings" not in done, "there is a row for each slice"
    answer = fetch(server, "stl", "polytope=16-cell&at=0,-2,sqrt(2)")
    assert answer.getheader("Export-Warnings") == "; ".join(expected).replace("−", "-"), "header fields are ASCII"
    done = run_oval4d("export", "-o", "-", "--format", "stl", "--polytope", "16-cell", "--at=0,-2,sqrt(2)")
    assert done.returncode == 0 and done.stdout == answer.body
    assert done.stderr.decode().splitlines() == [f"oval4d: {line}" for line in expected]


def test_slices_of_an_oval_that_are_left_out_are_named(server):
    """The first and the last slice of the 24-cell are single vertices."""
    warnings = fetch(server, "stl", "polytope=24-cell&of=oval&slices=5").getheader("Export-Warnings")
    left_out = sum(int(count) for count in re.findall(r"(\d+) of 5 slices", warnings))
    rows = csv_rows(server, "polytope=24-cell&of=oval&slices=5")
    assert left_out == sum(row["volume"] < 1e-6 for row in rows) > 0


def test_a_field_has_the_fitted_slices_of_its_box(server):
    query = "formula=x%5E2%2By%5E2%2Bz%5E2%2Bw%5E2%3C1&fit=4"  # a ball of radius 1 in a box from -2 to 2
    answer = fetch(server, "3mf", query)
    bodies = meshes.read_three_mf(answer.body)
    assert answer.getheader("Export-Warnings") == "2 of 4 slices are empty and left out: w = -1.5, 1.5"
    scale = 30 / 4  # the box has a half diagonal of 4
    for _, points, triangles in bodies:
        assert meshes.volume(points, triangles) == pytest.approx(4 / 3 * numpy.pi * (0.75**0.5 * scale)**3, rel=0.01)
    assert len(bodies) == 2


async def test_the_nearest_points_of_a_cloud_belong_to_a_chosen_slice(server):
    async with Client(server, stream="none") as client:
        data = "".join(f"{x} {y} {z} {w}\n" for x, y, z, w in [(0, 0, 0, 0), (1, 0, 0, 0.04), (0, 1, 0, 0.5), (0, 0, 1, -1)])
        await client.request("load", name="four", format="cloud", data=data)
        await client.request("set", slices={"spacing": 0.1})
        done = await client.request("get", what="file", format="csv", at=[0, 0.5, 0.2])
        rows = rows_of(client.messages[client.messages.index(done) - 1])
    assert [row["vertices"] for row in rows] == [2, 1, 0]


@pytest.mark.parametrize("query, code, words", [
    ("at=0&fit=2", "bad_message", "either at or fit"), ("fit=2&of=focus", "bad_message", "not of focus"),
    ("at=0&of=critical", "bad_message", "not of critical"), ("at=99", "out_of_range", "not 99"),
    ("at=0,1,0", "out_of_range", "0 is given twice"), ("at=one", "bad_expression", "at: 'one'"),
    ("at=", "bad_expression", "a number is expected"), ("at=0,", "bad_expression", "a number is expected"),
    ("fit=0", "out_of_range", "whole number of slices from 1 to 201, not 0"), ("fit=1.5", "out_of_range", "whole number of slices"),
    ("fit=202", "out_of_range", "from 1 to 201, not 202"), ("fit=-3", "out_of_range", "from 1 to 201, not −3"), ("fit=many", "bad_expression", "fit: 'many'"),
    ("at=" + ",".join(f"{i}/1000" for i in range(202)), "out_of_range", "at most 201, not 202"),
    ("at=2.5,3", "no_body", "choose other slices"),
])
def test_impossible_choices_are_explained(server, query, code, words):
    error = json.loads(fetch(server, "csv" if "critical" in query else "stl", f"polytope=24-cell&{query}", 400).body)
    assert error["code"] == code and words in error["message"], error
    done = run_oval4d("export", "-o", "-", "--format", "stl", "--polytope", "24-cell",
                      *("--" + part for part in query.split("&")))
    assert done.returncode == 1 and words.encode() in done.stderr and not done.stdout


def test_drawings_of_the_oval_have_the_chosen_slices(server):
    def labels(query):
        return re.findall(rb"<text[^>]*>(?:w = )?(-?[0-9.]+)(?:, [a-z ]+)?</text>", fetch(server, "svg", "polytope=24-cell&" + query).body)

    assert len(labels("fit=3")) == 3
    assert sorted(float(label) for label in labels("at=-1,0,0.5")) == [-1, 0, 0.5]
    assert json.loads(fetch(server, "svg", "polytope=24-cell&fit=3&of=coordinates", 400).body)["code"] == "bad_message"


@pytest.mark.parametrize("members, code", [
    ({"at": []}, "bad_message"), ({"at": ["1/2"]}, "bad_message"), ({"at": 1}, "bad_message"), ({"at": "1/"}, "bad_expression"),
    ({"at": [1e14]}, "out_of_range"), ({"fit": "5"}, "bad_message"), ({"fit": 0}, "out_of_range"),
    ({"fit": 2.5}, "bad_message"), ({"at": [0], "fit": 1}, "bad_message"),
])
async def test_wrong_members_are_refused(server, members, code):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused) as refused:
            await client.request("get", what="file", format="stl", **members)
        assert refused.value.code == code


async def test_slices_that_fit_a_cloud_contain_all_of_its_points(server):
    points = [[0.1 * i, 0.2, 0, 0.7 * (i - 3)] for i in range(10)]
    async with Client(server, stream="none") as client:
        await client.request("load", name="row", format="cloud", data="\n".join(" ".join(map(str, p)) for p in points))
        for angle in (0, 0.4):
            await client.request("rotate", planes=["yw"], angles=[angle])
            for count in (1, 3, 10):
                done = await client.request("get", what="file", format="csv", of="oval", fit=count)
                rows = rows_of(client.messages[client.messages.index(done) - 1])
                assert len(rows) == count and sum(row["vertices"] for row in rows) == len(points)


def test_labels_of_chosen_slices_differ(server):
    drawing = fetch(server, "svg", "polytope=24-cell&at=0.001,0.002,-1&labels=on").body.decode()
    labels = re.findall(r">(?:w = )?(-?\d+\.\d+)</text>", drawing)
    assert sorted(labels) == sorted(["0.0010", "0.0020", "-1.0000"])


async def test_the_numbers_at_a_matrix_are_those_of_the_file(server):
    def numbers(drawing):
        """Returns the numbers at the axes, to which the one below the name of the axis is added."""
        texts = re.findall(r">([^<]+)</text>", drawing[drawing.index('id="names"'):])
        first = next(i for i, text in enumerate(texts) if re.fullmatch(r"-?[\d.]+", text))
        names, values = " ".join(texts[:first]), texts[first:]
        assert all(len(text) <= 5 for text in values), "there is room for short numbers"
        offsets = [float(offset or 0) for offset in re.findall(r"[xyzw](?: ([-+][\d.]+))?", names)]
        each = len(values) // 4
        return [float(text) + offsets[i // each] for i, text in enumerate(values)]

    near = [[sign * (i == axis) for i in range(4)] for axis in range(4) for sign in (1, -1)]
    async with Client(server, stream="none") as client:
        async def drawn(center):
            data = "\n".join(" ".join(str(p + c) for p, c in zip(point, center)) for point in near)
            await client.request("load", name="cross", format="points", data=data, center="object")
            done = await client.request("get", what="file", format="svg", of="matrix")
            return numbers(client.messages[client.messages.index(done) - 1].decode())

        for center in ([0, 0, 0, 0], [40, 0, -3, 1e6], [1e9, 0, 0, 0]):
            expected = 2 * [c + value for c in center for value in (-1, -0.5, 0, 0.5, 1)]  # rows and columns
            assert sorted(await drawn(center)) == sorted(expected)
