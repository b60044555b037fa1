"""The command line: help, how the server stops, and pictures without a server."""

import asyncio
import gzip
import os
import select
import signal
import socket
import subprocess

import png
import pytest
import zarr_files
from array_files import npy, quadratic
from harness import DEADLINE, LONG_TIME, PROGRAM, Server, run_oval4d
from test_pacing import open_nonreading_socket
from wire import Client


def test_version_and_help_are_printed():
    assert run_oval4d("--version").stdout.startswith(b"oval4d ")
    text = run_oval4d("--help").stdout.decode()
    for option in ("--host", "--port", "--workers", "--max-message", "--session-expiry", "--allow-origin", "--token"):
        assert option in text and "OVAL4D_" + option[2:].upper().replace("-", "_") in text
    assert "--rotate" in run_oval4d("render", "--help").stdout.decode()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
async def test_a_stop_closes_every_connection_with_code_1012(number):
    with Server("--stop-timeout", LONG_TIME) as server:
        async with Client(server, stream="geometry") as one, Client(server, stream="frames") as two:
            await one.request("key", key="r")
            await one.request("key", key=" ")  # starts continuous turning
            await two.wait_for_frame(0)
            stopped = asyncio.ensure_future(asyncio.to_thread(server.stop, number))
            assert await one.wait_for_close_code() == 1012 and await two.wait_for_close_code() == 1012
            status, _ = await stopped
            assert status == 0
            assert "stopped" in server.log()


def test_a_stop_does_not_wait_for_unresponsive_clients():
    with Server("--stop-timeout", 0.5) as server:
        requests = ['{"type":"set","polytope":"600-cell"}'] + ['{"type":"get","what":"slices"}'] * 100
        nonreading = open_nonreading_socket(server, '{"type":"hello","stream":"frames","width":2000,"height":2000}', *requests)
        idle = socket.create_connection((server.host, server.port), timeout=DEADLINE)
        server.wait_for(lambda: server.metric("oval4d_websockets") == 1)
        assert server.stop()[0] == 0
        assert idle.recv(1) == b""
        nonreading.close()
        idle.close()


def test_a_port_in_use_is_reported():
    with Server() as server:
        done = run_oval4d("--port", server.port)
        assert done.returncode == 1 and str(server.port) in done.stderr.decode()


def test_a_token_that_would_protect_nothing_is_refused():
    done = run_oval4d("--port", 0, "--open", "--token", "sesame")
    assert done.returncode == 1
    assert "--open" in done.stderr.decode() and "--token" in done.stderr.decode() and "sesame" not in done.stderr.decode()


def test_the_serve_subcommand_starts_a_server():
    process = subprocess.Popen([str(PROGRAM), "serve", "--port", "0"], stderr=subprocess.PIPE)
    try:
        assert select.select([process.stderr], [], [], DEADLINE)[0]
        assert b"listening url=http://127.0.0.1:" in process.stderr.readline()
    finally:
        process.terminate()
        process.communicate(timeout=DEADLINE)


def test_render_writes_a_picture_to_standard_output():
    done = run_oval4d("render", "--polytope", "16-cell", "--slices", "11", "--view=single", "--focus", "-1", "--width", 200,
                      "--height", 150, "-o", "-")
    state = png.state_in(done.stdout)
    assert state["polytope"]["name"] == "16-cell" and state["view"] == "single"
    assert state["slices"]["count"] == 11 and state["slices"]["focus"] == -1
    assert png.pixels(done.stdout)[0] == (200, 150)


@pytest.mark.parametrize("words, expected_text", [
    (["--polytope", "25-cell"], "5-cell"), (["--width", "0"], "16"), (["--color", "red"], "color"),
    (["--rotate", "xw:pi/0"], ""), (["--slices"], "slices"), (["frame.png"], "frame.png"),
    (["-o", "/nonexistent/frame.png"], "/nonexistent"), (["--rotate", "xw:−30"], "did you mean −30°?"),
    (["--load", "a", "--load", "b"], "--load is given twice"), (["--lod", "a"], "did you mean 'load'?"),
    (["--rotat", "xw:1"], "did you mean 'rotate'?"), (["--fit", "3"], "fit is a parameter of files"),
])
def test_render_explains_invalid_options(words, expected_text):
    done = run_oval4d("render", *words)
    assert done.returncode != 0 and expected_text in (done.stderr + done.stdout).decode()


CORNERS = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n-1 -1 -1 -1\n"


@pytest.mark.parametrize("file, shown", [
    (b"bad\xff\xfe.off", "bad??.off"), (b"line\nbreak", "line?break"), (b"24-cell", "24-cell (file)"),
    (b"Two-Warm spots", "Two-Warm spots (file)"), ("π".encode() * 100, "π" * 64), (b"usual.txt", "usual.txt"),
])
def test_an_object_has_a_usable_name_whatever_its_file_is_called(tmp_path, file, shown):
    path = os.path.join(tmp_path, os.fsdecode(file))
    with open(path, "w", encoding="ascii") as stream:
        stream.write(CORNERS)
    done = run_oval4d("render", "--load", path, "--width=64", "--height=64", "-o", "-")
    assert done.returncode == 0, done.stderr
    state = png.state_in(done.stdout)["polytope"]
    assert state["name"] == shown and state["vertices"] == 5
    assert (b"the object is called" in done.stderr) == (file != b"usual.txt")
    for format_ in ("glb", "x3d", "svg", "3mf"):
        made = run_oval4d("export", "--load", path, "--format", format_, "-o", "-")
        assert made.returncode == 0, made.stderr
        made.stdout.decode(errors="strict" if format_ in ("x3d", "svg") else "replace")


def test_compressed_files_and_folders_are_named(tmp_path):
    (tmp_path / "x.off.gz").write_bytes(gzip.compress(CORNERS.encode()))
    (tmp_path / "long.off.gz").write_bytes(gzip.compress(CORNERS.encode() * 100))
    for name in ("x.off.gz", "long.off.gz"):
        done = run_oval4d("render", "--load", tmp_path / name, "-o", "-")
        assert done.returncode != 0 and b"is compressed with gzip" in done.stderr and b"unpack it first" in done.stderr
    (tmp_path / "folder").mkdir()
    done = run_oval4d("render", "--load", tmp_path / "folder", "-o", "-")
    assert done.returncode != 0 and b"the folder contains no Zarr array or group" in done.stderr


def test_a_region_of_a_zarr_folder(tmp_path):
    values = quadratic((11, 4, 5, 6))
    zarr_files.write(tmp_path / "run", values, (2, 3, 2, 4))
    (tmp_path / "part.npy").write_bytes(npy(values[2:7, 1:3, :, 1:4]))
    region = "1,3,0,4,1,2,2,6"
    files = (tmp_path / "run", "--box=0,5,0,4,0,3,0,10", f"--region={region}"), (tmp_path / "part.npy", f"--box={region}")
    of_region, of_part = (run_oval4d("export", "--format", "csv", "-o", "-", "--of", "oval", "--slices", 5, "--spacing", 0.3,
                                     "--load", *options) for options in files)
    assert of_region.returncode == of_part.returncode == 0, of_region.stderr
    assert len(of_part.stdout.splitlines()) == 6 and of_region.stdout == of_part.stdout
    done = run_oval4d("render", "--load", tmp_path / "part.npy", f"--region={region}", "-o", "-")
    assert done.returncode != 0 and b"only Zarr folders" in done.stderr


def test_a_folder_of_arrays_is_a_series(tmp_path):
    values = quadratic((11, 4, 5, 6))
    (tmp_path / "run.npy").write_bytes(npy(values))
    (tmp_path / "run").mkdir()
    for moment, each in enumerate(values):
        (tmp_path / "run" / f"t{moment}.npy").write_bytes(npy(each))  # t2 must come before t10
    (tmp_path / "run" / "notes.txt").write_text("no array")
    whole, series = (run_oval4d("export", "--format", "csv", "-o", "-", "--load", tmp_path / name, "--of", "oval",
                                "--slices", 5, "--spacing", 0.3, "--box=-1,1,-1,1,-1,1,-1,1") for name in ("run.npy", "run"))
    assert whole.returncode == series.returncode == 0, series.stderr
    assert len(whole.stdout.splitlines()) == 6 and series.stdout == whole.stdout
    (tmp_path / "run" / "t11.npy").write_bytes(npy(values[0][1:]))
    done = run_oval4d("render", "--load", tmp_path / "run", "-o", "-")
    assert done.returncode != 0 and b"file 12 of the series" in done.stderr
