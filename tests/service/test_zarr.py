"""Zarr folders in the data folder: equal to NumPy's files bit for bit; groups; hostile metadata and chunks."""

import asyncio
import json
import os
import time
import zlib

import numpy
import pytest
import zarr_files
from array_files import npy, quadratic
from harness import DEADLINE, Server
from test_data_folder import slices_of
from wire import Client, Refused

SHAPE = (5, 20, 22, 24)
CHUNK = (2, 8, 22, 10)  # some chunks extend beyond the array
BOX = [[-1, 1]] * 4
LARGE = ("--max-field-bytes", "64k")


@pytest.fixture(name="folder")
def empty_folder(tmp_path):
    (tmp_path / "data").mkdir()
    return tmp_path / "data"


@pytest.fixture(name="shared", scope="module")
def server_of_module(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    with Server("--data", folder) as server:
        server.folder = folder
        yield server


async def refusal(server, path, **members):
    async with Client(server) as client:
        with pytest.raises(Refused) as refused:
            await client.request("load", name="run", path=path, **members)
        await slices_of(client)  # the server and the session still work
    return refused.value


async def compare(server, folder, path, values, **members):
    (folder / "same.npy").write_bytes(npy(values))
    async with Client(server) as client:
        await client.request("set", slices={"count": 5})
        await client.request("load", name="run", path="same.npy", box=BOX)
        expected = await client.request("get", what="state"), await slices_of(client)
        await client.request("load", name="zarr", path=path, box=BOX, **members)
        state = await client.request("get", what="state")
        assert state["field"] == expected[0]["field"] and state["levels"] == expected[0]["levels"]
        assert await slices_of(client) == expected[1]


@pytest.mark.parametrize("options", [[], LARGE], ids=["in memory", "on the disk"])
@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("compressor", list(zarr_files.COMPRESSORS), ids=lambda name: name or "uncompressed")
async def test_arrays_are_those_of_numpy(folder, options, version, compressor):
    values = quadratic(SHAPE)
    order = "F" if compressor in ("", "zstd") else "C"
    zarr_files.write(folder / "run.zarr", values, CHUNK, version, compressor, order)
    with Server("--data", folder, "--field-cache-folder", folder.parent, *options) as server:
        await compare(server, folder, "run.zarr", values)


@pytest.mark.parametrize("options", [[], LARGE], ids=["in memory", "on the disk"])
@pytest.mark.parametrize("compressor", ["", "zstd", "blosc"], ids=lambda name: name or "uncompressed")
async def test_chunks_are_read_from_shards(folder, options, compressor):
    values = quadratic(SHAPE)
    values[0:2, 8:16] = 0
    values[4:, :, :, 20:] = 0
    zarr_files.write_shards(folder / "run.zarr", values, (1, 4, 11, 10), (2, 8, 22, 20), compressor)
    with Server("--data", folder, "--field-cache-folder", folder.parent, *options) as server:
        await compare(server, folder, "run.zarr", values)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("type_", ["|b1", "|i1", "|u1", "<i2", ">i2", "<u2", "<i4", ">u4", "<i8", "<u8", "<f2", ">f2", ">f4",
                                   "<f8", ">f8"])
async def test_types_and_byte_orders(shared, version, type_):
    values = (quadratic((3, 9, 10, 11), 1.5) * (1 if type_[1] in "bf" else 40)).clip(0)
    values = values.astype(type_)
    name = f"{version} {type_.replace('|', '').replace('<', 'little ').replace('>', 'big ')}"
    zarr_files.write(shared.folder / name, values, (2, 4, 4, 11), version, separator="/")
    await compare(shared, shared.folder, name, values)


async def test_the_format_may_be_named_with_a_path(shared):
    zarr_files.write(shared.folder / "named", quadratic(SHAPE), CHUNK)
    await compare(shared, shared.folder, "named", quadratic(SHAPE), format="zarr")
    async with Client(shared) as client:
        with pytest.raises(Refused) as refused:
            await client.request("load", name="run", format="zarr", data="AAAA")
    assert refused.value.code == "unsupported_format"


@pytest.mark.parametrize("version", [2, 3])
async def test_missing_chunks_have_the_fill_value(shared, version):
    values = quadratic(SHAPE)
    for fill, number in ((0.5, 0.5), ("NaN", numpy.nan), (0, 0), ("-Infinity", numpy.nan)):
        filled = values.copy()
        filled[0:2, 8:16, :, 10:20] = number
        filled[4:, 16:, :, 20:] = number
        name = f"fill {version} {fill}"
        zarr_files.write(shared.folder / name, values, CHUNK, version, "gzip", fill=fill, skipped={(0, 1, 0, 1), (2, 2, 0, 2)})
        await compare(shared, shared.folder, name, filled)


@pytest.mark.parametrize("version", [2, 3])
async def test_chunks_that_have_changed_are_read_again(shared, version):
    values = quadratic(SHAPE)
    name = f"changed {version}"
    zarr_files.write(shared.folder / name, values, SHAPE, version, separator="/")
    chunk = shared.folder / name / ("c" if version == 3 else "") / "0/0/0/0"
    async with Client(shared) as client:
        ranges = []
        for factor in (1, 2):
            chunk.write_bytes((values * factor).astype(values.dtype).tobytes())
            os.utime(chunk, ns=(factor, factor))  # two writes may otherwise have the same time
            await client.request("load", name="run", path=name, box=BOX)
            ranges.append((await client.request("get", what="state"))["field"]["range"])
    assert ranges[1] == pytest.approx([2 * end for end in ranges[0]])


@pytest.mark.parametrize("version", [2, 3])
async def test_names_of_dimensions_and_attributes(shared, version):
    values = quadratic((4, 6, 8, 10))
    packed = numpy.rint(values * 1000).astype("<i2")
    name = f"group {version}"
    root = shared.folder / name
    zarr_files.write(root / "p", numpy.ascontiguousarray(packed.transpose(3, 2, 1, 0)), (10, 8, 3, 2), version,
                     names=["x", "y", "z", "time"], attributes={"scale_factor": 0.5, "add_offset": 2, "units": "Pa"})
    members = ["p"]
    for axis, (size, first, step) in {"time": (4, 1000, 60), "x": (10, 0, 0.5), "y": (8, 7, -1), "z": (6, 1, 1)}.items():
        at = first + step * numpy.arange(size)
        zarr_files.write(root / axis, at.astype("<i8" if axis == "time" else "<f8"), (3,), version, "zlib", names=[axis])
        members.append(axis)
    if version == 2:
        zarr_files.write_json(root / ".zgroup", {"zarr_format": 2})
        zarr_files.write_json(root / ".zmetadata", {"metadata": {f"{m}/.zarray": {} for m in members}})
    else:
        zarr_files.write_json(root / "zarr.json", {
            "zarr_format": 3, "node_type": "group", "consolidated_metadata": {"metadata": {
                m: {"node_type": "array"} for m in members}}})
    async with Client(shared) as client:
        for extra in ({}, {"variable": "p"}, {"variable": "/p"}):
            await client.request("load", name="run", path=name, **extra)
            field = (await client.request("get", what="state"))["field"]
            assert field["shape"] == [10, 8, 6, 4]
            assert field["box"] == [[0, 4.5], [0, 7], [1, 6], [1000, 1180]]
            assert field["range"] == [float(packed.min()) * 0.5 + 2, float(packed.max()) * 0.5 + 2]
            assert field["quantity"] == {"name": "p", "unit": "Pa"} and "units" not in field
        refused = await refusal(shared, name, variable="q")
        assert refused.code == "not_found"


@pytest.mark.parametrize("version", [2, 3])
async def test_multiscale_images_show_their_finest_level(shared, version):
    values = quadratic((3, 8, 16, 16))
    name = f"image {version}"
    root = shared.folder / name
    for level, part in enumerate((values, values[:, ::2, ::2, ::2])):
        zarr_files.write(root / str(level), numpy.ascontiguousarray(part[:, None]), (1, 1, 4, 8, 8), version, "zstd", separator="/")
    scales = [{"path": str(level), "coordinateTransformations": [
        {"type": "scale", "scale": [60, 1, 2 * 2**level, 0.5 * 2**level, 0.5 * 2**level]}]} for level in range(2)]
    image = {"multiscales": [{"version": "0.4", "datasets": scales, "axes": [
        {"name": "t", "type": "time", "unit": "second"}, {"name": "c", "type": "channel"},
        *({"name": a, "type": "space", "unit": "micrometer"} for a in "zyx")]}]}
    if version == 2:
        zarr_files.write_json(root / ".zgroup", {"zarr_format": 2})
        zarr_files.write_json(root / ".zattrs", image)
    else:
        zarr_files.write_json(root / "zarr.json", {"zarr_format": 3, "node_type": "group", "attributes": {"ome": image}})
    async with Client(shared) as client:
        await client.request("load", name="run", path=name)
        field = (await client.request("get", what="state"))["field"]
        assert field["shape"] == [16, 16, 8, 3]
        assert field["box"] == [[0, 7.5], [0, 7.5], [0, 14], [0, 120]]
        await client.request("load", name="coarse", path=name, variable="1")
        field = (await client.request("get", what="state"))["field"]
        assert field["shape"] == [8, 8, 4, 3]
        assert field["box"] == [[0, 7], [0, 7], [0, 12], [0, 120]]


def write_image(root, values, chunk, version):
    """Writes an image of two levels, the second of which has the means of 2 × 2 × 2 × 2 samples. Returns these means."""
    halves = [part for size in values.shape for part in (size // 2, 2)]
    means = values.reshape(halves).mean((1, 3, 5, 7)).astype("f4")
    for level, part in enumerate((values, means)):
        zarr_files.write(root / str(level), part, chunk, version, "zstd")
    levels = [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1] * 4}]},
              {"path": "1", "coordinateTransformations": [{"type": "scale", "scale": [2] * 4},
                                                          {"type": "translation", "translation": [0.5] * 4}]}]
    image = {"multiscales": [{"version": "0.4", "datasets": levels, "axes": [{"name": axis} for axis in "tzyx"]}]}
    if version == 2:
        zarr_files.write_json(root / ".zgroup", {"zarr_format": 2})
        zarr_files.write_json(root / ".zattrs", image)
    else:
        zarr_files.write_json(root / "zarr.json", {"zarr_format": 3, "node_type": "group", "attributes": {"ome": image}})
    return means


async def field_of(client):
    return (await client.request("get", what="state"))["field"]


@pytest.mark.parametrize("version", [2, 3])
async def test_an_image_larger_than_memory_opens_by_a_coarser_level(folder, version):
    values = quadratic((8, 24, 24, 24))
    means = write_image(folder / "image", values, (2, 8, 8, 8), version)
    with Server("--data", folder, "--field-cache-folder", folder.parent, "--max-undo", 0, *LARGE) as server:
        async with Client(server) as client:
            done = await client.request("load", name="run", path="image")
            assert any("of 2 levels, '1' is shown, the finest one" in warning for warning in done["warnings"])
            field = await field_of(client)
            assert field["shape"] == [12, 12, 12, 4] and field["box"] == [[0.5, 22.5]] * 3 + [[0.5, 6.5]]
            assert field["resolution"] == {"level": 1, "levels": 2} and "region" not in field
            assert field["range"] == [float(means.min()), float(means.max())]
            assert server.metric("oval4d_field_cache_bytes") == 0
            await client.request("load", name="fine", path="image", variable="0")
            assert (await field_of(client))["shape"] == [24, 24, 24, 8]
            assert server.metric("oval4d_field_cache_bytes") == values.nbytes


@pytest.mark.parametrize("version", [2, 3])
async def test_a_region_is_read_from_its_own_chunks(folder, tmp_path, version):
    values = quadratic((8, 24, 24, 24))
    write_image(folder / "image", values, (2, 8, 8, 8), version)
    needed = [folder / "image" / "0" / name for name in (("1.1.0.0", "1.1.0.1") if version == 2 else ("c/1/1/0/0", "c/1/1/0/1"))]
    for path in (folder / "image" / "0").rglob("*"):
        if path.is_file() and path not in needed and not path.name.startswith((".z", "zarr.json")):
            path.write_bytes(b"damaged")
    (folder / "part.npy").write_bytes(npy(values[3:4, 8:16, 0:8, 2:10]))
    options = ("--data", folder, "--field-cache-folder", folder.parent, "--store", f"sqlite:{tmp_path / 'sessions.sqlite'}", *LARGE)
    with Server(*options) as server:
        async with Client(server) as client:
            credentials = {"session": client.welcome["session"], "token": client.welcome["token"]}
            await client.request("load", name="run", path="part.npy", box=[[2, 9], [0, 7], [8, 15], [3, 3]])
            region = [[2.5, 9], [-5, 7], [8, 15], [3.1, 3.1]]
            part = {"region": region, "resolution": {"level": 0, "levels": 2}}
            expected = await field_of(client) | part, await slices_of(client)
            await client.request("load", name="run", path="image", region=region)
            assert (await field_of(client), await slices_of(client)) == expected
            await client.request("load", name="run", path="image")
            overview = await field_of(client)
            assert overview["shape"] == [12, 12, 12, 4]
            await client.request("command", line=":region 2.5,9,-5,7,8,15,3.1,3.1")
            assert (await field_of(client), await slices_of(client)) == expected
            await client.request("command", line=":region all")
            assert await field_of(client) == overview
            await client.request("undo")
        assert (await refusal(server, "image", variable="0")).code == "bad_field"
    with Server(*options) as server:
        async with Client(server, **credentials) as client:
            assert (await field_of(client), await slices_of(client)) == expected


async def test_a_region_of_ten_terabytes_is_read(shared):
    root = shared.folder / "ten terabytes"
    zarr_files.write_json(root / ".zarray", GOOD | {"shape": [1000, 1536, 1280, 1280], "chunks": [1, 64, 64, 64]})
    (root / "700.20.3.2").write_bytes(numpy.full(64**3, 5, "<f4").tobytes())
    async with Client(shared) as client:
        await client.request("load", name="run", path=root.name, box=[[0, 1279], [0, 1279], [0, 1535], [0, 999]],
                             region=[[100, 200], [180, 260], [1270, 1350], [699, 701]])
        field = await field_of(client)
        assert field["shape"] == [101, 81, 81, 3] and field["range"] == [0, 5]
        assert field["box"] == [[100, 200], [180, 260], [1270, 1350], [699, 701]]


@pytest.mark.parametrize("members, code, says", [
    ({"path": "f", "region": [[5, 6], [-1, 1], [-1, 1], [-1, 1]]}, "out_of_range", "along x from −1 to 1"),
    ({"path": "f", "region": [[0, 1], [1, 0], [-1, 1], [-1, 1]]}, "out_of_range", "region along y are in the wrong order"),
    ({"path": "f", "region": [[0, 1]]}, "bad_message", "region"),
    ({"path": "f.npy", "region": BOX}, "unsupported_format", "only Zarr folders"),
    ({"format": "formula", "data": "x", "region": BOX}, "bad_message", "data folder"),
])
async def test_other_regions_are_refused(shared, members, code, says):
    zarr_files.write(shared.folder / "f", quadratic(SHAPE), CHUNK)
    (shared.folder / "f.npy").write_bytes(npy(quadratic(SHAPE)))
    async with Client(shared) as client:
        with pytest.raises(Refused, match=says) as refused:
            await client.request("load", name="run", **members)
        assert refused.value.code == code


async def test_the_catalogue_lists_zarr_folders(shared):
    zarr_files.write(shared.folder / "listed.zarr", quadratic(SHAPE), CHUNK)
    (shared.folder / "not zarr").mkdir()
    (shared.folder / "not zarr" / "0.0").write_bytes(b"0")

    async def listed():
        async with Client(shared) as client:
            entries = (await client.request("get", what="catalogue"))["polytopes"]
        return [entry["name"] for entry in entries if entry["family"] == "data"]

    limit = time.monotonic() + DEADLINE
    while "listed.zarr" not in (names := await listed()):  # the server reads the folder only from time to time
        assert time.monotonic() < limit
        await asyncio.sleep(0.1)
    assert "not zarr" not in names


GOOD = {"zarr_format": 2, "shape": [4, 4], "chunks": [2, 4], "dtype": "<f4", "order": "C", "filters": None,
        "fill_value": 0, "compressor": None}
GOOD3 = {"zarr_format": 3, "node_type": "array", "shape": [4, 4], "data_type": "float32", "fill_value": 0,
         "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [2, 4]}},
         "chunk_key_encoding": {"name": "default"}, "codecs": [{"name": "bytes", "configuration": {"endian": "little"}}]}
SHARDS = {"chunk_shape": [1, 2], "codecs": GOOD3["codecs"], "index_codecs": [*GOOD3["codecs"], {"name": "crc32c"}]}  # in GOOD3


@pytest.mark.parametrize("changes, code", [
    ({"shape": [0, 4]}, "bad_field"), ({"shape": [2**62, 4]}, "bad_field"), ({"shape": [-4, 4]}, "bad_field"),
    ({"shape": [4.5, 4]}, "bad_field"), ({"shape": "4"}, "bad_field"), ({"shape": []}, "bad_field"), ({"shape": [4] * 5}, "bad_field"),
    ({"shape": [2**24, 2**16], "chunks": [2**24, 2**16]}, "too_large"), ({"shape": [2**24, 2**15], "chunks": [1, 1]}, "too_large"),
    ({"shape": [4] * 40}, "bad_field"), ({"chunks": [0, 4]}, "bad_field"), ({"chunks": [2]}, "bad_field"),
    ({"chunks": [2**40, 2**40]}, "too_large"), ({"chunks": None}, "bad_field"), ({"dtype": "<f16"}, "unsupported_format"),
    ({"dtype": [["a", "<f4"]]}, "unsupported_format"), ({"dtype": "<c8"}, "unsupported_format"), ({"dtype": "|O"}, "unsupported_format"),
    ({"order": "X"}, "bad_field"), ({"filters": [{"id": "delta"}]}, "unsupported_format"),
    ({"compressor": {"id": "lzma"}}, "unsupported_format"), ({"compressor": "zlib"}, "unsupported_format"),
    ({"zarr_format": 1}, "bad_field"), ({"fill_value": {}}, "bad_field"), ({"dimension_separator": "../"}, "bad_field"),
    ({"dimension_separator": "/../../"}, "bad_field"),
])
async def test_hostile_metadata_are_refused(shared, changes, code):
    zarr_files.write_json(shared.folder / "hostile" / ".zarray", GOOD | changes)
    refused = await refusal(shared, "hostile")
    assert refused.code == code, str(refused)


@pytest.mark.parametrize("changes, code", [
    ({"shape": [0, 4]}, "bad_field"), ({"data_type": "complex64"}, "unsupported_format"), ({"data_type": {"name": "r8"}}, "unsupported_format"),
    ({"chunk_grid": {"name": "rectilinear"}}, "unsupported_format"), ({"codecs": []}, "bad_field"), ({"codecs": None}, "bad_field"),
    *(({"codecs": [{"name": "sharding_indexed", "configuration": SHARDS | change}, *others]}, code) for change, others, code in [
        ({}, [{"name": "gzip"}], "unsupported_format"), ({"chunk_shape": None}, [], "bad_field"), ({"chunk_shape": [2]}, [], "bad_field"),
        ({"chunk_shape": [0, 4]}, [], "bad_field"), ({"chunk_shape": [1, 3]}, [], "bad_field"), ({"chunk_shape": [4, 4]}, [], "bad_field"),
        ({"index_location": "middle"}, [], "bad_field"), ({"index_codecs": None}, [], "unsupported_format"),
        ({"index_codecs": [{"name": "gzip"}]}, [], "unsupported_format"), ({"index_codecs": ["bytes"]}, [], "bad_field"),
        ({"codecs": [{"name": "sharding_indexed", "configuration": {}}]}, [], "unsupported_format"), ({"codecs": []}, [], "bad_field")]),
    ({"codecs": [{"name": "sharding_indexed"}]}, "bad_field"),
    ({"chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [2**20, 2**20]}},
      "codecs": [{"name": "sharding_indexed", "configuration": {"chunk_shape": [1, 1]}}]}, "too_large"),
    ({"codecs": GOOD3["codecs"] + [{"name": "gzip"}] * 2}, "unsupported_format"),
    ({"codecs": [{"name": "transpose", "configuration": {"order": [0, 0]}}, *GOOD3["codecs"]]}, "bad_field"),
    ({"codecs": [{"name": "transpose", "configuration": {"order": [1, 2]}}, *GOOD3["codecs"]]}, "bad_field"),
    ({"chunk_key_encoding": {"name": "../x"}}, "unsupported_format"), ({"fill_value": "0xzz"}, "bad_field"),
    ({"chunk_key_encoding": {"name": "default", "configuration": {"separator": "/../"}}}, "bad_field"),
    ({"node_type": "group"}, "out_of_range"), ({"zarr_format": 2}, "bad_field"),
])
async def test_hostile_metadata_of_version_3_are_refused(shared, changes, code):
    zarr_files.write_json(shared.folder / "hostile 3" / "zarr.json", GOOD3 | changes)
    refused = await refusal(shared, "hostile 3")
    assert refused.code == code, str(refused)


@pytest.mark.parametrize("text", ["", "{", "[]", "null", pytest.param('{"a":' * 5000, id="deep"), "\x00", '{"shape": NaN}', '"'])
async def test_metadata_that_are_not_json_are_refused(shared, text):
    (shared.folder / "text").mkdir(exist_ok=True)
    (shared.folder / "text" / "zarr.json").write_text(text)
    assert (await refusal(shared, "text")).code in ("bad_field", "out_of_range")


@pytest.mark.parametrize("variable", ["../secret", "..", "a/../../secret", "/../secret", "./../secret", "link", "a//b", "\0", "a/"])
async def test_no_file_outside_of_the_folder_is_read(folder, variable):
    zarr_files.write(folder.parent / "secret", quadratic(SHAPE), CHUNK)
    zarr_files.write_json(folder / "group" / ".zgroup", {"zarr_format": 2})
    (folder / "group" / "link").symlink_to(folder.parent / "secret")
    zarr_files.write(folder / "group" / "linked", quadratic((4, 4)), (4, 4))
    (folder / "group" / "linked" / "0.0").unlink()
    (folder / "group" / "linked" / "0.0").symlink_to(folder.parent / "secret" / "0.0.0.0")
    zarr_files.write_json(folder / "group" / ".zattrs", {"multiscales": [{"datasets": [{"path": "../../secret"}]}]})
    with Server("--data", folder) as server:
        for members in ({"variable": variable}, {}):
            refused = await refusal(server, "group", **members)
            assert refused.code in ("out_of_range", "not_found", "bad_message", "bad_field"), str(refused)
        async with Client(server) as client:  # a symbolic link counts as a missing chunk
            await client.request("load", name="run", path="group", variable="linked")
            assert (await client.request("get", what="state"))["field"]["range"] == [0, 0]


@pytest.mark.parametrize("compressor", list(zarr_files.COMPRESSORS), ids=lambda name: name or "uncompressed")
async def test_damaged_chunks_are_refused(shared, compressor):
    values = quadratic((4, 8, 8, 8))
    folder = shared.folder / f"damaged {compressor}"
    zarr_files.write(folder, values, (4, 8, 8, 8), 2, compressor)
    chunk = (folder / "0.0.0.0").read_bytes()
    pack = zarr_files.COMPRESSORS[compressor]
    damaged = [b"", chunk[:-1], chunk[: len(chunk) // 2], chunk[:3], pack(values.tobytes()[:-4]), pack(values.tobytes() + b"1234"),
               pack(bytes(100_000_000)) if compressor else bytes(1_000_000)]  # expands to much more than a chunk
    for each in damaged:
        (folder / "0.0.0.0").write_bytes(each)
        refused = await refusal(shared, folder.name)
        assert refused.code == "bad_field" and "0.0.0.0" in str(refused), (len(each), str(refused))
    random = numpy.random.default_rng(1)
    for _ in range(30):
        noisy = bytearray(chunk)
        for place in random.integers(0, len(noisy), 3):
            noisy[place] ^= 1 << int(random.integers(0, 8))
        (folder / "0.0.0.0").write_bytes(noisy)
        async with Client(shared) as client:
            try:
                await client.request("load", name="run", path=folder.name)
            except Refused as refused:
                assert refused.code in ("bad_field",), str(refused)


async def test_zlib_streams_with_a_tail_are_refused(shared):
    values = quadratic((2, 4, 4, 4))
    folder = shared.folder / "tail"
    zarr_files.write(folder, values, values.shape, 2, "zlib")
    (folder / "0.0.0.0").write_bytes(zlib.compress(values.tobytes())[:-2] + b"xx")  # has a wrong checksum
    assert (await refusal(shared, "tail")).code == "bad_field"


async def test_a_sparse_array_is_read_chunk_by_chunk(folder):
    """An array of 4 GB of which one chunk exists; the reader process may take 128 MB."""
    zarr_files.write_json(folder / "sparse" / ".zarray", GOOD | {"shape": [8, 512, 512, 512], "chunks": [1, 128, 512, 512]})
    (folder / "sparse" / "4.2.0.0").write_bytes(numpy.ones((128, 512, 512), "<f4").tobytes())
    with Server("--data", folder, "--field-cache-folder", folder.parent, "--load-memory", "128M") as server:
        async with Client(server) as client:
            await client.request("load", name="run", path="sparse")
            field = (await client.request("get", what="state"))["field"]
            assert field["shape"] == [512, 512, 512, 8] and field["range"] == [0, 1] and field["estimated"] is True
            assert server.metric("oval4d_field_cache_bytes") == 4 * 8 * 512**3
        assert json.loads((folder / "sparse" / ".zarray").read_text())["chunks"] == [1, 128, 512, 512]
