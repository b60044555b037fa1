"""The folder of arrays that a server offers: what can be opened, what cannot, and how much memory it takes."""

import os

import pytest
from array_clients import SIZE, load, state_of, unnumbered
from array_files import hdf5, netcdf, nifti, npy, quadratic
from harness import Server
from wire import Client, Refused

SECRET = npy(quadratic((2, 3, 4, 5)))


@pytest.fixture(scope="module", name="folder")
def folder_of_arrays(tmp_path_factory):
    root = tmp_path_factory.mktemp("root")
    (root / "secret.npy").write_bytes(SECRET)
    (root / "outside").mkdir()
    (root / "outside" / "t0.npy").write_bytes(npy(quadratic((4, 5, 6))))
    folder = root / "data"
    folder.mkdir()
    for name, body in (("a.npy", npy(quadratic())), ("b.nc", netcdf(quadratic())), ("c.h5", hdf5(quadratic())),
                       ("d.nii", nifti(quadratic())), ("notes.txt", b"hello"), (".hidden.npy", SECRET), ("empty.npy", b""),
                       ("broken.npy", SECRET[:-1]), ("ψ 1.npy", npy(quadratic()))):
        (folder / name).write_bytes(body)
    (folder / "link.npy").symlink_to(root / "secret.npy")
    (folder / "inner link.npy").symlink_to(folder / "a.npy")
    (folder / "linked series").symlink_to(root / "outside")
    for name in ("series", "mixed", "nothing"):
        (folder / name).mkdir()
    values = quadratic()
    for moment in range(len(values)):
        (folder / "series" / f"t{moment}.npy").write_bytes(npy(values[moment]))  # t2 must come before t10
    (folder / "series" / "t0 link.npy").symlink_to(root / "secret.npy")
    (folder / "mixed" / "t0.npy").write_bytes(npy(quadratic((4, 5, 6))))
    (folder / "mixed" / "t1.npy").write_bytes(npy(quadratic((4, 5, 7))))
    os.mkfifo(folder / "pipe.npy")
    return folder


@pytest.fixture(scope="module", name="data_server")
def server_with_data(folder):
    with Server("--data", folder) as server:
        yield server


async def slices_of(client):
    return (await client.request("get", what="slices", **SIZE))["slices"]


async def test_the_catalogue_lists_the_arrays_of_the_folder(data_server):
    async with Client(data_server) as client:
        entries = (await client.request("get", what="catalogue"))["polytopes"]
    names = [entry["name"] for entry in entries if entry["family"] == "data"]
    assert names == ["a.npy", "b.nc", "broken.npy", "c.h5", "d.nii", "mixed", "series", "ψ 1.npy"]
    assert b'"series"' in data_server.get("/api/v1/catalogue").body


@pytest.mark.parametrize("path", ["a.npy", "b.nc", "c.h5", "ψ 1.npy", "series"])
async def test_files_and_series_are_opened_by_name(data_server, path):
    box = [[-1, 1]] * 4
    async with Client(data_server) as client, Client(data_server) as other:
        done = await client.request("load", name="run", path=path, box=box)
        assert done["revision"] == 1
        await load(other, "run", npy(quadratic()), box=box)
        assert await slices_of(client) == await slices_of(other)
        await client.request("set", polytope="24-cell")
        await client.request("set", polytope="run")


@pytest.mark.parametrize("path", [
    "../secret.npy", "..", ".", "/", "", "./a.npy", "series/t0.npy", "series/../a.npy", "/etc/passwd", "link.npy",
    "inner link.npy", "linked series", "linked series/t0.npy", ".hidden.npy", "pipe.npy", "absent.npy", "nothing",
    "a.npy\0", "a.npy/", "%2e%2e/secret.npy", "x" * 300,
])
async def test_nothing_else_can_be_opened(data_server, path):
    async with Client(data_server) as client:
        before = unnumbered(await state_of(client))
        with pytest.raises(Refused) as refused:
            await client.request("load", name="run", path=path)
        assert refused.value.code in ("not_found", "bad_message")
        assert unnumbered(await state_of(client)) == before


@pytest.mark.parametrize("members, code", [
    ({"path": "notes.txt"}, "unsupported_format"), ({"path": "broken.npy"}, "bad_field"),
    ({"path": "mixed"}, "bad_field"), ({"path": "a.npy", "axes": "xyz"}, "out_of_range"),
    ({"path": "a.npy", "data": ""}, "bad_message"), ({"path": "a.npy", "format": "off"}, "unsupported_format"),
    ({}, "bad_message"),
])
async def test_wrong_requests_are_refused(data_server, members, code):
    async with Client(data_server) as client:
        with pytest.raises(Refused) as refused:
            await client.request("load", name="run", **members)
        assert refused.value.code == code


async def test_a_server_without_a_folder_says_so(server):
    async with Client(server) as client:
        with pytest.raises(Refused, match="no data folder"):
            await client.request("load", name="run", path="a.npy")


async def test_sessions_share_a_field_until_the_file_changes(tmp_path):
    values = quadratic((16, 32, 32, 32))  # 2 MiB
    (tmp_path / "run.npy").write_bytes(npy(values))
    with Server("--data", tmp_path, "--data-cache", "5M", "--max-client-bytes", "40M") as server:
        async with Client(server) as one, Client(server) as two:
            for client in (one, two):
                await client.request("load", name="run", path="run.npy")
            # The field counts in the cache. Bytes reserved for a request are freed shortly after its answer.
            server.wait_for(lambda: server.metric("oval4d_client_bytes") < 1 << 20)
            first = await slices_of(one)
            assert first == await slices_of(two)
            (tmp_path / "run.npy").write_bytes(npy(values * 2 + 1))
            await two.request("load", name="run", path="run.npy")
            assert await slices_of(one) == first
            (tmp_path / "third.npy").write_bytes(npy(values))
            with pytest.raises(Refused, match="--data-cache") as refused:  # both versions of the file are in use
                await two.request("load", name="third", path="third.npy")
            assert refused.value.code == "too_many"


async def test_fields_that_nobody_uses_make_room(tmp_path):
    for number in range(8):
        (tmp_path / f"{number}.npy").write_bytes(npy(quadratic((16, 32, 32, 32)) + number))
    with Server("--data", tmp_path, "--data-cache", "9M", "--max-undo", 0) as server:
        async with Client(server) as client:
            for number in (*range(8), 0):
                await client.request("load", name="run", path=f"{number}.npy")
                await client.request("get", what="slices", **SIZE)
