"""The highlighted element, and the names of sections."""

import png
import pytest
from wire import ENCODINGS, Client, Refused

SIZE = {"width": 640, "height": 360}
HIGHLIGHT = 0xff4fb8


def highlighted_pixels(picture):
    """Returns the number of pixels whose color is close to that of the highlight."""
    data = png.pixels(picture)[1]
    return sum(red > 60 and red > 1.6 * green and blue > 1.3 * green
               for red, green, blue in zip(data[::3], data[1::3], data[2::3]))


async def test_messages_commands_queries_and_undo_agree(server):
    async with Client(server, stream="none") as client:
        async def highlight():
            return (await client.request("get", what="state"))["highlight"]

        await client.request("set", polytope="24-cell")
        assert await highlight() is None
        await client.request("set", highlight={"element": "cell", "number": 17})
        assert await highlight() == {"element": "cell", "number": 17}
        await client.request("command", line=":highlight vertex 3")
        assert await highlight() == {"element": "vertex", "number": 3}
        await client.request("undo")
        assert await highlight() == {"element": "cell", "number": 17}
        await client.request("command", line=":highlight none")
        assert await highlight() is None
        await client.request("command", line=":set highlight=edge:95")
        state = await client.request("get", what="state")
        await client.request("set", polytope="tesseract")
        assert await highlight() is None
        await client.request("set", **{name: value for name, value in state.items() if name not in ("type", "id")})
        assert await highlight() == {"element": "edge", "number": 95}, "a state is a valid set"


@pytest.mark.parametrize("members, says", [
    ({"highlight": {"element": "cell", "number": 24}}, "the number of the cell must be from 0 to 23 for the 24-cell, not 24"),
    ({"highlight": {"element": "corner", "number": 1}}, "vertex"), ({"highlight": {"element": "cell"}}, "number"),
    ({"highlight": "cell"}, "highlight"),
])
async def test_elements_that_do_not_exist_are_refused(server, members, says):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        with pytest.raises(Refused, match=says):
            await client.request("set", **members)
        assert (await client.request("get", what="state"))["highlight"] is None


@pytest.mark.parametrize("line, says", [
    ("highlight", "none or an element such as cell:17"), ("highlight cell", "none or an element such as cell:17"),
    ("highlight cell x", "a whole number from 0, not 'x'"), ("highlight corner 1", "vertex, edge, face or cell, not 'corner'"),
    ("highlight cell 24", "from 0 to 23"),
])
async def test_wrong_lines_say_what_is_allowed(server, line, says):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="24-cell")
        with pytest.raises(Refused, match=says):
            await client.request("command", line=line)


async def test_a_picture_can_highlight_another_element_than_the_session(server):
    """As a client does that shows what is under the pointer."""
    cell, edge = {"element": "cell", "number": 17}, {"element": "edge", "number": 3}
    async with Client(server, stream="none") as client:
        async def pixels(**members):
            return png.pixels(await client.request_frame(**SIZE, **members))[1]

        async def highlighted_edges(**members):
            return list((await client.request("get", what="slices", **members)).get("highlight", {}).get("edges", []))

        await client.request("set", polytope="24-cell", projection="perspective")
        plain, with_cell = await pixels(), await pixels(highlight=cell)
        edges_of_cell = await highlighted_edges(highlight=cell)
        assert with_cell != plain and len(edges_of_cell) > 0
        revision = (await client.request("set", highlight=cell))["revision"]
        assert await pixels() == with_cell
        assert await highlighted_edges() == edges_of_cell
        assert await pixels(highlight=None) == plain
        assert await highlighted_edges(highlight=None) == []
        assert await pixels(highlight=edge) not in (plain, with_cell)
        state = await client.request("get", what="state")
        assert (state["highlight"], state["revision"]) == (cell, revision)
        for what in ["frame", "slices"]:
            with pytest.raises(Refused, match="the number of the cell must be from 0 to 23"):
                await client.request("get", what=what, highlight={"element": "cell", "number": 24})


@pytest.mark.parametrize("encoding", ENCODINGS)
async def test_the_geometry_tells_what_to_highlight(server, encoding):
    """Cell 5 of a tesseract: its 6 faces are cut to bars, its 12 edges are in the projection."""
    async with Client(server, stream="geometry", encoding=encoding) as client:
        done = await client.request("set", polytope="tesseract", projection="perspective", highlight={"element": "cell", "number": 5})
        slices = await client.wait_for_slices(done["revision"])
        highlight = slices["highlight"]
        assert len(highlight["own_vertices"]) == 8
        assert len(highlight["edges"]) == 6 + 12 and len(highlight["vertices"]) == 0
        assert slices["scene"]["colors"]["highlight"] == HIGHLIGHT
        assert [color == HIGHLIGHT for color in slices["scene"]["colors"]["cells"]] == [False] * 5 + [True] + [False] * 2


@pytest.mark.parametrize("element", ["vertex", "edge", "face", "cell"])
@pytest.mark.parametrize("polytope", ["tesseract", "small stellated 120-cell"])
def test_frames_show_the_highlight(server, polytope, element):
    view = f"/api/v1/frame.png?polytope={polytope.replace(' ', '%20')}&rotate=xw:0.3&projection=perspective&color=plain&width=640&height=360"
    assert highlighted_pixels(server.get(view).body) == 0
    assert highlighted_pixels(server.get(f"{view}&highlight={element}:1").body) > 20


@pytest.mark.parametrize("stream", ["none", "geometry", "frames"])
async def test_sections_have_names(server, stream):
    """Coxeter's sections of the 600-cell beginning with a vertex, and the tesseract's between its vertices."""
    async with Client(server, stream=stream, **SIZE) as client:
        async def section():
            return (await client.request("get", what="state"))["section"]

        await client.request("set", polytope="600-cell")
        await client.request("toward", element="vertex", number=0, immediately=True)
        found = []
        await client.request("command", line="set focus=-1000")
        for _ in range(9):
            await client.request("key", key=")")
            found.append((await section())["vertices"])
        assert found == ["point", "icosahedron", "dodecahedron", "icosahedron", "icosidodecahedron",
                         "icosahedron", "dodecahedron", "icosahedron", "point"]
        await client.request("set", polytope="tesseract", slices={"focus": 0, "offset": 0})
        await client.request("set", orientation=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        assert await section() == {"w": 0, "name": "cube", "vertices": ""}
        await client.request("toward", element="vertex", immediately=True)
        assert (await section())["name"] == "octahedron"


async def test_the_label_names_the_section(server):
    async with Client(server, stream="none") as client:
        async def label():
            slices = await client.request("get", what="slices")
            return slices["section"]["name"], next(cut["label"] for cut in slices["slices"] if cut["focus"])

        await client.request("set", polytope="tesseract")
        assert await label() == ("cube", "w = 0, cube")
        await client.request("rotate", planes=["xw"], angles=[0.1])
        assert await label() == ("cuboid", "w = 0, cuboid")
        await client.request("rotate", planes=["yw"], angles=[0.1])
        assert await label() == ("", "w = 0")
        await client.request("set", polytope="600-cell")
        await client.request("toward", element="vertex", immediately=True)
        for _ in range(2):
            await client.request("key", key=")")
        assert (await label())[1].endswith(", vertices: dodecahedron")


def test_frames_carry_the_section(server):
    """The middle section of a 24-cell beginning with a cell is a cuboctahedron."""
    frame = server.get("/api/v1/frame.png?polytope=24-cell&toward=cell").body
    assert png.state_in(frame)["section"] == {"w": 0, "name": "cuboctahedron", "vertices": "cuboctahedron"}


async def test_a_script_asks_what_is_at_a_point(server):
    """In the single view of a tesseract's cube, the middle of the picture shows a cell; the corner shows nothing."""
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract", view="single", shown={"coordinates": False})
        at = await client.request("get", what="at", x=320, y=180, **SIZE)
        assert at["highlight"]["element"] == "cell" and at["in"] == "slice" and at["slice"] == 0 and at["w"] == 0
        assert (at["least_w"], at["most_w"], at["vertices"], at["name"], at["kind"]) == (-1, 1, 8, "cube", 0)
        await client.request("set", highlight=at["highlight"])
        assert (await client.request("get", what="state"))["highlight"] == at["highlight"]
        assert "coordinates" not in at and "place" not in at, "of a cell"
        nothing = await client.request("get", what="at", x=1, y=1, **SIZE)
        assert nothing["highlight"] is None and "in" not in nothing
        with pytest.raises(Refused, match="needs /x and /y"):
            await client.request("get", what="at", x=1)


async def test_a_vertex_has_its_coordinates_before_and_after_the_rotation(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract")
        await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 0.7])
        slices = await client.request("get", what="slices", **SIZE)
        layout = slices["scene"]["coordinates"]
        for vertex in (0, 5):
            x = layout["left"] + vertex % layout["per_row"] * layout["column_step"] + 1.5 * layout["line_step"]
            y = layout["zero"] - vertex // layout["per_row"] * layout["row_step"]
            at = await client.request("get", what="at", x=x * SIZE["height"], y=(1 - y) * SIZE["height"], **SIZE)
            assert at["highlight"] == {"element": "vertex", "number": vertex}
            assert at["coordinates"] == pytest.approx(list(slices["coordinates"][vertex]), abs=1e-6)
            assert sorted(map(abs, at["place"])) == pytest.approx([1, 1, 1, 1])
