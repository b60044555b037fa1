"""The handshake of WebSockets (RFC 6455, section 4.2): keys, versions, subprotocols, extensions, and invalid requests."""

import base64

import pytest
from raw import TEXT, Socket, WebSocket, accept_value, frame, handshake, request
from websocket_messages import PROTOCOL_ERROR, padded_request


def handshake_response(server, *lines, method="GET", version="HTTP/1.1", target="/ws"):
    with Socket(server) as raw:
        raw.send(request(target, *lines, method=method, version=version))
        return raw.read_response()


UPGRADE, CONNECTION, VERSION = "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13"
KEY = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="
GOOD = [UPGRADE, CONNECTION, VERSION, KEY]


def test_the_accept_field_matches_the_example_of_the_rfc(server):
    """The example of RFC 6455, section 1.3."""
    answer = handshake_response(server, *GOOD)
    assert answer.status == 101
    assert answer.get("Sec-WebSocket-Accept") == "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=" == accept_value("dGhlIHNhbXBsZSBub25jZQ==")
    assert answer.get("Upgrade").lower() == "websocket" and answer.get("Connection").lower() == "upgrade"
    assert answer.get("Sec-WebSocket-Protocol") is None, "no subprotocol was offered"
    for number in range(8):
        key = base64.b64encode(bytes([number] * 16)).decode()
        assert handshake_response(server, *GOOD[:3], f"Sec-WebSocket-Key: {key}").get("Sec-WebSocket-Accept") == accept_value(key)


@pytest.mark.parametrize("lines", [
    ["upgrade: WEBSOCKET", "connection: UPGRADE", "sec-websocket-version: 13", "sec-websocket-key: " + KEY.split()[1]],
    [UPGRADE, "Connection: keep-alive, Upgrade", VERSION, KEY], [UPGRADE, "Connection:Upgrade,close", VERSION, KEY],
    [UPGRADE, "Connection: keep-alive", CONNECTION, VERSION, KEY], [KEY, VERSION, CONNECTION, UPGRADE],
    [UPGRADE, CONNECTION, VERSION, KEY + " "], GOOD + ["X-Unknown: 1"],
])
def test_valid_handshakes_are_accepted(server, lines):
    assert handshake_response(server, *lines).status == 101


@pytest.mark.parametrize("key", [
    None, "", base64.b64encode(b"x" * 15).decode(), base64.b64encode(b"x" * 17).decode(), base64.b64encode(b"x").decode(),
    base64.b64encode(b"x" * 32).decode(), "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZQ", "dGhlIHNhbXBsZSBub25jZQ===",
    "!!!!IHNhbXBsZSBub25jZQ==", "dGhlIHNhbXBs ZSBub25jZQ==", "x" * 24, "=" * 24, "dGhlIHNhbXBsZSBub25jZQ==, x", "x" * 4000,
])
def test_an_invalid_websocket_key_is_refused(server, key):
    answer = handshake_response(server, *GOOD[:3], *([] if key is None else [f"Sec-WebSocket-Key: {key}"]))
    assert answer.status == 400


def test_a_repeated_websocket_key_is_refused(server):
    assert handshake_response(server, *GOOD, "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==").status == 400


@pytest.mark.parametrize("version", ["0", "7", "8", "12", "14", "255", "99999999999999999999", "-13", "013", "13.0", "x", ""])
def test_another_websocket_version_is_refused(server, version):
    answer = handshake_response(server, UPGRADE, CONNECTION, f"Sec-WebSocket-Version: {version}", KEY)
    if version in ("7", "8", "12", "14"):
        assert answer.status == 426
    assert answer.status in (400, 426)
    if answer.status == 426:
        assert answer.get("Sec-WebSocket-Version") == "13"
        assert answer.get("Upgrade") == "websocket"  # required by RFC 9110, section 15.5.22


def test_a_missing_websocket_version_is_refused(server):
    assert handshake_response(server, UPGRADE, CONNECTION, KEY).status in (400, 426)


@pytest.mark.parametrize("lines", [
    [CONNECTION, VERSION, KEY], [UPGRADE, VERSION, KEY], ["Upgrade: websocke", CONNECTION, VERSION, KEY],
    ["Upgrade: websockets", CONNECTION, VERSION, KEY], ["Upgrade: h2c", CONNECTION, VERSION, KEY],
    [UPGRADE, "Connection: keep-alive", VERSION, KEY], [UPGRADE, "Connection: Upgrade2", VERSION, KEY],
    [UPGRADE, "Connection: close", VERSION, KEY],
])
def test_requests_without_an_upgrade_to_websocket_are_refused(server, lines):
    answer = handshake_response(server, *lines)
    assert 400 <= answer.status < 500


@pytest.mark.parametrize("method", ["POST", "PUT", "HEAD", "OPTIONS", "DELETE", "PATCH", "get", "FOO"])
def test_handshakes_with_methods_other_than_get_are_refused(server, method):
    with Socket(server) as raw:
        raw.send(request("/ws", *GOOD, method=method))
        assert raw.read_response(method).status in (400, 404, 405, 426, 501)


@pytest.mark.parametrize("version", ["HTTP/1.0", "HTTP/0.9"])
def test_handshakes_with_older_versions_of_http_are_refused(server, version):
    assert 400 <= handshake_response(server, *GOOD, version=version).status < 600


@pytest.mark.parametrize("lines", [["Content-Length: 5"], ["Transfer-Encoding: chunked"]])
def test_a_handshake_with_a_body_is_refused(server, lines):
    with Socket(server) as raw:
        raw.send(request("/ws", *GOOD, *lines) + b"5\r\nhello\r\n0\r\n\r\n")
        answer = raw.read_response()
        assert answer.status in (400, 411, 413, 501)
        assert raw.read_until_end() == b""


@pytest.mark.parametrize("offered, chosen", [
    (["oval4d.v1"], "oval4d.v1"), (["other, oval4d.v1"], "oval4d.v1"), (["other", "oval4d.v1"], "oval4d.v1"),
    (["oval4d.v1", "other"], "oval4d.v1"), (["a", "b", "c,oval4d.v1 ,d"], "oval4d.v1"), (["oval4d.v2"], None),
    (["other", "another"], None), (["OVAL4D.V1"], None), (["oval4d.v1x"], None), (["x oval4d.v1"], None), ([], ""),
])
def test_the_supported_subprotocol_is_selected(server, offered, chosen):
    answer = handshake_response(server, *GOOD, *(f"Sec-WebSocket-Protocol: {text}" for text in offered))
    if chosen is None:
        assert answer.status == 400
    else:
        assert answer.status == 101 and (answer.get("Sec-WebSocket-Protocol") or "") == chosen


@pytest.mark.parametrize("offer", ["permessage-deflate", "permessage-deflate; client_max_window_bits, x-webkit-deflate-frame",
                                   "permessage-deflate; server_max_window_bits=1", "unknown; a=b", "x" * 2000])
def test_extensions_are_not_negotiated(server, offer):
    with WebSocket(server, "/ws", f"Sec-WebSocket-Extensions: {offer}") as peer:
        assert peer.handshake_response.get("Sec-WebSocket-Extensions") is None
        peer.send(frame(TEXT, padded_request(50, 1), reserved=4))
        assert peer.wait_for_failure_code() == PROTOCOL_ERROR


def test_a_handshake_sent_byte_by_byte_is_answered(server):
    with Socket(server) as raw:
        for octet in handshake():
            raw.send(bytes([octet]))
        assert raw.read_response().status == 101
