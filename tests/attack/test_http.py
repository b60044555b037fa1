"""HTTP/1.1 as in RFC 9110 and RFC 9112, and attacks on it: request smuggling, endless bodies, unusual targets."""

import concurrent.futures
import contextlib
import gzip
import json
import re
import time

import pytest
from harness import Server, is_sanitizer_build, wait_until
from raw import ConnectionEnded, Socket, fetch, handshake, request, send_as_far_as_read

REFUSED = (400, 405, 411, 413, 414, 417, 431, 501, 505)
PAGE = b"<!doctype html><title>page</title>\n" * 40
SCRIPT = bytes(range(32, 127)) * 20
SMUGGLED = request("/api/v1/smuggled")


@pytest.fixture(name="site_server", scope="module")
def start_site_server(tmp_path_factory):
    root = tmp_path_factory.mktemp("site")
    (root / "index.html").write_bytes(PAGE)
    (root / "app.js").write_bytes(SCRIPT)
    (root / "packed.js").write_bytes(SCRIPT * 10)
    (root / "packed.js.gz").write_bytes(gzip.compress(SCRIPT * 10, mtime=0))
    (root / "empty.txt").write_bytes(b"")
    (root.parent / "secret.txt").write_text("secret")
    with Server("--web-root", root) as server:
        yield server


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


def assert_body_discarded_or_refused(server, data):
    """Sends a request with an unexpected body, then a valid one; asserts that both are answered, or the first is
    refused and the connection ends."""
    answers = responses_to(server, data + request("/healthz", close=True))
    assert answers, "no response"
    if answers[0].get("Connection") == "close":
        assert len(answers) == 1 and answers[0].status in REFUSED
    else:
        assert [answer.status for answer in answers[1:]] == [200], answers


# --- Request smuggling: where a body ends (RFC 9112, section 6)

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
        # RFC 9112, 6.1: HTTP/1.0 has no chunked encoding, so the framing is faulty.
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


# --- Endless requests, which could fill the memory

def endless_requests():
    chunked = request("/", "Transfer-Encoding: chunked")
    return {
        "chunk size": (chunked + b"0", b"0" * 65536), "chunk extension": (chunked + b"1;", b"x" * 65536),
        "chunk extensions": (chunked, b"1;a=" + b"b" * 4096 + b"\r\nx\r\n"), "trailers": (chunked + b"0\r\n", b"Trailer: x\r\n" * 5000),
        "one trailer": (chunked + b"0\r\nTrailer: ", b"x" * 65536), "chunks": (chunked, b"1\r\nx\r\n" * 10000),
        "one chunk": (chunked + b"ffffffff\r\n", b"x" * 65536), "body": (request("/", "Content-Length: 4294967296"), b"x" * 65536),
        "method": (b"", b"G" * 65536), "target": (b"GET /", b"x" * 65536), "query": (b"GET /?", b"a=b&" * 16384),
        "version": (b"GET / HTTP/1.1", b"1" * 65536), "fields": (b"GET / HTTP/1.1\r\n", b"X: y\r\n" * 10000),
        "field name": (b"GET / HTTP/1.1\r\nX", b"x" * 65536), "field value": (b"GET / HTTP/1.1\r\nX: ", b"x" * 65536),
        "blanks before a value": (b"GET / HTTP/1.1\r\nX:", b" " * 65536), "folded value": (b"GET / HTTP/1.1\r\nX: y", b"\r\n z" * 16384),
        "blank lines": (b"", b"\r\n" * 32768), "field of a handshake": (handshake()[:-2] + b"X: ", b"x" * 65536),
        "body of a handshake": (handshake("/ws", "Content-Length: 4294967296"), b"x" * 65536),
    }


@pytest.mark.parametrize("kind", endless_requests())
@pytest.mark.skipif(is_sanitizer_build(), reason="sanitizers keep freed memory")
def test_endless_requests_use_bounded_memory(site_server, kind):
    head, endless = endless_requests()[kind]
    responses_to(site_server, request("/", close=True))
    sockets = [Socket(site_server) for _ in range(4)]
    before, max_growth = site_server.anonymous_memory(), 0
    for raw in sockets:
        raw.try_send(head)
    with concurrent.futures.ThreadPoolExecutor(len(sockets)) as pool:
        sending = [pool.submit(raw.flood, endless, 32 << 20) for raw in sockets]
        while not all(future.done() for future in sending):
            max_growth = max(max_growth, site_server.anonymous_memory() - before)
            time.sleep(0.005)
    max_growth = max(max_growth, site_server.anonymous_memory() - before)
    for raw in sockets:
        raw.socket.close()
    assert max_growth < len(sockets) << 20, f"the memory grew by {max_growth} bytes"
    assert all(future.result() is not None for future in sending), "32 MiB were accepted, and the connection is still open"


def test_the_token_is_checked_before_the_body_arrives():
    """A client without a token gets its answer before any of the body has arrived."""
    with Server("--host", "0.0.0.0", "--token", "open-sesame") as server:
        server.host = "127.0.0.1"
        for lines in (["Content-Length: 1000"], ["Transfer-Encoding: chunked"]):
            with Socket(server) as raw:
                raw.send(request("/api/v1/keymap", *lines, method="POST"))
                assert raw.read_response().status in (401, *REFUSED)
                assert raw.read_until_end() == b""


# --- The request line and the header fields (RFC 9112, sections 2, 3 and 5)

@pytest.mark.parametrize("data", [
    b"GET  / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET / HTTP/1.1 \r\nHost: localhost\r\n\r\n", b"GET /\tHTTP/1.1\r\nHost: localhost\r\n\r\n",
    b" GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET / / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/1.1\r\nHost localhost\r\n\r\n", b"GET / HTTP/1.1\r\n: x\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/1.1\r\nHost: localhost\r\nX y: z\r\n\r\n", b"GET / HTTP/1.1\r\nHost: localhost\r\nX : z\r\n\r\n",
    b"GET / HTTP/1.1\r\n Host: localhost\r\n\r\n", b"GET / HTTP/1.1\r\nHost: localhost\r\nX\x00: y\r\n\r\n",
    b"GET / HTTP/1.1\r\nHost: localhost\r\nX: a\x00b\r\n\r\n", b"GET / HTTP/1.1\r\nHost: localhost\r\nX: a\rb\r\n\r\n",
    b"GET / HTTP/1.1\rHost: localhost\r\r", b"GET / HTTP/1.1\r\nHost: localhost\r\nX(y): z\r\n\r\n",
    b"GET / HTTP/1.1\r\nHost: localhost\r\n\"X\": z\r\n\r\n", b"GET / HTTP/1.1\r\nHost: localhost\r\nX\xff: y\r\n\r\n",
    b"GET /\x00 HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET /\x01 HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET /\x7f HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"G\x00T / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET / HTTQ/1.1\r\nHost: localhost\r\n\r\n", b"GET / http/1.1\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/11\r\nHost: localhost\r\n\r\n", b"GET / HTTP/1.\r\nHost: localhost\r\n\r\n", b"GET / HTTP/.1\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/1.1.1\r\nHost: localhost\r\n\r\n", b"GET / HTTP/01.1\r\nHost: localhost\r\n\r\n", b"GET / HTTP/-1.1\r\nHost: localhost\r\n\r\n",
    b"GET /\r\n\r\n", b"GET / \r\n\r\n", b"GET\r\n\r\n", b"\x00\x00\x00\x00\r\n\r\n", b"GET / HTTP/2.0\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/3.0\r\nHost: localhost\r\n\r\n", b"GET / HTTP/0.9\r\nHost: localhost\r\n\r\n", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
    b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\x00" * 100 + b"\r\n\r\n", b"SSH-2.0-OpenSSH_9.2\r\n\r\n",
    b"EHLO localhost\r\n\r\n", b"*1\r\n$4\r\nPING\r\n\r\n", b"{\"type\":\"hello\"}\r\n\r\n",
], ids=lambda data: ascii(data)[2:40])
def test_malformed_requests_are_refused(site_server, data):
    assert_refused_and_closed(site_server, data + SMUGGLED)


@pytest.mark.parametrize("lines, host", [
    (["Host: localhost"], "localhost"), (["Host: evil.example"], "localhost"), (["host: localhost"], "localhost"), ([], None),
    (["Host: localhost", "Host: localhost"], "localhost"), (["Host:"], "localhost"),
])
def test_a_missing_or_repeated_host_is_refused(site_server, lines, host):
    assert_refused_and_closed(site_server, request("/app.js", *lines, host=host) + SMUGGLED, (400,))
    assert_refused_and_closed(site_server, request("/healthz", *lines, host=host) + SMUGGLED, (400,))


@pytest.mark.parametrize("origins", [["http://localhost", "http://localhost"], ["http://localhost", "http://evil.example"],
                                     ["http://evil.example", "http://localhost"]])
def test_a_repeated_origin_is_refused(site_server, origins):
    answers = responses_to(site_server, request("/app.js", *(f"Origin: {origin}" for origin in origins), close=True))
    assert [answer.status in (400, 403) for answer in answers] == [True]


def test_http_1_0_connections_end_after_one_response(site_server):
    answers = responses_to(site_server, request("/app.js", version="HTTP/1.0", host=None) + SMUGGLED)
    assert len(answers) == 1 and answers[0].status in (200, 400, 403)
    answers = responses_to(site_server, request("/app.js", version="HTTP/1.0") + SMUGGLED)
    assert len(answers) == 1 and answers[0].status == 200 and answers[0].body == SCRIPT


@pytest.mark.parametrize("value", ["a\x01b", "a\x0bb", "a\x7fb", "a\x1bb", "a\x08b"], ids=ascii)
def test_control_characters_in_a_field_are_accepted_or_refused(site_server, value):
    """RFC 9110, 5.5, allows a server to keep or to refuse them."""
    answers = responses_to(site_server, request("/app.js", f"X: {value}", close=True))
    assert [answer.status in (200, 400) for answer in answers] == [True]


@pytest.mark.parametrize("data", [
    request("/app.js", "X: ä\xff", close=True), request("/app.js", "X:", close=True),
    request("/app.js", "X:y", close=True), request("/app.js", "X: \t y \t", close=True),
    request("/app.js", "connection: CLOSE"), request("/app.js", "Connection: foo, close"),
    request("/app.js", "!#$%&'*+-.^_`|~: x", close=True),
], ids=lambda data: ascii(data)[2:50])
def test_unusual_valid_headers_are_accepted(site_server, data):
    answers = responses_to(site_server, data)
    assert [answer.status for answer in answers] == [200] and answers[0].body == SCRIPT


@pytest.mark.parametrize("data", [
    b"GET /app.js HTTP/1.1\nHost: localhost\nConnection: close\n\n", b"GET /app.js HTTP/1.1\r\nHost: localhost\nConnection: close\r\n\r\n",
    b"GET /app.js HTTP/1.1\r\nHost: localhost\r\nConnection: close\n\n", request("/app.js", "X: a\r\n b", close=True),
    request("/app.js", "X:\r\n\tb", close=True), request("/app.js", version="HTTP/1.2", close=True),
    request("/app.js", version="HTTP/1.9", close=True), b"\r\n" + request("/app.js", close=True),
], ids=lambda data: ascii(data)[2:60])
def test_lenient_syntax_is_accepted_or_refused(site_server, data):
    answers = responses_to(site_server, data)
    assert [answer.status in (200, 400, 505) for answer in answers] == [True]


@pytest.mark.parametrize("target", ["/" + "x" * 8000, "/?" + "a=b&" * 2000])
def test_long_targets_are_answered(site_server, target):
    answers = responses_to(site_server, request(target, close=True))
    assert [answer.status in (200, 400, 404, 414, 431) for answer in answers] == [True]


@pytest.mark.parametrize("data", [
    request("/" + "x" * 70_000), request("/", "X: " + "x" * 70_000), request("/", *(f"X-{n}: y" for n in range(10_000))),
    request("/", "X" * 70_000 + ": y"), request("/", *["X: y"] * 20_000), request("/", method="G" * 70_000),
], ids=["target", "value", "fields", "name", "same field", "method"])
def test_too_long_headers_are_refused(site_server, data):
    with Socket(site_server) as raw:
        raw.try_send(data)
        try:
            answers = raw.read_responses()
            assert [answer.status in (400, 414, 431) for answer in answers] == [True]
        except ConnectionEnded:
            pass  # the server reset the connection during the transmission, so the response is lost


# --- Methods, targets, paths

@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "PROPFIND", "FOO", "get",
                                    "GETS", "M-SEARCH"])
@pytest.mark.parametrize("path", ["/", "/app.js", "/healthz", "/readyz", "/metrics", "/api/v1/frame.png", "/api/v1/file.stl",
                                  "/ws", "/nothing"])
def test_methods_other_than_get_and_head_are_refused(site_server, method, path):
    answers = responses_to(site_server, request(path, method=method, close=True))
    assert len(answers) == 1
    answer = answers[0]
    assert answer.status in ((405, 501, 400) if method in ("FOO", "get", "GETS", "CONNECT") else (405,)), answer
    if answer.status == 405:
        assert {word.strip() for word in answer.get("Allow").split(",")} == {"GET", "HEAD"}


@pytest.mark.parametrize("path", ["/", "/app.js", "/packed.js", "/healthz", "/api/v1/keymap", "/nothing", "/api/v1/frame.png?width=64&height=64",
                                  "/api/v1/frame.png?width=x"])
def test_head_is_answered_like_get_without_a_body(site_server, path):
    with Socket(site_server) as raw:
        raw.send(request(path, "Accept-Encoding: gzip", method="HEAD") + request(path, "Accept-Encoding: gzip", close=True))
        head, got = raw.read_response("HEAD"), raw.read_response()
        assert raw.read_until_end() == b""
    assert head.status == got.status and head.get("Content-Length") == str(len(got.body))
    for name in ("Content-Type", "ETag", "Content-Encoding", "Vary", "Cache-Control"):
        assert head.get(name) == got.get(name)


@pytest.mark.parametrize("target, statuses", [
    ("http://localhost/app.js", (200,)), ("http://localhost:80/app.js", (200,)), ("HTTP://LOCALHOST/app.js", (200,)),
    ("http://localhost", (200,)), ("http://evil.example/app.js", (400, 403, 421)), ("http://user@localhost/app.js", (400, 403)),
    ("http:///app.js", (400,)), ("http:/app.js", (400,)), ("ftp://localhost/app.js", (400, 403)), ("app.js", (400,)),
    ("localhost:80", (400,)), ("*", (400,)), ("?x", (400,)), ("#", (400,)), ("\\app.js", (400,)), ("file:///etc/passwd", (400, 403)),
])
def test_absolute_targets_are_accepted_and_invalid_targets_refused(site_server, target, statuses):
    """RFC 9112, 3.2.2: a server must accept the absolute form, and use its host instead of the Host field."""
    answers = responses_to(site_server, request(target, close=True))
    assert [answer.status in statuses for answer in answers] == [True], answers


def test_the_host_of_an_absolute_target_overrides_the_host_field(site_server):
    answers = responses_to(site_server, request("http://evil.example/api/v1/keymap", host="localhost", close=True))
    assert answers[0].status in (400, 403, 421)


def test_options_for_the_whole_server_is_answered(site_server):
    answers = responses_to(site_server, request("*", method="OPTIONS", close=True))
    assert [answer.status in (200, 204, 400, 405, 501) for answer in answers] == [True]


@pytest.mark.parametrize("path", [
    "/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/%2e%2e%2fsecret.txt", "/.%2e/secret.txt", "/..%5csecret.txt",
    "/..\\secret.txt", "/%252e%252e/secret.txt", "/....//secret.txt", "/./../secret.txt", "/x/../../secret.txt", "//secret.txt",
    "/%c0%ae%c0%ae/secret.txt", "/%c0%2e%c0%2e/secret.txt", "/%e0%80%ae%e0%80%ae/secret.txt", "/..%c0%afsecret.txt",
    "/..%00/secret.txt", "/%2e%2e%00/secret.txt", "/app.js/../../secret.txt", "/../" * 50 + "etc/passwd",
    "/%2e%2e/" * 50 + "etc/passwd", "/proc/self/environ", "//etc/passwd", "/%2fetc%2fpasswd", "/etc/passwd", "/file:///etc/passwd",
    "/app.js%00", "/app.js%00.html", "/%00", "/app.js%20", "/app.js/", "/APP.JS", "/app.js%0d%0aX:%20y", "/app.js;x", "/app.js.",
    "/%61pp.js/", "/app%2ejs%2f", "/index.html/index.html", "/\u2025/secret.txt".encode().decode("latin-1"), "/packed.js.gz", "/.", "/..",
    "/~", "/.git/config", "/%", "/%z", "/%zz", "/%1", "/%%", "/%-1", "/%+1", "/% 1", "/app.js%", "/?%", "/?%zz", "/?a=%", "/?a%=b",
    "/\xff\xfe", "/%ff%fe",
])
def test_unusual_paths_reach_no_file(site_server, path):
    answers = responses_to(site_server, request(path, close=True))
    assert [answer.status in (400, 404) for answer in answers] == [True], answers
    assert b"secret" not in answers[0].body.replace(b"secret.txt", b"") and b"root:" not in answers[0].body
    assert not answers[0].values_of("X"), "the target has added a field to the response"
    if answers[0].get("Content-Type") == "application/json":
        assert json.loads(answers[0].body)["type"] == "error"


@pytest.mark.parametrize("path", ["/app.js", "/%61pp.js", "/app%2ejs", "/%61%70%70%2E%6a%73", "/app.js?", "/app.js?x", "/app.js?a=b&a=b",
                                  "/app.js?&&&", "/app.js?=", "/app.js?a=%00", "/app.js?../..", "/app.js?http://x/"])
def test_equivalent_paths_serve_the_same_file(site_server, path):
    answers = responses_to(site_server, request(path, close=True))
    assert [answer.status for answer in answers] == [200] and answers[0].body == SCRIPT


# --- Many requests on one connection

def test_pipelined_requests_are_answered_in_order(site_server):
    names = [f"/api/v1/nothing-{number}" for number in range(50)]
    quick = b"".join(request(name) for name in names)
    slow = request("/api/v1/frame.png?polytope=600-cell&width=640&height=360")
    answers = responses_to(site_server, slow + quick + slow + request("/app.js") + request("/healthz", close=True))
    assert len(answers) == len(names) + 4
    assert answers[0].body[:4] == b"\x89PNG" and answers[-3].body == answers[0].body
    assert answers[-2].body == SCRIPT and answers[-1].body == b"ok\n"
    for name, answer in zip(names, answers[1:-3]):
        assert answer.status == 404 and name in json.loads(answer.body)["message"]


def test_pipelined_requests_sent_byte_by_byte_are_answered(site_server):
    with Socket(site_server) as raw:
        for octet in request("/app.js") + request("/nothing") + request("/healthz", close=True):
            raw.send(bytes([octet]))
        assert [answer.status for answer in raw.read_responses()] == [200, 404, 200]


def test_requests_after_connection_close_are_ignored(site_server):
    assert len(responses_to(site_server, request("/healthz", close=True) + request("/healthz") * 3)) == 1
    assert len(responses_to(site_server, request("/healthz", version="HTTP/1.0") + request("/healthz") * 3)) == 1


def test_the_server_stops_reading_from_a_client_that_reads_nothing(site_server):
    """If a client pipelines requests and reads no responses, the server stops reading from it and serves others."""
    def serve_another():
        assert fetch(site_server, "/app.js").body == SCRIPT

    with Socket(site_server, receive_buffer=4096) as raw:
        data = request("/packed.js") * 100_000
        assert send_as_far_as_read([raw], data, serve_another) < len(data), "100,000 requests were accepted"
        serve_another()


# --- Expect (RFC 9110, 10.1.1)

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


# --- Conditions (RFC 9110, 13)

def etag_of(site_server, path="/app.js", *fields):
    return fetch(site_server, path, *fields).get("ETag")


def test_a_matching_etag_gets_304(site_server):
    tag = etag_of(site_server)
    for text in (tag, "*", f"W/{tag}", f'"x", {tag}', f'{tag}, "x"', f'"x",{tag},"y"', f'W/"x", W/{tag}', f'"a,b", {tag}', f' {tag} '):
        answer = fetch(site_server, "/app.js", f"If-None-Match: {text}")
        assert answer.status == 304 and answer.get("ETag") == tag, text
        assert fetch(site_server, "/app.js", f"If-None-Match: {text}", method="HEAD").status == 304
    with Socket(site_server) as raw:
        raw.send(request("/app.js", 'If-None-Match: "x"', f"If-None-Match: {tag}") + request("/healthz", close=True))
        assert [answer.status for answer in raw.read_responses()] == [304, 200], "repeated fields must form one list"


def test_other_etags_get_the_file(site_server):
    tag = etag_of(site_server)
    bare = tag.strip('"')
    for text in ('"x"', bare, f'"{bare}x"', f'"x{bare}"', f'"x{tag}', f'"{bare.upper()}X"', '"*"', "W/*", "", f'"a{tag}b"', f'"{bare[:-1]}"'):
        answer = fetch(site_server, "/app.js", f"If-None-Match: {text}")
        assert answer.status == 200 and answer.body == SCRIPT, text
    assert fetch(site_server, "/nothing", "If-None-Match: *").status == 404
    tag = etag_of(site_server, "/packed.js")
    assert fetch(site_server, "/packed.js", f"If-None-Match: {tag}", "Accept-Encoding: gzip").status == 200


# --- Ranges (RFC 9110, 14): a server may ignore them, but must not serve them incorrectly

def parse_ranges(text, size):
    """Parses a Range field: returns (first, last) of each satisfiable range, None if the field is invalid."""
    match = re.fullmatch(r"bytes=(.*)", text)
    if not match:
        return None
    found = []
    for part in match[1].split(","):
        numbers = re.fullmatch(r"[ \t]*(\d*)-(\d*)[ \t]*", part)
        if not numbers or numbers[0].strip() == "-":
            return None
        first, last = numbers.groups()
        if first and last and int(first) > int(last):
            return None
        if not first:
            count = min(int(last), size)
            found += [(size - count, size - 1)] if count else []
        elif int(first) < size:
            found.append((int(first), min(int(last or size), size - 1)))
    return found


def multipart_ranges(answer):
    """Returns (first, last, content) of each part of a multipart/byteranges response."""
    boundary = re.search(r'boundary="?([^";]+)', answer.get("Content-Type"))[1].encode()
    found = []
    for part in answer.body.split(b"--" + boundary)[1:-1]:
        head, _, content = part.removeprefix(b"\r\n").partition(b"\r\n\r\n")
        first, last = re.search(rb"(?i)content-range: bytes (\d+)-(\d+)/", head).groups()
        found.append((int(first), int(last), content.removesuffix(b"\r\n")))
    return found


def assert_range_response(answer, text, full):
    asked, size = parse_ranges(text, len(full)), len(full)
    if answer.status == 200:
        assert answer.body == full
        assert answer.get("Accept-Ranges") in (None, "none", "bytes")
        return
    if answer.status == 416:
        assert not asked and answer.get("Content-Range") == f"bytes */{size}"
        return
    assert answer.status == (400 if asked is None else 206), answer
    if answer.status == 206:
        assert asked
        if answer.get("Content-Type").startswith("multipart/byteranges"):
            assert len(asked) > 1 and answer.get("Content-Range") is None
            parts = multipart_ranges(answer)
        else:
            first, last, whole = re.fullmatch(r"bytes (\d+)-(\d+)/(\d+)", answer.get("Content-Range")).groups()
            assert int(whole) == size
            parts = [(int(first), int(last), answer.body)]
        for first, last, content in parts:
            assert content == full[first:last + 1]
        covered = {at for first, last, _ in parts for at in range(first, last + 1)}
        assert covered >= {at for first, last in asked for at in range(first, last + 1)}


RANGES = ["bytes=0-0", "bytes=0-99", "bytes=100-", "bytes=-1", "bytes=-100", "bytes=0-", "bytes=0-99999999", "bytes=-99999999",
          "bytes=1899-1899", "bytes=1900-", "bytes=1900-1900", "bytes=99999-", "bytes=-0", "bytes=0-0,-1", "bytes=0-9, 20-29,50-",
          "bytes=0-9,5-14", "bytes=9-5", "bytes=", "bytes=-", "bytes=a-b", "bytes 0-9", "bytes=0-9,", "bytes=,0-9", "bytes=0--1",
          "bytes=0-9-10", "bytes=0x0-0x9", "bytes=+0-9", "octets=0-9", "items=0-9", "=0-9", "0-9", "", "bytes=0-18446744073709551615",
          "bytes=18446744073709551616-", "bytes=-18446744073709551616", "bytes=" + ",".join(["0-"] * 1000), "bytes=0-9;10-19",
          "bytes=0-0" + ",0-0" * 1000, "BYTES=0-9"]


@pytest.mark.parametrize("text", RANGES, ids=lambda text: text[:30])
@pytest.mark.parametrize("path", ["/app.js", "/api/v1/keymap", "/api/v1/file.csv", "/empty.txt"])
def test_ranges_are_served_correctly_or_ignored(site_server, text, path):
    full = fetch(site_server, path)
    assert full.status == 200
    answer = fetch(site_server, path, f"Range: {text}")
    assert_range_response(answer, text, full.body)
    assert len(answer.body) <= 2 * len(full.body) + 1000, "the ranges make the response larger than the file"
    assert fetch(site_server, path, f"Range: {text}", method="HEAD").status in (200, 206, 416)


def test_if_range_serves_a_range_only_of_the_current_file(site_server):
    """If-Range (RFC 9110, 13.1.5): a range is served only if the client's tag is current."""
    tag = etag_of(site_server)
    for text in ('"x"', f"W/{tag}", "Sat, 29 Oct 1994 19:43:31 GMT", tag.strip('"'), "*"):
        answer = fetch(site_server, "/app.js", "Range: bytes=0-9", f"If-Range: {text}")
        assert answer.status == 200 and answer.body == SCRIPT, text
    assert_range_response(fetch(site_server, "/app.js", "Range: bytes=0-9", f"If-Range: {tag}"), "bytes=0-9", SCRIPT)
    assert fetch(site_server, "/app.js", "Range: bytes=0-9", f"If-None-Match: {tag}").status == 304
    assert fetch(site_server, "/nothing", "Range: bytes=0-9").status == 404


# --- Clients that leave, stop or wait

def test_a_half_closed_connection_gets_its_response(site_server):
    assert responses_to(site_server, request("/app.js"))[0].body == SCRIPT
    assert responses_to(site_server, b"") == []
    for part in (b"G", b"GET / HTTP/1.1\r\n", request("/")[:-2], request("/", "Content-Length: 5") + b"he"):
        answers = responses_to(site_server, part)
        assert all(answer.status in REFUSED for answer in answers) and len(answers) <= 1


def test_the_server_survives_reset_connections(site_server):
    before = site_server.metric("oval4d_connections")
    for data in (b"", b"GET", request("/app.js")[:-2], request("/app.js"), request("/packed.js") * 100,
                 request("/api/v1/frame.png?polytope=600-cell"), request("/api/v1/file.stl?polytope=24-cell&of=oval")):
        for _ in range(5):
            raw = Socket(site_server)
            raw.try_send(data)
            raw.reset()
    site_server.wait_for(lambda: site_server.metric("oval4d_connections") <= before)
    assert fetch(site_server, "/app.js").body == SCRIPT


@pytest.mark.skipif(is_sanitizer_build(), reason="sanitizers keep freed memory")
def test_unread_pictures_use_bounded_memory(site_server):
    target = "/api/v1/frame.png?polytope=600-cell&width=640&height=360"
    size = len(fetch(site_server, target).body)
    before = site_server.anonymous_memory()
    sockets = [Socket(site_server, receive_buffer=4096) for _ in range(20)]
    try:
        for raw in sockets:
            raw.try_send(request(target) * 20)
        for _ in range(20):
            assert fetch(site_server, "/app.js").body == SCRIPT
        assert len(fetch(site_server, target).body) == size
        growth = site_server.anonymous_memory() - before
        assert growth < len(sockets) * (size + (1 << 20)), "more than one response per connection is buffered"
    finally:
        for raw in sockets:
            raw.socket.close()
    site_server.wait_for(lambda: site_server.metric("oval4d_connections") < 15)


def test_responses_state_type_and_forbid_cross_origin_reads(site_server):
    for path in ("/", "/app.js", "/healthz", "/metrics", "/api/v1/keymap", "/nothing", "/api/v1/frame.png?width=64&height=64",
                 "/api/v1/frame.png?width=x", "/api/v1/file.off"):
        answer = fetch(site_server, path)
        assert answer.get("X-Content-Type-Options") == "nosniff" and answer.get("Content-Type")
        assert answer.get("Access-Control-Allow-Origin") in (None,), "pages of other origins may read it"


def test_slow_requests_time_out():
    """Requests that are sent without end and slowly, on new connections and after another request, are given up."""
    parts = {"line": (b"G", b"E"), "target": (b"GET /", b"x"), "header": (b"GET / HTTP/1.1\r\nX-", b"a"),
             "fields": (b"GET / HTTP/1.1\r\nHost: localhost\r\n", b"A: b\r\n"), "nothing": (b"", b""), "blank lines": (b"", b"\r\n"),
             "body": (request("/", "Content-Length: 100000"), b"x"),
             "chunks": (request("/", "Transfer-Encoding: chunked"), b"1\r\nx\r\n"),
             "second request": (request("/healthz") + b"G", b"E"), "no second request": (request("/healthz"), b"")}
    with Server("--hello-timeout", 1, "--idle-timeout", 1) as server, contextlib.ExitStack() as stack:
        open_ = {name: stack.enter_context(Socket(server)) for name in parts}
        for name, raw in open_.items():
            raw.try_send(parts[name][0])
            raw.socket.setblocking(False)

        def all_have_ended():
            for name, raw in list(open_.items()):
                try:
                    if not raw.receive():
                        del open_[name]
                except BlockingIOError:
                    raw.try_send(parts[name][1])
            return not open_

        wait_until(all_have_ended, "the end of slow requests")
