"""Access control: hosts, origins, Fetch Metadata of browsers, and tokens."""

import pytest
from harness import Server
from raw import Ended, Socket, WebSocket, ask, handshake, request

REFUSED = (400, 403, 421)
PICTURE = "/api/v1/frame.png?width=64&height=64"
FILE = "/api/v1/file.csv"
COSTLY = [PICTURE, FILE, "/api/v1/file.stl", "/api/v1/file.svg"]


@pytest.fixture(name="allowing", scope="module")
def a_server_that_allows_a_page():
    with Server("--allow-origin", "https://pages.example") as server:
        yield server


def status_of_socket(server, *fields, host="localhost", target="/ws", source=None):
    """Returns the HTTP status of a WebSocket handshake."""
    with Socket(server, source) as raw:
        raw.send(handshake(target, *fields, host=host))
        return raw.answer().status


def status_of(server, target, *fields, host="localhost"):
    return ask(server, target, *fields, host=host).status


# --- Hosts

@pytest.mark.parametrize("host", ["localhost", "LOCALHOST", "LocalHost", "localhost:80", "localhost:1", "localhost:65535", "127.0.0.1",
                                  "127.0.0.1:8080", "[::1]", "[::1]:8080"])
def test_hosts_that_are_this_machine(server, host):
    assert status_of(server, "/api/v1/keymap", host=host) == 200
    assert status_of_socket(server, host=host) == 101
    assert status_of_socket(server, f"Origin: http://{host}", host=host) == 101


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
def test_hosts_that_are_not(server, host):
    assert status_of(server, "/api/v1/keymap", host=host) in REFUSED
    assert status_of(server, "/", host=host) in REFUSED
    assert status_of(server, PICTURE, f"Origin: http://{host}", host=host) in REFUSED
    assert status_of_socket(server, host=host) in REFUSED


@pytest.mark.parametrize("host", ["localhost.", "localhost:", "[0:0:0:0:0:0:0:1]", "[::1]:", "localhost:080"])
def test_hosts_that_may_be_either(server, host):
    assert status_of(server, "/api/v1/keymap", host=host) in (200, *REFUSED)


# --- Origins

@pytest.mark.parametrize("origin, host", [
    ("http://localhost:81", "localhost:81"), ("https://localhost:81", "localhost:81"), ("http://LOCALHOST:81", "localhost:81"),
    ("http://127.0.0.1:81", "127.0.0.1:81"), ("http://[::1]:81", "[::1]:81"), ("http://localhost", "localhost"),
])
def test_the_server_s_own_page(server, origin, host):
    assert status_of_socket(server, f"Origin: {origin}", host=host) == 101
    for target in ["/api/v1/keymap", *COSTLY]:
        assert status_of(server, target, f"Origin: {origin}", host=host) == 200


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
def test_foreign_origins(server, origin):
    assert status_of_socket(server, f"Origin: {origin}", host="localhost:81") in REFUSED
    for target in ("/api/v1/keymap", PICTURE, FILE):
        assert status_of(server, target, f"Origin: {origin}", host="localhost:81") in REFUSED


@pytest.fixture(name="open_to_all", scope="module")
def a_server_of_any_name():
    with Server("--allow-host", "*") as server:
        yield server


@pytest.mark.parametrize("port", ["abc", "99999", "65536", "-1", "81x", "+81", "8 1", "0x51", "99999999999999999999", "81:81", "81@x"])
def test_origins_whose_ports_are_none_though_the_host_has_the_same(open_to_all, port):
    """The origin is checked as strictly if every host is allowed."""
    for scheme in ("http", "https"):
        assert status_of_socket(open_to_all, f"Origin: {scheme}://localhost:{port}", host=f"localhost:{port}") in REFUSED


@pytest.mark.parametrize("scheme", ["file", "chrome-extension", "ws", "ftp", ""])
def test_origins_of_other_schemes_though_the_host_is_the_same(open_to_all, scheme):
    assert status_of_socket(open_to_all, "Origin: http://any.example:81", host="any.example:81") == 101
    assert status_of_socket(open_to_all, f"Origin: {scheme}://any.example:81", host="any.example:81") in REFUSED


@pytest.mark.parametrize("origin, allowed", [
    ("https://pages.example", True), ("https://PAGES.example", True), ("http://pages.example", False),
    ("https://pages.example:444", False), ("https://pages.example.evil.example", False), ("https://sub.pages.example", False),
    ("https://pages.examplex", False), ("https://xpages.example", False), ("https://pages.example/", False),
    ("https://pages.example@evil.example", False), ("null", False), ("https://pages.example, https://evil.example", False),
])
def test_pages_that_are_allowed(allowing, origin, allowed):
    statuses = [status_of_socket(allowing, f"Origin: {origin}"), status_of(allowing, PICTURE, f"Origin: {origin}")]
    assert statuses == [101, 200] if allowed else all(status in REFUSED for status in statuses)


# --- The site from which a request comes, according to the browser (Fetch Metadata)

CROSS = "Sec-Fetch-Site: cross-site"
IMAGE = ["Sec-Fetch-Mode: no-cors", "Sec-Fetch-Dest: image"]
FETCH = ["Sec-Fetch-Mode: cors", "Sec-Fetch-Dest: empty"]
LINK = ["Sec-Fetch-Mode: navigate", "Sec-Fetch-Dest: document", "Sec-Fetch-User: ?1"]


@pytest.mark.parametrize("target", COSTLY)
@pytest.mark.parametrize("kind", [IMAGE, FETCH, [], ["Sec-Fetch-Mode: no-cors", "Sec-Fetch-Dest: script"],
                                  ["Sec-Fetch-Mode: navigate", "Sec-Fetch-Dest: iframe"]], ids=["image", "fetch", "bare", "script", "iframe"])
def test_foreign_pages_cause_no_work(server, target, kind):
    for method in ("GET", "HEAD"):
        with Socket(server) as raw:
            raw.send(request(target, CROSS, *kind, method=method, close=True))
            assert raw.answer(method).status == 403


def test_a_foreign_page_that_is_refused_costs_nothing(server):
    """The server neither draws pictures nor creates files for it."""
    def work():
        return [server.metric('oval4d_picture_step_seconds_count{step="slice"}'), server.metric("oval4d_file_seconds_count")]

    before = work()
    for target in (PICTURE, FILE):
        ask(server, target)
    assert all(then < now for then, now in zip(before, work()))
    before = work()
    for target in 3 * COSTLY:
        ask(server, target, CROSS, *IMAGE)
    assert work() == before


@pytest.mark.parametrize("site", ["same-origin", "none"])
@pytest.mark.parametrize("target", ["/", "/api/v1/keymap", PICTURE, FILE])
def test_the_page_itself_and_the_user_may(server, site, target):
    assert status_of(server, target, f"Sec-Fetch-Site: {site}", *FETCH) == 200


def test_a_link_leads_to_the_page(server):
    for target in ("/", "/?polytope=24-cell"):
        answer = ask(server, target, CROSS, *LINK)
        assert answer.status == 200 and answer.body.lower().startswith(b"<!doctype html>")


def test_probes_are_answered_wherever_they_come_from(server):
    assert status_of(server, "/healthz", CROSS) == status_of(server, "/readyz", CROSS) == 200


@pytest.mark.parametrize("target", [PICTURE, FILE])
def test_an_allowed_page_may_cause_work(allowing, target):
    assert status_of(allowing, target, CROSS, *FETCH, "Origin: https://pages.example") == 200
    assert status_of(allowing, target, CROSS, *FETCH, "Origin: https://evil.example") in REFUSED
    assert status_of(allowing, target, CROSS, *IMAGE) == 403


def test_sockets_of_foreign_pages(server, allowing):
    mode = ["Sec-Fetch-Mode: websocket", "Sec-Fetch-Dest: websocket"]
    assert status_of_socket(server, CROSS, *mode) == 403
    assert status_of_socket(server, CROSS, *mode, "Origin: http://evil.example") in REFUSED
    assert status_of_socket(allowing, CROSS, *mode, "Origin: https://pages.example") == 101
    assert status_of_socket(server, "Sec-Fetch-Site: same-origin", *mode, "Origin: http://localhost") == 101


# --- Security headers of all responses

def answers_of_every_kind(server):
    tag = ask(server, "/").get("ETag")
    yield ask(server, "/")
    yield ask(server, "/", f"If-None-Match: {tag}")
    for target in ("/healthz", "/readyz", "/metrics", "/api/v1/keymap", "/api/v1/catalogue", PICTURE, FILE, "/nothing",
                   "/api/v1/frame.png?width=x", "/%zz"):
        yield ask(server, target)
    yield ask(server, "/", method="POST")
    yield ask(server, "/", host="evil.example")
    yield ask(server, "/", "Origin: null")
    yield ask(server, PICTURE, CROSS)
    yield ask(server, "/ws")
    for data in (b"nonsense\r\n\r\n", request("/", "X: " + "x" * 20_000), request("/", "Transfer-Encoding: x"),
                 handshake("/nothing"), handshake(protocol="other")):
        with Socket(server) as raw:
            raw.try_send(data)
            yield raw.answer()


def test_every_answer_keeps_to_its_own_origin(server):
    seen = set()
    for answer in answers_of_every_kind(server):
        assert answer.get("Cross-Origin-Resource-Policy") == "same-origin", answer
        assert answer.get("Cross-Origin-Opener-Policy") == "same-origin", answer
        assert answer.get("X-Content-Type-Options") == "nosniff" and answer.get("Referrer-Policy") == "no-referrer"
        assert answer.get("Access-Control-Allow-Origin") is None
        seen.add(answer.status)
    assert seen >= {200, 304, 400, 403, 404, 405, 431}


# --- The server's own token

SECRET = "open-sesame"


@pytest.fixture(name="guarded", scope="module")
def a_guarded_server():
    with Server("--host", "0.0.0.0", "--token", SECRET) as server:
        server.host = "127.0.0.1"
        yield server


@pytest.mark.parametrize("target, lines", [
    (f"/api/v1/keymap?token={SECRET}", []), (f"/api/v1/keymap?x=y&token={SECRET}", []), ("/api/v1/keymap?token=open%2dsesame", []),
    ("/api/v1/keymap", [f"Authorization: Bearer {SECRET}"]), ("/api/v1/keymap", [f"authorization: bearer {SECRET}"]),
    ("/api/v1/keymap", [f"Cookie: oval4d_token={SECRET}"]), ("/api/v1/keymap", [f"Cookie: a=b; oval4d_token={SECRET}; c=d"]),
])
def test_right_tokens(guarded, target, lines):
    assert ask(guarded, target, *lines).status == 200
    assert status_of_socket(guarded, *lines, target=target.replace("/api/v1/keymap", "/ws")) == 101


WRONG = ["", "x", SECRET[:-1], SECRET + "x", "x" + SECRET, SECRET.upper(), SECRET + "%00", "%00" + SECRET, SECRET * 2, "*", "x" * 4000]


@pytest.mark.parametrize("number", range(len(WRONG)), ids=lambda number: WRONG[number][:30])
def test_wrong_tokens(guarded, number):
    # Each test has its own address, because wrong tokens are counted by address.
    token, source = WRONG[number], f"127.0.1.{number + 1}"
    for target, lines in ((f"/api/v1/keymap?token={token}", []), ("/api/v1/keymap", [f"Authorization: Bearer {token}"]),
                          ("/api/v1/keymap", [f"Cookie: oval4d_token={token}"])):
        answer = ask(guarded, target, *lines, source=source)
        assert answer.status == 401 and answer.get("WWW-Authenticate") == "Bearer"
        assert not answer.all("Set-Cookie")
        assert status_of_socket(guarded, *lines, target=target.replace("/api/v1/keymap", "/ws"), source=source) == 401


def test_without_a_token_nothing_is_told(guarded):
    answers = {ask(guarded, target).body for target in ("/", "/nothing", "/metrics", PICTURE, "/api/v1/keymap", "/app.js")}
    assert len(answers) == 1, "what there is can be told from what there is not"
    for line in ("Authorization: Basic eDp5", "Authorization: Bearer", "Authorization:", "Cookie: oval4d_token", "Cookie: =",
                 f"Cookie: xoval4d_token={SECRET}", f"X-Token: {SECRET}"):
        assert ask(guarded, "/api/v1/keymap", line).status == 401, line


def test_the_cookie_is_for_the_page_alone(guarded):
    cookie = ask(guarded, f"/?token={SECRET}").get("Set-Cookie")
    words = [word.strip().lower() for word in cookie.split(";")]
    assert "httponly" in words and "samesite=strict" in words


def test_the_token_is_not_in_the_log(guarded):
    ask(guarded, f"/?token={SECRET}")
    ask(guarded, "/?token=wrong-guess")
    assert SECRET not in guarded.log().split("\n", 1)[1] and "wrong-guess" not in guarded.log()


# --- Guessing the server's token

def guess(server, kind, token, source):
    """Returns the HTTP status of a request with this token."""
    if kind == "query":
        return ask(server, f"/api/v1/keymap?token={token}", source=source).status
    if kind == "socket":
        with Socket(server, source) as raw:
            raw.send(handshake(f"/ws?token={token}"))
            return raw.answer().status
    line = f"Authorization: Bearer {token}" if kind == "bearer" else f"Cookie: oval4d_token={token}"
    return ask(server, "/api/v1/keymap", line, source=source).status


@pytest.mark.parametrize("kind", ["query", "bearer", "cookie", "socket"])
def test_who_guesses_is_soon_not_listened_to(kind):
    good = 101 if kind == "socket" else 200
    with Server("--host", "0.0.0.0", "--token", SECRET, "--max-wrong-tokens", 10) as server:
        server.host = "127.0.0.1"
        statuses = [guess(server, kind, f"guess-{number}", "127.0.0.2") for number in range(30)]
        assert statuses[:5] == [401] * 5
        assert set(statuses[15:]) <= {403, 429, 503}, statuses
        assert guess(server, kind, SECRET, "127.0.0.2") != good, "who guesses right at last is let in"
        assert guess(server, kind, SECRET, "127.0.0.3") == good, "others are shut out"
        assert ask(server, "/healthz", source="127.0.0.2").status == 200


def test_who_guesses_a_session_s_token_is_soon_not_listened_to():
    with Server("--max-wrong-tokens", 10) as server:
        with WebSocket(server, source="127.0.0.3") as owner:
            welcome = owner.ask(type="hello")
        path = f"/ws/{welcome['session']}"

        def join(token, source):
            try:
                with WebSocket(server, path, source=source) as peer:
                    answer = peer.ask(type="hello", token=token)
                    return answer.get("code", answer["type"])
            except Ended:
                return "ended"

        answers = [join(f"guess-{number}", "127.0.0.2") for number in range(30)]
        assert answers[:5] == ["bad_token"] * 5
        assert set(answers[15:]) <= {"too_many", "ended"}, answers
        assert join(welcome["token"], "127.0.0.2") != "welcome"
        assert join(welcome["token"], "127.0.0.3") == "welcome"
