"""Zarr arrays in an object store: equal to those of a folder; only what is needed is requested; stores that fail."""

import collections
import contextlib
import http.server
import json
import re
import subprocess
import threading
from urllib.parse import unquote

import pytest
import zarr_files
from array_files import quadratic
from harness import PROGRAM, Server, free_port
from test_data_folder import slices_of
from wire import Client, Refused, credentials_of, hello_refusal

SHAPE = (5, 20, 22, 24)
CHUNK = (2, 8, 22, 10)
BOX = [[0, 23], [0, 21], [0, 19], [0, 4]]  # the coordinates of samples equal their indices
SHARD_INDEX = 16 * 2**4 + 4
CHUNK_OF_SHARD = 4 * 4 * 11 * 10  # bytes in a chunk of a shard


class Store:
    """An HTTP server on this machine that answers GET with Range from `objects`, a dictionary from paths to bytes.
    `requests` are the paths and the ranges that were asked for. `faults` maps paths to functions that answer instead,
    with the handler as argument."""

    def __init__(self):
        self.objects, self.requests, self.faults = {}, [], {}
        store = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                path = unquote(self.path)
                store.requests.append((path, self.headers["Range"]))
                if path in store.faults:
                    store.faults[path](self)
                elif path not in store.objects:
                    self.answer(404, b"none")
                else:
                    self.answer_with_object(store.objects[path])

            def answer_with_object(self, content):
                if not self.headers["Range"]:
                    self.answer(200, content)
                    return
                first, last = re.fullmatch(r"bytes=(\d*)-(\d*)", self.headers["Range"]).groups()
                begin = int(first) if first else max(0, len(content) - int(last))
                end = min(len(content), int(last) + 1) if first and last else len(content)
                if begin >= len(content):
                    self.answer(416)
                else:
                    self.answer(206, content[begin:end], {"Content-Range": f"bytes {begin}-{end - 1}/{len(content)}"})

            def answer(self, status, content=b"", headers=()):
                self.send_response(status)
                for name, value in {"Content-Length": len(content), **dict(headers)}.items():
                    self.send_header(name, str(value))
                self.end_headers()
                self.wfile.write(content)

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self.server.server_port}/runs"

    def add(self, folder):
        """Adds the files in a folder, under /runs."""
        for path in folder.rglob("*"):
            if path.is_file():
                self.objects[f"/runs/{path.relative_to(folder)}"] = path.read_bytes()

    def chunk_requests(self):
        """Returns the requests for chunks and shards, without those for metadata."""
        return [(path, range_) for path, range_ in self.requests
                if not path.rsplit("/", 1)[1].startswith(".") and not path.endswith(".json")]

    @contextlib.contextmanager
    def running(self):
        thread = threading.Thread(target=self.server.serve_forever)
        thread.start()
        try:
            yield self
        finally:
            self.server.shutdown()
            self.server.server_close()
            thread.join()


@pytest.fixture(name="store")
def running_store():
    with Store().running() as store:
        yield store


def open_server(url, *options):
    return Server("--data", url, *options, no_proxy="*")


def write_whole(folder, version=2):
    zarr_files.write(folder / "run.zarr", quadratic(SHAPE), CHUNK, version, "zstd")


def write_shards(folder):
    values = quadratic(SHAPE)
    assert values[0, :4, :11, :10].any()
    zarr_files.write_shards(folder / "run.zarr", values, (1, 4, 11, 10), (2, 8, 22, 20))


async def field_and_slices(server, **members):
    async with Client(server) as client:
        await client.request("set", slices={"count": 5})
        await client.request("load", name="run", path="run.zarr", box=BOX, **members)
        return (await client.request("get", what="state"))["field"], await slices_of(client)


async def refusal(server, path="run.zarr", **members):
    async with Client(server) as client:
        with pytest.raises(Refused) as refused:
            await client.request("load", name="run", path=path, **members)
        await slices_of(client)  # the server and the session still work
    return refused.value


@pytest.mark.parametrize("members", [{}, {"format": "zarr", "region": [[3, 12], [2, 20], [7, 9], [1, 3]]}], ids=["all", "region"])
@pytest.mark.parametrize("write", [write_whole, lambda folder: write_whole(folder, 3), write_shards],
                         ids=["version 2", "version 3", "shards"])
async def test_arrays_are_those_of_a_folder(store, tmp_path, write, members):
    write(tmp_path)
    store.add(tmp_path)
    with Server("--data", tmp_path) as server:
        expected = await field_and_slices(server, **members)
    with open_server(store.url) as server:
        assert await field_and_slices(server, **members) == expected
    assert max(collections.Counter(store.requests).values()) == 1, "nothing is requested twice"


async def test_missing_chunks_have_the_fill_value(store, tmp_path):
    zarr_files.write(tmp_path / "run.zarr", quadratic(SHAPE), CHUNK, fill=0.5, skipped={(0, 1, 0, 1), (2, 2, 0, 2)})
    store.add(tmp_path)
    with Server("--data", tmp_path) as server:
        expected = await field_and_slices(server)
    with open_server(store.url) as server:
        assert await field_and_slices(server) == expected
    assert ("/runs/run.zarr/0.1.0.1", None) in store.requests


async def test_only_the_chunks_of_a_region_are_requested(store, tmp_path):
    write_whole(tmp_path)
    store.add(tmp_path)
    with open_server(store.url + "/") as server:
        await field_and_slices(server, region=[[0, 9], [0, 21], [8, 15], [2, 3]])
    assert store.chunk_requests() == [("/runs/run.zarr/1.1.0.0", None)]


async def test_only_the_needed_ranges_of_shards_are_requested(store, tmp_path):
    write_shards(tmp_path)
    store.add(tmp_path)
    with open_server(store.url) as server:
        await field_and_slices(server, region=[[0, 9], [0, 10], [0, 3], [0, 0]])
    shard = "/runs/run.zarr/c/0/0/0/0"
    assert store.chunk_requests() == [(shard, f"bytes=-{SHARD_INDEX}"), (shard, f"bytes=0-{CHUNK_OF_SHARD - 1}")]


async def test_sessions_share_a_field_until_its_metadata_change(store, tmp_path):
    write_whole(tmp_path)
    store.add(tmp_path)
    with open_server(store.url) as server:
        first, _ = await field_and_slices(server)
        count = len(store.chunk_requests())
        await field_and_slices(server)
        assert len(store.chunk_requests()) == count
        zarr_files.write(tmp_path / "run.zarr", 2 * quadratic(SHAPE), CHUNK, compressor="zlib")
        store.add(tmp_path)
        second, _ = await field_and_slices(server)
    assert second["range"] == pytest.approx([2 * end for end in first["range"]])


async def test_no_other_address_can_be_requested(store, tmp_path):
    write_whole(tmp_path)
    store.add(tmp_path)
    store.objects["/secret.zarr/zarr.json"] = store.objects["/runs/run.zarr/.zarray"]
    names = ["../secret.zarr", "..", ".", "%2e%2e/secret.zarr", "/secret.zarr", "run.zarr/0", store.url, "//127.0.0.1/x",
             "no.zarr", "a?b#c"]
    with open_server(store.url) as server:
        for name in names:
            assert (await refusal(server, name)).code == "not_found"
        for variable in ("../../secret.zarr", "..", "http://127.0.0.1/x"):
            assert (await refusal(server, variable=variable)).code == "out_of_range"
    assert {path.rsplit("/", 1)[0] for path, _ in store.requests} == {"/runs/run.zarr", "/runs/no.zarr", "/runs/a?b#c"}


@pytest.mark.parametrize("status", [301, 302, 307, 308])
async def test_redirects_are_refused(store, tmp_path, status):
    write_whole(tmp_path)
    with Store().running() as other:
        other.add(tmp_path)
        for path in other.objects:
            store.faults[path] = lambda handler: handler.answer(status, headers={"Location": other.url + handler.path[5:]})
        with open_server(store.url) as server:
            refused = await refusal(server)
            assert refused.code == "internal" and "redirects are not followed" in str(refused)
        store.add(tmp_path)
        chunk = "/runs/run.zarr/1.1.0.0"
        store.faults = {chunk: store.faults[chunk]}
        with open_server(store.url) as server:
            assert "redirects are not followed" in str(await refusal(server))
        assert other.requests == []


def stop_early(handler):
    handler.send_response(200)
    handler.send_header("Content-Length", "1000")
    handler.end_headers()
    handler.wfile.write(b"x" * 10)
    handler.close_connection = True


FAULTS = {
    "refuses access (status 403)": lambda handler: handler.answer(403, b"denied"),
    "try again later": lambda handler: handler.answer(503, b"busy"),
    "before the whole answer": stop_early,
    "not expected (status 204)": lambda handler: handler.answer(204),
    "must support ranges": lambda handler: handler.answer(200, b"x" * 100_000),
    "wrong length": lambda handler: handler.answer(206, b"x" * 10, {"Content-Range": "bytes 0-9/100000"}),
}


@pytest.mark.parametrize("message", FAULTS)
async def test_stores_that_fail_are_named(store, tmp_path, message):
    ranges = message in ("must support ranges", "wrong length")
    (write_shards if ranges else write_whole)(tmp_path)
    store.add(tmp_path)
    store.faults["/runs/run.zarr/c/0/0/0/0" if ranges else "/runs/run.zarr/1.1.0.0"] = FAULTS[message]
    with open_server(store.url) as server:
        refused = await refusal(server)
        assert refused.code == "internal" and message in str(refused) and "--data" in str(refused)
        assert "an object was not read" in server.log()
        store.faults.clear()
        await field_and_slices(server)


async def test_a_store_that_is_down_is_an_error():
    with open_server(f"http://127.0.0.1:{free_port()}/runs") as server:
        refused = await refusal(server)
        assert refused.code == "internal" and "its host cannot be reached" in str(refused)
        async with Client(server) as client:
            entries = (await client.request("get", what="catalogue"))["polytopes"]
            assert "data" not in {entry["family"] for entry in entries}


async def test_a_store_that_does_not_answer_is_an_error(store):
    ended = threading.Event()
    store.faults["/runs/run.zarr/zarr.json"] = lambda handler: ended.wait()
    try:
        with open_server(store.url, "--data-timeout", 0.1) as server:
            refused = await refusal(server)
            assert refused.code == "internal" and "--data-timeout" in str(refused)
    finally:
        ended.set()


@pytest.mark.parametrize("write", [write_whole, write_shards], ids=["whole", "shards"])
async def test_large_objects_are_refused(store, tmp_path, write):
    write(tmp_path)
    store.add(tmp_path)
    store.objects["/runs/run.zarr/1.1.0.0"] = bytes(5000)
    with open_server(store.url, "--max-data-object", 1500) as server:
        refused = await refusal(server)
    assert refused.code == "too_large" and "--max-data-object" in str(refused)


async def test_damaged_shards_are_refused(store, tmp_path):
    write_shards(tmp_path)
    store.add(tmp_path)
    shard = "/runs/run.zarr/c/0/0/0/0"
    whole = store.objects[shard]
    with open_server(store.url) as server:
        for damaged, message in ((b"", "shorter than its index"), (whole[:100], "shorter than its index"),
                                 (whole[:-1] + b"x", "checksum"), (whole[-SHARD_INDEX:], "beyond its end")):
            store.objects[shard] = damaged
            refused = await refusal(server)
            assert refused.code == "bad_field" and message in str(refused)


async def test_the_catalogue_lists_the_names_in_the_index(store, tmp_path):
    write_whole(tmp_path)
    store.add(tmp_path)
    store.objects["/runs/index.json"] = json.dumps(["run.zarr", "../x", ".hidden", 5, "ψ 1"]).encode()
    with open_server(store.url) as server:
        async with Client(server) as client:
            entries = (await client.request("get", what="catalogue"))["polytopes"]
        assert [entry["name"] for entry in entries if entry["family"] == "data"] == ["run.zarr", "ψ 1"]


async def test_sessions_outlast_a_store_that_is_down(store, tmp_path):
    (tmp_path / "data").mkdir()
    write_whole(tmp_path / "data")
    store.add(tmp_path / "data")
    options = ("--store", f"sqlite:{tmp_path / 'sessions.sqlite'}")
    with open_server(store.url, *options) as server:
        async with Client(server) as client:
            credentials = credentials_of(client)
            await client.request("load", name="run", path="run.zarr", box=BOX, region=[[0, 9], [0, 21], [0, 7], [0, 1]])
            expected = await slices_of(client)
    store.faults["/runs/run.zarr/zarr.json"] = lambda handler: handler.answer(503)
    with open_server(store.url, *options) as server:
        assert await hello_refusal(server, **credentials) == ("internal", 1013)
        store.faults.clear()
        async with Client(server, **credentials) as client:
            assert await slices_of(client) == expected


@pytest.mark.parametrize("address", ["s3://bucket/runs", "ftp://127.0.0.1/", "https://", "https://me:secret@127.0.0.1/",
                                     "https://127.0.0.1/?list", "https://127.0.0.1/#part"])
def test_addresses_that_are_not_valid_are_refused(address):
    ended = subprocess.run([PROGRAM, "--port", "0", "--data", address], capture_output=True, text=True, check=False)
    assert ended.returncode != 0 and "--data" in ended.stderr
    assert "secret" not in ended.stderr
