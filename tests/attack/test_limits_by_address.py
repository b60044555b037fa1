"""Limits per client address: while one address uses all it can get, another one is served at once.

Loopback has many addresses: the attacker connects from 127.0.0.2, the other client from 127.0.0.3.
"""

import concurrent.futures
import contextlib
import resource
import time

import pytest
from harness import DEADLINE, SLOW, Server, run
from raw import CLOSE, PING, TEXT, Ended, Socket, WebSocket, ask, close_frame, frame, handshake, request

ATTACKER, OTHER = "127.0.0.2", "127.0.0.3"
HELLO = frame(TEXT, b'{"type":"hello","id":1}')
FULL = (429, 503)


@pytest.fixture(autouse=True, scope="module")
def many_files():
    """Raises this process's limit on open files, since each connection needs one."""
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (limits[1], limits[1]))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, limits)


def shook_hands(server, count, source, *fields):
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
                    answer = raw.answer()
                    (opened if answer.status == 101 else refused).append(raw if answer.status == 101 else answer.status)
                except Ended:
                    refused.append(None)
        stack.pop_all()
    return opened, refused


def let_go(sockets):
    for raw in sockets:
        raw.socket.close()


class Visitor:
    """Another client, which uses every service of the server."""

    def __init__(self, server, source=OTHER):
        self.server, self.source = server, source

    def is_served(self):
        assert ask(self.server, "/", source=self.source).status == 200
        assert ask(self.server, "/api/v1/frame.png?width=64&height=64", source=self.source).status == 200
        with WebSocket(self.server, source=self.source) as peer:
            assert peer.ask(type="hello")["type"] == "welcome"
            assert peer.ask(type="key", key="y")["type"] == "done"


def opened_session(server, source, *fields):
    """Opens a session and leaves it; returns "welcome" or an error code, None if the connection was ended."""
    try:
        with WebSocket(server, "/ws", *fields, source=source) as peer:
            answer = peer.ask(type="hello")
            return answer.get("code", answer["type"])
    except Ended:
        return None


# --- Default limits

def test_ten_thousand_sessions_by_hello_and_close():
    with Server() as server:
        visitor, welcomed = Visitor(server), 0
        for _ in range(50):
            opened, _ = shook_hands(server, 200, ATTACKER)
            for raw in opened:
                raw.try_send(HELLO + close_frame(1000))
            for raw in opened:
                welcomed += b'"welcome"' in raw.ends()
            let_go(opened)
        assert welcomed < 5000, "one address may have most of all sessions"
        visitor.is_served()
        assert server.metric("oval4d_sessions") < 5000


def test_four_thousand_connections_without_a_hello():
    with Server() as server:
        opened, refused = shook_hands(server, 4200, ATTACKER)
        try:
            assert set(refused) <= {*FULL, None}
            Visitor(server).is_served()
            assert server.metric("oval4d_connections") < 4000, "the oldest have given way"
        finally:
            let_go(opened)


def test_four_thousand_idle_connections():
    with Server() as server:
        idle = []
        try:
            for _ in range(4200):
                idle.append(Socket(server, ATTACKER))
            # Connections are processed in order, so all earlier ones have been processed when this one is served.
            Visitor(server).is_served()
            Visitor(server).is_served()
        finally:
            let_go(idle)


def test_connections_that_come_and_go_leave_nothing_behind():
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
        let_go(held)
        server.wait_for(lambda: server.metric("oval4d_connections") <= 1)
        Visitor(server, ATTACKER).is_served()


# --- Each limit on its own

def in_session(server, *fields):
    """Returns a connection that has said hello, and is therefore not replaced by a new one."""
    peer = WebSocket(server, "/ws", *fields, source=ATTACKER)
    assert peer.ask(type="hello")["type"] == "welcome"
    return peer


def test_an_idle_connection_gives_way_to_a_new_one_of_its_client():
    with Server("--max-client-connections", 3) as server:
        used = in_session(server)
        idle, _ = shook_hands(server, 2, ATTACKER)
        assert ask(server, "/", source=ATTACKER).status == 200
        assert idle[0].ends() == b"", "the one that has been idle for longest"
        assert used.ask(type="key", key="y")["type"] == "done"
        used.socket.close()
        let_go(idle)


def test_connections_of_one_client():
    with Server("--max-client-connections", 5) as server:
        held = [in_session(server) for _ in range(5)]
        assert ask(server, "/", source=ATTACKER).status in FULL
        _, refused = shook_hands(server, 3, ATTACKER)
        assert len(refused) == 3 and set(refused) <= set(FULL)
        Visitor(server).is_served()
        let_go(held[:1])
        server.wait_for(lambda: ask(server, "/", source=ATTACKER).status == 200)
        let_go(held)


def test_sessions_of_one_client():
    with Server("--max-client-sessions", 4, "--max-new-sessions", 1000) as server:
        held = [WebSocket(server, source=ATTACKER) for _ in range(4)]
        for peer in held:
            assert peer.ask(type="hello")["type"] == "welcome"
            assert peer.ask(type="key", key="y")["type"] == "done"
        assert opened_session(server, ATTACKER) == "too_many"
        Visitor(server).is_served()
        # A session counts for the address that opened it, whichever addresses join it.
        assert held[0].ask(type="key", key="y")["type"] == "done"
        let_go(held)


def test_sessions_that_a_client_left_count_too():
    """Otherwise a client could open any number, one after the other. Unchanged sessions may be replaced by new ones."""
    with Server("--max-client-sessions", 4, "--max-new-sessions", 1000) as server:
        for _ in range(4):
            with WebSocket(server, source=ATTACKER) as peer:
                peer.ask(type="hello")
                peer.ask(type="key", key="y")
        assert opened_session(server, ATTACKER) == "too_many"
        assert server.metric("oval4d_sessions") <= 4
        Visitor(server).is_served()


def test_sessions_expire_for_their_client():
    with Server("--max-client-sessions", 2, "--max-new-sessions", 1000, "--session-expiry", 0.5) as server:
        for _ in range(2):
            with WebSocket(server, source=ATTACKER) as peer:
                peer.ask(type="hello")
                peer.ask(type="key", key="y")
        server.wait_for(lambda: opened_session(server, ATTACKER) == "welcome")


def test_new_sessions_in_a_minute():
    with Server("--max-new-sessions", 6) as server:
        answers = [opened_session(server, ATTACKER) for _ in range(20)]
        assert answers[:6] == ["welcome"] * 6
        assert set(answers[8:]) == {"too_many"}
        Visitor(server).is_served()


def test_joining_a_session_is_not_opening_one():
    with Server("--max-new-sessions", 2, "--max-client-sessions", 2) as server:
        with WebSocket(server, source=ATTACKER) as peer:
            welcome = peer.ask(type="hello")
        for _ in range(20):
            with WebSocket(server, f"/ws/{welcome['session']}", source=ATTACKER) as peer:
                assert peer.ask(type="hello", token=welcome["token"])["type"] == "welcome"
                assert peer.ask(type="hello")["type"] == "welcome"


def test_a_hello_in_time():
    wait = 1 * SLOW
    # The last one is sent only once, the others repeatedly.
    sent = [b"", frame(PING, b"x"), frame(TEXT, b'{"type":"undo"}'), HELLO[:10]]
    with Server("--hello-timeout", wait) as server, concurrent.futures.ThreadPoolExecutor(len(sent)) as pool:
        start = time.monotonic()
        greeting, *peers = (WebSocket(server) for _ in range(1 + len(sent)))
        assert greeting.ask(type="hello")["type"] == "welcome"
        ends = [pool.submit(peer.end_time) for peer in peers]
        peers[-1].send(sent.pop())
        while not all(end.done() for end in ends) and time.monotonic() < start + wait + DEADLINE:
            for peer, data in zip(peers, sent):
                peer.try_send(data)
            time.sleep(0.1)
        times = [end.result() - start for end in ends]
        assert wait <= min(times) and max(times) < wait + DEADLINE / 4
        assert greeting.ask(type="key", key="y")["type"] == "done"
        let_go([greeting, *peers])


def test_a_close_says_why_when_no_hello_came():
    with Server("--hello-timeout", 0.3) as server, WebSocket(server) as peer:
        opcode, payload = peer.next_message()
        while opcode != CLOSE:
            opcode, payload = peer.next_message()
        assert int.from_bytes(payload[:2], "big") in (1002, 1008, 4408) and payload[2:]


def test_sessions_that_were_never_touched_are_given_up_first():
    with Server("--max-sessions", 20, "--max-client-sessions", 1000, "--max-new-sessions", 1000) as server:
        with WebSocket(server, source=OTHER) as peer:
            touched = peer.ask(type="hello")
            assert peer.ask(type="key", key="y")["type"] == "done"
        watched = WebSocket(server, source=OTHER)
        watched.ask(type="hello")
        answers = [opened_session(server, ATTACKER) for _ in range(100)]
        assert answers == ["welcome"] * 100, "sessions that nobody has are kept, and new ones refused"
        server.wait_for(lambda: server.metric("oval4d_sessions") <= 20)
        assert watched.ask(type="key", key="y")["type"] == "done"
        with WebSocket(server, f"/ws/{touched['session']}", source=OTHER) as peer:
            assert peer.ask(type="hello", token=touched["token"])["type"] == "welcome"
            assert peer.ask(type="get", what="state")["revision"] == 1
        let_go([watched])


def test_sessions_that_were_touched_are_kept():
    with Server("--max-sessions", 5, "--max-client-sessions", 1000, "--max-new-sessions", 1000) as server:
        kept = []
        for _ in range(5):
            with WebSocket(server, source=OTHER) as peer:
                kept.append(peer.ask(type="hello"))
                peer.ask(type="key", key="y")
        assert opened_session(server, ATTACKER) == "too_many"
        for welcome in kept:
            with WebSocket(server, f"/ws/{welcome['session']}", source=OTHER) as peer:
                assert peer.ask(type="hello", token=welcome["token"])["type"] == "welcome"


# --- Who a client is: X-Forwarded-For

def sessions_by(server, source, *forwarded):
    """Opens a session with each value of X-Forwarded-For; returns the results of opened_session."""
    return [opened_session(server, source, *([f"X-Forwarded-For: {text}"] if text else [])) for text in forwarded]


SMALL = ("--max-new-sessions", 3, "--max-client-sessions", 1000)


def test_who_forwards_is_not_believed_unless_trusted():
    with Server(*SMALL) as server:
        answers = sessions_by(server, ATTACKER, *(f"10.0.0.{number}" for number in range(20)))
        assert answers[:3] == ["welcome"] * 3 and set(answers[4:]) == {"too_many"}
        Visitor(server).is_served()
    with Server(*SMALL, "--trusted-proxy", "127.0.0.9") as server:
        assert sessions_by(server, ATTACKER, *(f"10.0.0.{number}" for number in range(20)))[-1] == "too_many"


@pytest.mark.parametrize("trusted", ["127.0.0.2", "127.0.0.2/32", "127.0.0.0/30", "::1,127.0.0.2", "10.1.0.0/16,127.0.0.2"])
def test_a_trusted_proxy_says_who_calls(trusted):
    words = [word for one in trusted.split(",") for word in ("--trusted-proxy", one)]
    with Server(*SMALL, *words) as server:
        assert sessions_by(server, ATTACKER, *(f"192.0.2.{number}" for number in range(20))) == ["welcome"] * 20
        answers = sessions_by(server, ATTACKER, *["198.51.100.7"] * 10)
        assert answers[:3] == ["welcome"] * 3 and set(answers[4:]) == {"too_many"}
        assert sessions_by(server, ATTACKER, "2001:db8::1", "198.51.100.8") == ["welcome"] * 2


def test_what_a_client_puts_before_the_proxy_s_word_is_not_believed():
    """A proxy appends the address that it sees; the client itself may have sent whatever precedes it."""
    with Server(*SMALL, "--trusted-proxy", "127.0.0.2", "--trusted-proxy", "203.0.113.0/24") as server:
        answers = sessions_by(server, ATTACKER, *(f"10.0.0.{number}, 198.51.100.7" for number in range(10)))
        assert set(answers[4:]) == {"too_many"}
        # With a chain of proxies, the last address that is not a trusted proxy counts.
        answers = sessions_by(server, ATTACKER, *(f"10.0.1.{number}, 198.51.100.9, 203.0.113.{number}" for number in range(10)))
        assert answers[:3] == ["welcome"] * 3 and set(answers[4:]) == {"too_many"}


def test_two_fields_are_one_list():
    with Server(*SMALL, "--trusted-proxy", "127.0.0.2") as server:
        answers = [opened_session(server, ATTACKER, f"X-Forwarded-For: 10.0.0.{number}", "X-Forwarded-For: 198.51.100.7")
                   for number in range(10)]
        assert set(answers[4:]) == {"too_many"}


@pytest.mark.parametrize("text", ["nonsense", "", ",", "1.2.3", "999.1.1.1", "10.0.0.1:80x", "unknown", "_hidden", "[::1", "::::",
                                  "10.0.0.1, nonsense", "x" * 4000, "10.0.0.1 10.0.0.2", "-1", "*"])
def test_a_proxy_that_talks_nonsense_is_one_client(text):
    with Server(*SMALL, "--trusted-proxy", "127.0.0.2") as server:
        answers = sessions_by(server, ATTACKER, *[text] * 10)
        assert set(answers[4:]) <= {"too_many", None}
        Visitor(server).is_served()


@pytest.mark.parametrize("text", ["nonsense", "127.0.0.1/33", "127.0.0.1/-1", "127.0.0.1/x", "::1/129", "127.0.0.1/", "/8", "127.0.0",
                                  "localhost", "127.0.0.1/8/8"])
def test_a_trusted_proxy_that_is_no_address(text):
    done = run("--trusted-proxy", text, "--port", "0")
    said = (done.stdout + done.stderr).decode()
    assert done.returncode != 0 and "trusted-proxy" in said and "not expected" not in said


def test_connections_behind_a_proxy_are_their_clients():
    with Server("--max-client-connections", 4, "--trusted-proxy", "127.0.0.2") as server:
        held = [in_session(server, f"X-Forwarded-For: 192.0.2.{number % 3}") for number in range(12)]
        opened, refused = shook_hands(server, 4, ATTACKER, "X-Forwarded-For: 192.0.2.1")
        assert not opened and set(refused) <= set(FULL)
        let_go(held + opened)


def test_the_limits_are_told_from_the_environment_too():
    with Server(OVAL4D_MAX_NEW_SESSIONS="2", OVAL4D_TRUSTED_PROXY="127.0.0.2") as server:
        assert sessions_by(server, ATTACKER, *["198.51.100.7"] * 6)[-1] == "too_many"
        assert sessions_by(server, ATTACKER, "198.51.100.8") == ["welcome"]


# --- Messages: bytes as well as numbers

def test_a_message_that_is_no_load_has_a_limit_of_its_own():
    with Server("--max-request-bytes", "2k") as server, WebSocket(server) as peer:
        assert peer.ask(type="hello")["type"] == "welcome"
        text = b'{"type":"get","what":"state","id":77}'
        peer.send(frame(TEXT, text.ljust(2048)))
        assert peer.answer_to(77)["type"] == "state"
        assert peer.ask(type="load", name="x", format="off", data="#" * 10_000)["code"] == "bad_polytope"
        peer.try_send(frame(TEXT, text.ljust(2049)))
        assert peer.refuses_its_size()


def test_bytes_a_second_of_one_connection():
    """Beyond the limit, messages are refused or not read."""
    rate, message = 256 << 10, 256 << 10
    with Server("--max-byte-rate", rate, "--max-message", message) as server:
        with WebSocket(server, source=ATTACKER) as peer, WebSocket(server, source=OTHER) as other:
            peer.ask(type="hello")
            other.ask(type="hello")
            start, taken = time.monotonic(), 0
            peer.socket.settimeout(1)
            with contextlib.suppress(Ended, ConnectionError, TimeoutError):
                for _ in range(60):
                    taken += 30_000 if peer.ask(type="get", what="state", x="x" * 30_000)["code"] == "bad_message" else 0
            assert 0 < taken <= 2 * message + rate * (5 + time.monotonic() - start)
            assert other.ask(type="key", key="y")["type"] == "done"
