"""The serial number in the state tells whether the object is still the same."""

import png
from array_clients import load, state_of
from array_files import npy, quadratic
from harness import Server
from wire import Client

CORNERS = "".join(f"{x} {y} {z} {w}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1) for w in (-1, 1))


async def serial_of(client):
    return (await state_of(client))["object_serial"]


async def test_settings_keep_the_number_and_another_object_has_another(server):
    async with Client(server, stream="none") as client:
        serials = [await serial_of(client)]
        await client.request("set", polytope="24-cell")
        serials.append(await serial_of(client))
        for change in ({"slices": {"count": 5, "focus": 1}}, {"pace": 2, "boost": [0, 0.5, 0]}, {"color": "w"},
                       {"polytope": "24-cell"}, {"alpha": 0.1, "view": "matrix"}):
            await client.request("set", **change)
            assert await serial_of(client) == serials[1], change
        await client.request("key", key="y")
        assert await serial_of(client) == serials[1]
        assert png.state_in(await client.request_frame(width=64, height=48))["object_serial"] == serials[1]
        for _ in range(2):  # with the same name and as many elements
            await client.request("load", name="mine", format="points", data=CORNERS)
            serials.append(await serial_of(client))
        for a in (0.4, 0.5):
            await client.request("load", name="body", format="formula", data=f"x^2 + a*w^2 < 1; a={a}")
            serials.append(await serial_of(client))
        assert len(set(serials)) == len(serials) == 6


async def test_undo_and_redo_return_to_the_number(server):
    async with Client(server, stream="none") as client:
        first = await serial_of(client)
        for _ in range(2):
            await client.request("load", name="mine", format="points", data=CORNERS)
        last = await serial_of(client)
        await client.request("undo")
        between = await serial_of(client)
        await client.request("undo")
        assert await serial_of(client) == first
        for expected in (between, last):
            await client.request("redo")
            assert await serial_of(client) == expected
        assert len({first, between, last}) == 3


async def test_a_field_that_grows_has_another_number(server):
    values = quadratic((4, 5, 6, 7))
    async with Client(server, stream="none") as client:
        await load(client, "run", npy(values[:2]))
        before = await serial_of(client)
        await load(client, "run", npy(values[2:3]), append=True)
        grown = await serial_of(client)
        await client.request("set", polytope="24-cell")
        other = await serial_of(client)
        await load(client, "run", npy(values[3:]), append=True)
        assert await serial_of(client) == other, "another object is shown"
        await client.request("undo")
        assert len({before, grown, other, await serial_of(client)}) == 4, "the longer field is in the history, too"


async def test_each_server_has_other_numbers():
    """So a session that another server opens again never shows another object under a former number."""
    serials = set()
    for _ in range(2):
        with Server() as server:
            async with Client(server, stream="none") as client:
                serials.add(await serial_of(client))
    assert len(serials) == 2


async def test_pictures_outside_sessions_have_no_number(server):
    pictures = [server.get("/api/v1/frame.png?polytope=8-cell&width=64&height=48").body for _ in range(2)]
    assert "object_serial" not in png.state_in(pictures[0])
    assert pictures[0] == pictures[1]
