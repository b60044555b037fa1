"""A site to which hostile HTTP requests are sent, and what the server may answer to them."""

from raw import Socket, request

REFUSED = (400, 405, 411, 413, 414, 417, 431, 501, 505)
PAGE = b"<!doctype html><title>page</title>\n" * 40
SCRIPT = bytes(range(32, 127)) * 20
SMUGGLED = request("/api/v1/smuggled")


def responses_to(server, data, method="GET"):
    """Sends bytes and half-closes; returns all responses. Asserts that the connection ends, and that no response
    answers the smuggled request."""
    with Socket(server) as raw:
        raw.try_send(data)
        raw.half_close()
        answers = raw.read_responses(method)
    assert not any(b"smuggled" in answer.body for answer in answers), "a body was read as a request"
    return answers


def assert_refused_and_closed(server, data, statuses=REFUSED):
    """Asserts one response, which refuses the request, and then that the server ends the connection."""
    with Socket(server) as raw:
        raw.try_send(data)
        answer = raw.read_response()
        assert answer.status in statuses, answer
        assert answer.get("Connection") == "close"
        assert raw.read_responses() == [], "a second response"
