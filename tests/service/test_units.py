"""The units of fields: from files to the state, stored sessions, sizes and pictures."""

import png
import pytest
from array_clients import SIZE, load, state_of
from array_files import hdf5, netcdf_with_units, nifti, npy, quadratic
from harness import Server
from wire import Client

SHAPE = (3, 4, 5, 6)
UNITS = {"x": "m", "y": "m", "z": "km", "t": "s"}
BODY = netcdf_with_units(quadratic(SHAPE), "temperature", "K", UNITS)
KNOWN = {"units": {"x": "m", "y": "m", "z": "km", "w": "s"}, "quantity": {"name": "temperature", "unit": "K"}}


def measured(state):
    """Returns what the state says of units."""
    return {name: state["field"][name] for name in ("units", "quantity") if name in state["field"]}


def nifti_with_units():
    body = bytearray(nifti(quadratic(SHAPE)))
    body[123] = 2 | 8  # millimeters and seconds
    return bytes(body)


@pytest.mark.parametrize("body, format_, expected", [
    (BODY, "netcdf", KNOWN),
    (hdf5(quadratic(SHAPE)), "hdf5", {"quantity": {"name": "v"}}),
    (nifti_with_units(), "nifti", {"units": {"x": "mm", "y": "mm", "z": "mm", "w": "s"}}),
    (npy(quadratic(SHAPE)), "npy", {}),
], ids=["netcdf", "hdf5", "nifti", "npy"])
async def test_the_state_has_the_units_that_a_file_states(server, body, format_, expected):
    async with Client(server, stream="none") as client:
        await load(client, "run", body, format_)
        assert measured(await state_of(client)) == expected
        await load(client, "run", body, format_, box=[[0, 2], [0, 2], [0, 2], [0, 2]])
        without = {name: member for name, member in expected.items() if name != "units"}
        assert measured(await state_of(client)) == without, "another box may have other units"
        await client.request("load", name="formula", format="formula", data="x + y")
        assert measured(await state_of(client)) == {}


async def test_units_survive_frames_growth_and_a_restart(tmp_path):
    store = f"sqlite:{tmp_path}/sessions.db"
    with Server("--store", store) as server:
        async with Client(server) as client:
            await load(client, "run", BODY, "netcdf")
            await client.request("set", pace=2, boost=[0.2, 0, 0])
            assert measured(await state_of(client)) == KNOWN
            await load(client, "run", npy(quadratic(SHAPE)[:1]), append=True)
            state = await state_of(client)
            assert state["field"]["shape"][3] == SHAPE[0] + 1 and measured(state) == KNOWN
            await client.request("set", polytope="16-cell")
            assert "field" not in await state_of(client)
            welcome = client.welcome
    with Server("--store", store) as server:
        async with Client(server, session=welcome["session"], token=welcome["token"]) as client:
            await client.request("undo")
            assert measured(await state_of(client)) == KNOWN


async def test_hostile_texts_are_cut(server):
    async with Client(server, stream="none") as client:
        body = netcdf_with_units(quadratic(SHAPE), "q" * 100_000, b"\xffK\n", {**UNITS, "x": "\u20ac" * 1000})
        await load(client, "run", body, "netcdf")
        field = (await state_of(client))["field"]
        assert field["quantity"]["unit"] == "?K?"
        for text, character in ((field["quantity"]["name"], "q"), (field["units"]["x"], "\u20ac")):
            assert len(text.encode()) <= 64 and set(text[:-1]) == {character} and text[-1] == "\u2026"


async def test_the_sizes_of_the_box_have_units(server):
    async with Client(server, stream="none") as client:
        await load(client, "run", BODY, "netcdf")
        found = {}
        for element, count in (("edge", 32), ("face", 24), ("cell", 8)):
            sizes = [await client.request("measure", element=element, number=number) for number in range(count)]
            found[element] = {size["unit"] for size in sizes}
        assert found == {"edge": {"m", "km", "s"}, "face": {"m\u00b2", "m km", "m s", "km s"},
                         "cell": {"m\u00b2 km", "m\u00b2 s", "m km s"}}
        assert "unit" not in await client.request("measure", element="vertex", number=0)


async def test_pictures_show_the_units(server):
    async with Client(server) as client:
        pixels = []
        for units in (UNITS, dict.fromkeys(UNITS, "")):
            await load(client, "run", netcdf_with_units(quadratic(SHAPE), "temperature", "K", units), "netcdf")
            await client.request("set", shown={"faces": False})
            pixels.append(png.pixels(await client.request_frame(**SIZE)))
    assert pixels[0] != pixels[1], "the histogram names the units of the axes"
