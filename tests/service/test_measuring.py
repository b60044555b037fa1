"""The centers and sizes of elements."""

import math

import pytest
from surfaces import field_client, random_rotation
from wire import Client, Refused

SIZES = {"edge": "length", "face": "area", "cell": "volume"}


def without_numbering(measured):
    return {name: value for name, value in measured.items() if name not in ("id", "revision")}


@pytest.mark.parametrize("polytope, sizes, distances", [
    ("tesseract", (2, 4, 8), (math.sqrt(3), math.sqrt(2), 1)),
    ("24-cell", (2, math.sqrt(3), 8 * math.sqrt(2) / 3), (math.sqrt(3), math.sqrt(8 / 3), math.sqrt(2))),
])
async def test_regular_polytopes_have_regular_elements(server, polytope, sizes, distances):
    async with Client(server, stream="none") as client:
        done = await client.request("set", polytope=polytope)
        for (element, member), size, distance in zip(SIZES.items(), sizes, distances):
            measured = await client.request("measure", element=element, number=7)
            more = {"cell": {"kind"}, "face": {"name"}}.get(element, set())
            assert set(measured) == {"type", "id", "revision", member, "center"} | more
            assert measured["revision"] == done["revision"]
            assert measured[member] == pytest.approx(size)
            assert math.hypot(*measured["center"]) == pytest.approx(distance)
        assert (await client.request("get", what="state"))["revision"] == done["revision"], "nothing changes"


async def test_a_cell_has_its_kind(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="truncated tesseract")
        kinds = (await client.request("get", what="state"))["polytope"]["kinds"]
        assert [(kind["name"], kind["cells"]) for kind in kinds] == [("truncated cube", 8), ("tetrahedron", 16)]
        cells = [await client.request("measure", element="cell", number=number) for number in range(24)]
        cube, tetrahedron = ([cell["volume"] for cell in cells if cell["kind"] == kind] for kind in range(2))
        assert cube == pytest.approx(8 * [2**3 * (21 + 14 * math.sqrt(2)) / 3])
        assert tetrahedron == pytest.approx(16 * [math.sqrt(8) / 3])


@pytest.mark.parametrize("polytope, names", [
    ("tesseract", {"square"}), ("600-cell", {"triangle"}), ("120-cell", {"pentagon"}), ("5,7-duoprism", {"pentagon", "heptagon", "square"}),
    ("small stellated 120-cell", {"pentagram"}), ("great 120-cell", {"pentagon"}), ("3,17-duoprism", {"triangle", "17-gon", "square"}),
])
async def test_a_face_has_the_name_of_its_polygon(server, polytope, names):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope=polytope)
        count = (await client.request("get", what="state"))["polytope"]["faces"]
        chosen = range(count) if count < 100 else range(0, count, count // 20)
        found = {(await client.request("measure", element="face", number=number))["name"] for number in chosen}
        assert found == names


async def test_the_faces_of_a_box_are_rectangles(server):
    async with field_client(server, "x", [[0, 1], [0, 1], [0, 3], [0, 3]]) as client:
        named = [await client.request("measure", element="face", number=number) for number in range(24)]
        assert {(face["name"], round(face["area"])) for face in named} == {("square", 1), ("square", 9), ("rectangle", 3)}


async def test_neither_a_rotation_nor_a_frame_of_reference_changes_them(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        for element in ("vertex", *SIZES):
            before = await client.request("measure", element=element, number=7)
            await client.request("set", orientation=random_rotation(3), pace=2, boost=[0.5, 0, 0])
            after = await client.request("measure", element=element, number=7)
            assert after["revision"] > before["revision"] and without_numbering(after) == without_numbering(before)
            await client.request("undo")


@pytest.mark.parametrize("polytope", ["tesseract", "small stellated 120-cell"])
async def test_they_tell_what_a_picture_highlights(server, polytope):
    """Also for elements that no slice cuts, and while the parallel coordinates are hidden."""
    async with Client(server, stream="none") as client:
        frame = {"pace": 2, "boost": [0.5, 0, 0]}
        await client.request("set", polytope=polytope, orientation=random_rotation(4), slices={"count": 3}, **frame)
        for element in ("vertex", *SIZES):
            chosen = {"element": element, "number": 7}
            picture = await client.request("get", what="slices", highlight=chosen)
            await client.request("set", shown={"coordinates": False})
            measured = await client.request("measure", **chosen, highlight=True)
            assert measured["highlight"] == picture["highlight"]
            w = [picture["coordinates"][vertex][3] for vertex in picture["highlight"]["own_vertices"]]
            assert measured["range"] == pytest.approx([min(w), max(w)], abs=1e-5)
            only_size = await client.request("measure", **chosen)
            assert measured == {**only_size, "id": measured["id"],
                                "highlight": measured["highlight"], "range": measured["range"]}
            await client.request("undo")


@pytest.mark.parametrize("center", ["origin", "object"])
async def test_a_point_has_only_its_place(server, center):
    async with Client(server, stream="none") as client:
        await client.request("load", name="pair", format="cloud", data="1 2 3 4\n5 6 7 8\n", center=center)
        measured = await client.request("measure", element="vertex", number=1)
        assert without_numbering(measured) == {"type": "measured", "center": [5, 6, 7, 8]}
        measured = await client.request("measure", element="vertex", number=1, highlight=True)
        assert measured["highlight"] == {"vertices": [1], "edges": [], "own_vertices": [1]}
        assert measured["range"] == pytest.approx([8, 8]), "w of the file, wherever the center is"
        with pytest.raises(Refused, match="the pair has no edge") as refused:
            await client.request("measure", element="edge", number=0)
        assert refused.value.code == "out_of_range"


async def test_a_field_is_measured_in_the_units_of_its_box(server):
    async with field_client(server, "x", [[0, 1], [0, 2], [0, 3], [0, 4]]) as client:
        cells = [await client.request("measure", element="cell", number=number) for number in range(8)]
        assert sorted(cell["volume"] for cell in cells) == pytest.approx([6, 6, 8, 8, 12, 12, 24, 24])
        assert [sum(cell["center"][axis] for cell in cells) / 8 for axis in range(4)] == pytest.approx([0.5, 1, 1.5, 2])


@pytest.mark.parametrize("members, code, says", [
    ({"element": "cell", "number": 24}, "out_of_range", "the number of the cell must be from 0 to 23 for the 24-cell, not 24"),
    ({"element": "cell", "number": -1}, "out_of_range", "number"), ({"element": "cell"}, "bad_message", "/number is missing"),
    ({"element": "corner", "number": 1}, "bad_message", "vertex"), ({"number": 1}, "bad_message", "/element is missing"),
    ({"element": "cell", "number": 0.5}, "bad_message", "number"),
])
async def test_elements_that_do_not_exist_are_refused(server, members, code, says):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        with pytest.raises(Refused, match=says) as refused:
            await client.request("measure", **members)
        assert refused.value.code == code
