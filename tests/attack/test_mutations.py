"""Sends thousands of randomly damaged requests of every type; other clients must not be affected.

The seed is fixed, so a failure is reproducible; OVAL4D_MUTATIONS sets the number of messages, OVAL4D_SEED the seed.
"""

import copy
import json
import os
import random

from harness import Server
from raw import CLOSE, TEXT, ConnectionEnded, WebSocket, frame

COUNT = int(os.environ.get("OVAL4D_MUTATIONS", "8000"))
SEED = int(os.environ.get("OVAL4D_SEED", "4"))
SIMPLEX = ("4OFF\n5 10 10 5\n1 1 1 -0.447214\n1 -1 -1 -0.447214\n-1 1 -1 -0.447214\n-1 -1 1 -0.447214\n0 0 0 1.788854\n3 0 1 2\n"
           "3 0 1 3\n3 0 1 4\n3 0 2 3\n3 0 2 4\n3 0 3 4\n3 1 2 3\n3 1 2 4\n3 1 3 4\n3 2 3 4\n4 0 1 3 6\n4 0 2 4 7\n4 1 2 5 8\n"
           "4 3 4 5 9\n4 6 7 8 9\n")
IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
REQUESTS = [
    {"type": "hello", "stream": "geometry", "encoding": "cbor"}, {"type": "hello", "stream": "frames", "width": 64, "height": 64},
    {"type": "hello"}, {"type": "key", "key": "y"}, {"type": "key", "key": "2", "shift": True}, {"type": "key", "key": "r", "ctrl": True},
    {"type": "rotate", "planes": ["xw", "yz"], "angles": [0.4, 1.4]}, {"type": "rotate", "planes": ["xy"], "angles": [-0.5]},
    {"type": "set", "polytope": "24-cell"}, {"type": "set", "slices": {"count": 21, "spacing": 0.12, "focus": 0}, "alpha": 0.4},
    {"type": "set", "camera": {"azimuth": 0.4, "elevation": 0.1, "zoom": 1.5}, "shown": {"faces": False, "bars": True}},
    {"type": "set", "color": "kind", "hidden": [0], "faded": []}, {"type": "set", "orientation": IDENTITY, "view": "single"},
    {"type": "set", "turning": False, "last": {"planes": ["xw", "yz"], "angles": [0.4, 1.4]}, "step": 0.1, "beta": 1},
    {"type": "load", "name": "mine", "format": "off", "data": SIMPLEX},
    {"type": "load", "name": "yours", "format": "points", "data": "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n-1 -1 -1 -1\n"},
    {"type": "undo"}, {"type": "redo"}, {"type": "reset"}, {"type": "command", "line": "rotate xw,yz pi/8 pi/sqrt(3)-pi/8"},
    {"type": "command", "line": ":set slices=11 faces=off"}, {"type": "command", "line": "hide cube"}, {"type": "command", "line": "fade 0 2"},
    {"type": "get", "what": "state"}, {"type": "get", "what": "slices"}, {"type": "get", "what": "frame", "width": 64, "height": 48},
    {"type": "get", "what": "file", "format": "off", "of": "focus", "body": "solid", "size": 60, "label": "none"},
    {"type": "get", "what": "file", "format": "csv"}, {"type": "get", "what": "keymap"}, {"type": "shown", "revision": 7},
]
UNUSUAL_VALUES = [None, True, False, 0, -1, 1, 0.5, 1e308, -1e308, 1e-320, 2**31, 2**32, 2**53, 2**63, 2**64, -2**63, 10**40, "", "\0", "x" * 5000,
                  "\ud7ff\ue000\U0010ffff", "../../etc/passwd", "%n%s%x", "'; DROP TABLE sessions;--", "NaN", "1e999", [], {}, [[]], [None] * 100,
                  {"type": "hello"}, "{5,5/2,5}", "x3o3o *b3o", "5/0,5-duoprism", "99999-gonal prism prism", "(" * 500, "1+" * 400 + "1", "-" * 900]


def value_paths(value, path=()):
    """Yields the path of each value in a message, the message itself included."""
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from value_paths(inner, (*path, key))


def set_value(message, path, value):
    for key in path[:-1]:
        message = message[key]
    message[path[-1]] = value


def value_at(message, path):
    for key in path:
        message = message[key]
    return message


DEEP = "nested deeply"  # stands for nested brackets, which are inserted into the message's text


def mutated_request(rng, may_break_json):
    """Returns a damaged message as bytes. It may be valid by chance; if `may_break_json`, it need not be JSON."""
    message = copy.deepcopy(rng.choice(REQUESTS))
    message["id"] = rng.randrange(1000)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        path = rng.choice([path for path in value_paths(message) if path])
        value, kind = value_at(message, path), rng.randrange(10)
        if kind <= 3:
            value = copy.deepcopy(rng.choice(UNUSUAL_VALUES))
        elif kind == 4:
            value = DEEP
        elif kind == 5:
            value = value_at(message, rng.choice(list(value_paths(message))))  # the value of another member
            value = copy.deepcopy(value)
        elif kind == 6 and isinstance(value, str) and value:
            cut = rng.randrange(len(value))
            value = value[:cut] + rng.choice(["", "9" * 400, "\n", "#", "-", "1e9", "é", "\0", value]) + value[cut + 1:]
        elif kind == 7 and isinstance(value, (int, float)):
            value = min(value * rng.choice([-1, 0, 1e9, 1e300, 0.1]), 1e308)
        elif kind == 8 and isinstance(path[-1], str):
            set_value(message, (*path[:-1], rng.choice(["typ", "key", "x" * 300, ""])), value)
        set_value(message, path, value)
    text = json.dumps(message, ensure_ascii=rng.random() < 0.5)
    depth = rng.choice([5, 30, 31, 32, 33, 100, 30_000])
    text = text.replace(f'"{DEEP}"', "[" * depth + "]" * depth)
    kind = rng.randrange(4) if may_break_json else rng.choice([0, 4, 4, 4, 4, 4, 4, 4])
    if kind == 0:  # repeats a member
        text = text[:-1] + "," + text[1:]
    data = bytearray(text.encode("utf-8", "surrogatepass"))
    if kind == 1:
        for _ in range(rng.choice([1, 1, 3])):
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    if kind == 2:
        del data[rng.randrange(len(data)):]
    if kind == 3:
        start = rng.randrange(len(data))
        data[start:start] = data[start:start + rng.randrange(60)] * rng.randrange(1, 20)
    return bytes(data)


class Sender:
    """Sends damaged messages in its own session, and reconnects whenever the server closes the connection."""

    def __init__(self, server):
        self.server, self.session, self.peer = server, None, None
        self.codes, self.closes = {}, {}

    def connect(self):
        if self.session is None:
            self.peer = WebSocket(self.server)
            self.session = self.peer.request(type="hello")
        else:
            self.peer = WebSocket(self.server, f"/ws/{self.session['session']}")
            welcome = self.peer.request(type="hello", token=self.session["token"])
            assert welcome["type"] == "welcome", welcome

    def count_error(self, message):
        if message["type"] == "error":
            self.codes[message["code"]] = self.codes.get(message["code"], 0) + 1

    def send(self, messages):
        """Sends the messages, then a valid request; waits until that is answered or the connection ends."""
        if self.peer is None:
            self.connect()
        valid_request = b'{"type":"get","what":"keymap","id":123456789}'
        self.peer.try_send(b"".join(frame(TEXT, data) for data in [*messages, valid_request]))
        try:
            while True:
                opcode, payload = self.peer.next_message()
                if opcode == CLOSE:
                    code = int.from_bytes(payload[:2], "big")
                    self.closes[code] = self.closes.get(code, 0) + 1
                    break
                if opcode == TEXT:
                    message = json.loads(payload)
                    self.count_error(message)
                    if message.get("id") == 123456789 and message["type"] == "keymap":
                        return
        except ConnectionEnded:
            self.closes[None] = self.closes.get(None, 0) + 1
        self.peer.socket.close()
        self.peer = None


def test_mutated_requests_do_not_affect_other_clients():
    rng = random.Random(SEED)
    with Server("--max-requests", 1_000_000, "--max-width", 1280, "--max-height", 720, "--max-file-time", 1, "--max-vertices", 2000,
                "--max-slices", 31) as server:
        with WebSocket(server) as bystander:
            welcome = bystander.request(type="hello")
            assert bystander.request(type="command", line="polytope 16-cell")["type"] == "done"
            assert bystander.request(type="key", key="y")["type"] == "done"
            before = bystander.request(type="get", what="state")
            senders = [Sender(server) for _ in range(4)]
            for batch in range(COUNT // 10):
                senders[batch % 4].send([mutated_request(rng, number == 9) for number in range(10)])
                if batch % 200 == 0:
                    assert bystander.request(type="get", what="state")["orientation"] == before["orientation"]
            after = bystander.request(type="get", what="state")
            assert {**after, "id": 0} == {**before, "id": 0}
        codes = {code: sum(sender.codes.get(code, 0) for sender in senders) for sender in senders for code in sender.codes}
        closes = {code: sum(sender.closes.get(code, 0) for sender in senders) for sender in senders for code in sender.closes}
        print(f"errors {codes}, closes {closes}")
        assert "internal" not in codes, codes
        assert closes.keys() <= {1000, 1003, 1007, 1008, 1009, 4401}, closes
        # Damage must cause every possible error code here. Otherwise, the damage is not varied enough.
        assert codes.keys() >= {"bad_json", "bad_message", "unknown_type", "unknown_key", "unknown_polytope", "unknown_command",
                                "bad_expression", "out_of_range", "not_a_rotation", "bad_polytope", "unsupported_format"}, codes
        with WebSocket(server, f"/ws/{welcome['session']}") as again:
            assert again.request(type="hello", token=welcome["token"])["type"] == "welcome"
            assert again.request(type="undo")["type"] == "done"
        assert server.metric('oval4d_errors_total{code="internal"}') == 0
        assert "fault=" not in server.log() and server.process.poll() is None
