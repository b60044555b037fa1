"""WebSocket messages (RFC 6455), as in groups 5, 6 and 9 of the Autobahn test suite: fragments, UTF-8, and the limits of
their size. Many cases send bytes that no library would send.
"""

import json
import socket
import struct

import pytest
from raw import BINARY, CLOSE, CONTINUATION, PING, PONG, TEXT, frame
from websocket_messages import INVALID, PROTOCOL_ERROR, TOO_BIG, assert_answers, fragments, padded_request


def load_message(size, number):
    """Returns a load message of `size` bytes; the server answers it with an error."""
    text = b'{"type":"load","id":%d,"name":"x","format":"off","data":"#' % number
    return text + b"x" * (size - len(text) - 2) + b'"}'


def command_with_text(text, number):
    """Returns a command that the server answers with an error that contains the text."""
    return json.dumps({"type": "command", "id": number, "line": "polytope " + text}, ensure_ascii=False).encode()


# --- Fragmented messages (Autobahn 5)

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


# --- Messages must be valid UTF-8 (Autobahn 6)

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


# --- Limits on messages, and many messages (Autobahn 9)

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


def test_the_tests_above_caused_no_internal_error(session):
    """Comes last: none of the tests above has caused an internal error of the server."""
    with session.join() as peer:
        peer.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        assert_answers(peer)
    assert "fault=" not in session.server.log()
