"""Limits per client address: while one address uses as much as it can, another address is served at once.

Loopback has many addresses: the attacker connects from 127.0.0.2, the other client from 127.0.0.3.
"""

import contextlib
import resource
import time

import pytest
from harness import DEADLINE, Server, run_oval4d
from raw import CLOSE, TEXT, ConnectionEnded, Socket, WebSocket, fetch, close_frame, frame, handshake, request

ATTACKER, OTHER = "127.0.0.2", "127.0.0.3"
HELLO = frame(TEXT, b'{"type":"hello","id":1}')
FULL = (429, 503)


@pytest.fixture(autouse=True, scope="module")
def raise_open_file_limit():
    """Raises this process's limit on open files, since each connection needs one."""
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (limits[1], limits[1]))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, limits)


def open_websockets(server, count, source, *fields):
    """Requests `count` WebSockets; returns the open ones, and the HTTP statuses of the others."""
    opened, refused = [], []
    with contextlib.ExitStack() as stack:
        while count > 0:
            batch = []
            for _ in range(min(count, 100)):
                try:
                    raw = stack.enter_context(Socket(server, source))
                    raw.send(handshake("/ws", *fields))
                    batch.append(raw)
                except ConnectionError:
                    refused.append(None)
            count -= 100
            for raw in batch:
                try:
                    answer = raw.read_response()
                    (opened if answer.status == 101 else refused).append(raw if answer.status == 101 else answer.status)
                except ConnectionEnded:
                    refused.append(None)
        stack.pop_all()
    return opened, refused


def close_all(sockets):
    for raw in sockets:
        raw.socket.close()


class Bystander:
    """Another client, which uses every service of the server."""

    def __init__(self, server, source=OTHER):
        self.server, self.source = server, source

    def assert_served(self):
        assert fetch(self.server, "/", source=self.source).status == 200
        assert fetch(self.server, "/api/v1/frame.png?width=64&height=64", source=self.source).status == 200
        with WebSocket(self.server, source=self.source) as peer:
            assert peer.request(type="hello")["type"] == "welcome"
            assert peer.request(type="key", key="y")["type"] == "done"


def try_open_session(server, source, *fields):
    """Opens a session and leaves it; returns "welcome" or an error code, None if the connection was ended."""
    try:
        with WebSocket(server, "/ws", *fields, source=source) as peer:
            answer = peer.request(type="hello")
            return answer.get("code", answer["type"])
    except ConnectionEnded:
        return None


def assert_limited(answers, per_minute, start, refusals=("too_many",)):
    """Asserts that as many sessions were opened as the limit allows from the time `start` on, and the others refused."""
    assert answers[:per_minute] == ["welcome"] * per_minute
    allowed = per_minute * (1 + (time.monotonic() - start) / 60)
    assert answers.count("welcome") <= allowed and set(answers) <= {"welcome", *refusals}, answers


# --- The default limits leave room for other addresses

def test_ten_thousand_sessions_of_one_address_leave_room_for_others():
    with Server() as server:
        bystander, welcomed, start = Bystander(server), 0, time.monotonic()
        for _ in range(50):
            opened, _ = open_websockets(server, 200, ATTACKER)
            for raw in opened:
                raw.try_send(HELLO + close_frame(1000))
            for raw in opened:
                welcomed += b'"welcome"' in raw.read_until_end()
            close_all(opened)
        allowed = 2000 * (1 + (time.monotonic() - start) / 60)
        assert welcomed <= allowed, "one address opened most of the possible sessions"
        bystander.assert_served()
        assert server.metric("oval4d_sessions") < 5000


def test_four_thousand_websockets_without_hello_leave_room_for_others():
    with Server() as server:
        opened, refused = open_websockets(server, 4200, ATTACKER)
        try:
            assert set(refused) <= {*FULL, None}
            Bystander(server).assert_served()
            assert server.metric("oval4d_connections") < 4000, "old connections without hello must be replaced"
        finally:
            close_all(opened)


def test_four_thousand_idle_connections_leave_room_for_others():
    with Server() as server:
        idle = []
        try:
            for _ in range(4200):
                idle.append(Socket(server, ATTACKER))
            # Connections are processed in order. When the server serves this client, it has processed all earlier
            # connections.
            Bystander(server).assert_served()
            Bystander(server).assert_served()
        finally:
            close_all(idle)


def test_ended_connections_no_longer_count_toward_the_limit():
    """A connection no longer counts toward the limit once it has ended, in whichever way."""
    with Server("--max-client-connections", 8) as server:
        for number in range(40):
            raw = Socket(server, ATTACKER)
            if number % 4 == 1:
                raw.try_send(b"nonsense\r\n\r\n")
            if number % 4 == 2:
                raw.try_send(handshake() + HELLO)
            if number % 4 == 3:
                raw.try_send(request("/"))
            raw.reset()
        server.wait_for(lambda: server.metric("oval4d_connections") <= 1)
        held = [WebSocket(server, source=ATTACKER) for _ in range(8)]
        close_all(held)
        server.wait_for(lambda: server.metric("oval4d_connections") <= 1)
        Bystander(server, ATTACKER).assert_served()


# --- Each limit by itself

def websocket_in_session(server, *fields):
    """Returns a WebSocket that has opened a session, and is therefore not replaced by a new connection."""
    peer = WebSocket(server, "/ws", *fields, source=ATTACKER)
    assert peer.request(type="hello")["type"] == "welcome"
    return peer


def test_a_new_connection_replaces_the_longest_idle_connection_of_its_address():
    with Server("--max-client-connections", 3) as server:
        used = websocket_in_session(server)
        idle, _ = open_websockets(server, 2, ATTACKER)
        assert fetch(server, "/", source=ATTACKER).status == 200
        assert idle[0].read_until_end() == b"", "the longest idle connection must be replaced"
        assert used.request(type="key", key="y")["type"] == "done"
        used.socket.close()
        close_all(idle)


def test_connections_per_address_are_limited():
    with Server("--max-client-connections", 5) as server:
        held = [websocket_in_session(server) for _ in range(5)]
        assert fetch(server, "/", source=ATTACKER).status in FULL
        _, refused = open_websockets(server, 3, ATTACKER)
        # The server may close a connection that has not sent its request yet without an answer, to make room for the
        # next.
        assert len(refused) == 3 and set(refused) <= {*FULL, None}
        Bystander(server).assert_served()
        close_all(held[:1])
        server.wait_for(lambda: fetch(server, "/", source=ATTACKER).status == 200)
        close_all(held)


def test_sessions_per_address_are_limited():
    with Server("--max-client-sessions", 4, "--max-new-sessions", 1000) as server:
        held = [WebSocket(server, source=ATTACKER) for _ in range(4)]
        for peer in held:
            assert peer.request(type="hello")["type"] == "welcome"
            assert peer.request(type="key", key="y")["type"] == "done"
        assert try_open_session(server, ATTACKER) == "too_many"
        Bystander(server).assert_served()
        # A session counts for the address that opened it, also if other addresses join it.
        assert held[0].request(type="key", key="y")["type"] == "done"
        close_all(held)


def test_abandoned_sessions_count_toward_the_limit():
    """Otherwise a client could open any number, one after the other. Unchanged sessions may be replaced by new ones."""
    with Server("--max-client-sessions", 4, "--max-new-sessions", 1000) as server:
        for _ in range(4):
            with WebSocket(server, source=ATTACKER) as peer:
                peer.request(type="hello")
                peer.request(type="key", key="y")
        assert try_open_session(server, ATTACKER) == "too_many"
        assert server.metric("oval4d_sessions") <= 4
        Bystander(server).assert_served()


def test_new_sessions_per_minute_are_limited():
    with Server("--max-new-sessions", 6) as server:
        start = time.monotonic()
        assert_limited([try_open_session(server, ATTACKER) for _ in range(20)], 6, start)
        Bystander(server).assert_served()


def test_joining_a_session_does_not_count_as_a_new_session():
    with Server("--max-new-sessions", 2, "--max-client-sessions", 2) as server:
        with WebSocket(server, source=ATTACKER) as peer:
            welcome = peer.request(type="hello")
        for _ in range(20):
            with WebSocket(server, f"/ws/{welcome['session']}", source=ATTACKER) as peer:
                assert peer.request(type="hello", token=welcome["token"])["type"] == "welcome"
                assert peer.request(type="hello")["type"] == "welcome"


def websocket_before_timeout(server):
    """Returns a WebSocket. The time limit for the first hello is that for a handshake, too: one that misses it is
    repeated."""
    limit = time.monotonic() + DEADLINE
    while True:
        with contextlib.suppress(ConnectionEnded):
            return WebSocket(server)
        assert time.monotonic() < limit, "no handshake succeeds"


def test_the_close_after_the_hello_timeout_states_a_reason():
    with Server("--hello-timeout", 1) as server, websocket_before_timeout(server) as peer:
        opcode, payload = peer.next_message()
        while opcode != CLOSE:
            opcode, payload = peer.next_message()
        assert int.from_bytes(payload[:2], "big") in (1002, 1008, 4408) and payload[2:]


def test_unchanged_sessions_are_evicted_first():
    with Server("--max-sessions", 20, "--max-client-sessions", 1000, "--max-new-sessions", 1000) as server:
        with WebSocket(server, source=OTHER) as peer:
            touched = peer.request(type="hello")
            assert peer.request(type="key", key="y")["type"] == "done"
        watched = WebSocket(server, source=OTHER)
        watched.request(type="hello")
        answers = [try_open_session(server, ATTACKER) for _ in range(100)]
        assert answers == ["welcome"] * 100, "sessions without clients are kept, and new sessions refused"
        server.wait_for(lambda: server.metric("oval4d_sessions") <= 20)
        assert watched.request(type="key", key="y")["type"] == "done"
        with WebSocket(server, f"/ws/{touched['session']}", source=OTHER) as peer:
            assert peer.request(type="hello", token=touched["token"])["type"] == "welcome"
            assert peer.request(type="get", what="state")["revision"] == 1
        close_all([watched])


def test_changed_sessions_are_not_evicted():
    with Server("--max-sessions", 5, "--max-client-sessions", 1000, "--max-new-sessions", 1000) as server:
        kept = []
        for _ in range(5):
            with WebSocket(server, source=OTHER) as peer:
                kept.append(peer.request(type="hello"))
                peer.request(type="key", key="y")
        assert try_open_session(server, ATTACKER) == "too_many"
        for welcome in kept:
            with WebSocket(server, f"/ws/{welcome['session']}", source=OTHER) as peer:
                assert peer.request(type="hello", token=welcome["token"])["type"] == "welcome"


# --- X-Forwarded-For determines which address a client behind a proxy has

def open_sessions_forwarded_for(server, source, *forwarded):
    """Opens a session with each value of X-Forwarded-For; returns the results of opened_session."""
    return [try_open_session(server, source, *([f"X-Forwarded-For: {text}"] if text else [])) for text in forwarded]


FEW_NEW_SESSIONS = ("--max-new-sessions", 3, "--max-client-sessions", 1000)


def test_x_forwarded_for_of_an_untrusted_client_is_ignored():
    for options in ((), ("--trusted-proxy", "127.0.0.9")):
        with Server(*FEW_NEW_SESSIONS, *options) as server:
            start = time.monotonic()
            answers = open_sessions_forwarded_for(server, ATTACKER, *(f"10.0.0.{number}" for number in range(20)))
            assert_limited(answers, 3, start)
            Bystander(server).assert_served()


@pytest.mark.parametrize("trusted", ["127.0.0.2", "127.0.0.2/32", "127.0.0.0/30", "::1,127.0.0.2", "10.1.0.0/16,127.0.0.2"])
def test_x_forwarded_for_of_a_trusted_proxy_identifies_the_client(trusted):
    options = [word for address in trusted.split(",") for word in ("--trusted-proxy", address)]
    with Server(*FEW_NEW_SESSIONS, *options) as server:
        assert open_sessions_forwarded_for(server, ATTACKER, *(f"192.0.2.{number}" for number in range(20))) == ["welcome"] * 20
        start = time.monotonic()
        assert_limited(open_sessions_forwarded_for(server, ATTACKER, *["198.51.100.7"] * 10), 3, start)
        assert open_sessions_forwarded_for(server, ATTACKER, "2001:db8::1", "198.51.100.8") == ["welcome"] * 2


def test_the_last_forwarded_address_that_is_no_proxy_counts():
    """A proxy appends the address that it sees; the client itself may have sent whatever precedes it."""
    with Server(*FEW_NEW_SESSIONS, "--trusted-proxy", "127.0.0.2", "--trusted-proxy", "203.0.113.0/24") as server:
        start = time.monotonic()
        answers = open_sessions_forwarded_for(server, ATTACKER, *(f"10.0.0.{number}, 198.51.100.7" for number in range(10)))
        assert_limited(answers, 3, start)
        # If a request passes several proxies, the last address that is not a trusted proxy counts.
        start = time.monotonic()
        lists = [f"10.0.1.{number}, 198.51.100.9, 203.0.113.{number}" for number in range(10)]
        assert_limited(open_sessions_forwarded_for(server, ATTACKER, *lists), 3, start)


def test_two_x_forwarded_for_fields_are_one_list():
    with Server(*FEW_NEW_SESSIONS, "--trusted-proxy", "127.0.0.2") as server:
        start = time.monotonic()
        answers = [try_open_session(server, ATTACKER, f"X-Forwarded-For: 10.0.0.{number}", "X-Forwarded-For: 198.51.100.7")
                   for number in range(10)]
        assert_limited(answers, 3, start)


@pytest.mark.parametrize("text", ["nonsense", "", ",", "1.2.3", "999.1.1.1", "10.0.0.1:80x", "unknown", "_hidden", "[::1", "::::",
                                  "10.0.0.1, nonsense", "x" * 4000, "10.0.0.1 10.0.0.2", "-1", "*"])
def test_clients_with_an_invalid_x_forwarded_for_count_as_one_client(text):
    with Server(*FEW_NEW_SESSIONS, "--trusted-proxy", "127.0.0.2") as server:
        start = time.monotonic()
        answers = open_sessions_forwarded_for(server, ATTACKER, *[text] * 10)
        assert answers.count("welcome") <= 3 * (1 + (time.monotonic() - start) / 60)
        assert set(answers) <= {"welcome", "too_many", None}
        Bystander(server).assert_served()


@pytest.mark.parametrize("text", ["nonsense", "127.0.0.1/33", "127.0.0.1/-1", "127.0.0.1/x", "::1/129", "127.0.0.1/", "/8", "127.0.0",
                                  "localhost", "127.0.0.1/8/8"])
def test_an_invalid_trusted_proxy_option_is_refused(text):
    done = run_oval4d("--trusted-proxy", text, "--port", "0")
    output = (done.stdout + done.stderr).decode()
    assert done.returncode != 0 and "trusted-proxy" in output and "not expected" not in output


def test_connections_behind_a_proxy_count_for_the_forwarded_address():
    with Server("--max-client-connections", 4, "--trusted-proxy", "127.0.0.2") as server:
        held = [websocket_in_session(server, f"X-Forwarded-For: 192.0.2.{number % 3}") for number in range(12)]
        opened, refused = open_websockets(server, 4, ATTACKER, "X-Forwarded-For: 192.0.2.1")
        assert not opened and set(refused) <= {*FULL, None}
        close_all(held + opened)


def test_environment_variables_set_the_limits():
    with Server(OVAL4D_MAX_NEW_SESSIONS="2", OVAL4D_TRUSTED_PROXY="127.0.0.2") as server:
        start = time.monotonic()
        assert_limited(open_sessions_forwarded_for(server, ATTACKER, *["198.51.100.7"] * 6), 2, start)
        assert open_sessions_forwarded_for(server, ATTACKER, "198.51.100.8") == ["welcome"]


# --- Messages are limited by their sizes and by their number

def test_messages_other_than_load_have_their_own_size_limit():
    with Server("--max-request-bytes", "2k") as server, WebSocket(server) as peer:
        assert peer.request(type="hello")["type"] == "welcome"
        text = b'{"type":"get","what":"state","id":77}'
        peer.send(frame(TEXT, text.ljust(2048)))
        assert peer.wait_for_answer(77)["type"] == "state"
        assert peer.request(type="load", name="x", format="off", data="#" * 10_000)["code"] == "bad_polytope"
        peer.try_send(frame(TEXT, text.ljust(2049)))
        assert peer.refuses_message_as_too_large()


def test_bytes_per_second_of_a_connection_are_limited():
    """Beyond the limit, messages are refused or not read."""
    rate, message = 1 << 20, 256 << 10
    with Server("--max-byte-rate", rate, "--max-message", message) as server:
        with WebSocket(server, source=ATTACKER) as peer, WebSocket(server, source=OTHER) as other:
            peer.request(type="hello")
            other.request(type="hello")
            start, taken = time.monotonic(), 0
            with contextlib.suppress(ConnectionEnded, ConnectionError):
                for _ in range(100):
                    taken += 30_000 if peer.request(type="get", what="state", x="x" * 30_000)["code"] == "bad_message" else 0
            assert 0 < taken <= 2 * message + rate * (1 + time.monotonic() - start)
            assert other.request(type="key", key="y")["type"] == "done"
