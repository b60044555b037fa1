"""Exports of fields whose surfaces are cut exactly, and agree with the measurements in CSV files."""

import csv
import io
import json
from urllib.parse import quote

import meshes
import numpy
import pytest
from array_clients import load
from exports import csv_rows, export_refusal, fetch_file
from harness import run_oval4d
from surfaces import random_rotation
from wire import Client

TIGER = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 < 0.09"
BOX = "-1.6,1.6,-1.6,1.6,-1.3,1.3,-1.3,1.3"
QUERY = f"formula={quote(TIGER)}&box={BOX}&rotate=xw,yz:0.4,0.9"
WORDS = ["--formula", TIGER, f"--box={BOX}", "--rotate", "xw,yz:0.4,0.9"]
RADIUS = float(numpy.hypot(1.6, 1.3) * 2**0.5)  # the radius of the sphere around the box


def read_obj(data):
    lines = [line.split() for line in data.decode().splitlines()]
    points = [[float(number) for number in line[1:]] for line in lines if line[:1] == ["v"]]
    triangles = [[int(number) - 1 for number in line[1:]] for line in lines if line[:1] == ["f"]]
    return points, triangles


def samples(side=9):
    """Returns a NumPy file with waves in four dimensions, which also leave the box."""
    axes = numpy.meshgrid(*[numpy.linspace(-2, 2, side)] * 4, indexing="ij")
    w, z, y, x = axes
    file = io.BytesIO()
    numpy.save(file, (numpy.sin(1.3 * x + w) + numpy.cos(1.7 * y - 0.5 * w) + numpy.sin(1.1 * z * w)).astype("f4"))
    return file.getvalue()


@pytest.mark.parametrize("seed", range(3))
async def test_the_body_of_an_array_has_the_volume_of_the_table(server, seed):
    async with Client(server, stream="none") as client:
        await load(client, "waves", samples(), axes="tzyx", box=[[-1, 1]] * 4)
        await client.request("set", levels=[0.3 * seed - 0.2], orientation=random_rotation(seed))

        async def file(format_, **members):
            done = await client.request("get", what="file", format=format_, **members)
            return client.messages[client.messages.index(done) - 1]

        (row,) = csv.DictReader(io.StringIO((await file("csv")).decode()))
        points, triangles = read_obj(await file("obj", exact=True))
        meshes.assert_manifold(triangles)
        scale = 30 / 2  # the box has a half diagonal of 2
        assert meshes.volume(points, triangles) == pytest.approx(float(row["volume"]) * scale**3, rel=1e-9)
        smooth = read_obj(await file("obj"))
        assert smooth == read_obj(await file("obj", exact=False)) != (points, triangles)
        exact = meshes.read_vtk(await file("vtp", exact=True), "PolyData")
        corners = numpy.reshape(exact["Polys"]["connectivity"], (-1, 3))
        volume = meshes.volume(exact["Points"]["points"], corners)
        assert volume == pytest.approx(float(row["volume"]), rel=1e-9)


async def test_messages_queries_and_the_command_line_make_the_same_file(server):
    body = fetch_file(server, "ply", f"{QUERY}&exact=on")
    assert b"property double x" in body[:300]
    assert body != fetch_file(server, "ply", f"{QUERY}&exact=off") == fetch_file(server, "ply", QUERY)
    done = run_oval4d("export", "-o", "-", "--format", "ply", *WORDS, "--exact", "on")
    assert done.returncode == 0 and done.stdout == body


def test_a_formula_is_sampled_as_for_the_table(server):
    (row,) = csv_rows(server, QUERY)
    points, triangles = read_obj(fetch_file(server, "obj", f"{QUERY}&exact=on&size=100"))
    meshes.assert_manifold(triangles)
    expected = float(row["volume"]) * (50 / RADIUS)**3
    assert meshes.volume(points, triangles) == pytest.approx(expected, rel=1e-9)


def test_a_printable_file_of_exact_surfaces_is_closed(server, tmp_path):
    path = tmp_path / "tiger.stl"
    path.write_bytes(fetch_file(server, "stl", f"{QUERY}&exact=on"))
    meshes.assert_closed_mesh(path)


def test_polytopes_are_exact_anyway(server):
    assert fetch_file(server, "obj", "polytope=24-cell&exact=on") == fetch_file(server, "obj", "polytope=24-cell")


def test_other_values_are_refused(server):
    error = export_refusal(server, "stl", f"{QUERY}&exact=perhaps")
    assert error["code"] == "bad_message" and "exact must be on or off, not 'perhaps'" in error["message"]
    error = json.loads(fetch_file(server, "stl", f"{QUERY}&exact=on&at=99", 400))
    assert error["code"] == "out_of_range"
