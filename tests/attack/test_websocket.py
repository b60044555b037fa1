"""WebSocket conformance (RFC 6455), with the groups of cases of the Autobahn test suite: framing, pings, reserved bits
and opcodes, fragments, UTF-8, closing, limits, and the handshake. Many cases send bytes that no library would send.
"""

import base64
import json
import socket
import struct

import pytest
from harness import Server
from raw import (BINARY, CLOSE, CONTINUATION, PING, PONG, TEXT, Session, Socket, WebSocket, accept_for, close_frame,
                 frame, handshake, request)

NORMAL, PROTOCOL_ERROR, UNSUPPORTED, INVALID, TOO_BIG = 1000, 1002, 1003, 1007, 1009


@pytest.fixture(name="session", scope="module")
def a_session(server):
    return Session(server)


@pytest.fixture(name="peer")
def a_peer(session):
    """A WebSocket that has joined the session."""
    with session.join() as joined:
        yield joined


@pytest.fixture(name="bare")
def a_bare_peer(server):
    """A WebSocket before its hello."""
    with WebSocket(server) as opened:
        yield opened


def padded(size, number):
    """Returns a request of `size` bytes, padded with blanks, which are valid after JSON."""
    text = b'{"type":"get","what":"state","id":%d}' % number if size >= 50 else b'{"id":%d}' % number
    assert len(text) <= size
    return text.ljust(size)


def load_of(size, number):
    """Returns a load message of `size` bytes; the server answers it with an error."""
    text = b'{"type":"load","id":%d,"name":"x","format":"off","data":"#' % number
    return text + b"x" * (size - len(text) - 2) + b'"}'


def line(text, number):
    """Returns a command that the server answers with an error that contains the text."""
    return json.dumps({"type": "command", "id": number, "line": "polytope " + text}, ensure_ascii=False).encode()


def assert_alive(peer, number=999_999):
    peer.send(frame(TEXT, padded(50, number)))
    assert peer.answer_to(number)["type"] == "state"


# --- Framing (Autobahn 1)

@pytest.mark.parametrize("size", [10, 50, 124, 125, 126, 127, 128, 254, 255, 256, 1000, 65534, 65535, 65536])
@pytest.mark.parametrize("piece", [None, 997])
def test_text_of_every_length(peer, size, piece):
    data = frame(TEXT, padded(size, 7))
    step = piece or len(data)
    for at in range(0, len(data), step):
        peer.send(data[at:at + step])
    assert peer.answer_to(7)["type"] == ("state" if size >= 50 else "error")
    assert_alive(peer)


@pytest.mark.parametrize("size", [10, 50, 125, 126, 127, 1000])
def test_text_octet_by_octet(peer, size):
    for octet in frame(TEXT, padded(size, 7)):
        peer.send(bytes([octet]))
    assert peer.answer_to(7)["type"] == ("state" if size >= 50 else "error")


def test_an_empty_text_is_no_json(peer):
    peer.send(frame(TEXT))
    assert peer.fails() == INVALID


@pytest.mark.parametrize("size", [0, 1, 125, 126, 127, 128, 1000, 65535, 65536])
def test_binary_is_not_spoken_here(peer, size):
    peer.send(frame(BINARY, b"\xfe" * size))
    assert peer.fails() == UNSUPPORTED


@pytest.mark.parametrize("size, form", [(0, 16), (50, 16), (125, 16), (0, 64), (50, 64), (125, 64), (126, 64), (65535, 64)])
def test_a_length_longer_than_need_be_is_refused(peer, size, form):
    peer.send(frame(TEXT, padded(size, 1) if size else b"", form=form))
    assert peer.fails() == PROTOCOL_ERROR


@pytest.mark.parametrize("announced", [1 << 63, (1 << 64) - 1, (1 << 63) + 50])
def test_a_length_with_its_highest_bit_set_is_refused(peer, announced):
    peer.send(frame(TEXT, b"", form=64, announced=announced))
    assert peer.fails() in (PROTOCOL_ERROR, TOO_BIG)


def test_many_frames_at_once(peer):
    peer.send(b"".join(frame(TEXT, padded(50, number)) for number in range(1, 101)))
    answered = []
    while len(answered) < 100:
        message = json.loads(peer.next_message()[1])
        answered += [message["id"]] if "id" in message else []
    assert answered == list(range(1, 101))


# --- Masks

@pytest.mark.parametrize("opcode, payload", [(TEXT, padded(50, 1)), (TEXT, b""), (BINARY, b"x"), (PING, b"x"), (PONG, b""),
                                             (CLOSE, b"\x03\xe8"), (CONTINUATION, b"x")])
def test_frames_without_a_mask_are_refused(peer, opcode, payload):
    peer.send(frame(opcode, payload, mask=None))
    assert peer.fails() == PROTOCOL_ERROR


@pytest.mark.parametrize("mask", [b"\0\0\0\0", b"\xff\xff\xff\xff", b"\0\0\0\1", b"\x80\0\0\0"])
def test_every_mask_is_a_mask(peer, mask):
    for size in (50, 51, 52, 53, 200):
        peer.send(frame(TEXT, padded(size, size), mask=mask))
        assert peer.answer_to(size)["type"] == "state"


# --- Pings and pongs (Autobahn 2)

@pytest.mark.parametrize("payload", [b"", b"x", b"Hello, world!", b"\x00\xff\xfe\xfd\xfc\xfb\x00\xff", b"\xfe" * 124,
                                     b"\xfe" * 125], ids=len)
@pytest.mark.parametrize("chopped", [False, True])
def test_a_ping_is_answered_with_its_payload(bare, payload, chopped):
    data = frame(PING, payload)
    for piece in ([data[i:i + 1] for i in range(len(data))] if chopped else [data]):
        bare.send(piece)
    assert bare.pong() == payload


@pytest.mark.parametrize("opcode", [PING, PONG])
@pytest.mark.parametrize("size", [126, 127, 1000, 65536])
def test_a_long_ping_is_refused(bare, opcode, size):
    bare.send(frame(opcode, b"\xfe" * size))
    assert bare.fails() == PROTOCOL_ERROR


@pytest.mark.parametrize("payload", [b"", b"unsolicited"])
def test_a_pong_that_nobody_asked_for_is_passed_over(bare, payload):
    bare.send(frame(PONG, payload) * 3 + frame(PING, b"after") + frame(PONG, payload))
    assert bare.pong() == b"after"
    bare.send(frame(PING, b"again"))
    assert bare.pong() == b"again" and not bare.pongs


def test_ten_pings_are_answered_in_order(bare):
    bare.send(b"".join(frame(PING, b"payload-%d" % number) for number in range(10)))
    assert [bare.pong() for _ in range(10)] == [b"payload-%d" % number for number in range(10)]
    bare.send(b"".join(frame(PING, b"%d" % number) for number in range(200)))
    assert [bare.pong() for _ in range(200)] == [b"%d" % number for number in range(200)]


# --- Reserved bits (Autobahn 3)

@pytest.mark.parametrize("reserved", range(1, 8))
@pytest.mark.parametrize("opcode, payload", [(TEXT, padded(50, 1)), (PING, b"x"), (PONG, b""), (CLOSE, b"\x03\xe8"),
                                             (TEXT, b"")])
def test_reserved_bits_are_refused(peer, reserved, opcode, payload):
    peer.send(frame(PING, b"before") + frame(opcode, payload, reserved=reserved) + frame(PING, b"after"))
    assert peer.pong() == b"before"
    assert peer.fails() == PROTOCOL_ERROR
    assert not peer.pongs


def test_reserved_bits_are_refused_within_a_message(peer):
    peer.send(frame(TEXT, padded(50, 1)[:20], final=False) + frame(CONTINUATION, padded(50, 1)[20:], reserved=4))
    assert peer.fails() == PROTOCOL_ERROR


# --- Reserved opcodes (Autobahn 4)

@pytest.mark.parametrize("opcode", [3, 4, 5, 6, 7, 11, 12, 13, 14, 15])
@pytest.mark.parametrize("payload", [b"", b"reserved opcode payload"])
def test_reserved_opcodes_are_refused(peer, opcode, payload):
    peer.send(frame(PING, b"before") + frame(opcode, payload) + frame(PING, b"after"))
    assert peer.pong() == b"before"
    assert peer.fails() == PROTOCOL_ERROR


# --- Fragments (Autobahn 5)

def fragments(data, cuts, opcode=TEXT):
    """Returns the frames of a message that is split at these positions."""
    bounds = [0, *cuts, len(data)]
    pieces = [data[a:b] for a, b in zip(bounds, bounds[1:])]
    return [frame(opcode if i == 0 else CONTINUATION, piece, final=i == len(pieces) - 1) for i, piece in enumerate(pieces)]


@pytest.mark.parametrize("cuts", [[20], [0], [50], [0, 0, 0], [1, 2, 3, 4], [50, 50], list(range(1, 50))])
@pytest.mark.parametrize("between", [b"", frame(PING, b"between"), frame(PONG, b"unsolicited")], ids=["", "ping", "pong"])
@pytest.mark.parametrize("chopped", [False, True])
def test_a_message_in_fragments(peer, cuts, between, chopped):
    data = between.join(fragments(padded(50, 7), cuts))
    for piece in ([data[i:i + 1] for i in range(len(data))] if chopped else [data]):
        peer.send(piece)
    assert peer.answer_to(7)["type"] == "state"
    pings = len(cuts) if between == frame(PING, b"between") else 0
    assert peer.pongs == [b"between"] * pings
    assert_alive(peer)


def test_a_ping_between_fragments_is_answered_at_once(peer):
    first, second = fragments(padded(50, 7), [25])
    peer.send(first + frame(PING, b"within"))
    assert peer.pong() == b"within"
    peer.send(second)
    assert peer.answer_to(7)["type"] == "state"


@pytest.mark.parametrize("opcode, payload", [(PING, b"x"), (PING, b""), (PONG, b"x"), (CLOSE, b""), (CLOSE, b"\x03\xe8")])
def test_control_frames_in_fragments_are_refused(bare, opcode, payload):
    bare.send(frame(opcode, payload, final=False) + frame(CONTINUATION, payload))
    assert bare.fails() == PROTOCOL_ERROR
    assert not bare.pongs


@pytest.mark.parametrize("final", [True, False])
@pytest.mark.parametrize("payload", [b"", b"nothing to continue"])
def test_a_continuation_of_nothing_is_refused(peer, final, payload):
    peer.send(frame(CONTINUATION, payload, final=final) + frame(TEXT, padded(50, 7)))
    assert peer.fails() == PROTOCOL_ERROR


def test_a_continuation_after_a_finished_message_is_refused(peer):
    assert_alive(peer)
    peer.send(b"".join(fragments(padded(50, 7), [20])) + frame(CONTINUATION, b"more"))
    assert peer.fails() == PROTOCOL_ERROR


@pytest.mark.parametrize("opcode", [TEXT, BINARY])
@pytest.mark.parametrize("final", [True, False])
def test_a_message_begun_within_another_is_refused(peer, opcode, final):
    first, _ = fragments(padded(50, 7), [25])
    peer.send(first + frame(opcode, padded(50, 8), final=final))
    assert peer.fails() == PROTOCOL_ERROR


# --- UTF-8 (Autobahn 6)

VALID = ["κόσμε", "Hello-µ@ßöäüàá-UTF-8!!", "\u0080", "\u07ff", "\u0800", "\uffff", "\U00010000", "\U0010ffff", "\ud7ff",
         "\ue000", "\ufffd", "\ufffe", "\ufdd0", "\U0001fffe", "\U0001ffff", "\U0008ffff", "\U000fffff", "\U0010fffe",
         "\ufeff", "\u200b", "日本語", "𝄞𝄢", "e\u0301", "\u202e"]

INVALID_SEQUENCES = {
    "lone continuation 80": b"\x80", "lone continuation bf": b"\xbf", "two continuations": b"\x80\xbf",
    "all continuations": bytes(range(0x80, 0xc0)), "lone starts of 2": b"".join(bytes([c, 32]) for c in range(0xc0, 0xe0)),
    "lone starts of 3": b"".join(bytes([c, 32]) for c in range(0xe0, 0xf0)),
    "lone starts of 4": b"".join(bytes([c, 32]) for c in range(0xf0, 0xf8)), "start of 5": b"\xf8 ", "start of 6": b"\xfc ",
    "2 without its last": b"\xdf ", "3 without its last": b"\xef\xbf ", "3 without two": b"\xe1 ",
    "4 without its last": b"\xf4\x80\x80 ", "4 without two": b"\xf1\x80 ", "fe": b"\xfe", "ff": b"\xff",
    "fe fe ff ff": b"\xfe\xfe\xff\xff",
    "overlong slash of 2": b"\xc0\xaf", "overlong slash of 3": b"\xe0\x80\xaf", "overlong slash of 4": b"\xf0\x80\x80\xaf",
    "overlong slash of 5": b"\xf8\x80\x80\x80\xaf", "overlong slash of 6": b"\xfc\x80\x80\x80\x80\xaf",
    "overlong 7f": b"\xc1\xbf", "overlong 7ff": b"\xe0\x9f\xbf", "overlong ffff": b"\xf0\x8f\xbf\xbf",
    "overlong 1fffff": b"\xf8\x87\xbf\xbf\xbf", "overlong nul of 2": b"\xc0\x80", "overlong nul of 3": b"\xe0\x80\x80",
    "overlong nul of 4": b"\xf0\x80\x80\x80", "surrogate d800": b"\xed\xa0\x80", "surrogate db7f": b"\xed\xad\xbf",
    "surrogate dc00": b"\xed\xb0\x80", "surrogate dfff": b"\xed\xbf\xbf", "pair of surrogates": b"\xed\xa0\x80\xed\xb0\x80",
    "110000": b"\xf4\x90\x80\x80", "13ffff": b"\xf4\xbf\xbf\xbf", "140000": b"\xf5\x80\x80\x80",
    "1fffff": b"\xf7\xbf\xbf\xbf", "5 octets": b"\xf8\x88\x80\x80\x80", "6 octets": b"\xfd\xbf\xbf\xbf\xbf\xbf",
    "good then bad": "κόσμε".encode() + b"\xed\xa0\x80edited",
}


@pytest.mark.parametrize("text", VALID, ids=ascii)
def test_valid_text_is_taken(peer, text):
    peer.send(frame(TEXT, line(text, 7)))
    assert text in peer.answer_to(7)["message"]


@pytest.mark.parametrize("text", ["κόσμε", "\U0010ffff", "\uffff", "𝄞x"], ids=ascii)
def test_code_points_cut_by_fragments_and_by_segments(peer, text):
    data = line(text, 7)
    for cut in range(1, len(data)):
        peer.send(b"".join(fragments(data, [cut])))
        assert text in peer.answer_to(7)["message"]
    peer.send(b"".join(fragments(data, range(1, len(data)))))
    assert text in peer.answer_to(7)["message"]
    for octet in frame(TEXT, data):
        peer.send(bytes([octet]))
    assert text in peer.answer_to(7)["message"]


@pytest.mark.parametrize("sequence", INVALID_SEQUENCES.values(), ids=INVALID_SEQUENCES)
@pytest.mark.parametrize("cut", [False, True])
def test_invalid_text_is_refused(peer, sequence, cut):
    data = line("@", 7).replace(b"@", sequence)
    at = data.index(sequence)
    peer.send(b"".join(fragments(data, [at + 1])) if cut else frame(TEXT, data))
    assert peer.fails() == INVALID


@pytest.mark.parametrize("sequence", [b"\xce", b"\xf4", b"\xf4\x8f", b"\xf4\x8f\xbf", b"\xe1\x80"])
def test_text_that_ends_within_a_code_point_is_refused(peer, sequence):
    peer.send(frame(TEXT, b'{"id":1,"type":"' + sequence))
    assert peer.fails() == INVALID


@pytest.mark.parametrize("sequence", [b"\xf4\x90", b"\xed\xa0", b"\xc0", b"\xff", b"\xe0\x80", b"\x80"])
def test_invalid_text_is_refused_before_the_message_ends(peer, sequence):
    """RFC 6455, 8.1, and Autobahn: the server refuses it without waiting for the end of the message."""
    peer.send(frame(TEXT, b'{"type":"' + sequence, final=False))
    assert peer.fails() == INVALID


def test_invalid_text_is_refused_in_a_later_fragment(peer):
    peer.send(frame(TEXT, b'{"type":"\xce', final=False) + frame(CONTINUATION, b"\xba", final=False)
              + frame(CONTINUATION, b"\xce", final=False) + frame(CONTINUATION, b"\xce"))
    assert peer.fails() == INVALID


def test_pings_need_not_be_utf8(bare):
    bare.send(frame(PING, b"\xff\xfe\x80"))
    assert bare.pong() == b"\xff\xfe\x80"


# --- Closing (Autobahn 7)

VALID_CODES = [1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 1012, 1013, 1014, 3000, 3999, 4000, 4401, 4999]
INVALID_CODES = [0, 1, 999, 1004, 1005, 1006, 1015, 1016, 1100, 1999, 2000, 2999, 5000, 9999, 65534, 65535]


@pytest.mark.parametrize("code", VALID_CODES)
@pytest.mark.parametrize("reason", [b"", b"going", "κόσμε".encode(), b"x" * 123], ids=len)
def test_a_close_is_answered_with_its_code(bare, code, reason):
    bare.send(close_frame(code, reason))
    assert bare.closed() == code


@pytest.mark.parametrize("code", INVALID_CODES)
@pytest.mark.parametrize("reason", [b"", b"reason"])
def test_a_close_with_a_code_that_may_not_be_sent_is_refused(bare, code, reason):
    bare.send(close_frame(code, reason))
    assert bare.fails() == PROTOCOL_ERROR


def test_a_close_without_a_code(bare):
    bare.send(close_frame())
    assert bare.closed() in (None, NORMAL)


def test_a_close_of_one_octet_is_refused(bare):
    bare.send(frame(CLOSE, b"\x03"))
    assert bare.fails() == PROTOCOL_ERROR


@pytest.mark.parametrize("size", [124, 125, 1000, 65536])
def test_a_close_with_too_long_a_reason_is_refused(bare, size):
    bare.send(close_frame(1000, b"x" * size))
    assert bare.fails() == PROTOCOL_ERROR


@pytest.mark.parametrize("sequence", [b"\xff", b"\xce", b"\xed\xa0\x80", b"\xc0\xaf", b"\xf4\x90\x80\x80"])
def test_a_close_with_a_reason_that_is_not_utf8_is_refused(bare, sequence):
    bare.send(close_frame(1000, b"bye" + sequence))
    assert bare.fails() in (INVALID, PROTOCOL_ERROR)


@pytest.mark.parametrize("after", [frame(PING, b"late"), frame(TEXT, padded(50, 7)), close_frame(1001), frame(3, b"?"),
                                   b"\0" * 1000, frame(TEXT, b"{", final=False)])
def test_what_follows_a_close_is_passed_over(peer, after):
    peer.send(close_frame(NORMAL) + after)
    assert peer.closed() == NORMAL
    assert not peer.pongs


def test_a_close_within_a_message(peer):
    first, _ = fragments(padded(50, 7), [25])
    peer.send(first + close_frame(NORMAL))
    assert peer.closed() == NORMAL


def test_what_was_asked_before_a_close_harms_nobody(session):
    with session.join() as peer:
        peer.send(b"".join(frame(TEXT, padded(50, number)) for number in range(100)) + close_frame(NORMAL))
        assert peer.closed() == NORMAL
    with session.join() as peer:
        assert_alive(peer)


def test_the_server_ends_the_connection_though_its_close_is_not_answered():
    """The server begins to close, and the client sends no close frame."""
    with Server("--ping-interval", 0.5) as hasty, WebSocket(hasty) as peer:
        peer.send(frame(BINARY, b"x"))
        assert peer.closed(answers=False) == UNSUPPORTED
        hasty.wait_for(lambda: hasty.metric("oval4d_websockets") == 0)


@pytest.mark.parametrize("leave", ["fin", "reset", "within a frame", "within a message"])
def test_clients_that_just_go(server, session, leave):
    peer = session.join()
    if leave == "within a frame":
        peer.send(frame(TEXT, padded(200, 1))[:100])
    if leave == "within a message":
        peer.send(frame(TEXT, padded(200, 1), final=False))
    if leave == "reset":
        peer.reset()
    peer.socket.close()
    server.wait_for(lambda: server.metric("oval4d_websockets") == 0)
    with session.join() as another:
        assert_alive(another)


def test_a_half_closed_connection_is_answered(peer):
    peer.send(frame(TEXT, padded(50, 7)) + close_frame(NORMAL))
    peer.half_close()
    assert peer.answer_to(7)["type"] == "state"
    assert peer.closed() == NORMAL


# --- Limits and many messages (Autobahn 9)

def test_many_small_messages_are_answered_in_order(peer):
    count = 2000
    peer.send(b"".join(frame(TEXT, b'{"type":"shown","revision":0,"id":%d}' % number) for number in range(1, count + 1)))
    answered = []
    while len(answered) < count:
        message = json.loads(peer.next_message()[1])
        answered += [message["id"]] if "id" in message else []
    assert answered == list(range(1, count + 1))


@pytest.mark.parametrize("size", [1 << 17, 1 << 20, (8 << 20)])
@pytest.mark.parametrize("pieces", [1, 64, 1024])
def test_large_messages(peer, size, pieces):
    data = load_of(size, 7)
    assert len(data) == size
    peer.send(b"".join(fragments(data, [size * i // pieces for i in range(1, pieces)])))
    assert peer.answer_to(7)["code"] == "bad_polytope"
    assert_alive(peer)


def test_a_message_in_fragments_of_an_octet(peer):
    data = padded(1 << 14, 7)
    peer.send(b"".join(fragments(data, range(1, len(data)))))
    assert peer.answer_to(7)["type"] == "state"


@pytest.mark.parametrize("announced", [(8 << 20) + 1, 1 << 31, 1 << 32, (1 << 63) - 1])
def test_a_message_over_the_limit_is_refused_by_its_length_alone(peer, announced):
    peer.send(frame(TEXT, b"", announced=announced))
    assert peer.fails() == TOO_BIG


def test_fragments_over_the_limit_are_refused(peer):
    data = load_of((8 << 20) + 1, 7)
    peer.try_send(b"".join(fragments(data, [1 << 20, 3 << 20, 5 << 20, 8 << 20])))
    assert peer.fails() == TOO_BIG


def test_endless_fragments_are_refused(peer):
    peer.send(frame(TEXT, b'{"type":"load","data":"', final=False))
    sent = peer.flood(frame(CONTINUATION, b"x" * 60_000, final=False), 64 << 20)
    assert sent is not None, "64 MiB of one message were taken"


@pytest.mark.parametrize("size", [(64 << 10) + 1, 1 << 20, 7 << 20])
@pytest.mark.parametrize("text", ['{"type":"command","id":7,"line":"%s"}', '{"type":"get","what":"state","id":7}%s',
                                  '{"type":"set","id":7,"polytope":"%s"}', '{"id":7,"data":"%s"}'])
def test_only_a_load_may_be_large(peer, size, text):
    data = (text % (" " * (size - len(text) + 2))).encode()
    assert len(data) == size
    peer.try_send(frame(TEXT, data))
    assert peer.refuses_its_size()


@pytest.mark.parametrize("text", ['{"type":"load","name":"x","format":"off","data":"%s"}', '{"type":"hello"}%s'])
def test_before_hello_nothing_may_be_large(bare, text):
    bare.try_send(frame(TEXT, (text % (" " * ((64 << 10) + 1))).encode()))
    assert bare.refuses_its_size()


# --- The handshake (RFC 6455, section 4.2)

def shake(server, *lines, method="GET", version="HTTP/1.1", target="/ws"):
    with Socket(server) as raw:
        raw.send(request(target, *lines, method=method, version=version))
        return raw.answer()


UPGRADE, CONNECTION, VERSION = "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13"
KEY = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="
GOOD = [UPGRADE, CONNECTION, VERSION, KEY]


def test_the_key_is_answered_as_in_the_rfc(server):
    """The example of RFC 6455, section 1.3."""
    answer = shake(server, *GOOD)
    assert answer.status == 101
    assert answer.get("Sec-WebSocket-Accept") == "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=" == accept_for("dGhlIHNhbXBsZSBub25jZQ==")
    assert answer.get("Upgrade").lower() == "websocket" and answer.get("Connection").lower() == "upgrade"
    assert answer.get("Sec-WebSocket-Protocol") is None, "none was offered"
    for number in range(8):
        key = base64.b64encode(bytes([number] * 16)).decode()
        assert shake(server, *GOOD[:3], f"Sec-WebSocket-Key: {key}").get("Sec-WebSocket-Accept") == accept_for(key)


@pytest.mark.parametrize("lines", [
    ["upgrade: WEBSOCKET", "connection: UPGRADE", "sec-websocket-version: 13", "sec-websocket-key: " + KEY.split()[1]],
    [UPGRADE, "Connection: keep-alive, Upgrade", VERSION, KEY], [UPGRADE, "Connection:Upgrade,close", VERSION, KEY],
    [UPGRADE, "Connection: keep-alive", CONNECTION, VERSION, KEY], [KEY, VERSION, CONNECTION, UPGRADE],
    [UPGRADE, CONNECTION, VERSION, KEY + " "], GOOD + ["X-Unknown: 1"],
])
def test_handshakes_that_are_good(server, lines):
    assert shake(server, *lines).status == 101


@pytest.mark.parametrize("key", [
    None, "", base64.b64encode(b"x" * 15).decode(), base64.b64encode(b"x" * 17).decode(), base64.b64encode(b"x").decode(),
    base64.b64encode(b"x" * 32).decode(), "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZQ", "dGhlIHNhbXBsZSBub25jZQ===",
    "!!!!IHNhbXBsZSBub25jZQ==", "dGhlIHNhbXBs ZSBub25jZQ==", "x" * 24, "=" * 24, "dGhlIHNhbXBsZSBub25jZQ==, x", "x" * 4000,
])
def test_a_key_that_is_not_sixteen_octets_in_base64_is_refused(server, key):
    answer = shake(server, *GOOD[:3], *([] if key is None else [f"Sec-WebSocket-Key: {key}"]))
    assert answer.status == 400


def test_two_keys_are_refused(server):
    assert shake(server, *GOOD, "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==").status == 400


@pytest.mark.parametrize("version", ["0", "7", "8", "12", "14", "255", "99999999999999999999", "-13", "013", "13.0", "x", ""])
def test_another_version_is_told_the_right_one(server, version):
    answer = shake(server, UPGRADE, CONNECTION, f"Sec-WebSocket-Version: {version}", KEY)
    if version in ("7", "8", "12", "14"):
        assert answer.status == 426
    assert answer.status in (400, 426)
    if answer.status == 426:
        assert answer.get("Sec-WebSocket-Version") == "13"
        assert answer.get("Upgrade") == "websocket"  # RFC 9110, 15.5.22


def test_no_version(server):
    assert shake(server, UPGRADE, CONNECTION, KEY).status in (400, 426)


@pytest.mark.parametrize("lines", [
    [CONNECTION, VERSION, KEY], [UPGRADE, VERSION, KEY], ["Upgrade: websocke", CONNECTION, VERSION, KEY],
    ["Upgrade: websockets", CONNECTION, VERSION, KEY], ["Upgrade: h2c", CONNECTION, VERSION, KEY],
    [UPGRADE, "Connection: keep-alive", VERSION, KEY], [UPGRADE, "Connection: Upgrade2", VERSION, KEY],
    [UPGRADE, "Connection: close", VERSION, KEY],
])
def test_what_is_no_upgrade_to_a_websocket(server, lines):
    answer = shake(server, *lines)
    assert 400 <= answer.status < 500


@pytest.mark.parametrize("method", ["POST", "PUT", "HEAD", "OPTIONS", "DELETE", "PATCH", "get", "FOO"])
def test_a_websocket_begins_with_get(server, method):
    with Socket(server) as raw:
        raw.send(request("/ws", *GOOD, method=method))
        assert raw.answer(method).status in (400, 404, 405, 426, 501)


@pytest.mark.parametrize("version", ["HTTP/1.0", "HTTP/0.9"])
def test_a_websocket_needs_http_1_1(server, version):
    assert 400 <= shake(server, *GOOD, version=version).status < 600


@pytest.mark.parametrize("lines", [["Content-Length: 5"], ["Transfer-Encoding: chunked"]])
def test_a_handshake_has_no_body(server, lines):
    with Socket(server) as raw:
        raw.send(request("/ws", *GOOD, *lines) + b"5\r\nhello\r\n0\r\n\r\n")
        answer = raw.answer()
        assert answer.status in (400, 411, 413, 501)
        assert raw.ends() == b""


@pytest.mark.parametrize("offered, chosen", [
    (["oval4d.v1"], "oval4d.v1"), (["other, oval4d.v1"], "oval4d.v1"), (["other", "oval4d.v1"], "oval4d.v1"),
    (["oval4d.v1", "other"], "oval4d.v1"), (["a", "b", "c,oval4d.v1 ,d"], "oval4d.v1"), (["oval4d.v2"], None),
    (["other", "another"], None), (["OVAL4D.V1"], None), (["oval4d.v1x"], None), (["x oval4d.v1"], None), ([], ""),
])
def test_subprotocols_are_one_list(server, offered, chosen):
    answer = shake(server, *GOOD, *(f"Sec-WebSocket-Protocol: {text}" for text in offered))
    if chosen is None:
        assert answer.status == 400
    else:
        assert answer.status == 101 and (answer.get("Sec-WebSocket-Protocol") or "") == chosen


@pytest.mark.parametrize("offer", ["permessage-deflate", "permessage-deflate; client_max_window_bits, x-webkit-deflate-frame",
                                   "permessage-deflate; server_max_window_bits=1", "unknown; a=b", "x" * 2000])
def test_extensions_are_not_negotiated(server, offer):
    with WebSocket(server, "/ws", f"Sec-WebSocket-Extensions: {offer}") as peer:
        assert peer.upgraded.get("Sec-WebSocket-Extensions") is None
        peer.send(frame(TEXT, padded(50, 1), reserved=4))
        assert peer.fails() == PROTOCOL_ERROR


def test_a_handshake_octet_by_octet(server):
    with Socket(server) as raw:
        for octet in handshake():
            raw.send(bytes([octet]))
        assert raw.answer().status == 101


def test_the_socket_after_all_this(session):
    """Comes last: none of the tests above has caused an internal error of the server."""
    with session.join() as peer:
        peer.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        assert_alive(peer)
    assert "fault=" not in session.server.log()
