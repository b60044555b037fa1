"""The command line: help, how the server stops, and pictures without a server."""

import signal
import socket
import subprocess

import png
import pytest
from harness import DEADLINE, PROGRAM, SLOW, Server, run
from wire import Client


def test_version_and_help():
    assert run("--version").stdout.startswith(b"oval4d ")
    text = run("--help").stdout.decode()
    for option in ("--host", "--port", "--workers", "--max-message", "--session-expiry", "--allow-origin", "--token"):
        assert option in text and "OVAL4D_" + option[2:].upper().replace("-", "_") in text
    assert "--rotate" in run("render", "--help").stdout.decode()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
async def test_a_stop_tells_every_client_to_come_back(number):
    with Server() as server:
        async with Client(server, stream="geometry") as one, Client(server, stream="frames") as two:
            await one.request("key", key="r")
            await one.request("key", key=" ")  # starts continuous turning
            await two.frame_of(0)
            import asyncio

            stopped = asyncio.get_running_loop().run_in_executor(None, server.stop, number)
            assert await one.closed() == 1012 and await two.closed() == 1012
            status, seconds = await stopped
            assert status == 0 and seconds < 5 * SLOW
            assert "stopped" in server.log()


def test_a_stop_waits_for_nobody_for_long():
    from test_pacing import deaf_socket

    with Server("--stop-timeout", 0.5) as server:
        wishes = ['{"type":"set","polytope":"600-cell"}'] + ['{"type":"get","what":"slices"}'] * 100
        deaf = deaf_socket(server, '{"type":"hello","stream":"frames","width":2000,"height":2000}', *wishes)
        idle = socket.create_connection((server.host, server.port), timeout=DEADLINE)
        server.wait_for(lambda: server.metric("oval4d_websockets") == 1)
        status, seconds = server.stop()
        assert status == 0 and seconds < 5 * SLOW
        assert idle.recv(1) == b""
        deaf.close()
        idle.close()


def test_a_port_that_is_taken_is_said():
    with Server() as server:
        done = run("--port", server.port)
        assert done.returncode == 1 and str(server.port) in done.stderr.decode()


def test_serve_is_the_default():
    process = subprocess.Popen([str(PROGRAM), "serve", "--port", "0"], stderr=subprocess.PIPE)
    try:
        assert b"listening url=http://127.0.0.1:" in process.stderr.readline()
    finally:
        process.terminate()
        process.communicate(timeout=DEADLINE)


def test_render_to_standard_output_and_with_any_setting():
    done = run("render", "--polytope", "16-cell", "--slices", "11", "--view=single", "--focus", "-1", "--width", 200,
               "--height", 150, "-o", "-")
    state = png.state_in(done.stdout)
    assert state["polytope"]["name"] == "16-cell" and state["view"] == "single"
    assert state["slices"]["count"] == 11 and state["slices"]["focus"] == -1
    assert png.pixels(done.stdout)[0] == (200, 150)


@pytest.mark.parametrize("words, says", [
    (["--polytope", "25-cell"], "5-cell"), (["--width", "0"], "16"), (["--color", "red"], "color"),
    (["--rotate", "xw:pi/0"], ""), (["--slices"], "slices"), (["frame.png"], "frame.png"),
    (["-o", "/nonexistent/frame.png"], "/nonexistent"),
])
def test_render_explains_what_is_wrong(words, says):
    done = run("render", *words)
    assert done.returncode != 0 and says in (done.stderr + done.stdout).decode()
