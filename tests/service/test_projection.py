"""The projection of the whole object: settings, geometry, and frames."""

import math

import png
import pytest
from test_cloud import torus_points
from test_import import get_file, tesseract_file
from test_limits import two_tesseracts
from wire import Client, Refused

SIZE = {"width": 640, "height": 360}


async def projection_of(client):
    return (await client.request("get", what="slices", **SIZE)).get("projection")


async def test_keys_messages_and_commands_agree(server):
    async with Client(server, stream="none") as client:
        async def settings():
            state = await client.request("get", what="state")
            return state["projection"], state["eye"]

        assert await settings() == ("off", 3)
        for expected in ("perspective", "orthogonal", "off"):
            await client.request("key", key="w")
            assert (await settings())[0] == expected
        await client.request("command", line=":project orthogonal")
        await client.request("command", line=":set eye=2.5")
        assert await settings() == ("orthogonal", 2.5)
        await client.request("undo")
        assert await settings() == ("orthogonal", 3)
        await client.request("set", projection="perspective", eye=1.05, shown={"cells": True, "back": False})
        assert await settings() == ("perspective", 1.05)
        for key, part, expected in (("c", "cells", False), ("W", "back", True), ("C", "sections", True)):
            await client.request("key", key=key)
            assert (await client.request("get", what="state"))["shown"][part] is expected


@pytest.mark.parametrize("members, says", [
    ({"projection": "parallel"}, "orthogonal"), ({"projection": 1}, "projection"), ({"eye": 1}, "1.05"),
    ({"eye": 1001}, "1000"), ({"eye": "far"}, "eye"), ({"shown": {"cells": 1}}, "cells"),
])
async def test_bad_settings_are_refused(server, members, says):
    async with Client(server, stream="none") as client:
        with pytest.raises(Refused, match=says):
            await client.request("set", **members)
        assert (await client.request("get", what="state"))["projection"] == "off"
        with pytest.raises(Refused, match="circumradii"):
            await client.request("command", line=":set eye=0.5")


async def test_the_geometry_has_the_whole_object_and_its_sections(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract")
        assert await projection_of(client) is None
        await client.request("rotate", planes=["xw", "yz"], angles=[0.4, 0.3])
        await client.request("set", projection="perspective", eye=2, shown={"cells": True})
        slices = await client.request("get", what="slices", **SIZE)
        projection, radius = slices["projection"], slices["scene"]["circumradius"]
        whole, section = projection["parts"]
        assert (len(whole["vertices"]), len(whole["edges"]), len(whole["faces"])) == (16, 32, 24)
        for vertex, (x, y, z, w) in zip(whole["vertices"], slices["coordinates"]):
            factor = 2 * radius / (2 * radius - w)
            assert vertex == pytest.approx([factor * x, factor * y, factor * z], rel=1e-4, abs=1e-5)
        focus = next(one for one in slices["slices"] if one["focus"])
        assert section["of"] == focus["of"] and section["edges"] == focus["edges"]
        factor = 2 * radius / (2 * radius - focus["w"])
        for inside, outside in zip(section["vertices"], focus["vertices"]):
            assert inside == pytest.approx([factor * c for c in outside], rel=1e-4, abs=1e-5)
        await client.request("set", shown={"sections": True, "back": False})
        parts = (await projection_of(client))["parts"]
        assert len(parts) == 1 + len(slices["slices"])
        assert len(parts[0]["vertices"]) < 16


async def test_the_eye_sees_through_hidden_kinds_of_cells(server):
    """The eye looks at the upper one of the two cubes of a box. Without them, it sees the other cells from inside."""
    lines = tesseract_file().splitlines()
    points = [line.split() for line in lines[2:18]]
    lines[2:18] = [" ".join([*xyz, str(2 * float(w))]) for *xyz, w in points]
    async with Client(server, stream="none") as client:
        await client.request("load", name="box", format="off", data="\n".join(lines) + "\n")
        await client.request("set", projection="perspective", shown={"cells": True, "back": False},
                             orientation=[[int(i == j) for j in range(4)] for i in range(4)])
        kinds = (await client.request("get", what="state"))["polytope"]["kinds"]
        cubes = next(number for number, kind in enumerate(kinds) if kind["cells"] == 2)

        async def seen():
            part = (await projection_of(client))["parts"][0]
            return [len(part[kind]) for kind in ("vertices", "edges", "faces")]

        def pictures():
            return [client.request_frame(**SIZE), get_file(client, format="svg", of="projection")]

        assert await seen() == [8, 12, 6]
        closed = [await one for one in pictures()]
        body = await get_file(client, format="stl", of="projection", body="skeleton")
        await client.request("set", hidden=[cubes])
        assert await seen() == [16, 32, 24]
        assert all([one != await other for one, other in zip(closed, pictures())])
        assert body == await get_file(client, format="stl", of="projection", body="skeleton"), "it has all kinds"
        await client.request("set", hidden=[])
        assert await seen() == [8, 12, 6]


async def test_bars_are_cut_off_where_they_vanish_behind_a_cell(server):
    """The face x = 1 of the nearer cube halves four edges of the farther one, and four others are hidden."""
    async with Client(server, stream="none") as client:
        await client.request("load", name="boxes", format="off", data=two_tesseracts(1))
        await client.request("set", projection="orthogonal", shown={"back": False},
                             orientation=[[int(i == j) for j in range(4)] for i in range(4)])
        for cells in (False, True):
            await client.request("set", shown={"cells": cells})
            part = (await projection_of(client))["parts"][0]
            assert len(part["edges"]) == 12 + 8
            cut = [v for v, source in enumerate(part["of"]["vertices"]) if source < 64]  # from one of the 64 edges
            assert len(cut) == 4 and part["balls"]["scale"] == [1] * len(part["vertices"])
            assert all(part["balls"]["opacity"][v] == 0 for v in cut)
            assert part["balls"]["opacity"].count(1) == 8 + 4
            halves = [edge for edge in part["edges"] if not set(edge).isdisjoint(cut)]
            lengths = [math.dist(*(part["vertices"][v] for v in edge)) for edge in halves]
            assert lengths == pytest.approx([0.5] * 4, rel=1e-3)
            svg = (await get_file(client, format="svg", of="projection")).decode()
            assert (svg.count("<circle"), svg.count("<line")) == (12, 2 * 20), "each bar has a halo"
        skeleton = await get_file(client, format="stl", of="projection", body="skeleton")
        await client.request("set", shown={"back": True})
        assert skeleton != await get_file(client, format="stl", of="projection", body="skeleton")


async def test_frames_and_stored_sessions_have_it(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        plain = png.pixels(await client.request_frame(**SIZE))
        pictures = []
        for line in ("project perspective", "project orthogonal", "set cells=on", "set sections=on", "set back=off"):
            await client.request("command", line=line)
            pictures.append(png.pixels(await client.request_frame(**SIZE)))
        assert len({hash(picture) for picture in [plain, *pictures]}) == 6
        state = png.state_in(await client.request_frame(**SIZE))
        assert (state["projection"], state["shown"]["sections"]) == ("orthogonal", True)
        await client.request("set", projection="off")
        assert png.pixels(await client.request_frame(**SIZE)) == plain


def area(*points):
    """The area that a loop of points encloses; regions count as often as the loop winds around them."""
    sides = [[b - a for a, b in zip(points[0], point)] for point in points[1:]]
    crosses = [(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
               for a, b in zip(sides, sides[1:])]
    return math.hypot(*map(sum, zip(*crosses))) / 2


async def test_pentagrams_are_filled(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="{5/2,5,3}", projection="orthogonal")
        await client.request("rotate", planes=["xw", "yz"], angles=[0.4, 0.3])
        without = png.pixels(await client.request_frame(**SIZE))
        await client.request("set", shown={"cells": True})
        assert png.pixels(await client.request_frame(**SIZE)) != without
        slices = await client.request("get", what="slices", **SIZE)
        whole, section = slices["projection"]["parts"]
        focus = next(one for one in slices["slices"] if one["focus"])
        assert len(whole["faces"]) == 720
        assert section["opacity"] > 0 and section["fill"] == focus["fill"], "an orthogonal projection magnifies nothing"
        points = whole["fill"]["points"]
        filled = sum(area(*(points[i] for i in triangle)) for triangle in whole["fill"]["triangles"])
        enclosed = sum(area(*(whole["vertices"][v] for v in loop)) for loop in whole["faces"])
        # The boundary of a pentagram winds twice around its core, but the core is filled once. Projections keep the
        # ratio of areas.
        golden = (1 + math.sqrt(5)) / 2
        assert filled == pytest.approx(2 / golden**2 * enclosed, rel=1e-4)
        await client.request("set", shown={"back": False})
        seen = (await projection_of(client))["parts"][0]
        assert 0 < len(seen["faces"]) < 720
        assert set(seen["fill"]["tints"]) == set(seen["tints"])


async def test_a_field_shows_the_surface_of_the_focus_slice_in_its_box(server):
    async with Client(server, stream="none") as client:
        await client.request("load", name="ball", format="formula", data="x^2 + y^2 + z^2 + w^2 < 2")
        await client.request("set", projection="perspective", eye=2, slices={"w": 0.5})
        slices = await client.request("get", what="slices", **SIZE)
        projection, radius = slices["projection"], slices["scene"]["circumradius"]
        assert projection["surface_scale"] == pytest.approx(projection["scale"] * 2 * radius / (2 * radius - 0.5))
        shown = png.pixels(await client.request_frame(**SIZE))
        await client.request("set", shown={"faces": False})
        assert "surface_scale" not in await projection_of(client)
        assert png.pixels(await client.request_frame(**SIZE)) != shown


async def test_a_cloud_has_points_only(server):
    text, _ = torus_points(50)
    async with Client(server, stream="none") as client:
        await client.request("load", name="torus", format="cloud", data=text)
        await client.request("set", projection="perspective", slices={"focus": 3, "spacing": 0.3})
        whole, section = (await projection_of(client))["parts"]
        assert len(whole["vertices"]) == 50 and whole["edges"] == [] and whole["faces"] == []
        for source, vertex in zip(section["of"]["vertices"], section["vertices"]):
            assert math.dist(vertex, whole["vertices"][source]) < 1e-6
