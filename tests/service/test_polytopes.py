"""Polytopes by name, by notation and from the catalogue."""

from urllib.parse import quote

import pytest
from wire import Client, Refused


@pytest.mark.parametrize("text, name, counts", [
    ("truncated tesseract", "truncated tesseract", (64, 128, 88, 24)),
    ("omnitruncated 120-cell", "omnitruncated 120-cell", (14400, 28800, 17040, 2640)),
    ("O5O3O3X", "600-cell", (120, 720, 1200, 600)),
    ("x3o3o *b3o", "16-cell", (8, 24, 32, 16)),
    ("{5,5/2,5}", "great 120-cell", (120, 720, 720, 120)),
    ("sadi", "snub 24-cell", (96, 432, 480, 144)),
    ("grand antiprism", "grand antiprism", (100, 500, 720, 320)),
    ("7x9 duoprism", "7,9-duoprism", (63, 126, 79, 16)),
    ("4-3 duoantiprism", "3,4-duoantiprism", (24, 96, 110, 38)),
    ("2,2-duoantiprism", "16-cell", (8, 24, 32, 16)),
    ("7-cyclic polytope", "cyclic polytope C(7,4)", (7, 21, 28, 14)),
    ("C(8, 4)", "cyclic polytope C(8,4)", (8, 28, 40, 20)),
    ("pentagonal antiprism prism", "pentagonal antiprism prism", (20, 50, 44, 14)),
    ("snub cube prism", "snub cubic prism", (48, 144, 136, 40)),
    ("pyramid of cube", "pyramid of cube", (9, 20, 18, 7)),
    ("bipyramid of icosahedron", "bipyramid of icosahedron", (14, 54, 80, 40)),
    ("prism of rhombic dodecahedron", "prism of rhombic dodecahedron", (28, 62, 48, 14)),
    ("prism of Snub Cube", "snub cubic prism", (48, 144, 136, 40)),
    ("product of 5-gon and 7-gon", "5,7-duoprism", (35, 70, 47, 12)),
    ("dual of bipyramid of dual of 6-gonal prism", "dual of bipyramid of hexagonal bipyramid", (24, 48, 34, 10)),
    ("rectification of 16-cell", "24-cell", (24, 96, 96, 24)),
    ("truncation of tesseract", "truncation of 8-cell", (64, 128, 88, 24)),
    ("hull of tesseract and 16-cell of circumradius 2", "hull of 8-cell and 16-cell of circumradius 2",
     (24, 96, 96, 24)),
    ("intersection of tesseract and dual of tesseract", "intersection of 8-cell and 16-cell", (24, 96, 96, 24)),
    ("rectification of hull of omnitruncated 5-cell and intersection of runcitruncated tesseract of circumradius 3.25 "
     "and cantellated 24-cell", None, None),
])
async def test_names_and_notations_select_polytopes(server, text, name, counts):
    async with Client(server, stream="geometry") as client:
        for request in ({"type_": "set", "polytope": text}, {"type_": "command", "line": f":polytope {text}"}):
            await client.request("set", polytope="5-cell")
            done = await client.request(request.pop("type_"), **request)
            state = await client.wait_for_state(done["revision"])
            polytope = state["polytope"]
            found = tuple(polytope[part] for part in ("vertices", "edges", "faces", "cells"))
            assert polytope["name"] == (name or polytope["name"]) and found == (counts or found)
            assert found[0] - found[1] + found[2] - found[3] == 0 or "/" in name
            assert sum(kind["cells"] for kind in polytope["kinds"]) == found[3]
            # The polytope in a state message can be sent back to set the polytope again.
            await client.request("set", polytope="5-cell")
            done = await client.request("set", polytope=polytope)
            assert (await client.wait_for_state(done["revision"]))["polytope"] == polytope


async def test_kinds_of_cells_have_names_and_colors(server):
    async with Client(server) as client:
        await client.request("set", polytope="omnitruncated 120-cell")
        state = await client.request("get", what="state")
        kinds = state["polytope"]["kinds"]
        assert [(kind["name"], kind["cells"]) for kind in kinds] == [
            ("truncated icosidodecahedron", 120), ("truncated octahedron", 600), ("decagonal prism", 720),
            ("hexagonal prism", 1200)]
        await client.request("set", color="kind")
        slices = await client.request("get", what="slices")
        cells = slices["scene"]["colors"]["cells"]
        assert sorted(cells) == sorted(kind["color"] for kind in kinds for _ in range(kind["cells"]))


@pytest.mark.parametrize("text, expected_text", [
    ("trunkated tesseract", "did you mean 'truncated tesseract'?"),
    ("omnitruncate 120 cell", "did you mean 'omnitruncated 120-cell'?"),
    ("truncated 14-cell", "did you mean 'truncated 16-cell' or 'truncated 24-cell'?"),
    ("x5o3o", "four nodes"),
    ("x6o3o3o", "finite"),
    ("o5o3o3o", "ringed"),
    ("2,5-duoprism", "at least three sides"),
    ("5/2,5-duoantiprism", "are no stars"),
    ("C(7, 3)", "from 5 to 448"),
    ("{6,3,3}", "finite"),
    ("cube", "is a polyhedron"),
    ("dual of cube", "is a polyhedron"),
    ("dual of tessaract", "'tessaract' is not the name of a polytope; did you mean 'tesseract'?"),
    ("pyramid of tesseract", "is not the name of a polyhedron"),
    ("piramid of cube", "did you mean 'pyramid'?"),
    ("hull of tesseract", "the word 'and'"),
    ("hull of tesseract and 16-cell of circumradius 1000", "from 0.01 to 100"),
    ("truncation of great 120-cell", "is not convex"),
    ("product of 5-gon and cube", "is not a polygon"),
    ("dual of " * 9 + "5-cell", "at most 8"),
])
async def test_unknown_names_are_explained(server, text, expected_text):
    async with Client(server) as client:
        before = await client.request("get", what="state")
        for line in ({"type_": "set", "polytope": text}, {"type_": "command", "line": f"polytope {text}"}):
            with pytest.raises(Refused) as refused:
                await client.request(line.pop("type_"), **line)
            assert refused.value.code == "unknown_polytope"
            assert expected_text in refused.value.text
            assert f"'{text}'" in refused.value.text or f"'{text[:60]}…'" in refused.value.text
        after = await client.request("get", what="state")
        assert {**after, "id": 0} == {**before, "id": 0}


async def test_too_many_vertices_are_refused(server):
    async with Client(server) as client:
        for text, most in (("1000,1000-duoprism", 100000), ("x999999o x999999o", 100000),
                           ("300,300-duoantiprism", 100000), ("cyclic polytope C(449, 4)", 448),
                           ("500000-gonal antiprism prism", 100000), ("pyramid of 500000-gonal prism", 100000),
                           ("truncation of omnitruncated 120-cell", 20000),
                           ("hull of omnitruncated 120-cell and omnitruncated 120-cell", 20000),
                           ("rectification of 3,1500-duoprism", 1000)):
            with pytest.raises(Refused) as refused:
                await client.request("set", polytope=text)
            assert refused.value.code == "too_large" and str(most) in refused.value.text


async def test_nothing_similar_is_suggested_for_nonsense(server):
    async with Client(server) as client:
        for text in ("q", "zz", "wvqzk", "7"):
            with pytest.raises(Refused) as refused:
                await client.request("set", polytope=text)
            assert refused.value.code == "unknown_polytope" and "did you mean" not in refused.value.text


async def test_kinds_of_cells_are_found_by_all_their_names(server):
    async with Client(server) as client:
        await client.request("set", polytope="pyramid of 7-gonal prism")
        names = ["heptagonal prism", "heptagonal pyramid", "square pyramid"]
        state = await client.request("get", what="state")
        assert sorted(kind["name"] for kind in state["polytope"]["kinds"]) == names
        for text in ("heptagonal prism", "7-gonal prism", "7 gonal prism", "Heptagonal Prism"):
            await client.request("command", line=f"hide {text}")
            hidden = (await client.request("get", what="state"))["hidden"]
            assert [state["polytope"]["kinds"][kind]["name"] for kind in hidden] == ["heptagonal prism"], text
            await client.request("set", hidden=[])


def test_addresses_name_composed_polytopes(server):
    def frame(name):
        return server.get(f"/api/v1/frame.png?polytope={quote(name)}&width=320&height=180")

    assert frame("rectification of 16-cell").body == frame("24-cell").body
    assert frame("pyramid of rhombic dodecahedron").status == 200
    refused = frame("pyramid of teapot")
    assert refused.status == 400 and b"is not the name of a polyhedron" in refused.body


async def test_composed_polytopes_are_built_again_from_their_names(server):
    name = "hull of pyramid of dual of cuboctahedron and intersection of 24-cell and 5,5-duoprism of circumradius 2"
    async with Client(server) as client:
        await client.request("set", polytope=name)
        polytope = (await client.request("get", what="state"))["polytope"]
        await client.request("set", polytope="5-cell")
        await client.request("set", polytope=polytope["name"])
        assert (await client.request("get", what="state"))["polytope"] == polytope


async def test_catalogue_entries_have_the_stated_counts(server):
    async with Client(server) as client:
        entries = (await client.request("get", what="catalogue"))["polytopes"]
        assert len(entries) > 80
        for entry in entries:
            await client.request("key", key="n")
        assert (await client.request("get", what="state"))["polytope"]["name"] == entries[0]["name"]
        for entry in reversed(entries):
            await client.request("key", key="N")
            polytope = (await client.request("get", what="state"))["polytope"]
            for part in ("name", "vertices", "edges", "faces", "cells"):
                assert polytope[part] == entry[part]


async def test_n_and_shift_n_enter_the_catalogue_from_other_polytopes(server):
    async with Client(server) as client:
        entries = (await client.request("get", what="catalogue"))["polytopes"]
        for key, name in (("n", entries[0]["name"]), ("N", entries[-1]["name"])):
            await client.request("set", polytope="7,9-duoprism")
            await client.request("key", key=key)
            assert (await client.request("get", what="state"))["polytope"]["name"] == name


async def test_built_in_names_are_refused_for_loaded_polytopes(server):
    async with Client(server) as client:
        for name in ("tesseract", "truncated tesseract", "7,9-duoprism", "x5o x8o"):
            with pytest.raises(Refused) as refused:
                await client.request("load", name=name, format="off", data="4OFF\n")
            assert refused.value.code == "bad_polytope" and "choose another" in refused.value.text
