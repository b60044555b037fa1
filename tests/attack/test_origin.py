"""Access control: hosts, origins, Fetch Metadata of browsers, and tokens."""

import time

import pytest
from harness import Server, wait_until
from raw import ConnectionEnded, Socket, WebSocket, fetch, handshake, request

REFUSED = (400, 403, 421)
PICTURE = "/api/v1/frame.png?width=64&height=64"
FILE = "/api/v1/file.csv"
COSTLY = [PICTURE, FILE, "/api/v1/file.stl", "/api/v1/file.svg"]


@pytest.fixture(name="server_with_allowed_origin", scope="module")
def start_server_with_allowed_origin():
    with Server("--allow-origin", "https://pages.example") as server:
        yield server


def handshake_status(server, *fields, host="localhost", target="/ws", source=None):
    """Returns the HTTP status of a WebSocket handshake."""
    with Socket(server, source) as raw:
        raw.send(handshake(target, *fields, host=host))
        return raw.read_response().status


def response_status(server, target, *fields, host="localhost"):
    return fetch(server, target, *fields, host=host).status


# --- Which Host fields the server accepts

@pytest.mark.parametrize("host", ["localhost", "LOCALHOST", "LocalHost", "localhost:80", "localhost:1", "localhost:65535", "127.0.0.1",
                                  "127.0.0.1:8080", "[::1]", "[::1]:8080"])
def test_hosts_that_name_this_machine_are_accepted(server, host):
    assert response_status(server, "/api/v1/keymap", host=host) == 200
    assert handshake_status(server, host=host) == 101
    assert handshake_status(server, f"Origin: http://{host}", host=host) == 101


@pytest.mark.parametrize("host", [
    "evil.example", "localhost.evil.example", "evil-localhost", "localhostx", "xlocalhost", "127.0.0.1.evil.example", "127.0.0.2",
    "127.1", "127.0.0.01", "0.0.0.0", "2130706433", "0x7f000001", "0177.0.0.1", "[::]", "[::2]", "::1", "[::1", "::1]", "[::1]x",
    "[::1]]", "[[::1]]", "[::ffff:127.0.0.1", "[::1%25lo]", "[localhost]", "localhost:abc", "localhost:80a", "localhost:-1",
    "localhost:+1", "localhost:65536", "localhost:99999", "localhost:99999999999999999999", "localhost:0x50", "localhost: 80",
    "localhost:80:80", "localhost::80", ":80", ":", "evil.example:localhost", "user@localhost", "localhost@evil.example",
    "user:pass@localhost", "evil.example,localhost", "localhost,evil.example", "localhost, evil.example", "localhost evil.example",
    "localhost/", "localhost/x", "localhost?x", "localhost#x", "localhost\\", "http://localhost", "//localhost", "localhost%00",
    "localho%73t", "*", ".", "..", "localhost..", ".localhost", "_", "null", "\u212aocalhost".encode().decode("latin-1"),
    "localhost\u00a0".encode().decode("latin-1"), "x" * 5000,
], ids=lambda host: ascii(host)[:40])
def test_other_hosts_are_refused(server, host):
    assert response_status(server, "/api/v1/keymap", host=host) in REFUSED
    assert response_status(server, "/", host=host) in REFUSED
    assert response_status(server, PICTURE, f"Origin: http://{host}", host=host) in REFUSED
    assert handshake_status(server, host=host) in REFUSED


@pytest.mark.parametrize("host", ["localhost.", "localhost:", "[0:0:0:0:0:0:0:1]", "[::1]:", "localhost:080"])
def test_unusual_names_of_this_machine_are_accepted_or_refused(server, host):
    assert response_status(server, "/api/v1/keymap", host=host) in (200, *REFUSED)


# --- Which Origin fields the server accepts

@pytest.mark.parametrize("origin, host", [
    ("http://localhost:81", "localhost:81"), ("https://localhost:81", "localhost:81"), ("http://LOCALHOST:81", "localhost:81"),
    ("http://127.0.0.1:81", "127.0.0.1:81"), ("http://[::1]:81", "[::1]:81"), ("http://localhost", "localhost"),
])
def test_the_origin_of_the_server_is_accepted(server, origin, host):
    assert handshake_status(server, f"Origin: {origin}", host=host) == 101
    for target in ["/api/v1/keymap", *COSTLY]:
        assert response_status(server, target, f"Origin: {origin}", host=host) == 200


FOREIGN = [
    "null", "http://evil.example", "https://evil.example", "http://localhost:82", "http://localhost", "http://127.0.0.1:81",
    "http://[::1]:81", "file://", "file://localhost:81", "file:///", "ftp://localhost:81", "ws://localhost:81", "wss://localhost:81",
    "chrome-extension://localhost:81", "moz-extension://localhost:81", "about:blank", "data:text/html,x", "blob:http://localhost:81",
    "javascript://localhost:81", "httpx://localhost:81", "xhttp://localhost:81", "://localhost:81", "//localhost:81", "localhost:81",
    "http:localhost:81", "http:/localhost:81", "http:///localhost:81", "http://localhost:81.evil.example",
    "http://localhost.evil.example:81", "http://evil.example:81", "http://evil.example#localhost:81", "http://evil.example/localhost:81",
    "http://evil.example?localhost:81", "http://evil.example\\localhost:81", "http://evil.example@localhost:81",
    "http://localhost:81@evil.example", "http://user@localhost:81", "http://localhost:81, http://evil.example",
    "http://evil.example, http://localhost:81", "http://localhost:81 http://evil.example", "http://evil.example http://localhost:81",
    "http://xlocalhost:81", "http://localhostx:81", "http://localhost:811", "http://localhost:8", "http://localhost:081x",
    "http://localhost:65617", "http://localhost:99999", "http://localhost:abc", "http://localhost:", "http://localhost:-81",
    "http://localhost:81/", "http://localhost:81/x", "http://localhost:81?", "http://localhost:81#", "http://", "http", "x", "*",
    "http://*", "http://localhost:81\x0b", "http://local\x0bhost:81",
]


@pytest.mark.parametrize("origin", FOREIGN, ids=ascii)
def test_foreign_origins_are_refused(server, origin):
    assert handshake_status(server, f"Origin: {origin}", host="localhost:81") in REFUSED
    for target in ("/api/v1/keymap", PICTURE, FILE):
        assert response_status(server, target, f"Origin: {origin}", host="localhost:81") in REFUSED


@pytest.fixture(name="server_for_any_host", scope="module")
def start_server_for_any_host():
    with Server("--allow-host", "*") as server:
        yield server


@pytest.mark.parametrize("port", ["abc", "99999", "65536", "-1", "81x", "+81", "8 1", "0x51", "99999999999999999999", "81:81", "81@x"])
def test_origins_with_an_invalid_port_are_refused_even_if_the_host_matches(server_for_any_host, port):
    """The origin is checked as strictly if every host is allowed."""
    for scheme in ("http", "https"):
        origin = f"Origin: {scheme}://localhost:{port}"
        assert handshake_status(server_for_any_host, origin, host=f"localhost:{port}") in REFUSED


@pytest.mark.parametrize("scheme", ["file", "chrome-extension", "ws", "ftp", ""])
def test_origins_with_another_scheme_are_refused_even_if_the_host_matches(server_for_any_host, scheme):
    assert handshake_status(server_for_any_host, "Origin: http://any.example:81", host="any.example:81") == 101
    assert handshake_status(server_for_any_host, f"Origin: {scheme}://any.example:81", host="any.example:81") in REFUSED


@pytest.mark.parametrize("origin, allowed", [
    ("https://pages.example", True), ("https://PAGES.example", True), ("http://pages.example", False),
    ("https://pages.example:444", False), ("https://pages.example.evil.example", False), ("https://sub.pages.example", False),
    ("https://pages.examplex", False), ("https://xpages.example", False), ("https://pages.example/", False),
    ("https://pages.example@evil.example", False), ("null", False), ("https://pages.example, https://evil.example", False),
])
def test_only_the_allowed_origin_is_accepted(server_with_allowed_origin, origin, allowed):
    statuses = [handshake_status(server_with_allowed_origin, f"Origin: {origin}"),
                response_status(server_with_allowed_origin, PICTURE, f"Origin: {origin}")]
    assert statuses == [101, 200] if allowed else all(status in REFUSED for status in statuses)


# --- Requests that come from pages of other sites, as the browser says (Fetch Metadata)

CROSS = "Sec-Fetch-Site: cross-site"
IMAGE = ["Sec-Fetch-Mode: no-cors", "Sec-Fetch-Dest: image"]
FETCH = ["Sec-Fetch-Mode: cors", "Sec-Fetch-Dest: empty"]
LINK = ["Sec-Fetch-Mode: navigate", "Sec-Fetch-Dest: document", "Sec-Fetch-User: ?1"]


@pytest.mark.parametrize("target", COSTLY)
@pytest.mark.parametrize("kind", [IMAGE, FETCH, [], ["Sec-Fetch-Mode: no-cors", "Sec-Fetch-Dest: script"],
                                  ["Sec-Fetch-Mode: navigate", "Sec-Fetch-Dest: iframe"]], ids=["image", "fetch", "bare", "script", "iframe"])
def test_cross_site_requests_for_pictures_and_files_are_refused(server, target, kind):
    for method in ("GET", "HEAD"):
        with Socket(server) as raw:
            raw.send(request(target, CROSS, *kind, method=method, close=True))
            assert raw.read_response(method).status == 403


def test_refused_cross_site_requests_cause_no_work():
    """The server neither draws pictures nor creates files for it."""
    with Server() as server:  # its own server, because the counters include all clients
        def work_counters():
            return [server.metric('oval4d_picture_step_seconds_count{step="slice"}'), server.metric("oval4d_file_seconds_count")]

        def wait_for_counters(before, increase):
            server.wait_for(lambda: work_counters() == [count + increase for count in before])

        before = work_counters()
        for target in 3 * COSTLY:
            assert fetch(server, target, CROSS, *IMAGE).status == 403
        # These requests are counted after everything that the refused requests have caused. Nothing else is counted.
        for target in (PICTURE, FILE):
            fetch(server, target)
        wait_for_counters(before, 1)


@pytest.mark.parametrize("site", ["same-origin", "none"])
@pytest.mark.parametrize("target", ["/", "/api/v1/keymap", PICTURE, FILE])
def test_same_origin_and_user_initiated_requests_are_served(server, site, target):
    assert response_status(server, target, f"Sec-Fetch-Site: {site}", *FETCH) == 200


def test_cross_site_links_to_the_page_are_served(server):
    for target in ("/", "/?polytope=24-cell"):
        answer = fetch(server, target, CROSS, *LINK)
        assert answer.status == 200 and answer.body.lower().startswith(b"<!doctype html>")


@pytest.mark.parametrize("target", [PICTURE, FILE])
def test_cross_site_links_to_pictures_and_files_are_served(server, target):
    assert response_status(server, target, CROSS, *LINK) == 200


def test_cross_site_health_probes_are_answered(server):
    assert response_status(server, "/healthz", CROSS) == response_status(server, "/readyz", CROSS) == 200


@pytest.mark.parametrize("target", [PICTURE, FILE])
def test_an_allowed_origin_may_request_pictures_and_files(server_with_allowed_origin, target):
    assert response_status(server_with_allowed_origin, target, CROSS, *FETCH, "Origin: https://pages.example") == 200
    assert response_status(server_with_allowed_origin, target, CROSS, *FETCH, "Origin: https://evil.example") in REFUSED
    assert response_status(server_with_allowed_origin, target, CROSS, *IMAGE) == 403


def test_cross_site_websockets_need_an_allowed_origin(server, server_with_allowed_origin):
    mode = ["Sec-Fetch-Mode: websocket", "Sec-Fetch-Dest: websocket"]
    assert handshake_status(server, CROSS, *mode) == 403
    assert handshake_status(server, CROSS, *mode, "Origin: http://evil.example") in REFUSED
    assert handshake_status(server_with_allowed_origin, CROSS, *mode, "Origin: https://pages.example") == 101
    assert handshake_status(server, "Sec-Fetch-Site: same-origin", *mode, "Origin: http://localhost") == 101


# --- Every response has the security headers

def responses_of_every_kind(server):
    tag = fetch(server, "/").get("ETag")
    yield fetch(server, "/")
    yield fetch(server, "/", f"If-None-Match: {tag}")
    for target in ("/healthz", "/readyz", "/metrics", "/api/v1/keymap", "/api/v1/catalogue", PICTURE, FILE, "/nothing",
                   "/api/v1/frame.png?width=x", "/%zz"):
        yield fetch(server, target)
    yield fetch(server, "/", method="POST")
    yield fetch(server, "/", host="evil.example")
    yield fetch(server, "/", "Origin: null")
    yield fetch(server, PICTURE, CROSS)
    yield fetch(server, "/ws")
    for data in (b"nonsense\r\n\r\n", request("/", "X: " + "x" * 20_000), request("/", "Transfer-Encoding: x"),
                 handshake("/nothing"), handshake(protocol="other")):
        with Socket(server) as raw:
            raw.try_send(data)
            yield raw.read_response()


def test_every_response_has_cross_origin_headers(server):
    seen = set()
    for answer in responses_of_every_kind(server):
        assert answer.get("Cross-Origin-Resource-Policy") == "same-origin", answer
        assert answer.get("Cross-Origin-Opener-Policy") == "same-origin", answer
        assert answer.get("X-Content-Type-Options") == "nosniff" and answer.get("Referrer-Policy") == "no-referrer"
        assert answer.get("Access-Control-Allow-Origin") is None
        seen.add(answer.status)
    assert seen >= {200, 304, 400, 403, 404, 405, 431}


# --- The token that a server may require

SECRET = "open-sesame"


@pytest.fixture(name="server_with_token", scope="module")
def start_server_with_token():
    with Server("--host", "0.0.0.0", "--token", SECRET) as server:
        server.host = "127.0.0.1"
        yield server


@pytest.mark.parametrize("target, lines", [
    (f"/api/v1/keymap?token={SECRET}", []), (f"/api/v1/keymap?x=y&token={SECRET}", []), ("/api/v1/keymap?token=open%2dsesame", []),
    ("/api/v1/keymap", [f"Authorization: Bearer {SECRET}"]), ("/api/v1/keymap", [f"authorization: bearer {SECRET}"]),
    ("/api/v1/keymap", [f"Cookie: oval4d_token={SECRET}"]), ("/api/v1/keymap", [f"Cookie: a=b; oval4d_token={SECRET}; c=d"]),
])
def test_the_correct_token_is_accepted(server_with_token, target, lines):
    assert fetch(server_with_token, target, *lines).status == 200
    assert handshake_status(server_with_token, *lines, target=target.replace("/api/v1/keymap", "/ws")) == 101


WRONG_TOKENS = ["", "x", SECRET[:-1], SECRET + "x", "x" + SECRET, SECRET.upper(), SECRET + "%00", "%00" + SECRET, SECRET * 2, "*", "x" * 4000]


@pytest.mark.parametrize("number", range(len(WRONG_TOKENS)), ids=lambda number: WRONG_TOKENS[number][:30])
def test_wrong_tokens_are_refused(server_with_token, number):
    # Each test has its own address, because the server counts wrong tokens by address.
    token, source = WRONG_TOKENS[number], f"127.0.1.{number + 1}"
    for target, lines in ((f"/api/v1/keymap?token={token}", []), ("/api/v1/keymap", [f"Authorization: Bearer {token}"]),
                          ("/api/v1/keymap", [f"Cookie: oval4d_token={token}"])):
        answer = fetch(server_with_token, target, *lines, source=source)
        assert answer.status == 401 and answer.get("WWW-Authenticate") == "Bearer"
        assert not answer.values_of("Set-Cookie")
        assert handshake_status(server_with_token, *lines, target=target.replace("/api/v1/keymap", "/ws"), source=source) == 401


def test_responses_without_a_token_reveal_nothing(server_with_token):
    targets = ("/", "/nothing", "/metrics", PICTURE, "/api/v1/keymap", "/app.js")
    answers = {fetch(server_with_token, target).body for target in targets}
    assert len(answers) == 1, "the responses reveal which paths exist"
    for line in ("Authorization: Basic eDp5", "Authorization: Bearer", "Authorization:", "Cookie: oval4d_token", "Cookie: =",
                 f"Cookie: xoval4d_token={SECRET}", f"X-Token: {SECRET}"):
        assert fetch(server_with_token, "/api/v1/keymap", line).status == 401, line


def test_the_token_cookie_is_http_only_and_same_site(server_with_token):
    cookie = fetch(server_with_token, f"/?token={SECRET}").get("Set-Cookie")
    words = [word.strip().lower() for word in cookie.split(";")]
    assert "httponly" in words and "samesite=strict" in words


def test_tokens_are_not_logged(server_with_token):
    fetch(server_with_token, f"/?token={SECRET}")
    fetch(server_with_token, "/?token=wrong-guess")
    assert SECRET not in server_with_token.log().split("\n", 1)[1] and "wrong-guess" not in server_with_token.log()


# --- Guessing the server's token is slow

def status_with_token(server, kind, token, source):
    """Returns the HTTP status of a request with this token."""
    if kind == "query":
        return fetch(server, f"/api/v1/keymap?token={token}", source=source).status
    if kind == "socket":
        with Socket(server, source) as raw:
            raw.send(handshake(f"/ws?token={token}"))
            return raw.read_response().status
    line = f"Authorization: Bearer {token}" if kind == "bearer" else f"Cookie: oval4d_token={token}"
    return fetch(server, "/api/v1/keymap", line, source=source).status


def assert_limited(answers, wrong, refusals, start):
    """Asserts that no more than 10 guesses were tried at once, and then 10 per minute, and that the others were refused."""
    allowed = 10 * (1 + (time.monotonic() - start) / 60)
    assert answers.count(wrong) <= allowed + 1 and set(answers) <= {wrong, *refusals}, answers


@pytest.mark.parametrize("kind", ["query", "bearer", "cookie", "socket"])
def test_an_address_that_guesses_tokens_is_blocked(kind):
    good = 101 if kind == "socket" else 200
    with Server("--host", "0.0.0.0", "--token", SECRET, "--max-wrong-tokens", 10) as server:
        server.host = "127.0.0.1"
        start = time.monotonic()
        statuses = [status_with_token(server, kind, f"guess-{number}", "127.0.0.2") for number in range(30)]
        assert statuses[:5] == [401] * 5
        assert_limited(statuses, 401, (403, 429, 503), start)
        # One more guess is allowed from time to time. While guesses are refused, the correct token is refused, too.
        wait_until(lambda: status_with_token(server, kind, "guess", "127.0.0.2") != 401
                   and status_with_token(server, kind, SECRET, "127.0.0.2") != good, "the refusal of the correct token")
        assert status_with_token(server, kind, SECRET, "127.0.0.3") == good, "another address is blocked"
        assert fetch(server, "/healthz", source="127.0.0.2").status == 200


def test_an_address_that_guesses_session_tokens_is_blocked():
    with Server("--max-wrong-tokens", 10) as server:
        with WebSocket(server, source="127.0.0.3") as owner:
            welcome = owner.request(type="hello")
        path = f"/ws/{welcome['session']}"

        def join(token, source):
            try:
                with WebSocket(server, path, source=source) as peer:
                    answer = peer.request(type="hello", token=token)
                    return answer.get("code", answer["type"])
            except ConnectionEnded:
                return "ended"

        start = time.monotonic()
        answers = [join(f"guess-{number}", "127.0.0.2") for number in range(30)]
        assert answers[:5] == ["bad_token"] * 5
        assert_limited(answers, "bad_token", ("too_many", "ended"), start)
        wait_until(lambda: join("guess", "127.0.0.2") != "bad_token" and join(welcome["token"], "127.0.0.2") != "welcome",
                   "the refusal of the correct token")
        assert join(welcome["token"], "127.0.0.3") == "welcome"
