"""How signals end the server, and on which addresses it listens."""

import concurrent.futures
import contextlib
import random
import signal
import socket
import time

import pytest
from harness import SLOW, Server
from raw import CLOSE, ConnectionEnded, Socket, WebSocket, fetch, request

LONG_FILE = "/api/v1/file.stl?polytope=120-cell&of=oval&body=frame"  # takes seconds to export


def close_code(peer):
    """Returns the server's close code, None if it ends the connection without a close frame."""
    try:
        while True:
            opcode, payload = peer.next_message()
            if opcode == CLOSE:
                return int.from_bytes(payload[:2], "big")
    except ConnectionEnded:
        return None


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM, signal.SIGINT])
def test_a_signal_stops_the_server_gracefully(number):
    with Server() as server, WebSocket(server) as one, WebSocket(server) as two, Socket(server) as idle:
        one.request(type="hello", stream="geometry")
        two.request(type="hello")
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            codes = [pool.submit(close_code, peer) for peer in (one, two)]
            stopped = pool.submit(server.stop, number)
            assert [code.result() for code in codes] == [1012, 1012]
            one.socket.close()
            two.socket.close()
            status, _ = stopped.result()
        assert status == 0 and "stopped" in server.log()
        assert idle.read_until_end() == b""


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM])
def test_sessions_are_saved_when_a_signal_stops_the_server(number, tmp_path):
    store = f"sqlite:{tmp_path / 'sessions.sqlite'}"
    with Server("--store", store) as server, WebSocket(server) as peer:
        welcome = peer.request(type="hello")
        for _ in range(5):
            assert peer.request(type="key", key="y")["type"] == "done"
        server.process.send_signal(number)
        assert close_code(peer) == 1012
        peer.socket.close()
        assert server.process.wait(20 * SLOW) == 0
    with Server("--store", store) as server, WebSocket(server, f"/ws/{welcome['session']}") as peer:
        assert peer.request(type="hello", token=welcome["token"])["type"] == "welcome"
        assert peer.request(type="get", what="state")["revision"] == 5


def sphere_points(count):
    """Returns points whose convex hull takes some time to compute, as text."""
    rng = random.Random(4)
    lines = []
    for _ in range(count):
        point = [rng.gauss(0, 1) for _ in range(4)]
        size = sum(x * x for x in point) ** 0.5
        lines.append(" ".join(f"{x / size:.17g}" for x in point))
    return "\n".join(lines)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("work", ["files", "files by websocket", "loads", "pictures", "slow readers"])
def test_running_work_does_not_delay_a_stop(number, work):
    timeout = 1
    with Server("--stop-timeout", timeout, "--max-file-triangles", 100_000_000) as server, contextlib.ExitStack() as stack:
        points = sphere_points(6000) if work == "loads" else ""
        peers = []
        for _ in range(4):
            if work in ("files", "slow readers"):
                raw = stack.enter_context(Socket(server, receive_buffer=4096))
                raw.send(request(LONG_FILE if work == "files" else LONG_FILE.replace("120-cell", "24-cell")))
                continue
            peer = stack.enter_context(WebSocket(server))
            peers.append(peer)
            peer.request(type="hello", stream="frames" if work == "pictures" else "none", width=4096, height=4096)
            if work == "files by websocket":
                peer.request(type="command", line="polytope 120-cell")
                peer.send_message(type="get", what="file", format="stl", of="oval", body="frame")
            if work == "loads":
                peer.send_message(type="load", name="mine", format="points", data=points)
            if work == "pictures":
                peer.send_message(type="command", line="polytope omnitruncated 120-cell")
                peer.send_message(type="command", line="rotate xw,yz 0.3 0.2")
        if "files" in work:
            server.wait_for(lambda: server.metric("oval4d_files_under_way") >= 1)
        if work == "slow readers":
            server.wait_for(lambda: server.metric("oval4d_file_seconds_count") >= 1)
        time.sleep(0.3)
        status, seconds = server.stop(number)
        assert status == 0
        assert seconds < timeout + 1 * SLOW


def test_a_second_signal_ends_the_server_at_once():
    with Server("--stop-timeout", 1000) as server, WebSocket(server) as peer:
        peer.request(type="hello")
        server.process.send_signal(signal.SIGTERM)
        server.wait_for(lambda: "stopping" in server.log())
        server.process.send_signal(signal.SIGTERM)
        server.process.wait(20 * SLOW)
        server.process.returncode = 0  # the second signal killed the server, as intended


# --- Loopback addresses of IPv4 and IPv6

def has_ipv6():
    with contextlib.suppress(OSError), socket.socket(socket.AF_INET6) as one:
        one.bind(("::1", 0))
        return True
    return False


@pytest.mark.skipif(not has_ipv6(), reason="this machine has no IPv6 loopback")
def test_both_loopback_addresses_are_served(server):
    for host in ("127.0.0.1", "::1"):
        for name in ("localhost", "[::1]", "127.0.0.1"):
            with Socket(server, host=host) as raw:
                raw.send(request("/api/v1/keymap", host=f"{name}:{server.port}", close=True))
                assert raw.read_response().status == 200
    with Socket(server, host="::1") as raw:
        raw.send(request("/api/v1/keymap", host="evil.example", close=True))
        assert raw.read_response().status == 403


@pytest.mark.skipif(not has_ipv6(), reason="this machine has no IPv6 loopback")
def test_the_server_listens_only_on_the_given_host():
    for asked, other in (("127.0.0.1", "::1"), ("::1", "127.0.0.1")):
        with Server("--host", asked) as server:
            assert fetch(server, "/healthz", host="localhost").status == 200
            with pytest.raises(ConnectionRefusedError):
                Socket(server, host=other)


def test_the_port_can_be_reused_at_once_after_a_stop():
    with Server() as server:
        port = server.port
        with WebSocket(server) as peer:
            peer.request(type="hello")
            assert server.stop()[0] == 0
    with Server("--port", port) as again:
        assert fetch(again, "/healthz").status == 200
