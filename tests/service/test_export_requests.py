"""Requests of exported files: which are refused, the limits, and what does not wait for a long file."""

import asyncio
import contextlib
import http.client
import time

import pytest
from exports import TABLE, export_refusal, fetch_file
from harness import Server, run_oval4d
from test_pacing import open_nonreading_socket
from wire import Client, Refused


@pytest.mark.parametrize("query, code, expected_text", [
    ("focus=90", "no_body", "is empty"), ("of=all", "bad_message", "focus"), ("body=wood", "bad_message", "skeleton"),
    ("size=0.5", "out_of_range", "from 1 to 10000 millimeters"), ("size=thick", "out_of_range", "thick"),
    ("size=nan", "out_of_range", "nan"),
    ("label=gold", "bad_message", "engraved"), ("width=30", "unknown_command", "width is a parameter of pictures"),
    ("rotat=xw:1", "unknown_command", "did you mean 'rotate'?"), ("lable=none", "unknown_command", "did you mean 'label'?"),
    ("focus=90", "no_body", "extends from w = −"),
    ("polytope=25-cell", "unknown_polytope", "24-cell"),
])
def test_invalid_export_parameters_are_explained(server, query, code, expected_text):
    error = export_refusal(server, "stl", query)
    assert error["code"] == code and expected_text in error["message"]
    done = run_oval4d("export", "-o", "-", "--format", "stl", *("--" + part for part in query.split("&")))
    assert done.returncode == 1 and expected_text.encode() in done.stderr and not done.stdout


def test_export_command_lists_the_formats(tmp_path):
    for words in (["-o", tmp_path / "slice.step"], ["-o", "-"], ["--format", "doc"]):
        done = run_oval4d("export", *words)
        assert done.returncode == 1 and b"3mf" in done.stderr
    assert run_oval4d("export", "-o", tmp_path / "no" / "where.stl").returncode == 1


async def test_invalid_file_requests_are_refused(server):
    async with Client(server) as client:
        for members in ({}, {"format": "doc"}, {"format": "stl", "size": "large"},
                        {"format": "stl", "of": "all"}, {"format": "stl", "label": True},
                        {"format": "stl", "exact": "on"}):
            with pytest.raises(Refused) as refused:
                await client.request("get", what="file", **members)
            assert refused.value.code == "bad_message"
        with pytest.raises(Refused) as refused:
            await client.request("get", what="file", format="stl", size=0)
        assert refused.value.code == "out_of_range"
        await client.request("set", slices={"focus": 1000})
        with pytest.raises(Refused) as refused:
            await client.request("get", what="file", format="stl")
        assert refused.value.code == "no_body" and "empty" in refused.value.text
        assert (await client.request("get", what="state"))["slices"]["focus"] == 1000


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row["name"])
def test_what_a_format_cannot_contain_is_refused(server, row):
    """The message says what files of this format contain, and which formats contain what was asked for."""
    all_contents = {of for other in TABLE for of in other["of"]}
    for of in sorted(all_contents - set(row["of"])):
        error = export_refusal(server, row["name"], f"polytope=24-cell&of={of}")
        assert error["code"] == "no_body"
        contents, others = error["message"].split("; ")
        assert f", not {of}" in contents and all(own in contents for own in row["of"])
        assert all(other["name"] in others for other in TABLE if of in other["of"])


async def test_export_limits_are_enforced():
    query = "polytope=120-cell&of=oval&body=frame"
    with Server("--max-file-triangles", 5000) as server:
        error = export_refusal(server, "stl", query, 413)
        assert error["code"] == "too_large" and "5000 are allowed" in error["message"]
        fetch_file(server, "stl", "polytope=120-cell")
    with Server("--max-file-bytes", "2k") as server:
        assert "2048 bytes" in export_refusal(server, "off", "polytope=120-cell", 413)["message"]
        async with Client(server) as client:
            with pytest.raises(Refused) as refused:
                await client.request("get", what="file", format="off")
                await client.request("get", what="file", format="stl", body="frame")
            assert refused.value.code == "too_large"
    with Server("--max-file-time", 0.001) as server:
        assert "takes longer than" in export_refusal(server, "stl", query, 413)["message"]


# Making this file takes the server a hundred times as long as answering a few requests for pictures.
LONG_FILE = "/api/v1/file.3mf?polytope=120-cell&of=oval&body=frame"


@contextlib.asynccontextmanager
async def requested_files(server, count):
    """Requests long files, and waits until the server makes one of them. The server must stop before they are done."""
    files = [asyncio.ensure_future(asyncio.to_thread(server.get, LONG_FILE)) for _ in range(count)]
    await asyncio.to_thread(server.wait_for, lambda: server.metric("oval4d_files_under_way") == 1)
    yield files
    ends = await asyncio.gather(*files, return_exceptions=True)
    assert any(isinstance(end, (http.client.HTTPException, OSError)) for end in ends), ends


async def test_pictures_do_not_wait_for_files():
    with Server("--max-file-triangles", 20_000_000, "--stop-timeout", 0.2) as server:
        async with requested_files(server, 3) as files:
            async with Client(server, stream="geometry") as client:
                for _ in range(5):
                    done = await client.request("key", key="r")
                    await client.wait_for_slices(done["revision"])
                assert not all(file.done() for file in files)
            assert server.stop()[0] == 0


async def test_a_server_stop_does_not_wait_for_a_file():
    with Server("--max-file-triangles", 20_000_000, "--stop-timeout", 0.2) as server:
        async with requested_files(server, 1):
            assert server.stop()[0] == 0


def receive_slowly(raw, size, duration):
    """Receives up to this many bytes within no less than `duration`, in seconds, and with many short pauses."""
    received = 0
    with contextlib.suppress(ConnectionResetError):
        while received < size and (part := raw.recv(1 << 18)):
            received += len(part)
            time.sleep(duration * len(part) / size)
    return received


def test_a_slow_reader_receives_a_whole_long_file():
    """It takes longer in total than the time limit of one write, but never pauses that long."""
    for limit in (0.5, 2, 8, 32):  # increases until the pauses of this machine are shorter
        with Server("--write-timeout", limit) as server:
            whole = server.get("/api/v1/file.stl?polytope=24-cell&of=oval&body=frame").body
            assert len(whole) > 20_000_000
            request = '{"type":"get","what":"file","format":"stl","of":"oval","body":"frame"}'
            raw = open_nonreading_socket(server, '{"type":"hello"}', '{"type":"set","polytope":"24-cell"}', request,
                                         buffer=1 << 18)
            with contextlib.closing(raw):
                server.wait_for(lambda: server.metric("oval4d_file_seconds_count") == 2)
                if receive_slowly(raw, len(whole), 3 * limit) >= len(whole):
                    assert server.metric("oval4d_slow_readers_total") == 0
                    return
    pytest.fail("a slow reader is dropped")
