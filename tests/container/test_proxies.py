"""The proxies of docker/proxies: the page, its files, WebSockets and the client's address pass through them."""

import asyncio
import http.client
import re
import subprocess
import sys
from pathlib import Path

import pytest
import websockets
import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/service"))
from harness import Server, free_port, is_listening, wait_until  # noqa: E402

EXAMPLES = ROOT / "docker/proxies"


def words_to_start(name, path, folder):
    """Returns the command that starts a proxy with the configuration file at `path`."""
    if name == "nginx.conf":
        return ["nginx", "-p", str(folder), "-c", str(path), "-g", "daemon off;"]
    return ["caddy", "run", "--adapter", "caddyfile", "--config", str(path)]


@pytest.fixture(name="proxy", params=["nginx.conf", "Caddyfile"])
def start_proxy(request, tmp_path):
    """Yields the server and the port of a proxy, which has the example's configuration but for the ports."""
    with Server("--trusted-proxy", "127.0.0.1", "--allow-host", "*") as server:
        port = free_port()
        text = (EXAMPLES / request.param).read_text(encoding="utf-8")
        assert "127.0.0.1:8080" in text
        text = text.replace("127.0.0.1:8080", f"127.0.0.1:{server.port}").replace("listen 80;", f"listen 127.0.0.1:{port};")
        text = text.replace(":80 {", f"http://127.0.0.1:{port} {{")
        path = tmp_path / request.param
        path.write_text(text, encoding="utf-8")
        with open(tmp_path / "log", "wb") as log:
            process = subprocess.Popen(words_to_start(request.param, path, tmp_path), stdin=subprocess.DEVNULL, stdout=log,
                                       stderr=log, env={"HOME": str(tmp_path), "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"})
        try:
            wait_until(lambda: is_listening("127.0.0.1", port), "the proxy")
            yield server, port
        finally:
            process.kill()
            process.wait()


def get(port, path, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", port)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    return answer, answer.read()


async def conversation(port, origin):
    """Opens a session through the proxy, and asserts that another origin cannot."""
    url = f"ws://127.0.0.1:{port}/oval/ws"
    async with websockets.connect(url, subprotocols=["oval4d.v1"], origin=origin) as socket:
        await socket.send('{"type":"hello"}')
        assert '"welcome"' in await socket.recv()
    with pytest.raises(websockets.InvalidHandshake):
        await websockets.connect(url, subprotocols=["oval4d.v1"], origin="http://evil.example")


def test_a_proxy_serves_the_page_and_its_session(proxy):
    server, port = proxy
    origin = f"http://127.0.0.1:{port}"
    answer, _ = get(port, "/oval")
    assert answer.status in (301, 302, 308) and answer.getheader("Location").removesuffix("?").endswith("/oval/")
    answer, _ = get(port, "/oval?polytope=24-cell&token=a%2Bb")
    assert answer.getheader("Location").endswith("/oval/?polytope=24-cell&token=a%2Bb")
    for file, begin in (("", b"<!doctype html>"), ("app.js", b"")):
        answer, body = get(port, f"/oval/{file}", Origin=origin)
        assert answer.status == 200 and body.lower().startswith(begin)
    answer, body = get(port, "/oval/api/v1/frame.png?polytope=24-cell&width=64&height=64", Origin=origin)
    assert answer.status == 200 and body.startswith(b"\x89PNG")
    clients = server.metric("oval4d_clients")
    get(port, "/oval/", **{"X-Forwarded-For": "198.51.100.7"})
    assert server.metric("oval4d_clients") == clients  # the proxy replaces what the client has sent
    asyncio.run(conversation(port, origin))
    assert "X-Forwarded-For has no address" not in server.log()


def test_the_redirect_of_traefik_keeps_the_query():
    middlewares = yaml.safe_load((EXAMPLES / "traefik.yaml").read_text(encoding="utf-8"))["http"]["middlewares"]
    redirect = middlewares["slash"]["redirectRegex"]
    replacement = re.sub(r"\$\{(\d)\}", r"\\\1", redirect["replacement"])
    for address, expected in (("https://host/oval", "https://host/oval/"), ("https://host/oval/", "https://host/oval/"),
                              ("http://host:80/oval?a=b/c", "http://host:80/oval/?a=b/c"),
                              ("https://host/oval/?a=b", "https://host/oval/?a=b")):
        assert re.sub(redirect["regex"], replacement, address) == expected
