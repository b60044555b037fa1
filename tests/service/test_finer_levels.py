"""Multiscale images of the data folder: a coarse level is shown first, and finer ones replace it."""

import os

import pytest
import zarr_files
from array_files import quadratic
from harness import Server
from test_data_folder import slices_of
from wire import Client, credentials_of

VALUES = quadratic((8, 24, 24, 24))  # the sizes of the levels are 432 KiB, 27 KiB and 1.7 KiB
FIRST = ("--first-level-bytes", "4k")


@pytest.fixture(name="folder")
def folder_with_an_image(tmp_path):
    """A data folder with an image of three levels, each of which has the means of 2 × 2 × 2 × 2 samples of the one before."""
    folder = tmp_path / "data"
    values, levels = VALUES, []
    for level in range(3):
        zarr_files.write(folder / "image" / str(level), values, (2, 8, 8, 8), 2, "zstd")
        halves = [part for size in values.shape for part in (size // 2, 2)]
        values = values.reshape(halves).mean((1, 3, 5, 7)).astype("f4")
        levels.append({"path": str(level), "coordinateTransformations": [
            {"type": "scale", "scale": [2**level] * 4}, {"type": "translation", "translation": [(2**level - 1) / 2] * 4}]})
    zarr_files.write_json(folder / "image" / ".zgroup", {"zarr_format": 2})
    zarr_files.write_json(folder / "image" / ".zattrs", {"multiscales": [
        {"version": "0.4", "datasets": levels, "axes": [{"name": axis} for axis in "tzyx"]}]})
    return folder


async def refined(client, revision=0):
    """Waits for a state of this revision, or a newer one, after which no finer level follows. Returns its field."""
    def field():
        newest = client.states()[-1:]
        found = newest[0].get("field", {}) if newest and newest[0]["revision"] >= revision else {}
        return dict(found) if "refining" not in found.get("resolution", {"refining": True}) else None
    return await client.wait_until(field)


async def change_settings(client):
    await client.request("set", levels=[0.25, 0.75], slices={"count": 5, "spacing": 3.5, "focus": 1})
    await client.request("rotate", planes=["xw"], angles=[0.3])


async def test_finer_levels_replace_a_coarse_one_in_place(folder):
    with Server("--data", folder, *FIRST) as server:
        async with Client(server) as client, Client(server) as whole:
            done = await client.request("load", name="run", path="image")
            assert any("of 3 levels, '2' is shown first" in warning for warning in done["warnings"])
            await change_settings(client)
            field = await refined(client, done["revision"])
            assert field.pop("resolution") == {"level": 0, "levels": 3}
            shown = [state["field"]["resolution"]["level"] for state in client.states() if "field" in state]
            assert shown == sorted(shown, reverse=True)
            await whole.request("load", name="run", path="image", variable="0")
            await change_settings(whole)
            state = await whole.request("get", what="state")
            assert field == state["field"]
            assert await slices_of(client) == await slices_of(whole)
            for _ in range(3):  # undoes the rotation, the settings and the load
                await client.request("undo")
            assert (await client.request("get", what="state"))["polytope"]["name"] == "5-cell"
            await client.request("redo")
            assert (await client.request("get", what="state"))["field"]["resolution"] == {"level": 0, "levels": 3}


async def test_levels_and_regions_are_as_fine_as_fits_into_memory(folder):
    with Server("--data", folder, *FIRST, "--max-field-bytes", "64k") as server:
        async with Client(server) as client:
            done = await client.request("load", name="run", path="image")
            assert (await refined(client, done["revision"]))["resolution"] == {"level": 1, "levels": 3}
            done = await client.request("command", line=":region 0,7,0,7,0,7,0,7")
            assert any("is shown first" in warning for warning in done["warnings"])
            field = await refined(client, done["revision"])
            assert field["resolution"] == {"level": 0, "levels": 3} and field["shape"] == [8, 8, 8, 8]
            part = VALUES[:8, :8, :8, :8]
            assert field["range"] == [float(part.min()), float(part.max())]
            await client.request("undo")
            assert (await client.request("get", what="state"))["field"]["resolution"] == {"level": 1, "levels": 3}


async def test_a_level_without_room_does_not_replace_the_one_before(folder):
    with Server("--data", folder, *FIRST, "--data-cache", "300k") as server:
        async with Client(server) as client:
            done = await client.request("load", name="run", path="image")
            assert (await refined(client, done["revision"]))["resolution"] == {"level": 1, "levels": 3}
            await slices_of(client)


async def test_sessions_read_a_level_once(folder):
    with Server("--data", folder, *FIRST) as server:
        async with Client(server) as one, Client(server) as two:
            done = await one.request("load", name="run", path="image")
            await refined(one, done["revision"])
            cached = server.metric("oval4d_data_cache_bytes")
            for path in (folder / "image").glob("[0-2]/*.*.*.*"):  # damages chunks, which look unchanged
                status = path.stat()
                with path.open("r+b") as file:
                    file.write(bytes(status.st_size))
                os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
            done = await two.request("load", name="another name", path="image")
            assert (await refined(two, done["revision"]))["resolution"] == {"level": 0, "levels": 3}
            for each in (one, two):
                await change_settings(each)
            assert await slices_of(one) == await slices_of(two)
            assert server.metric("oval4d_data_cache_bytes") == cached


async def test_restored_sessions_are_refined_again(folder, tmp_path):
    options = ("--data", folder, *FIRST, "--store", f"sqlite:{tmp_path / 'sessions.sqlite'}")
    with Server(*options) as server:
        async with Client(server) as client:
            credentials = credentials_of(client)
            done = await client.request("load", name="run", path="image")
            await refined(client, done["revision"])
            await change_settings(client)
            expected = await slices_of(client)
    assert (tmp_path / "sessions.sqlite").stat().st_size < VALUES.nbytes
    with Server(*options) as server:
        async with Client(server, **credentials) as client:
            assert (await refined(client))["resolution"] == {"level": 0, "levels": 3}
            assert await slices_of(client) == expected
