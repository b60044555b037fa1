"""HTTP: the page, the API, the health probes, and access control."""

import gzip
import json

import pytest
import websockets
from harness import DEADLINE, Server
from wire import Client, connect, handshake_status


@pytest.fixture(name="site_server", scope="module")
def start_site_server(tmp_path_factory):
    root = tmp_path_factory.mktemp("site")
    (root / "index.html").write_text("<!doctype html><title>page</title>")
    (root / "app.js").write_text("export {};\n")
    (root / "style.css").write_text("body {}\n")
    (root / "images").mkdir()
    (root / "images" / "icon.svg").write_text("<svg/>")
    (root.parent / "secret.txt").write_text("secret")
    with Server("--web-root", root) as server:
        yield server


SCRIPT = b"export {};\n" * 20


@pytest.fixture(name="compressed_site_server", scope="module")
def start_compressed_site_server(tmp_path_factory):
    root = tmp_path_factory.mktemp("packed")
    (root / "index.html").write_text("<!doctype html><title>page</title>")
    (root / "app.js").write_bytes(SCRIPT)
    (root / "app.js.gz").write_bytes(gzip.compress(SCRIPT, mtime=0))
    (root / "app.js.br").write_bytes(b"brotli")  # the server does not decompress this
    (root / "lone.gz").write_bytes(b"as it is")
    with Server("--web-root", root) as server:
        yield server


@pytest.mark.parametrize("path, type_, content", [
    ("/", "text/html; charset=utf-8", b"<!doctype html>"), ("/index.html", "text/html; charset=utf-8", b"<!doctype"),
    ("/?polytope=24-cell&rotate=xw:pi/8", "text/html; charset=utf-8", b"<!doctype html>"),
    ("/app.js", "text/javascript; charset=utf-8", b"export"), ("/style.css", "text/css; charset=utf-8", b"body"),
    ("/images/icon.svg", "image/svg+xml", b"<svg/>"),
])
def test_page_files_are_served_with_their_media_types(site_server, path, type_, content):
    answer = site_server.get(path)
    assert answer.status == 200 and answer.getheader("Content-Type") == type_
    assert answer.body.startswith(content)
    assert answer.getheader("Cache-Control") == "no-cache"
    assert answer.getheader("X-Content-Type-Options") == "nosniff"


def test_an_unchanged_file_is_not_sent_again(site_server):
    etag = site_server.get("/app.js").getheader("ETag")
    again = site_server.get("/app.js", If_None_Match=etag)
    assert again.status == 304 and again.body == b"" and again.getheader("ETag") == etag
    assert site_server.get("/app.js", If_None_Match='"other"').status == 200
    assert site_server.get("/style.css").getheader("ETag") != etag


@pytest.mark.parametrize("accepted, coding", [
    (None, None), ("", None), ("identity", None), ("deflate, zstd", None), ("gzip", "gzip"), ("GZIP", "gzip"),
    ("br", "br"), ("gzip, deflate, br, zstd", "br"), ("gzip;q=1.0, br;q=0.5", "gzip"), ("br;q=0, gzip;q=0.1", "gzip"),
    ("*", "br"), ("*;q=0.3, br;q=0", "gzip"), ("identity, *;q=0", None), ("gzip;q=0", None), (";;,=,q", None),
])
def test_a_file_is_sent_in_the_preferred_encoding(compressed_site_server, accepted, coding):
    headers = {} if accepted is None else {"Accept_Encoding": accepted}
    answer = compressed_site_server.get("/app.js", **headers)
    assert answer.status == 200 and answer.getheader("Content-Encoding") == coding
    assert answer.getheader("Content-Type") == "text/javascript; charset=utf-8"
    assert "Accept-Encoding" in answer.getheader("Vary")
    assert answer.body == {None: SCRIPT, "gzip": gzip.compress(SCRIPT, mtime=0), "br": b"brotli"}[coding]
    again = compressed_site_server.get("/app.js", If_None_Match=answer.getheader("ETag"), **headers)
    assert again.status == 304 and again.body == b""


def test_each_encoding_of_a_file_has_its_own_etag(compressed_site_server):
    tags = {compressed_site_server.get("/app.js", Accept_Encoding=coding).getheader("ETag") for coding in ("gzip", "br", "x")}
    assert len(tags) == 3
    for path in ("/app.js.gz", "/app.js.br"):
        assert compressed_site_server.get(path).status == 404, "a compressed variant is not a file of its own"
    assert compressed_site_server.get("/lone.gz").body == b"as it is"
    head = compressed_site_server.get("/app.js", method="HEAD", Accept_Encoding="br")
    assert head.body == b"" and head.getheader("Content-Length") == "6"


def test_the_content_security_policy_forbids_foreign_sources(site_server):
    policy = dict(part.strip().split(" ", 1) for part in site_server.get("/").getheader("Content-Security-Policy").split(";"))
    assert policy["default-src"] == "'none'" and policy["script-src"] == "'self'" and policy["connect-src"] == "'self'"
    assert not any("unsafe" in sources or "*" in sources or "http" in sources for sources in policy.values())


@pytest.mark.parametrize("path", ["/nothing", "/images", "/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt",
                                  "//app.js", "/api/v1/", "/api/v2/catalogue"])
def test_missing_paths_get_404(site_server, path):
    answer = site_server.get(path)
    assert answer.status == 404 and json.loads(answer.body)["code"] == "not_found"


def test_head_is_answered_and_post_is_refused(site_server):
    head = site_server.get("/app.js", method="HEAD")
    assert head.status == 200 and head.body == b"" and head.getheader("Content-Length") == "11"
    answer = site_server.get("/app.js", method="POST")
    assert answer.status == 405 and answer.getheader("Allow") == "GET, HEAD"


def test_one_connection_serves_many_requests(site_server):
    import http.client

    connection = http.client.HTTPConnection(site_server.host, site_server.port, timeout=DEADLINE)
    for _ in range(3):
        connection.request("GET", "/healthz")
        assert connection.getresponse().read() == b"ok\n"
        own = connection.sock.getsockname()
    connection.request("GET", "/readyz")
    connection.getresponse().read()
    assert connection.sock.getsockname() == own
    connection.close()


def test_the_server_works_without_the_page_files(tmp_path):
    with Server("--web-root", tmp_path / "none") as server:
        assert server.get("/").status == 404
        assert server.get("/api/v1/catalogue").status == 200
        assert "no page" in server.log()


def test_health_probes_are_answered(server):
    assert server.get("/healthz").body == b"ok\n"
    assert server.get("/readyz").status == 200


def test_catalogue_and_keymap_are_served(server):
    catalogue = json.loads(server.get("/api/v1/catalogue").body)["polytopes"]
    assert {"name": "600-cell", "vertices": 120, "edges": 720, "faces": 1200, "cells": 600}.items() <= next(
        p for p in catalogue if p["name"] == "600-cell").items()
    omnitruncated = next(p for p in catalogue if p["name"] == "omnitruncated 120-cell")
    assert omnitruncated == {
        "name": "omnitruncated 120-cell", "family": "uniform H4", "diagram": "x5x3x3x", "schlaefli": "t0,1,2,3{5,3,3}",
        "aliases": omnitruncated["aliases"], "vertices": 14400, "edges": 28800, "faces": 17040, "cells": 2640,
        "symmetry_order": 14400}
    assert {"gidpixhi", "omnitruncated 600-cell"} <= set(omnitruncated["aliases"])
    assert len(json.loads(server.get("/api/v1/keymap").body)["keys"]) > 20


async def test_metrics_count_messages_and_pictures(server):
    before = server.metric('oval4d_errors_total{code="unknown_key"}')
    async with Client(server, stream="geometry") as client:
        sockets = server.metric("oval4d_websockets")
        assert sockets >= 1 and server.metric("oval4d_sessions") >= 1
        await client.socket.send('{"type":"key","key":"q"}')
        await client.wait_for_slices(0)  # otherwise, one picture could show both states
        done = await client.request("key", key="y")
        await client.wait_for_slices(done["revision"])
    assert server.metric('oval4d_errors_total{code="unknown_key"}') == before + 1
    server.wait_for(lambda: server.metric('oval4d_pictures_total{stream="geometry"}') >= 2)
    server.wait_for(lambda: server.metric('oval4d_picture_step_seconds_count{step="slice"}') >= 2)
    server.wait_for(lambda: server.metric("oval4d_bytes_sent_total") > 1000)
    text = server.get("/metrics").body.decode()
    assert "# TYPE oval4d_connections gauge" in text


@pytest.mark.parametrize("headers, status", [
    ({}, 200), ({"Host": "localhost:1"}, 200), ({"Host": "localhost.:1"}, 200), ({"Host": "[::1]:80"}, 200), ({"Host": "evil.example"}, 403),
    ({"Host": "127.0.0.1.evil.example"}, 403), ({"Host": ""}, 403),
    ({"Origin": "http://evil.example"}, 403), ({"Origin": "null"}, 403),
    ({"Host": "localhost:99", "Origin": "http://localhost:99"}, 200),
    ({"Host": "localhost:99", "Origin": "http://localhost:98"}, 403),
    ({"Host": "localhost.:99", "Origin": "http://localhost:99"}, 200),
])
async def test_only_local_hosts_and_origins_are_accepted(server, headers, status):
    assert server.get("/api/v1/catalogue", **headers).status == status
    assert server.get("/healthz", **headers).status == 200


def test_the_pages_files_are_served_whatever_the_origin(server):
    """Browsers send an Origin for modules, and a proxy may change Host."""
    for origin in ("http://oval.example", "null"):
        assert server.get("/app.js", Origin=origin).status == 200
        assert server.get("/", Origin=origin).status == 200
    refusal = server.get("/api/v1/catalogue", Host="localhost:99", Origin="http://oval.example")
    assert refusal.status == 403
    for part in (b"'http://oval.example'", b"'localhost:99'", b"a proxy must pass the header Host on", b"--allow-origin"):
        assert part in refusal.body


async def test_websockets_from_foreign_origins_are_refused(server):
    with pytest.raises(websockets.InvalidHandshake) as refused:
        await connect(server, origin="http://evil.example")
    assert handshake_status(refused.value) == 403
    async with connect(server, origin=f"http://{server.host}:{server.port}") as socket:
        await socket.ping()


async def test_options_allow_hosts_and_origins():
    with Server("--allow-host", "oval.example", "--allow-host", "127.0.0.1", "--allow-origin",
                "https://pages.example") as server:
        assert server.get("/api/v1/keymap", Host="oval.example").status == 200
        assert server.get("/api/v1/keymap", Host="localhost").status == 403
        async with connect(server, origin="https://pages.example") as socket:
            await socket.ping()


@pytest.mark.parametrize("path, status", [("/nowhere", 404), ("/wsx", 404), ("/api/v1/catalogue", 404)])
async def test_websockets_are_only_at_ws(server, path, status):
    with pytest.raises(websockets.InvalidHandshake) as refused:
        await websockets.connect(f"ws://{server.host}:{server.port}{path}")
    assert handshake_status(refused.value) == status


async def test_other_protocol_versions_are_refused(server):
    with pytest.raises(websockets.InvalidHandshake) as refused:
        await connect(server, subprotocols=["oval4d.v99"])
    assert handshake_status(refused.value) == 400
    async with connect(server, subprotocols=["oval4d.v99", "oval4d.v1"]) as socket:
        assert socket.subprotocol == "oval4d.v1"


async def test_a_token_is_required_beyond_loopback():
    with Server("--host", "0.0.0.0", "--token", "open-sesame") as server:
        assert server.token == "open-sesame"
        server.host = "127.0.0.1"
        assert server.get("/healthz").status == server.get("/readyz").status == 200
        for path in ("/", "/metrics", "/api/v1/catalogue", "/api/v1/catalogue?token=wrong"):
            refused = server.get(path)
            assert refused.status == 401 and refused.getheader("WWW-Authenticate") == "Bearer"
        assert server.get("/api/v1/catalogue", Authorization="Bearer open-sesame").status == 200
        page = server.get("/api/v1/catalogue?token=open-sesame")
        assert page.status == 200 and "HttpOnly" in page.getheader("Set-Cookie")
        cookie = page.getheader("Set-Cookie").split(";")[0]
        assert server.get("/api/v1/catalogue", Cookie="a=b; " + cookie).status == 200
        assert server.get("/api/v1/frame.png?token=open-sesame&width=64&height=64").status == 200
        with pytest.raises(websockets.InvalidHandshake) as refused:
            await connect(server)
        assert handshake_status(refused.value) == 401
        async with websockets.connect(f"ws://127.0.0.1:{server.port}/ws?token=open-sesame") as socket:
            await socket.send('{"type":"hello"}')
            assert "welcome" in await socket.recv()
        assert "sesame" not in server.log().split("\n", 1)[1]


def test_a_token_is_generated_unless_it_is_given_or_disabled():
    with Server("--host", "0.0.0.0") as one, Server("--host", "0.0.0.0") as two:
        assert len(one.token) == 32 and one.token != two.token
    with Server("--host", "0.0.0.0", "--open") as server:
        assert not server.token and server.get("/api/v1/catalogue", Host="any.example").status == 200


def test_the_printed_address_has_the_token_escaped():
    with Server("--host", "0.0.0.0", "--token", "a+/&b=") as server:
        assert server.get(server.url.partition(str(server.port))[2].replace("/?", "/api/v1/catalogue?")).status == 200


def send_raw_bytes(server, data):
    import socket

    with socket.create_connection((server.host, server.port), timeout=DEADLINE) as raw:
        raw.sendall(data)
        answer = b""
        while chunk := raw.recv(65536):
            answer += chunk
        return answer


@pytest.mark.parametrize("path", ["/api/v1/frame.png?rotate=xw:30%", "/api/v1/file.stl?a=%zz", "/%4"])
def test_a_malformed_escape_is_explained(server, path):
    answer = server.get(path)
    error = json.loads(answer.body)
    assert answer.status == 400 and error["type"] == "error" and error["code"] == "bad_message" and "%" in error["message"]


@pytest.mark.parametrize("data, status", [
    (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", b"400"),
    (b"GET / HTTP/9.9\r\n\r\n", b"400"),
    (b"GET /?%zz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", b"400"),
    (b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 20_000 + b"\r\n\r\n", b"431"),
    (b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000000\r\n\r\n", b"413"),
])
def test_malformed_requests_are_refused(server, data, status):
    assert send_raw_bytes(server, data).split(b" ")[1] == status
    assert server.get("/healthz").status == 200
