"""Single WebSocket frames (RFC 6455), as in groups 1 to 4 of the Autobahn test suite: lengths, masks, pings, reserved bits
and opcodes. Many cases send bytes that no library would send.
"""

import json

import pytest
from raw import BINARY, CLOSE, CONTINUATION, PING, PONG, TEXT, frame
from websocket_messages import INVALID, PROTOCOL_ERROR, TOO_BIG, UNSUPPORTED, assert_answers, padded_request

# --- Frames of all sizes, in one piece or in several (Autobahn 1)

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


# --- Frames of clients must be masked

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


# --- Pings are answered, and pongs are ignored (Autobahn 2)

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


# --- Reserved bits are refused (Autobahn 3)

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


# --- Reserved opcodes are refused (Autobahn 4)

@pytest.mark.parametrize("opcode", [3, 4, 5, 6, 7, 11, 12, 13, 14, 15])
@pytest.mark.parametrize("payload", [b"", b"reserved opcode payload"])
def test_reserved_opcodes_are_refused(peer, opcode, payload):
    peer.send(frame(PING, b"before") + frame(opcode, payload) + frame(PING, b"after"))
    assert peer.next_pong() == b"before"
    assert peer.wait_for_failure_code() == PROTOCOL_ERROR
