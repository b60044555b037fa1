"""Second functions of fields, whose values color surfaces and caps."""

import math
import sys
from pathlib import Path
from urllib.parse import quote, urlencode

import meshes
import png
import pytest
from harness import DEADLINE, Server
from surfaces import dot, field_client, load_field, random_rotation
from test_field_files import BALL, BALL_BOX, TURN, fetch, rows_of
from wire import Client, Refused

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
from oval4d_client import connect  # noqa: E402

numpy = pytest.importorskip("numpy")
SIZE = {"width": 480, "height": 270}


def rgb(color):
    return color >> 16, color >> 8 & 255, color & 255


def scale_color(values, value):
    """Returns the color of a value, interpolated between the nine of the state."""
    least, greatest = values["range"]
    at = min(max((value - least) / (greatest - least), 0), 1) * (len(values["colors"]) - 1)
    i = min(int(at), len(values["colors"]) - 2)
    return [a + (b - a) * (at - i) for a, b in zip(rgb(values["colors"][i]), rgb(values["colors"][i + 1]))]


def own_point(state, piece, point):
    """Returns the point of the field that a point of a slice shows."""
    shown = [*point, piece["w"]]
    return [dot(column, shown) for column in zip(*state["orientation"])]


def assert_colors_follow(state, slices, f, name="colors", of_caps=False):
    """Asserts that the colors of the points are those of the values of f at the field's own points."""
    seen, tolerance = 0, 32  # of 255; the scale is not linear between its nine colors
    for piece in slices:
        if "surface" not in piece:
            continue
        surface = piece["surface"]
        if of_caps:
            chosen = {p for t, cap in zip(surface["triangles"], surface["cap"]) if cap for p in t}
        else:
            chosen = range(len(surface["points"]))
        for i in chosen:
            expected = scale_color(state["field"]["values"], f(*own_point(state, piece, surface["points"][i])))
            assert max(abs(a - b) for a, b in zip(rgb(surface[name][i]), expected)) < tolerance
            seen += 1
    assert seen > 100


@pytest.mark.parametrize("seed", [None, 1, 2])
async def test_a_ball_is_colored_by_another_formula(server, seed):
    async with Client(server) as client:
        await client.request("load", name="ball", format="formula", data="x^2+y^2+z^2+w^2 < a^2; a=1",
                             values="a*x + a^2*y*y", box=[[-1.2, 1.2]] * 4)
        if seed:
            await client.request("set", orientation=random_rotation(seed))
        state = await client.request("get", what="state")
        assert state["color"] == "value" and state["caps"] == "plain"
        values = state["field"]["values"]
        assert values["formula"] == "a*x + a^2*y*y"
        assert values["range"][1] == pytest.approx(1.2 + 1.44) and values["range"][0] == -values["range"][1]
        slices = (await client.request("get", what="slices", **SIZE))["slices"]
        assert_colors_follow(state, slices, lambda x, y, z, w: x + y * y)
        again = await client.request("get", what="state")
        assert again["field"]["values"]["range"] == values["range"], "rotations do not change the scale"


async def test_without_a_second_function_the_values_are_those_of_the_field(server):
    async with field_client(server, "x^2 + y^2 + z^2 + w^2", [[-1, 1]] * 4) as client:
        state = await client.request("get", what="state")
        assert "values" not in state["field"]
        await client.request("set", color="value", levels=[0.2, 0.8])
        state = await client.request("get", what="state")
        values = state["field"]["values"]
        assert values["range"][0] == 0 and values["range"][1] > 2 and "formula" not in values
        for piece in (await client.request("get", what="slices", **SIZE))["slices"]:
            if "surface" not in piece:
                continue
            surface = piece["surface"]
            for triangle, level, cap in zip(surface["triangles"], surface["level"], surface["cap"]):
                if not cap:
                    expected = scale_color(values, [0.2, 0.8][level])
                    assert max(abs(a - b) for a, b in zip(rgb(surface["colors"][triangle[0]]), expected)) < 30
        # A polytope has a single color with this coloring.
        await client.request("set", polytope="8-cell")
        colors = (await client.request("get", what="slices", **SIZE))["scene"]["colors"]["cells"]
        assert len(set(colors)) == 1


async def test_caps_are_colored_by_value_or_left_open(server):
    async with Client(server) as client:
        await load_field(client, "x^2 + y^2 - z^2 < w", [[-1, 1]] * 4, values="z + w")
        await client.request("set", color="cell", caps="value", orientation=random_rotation(3))
        state = await client.request("get", what="state")
        message = await client.request("get", what="slices", **SIZE)
        assert_colors_follow(state, message["slices"], lambda x, y, z, w: z + w, "cap_colors", of_caps=True)
        assert all("colors" not in piece.get("surface", {}) for piece in message["slices"])
        assert message["scene"]["surfaces"][0]["caps"]
        await client.request("set", caps="plain")
        await client.request("set", caps="open")
        message = await client.request("get", what="slices", **SIZE)
        assert not message["scene"]["surfaces"][0]["caps"]
        await client.request("undo")
        assert (await client.request("get", what="state"))["caps"] == "plain"


async def test_errors_say_which_formula_is_wrong(server):
    async with Client(server) as client:
        async def refused(code, text, **members):
            with pytest.raises(Refused, match=text) as refusal:
                await client.request("load", **{"name": "field", "format": "formula", "data": "x - a; a=1", **members})
            assert refusal.value.code == code

        await refused("bad_expression", r"^bad_expression: values: 'x\*', position 3: ", values="x*")
        await refused("bad_expression", r"values: 'b', position 1: nothing is called 'b'", values="b")
        await refused("bad_expression", r"values: 'x; a=2', position 4: 'a' has a value already", values="x; a=2")
        await refused("bad_message", "values", values="")
        await refused("bad_message", "only arrays take a variable of values", values_variable="p")
        await refused("bad_message", "only formulas and arrays", format="points", data="1 2 3 4", values="x")
        assert (await client.request("get", what="state"))["revision"] == 0


def test_files_have_the_second_values(server):
    query = {"of": "oval", "slices": 5, "spacing": 0.3, "rotate": TURN, "values": "x + 2*w + 1"}
    data = meshes.read_vtk(fetch(server, "vtp", BALL, BALL_BOX, **{**query, "of": "focus"}), "PolyData")
    points, values = data["Points"]["points"], data["PointData"]["second_value"]
    assert len(values) == len(points) > 100
    # With R = R_yz(0.4) R_xw(0.7) and the slice at w = 0: x = cos(0.7) x', w = -sin(0.7) x'.
    for (x, y, z), value in zip(points, values):
        assert value == pytest.approx(1 + math.cos(0.7) * x - 2 * math.sin(0.7) * x, abs=1e-4)
    rows = rows_of(fetch(server, "csv", BALL, BALL_BOX, **query))
    assert list(rows[0])[-1] == "mean_second_value"
    for row in rows:
        # The mean over a sphere is the value at its center, (0, 0, 0, w').
        expected = 1 + row["w"] * (math.sin(0.7) + 2 * math.cos(0.7))
        assert row["mean_second_value"] == pytest.approx(expected, abs=0.01)
    assert "second" not in list(rows_of(fetch(server, "csv", BALL, BALL_BOX))[0])[-1]
    plain = meshes.read_vtk(fetch(server, "vtp", BALL, BALL_BOX), "PolyData")
    assert "second_value" not in plain["PointData"]
    for format_ in ("ply", "glb"):
        colored = fetch(server, format_, BALL, BALL_BOX, **query)
        assert colored != fetch(server, format_, BALL, BALL_BOX, **{**query, "color": "cell"})


def test_addresses_have_a_second_formula(server):
    def frame(status=200, **query):
        answer = server.get(f"/api/v1/frame.png?{urlencode({**SIZE, **query}, quote_via=quote)}")
        assert answer.status == status, answer.body
        return answer.body

    colored = frame(formula=BALL, box=BALL_BOX, values="x")
    assert b'"color":"value"' in colored
    assert png.pixels(colored) != png.pixels(frame(formula=BALL, box=BALL_BOX))
    pictures = [png.pixels(frame(formula="x^2+y^2 < z^2+w", values="x", caps=caps)) for caps in ("plain", "value", "open")]
    assert pictures[0] != pictures[1] != pictures[2] != pictures[0]
    assert b'"color":"growth"' in frame(formula=BALL, values="x", color="growth")
    assert b"values needs a formula" in frame(400, values="x")
    assert b"values: 'y*', position 3" in frame(400, formula=BALL, values="y*")


def ball_and_x(shape=(3, 9, 10, 11)):
    """Returns two arrays with the axes t, z, y, x, and the coordinates of the samples from 0 on."""
    t, z, y, x = numpy.meshgrid(*(numpy.arange(n, dtype="f4") for n in shape), indexing="ij")
    return (x - 5) ** 2 + (y - 4.5) ** 2 + (z - 4) ** 2 + t, x - 2 * y + z * t


def test_an_array_is_colored_by_another_one(server):
    field, values = ball_and_x()
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        oval.field("run", field, spacing=1, levels=[9.5], inside="below", values=values)
        state = oval.state()
        assert state["color"] == "value" and state["field"]["shape"] == [11, 10, 9, 3]
        assert state["field"]["values"]["variable"] == "values"
        oval.set(slices={"count": 3, "spacing": 4.5})
        state = oval.state()
        low = [side[0] for side in state["field"]["box"]]
        assert low == [0, 0, 0, 0]

        def expected(x, y, z, w):  # slices are at whole moments, and the function is linear in each cell
            x, y, z, t = x + 5, y + 4.5, z + 4, (w + 5) / 5
            return x - 2 * y + z * t

        slices = oval.slices(**SIZE)["slices"]
        assert [piece["w"] for piece in slices] == [-4.5, 0, 4.5]
        assert_colors_follow(state, [slices[1]], expected)

        # A moment of this field needs values of its own.
        with pytest.raises(Exception, match="values_variable"):
            oval.append("run", field[0])
        oval.append("run", field[0], values=values[0])
        assert oval.state()["field"]["shape"][3] == 4 and oval.state()["field"]["values"]["variable"] == "values"
        with pytest.raises(Exception, match="moments have no formula of values"):
            oval.append("run", field[0], values="x")

        # A formula stays the same when moments are added.
        oval.field("other", field, values="x*t")
        assert oval.state()["field"]["values"]["formula"] == "x*w"
        oval.append("other", field[0])
        assert oval.state()["field"]["values"]["formula"] == "x*w" and oval.state()["field"]["shape"][3] == 4
        with pytest.raises(ValueError, match="the same shape"):
            oval.field("run", field, values=values[0])


def test_uploads_and_the_data_folder_take_second_functions(tmp_path):
    from oval4d_client import _netcdf_file
    field, values = (array.astype("f4") for array in ball_and_x((4, 20, 20, 20)))
    body = _netcdf_file({"vorticity": field, "pressure": values, "plane": values[:]})
    (tmp_path / "run.nc").write_bytes(body)
    with Server("--data", tmp_path) as server, connect(server.url, timeout=DEADLINE) as oval:
        oval.hello()
        oval.upload("up", body, variable="vorticity", axes="tzyx", values_variable="pressure")
        uploaded = oval.state()
        assert uploaded["field"]["values"]["variable"] == "pressure" and uploaded["color"] == "value"
        oval.request("load", name="down", path="run.nc", variable="vorticity", axes="tzyx", values_variable="pressure")
        assert oval.state()["field"] == uploaded["field"]
        oval.request("load", name="down", path="run.nc", variable="vorticity", axes="tzyx", values="x + y")
        assert oval.state()["field"]["values"]["formula"] == "x + y", "another field than the cached one"
        oval.upload("up", body, variable="vorticity", axes="tzyx", values="x - y")
        assert oval.state()["field"]["values"]["formula"] == "x - y"
        for code, text, members in (
                ("not_found", "values: .*'speed'", {"values_variable": "speed"}),
                ("bad_message", "not both", {"values_variable": "pressure", "values": "x"}),
                ("bad_expression", "values: 'x\\*'", {"values": "x*"})):
            with pytest.raises(Exception, match=text) as refused:
                oval.upload("up", body, variable="vorticity", axes="tzyx", **members)
            assert refused.value.code == code
            with pytest.raises(Exception, match=text) as refused:
                oval.request("load", name="down", path="run.nc", variable="vorticity", axes="tzyx", **members)
            assert refused.value.code == code


async def test_sessions_keep_second_functions(tmp_path):
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as server:
        async with Client(server) as client:
            await load_field(client, "x^2 < a; a=0.5", values="a*y")
            await client.request("set", caps="value")
            credentials = client.welcome["session"], client.welcome["token"]
            before = await client.request("get", what="slices", **SIZE)
    with Server("--store", store) as server:
        async with Client(server, credentials[0], token=credentials[1]) as client:
            state = await client.request("get", what="state")
            assert state["field"]["values"]["formula"] == "a*y" and state["caps"] == "value"
            assert (await client.request("get", what="slices", **SIZE))["slices"] == before["slices"]
