"""Close codes, and messages that the tests of WebSockets send, whole or in fragments."""

from raw import CONTINUATION, TEXT, frame

NORMAL, PROTOCOL_ERROR, UNSUPPORTED, INVALID, TOO_BIG = 1000, 1002, 1003, 1007, 1009


def padded_request(size, number):
    """Returns a request of `size` bytes, padded with blanks, which are valid after JSON."""
    text = b'{"type":"get","what":"state","id":%d}' % number if size >= 50 else b'{"id":%d}' % number
    assert len(text) <= size
    return text.ljust(size)


def assert_answers(peer, number=999_999):
    peer.send(frame(TEXT, padded_request(50, number)))
    assert peer.wait_for_answer(number)["type"] == "state"


def fragments(data, cuts, opcode=TEXT):
    """Returns the frames of a message that is split at these positions."""
    bounds = [0, *cuts, len(data)]
    pieces = [data[a:b] for a, b in zip(bounds, bounds[1:])]
    return [frame(opcode if i == 0 else CONTINUATION, piece, final=i == len(pieces) - 1) for i, piece in enumerate(pieces)]
