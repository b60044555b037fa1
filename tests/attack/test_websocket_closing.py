"""The end of WebSockets (RFC 6455, section 7), as in group 7 of the Autobahn test suite: close frames, and disconnects."""

import json
from pathlib import Path

import pytest
from harness import Server
from raw import BINARY, CLOSE, PING, TEXT, WebSocket, close_frame, frame
from websocket_messages import INVALID, NORMAL, PROTOCOL_ERROR, UNSUPPORTED, assert_answers, fragments, padded_request

VALID_CODES = [1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 1012, 1013, 1014, 3000, 3999, 4000, 4401, 4999]
INVALID_CODES = [0, 1, 999, 1004, 1005, 1006, 1015, 1016, 1100, 1999, 2000, 2999, 5000, 9999, 65534, 65535]


@pytest.mark.parametrize("code", VALID_CODES)
@pytest.mark.parametrize("reason", [b"", b"going", "κόσμε".encode(), b"x" * 123], ids=len)
def test_a_close_is_answered_with_its_code(peer_without_hello, code, reason):
    peer_without_hello.send(close_frame(code, reason))
    assert peer_without_hello.wait_for_close_code() == code


@pytest.mark.parametrize("code", INVALID_CODES)
@pytest.mark.parametrize("reason", [b"", b"reason"])
def test_a_close_with_an_invalid_code_is_refused(peer_without_hello, code, reason):
    peer_without_hello.send(close_frame(code, reason))
    assert peer_without_hello.wait_for_failure_code() == PROTOCOL_ERROR


def test_a_close_without_a_code_is_answered(peer_without_hello):
    peer_without_hello.send(close_frame())
    assert peer_without_hello.wait_for_close_code() in (None, NORMAL)


def test_a_close_with_a_payload_of_one_byte_is_refused(peer_without_hello):
    peer_without_hello.send(frame(CLOSE, b"\x03"))
    assert peer_without_hello.wait_for_failure_code() == PROTOCOL_ERROR


@pytest.mark.parametrize("size", [124, 125, 1000, 65536])
def test_a_close_with_a_too_long_reason_is_refused(peer_without_hello, size):
    peer_without_hello.send(close_frame(1000, b"x" * size))
    assert peer_without_hello.wait_for_failure_code() == PROTOCOL_ERROR


@pytest.mark.parametrize("sequence", [b"\xff", b"\xce", b"\xed\xa0\x80", b"\xc0\xaf", b"\xf4\x90\x80\x80"])
def test_a_close_with_a_reason_that_is_not_utf8_is_refused(peer_without_hello, sequence):
    peer_without_hello.send(close_frame(1000, b"bye" + sequence))
    assert peer_without_hello.wait_for_failure_code() in (INVALID, PROTOCOL_ERROR)


@pytest.mark.parametrize("after", [frame(PING, b"late"), frame(TEXT, padded_request(50, 7)), close_frame(1001), frame(3, b"?"),
                                   b"\0" * 1000, frame(TEXT, b"{", final=False)])
def test_data_after_a_close_is_ignored(peer, after):
    peer.send(close_frame(NORMAL) + after)
    assert peer.wait_for_close_code() == NORMAL
    assert not peer.pongs


def test_a_close_within_a_fragmented_message_is_answered(peer):
    first, _ = fragments(padded_request(50, 7), [25])
    peer.send(first + close_frame(NORMAL))
    assert peer.wait_for_close_code() == NORMAL


def test_pending_requests_do_not_prevent_a_close(session):
    with session.join() as peer:
        peer.send(b"".join(frame(TEXT, padded_request(50, number)) for number in range(100)) + close_frame(NORMAL))
        assert peer.wait_for_close_code() == NORMAL
    with session.join() as peer:
        assert_answers(peer)


def test_the_server_ends_the_connection_if_its_close_is_not_answered():
    """The server begins to close, and the client sends no close frame."""
    with Server() as impatient, WebSocket(impatient) as peer:
        peer.send(frame(BINARY, b"x"))
        assert peer.wait_for_close_code(answers=False) == UNSUPPORTED
        impatient.wait_for(lambda: impatient.metric("oval4d_websockets") == 0)


@pytest.mark.parametrize("leave", ["fin", "reset", "within a frame", "within a message"])
def test_the_server_survives_abrupt_disconnects(server, session, leave):
    peer = session.join()
    if leave == "within a frame":
        peer.send(frame(TEXT, padded_request(200, 1))[:100])
    if leave == "within a message":
        peer.send(frame(TEXT, padded_request(200, 1), final=False))
    if leave == "reset":
        peer.reset()
    peer.socket.close()
    server.wait_for(lambda: server.metric("oval4d_websockets") == 0)
    with session.join() as another:
        assert_answers(another)


def test_the_server_closes_a_half_closed_connection_that_does_not_read():
    """The end of the client's side arrives while answers wait to be written."""
    with Server("--max-unsent", "256M", "--max-client-bytes", "256M", "--min-read-rate", 1) as server:
        with WebSocket(server, receive_buffer=4096) as peer:
            peer.request(type="hello")
            assert peer.request(type="command", line="polytope 600-cell")["type"] == "done"
            answer = len(json.dumps(peer.request(type="get", what="slices")))
            # These answers are much larger than the buffers of the sockets.
            peer.send(frame(TEXT, b'{"type":"get","what":"slices"}') * ((64 << 20) // answer))
            server.wait_for(lambda: server.metric("oval4d_client_bytes") > 32 << 20)
            peer.half_close()
            server.wait_for(lambda: not is_open_in_server(peer))
            server.wait_for(lambda: server.metric("oval4d_client_bytes") == 0)


def is_open_in_server(peer):
    """Returns whether a process has the server's end of the connection open: whether it has an inode (proc(5))."""
    ports = peer.server.port, peer.socket.getsockname()[1]
    for row in Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()[1:]:
        fields = row.split()
        if tuple(int(address.partition(":")[2], 16) for address in fields[1:3]) == ports:
            return fields[9] != "0"
    return False


def test_a_half_closed_connection_is_answered(peer):
    peer.send(frame(TEXT, padded_request(50, 7)) + close_frame(NORMAL))
    peer.half_close()
    assert peer.wait_for_answer(7)["type"] == "state"
    assert peer.wait_for_close_code() == NORMAL
