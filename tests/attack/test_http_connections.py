"""HTTP connections: endless requests, many requests on one connection, and clients that leave, stop or wait."""

import concurrent.futures
import contextlib
import json
import time

import pytest
from harness import Server, is_sanitizer_build, wait_until
from http_site import REFUSED, SCRIPT, responses_to
from raw import Socket, fetch, handshake, request, send_as_far_as_read

# --- Endless requests do not fill the memory

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


# --- One connection may send many requests

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


def test_http_1_0_clients_are_told_whether_the_connection_stays_open(site_server):
    asking = request("/healthz", "Connection: keep-alive", version="HTTP/1.0")
    answers = responses_to(site_server, asking + request("/healthz", version="HTTP/1.0"))
    assert [answer.get("Connection") for answer in answers] == ["keep-alive", "close"]


def test_the_server_stops_reading_from_a_client_that_reads_nothing(site_server):
    """If a client pipelines requests and reads no responses, the server stops reading from it and serves others."""
    def serve_another():
        assert fetch(site_server, "/app.js").body == SCRIPT

    with Socket(site_server, receive_buffer=4096) as raw:
        data = request("/packed.js") * 100_000
        assert send_as_far_as_read([raw], data, serve_another) < len(data), "100,000 requests were accepted"
        serve_another()


# --- Clients may leave, stop or wait at any point of a request

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
