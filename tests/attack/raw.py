"""HTTP/1.1 and WebSocket on bare sockets: nothing is corrected on the way out, and nothing is forgiven on the way in."""

import base64
import hashlib
import json
import os
import select
import socket
import struct
import time

from harness import DEADLINE

GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # RFC 6455, section 1.3
CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10


class Ended(Exception):
    """The peer ended the connection before what was expected came."""


class Socket:
    """A TCP connection with a buffer of what was read. `source` is the address that it comes from."""

    def __init__(self, server, source=None, receive_buffer=None, host=None):
        self.server = server
        host = host or server.host
        self.socket = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
        self.socket.settimeout(DEADLINE)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        if source:
            self.socket.bind((source, 0))
        self.socket.connect((host, server.port))
        self.buffer = bytearray()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, data):
        self.socket.sendall(data)

    def try_send(self, data):
        """Sends to somebody who may have hung up."""
        try:
            self.socket.sendall(data)
        except ConnectionError:
            pass

    def more(self):
        """Reads once more; false at the end, which a reset is too."""
        try:
            data = self.socket.recv(1 << 20)
        except ConnectionError:
            return False
        self.buffer += data
        return bool(data)

    def take(self, count):
        while len(self.buffer) < count:
            if not self.more():
                raise Ended(f"{count} octets expected, {bytes(self.buffer[:200])!r} came")
        data = bytes(self.buffer[:count])
        del self.buffer[:count]
        return data

    def take_until(self, mark):
        while mark not in self.buffer:
            if not self.more():
                raise Ended(f"{mark!r} expected, {bytes(self.buffer[:200])!r} came")
        return self.take(self.buffer.index(mark) + len(mark))

    def ends(self):
        """Waits for the end, which must come; what came before it."""
        while self.more():
            pass
        return self.take(len(self.buffer))

    def is_silent(self, seconds):
        """Whether nothing comes for so long, neither data nor the end."""
        return not self.buffer and not select.select([self.socket], [], [], seconds)[0]

    def reset(self):
        """Ends the connection with RST."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()

    def half_close(self):
        self.socket.shutdown(socket.SHUT_WR)

    def answer(self, method="GET"):
        return Answer(self, method)

    def answers(self, method="GET"):
        """All that come until the connection ends, which it must."""
        found = []
        while self.buffer or self.more():
            found.append(Answer(self, method))
        return found

    def flood(self, data, most):
        """Sends it again and again until the server ends the connection: the octets sent, or None if it took `most`."""
        self.socket.setblocking(False)
        sent, limit, rest = 0, time.monotonic() + DEADLINE, b""
        try:
            while sent < most:
                assert time.monotonic() < limit, f"the connection is still open after {sent} octets"
                readable, writable, _ = select.select([self.socket], [self.socket], [], 0.1)
                if readable and not self.more():
                    return sent
                if writable:
                    rest = rest or data
                    count = self.socket.send(rest)
                    rest, sent = rest[count:], sent + count
            return None
        except ConnectionError:
            return sent
        finally:
            self.socket.settimeout(DEADLINE)


class Answer:
    """One response as RFC 9112 frames it; an assertion where it breaks the rules itself."""

    def __init__(self, raw, method):
        head = raw.take_until(b"\r\n\r\n").decode("latin-1")
        first, *lines = head[:-4].split("\r\n")
        version, status, self.reason = first.split(" ", 2)
        assert version == "HTTP/1.1" and len(status) == 3, first
        self.status = int(status)
        self.fields = []
        for line in lines:
            name, colon, value = line.partition(":")
            assert colon and name and name == name.strip(), line
            self.fields.append((name.lower(), value.strip()))
        self.body = b""
        assert not self.all("transfer-encoding"), "no answer needs one"
        lengths = self.all("content-length")
        assert len(lengths) <= 1
        if self.status < 200:
            assert not lengths
        elif method != "HEAD" and self.status not in (204, 304):
            assert lengths, "the end of the answer cannot be told"
            self.body = raw.take(int(lengths[0]))

    def all(self, name):
        return [value for found, value in self.fields if found == name]

    def get(self, name):
        """The value of a field that comes once, or None."""
        values = self.all(name.lower())
        assert len(values) <= 1, self.fields
        return values[0] if values else None

    def __repr__(self):
        return f"{self.status} {self.fields} {self.body[:200]!r}"


def request(target="/healthz", *fields, method="GET", version="HTTP/1.1", host="localhost", close=False):
    """The octets of a request; `fields` are whole lines."""
    lines = [f"{method} {target} {version}"]
    lines += [f"Host: {host}"] if host is not None else []
    lines += [*fields] + (["Connection: close"] if close else [])
    return "".join(line + "\r\n" for line in lines).encode("latin-1") + b"\r\n"


def ask(server, target, *fields, method="GET", host="localhost", source=None):
    """One request on a connection of its own; its answer."""
    with Socket(server, source) as raw:
        raw.send(request(target, *fields, method=method, host=host, close=True))
        return raw.answer(method)


# --- WebSocket

def xor(data, mask):
    if mask == b"\0\0\0\0":
        return data
    repeated = mask * (len(data) // 4 + 1)
    number = int.from_bytes(data, "little") ^ int.from_bytes(repeated[:len(data)], "little")
    return number.to_bytes(len(data), "little")


def frame(opcode, payload=b"", final=True, reserved=0, mask=b"\x37\xfa\x21\x3d", form=None, announced=None):
    """A frame. `form` is the size of the length's own form: 7, 16 or 64 bits, the least that holds it unless given;
    `announced` a length that is not the payload's; `mask` None for none."""
    size = len(payload) if announced is None else announced
    form = form or (7 if size < 126 else 16 if size < 1 << 16 else 64)
    code, length = {7: (size, b""), 16: (126, size.to_bytes(8, "big")[6:]), 64: (127, size.to_bytes(8, "big"))}[form]
    head = bytes([(0x80 if final else 0) | reserved << 4 | opcode, (0x80 if mask is not None else 0) | code])
    return head + length + (mask or b"") + (payload if mask is None else xor(payload, mask))


def close_frame(code=None, reason=b""):
    return frame(CLOSE, b"" if code is None else code.to_bytes(2, "big") + reason)


def handshake(target="/ws", *fields, key=None, host="localhost", protocol="oval4d.v1"):
    """A good one; further `fields` are whole lines."""
    key = key or base64.b64encode(os.urandom(16)).decode()
    offered = [f"Sec-WebSocket-Protocol: {protocol}"] if protocol else []
    return request(target, "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                   f"Sec-WebSocket-Key: {key}", *offered, *fields, host=host)


def accept_for(key):
    return base64.b64encode(hashlib.sha1(key.encode() + GUID).digest()).decode()


class WebSocket(Socket):
    """An open one, after the handshake. `pongs` are collected while something else is waited for."""

    def __init__(self, server, target="/ws", *fields, source=None, receive_buffer=None):
        super().__init__(server, source, receive_buffer)
        self.pongs, self.number = [], 0
        self.send(handshake(target, *fields))
        self.upgraded = self.answer()
        if self.upgraded.status != 101:
            self.socket.close()
            raise Ended(f"no WebSocket: {self.upgraded}")

    def next_frame(self):
        """(opcode, payload, final) of the next frame, which must keep to the rules for servers."""
        first, second = self.take(2)
        assert not first & 0x70, "reserved bits are set"
        assert not second & 0x80, "a server's frame is masked"
        opcode, final, size = first & 15, bool(first & 0x80), second & 127
        assert opcode in (CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG)
        if size == 126:
            size = int.from_bytes(self.take(2), "big")
            assert size >= 126, "a length that is longer than need be"
        elif size == 127:
            size = int.from_bytes(self.take(8), "big")
            assert 1 << 16 <= size < 1 << 63, "a length that is longer than need be"
        if opcode >= CLOSE:
            assert final and size <= 125
        return opcode, self.take(size), final

    def next_message(self):
        """(opcode, payload) of the next message, or of the close; its fragments joined, pings and pongs put aside."""
        kind, pieces = None, []
        while True:
            opcode, payload, final = self.next_frame()
            if opcode == PONG:
                self.pongs.append(payload)
            elif opcode == PING:
                self.try_send(frame(PONG, payload))
            elif opcode == CLOSE:
                assert len(payload) != 1
                payload[2:].decode()
                return CLOSE, payload
            else:
                assert (kind is None) == (opcode != CONTINUATION), "fragments of messages are mixed"
                kind = opcode if kind is None else kind
                pieces.append(payload)
                if final:
                    return kind, b"".join(pieces)

    def say(self, **members):
        self.send(frame(TEXT, json.dumps(members).encode()))

    def answer_to(self, number):
        """The message with this id."""
        while True:
            opcode, payload = self.next_message()
            if opcode == CLOSE:
                raise Ended(f"closed with {int.from_bytes(payload[:2], 'big')} {payload[2:]}")
            if opcode == TEXT:
                message = json.loads(payload)
                if message.get("id") == number:
                    return message

    def ask(self, **members):
        """A request and the message that answers it, which may be an error."""
        self.number += 1
        self.say(**members, id=self.number)
        return self.answer_to(self.number)

    def pong(self):
        """The payload of the next pong, or of one that came meanwhile."""
        while not self.pongs:
            opcode, payload, _ = self.next_frame()
            if opcode == PONG:
                self.pongs.append(payload)
            assert opcode != CLOSE, payload
        return self.pongs.pop(0)

    def closed(self, answers=True):
        """The close code of the server's close frame, None if it has none. It is answered; then the connection must end."""
        while True:
            opcode, payload = self.next_message()
            if opcode == CLOSE:
                if answers:
                    self.try_send(frame(CLOSE, payload[:2]))
                assert self.ends() == b"", "something follows the close frame"
                return int.from_bytes(payload[:2], "big") if payload else None

    def fails(self):
        """The close code with which the server fails the connection."""
        code = self.closed()
        assert code is not None
        return code

    def refuses_its_size(self):
        """Whether what was just sent is refused as too large, by an error or by the end, and is not carried out."""
        try:
            while True:
                opcode, payload = self.next_message()
                if opcode == CLOSE:
                    return int.from_bytes(payload[:2], "big") == 1009
                message = json.loads(payload)
                if message["type"] == "error":
                    return message["code"] == "too_large"
                assert message.get("id") is None and message["type"] != "welcome", "it was carried out"
        except Ended:
            return True  # what was still being sent was reset

    def end_time(self):
        """When the server ends the conversation."""
        try:
            while self.next_message()[0] != CLOSE:
                pass
        except Ended:
            pass
        return time.monotonic()


class Session:
    """A session for tests that open many connections: each joins it."""

    def __init__(self, server):
        self.server = server
        with WebSocket(server) as socket_:
            welcome = socket_.ask(type="hello")
        self.name, self.token = welcome["session"], welcome["token"]

    def join(self, **keywords):
        socket_ = WebSocket(self.server, f"/ws/{self.name}", **keywords)
        welcome = socket_.ask(type="hello", token=self.token)
        assert welcome["type"] == "welcome", welcome
        return socket_
