"""Fields of the data folder that are larger than the memory for them: mapped, converted on the disk, lost, restored."""

import asyncio
import gzip
import json
import os
import struct

import numpy
import png
import pytest
from array_files import hdf5, netcdf, nifti, npy, quadratic
from harness import Server
from test_data_folder import slices_of
from wire import Client, Refused, hello_refusal

SIZE = {"width": 480, "height": 270}
SHAPE = (9, 20, 22, 24)
SMALL = ("--max-field-bytes", "64k", "--max-undo", 0)  # with these limits, arrays of this shape count as large
GIGABYTE = 1 << 30


def header_of(shape, descr="<f4", fortran=False):
    text = f"{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}"
    text += " " * (-(len(text) + 11) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(text)) + text.encode()


def sparse_npy(path, shape, parts=()):
    """Writes a file of zeros, of which the disk has only the given parts: pairs of an index along t and z, and a plane."""
    head = header_of(shape)
    size = 4 * int(numpy.prod(shape))
    with path.open("wb") as file:
        file.write(head)
        for index, plane in parts:
            file.seek(len(head) + 4 * int(numpy.ravel_multi_index((*index, 0, 0), shape)))
            file.write(plane.astype("<f4").tobytes())
        file.truncate(len(head) + size)


@pytest.fixture(name="folder")
def empty_folder(tmp_path):
    (tmp_path / "data").mkdir()
    return tmp_path / "data"


def open_server(folder, *options):
    return Server("--data", folder, "--field-cache-folder", folder.parent, *options)


@pytest.mark.parametrize("name, body, box, on_disk", [
    ("in order.npy", lambda v: npy(v), None, False),
    ("doubles.npy", lambda v: npy(v.astype("f8")), None, True),
    ("big-endian.npy", lambda v: npy(v.astype(">f4")), None, True),
    ("fortran.npy", lambda v: npy(numpy.asfortranarray(v)), None, True),
    ("contiguous.h5", hdf5, None, False),
    ("classic.nc", netcdf, None, True),
    ("plain.nii", nifti, "same", False),
    ("packed.nii.gz", lambda v: gzip.compress(nifti(v)), "same", True),
])
async def test_large_arrays_are_shown_like_small_ones(folder, name, body, box, on_disk):
    values = quadratic(SHAPE)
    (folder / name).write_bytes(body(values))
    members = {"name": "run", "path": name} | ({"box": [[-1, 1]] * 4} if box else {})
    with Server("--data", folder) as server:
        async with Client(server) as client:
            await client.request("load", **members)
            expected, frame = await slices_of(client), png.pixels(await client.request_frame(**SIZE))
            state = await client.request("get", what="state")
    with open_server(folder, *SMALL) as server:
        async with Client(server) as client:
            await client.request("load", **members)
            assert await slices_of(client) == expected
            assert png.pixels(await client.request_frame(**SIZE)) == frame
            assert (await client.request("get", what="state"))["field"] == state["field"]
            server.wait_for(lambda: server.metric("oval4d_client_bytes") < 1 << 20)
            assert (server.metric("oval4d_field_cache_bytes") > 0) == on_disk
    assert not [f for f in os.listdir(folder.parent) if f.startswith("oval4d-")]


async def test_a_large_series_is_one_array(folder):
    values = quadratic(SHAPE)
    (folder / "run").mkdir()
    for moment, each in enumerate(values):
        (folder / "run" / f"t{moment}.npy").write_bytes(npy(each if moment % 2 else each.astype(">f4")))
    (folder / "whole.npy").write_bytes(npy(values))
    with open_server(folder, *SMALL) as server:
        async with Client(server) as client:
            await client.request("load", name="whole", path="whole.npy", box=[[-1, 1]] * 4)
            expected = await slices_of(client)
            await client.request("load", name="series", path="run", box=[[-1, 1]] * 4)
            assert await slices_of(client) == expected


@pytest.mark.release_only
async def test_an_array_larger_than_memory_is_shown(folder):
    shape = (100, 512, 512, 512)  # 54 GB; the file has holes, so the disk needs little of it
    y, x = numpy.meshgrid(numpy.linspace(-1, 1, 512), numpy.linspace(-1, 1, 512), indexing="ij")
    parts = [((t, z), 1 - x**2 - y**2 - ((z - 256) / 256)**2) for t in (49, 50) for z in range(0, 512)]
    sparse_npy(folder / "large.npy", shape, parts)
    with open_server(folder, "--load-memory", "128M") as server:
        before = server.anonymous_memory()
        async with Client(server, stream="geometry", **SIZE) as client:
            await client.wait_for_slices(0)
            done = await client.request("load", name="run", path="large.npy")
            assert any("selection" in warning for warning in done["warnings"])
            pictures = lambda: [m for m in client.streamed_messages("slices") if m["revision"] == done["revision"]]
            first = (await client.wait_until(pictures))[0]
            assert first.get("draft") is True
            state = await client.request("get", what="state")
            assert state["field"]["estimated"] is True and state["field"]["shape"] == [512, 512, 512, 100]
            await client.wait_for_slices(done["revision"])
            await client.request("set", levels=[0.5], inside="above", slices={"count": 5, "spacing": 0.02}, shown={"coordinates": False})
            for _ in range(5):
                await client.request("rotate", planes=["xy"], angles=[0.1])
            slices = await slices_of(client)
            assert any("surface" in each and each["surface"]["triangles"] for each in slices)
            assert len(await client.request_frame(**SIZE)) > 1000
            grown = server.anonymous_memory() - before
            print(f"anonymous memory {grown / 1e6:.0f} MB, resident {server.resident_memory() / 1e6:.0f} MB")
            for process in [server.process.pid, *server.drawing_processes()]:
                assert server.anonymous_memory(process) < GIGABYTE
            assert grown < GIGABYTE // 4
            assert server.resident_memory() < GIGABYTE // 2


async def test_a_file_that_is_shortened_while_it_is_shown_harms_only_its_sessions(folder):
    values = quadratic(SHAPE)
    (folder / "a.npy").write_bytes(npy(values))
    (folder / "b.npy").write_bytes(npy(values))
    with open_server(folder, *SMALL) as server:
        async with Client(server, stream="frames", **SIZE) as victim, Client(server, stream="geometry", **SIZE) as other:
            for client, name in ((victim, "a.npy"), (other, "b.npy")):
                await client.request("load", name="run", path=name)
                await client.request_frame(**SIZE)
                await slices_of(client)
            pids = [server.process.pid, *server.drawing_processes()]
            expected = await slices_of(other)
            await victim.request("rotate", planes=["xw"], angles=[0.3])
            os.truncate(folder / "a.npy", 4096)
            for what in ("slices", "frame"):
                with pytest.raises(Refused, match="shortened") as refused:
                    await victim.request("get", what=what, **SIZE)
                assert refused.value.code == "bad_field"
            for format_ in ("csv", "vti", "stl"):
                with pytest.raises(Refused, match="shortened") as refused:
                    await victim.request("get", what="file", format=format_, of="focus")
                assert refused.value.code == "bad_field"
            for type_, members in (("get", {"what": "critical"}), ("key", {"key": ")"})):
                with pytest.raises(Refused, match="shortened") as refused:
                    await victim.request(type_, **members)
                assert refused.value.code == "bad_field"
            assert await slices_of(other) == expected
            await other.request_frame(**SIZE)
            assert [server.process.pid, *server.drawing_processes()] == pids
            (folder / "a.npy").write_bytes(npy(values))
            await victim.request("load", name="run", path="a.npy")
            await slices_of(victim)


async def test_a_file_may_change_at_any_time(folder):
    path = folder / "run.npy"
    whole = npy(quadratic(SHAPE))
    path.write_bytes(whole)
    with open_server(folder, *SMALL) as server:
        async with Client(server, stream="frames", **SIZE) as client:
            await client.request("load", name="run", path="run.npy")
            await client.request("rotate", planes=["xw"], angles=[0.1])
            await client.request("set", turning=True)
            for round_ in range(40):
                if round_ % 4 == 0:
                    path.write_bytes(whole)  # leaves the file empty for a moment
                elif round_ % 4 == 1:
                    os.truncate(path, 128 + 40 * round_)
                elif round_ % 4 == 2:
                    with path.open("r+b") as file:
                        file.write(numpy.random.default_rng(round_).bytes(len(whole)))
                else:
                    path.write_bytes(whole)
                    await client.request("load", name="run", path="run.npy")
                await asyncio.sleep(0.02)
        async with Client(server) as client:
            path.write_bytes(whole)
            await client.request("load", name="run", path="run.npy")
            await slices_of(client)


async def test_the_field_cache_drops_what_no_session_uses(folder):
    for number in range(4):
        (folder / f"{number}.npy").write_bytes(npy((quadratic(SHAPE) + number).astype("f8")))
    bytes_ = 4 * int(numpy.prod(SHAPE))
    with open_server(folder, *SMALL, "--field-cache", 2 * bytes_ + 100) as server:
        async with Client(server) as one, Client(server) as two:
            for number in (0, 1, 2, 3, 0):
                await one.request("load", name="run", path=f"{number}.npy")
                await slices_of(one)
                server.wait_for(lambda: server.metric("oval4d_field_cache_bytes") <= 2 * bytes_)
            await two.request("load", name="run", path="1.npy")
            with pytest.raises(Refused, match="--field-cache") as refused:
                await two.request("load", name="other", path="2.npy")
            assert refused.value.code == "too_many"
    with open_server(folder, *SMALL, "--field-cache", bytes_ - 1) as server:
        async with Client(server) as client:
            with pytest.raises(Refused, match="--field-cache") as refused:
                await client.request("load", name="run", path="0.npy")
            assert refused.value.code == "too_large"
    with Server("--data", folder, "--field-cache-folder", folder / "absent", *SMALL) as server:
        async with Client(server) as client:
            with pytest.raises(Refused, match="--field-cache-folder"):
                await client.request("load", name="run", path="0.npy")


async def test_stored_sessions_open_their_file_again(folder, tmp_path):
    values = quadratic(SHAPE)
    (folder / "a.npy").write_bytes(npy(values))
    (folder / "b.npy").write_bytes(npy(values.astype("f8")))
    store = ("--store", f"sqlite:{tmp_path / 'sessions.sqlite'}")
    with open_server(folder, *SMALL, *store) as server:
        async with Client(server) as client:
            sessions = client.welcome["session"], client.welcome["token"]
            await client.request("load", name="first", path="a.npy", box=[[-1, 1]] * 4, values="x*y")
            await client.request("load", name="run", path="b.npy", box=[[-2, 2]] * 4)
            await client.request("rotate", planes=["xw"], angles=[0.3])
            expected = await slices_of(client)
    assert (tmp_path / "sessions.sqlite").stat().st_size < values.nbytes
    (folder / "b.npy").rename(folder / "c.npy")
    with open_server(folder, *SMALL, *store) as server:
        with pytest.raises(Refused, match="b.npy") as refused:
            async with Client(server, session=sessions[0], token=sessions[1]):
                pass
        assert refused.value.code == "not_found"
        (folder / "c.npy").rename(folder / "b.npy")
        async with Client(server, session=sessions[0], token=sessions[1]) as client:
            assert await slices_of(client) == expected
            await client.request("set", polytope="first")
            await slices_of(client)


async def test_a_session_whose_field_has_no_room_can_be_opened_later(folder, tmp_path):
    for number in range(2):
        (folder / f"{number}.npy").write_bytes(npy((quadratic(SHAPE) + number).astype("f8")))
    room = 4 * int(numpy.prod(SHAPE)) + 100  # bytes for one of the fields
    options = (*SMALL, "--field-cache", room, "--store", f"sqlite:{tmp_path / 'sessions.sqlite'}")
    with open_server(folder, *options) as server:
        async with Client(server) as client:
            credentials = {"session": client.welcome["session"], "token": client.welcome["token"]}
            await client.request("load", name="run", path="0.npy")
            expected = await slices_of(client)
    with open_server(folder, *options) as server:
        async with Client(server) as other:
            await other.request("load", name="run", path="1.npy")
            assert await hello_refusal(server, **credentials) == ("internal", 1013)
    with open_server(folder, *options, "--data-cache", "1k") as server:  # the field exceeds this limit for now
        assert await hello_refusal(server, **credentials) == ("internal", 1013)
    with open_server(folder, *options) as server:
        async with Client(server, **credentials) as client:
            assert await slices_of(client) == expected


async def test_moments_cannot_be_added_to_a_large_field(folder):
    (folder / "a.npy").write_bytes(npy(quadratic(SHAPE)))
    with open_server(folder, *SMALL) as server:
        async with Client(server) as client:
            await client.request("load", name="run", path="a.npy")
            with pytest.raises(Refused) as refused:
                await client.request("load", name="run", path="a.npy", append=True)
            assert refused.value.code == "too_large"


async def test_second_arrays_of_a_large_file(folder):
    values = quadratic(SHAPE)
    (folder / "two.h5").write_bytes(hdf5(values, "group/v"))
    with open_server(folder, *SMALL) as server:
        async with Client(server) as client:
            await client.request("load", name="run", path="two.h5", variable="group/v", values_variable="group/v")
            state = await client.request("get", what="state")
            assert state["field"]["values"]["variable"] == "group/v"
            assert len(await client.request_frame(**SIZE)) > 1000
            assert json.dumps(await slices_of(client)).count('"colors"') > 0
