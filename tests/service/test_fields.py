"""4-D scalar fields that formulas define: their slices against closed forms, settings, pictures, storage."""

import asyncio
import math
import sys
from pathlib import Path
from urllib.parse import quote, urlencode

import numpy
import png
import pytest
from harness import Server, run_oval4d
from surfaces import (components_and_euler, ellipsoid_slice, field_client, lattice_step, load_field, random_rotation,
                      surface_centroid, surface_volume, tiger_slice)
from test_geometry import volume as domain_volume
from wire import BINARY_ENCODINGS, Client, Refused

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402

SIZE = {"width": 480, "height": 270}
BALL = "x^2 + y^2 + z^2 + w^2 < 1"
BALL_BOX = [[-1.2, 1.2]] * 4
TIGER = "(sqrt(x^2+y^2)-a)^2 + (sqrt(z^2+w^2)-b)^2 - c^2; a=1, b=0.8, c=0.35"
TIGER_BOX = [[-1.4, 1.4], [-1.4, 1.4], [-1.2, 1.2], [-1.2, 1.2]]


async def slices_of(client):
    return await client.request("get", what="slices", **SIZE)


def surfaces_in(message):
    return [piece for piece in message["slices"] if "surface" in piece]


def colors_at(surface):
    """Returns the (red, green, blue) of each point."""
    return [(color >> 16, color >> 8 & 255, color & 255) for color in surface["colors"]]


# --- Loading fields


async def test_a_loaded_formula_shows_its_surfaces(server):
    async with field_client(server, BALL, stream="geometry", **SIZE) as client:
        state = await client.wait_for_state(1)
        w = [piece["w"] for piece in (await client.wait_for_slices(1))["slices"]]
        assert len(w) == 21 and w == pytest.approx([0.19 * n for n in range(-10, 11)]), "within the box along w"
        done = await client.request("set", slices={"spacing": 0.4})
        message = await client.wait_for_slices(done["revision"])
        assert state["polytope"]["name"] == "field" and state["polytope"]["vertices"] == 16
        assert state["levels"] == [0] and state["inside"] == "below"
        assert message["scene"]["circumradius"] == pytest.approx(4)
        (level,) = message["scene"]["surfaces"]
        assert (level["level"], level["opacity"], level["caps"]) == (0, 1, True)
        for piece in message["slices"]:
            assert ("surface" in piece) == (abs(piece["w"]) < 1)
        for piece in surfaces_in(message):
            surface = piece["surface"]
            assert len(surface["points"]) == len(surface["normals"])
            assert len(surface["triangles"]) == len(surface["level"]) == len(surface["cap"])
            for point, normal in zip(surface["points"], surface["normals"]):  # must be on the sphere
                radius = math.sqrt(1 - piece["w"] ** 2)
                assert math.hypot(*point) == pytest.approx(radius, abs=1e-3)
                assert normal == pytest.approx([c / math.hypot(*point) for c in point], abs=5e-3)


async def test_a_frame_stream_shows_the_surfaces(server):
    async with field_client(server, BALL, stream="frames", **SIZE) as client:
        shown = png.pixels(await client.wait_for_frame(1))
        await client.request("set", shown={"faces": False})
        assert png.pixels(await client.wait_for_frame(2)) != shown
        await client.request("undo")
        assert png.pixels(await client.wait_for_frame(3)) == shown


async def test_the_command_line_loads_a_formula(server):
    async with Client(server) as client, field_client(server, TIGER) as other:
        await client.request("command", line="formula " + TIGER)
        assert (await client.request("get", what="state"))["polytope"]["name"] == "formula"
        got, expected = await slices_of(client), await slices_of(other)
        assert got["slices"] == expected["slices"]
        with pytest.raises(Refused, match="such as formula"):
            await client.request("command", line="formula")
        with pytest.raises(Refused, match="position 3") as refused:
            await client.request("command", line="formula x y")
        assert refused.value.code == "bad_expression"


async def test_a_formula_replaces_that_of_the_same_name(server):
    async with field_client(server, BALL, BALL_BOX) as client:
        await client.request("set", levels=[-0.5], inside="above")
        await load_field(client, "w - x", BALL_BOX)
        state = await client.request("get", what="state")
        assert (state["levels"], state["inside"]) == ([0], "below")
        await client.request("command", line="polytope 24-cell")
        state = await client.request("get", what="state")
        assert "levels" not in state and "inside" not in state
        await client.request("set", polytope="field")
        names = [polytope["name"] for polytope in (await client.request("get", what="catalogue"))["polytopes"]]
        assert names.count("field") == 1
        middle = (await slices_of(client))["slices"][10]
        # The body is half of the cube, because the plane x = w passes through the cube's middle.
        assert surface_volume(middle) == pytest.approx(2.4 ** 3 / 2, rel=1e-3)


# --- The geometry of surfaces


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("axes, center", [
    ((1, 1, 1, 1), (0, 0, 0, 0)),
    ((1, 1, 1, 1), (0.3, -0.2, 0.1, 0.25)),
    ((1.2, 0.9, 0.8, 1), (0, 0, 0, 0)),
    ((0.8, 1.3, 1, 0.9), (0.2, 0.1, -0.3, 0)),
])
async def test_slices_of_ellipsoids_have_their_volume_and_centroid(server, axes, center, seed):
    orientation = random_rotation(seed)
    formula = " + ".join(f"(({name})-({c}))^2/{a}^2" for name, c, a in zip("xyzt", center, axes)) + " < 1"
    async with field_client(server, formula, [[-1.75, 1.75]] * 4) as client:
        await client.request("set", orientation=orientation, slices={"count": 15, "spacing": 0.2, "offset": 0.03})
        message = await slices_of(client)
        step, checked = lattice_step(message), 0
        for piece in message["slices"]:
            expected = ellipsoid_slice(axes, center, orientation, piece["w"])
            if expected is None:
                assert "surface" not in piece
                continue
            # Triangles whose corners are on a curved surface cut off a part of the volume. Relative to the volume, this
            # part is proportional to the square of the triangles' size divided by the radius of curvature.
            size = min(axes) * expected.scale
            if size < 3 * step:
                continue
            error = (step / size) ** 2
            assert expected.volume * (1 - error) < surface_volume(piece, caps=False) < expected.volume * (1 + error / 4)
            assert math.dist(surface_centroid(piece["surface"]), expected.centroid) < error * size
            checked += 1
        assert checked >= 6


async def test_the_error_of_a_volume_is_of_second_order(server):
    errors = []
    for half in (4, 2):  # a box of half the size has a lattice with half the step
        async with field_client(server, BALL, [[-half, half]] * 4) as client:
            errors.append(4 / 3 * math.pi - surface_volume((await slices_of(client))["slices"][10]))
    assert 2.5 < errors[0] / errors[1] < 6


@pytest.mark.release_only
@pytest.mark.parametrize("seed", [None, 1, 2, 3])
async def test_slices_of_the_tiger_have_its_volume(server, seed):
    """The integral of the slices' volumes is that of the tiger in any rotation, by Pappus's theorem used twice."""
    async with field_client(server, TIGER, TIGER_BOX) as client:
        await client.request("set", slices={"count": 101, "spacing": 0.035})
        if seed is not None:
            await client.request("set", orientation=random_rotation(seed))
        message = await slices_of(client)
        volumes = [surface_volume(piece, caps=False) for piece in message["slices"]]
        assert volumes[0] == volumes[-1] == 0
        error = (lattice_step(message) / 0.35) ** 2 / 2  # the smallest radius of curvature is 0.35, in one direction
        whole = 4 * math.pi ** 3 * 1 * 0.8 * 0.35 ** 2
        assert whole * (1 - error) < sum(volumes) * 0.035 < whole * 1.005
        if seed is None:
            for piece, got in zip(message["slices"][30:71], volumes[30:71]):
                expected = tiger_slice(1, 0.8, 0.35, piece["w"])
                assert expected * (1 - error) < got < expected * 1.005


async def test_slices_of_the_tiger_have_its_topology(server):
    async with field_client(server, TIGER, TIGER_BOX) as client:
        for plane, w, expected in [("xy", 0, (2, 0)), ("xy", 0.8, (1, 0)), ("xz", 0, (2, 0)), ("xz", 0.9, (1, 0))]:
            await client.request("set", orientation=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
                                 slices={"count": 1, "offset": w})
            await client.request("rotate", planes=[plane], angles=[0.4])
            assert components_and_euler((await slices_of(client))["slices"][0]["surface"]) == expected, (plane, w)


@pytest.mark.parametrize("seed", range(3))
async def test_a_field_that_fills_its_domain_is_capped_by_it(server, seed):
    box = [[-1, 1], [0, 1.5], [-2, 0.5], [1, 2]]
    async with field_client(server, "-1", box) as client:
        await client.request("set", orientation=random_rotation(seed), slices={"count": 11, "spacing": 0.2, "offset": 0.01})
        pieces = surfaces_in(await slices_of(client))
        assert len(pieces) > 5
        for piece in pieces:
            assert set(piece["surface"]["cap"]) == {1}
            assert surface_volume(piece) == pytest.approx(domain_volume(piece), rel=5e-3, abs=1e-3)


@pytest.mark.parametrize("seed", range(3))
async def test_a_field_and_its_complement_fill_the_domain(server, seed):
    async with field_client(server, TIGER, [[-1.2, 1.2]] * 4) as client:
        await client.request("set", orientation=random_rotation(seed), slices={"count": 5, "spacing": 0.3})
        below = await slices_of(client)
        await client.request("set", inside="above")
        above = await slices_of(client)
        for one, other in zip(below["slices"], above["slices"]):
            whole = domain_volume(one)
            # In both bodies, the edges between surfaces and caps are rounded off.
            assert 0.98 * whole < surface_volume(one) + surface_volume(other) < 1.002 * whole
            assert 0 < surface_volume(one) < whole


# Functions with poles, jumps, edges, double roots, or regions without values.
DIFFICULT = ["1/x - y", "sqrt(x) - w", "log(x) + sqrt(y)", "floor(4*x) - 0.5", "step(x*y) - 0.5", "mod(x, 0.5) - 0.2",
             "tan(9*x)", "x*y", "x*y*z*w", "abs(x)", "abs(x) - 1e-9", "min(x, y, z, w)", "exp(1e3*x) - 1", "1e300*x*1e300",
             "x^y", "x^w - y", "atan2(y, x)", "0/0", "x - x", "log(-1 - x^2)", "x < 1/0", "sin(20*x)*sin(20*y)*sin(20*z)"]


@pytest.mark.parametrize("formula", DIFFICULT)
async def test_surfaces_of_difficult_formulas_are_closed(server, formula):
    async with field_client(server, formula, [[-1, 1], [0, 1.5], [-2, 0.5], [1, 2]]) as client:
        await client.request("set", orientation=random_rotation(3), slices={"count": 5}, color="growth")
        for inside in ("below", "above"):
            await client.request("set", inside=inside)
            for piece in surfaces_in(await slices_of(client)):
                assert -1e-6 < surface_volume(piece) < 1.01 * domain_volume(piece)
                points, normals = (numpy.linalg.norm(piece["surface"][n], axis=1) for n in ("points", "normals"))
                assert points.max() <= 1.001 * 2.5 and abs(normals - 1).max() < 1e-3
        assert await client.request_frame(**SIZE)


# --- Encodings of `slices` messages


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
@pytest.mark.parametrize("color", ["cell", "w", "growth"])
async def test_all_encodings_have_the_same_surfaces(server, color, encoding, monkeypatch):
    monkeypatch.setattr(oval4d_client, "numpy", None)
    async with Client(server) as client:
        await load_field(client, TIGER, TIGER_BOX)
        await client.request("set", orientation=random_rotation(1), color=color, levels=[0.1, 0], slices={"count": 5})
        text = await slices_of(client)
        await client.request("hello", encoding=encoding)
        packed = await slices_of(client)
        assert len(text["slices"]) == len(packed["slices"])
        for piece, own in zip(text["slices"], packed["slices"]):
            assert ("surface" in piece) == ("surface" in own)
            if "surface" not in piece:
                continue
            expected, got = piece["surface"], own["surface"]
            assert got.keys() == expected.keys()
            for name in ("points", "normals"):
                assert len(got[name]) == len(expected[name])
                assert all(math.dist(p, q) < 1e-6 for p, q in zip(got[name], expected[name]))
            for name in got.keys() - {"points", "normals"}:
                assert got[name] == expected[name], name
            for level in (0, 1):
                assert surface_volume(own, level) == pytest.approx(surface_volume(piece, level), rel=1e-5)


# --- Settings of fields


async def test_each_level_has_its_own_closed_surface(server):
    levels = [0.44, 0, -0.36, -0.75]  # in the middle slice, spheres of the radii 1.2, 1, 0.8 and 0.5
    async with field_client(server, BALL, [[-1.5, 1.5]] * 4) as client:
        await client.request("set", levels=levels, slices={"count": 5})
        message = await slices_of(client)
        assert (await client.request("get", what="state"))["levels"] == levels
        middle = message["slices"][2]
        for index, level in enumerate(levels):
            radius = math.sqrt(1 + level)
            expected = 4 / 3 * math.pi * radius ** 3
            error = (lattice_step(message) / radius) ** 2
            assert expected * (1 - error) < surface_volume(middle, index) < expected * (1 + error / 4)
        look = message["scene"]["surfaces"]  # the innermost level, which is opaque, is first
        assert [level["level"] for level in look] == [3, 2, 1, 0]
        assert [level["opacity"] == 1 for level in look] == [True, False, False, False]
        assert len({level["color"] for level in look}) == 4
        await client.request("set", inside="above")
        look = (await slices_of(client))["scene"]["surfaces"]
        assert [level["level"] for level in look] == [0, 1, 2, 3]


async def test_undo_and_redo_restore_the_field_and_its_levels(server):
    async with field_client(server, BALL, BALL_BOX) as client:
        seen = []
        await client.request("set", slices={"count": 5})
        for change in ({}, {"levels": [0, -0.5]}, {"inside": "above"}, {"color": "growth"}):
            await client.request("set", **change)
            seen.append((await slices_of(client))["slices"])
        await load_field(client, "x", BALL_BOX)
        for slices in reversed(seen[1:]):
            await client.request("undo")
            assert (await slices_of(client))["slices"] == slices
        await client.request("undo")
        assert (await slices_of(client))["slices"] == seen[0]
        await client.request("redo")
        state = await client.request("get", what="state")
        assert (state["levels"], state["inside"]) == ([0, -0.5], "below")


async def test_the_colors_by_growth_show_where_a_body_grows(server):
    """Amber where it grows with w, blue where it shrinks, and gray where it rests."""
    async with field_client(server, BALL, BALL_BOX) as client:
        await client.request("set", color="growth", slices={"count": 5, "spacing": 0.4})
        before, less, middle, more, after = (set(colors_at(p["surface"])) for p in (await slices_of(client))["slices"])
        for color in before | less:
            assert color[0] > color[2] + 10
        for color in more | after:
            assert color[2] > color[0] + 10
        assert all(max(color) - min(color) < 25 for color in middle)

        # A ball that moves along x by half a unit of length per unit of w. It grows in front and shrinks behind.
        await load_field(client, "(x - w/2)^2 + y^2 + z^2 < 1/4", BALL_BOX)
        await client.request("set", color="growth")
        pieces = surfaces_in(await slices_of(client))
        assert len(pieces) == 5
        for piece in pieces:
            surface = piece["surface"]
            tints = sorted((normal[0], color[0] - color[2]) for normal, color, cap
                           in zip(surface["normals"], colors_at(surface), points_in_caps(surface)) if not cap)
            assert tints[0][1] < -10 and tints[-1][1] > 10
            assert all(tint > 0 for front, tint in tints if front > 0.2)
            assert all(tint < 0 for front, tint in tints if front < -0.2)
        await client.request("set", color="w")
        colors = [piece["surface"]["color"] for piece in surfaces_in(await slices_of(client))]
        assert len(set(colors)) == 5
        assert "colors" not in pieces[0] and "color" not in surface


def points_in_caps(surface):
    """Returns for each point whether a cap contains it."""
    inside = [False] * len(surface["points"])
    for triangle, cap in zip(surface["triangles"], surface["cap"]):
        for point in triangle:
            inside[point] = inside[point] or bool(cap)
    return inside


# --- Stored fields


async def test_a_field_survives_a_restart_with_its_levels_and_constants(tmp_path):
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as server:
        async with field_client(server, TIGER, TIGER_BOX) as client:
            await load_field(client, TIGER.replace("0.35", "0.3"), name="thin")
            await client.request("set", polytope="field", levels=[-0.05, 0.02], inside="above", color="growth",
                                 slices={"count": 5})
            await client.request("key", key="y")
            before = [await client.request("get", what="state"), await slices_of(client)]
            picture = png.pixels(await client.request_frame(**SIZE))
            welcome = client.welcome
    with Server("--store", store) as server:
        async with Client(server, session=welcome["session"], token=welcome["token"]) as client:
            after = [await client.request("get", what="state"), await slices_of(client)]
            for one, other in zip(before, after):
                assert {**one, "id": 0, "object_serial": 0} == {**other, "id": 0, "object_serial": 0}
            assert png.pixels(await client.request_frame(**SIZE)) == picture
            await client.request("undo")
            await client.request("undo")
            state = await client.request("get", what="state")
            assert (state["polytope"]["name"], state["levels"], state["inside"]) == ("thin", [0], "below")
            await client.request("set", polytope="field", orientation=random_rotation(1),
                                 slices={"count": 101, "spacing": 0.035})
            whole = sum(surface_volume(piece) for piece in (await slices_of(client))["slices"]) * 0.035
            assert whole == pytest.approx(4 * math.pi ** 3 * 0.8 * 0.35 ** 2, rel=0.03)


# --- Pictures of fields


QUERIES = [
    {"formula": BALL},
    {"formula": TIGER, "box": TIGER_BOX},
    {"formula": TIGER, "box": TIGER_BOX, "levels": "0.1,0", "color": "growth", "slices": "31", "rotate": "xw,yz:pi/8,0.4"},
    {"formula": "x*y + z*w", "box": [[-1, 1], [0, 2], [-1, 1], [-3, 1]], "inside": "above", "view": "single"},
]


def query_of(values):
    return {name: ",".join(str(end) for side in value for end in side) if name == "box" else value
            for name, value in values.items()}


@pytest.mark.parametrize("values", QUERIES)
async def test_frames_over_http_and_websocket_and_of_the_command_line_are_equal(server, values, tmp_path):
    query = query_of(values)
    answer = await asyncio.to_thread(server.get, f"/api/v1/frame.png?{urlencode({**query, **SIZE}, quote_via=quote)}")
    assert answer.status == 200, answer.body
    expected = png.pixels(answer.body)
    async with field_client(server, values["formula"], values.get("box")) as client:
        if "rotate" in values:
            await client.request("rotate", planes=["xw", "yz"], angles=[math.pi / 8, 0.4])
        for name in query.keys() - {"formula", "box", "rotate"}:
            await client.request("command", line=f"set {name}={query[name]}")
        assert png.pixels(await client.request_frame(**SIZE)) == expected
    picture = tmp_path / "picture.png"
    words = [f"--{name}={value}" for name, value in {**query, **SIZE}.items()]
    done = await asyncio.to_thread(run_oval4d, "render", "-o", picture, *words)
    assert done.returncode == 0, done.stderr
    assert png.pixels(picture.read_bytes()) == expected


async def test_a_histogram_takes_the_place_of_parallel_coordinates(server):
    async with field_client(server, "x", [[-1, 1], [-2, 2], [-1, 1], [-1, 1]]) as client:
        shown = await slices_of(client)
        layout, histogram = shown["scene"]["coordinates"], shown["histogram"]
        assert "coordinates" not in shown
        assert histogram["reach"] == [1, 2, 1, 1]
        assert [round(value, 2) for value in histogram["range"]] == [-1, 1]
        assert [level["value"] for level in histogram["levels"]] == [0]
        panel, rows = layout["columns"] // 4, len(shown["density"])
        # In the panel of x, the function f = x is a diagonal.
        for row, tones in enumerate(shown["density"]):
            seen = [column for column in range(panel) if tones[column] > 0]
            middle = (panel - 1) * (1 - row / (rows - 1))
            assert seen and max(abs(column - middle) for column in seen) < 2
        # A quarter turn in xw moves x to w.
        await client.request("rotate", planes=["xw"], angles=[math.pi / 2])
        turned = await slices_of(client)
        for tones, before in zip(turned["density"], shown["density"], strict=True):
            assert max(abs(a - b) for a, b in zip(tones[3 * panel:], before[:panel], strict=True)) <= 3
        await client.request("set", shown={"coordinates": False})
        hidden = await slices_of(client)
        assert "histogram" not in hidden and "density" not in hidden
