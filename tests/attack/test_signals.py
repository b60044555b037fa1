"""How signals end the server, and on which addresses it listens."""

import concurrent.futures
import contextlib
import signal
import socket

import pytest
from harness import DEADLINE, LONG_TIME, Server
from raw import CLOSE, TEXT, ConnectionEnded, Socket, WebSocket, fetch, frame, request, send_as_far_as_read
from running_work import KINDS_OF_WORK, server_with_running_work


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


def test_answers_that_are_unread_when_the_server_stops_do_not_delay_its_end():
    with Server("--max-unsent", "16k", "--stop-timeout", LONG_TIME) as server, WebSocket(server, receive_buffer=4096) as peer:
        peer.request(type="hello")
        flood = frame(TEXT, b'{"type":"get","what":"keymap"}') * 500_000  # more than sockets can hold
        assert send_as_far_as_read([peer], flood, lambda: fetch(server, "/readyz")) < len(flood)
        server.process.send_signal(signal.SIGTERM)
        assert close_code(peer) == 1012
        peer.socket.close()
        assert server.process.wait(DEADLINE) == 0
        assert "clients still connected" not in server.log()


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
        assert server.process.wait(DEADLINE) == 0
    with Server("--store", store) as server, WebSocket(server, f"/ws/{welcome['session']}") as peer:
        assert peer.request(type="hello", token=welcome["token"])["type"] == "welcome"
        assert peer.request(type="get", what="state")["revision"] == 5


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("work", KINDS_OF_WORK)
def test_a_signal_stops_the_server_while_it_works(number, work):
    with server_with_running_work(work, "--stop-timeout", 0.1) as server:
        assert server.stop(number)[0] == 0
        assert "stopped" in server.log()


def test_a_second_signal_ends_the_server_at_once():
    with Server("--stop-timeout", 1000) as server, WebSocket(server) as peer:
        peer.request(type="hello")
        server.process.send_signal(signal.SIGTERM)
        server.wait_for(lambda: "stopping" in server.log())
        server.process.send_signal(signal.SIGTERM)
        server.process.wait(DEADLINE)
        server.process.returncode = 0  # as intended, the second signal has killed the server


# --- The server listens on the loopback addresses of IPv4 and IPv6

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
    with Server("--stop-timeout", 0.1) as server:
        port = server.port
        with WebSocket(server) as peer:
            peer.request(type="hello")
            assert server.stop()[0] == 0
    with Server("--port", port) as again:
        assert fetch(again, "/healthz").status == 200
