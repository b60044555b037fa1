"""HTTP requests (RFC 9110, RFC 9112), valid or not: request lines, header fields, methods, targets and paths."""

import json

import pytest
from http_site import SCRIPT, SMUGGLED, assert_refused_and_closed, responses_to
from raw import ConnectionEnded, Socket, request

# --- Invalid request lines and header fields are refused (RFC 9112, sections 2, 3 and 5)

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
            pass  # the server has reset the connection, so the response is lost


# --- Methods, targets and paths that the server accepts or refuses

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
