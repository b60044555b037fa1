"""Exports of the highlighted element alone."""

import json
import re

import meshes
import pytest
from exports import ROTATION, TABLE
from harness import run_oval4d
from wire import Client, Refused

PHI = (1 + 5**0.5) / 2


def fetch(server, format_, query, status=200):
    answer = server.get(f"/api/v1/file.{format_}?{query}&of=highlight")
    assert answer.status == status, answer.body[:500]
    return answer.body


def report_on(server, tmp_path, query):
    path = tmp_path / "element.stl"
    path.write_bytes(fetch(server, "stl", query))
    return meshes.assert_closed_mesh(path, parts=1)


# Polytopes have edges of length 2. In files, the sphere around a polytope has a diameter of 60 mm.
@pytest.mark.parametrize("query, volume", [
    ("polytope=tesseract&highlight=cell:3", 30**3),
    ("polytope=120-cell&highlight=cell:77", (15 + 7 * 5**0.5) / 4 * (30 / (PHI**2 * 2**0.5))**3),
    ("polytope=120-cell&highlight=cell:77&size=120", (15 + 7 * 5**0.5) / 4 * (60 / (PHI**2 * 2**0.5))**3),
    ("formula=x*y-z*w&highlight=cell:0", 30**3),  # a cell of the box from -2 to 2
])
@pytest.mark.parametrize("rotation", ["", f"&{ROTATION}"])
def test_a_cell_is_a_solid_of_its_true_size(server, tmp_path, query, volume, rotation):
    assert report_on(server, tmp_path, query + rotation)["volume"] == pytest.approx(volume, rel=1e-3)


def test_a_cell_of_a_star_is_a_closed_body(server, tmp_path):
    report_on(server, tmp_path, f"polytope=small stellated 120-cell&{ROTATION}&highlight=cell:5".replace(" ", "+"))


@pytest.mark.parametrize("element, length", [("cell:3", 30 * 3**0.5), ("face:7", 30 * 2**0.5), ("edge:9", 30), ("vertex:2", 0)])
def test_every_element_has_balls_and_bars(server, tmp_path, element, length):
    query = f"polytope=tesseract&{ROTATION}&highlight={element}&body=skeleton"
    report = report_on(server, tmp_path, query)
    ball = report_on(server, tmp_path, f"polytope=tesseract&{ROTATION}&highlight=vertex:0&body=skeleton")
    diameter = max(high - low for low, high in ball["box"])
    reach = max(high - low for low, high in report["box"])
    assert length / 3**0.5 - 1 < reach - diameter < length + 1
    assert report["volume"] >= 0.99 * ball["volume"]


@pytest.mark.parametrize("element", ["face 7", "edge 9", "vertex 2"])
def test_only_cells_are_solids(server, element):
    query = f"polytope=tesseract&highlight={element.replace(' ', ':')}"
    error = json.loads(fetch(server, "stl", query, 400))
    assert error["code"] == "no_body" and error["message"].startswith(f"{element} has no volume; choose body=skeleton")


def test_the_body_is_named_after_the_element_and_can_have_a_label(server, tmp_path):
    query = f"polytope=tesseract&{ROTATION}&highlight=cell:3"
    ((name, _, _),) = meshes.read_three_mf(fetch(server, "3mf", query))
    assert name == "8-cell, cell 3"
    engraved = report_on(server, tmp_path, query + "&label=engraved")
    assert 0.98 * 30**3 < engraved["volume"] < 30**3 - 1


def test_a_cell_has_its_own_color(server):
    data = fetch(server, "ply", "polytope=tesseract&highlight=cell:3")
    head, _, body = data.partition(b"end_header\n")
    vertices, faces = (int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element"))
    records = body[12 * vertices:]
    colors = {records[16 * i + 13:16 * i + 16] for i in range(faces)}
    assert len(colors) == 1 and colors != {bytes.fromhex("ff4fb8")}, "not that of the highlight"


@pytest.mark.parametrize("format_", [row["name"] for row in TABLE if "highlight" in row["of"]])
async def test_messages_queries_and_the_command_line_export_the_same_element(server, format_):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell", highlight={"element": "cell", "number": 17})
        done = await client.request("get", what="file", format=format_, of="highlight")
        by_websocket = client.messages[client.messages.index(done) - 1]
    by_http = fetch(server, format_, "polytope=24-cell&highlight=cell:17")
    by_command = run_oval4d("export", "-o", "-", "--format", format_, "--polytope", "24-cell", "--highlight", "cell:17",
                            "--of", "highlight").stdout
    if format_ == "3mf":  # 3MF files contain their time of creation
        assert meshes.read_three_mf(by_websocket) == meshes.read_three_mf(by_http) == meshes.read_three_mf(by_command)
    else:
        assert by_websocket == by_http == by_command


async def test_a_point_of_a_cloud_is_a_ball(server, tmp_path):
    async with Client(server, stream="none") as client:
        await client.request("load", name="two", format="cloud", data="1 0 0 0\n0 0 0 1\n")
        await client.request("set", highlight={"element": "vertex", "number": 1})
        done = await client.request("get", what="file", format="stl", of="highlight", body="skeleton")
        path = tmp_path / "ball.stl"
        path.write_bytes(client.messages[client.messages.index(done) - 1])
    meshes.assert_closed_mesh(path, parts=1)


async def test_something_must_be_highlighted(server):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused, match="nothing is highlighted") as refused:
            await client.request("get", what="file", format="stl", of="highlight")
        assert refused.value.code == "no_body"
    error = json.loads(fetch(server, "stl", "polytope=24-cell", 400))
    assert error["code"] == "no_body" and "highlight=cell:17" in error["message"]
    done = run_oval4d("export", "-o", "-", "--format", "stl", "--of", "highlight")
    assert done.returncode == 1 and b"nothing is highlighted" in done.stderr
    error = json.loads(fetch(server, "stl", "polytope=24-cell&highlight=cell:3&fit=2", 400))
    assert error["code"] == "bad_message" and "not of highlight" in error["message"]


def test_the_help_lists_all_contents_of_files():
    text = run_oval4d("export", "--help").stdout.decode()
    listed = re.search(r"--of\s+(\S+)", text)[1].split("|")
    assert set(listed) == {of for row in TABLE for of in row["of"]}
    assert "--body solid|skeleton" in text and "--label none|engraved|separate" in text and "|frame" not in text
