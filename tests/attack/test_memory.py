"""Memory that clients can make the server hold: files that they do not read, loaded polytopes that undo keeps, endless
messages. The bounds are relative to the data sent or requested in the same run.
"""

import contextlib
import math
import select
import signal
import time

import pytest
from harness import Server, is_sanitizer_build, wait_until
from raw import TEXT, Socket, WebSocket, fetch, frame, request, send_as_far_as_read

pytestmark = pytest.mark.skipif(is_sanitizer_build(), reason="sanitizers keep freed memory")

ATTACKER, OTHER = "127.0.0.2", "127.0.0.3"
FILE = "/api/v1/file.stl?polytope=24-cell&of=oval&body=frame&slices=11"
LEAST_FILE_SIZE = 8 << 20
NOISE = 24 << 20  # bytes by which the memory varies due to allocators and caches
REFUSED = (413, 429, 503)


def memory_now(server):
    """Returns the least of several values of the server's memory, which leaves out short peaks; what tests assert are
    upper bounds, so an initial value that is too large only makes them weaker."""
    found = []
    for _ in range(10):
        found.append(server.anonymous_memory())
        time.sleep(0.02)
    return min(found)


def wait_for_memory_below(server, bound):
    """Waits until the server's memory is less than `bound` bytes."""
    wait_until(lambda: server.anonymous_memory() < bound, f"memory of less than {bound} bytes")


class Peak:
    """The most memory that a server has used since `before`, in bytes beyond that. Calling it has requests of another
    client served, which are ordered behind what the server has already received."""

    def __init__(self, server):
        self.server, self.before, self.growth = server, memory_now(server), 0

    def __call__(self):
        assert fetch(self.server, "/healthz", source=OTHER).status == 200
        self.growth = max(self.growth, self.server.anonymous_memory() - self.before)


def duoprism(p, q, seed=0):
    """Returns the duoprism of a p-gon and a q-gon as 4OFF; `seed` makes the text unique."""
    def vertex(i, j):
        return i % p * q + j % q

    lines = [f"# {seed}", "4OFF", f"{p * q} {p * q + p + q} {2 * p * q} {p + q}"]
    for i in range(p):
        a = 2 * math.pi * i / p
        for j in range(q):
            b = 2 * math.pi * j / q
            lines.append(f"{math.cos(a):.17g} {math.sin(a):.17g} {math.cos(b):.17g} {math.sin(b):.17g}")
    lines += [f"4 {vertex(i, j)} {vertex(i + 1, j)} {vertex(i + 1, j + 1)} {vertex(i, j + 1)}" for i in range(p) for j in range(q)]
    lines += [f"{q} " + " ".join(str(vertex(i, j)) for j in range(q)) for i in range(p)]
    lines += [f"{p} " + " ".join(str(vertex(i, j)) for i in range(p)) for j in range(q)]
    squares = p * q
    lines += [f"{q + 2} {squares + i} {squares + (i + 1) % p} " + " ".join(str(vertex(i, j)) for j in range(q)) for i in range(p)]
    lines += [f"{p + 2} {squares + p + j} {squares + p + (j + 1) % q} " + " ".join(str(vertex(i, j)) for i in range(p)) for j in range(q)]
    return "\n".join(lines) + "\n"


# --- Downloads that clients do not read use bounded memory

@contextlib.contextmanager
def unread_downloads(server, count, target=FILE, source=ATTACKER):
    """Yields `count` connections that have requested a file and do not read; their receive buffers are small."""
    downloads = [Socket(server, source, receive_buffer=4096) for _ in range(count)]
    try:
        for raw in downloads:
            raw.send(request(target))
        yield downloads
    finally:
        for raw in downloads:
            raw.socket.close()


def test_sixteen_slow_downloads_of_a_file_use_bounded_memory():
    with Server() as server:
        size = len(fetch(server, FILE).body)
        assert size > LEAST_FILE_SIZE
        peak = Peak(server)
        with unread_downloads(server, 16) as downloads:
            def all_have_begun():
                for raw in downloads:
                    if len(raw.buffer) < size // 2 and select.select([raw.socket], [], [], 0)[0]:
                        raw.receive()
                peak()
                return all(raw.buffer for raw in downloads)

            wait_until(all_have_begun, "the begin of all downloads")
            for _ in range(50):
                peak()
            statuses = {bytes(raw.buffer[9:12]) for raw in downloads}
            assert statuses <= {b"200"} | {str(status).encode() for status in REFUSED} and b"200" in statuses
            assert peak.growth < 5 * size, f"{peak.growth / size:.1f} times the file's size is held for 16 readers"
            assert len(fetch(server, FILE, source=OTHER).body) == size, "a client that reads gets the file"
        server.wait_for(lambda: server.metric("oval4d_connections") <= 1)
        wait_for_memory_below(server, peak.before + size + NOISE)


def test_memory_per_client_and_in_total_is_limited():
    """A client that requests many files gets no more than its share of the memory."""
    with Server("--max-client-bytes", "48M", "--max-bytes", "128M") as server:
        size = len(fetch(server, FILE).body)
        assert 12 << 20 < size < 40 << 20
        peak = Peak(server)
        with unread_downloads(server, 24):
            for _ in range(3):
                answer = fetch(server, FILE, source=OTHER)
                assert answer.status == 200 and len(answer.body) == size
                peak()
            assert peak.growth < (128 << 20) + NOISE


def test_a_file_beyond_the_memory_limit_is_refused_before_its_export():
    with Server("--max-client-bytes", "1M", "--max-bytes", "2M") as server:
        start = server.metric("oval4d_file_seconds_count")
        answer = fetch(server, FILE, source=ATTACKER)
        assert answer.status in REFUSED and b"error" in answer.body
        assert server.metric("oval4d_file_seconds_count") == start
        assert fetch(server, "/api/v1/file.csv", source=ATTACKER).status == 200
        with WebSocket(server, source=ATTACKER) as peer:
            peer.request(type="hello")
            peer.request(type="command", line="polytope 24-cell")
            answer = peer.request(type="get", what="file", format="stl", of="oval", body="frame")
            assert answer["type"] == "error" and answer["code"] in ("too_many", "too_large")
            assert peer.request(type="key", key="y")["type"] == "done"


@pytest.mark.parametrize("transport", ["http", "websocket"])
def test_too_slow_readers_are_disconnected(transport):
    with Server("--min-read-rate", "4M", "--write-timeout", 0.5) as server:
        if transport == "http":
            raw = Socket(server, ATTACKER, receive_buffer=4096)
            raw.send(request(FILE))
        else:
            raw = WebSocket(server, source=ATTACKER, receive_buffer=4096)
            raw.request(type="hello")
            raw.request(type="command", line="polytope 24-cell")
            raw.send_message(type="get", what="file", format="stl", of="oval", body="frame")
        got = len(raw.buffer)
        with contextlib.suppress(ConnectionError):
            while data := raw.socket.recv(2048):
                got += len(data)
                time.sleep(0.02)  # makes at most 100 KiB per second
        raw.socket.close()
        assert got < LEAST_FILE_SIZE, "the slow reader got the whole file"


# --- Loaded objects use bounded memory

def test_repeated_loads_use_bounded_memory():
    with Server("--max-undo-bytes", "4M") as server, WebSocket(server) as peer:
        assert peer.request(type="hello")["type"] == "welcome"
        text = duoprism(100, 100)
        assert len(text) > 1_000_000
        for seed in range(4):
            assert peer.request(type="load", name="mine", format="off", data=duoprism(100, 100, seed))["type"] == "done"
        before = memory_now(server)
        for seed in range(4, 28):
            assert peer.request(type="load", name="mine", format="off", data=text.replace("# 0", f"# {seed}"))["type"] == "done"
        wait_for_memory_below(server, before + (4 << 20) + 8 * len(text))
        state = peer.request(type="get", what="state")
        assert state["polytope"]["name"] == "mine" and state["polytope"]["vertices"] == 10_000
        assert peer.request(type="key", key="y")["type"] == "done"
        assert peer.request(type="undo")["type"] == "done", "small steps are still kept"


def test_undo_steps_count_toward_the_client_limit():
    """After many small steps, the client's byte limit removes the oldest undo steps, and nothing else."""
    with Server("--max-client-bytes", "128k") as server, WebSocket(server) as peer:
        peer.request(type="hello")
        for number in range(1000):
            assert peer.request(type="rotate", planes=["xw"], angles=[0.001 * (1 + number)])["type"] == "done"
        assert server.metric("oval4d_client_bytes") <= 128 << 10
        steps = 0
        while (answer := peer.request(type="undo"))["type"] == "done":
            steps += 1
        assert answer["code"] == "nothing_to_undo" and 50 < steps < 999
        assert peer.request(type="key", key="y")["type"] == "done"


def test_undo_keeps_the_newest_steps():
    """The limit on the bytes of polytopes removes the oldest undo steps; undo ends at the oldest remaining step."""
    with Server("--max-undo-bytes", "512k") as server, WebSocket(server) as peer:
        peer.request(type="hello")
        for number in range(12):
            text = duoprism(10 + number, 20)
            assert peer.request(type="load", name="mine", format="off", data=text)["type"] == "done"
        seen = []
        while (answer := peer.request(type="undo"))["type"] == "done":
            seen.append(peer.request(type="get", what="state")["polytope"]["vertices"])
        assert answer["code"] == "nothing_to_undo"
        assert seen == [20 * (20 - number) for number in range(len(seen))] and 1 <= len(seen) < 11


# --- Messages use bounded memory

def test_incomplete_messages_before_hello_use_bounded_memory():
    with Server("--max-client-connections", 1000) as server:
        count, peak = 64, Peak(server)
        peers = [WebSocket(server, source=ATTACKER) for _ in range(count)]
        try:
            part = frame(TEXT, b'{"type":"load","data":"' + b"x" * (1 << 20), announced_length=7 << 20)
            send_as_far_as_read(peers, part, peak)
            assert peak.growth < count * (256 << 10) + NOISE
        finally:
            for peer in peers:
                peer.socket.close()


def test_incomplete_messages_use_bounded_memory():
    """Each connection may send a load of 8 MiB; all together exceed the memory limit."""
    with Server("--max-client-connections", 1000, "--max-client-sessions", 1000, "--max-new-sessions", 1000,
                "--max-client-bytes", "32M", "--max-bytes", "64M", "--max-byte-rate", "1G") as server:
        count = 48
        peers = [WebSocket(server, source=ATTACKER) for _ in range(count)]
        try:
            for peer in peers:
                assert peer.request(type="hello")["type"] == "welcome"
            peak = Peak(server)
            part = frame(TEXT, b'{"type":"load","data":"' + b"x" * (6 << 20), announced_length=8 << 20)
            send_as_far_as_read(peers, part, peak)
            assert peak.growth < (64 << 20) + NOISE
            with WebSocket(server, source=OTHER) as other:
                other.request(type="hello")
                assert other.request(type="load", name="x", format="off", data=duoprism(30, 30))["type"] == "done"
        finally:
            for peer in peers:
                peer.socket.close()
        server.wait_for(lambda: server.metric("oval4d_websockets") == 0)
        wait_for_memory_below(server, peak.before + NOISE)


def test_unread_answers_use_bounded_memory():
    unsent = 64 << 10
    with Server("--max-unsent", unsent, "--min-read-rate", 1, "--max-new-sessions", 1000) as server:
        count = 30
        peers = [WebSocket(server, source=ATTACKER, receive_buffer=4096) for _ in range(count)]
        try:
            for peer in peers:
                peer.request(type="hello")
                peer.request(type="command", line="polytope 24-cell")
            answer = len(str(peers[0].request(type="get", what="slices")))
            peak = Peak(server)
            flood = frame(TEXT, b'{"type":"get","what":"slices"}') * 10_000
            send_as_far_as_read(peers, flood, peak)
            # In addition to the queued answers, a few pictures may be on their way.
            assert peak.growth < count * (unsent + 4 * answer + (256 << 10)) + NOISE
            with WebSocket(server, source=OTHER) as other:
                other.request(type="hello")
                assert other.request(type="get", what="slices")["type"] == "slices"
        finally:
            for peer in peers:
                peer.socket.close()


# --- Drawing processes that are killed or that draw much leak no memory

def test_repeatedly_killed_drawing_processes_leak_nothing():
    picture = "/api/v1/frame.png?polytope=24-cell&width=320&height=240"
    with Server() as server:
        first = fetch(server, picture).body
        for _ in range(3):  # until the numbers of processes and open files are stable
            server.signal_drawing_processes(signal.SIGKILL)
            assert fetch(server, picture).body == first
        before, files, count = memory_now(server), len(server.open_files()), len(server.drawing_processes())
        for _ in range(20):
            server.signal_drawing_processes(signal.SIGKILL)
            assert fetch(server, picture).body == first
        wait_until(lambda: len(server.drawing_processes()) <= count, "as few processes as before")
        wait_until(lambda: len(server.open_files()) <= files + 2, "as few descriptors as before")
        wait_for_memory_below(server, before + NOISE)


def test_changing_picture_sizes_leak_nothing():
    with Server("--workers", 1) as server:
        def draw(rounds):
            for _ in range(rounds):
                for width, height in ((1280, 720), (960, 540)):
                    server.get(f"/api/v1/frame.png?width={width}&height={height}")
            return {pid: server.anonymous_memory(pid) for pid in server.drawing_processes()}

        before, after = draw(4), draw(60)
        assert before.keys() == after.keys(), "no process was replaced"
        # A process in reserve may draw for the first time between the measurements, and then needs memory. The memory
        # of a process does not grow with the number of pictures, here 120 pictures of 2 or 4 MB.
        growth = sum(after.values()) - sum(before.values())
        assert growth < 2 * NOISE + 120 * (960 * 540 * 4) // 4, (before, after)
