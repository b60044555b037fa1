"""Elements that turn toward +w, and hyperplanes at an offset."""

import math

import pytest
from wire import Client, Refused

RADIUS = 2 * (1 + math.sqrt(5)) / 2  # the circumradius of a 600-cell with edges of length 2


async def at_rest(client):
    """Waits until the object does not move any more; returns the state."""
    return await client.wait_until(lambda: next((state for state in client.states()[-1:] if not state["moving"]), None))


async def vertex_positions(server):
    """Returns the vertices of an unrotated 600-cell, in the order of their numbers."""
    lines = server.get("/api/v1/file.off?polytope=600-cell").body.decode().split("\n")
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    count = int(rows[1][0])
    return [[float(number) for number in row] for row in rows[2:2 + count]]


@pytest.mark.parametrize("stream", ["none", "geometry"])
async def test_the_object_moves_to_the_element(server, stream):
    async with Client(server, stream=stream) as client:
        await client.request("set", polytope="600-cell")
        await client.request("rotate", planes=["xw"], angles=[0.3])
        own = await vertex_positions(server)
        heights = lambda state: [sum(m * x for m, x in zip(state["orientation"][3], vertex)) for vertex in own]
        w = heights(await client.request("get", what="state"))
        lowest = w.index(min(w))
        done = await client.request("toward", element="vertex", number=lowest)
        # Turning by almost π takes almost 2 s. A step covers at most 0.25 s, however late it is.
        await client.wait_for_state(done["revision"] + 6)
        state = await at_rest(client)
        w = heights(state)
        assert w[lowest] == pytest.approx(RADIUS, abs=1e-9) == pytest.approx(max(w))
        undone = await client.request("undo")
        before = await client.wait_for_state(undone["revision"])
        assert before["orientation"] != state["orientation"]
        assert before["orientation"][0][0] == pytest.approx(math.cos(0.3))


async def test_it_jumps_on_wish(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract")
        await client.request("rotate", planes=["xw"], angles=[0.3])
        done = await client.request("toward", element="cell", number=2, immediately=True)
        state = await client.request("get", what="state")
        assert state["revision"] == done["revision"]
        assert sorted(abs(entry) for entry in state["orientation"][3]) == pytest.approx([0, 0, 0, 1])


@pytest.mark.parametrize("members, code, says", [
    ({"element": "corner"}, "bad_message", "vertex"), ({}, "bad_message", "element"),
    ({"element": "cell", "number": 8}, "out_of_range", "from 0 to 7 for the 8-cell, not 8"),
    ({"element": "cell", "number": -1}, "out_of_range", "number"), ({"element": "cell", "number": 0.5}, "bad_message", "number"),
    ({"element": "cell", "immediately": 1}, "bad_message", "immediately"),
])
async def test_elements_that_do_not_exist_are_refused(server, members, code, says):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract")
        before = await client.request("get", what="state")
        with pytest.raises(Refused, match=says) as refused:
            await client.request("toward", **members)
        assert refused.value.code == code
        assert {**await client.request("get", what="state"), "id": 0} == {**before, "id": 0}


async def test_the_focus_goes_from_vertex_to_vertex(server):
    """Coxeter's sections of the 600-cell, beginning with a vertex, lie at cos 0°, 36°, 60°, 72° and 90°."""
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="600-cell")
        await client.request("toward", element="vertex", number=0, immediately=True)
        for degrees in (72, 60, 36, 0):
            await client.request("key", key=")")
            slices = (await client.request("get", what="state"))["slices"]
            w = slices["offset"] + slices["focus"] * slices["spacing"]
            assert w == pytest.approx(RADIUS * math.cos(math.radians(degrees)), abs=1e-9)
            focus = next(cut for cut in (await client.request("get", what="slices"))["slices"] if cut["focus"])
            assert focus["w"] == pytest.approx(w)


async def test_the_hyperplanes_stand_at_any_offset(server):
    async with Client(server, stream="none") as client:
        await client.request("set", polytope="tesseract", slices={"count": 5, "spacing": 0.5, "offset": 0.1})
        slices = (await client.request("get", what="slices"))["slices"]
        assert [cut["w"] for cut in slices] == pytest.approx([-0.9, -0.4, 0.1, 0.6, 1.1])
        with pytest.raises(Refused, match="the offset must be from −20 to 20"):
            await client.request("set", slices={"offset": 21})
        await client.request("command", line=":set offset=-0.25")
        assert (await client.request("get", what="state"))["slices"]["offset"] == -0.25


async def test_the_rotations_of_a_gesture_are_one_undo_step(server):
    async with Client(server, stream="none") as client:
        before = await client.request("get", what="state")
        for i in range(5):
            await client.request("rotate", planes=["xw"], angles=[0.1], continues=i > 0)
        await client.request("undo")
        after = await client.request("get", what="state")
        assert after["orientation"] == before["orientation"]
        with pytest.raises(Refused, match="nothing to undo"):
            await client.request("undo")


@pytest.mark.parametrize("line, angle", [("30°", math.pi / 6), ("30deg", math.pi / 6), ("pi/6", math.pi / 6), ("30rad", 30)])
async def test_angles_may_have_units(server, line, angle):
    async with Client(server, stream="none") as client:
        await client.request("command", line=f"rotate xw {line}")
        assert (await client.request("get", what="state"))["last"]["angles"] == pytest.approx([angle])
        with pytest.raises(Refused, match="did you mean 30°"):
            await client.request("command", line="rotate xw 30")
        with pytest.raises(Refused, match="did you mean 30°"):
            await client.request("command", line="set alpha=30")
