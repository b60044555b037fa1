"""Bodies of HTTP requests: request smuggling, which depends on where a body ends, and clients that expect 100 Continue."""

import pytest
from harness import Server
from http_site import REFUSED, SCRIPT, SMUGGLED, assert_refused_and_closed, responses_to
from raw import Socket, request


def assert_body_discarded_or_refused(server, data):
    """Sends a request with an unexpected body, then a valid one; asserts that both are answered, or the first is
    refused and the connection ends."""
    answers = responses_to(server, data + request("/healthz", close=True))
    assert answers, "no response"
    if answers[0].get("Connection") == "close":
        assert len(answers) == 1 and answers[0].status in REFUSED
    else:
        assert [answer.status for answer in answers[1:]] == [200], answers


# --- Request smuggling: the server and a proxy must agree where a body ends (RFC 9112, section 6)

INVALID_TRANSFER_ENCODINGS = [
    "chunked, chunked", "gzip, chunked", "chunked, gzip", "gzip", "identity", "x", "", "chunked, identity", "identity, chunked",
    "xchunked", "chunked;q=1", "chunked; a=b", "\"chunked\"", "'chunked'", "chunked chunked", "chunked\x0b", "\x0bchunked",
    "chunke", "chunkedx", ",chunked", "chunked,", "chu\x00nked", "=?utf-8?q?chunked?=", "chunked\r\n , identity",
    "\r\n chunked", "\r\n\tchunked", "cow, chunked", "deflate", "compress, chunked",
]
CHUNKED = b"0\r\n\r\n"


@pytest.mark.parametrize("coding", INVALID_TRANSFER_ENCODINGS, ids=ascii)
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_transfer_codings_other_than_chunked_are_refused(site_server, coding, method):
    head = request("/", f"Transfer-Encoding: {coding}", method=method)
    assert_refused_and_closed(site_server, head + b"%x\r\n%s\r\n0\r\n\r\n" % (len(SMUGGLED), SMUGGLED))
    assert_refused_and_closed(site_server, head + SMUGGLED)


@pytest.mark.parametrize("lines", [
    ["Transfer-Encoding: chunked", "Transfer-Encoding: chunked"], ["Transfer-Encoding: chunked", "Transfer-Encoding: identity"],
    ["Transfer-Encoding: identity", "Transfer-Encoding: chunked"], ["Transfer-Encoding: chunked", "Content-Length: 5"],
    ["Content-Length: 5", "Transfer-Encoding: chunked"], ["Content-Length: 0", "Transfer-Encoding: chunked"],
    ["Transfer-Encoding: x", "Content-Length: 0"], ["Transfer-Encoding : chunked"], ["Transfer-Encoding\t: chunked"],
    ["Content-Length : 5"], [" Transfer-Encoding: chunked"], ["X: y", " Transfer-Encoding: chunked", "Transfer-Encoding: x"],
    ["Transfer-Encoding: gzip", "Transfer-Encoding: chunked"],
])
def test_ambiguous_body_lengths_are_refused(site_server, lines):
    assert_refused_and_closed(site_server, request("/", *lines) + CHUNKED + SMUGGLED)


@pytest.mark.parametrize("coding", ["chunked", "Chunked", "CHUNKED", "  chunked", "chunked  ", "\tchunked"])
@pytest.mark.parametrize("version", ["HTTP/1.0", "HTTP/1.1"])
def test_chunked_bodies_are_discarded_or_refused(site_server, coding, version):
    head = request("/", f"Transfer-Encoding: {coding}", version=version)
    body = b"%x\r\n%s\r\n0\r\n\r\n" % (len(SMUGGLED), SMUGGLED)
    if version == "HTTP/1.0":
        # HTTP/1.0 has no chunked encoding, so the framing is faulty (RFC 9112, section 6.1).
        assert_refused_and_closed(site_server, head + body)
    else:
        assert_body_discarded_or_refused(site_server, head + body)


@pytest.mark.parametrize("body", [
    b"0;a=b\r\n\r\n", b"0\r\nTrailer: x\r\n\r\n", b"00000\r\n\r\n", b"5\r\nhello\r\n0\r\n\r\n", b"5;x\r\nhello\r\n0\r\n\r\n",
    b"A\r\n0123456789\r\n0\r\n\r\n", b'5;a="b\\"c"\r\nhello\r\n0\r\n\r\n',
])
def test_unusual_valid_chunks_are_discarded_or_refused(site_server, body):
    assert_body_discarded_or_refused(site_server, request("/", "Transfer-Encoding: chunked") + body)


@pytest.mark.parametrize("body", [
    b"5\r\nhelloX\r\n0\r\n\r\n", b"-5\r\nhello\r\n0\r\n\r\n", b"+5\r\nhello\r\n0\r\n\r\n", b"0x5\r\nhello\r\n0\r\n\r\n",
    b"\r\n5\r\nhello\r\n0\r\n\r\n", b"5\nhello\n0\n\n", b"5 5\r\nhello\r\n0\r\n\r\n", b"g\r\n", b"\r\n\r\n",
    b"ffffffffffffffff\r\nhello", b"10000000000000005\r\nhello\r\n0\r\n\r\n", b"5\r\nhello\r\n0\r\nbad trailer\r\n\r\n",
    b"5\rhello\r0\r\r", b"fffffffffffffffffffff\r\n",
])
def test_malformed_chunks_are_refused(site_server, body):
    assert_refused_and_closed(site_server, request("/", "Transfer-Encoding: chunked") + body + SMUGGLED)


@pytest.mark.parametrize("lines", [
    ["Content-Length: 5", "Content-Length: 6"], ["Content-Length: 5", "Content-Length: 5"], ["Content-Length: 0", "Content-Length: 0"],
    ["Content-Length: 5, 5"], ["Content-Length: 5, 6"], ["Content-Length: -1"], ["Content-Length: +5"], ["Content-Length: 0x5"],
    ["Content-Length: 5 5"], ["Content-Length: 5;"], ["Content-Length: "], ["Content-Length: five"], ["Content-Length: 5.0"],
    ["Content-Length: 1e1"], ["Content-Length: 99999999999999999999999999"], ["Content-Length: 18446744073709551616"],
    ["Content-Length: 18446744073709551617"], ["Content-Length: 18446744073709551615"], ["Content-Length: 9223372036854775808"],
    ["Content-Length: 4294967301"], ["Content-Length: 5\r\n 5"], ["Content-Length: \x0b5"], ["Content-Length: 5\x00"],
    ["Content-Length: ５".encode().decode("latin-1")], ["Content-Length: 100000000"], ["Content-Length: 5_0"],
])
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_malformed_content_lengths_are_refused(site_server, lines, method):
    assert_refused_and_closed(site_server, request("/", *lines, method=method) + b"hello" + SMUGGLED)


@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH"])
@pytest.mark.parametrize("size", [0, 5, len(SMUGGLED), 10_000])
def test_bodies_are_discarded_or_refused(site_server, method, size):
    body = SMUGGLED.ljust(size, b"x")[:size]
    with Socket(site_server) as raw:
        raw.try_send(request("/", f"Content-Length: {size}", method=method) + body + request("/healthz", close=True))
        first = raw.read_response(method)
        rest = raw.read_responses()
    assert not any(b"smuggled" in answer.body for answer in rest)
    if first.get("Connection") == "close":
        assert not rest and (size or method not in ("GET", "HEAD"))
    else:
        assert [answer.body for answer in rest] == [b"ok\n"]


def test_the_token_is_checked_before_the_body_arrives():
    """A client without a token gets its answer before any of the body has arrived."""
    with Server("--host", "0.0.0.0", "--token", "open-sesame") as server:
        server.host = "127.0.0.1"
        for lines in (["Content-Length: 1000"], ["Transfer-Encoding: chunked"]):
            with Socket(server) as raw:
                raw.send(request("/api/v1/keymap", *lines, method="POST"))
                assert raw.read_response().status in (401, *REFUSED)
                assert raw.read_until_end() == b""


# --- The header field Expect (RFC 9110, section 10.1.1)

@pytest.mark.parametrize("expectation", ["100-continue", "100-Continue"])
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_expect_100_continue_is_answered_at_once(site_server, expectation, method):
    with Socket(site_server) as raw:
        raw.send(request("/app.js", f"Expect: {expectation}", "Content-Length: 5", method=method))
        answer = raw.read_response()
        assert answer.status == 100 or answer.status in REFUSED
        if answer.status == 100:
            raw.send(b"hello")
            assert raw.read_response().status in (200, *REFUSED)
        else:
            raw.try_send(SMUGGLED)
            assert b"smuggled" not in raw.read_until_end() or answer.get("Connection") != "close"


def test_expect_100_continue_without_a_body_is_answered(site_server):
    with Socket(site_server) as raw:
        raw.send(request("/app.js", "Expect: 100-continue", close=True))
        answers = raw.read_responses()
        assert [answer.status for answer in answers] in ([100, 200], [200]) and answers[-1].body == SCRIPT


def test_http_1_0_gets_no_100_continue(site_server):
    with Socket(site_server) as raw:
        raw.send(request("/app.js", "Expect: 100-continue", version="HTTP/1.0"))
        assert [answer.status for answer in raw.read_responses()] == [200]


@pytest.mark.parametrize("expectation", ["x", "200-ok", "100-continue, x", "100-continued", "100"])
def test_other_expectations_are_refused(site_server, expectation):
    answers = responses_to(site_server, request("/app.js", f"Expect: {expectation}", close=True))
    assert [answer.status for answer in answers] == [417]
