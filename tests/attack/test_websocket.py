"""WebSocket conformance (RFC 6455), with the groups of cases of the Autobahn test suite: framing, pings, reserved bits
and opcodes, fragments, UTF-8, closing, limits, and the handshake. Many cases send bytes that no library would send.
"""

import base64
import json
import socket
import struct

import pytest
from harness import Server
from raw import (BINARY, CLOSE, CONTINUATION, PING, PONG, TEXT, SharedSession, Socket, WebSocket, accept_value, close_frame,
                 frame, handshake, request)

NORMAL, PROTOCOL_ERROR, UNSUPPORTED, INVALID, TOO_BIG = 1000, 1002, 1003, 1007, 1009


@pytest.fixture(name="session", scope="module")
def create_session(server):
    return SharedSession(server)


@pytest.fixture(name="peer")
def join_session(session):
    """A WebSocket that has joined the session."""
    with session.join() as joined:
        yield joined


@pytest.fixture(name="peer_without_hello")
def open_websocket(server):
    """A WebSocket before its hello."""
    with WebSocket(server) as opened:
        yield opened


def padded_request(size, number):
    """Returns a request of `size` bytes, padded with blanks, which are valid after JSON."""
    text = b'{"type":"get","what":"state","id":%d}' % number if size >= 50 else b'{"id":%d}' % number
    assert len(text) <= size
    return text.ljust(size)


def load_message(size, number):
    """Returns a load message of `size` bytes; the server answers it with an error."""
    text = b'{"type":"load","id":%d,"name":"x","format":"off","data":"#' % number
    return text + b"x" * (size - len(text) - 2) + b'"}'


def command_with_text(text, number):
    """Returns a command that the server answers with an error that contains the text."""
    return json.dumps({"type": "command", "id": number, "line": "polytope " + text}, ensure_ascii=False).encode()


def assert_answers(peer, number=999_999):
    peer.send(frame(TEXT, padded_request(50, number)))
    assert peer.wait_for_answer(number)["type"] == "state"


# --- Framing (Autobahn 1)

@pytest.mark.parametrize("size", [10, 50, 124, 125, 126, 127, 128, 254, 255, 256, 1000, 65534, 65535, 65536])
@pytest.mark.parametrize("piece", [None, 997])
def test_text_frames_of_every_length_are_answered(peer, size, piece):
    data = frame(TEXT, padded_request(size, 7))
    step = piece or len(data)
    for at in range(0, len(data), step):
        peer.send(data[at:at + step])
    assert peer.wait_for_answer(7)["type"] == ("state" if size >= 50 else "error")
    assert_answers(peer)


@pytest.mark.parametrize("size", [10, 50, 125, 126, 127, 1000])
def test_a_text_frame_sent_byte_by_byte_is_answered(peer, size):
    for octet in frame(TEXT, padded_request(size, 7)):
        peer.send(bytes([octet]))
    assert peer.wait_for_answer(7)["type"] == ("state" if size >= 50 else "error")


def test_an_empty_text_is_refused(peer):
    peer.send(frame(TEXT))
    assert peer.wait_for_failure_code() == INVALID


@pytest.mark.parametrize("size", [0, 1, 125, 126, 127, 128, 1000, 65535, 65536])
def test_binary_messages_are_refused(peer, size):
    peer.send(frame(BINARY, b"\xfe" * size))
    assert peer.wait_for_failure_code() == UNSUPPORTED


@pytest.mark.parametrize("size, length_bits", [(0, 16), (50, 16), (125, 16), (0, 64), (50, 64), (125, 64), (126, 64), (65535, 64)])
def test_a_nonminimal_length_encoding_is_refused(peer, size, length_bits):
    peer.send(frame(TEXT, padded_request(size, 1) if size else b"", length_bits=length_bits))
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


@pytest.mark.parametrize("announced_length", [1 << 63, (1 << 64) - 1, (1 << 63) + 50])
def test_a_length_with_its_highest_bit_set_is_refused(peer, announced_length):
    peer.send(frame(TEXT, b"", length_bits=64, announced_length=announced_length))
    assert peer.wait_for_failure_code() in (PROTOCOL_ERROR, TOO_BIG)


def test_many_frames_sent_at_once_are_answered_in_order(peer):
    peer.send(b"".join(frame(TEXT, padded_request(50, number)) for number in range(1, 101)))
    answered = []
    while len(answered) < 100:
        message = json.loads(peer.next_message()[1])
        answered += [message["id"]] if "id" in message else []
    assert answered == list(range(1, 101))


# --- Masks

@pytest.mark.parametrize("opcode, payload", [(TEXT, padded_request(50, 1)), (TEXT, b""), (BINARY, b"x"), (PING, b"x"), (PONG, b""),
                                             (CLOSE, b"\x03\xe8"), (CONTINUATION, b"x")])
def test_unmasked_frames_are_refused(peer, opcode, payload):
    peer.send(frame(opcode, payload, mask=None))
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


@pytest.mark.parametrize("mask", [b"\0\0\0\0", b"\xff\xff\xff\xff", b"\0\0\0\1", b"\x80\0\0\0"])
def test_special_masks_are_accepted(peer, mask):
    for size in (50, 51, 52, 53, 200):
        peer.send(frame(TEXT, padded_request(size, size), mask=mask))
        assert peer.wait_for_answer(size)["type"] == "state"


# --- Pings and pongs (Autobahn 2)

@pytest.mark.parametrize("payload", [b"", b"x", b"Hello, world!", b"\x00\xff\xfe\xfd\xfc\xfb\x00\xff", b"\xfe" * 124,
                                     b"\xfe" * 125], ids=len)
@pytest.mark.parametrize("byte_by_byte", [False, True])
def test_a_ping_is_answered_with_its_payload(peer_without_hello, payload, byte_by_byte):
    data = frame(PING, payload)
    for piece in ([data[i:i + 1] for i in range(len(data))] if byte_by_byte else [data]):
        peer_without_hello.send(piece)
    assert peer_without_hello.next_pong() == payload


@pytest.mark.parametrize("opcode", [PING, PONG])
@pytest.mark.parametrize("size", [126, 127, 1000, 65536])
def test_a_too_long_ping_or_pong_is_refused(peer_without_hello, opcode, size):
    peer_without_hello.send(frame(opcode, b"\xfe" * size))
    assert peer_without_hello.wait_for_failure_code() == PROTOCOL_ERROR


@pytest.mark.parametrize("payload", [b"", b"unsolicited"])
def test_an_unsolicited_pong_is_ignored(peer_without_hello, payload):
    peer_without_hello.send(frame(PONG, payload) * 3 + frame(PING, b"after") + frame(PONG, payload))
    assert peer_without_hello.next_pong() == b"after"
    peer_without_hello.send(frame(PING, b"again"))
    assert peer_without_hello.next_pong() == b"again" and not peer_without_hello.pongs


def test_pings_are_answered_in_order(peer_without_hello):
    peer_without_hello.send(b"".join(frame(PING, b"payload-%d" % number) for number in range(10)))
    assert [peer_without_hello.next_pong() for _ in range(10)] == [b"payload-%d" % number for number in range(10)]
    peer_without_hello.send(b"".join(frame(PING, b"%d" % number) for number in range(200)))
    assert [peer_without_hello.next_pong() for _ in range(200)] == [b"%d" % number for number in range(200)]


# --- Reserved bits (Autobahn 3)

@pytest.mark.parametrize("reserved", range(1, 8))
@pytest.mark.parametrize("opcode, payload", [(TEXT, padded_request(50, 1)), (PING, b"x"), (PONG, b""), (CLOSE, b"\x03\xe8"),
                                             (TEXT, b"")])
def test_reserved_bits_are_refused(peer, reserved, opcode, payload):
    peer.send(frame(PING, b"before") + frame(opcode, payload, reserved=reserved) + frame(PING, b"after"))
    assert peer.next_pong() == b"before"
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR
    assert not peer.pongs


def test_reserved_bits_in_a_continuation_are_refused(peer):
    peer.send(frame(TEXT, padded_request(50, 1)[:20], final=False) + frame(CONTINUATION, padded_request(50, 1)[20:], reserved=4))
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


# --- Reserved opcodes (Autobahn 4)

@pytest.mark.parametrize("opcode", [3, 4, 5, 6, 7, 11, 12, 13, 14, 15])
@pytest.mark.parametrize("payload", [b"", b"reserved opcode payload"])
def test_reserved_opcodes_are_refused(peer, opcode, payload):
    peer.send(frame(PING, b"before") + frame(opcode, payload) + frame(PING, b"after"))
    assert peer.next_pong() == b"before"
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


# --- Fragments (Autobahn 5)

def fragments(data, cuts, opcode=TEXT):
    """Returns the frames of a message that is split at these positions."""
    bounds = [0, *cuts, len(data)]
    pieces = [data[a:b] for a, b in zip(bounds, bounds[1:])]
    return [frame(opcode if i == 0 else CONTINUATION, piece, final=i == len(pieces) - 1) for i, piece in enumerate(pieces)]


@pytest.mark.parametrize("cuts", [[20], [0], [50], [0, 0, 0], [1, 2, 3, 4], [50, 50], list(range(1, 50))])
@pytest.mark.parametrize("between", [b"", frame(PING, b"between"), frame(PONG, b"unsolicited")], ids=["no control frame", "ping", "pong"])
@pytest.mark.parametrize("byte_by_byte", [False, True])
def test_a_fragmented_message_is_answered(peer, cuts, between, byte_by_byte):
    data = between.join(fragments(padded_request(50, 7), cuts))
    for piece in ([data[i:i + 1] for i in range(len(data))] if byte_by_byte else [data]):
        peer.send(piece)
    assert peer.wait_for_answer(7)["type"] == "state"
    ping_count = len(cuts) if between == frame(PING, b"between") else 0
    assert peer.pongs == [b"between"] * ping_count
    assert_answers(peer)


def test_a_ping_between_fragments_is_answered_at_once(peer):
    first, second = fragments(padded_request(50, 7), [25])
    peer.send(first + frame(PING, b"within"))
    assert peer.next_pong() == b"within"
    peer.send(second)
    assert peer.wait_for_answer(7)["type"] == "state"


@pytest.mark.parametrize("opcode, payload", [(PING, b"x"), (PING, b""), (PONG, b"x"), (CLOSE, b""), (CLOSE, b"\x03\xe8")])
def test_fragmented_control_frames_are_refused(peer_without_hello, opcode, payload):
    peer_without_hello.send(frame(opcode, payload, final=False) + frame(CONTINUATION, payload))
    assert peer_without_hello.wait_for_failure_code() == PROTOCOL_ERROR
    assert not peer_without_hello.pongs


@pytest.mark.parametrize("final", [True, False])
@pytest.mark.parametrize("payload", [b"", b"nothing to continue"])
def test_a_continuation_without_a_message_is_refused(peer, final, payload):
    peer.send(frame(CONTINUATION, payload, final=final) + frame(TEXT, padded_request(50, 7)))
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


def test_a_continuation_after_a_finished_message_is_refused(peer):
    assert_answers(peer)
    peer.send(b"".join(fragments(padded_request(50, 7), [20])) + frame(CONTINUATION, b"more"))
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


@pytest.mark.parametrize("opcode", [TEXT, BINARY])
@pytest.mark.parametrize("final", [True, False])
def test_a_new_message_within_a_fragmented_message_is_refused(peer, opcode, final):
    first, _ = fragments(padded_request(50, 7), [25])
    peer.send(first + frame(opcode, padded_request(50, 8), final=final))
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR


# --- UTF-8 (Autobahn 6)

VALID_TEXTS = ["κόσμε", "Hello-µ@ßöäüàá-UTF-8!!", "\u0080", "\u07ff", "\u0800", "\uffff", "\U00010000", "\U0010ffff", "\ud7ff",
               "\ue000", "\ufffd", "\ufffe", "\ufdd0", "\U0001fffe", "\U0001ffff", "\U0008ffff", "\U000fffff", "\U0010fffe",
               "\ufeff", "\u200b", "日本語", "𝄞𝄢", "e\u0301", "\u202e"]

INVALID_SEQUENCES = {
    "lone continuation byte 80": b"\x80", "lone continuation byte bf": b"\xbf", "two continuation bytes": b"\x80\xbf",
    "all continuation bytes": bytes(range(0x80, 0xc0)), "lone starts of 2 bytes": b"".join(bytes([c, 32]) for c in range(0xc0, 0xe0)),
    "lone starts of 3 bytes": b"".join(bytes([c, 32]) for c in range(0xe0, 0xf0)),
    "lone starts of 4 bytes": b"".join(bytes([c, 32]) for c in range(0xf0, 0xf8)), "start of 5 bytes": b"\xf8 ", "start of 6 bytes": b"\xfc ",
    "2 bytes without the last": b"\xdf ", "3 bytes without the last": b"\xef\xbf ", "3 bytes without the last two": b"\xe1 ",
    "4 bytes without the last": b"\xf4\x80\x80 ", "4 bytes without the last two": b"\xf1\x80 ", "byte fe": b"\xfe", "byte ff": b"\xff",
    "bytes fe fe ff ff": b"\xfe\xfe\xff\xff",
    "overlong slash of 2 bytes": b"\xc0\xaf", "overlong slash of 3 bytes": b"\xe0\x80\xaf", "overlong slash of 4 bytes": b"\xf0\x80\x80\xaf",
    "overlong slash of 5 bytes": b"\xf8\x80\x80\x80\xaf", "overlong slash of 6 bytes": b"\xfc\x80\x80\x80\x80\xaf",
    "overlong 7f": b"\xc1\xbf", "overlong 7ff": b"\xe0\x9f\xbf", "overlong ffff": b"\xf0\x8f\xbf\xbf",
    "overlong 1fffff": b"\xf8\x87\xbf\xbf\xbf", "overlong NUL of 2 bytes": b"\xc0\x80", "overlong NUL of 3 bytes": b"\xe0\x80\x80",
    "overlong NUL of 4 bytes": b"\xf0\x80\x80\x80", "surrogate d800": b"\xed\xa0\x80", "surrogate db7f": b"\xed\xad\xbf",
    "surrogate dc00": b"\xed\xb0\x80", "surrogate dfff": b"\xed\xbf\xbf", "surrogate pair": b"\xed\xa0\x80\xed\xb0\x80",
    "code point 110000": b"\xf4\x90\x80\x80", "code point 13ffff": b"\xf4\xbf\xbf\xbf", "code point 140000": b"\xf5\x80\x80\x80",
    "code point 1fffff": b"\xf7\xbf\xbf\xbf", "5 bytes": b"\xf8\x88\x80\x80\x80", "6 bytes": b"\xfd\xbf\xbf\xbf\xbf\xbf",
    "valid text, then a surrogate": "κόσμε".encode() + b"\xed\xa0\x80edited",
}


@pytest.mark.parametrize("text", VALID_TEXTS, ids=ascii)
def test_valid_utf8_is_accepted(peer, text):
    peer.send(frame(TEXT, command_with_text(text, 7)))
    assert text in peer.wait_for_answer(7)["message"]


@pytest.mark.parametrize("text", ["κόσμε", "\U0010ffff", "\uffff", "𝄞x"], ids=ascii)
def test_code_points_split_across_fragments_and_segments_are_accepted(peer, text):
    data = command_with_text(text, 7)
    for split in range(1, len(data)):
        peer.send(b"".join(fragments(data, [split])))
        assert text in peer.wait_for_answer(7)["message"]
    peer.send(b"".join(fragments(data, range(1, len(data)))))
    assert text in peer.wait_for_answer(7)["message"]
    for octet in frame(TEXT, data):
        peer.send(bytes([octet]))
    assert text in peer.wait_for_answer(7)["message"]


@pytest.mark.parametrize("sequence", INVALID_SEQUENCES.values(), ids=INVALID_SEQUENCES)
@pytest.mark.parametrize("split", [False, True])
def test_invalid_utf8_is_refused(peer, sequence, split):
    data = command_with_text("@", 7).replace(b"@", sequence)
    at = data.index(sequence)
    peer.send(b"".join(fragments(data, [at + 1])) if split else frame(TEXT, data))
    assert peer.wait_for_failure_code() == INVALID


@pytest.mark.parametrize("sequence", [b"\xce", b"\xf4", b"\xf4\x8f", b"\xf4\x8f\xbf", b"\xe1\x80"])
def test_text_that_ends_within_a_code_point_is_refused(peer, sequence):
    peer.send(frame(TEXT, b'{"id":1,"type":"' + sequence))
    assert peer.wait_for_failure_code() == INVALID


@pytest.mark.parametrize("sequence", [b"\xf4\x90", b"\xed\xa0", b"\xc0", b"\xff", b"\xe0\x80", b"\x80"])
def test_invalid_utf8_is_refused_before_the_message_ends(peer, sequence):
    """RFC 6455, 8.1, and Autobahn: the server refuses it without waiting for the end of the message."""
    peer.send(frame(TEXT, b'{"type":"' + sequence, final=False))
    assert peer.wait_for_failure_code() == INVALID


def test_invalid_utf8_in_a_later_fragment_is_refused(peer):
    peer.send(frame(TEXT, b'{"type":"\xce', final=False) + frame(CONTINUATION, b"\xba", final=False)
              + frame(CONTINUATION, b"\xce", final=False) + frame(CONTINUATION, b"\xce"))
    assert peer.wait_for_failure_code() == INVALID


def test_pings_need_not_be_utf8(peer_without_hello):
    peer_without_hello.send(frame(PING, b"\xff\xfe\x80"))
    assert peer_without_hello.next_pong() == b"\xff\xfe\x80"


# --- Closing (Autobahn 7)

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


def test_a_half_closed_connection_is_answered(peer):
    peer.send(frame(TEXT, padded_request(50, 7)) + close_frame(NORMAL))
    peer.half_close()
    assert peer.wait_for_answer(7)["type"] == "state"
    assert peer.wait_for_close_code() == NORMAL


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
def test_large_load_messages_are_answered(peer, size, pieces):
    data = load_message(size, 7)
    assert len(data) == size
    peer.send(b"".join(fragments(data, [size * i // pieces for i in range(1, pieces)])))
    assert peer.wait_for_answer(7)["code"] == "bad_polytope"
    assert_answers(peer)


def test_a_message_in_fragments_of_one_byte_is_answered(peer):
    data = padded_request(1 << 14, 7)
    peer.send(b"".join(fragments(data, range(1, len(data)))))
    assert peer.wait_for_answer(7)["type"] == "state"


@pytest.mark.parametrize("announced_length", [(8 << 20) + 1, 1 << 31, 1 << 32, (1 << 63) - 1])
def test_a_too_large_message_is_refused_by_its_announced_length(peer, announced_length):
    peer.send(frame(TEXT, b"", announced_length=announced_length))
    assert peer.wait_for_failure_code() == TOO_BIG


def test_fragments_that_exceed_the_message_limit_are_refused(peer):
    data = load_message((8 << 20) + 1, 7)
    peer.try_send(b"".join(fragments(data, [1 << 20, 3 << 20, 5 << 20, 8 << 20])))
    assert peer.wait_for_failure_code() == TOO_BIG


def test_endless_fragments_are_refused(peer):
    peer.send(frame(TEXT, b'{"type":"load","data":"', final=False))
    sent = peer.flood(frame(CONTINUATION, b"x" * 60_000, final=False), 64 << 20)
    assert sent is not None, "64 MiB of one message were accepted"


@pytest.mark.parametrize("size", [(64 << 10) + 1, 1 << 20, 7 << 20])
@pytest.mark.parametrize("text", ['{"type":"command","id":7,"line":"%s"}', '{"type":"get","what":"state","id":7}%s',
                                  '{"type":"set","id":7,"polytope":"%s"}', '{"id":7,"data":"%s"}'])
def test_large_messages_other_than_load_are_refused(peer, size, text):
    data = (text % (" " * (size - len(text) + 2))).encode()
    assert len(data) == size
    peer.try_send(frame(TEXT, data))
    assert peer.refuses_message_as_too_large()


@pytest.mark.parametrize("text", ['{"type":"load","name":"x","format":"off","data":"%s"}', '{"type":"hello"}%s'])
def test_large_messages_before_hello_are_refused(peer_without_hello, text):
    peer_without_hello.try_send(frame(TEXT, (text % (" " * ((64 << 10) + 1))).encode()))
    assert peer_without_hello.refuses_message_as_too_large()


# --- The handshake (RFC 6455, section 4.2)

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
        assert answer.get("Upgrade") == "websocket"  # RFC 9110, 15.5.22


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


def test_the_tests_above_caused_no_internal_error(session):
    """Comes last: none of the tests above has caused an internal error of the server."""
    with session.join() as peer:
        peer.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        assert_answers(peer)
    assert "fault=" not in session.server.log()
