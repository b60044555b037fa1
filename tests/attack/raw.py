"""HTTP/1.1 and WebSocket on plain sockets: sends any bytes, valid or not, and parses responses strictly."""

import base64
import hashlib
import json
import select
import socket
import struct
import time

from harness import DEADLINE

GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # the GUID of WebSocket handshakes (RFC 6455, section 1.3)
CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10


class ConnectionEnded(Exception):
    """Raised if the peer ends the connection before the expected data has arrived."""


class Socket:
    """A TCP connection with a buffer of received data. `source` is the local address."""

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
        """Sends data; ignores that the peer may have ended the connection."""
        try:
            self.socket.sendall(data)
        except ConnectionError:
            pass

    def receive(self):
        """Reads once into the buffer; returns False at the end of the connection, including a reset."""
        try:
            data = self.socket.recv(1 << 20)
        except ConnectionError:
            return False
        self.buffer += data
        return bool(data)

    def read_exactly(self, count):
        while len(self.buffer) < count:
            if not self.receive():
                raise ConnectionEnded(f"expected {count} bytes, received {bytes(self.buffer[:200])!r}")
        data = bytes(self.buffer[:count])
        del self.buffer[:count]
        return data

    def read_until(self, mark):
        while mark not in self.buffer:
            if not self.receive():
                raise ConnectionEnded(f"expected {mark!r}, received {bytes(self.buffer[:200])!r}")
        return self.read_exactly(self.buffer.index(mark) + len(mark))

    def read_until_end(self):
        """Waits for the end of the connection; returns the data that arrived before it."""
        while self.receive():
            pass
        return self.read_exactly(len(self.buffer))

    def reset(self):
        """Ends the connection with a TCP reset."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()

    def half_close(self):
        self.socket.shutdown(socket.SHUT_WR)

    def read_response(self, method="GET"):
        return Response(self, method)

    def read_responses(self, method="GET"):
        """Returns all responses until the connection ends, which it must."""
        found = []
        while self.buffer or self.receive():
            found.append(Response(self, method))
        return found

    def flood(self, data, max_bytes):
        """Sends the data repeatedly until the server ends the connection; returns the number of bytes sent, or None if
        the server accepted `max_bytes` bytes."""
        self.socket.setblocking(False)
        sent, deadline, rest = 0, time.monotonic() + DEADLINE, b""
        try:
            while sent < max_bytes:
                assert time.monotonic() < deadline, f"the connection is still open after {sent} bytes"
                readable, writable, _ = select.select([self.socket], [self.socket], [], DEADLINE)
                if readable and not self.receive():
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


def send_as_far_as_read(sockets, data, serve_another):
    """Sends the data on each connection until the server does not read on: until several rounds, in each of which
    `serve_another()` has requests of another client answered, send nothing. Returns the number of bytes sent."""
    rest = {raw: memoryview(data) for raw in sockets}
    sent, rounds_without = 0, 0
    for raw in sockets:
        raw.socket.setblocking(False)
    while rest and rounds_without < 5:
        rounds_without += 1
        for raw in list(rest):
            try:
                count = raw.socket.send(rest[raw])
            except BlockingIOError:
                continue
            except ConnectionError:
                del rest[raw]
                continue
            sent, rounds_without = sent + count, 0
            rest[raw] = rest[raw][count:]
            if not rest[raw]:
                del rest[raw]
        serve_another()
    for raw in sockets:
        raw.socket.settimeout(DEADLINE)
    return sent


class Response:
    """An HTTP response, framed as in RFC 9112; asserts that it is well-formed."""

    def __init__(self, raw, method):
        head = raw.read_until(b"\r\n\r\n").decode("latin-1")
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
        assert not self.values_of("transfer-encoding"), "the server sends no Transfer-Encoding"
        lengths = self.values_of("content-length")
        assert len(lengths) <= 1
        if self.status < 200:
            assert not lengths
        elif method != "HEAD" and self.status not in (204, 304):
            assert lengths, "the response has no length"
            self.body = raw.read_exactly(int(lengths[0]))

    def values_of(self, name):
        return [value for found, value in self.fields if found == name]

    def get(self, name):
        """Returns the value of a field that must not be repeated, or None."""
        values = self.values_of(name.lower())
        assert len(values) <= 1, self.fields
        return values[0] if values else None

    def __repr__(self):
        return f"{self.status} {self.fields} {self.body[:200]!r}"


def request(target="/healthz", *fields, method="GET", version="HTTP/1.1", host="localhost", close=False):
    """Returns the bytes of a request; `fields` are complete header lines."""
    lines = [f"{method} {target} {version}"]
    lines += [f"Host: {host}"] if host is not None else []
    lines += [*fields] + (["Connection: close"] if close else [])
    return "".join(line + "\r\n" for line in lines).encode("latin-1") + b"\r\n"


def fetch(server, target, *fields, method="GET", host="localhost", source=None):
    """Sends one request on its own connection; returns the response."""
    with Socket(server, source) as raw:
        raw.send(request(target, *fields, method=method, host=host, close=True))
        return raw.read_response(method)


# --- WebSocket frames and a client that can send invalid ones

def xor_with_mask(data, mask):
    if mask == b"\0\0\0\0":
        return data
    repeated = mask * (len(data) // 4 + 1)
    number = int.from_bytes(data, "little") ^ int.from_bytes(repeated[:len(data)], "little")
    return number.to_bytes(len(data), "little")


def frame(opcode, payload=b"", final=True, reserved=0, mask=b"\x37\xfa\x21\x3d", length_bits=None, announced_length=None):
    """Returns a frame. `length_bits` is the size of the length field, 7, 16 or 64 (by default the least possible);
    `announced_length` replaces the length in the header; without a `mask`, the payload is not masked."""
    size = len(payload) if announced_length is None else announced_length
    length_bits = length_bits or (7 if size < 126 else 16 if size < 1 << 16 else 64)
    code, length = {7: (size, b""), 16: (126, size.to_bytes(8, "big")[6:]), 64: (127, size.to_bytes(8, "big"))}[length_bits]
    head = bytes([(0x80 if final else 0) | reserved << 4 | opcode, (0x80 if mask is not None else 0) | code])
    return head + length + (mask or b"") + (payload if mask is None else xor_with_mask(payload, mask))


def close_frame(code=None, reason=b""):
    return frame(CLOSE, b"" if code is None else code.to_bytes(2, "big") + reason)


def handshake(target="/ws", *fields, key=None, host="localhost", protocol="oval4d.v1"):
    """Returns a valid handshake request; `fields` are additional header lines."""
    key = key or base64.b64encode(b"sixteen bytes...").decode()
    offered = [f"Sec-WebSocket-Protocol: {protocol}"] if protocol else []
    return request(target, "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                   f"Sec-WebSocket-Key: {key}", *offered, *fields, host=host)


def accept_value(key):
    return base64.b64encode(hashlib.sha1(key.encode() + GUID).digest()).decode()


class WebSocket(Socket):
    """A WebSocket after the handshake. `pongs` collects the pongs that arrive while another message is awaited."""

    def __init__(self, server, target="/ws", *fields, source=None, receive_buffer=None):
        super().__init__(server, source, receive_buffer)
        self.pongs, self.number = [], 0
        self.send(handshake(target, *fields))
        self.handshake_response = self.read_response()
        if self.handshake_response.status != 101:
            self.socket.close()
            raise ConnectionEnded(f"no WebSocket: {self.handshake_response}")

    def next_frame(self):
        """Returns (opcode, payload, final) of the next frame; asserts that a server may send it."""
        first, second = self.read_exactly(2)
        assert not first & 0x70, "reserved bits are set"
        assert not second & 0x80, "a server's frame is masked"
        opcode, final, size = first & 15, bool(first & 0x80), second & 127
        assert opcode in (CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG)
        if size == 126:
            size = int.from_bytes(self.read_exactly(2), "big")
            assert size >= 126, "the length is not encoded minimally"
        elif size == 127:
            size = int.from_bytes(self.read_exactly(8), "big")
            assert 1 << 16 <= size < 1 << 63, "the length is not encoded minimally"
        if opcode >= CLOSE:
            assert final and size <= 125
        return opcode, self.read_exactly(size), final

    def next_message(self):
        """Returns (opcode, payload) of the next message or close frame. Joins fragments and collects pongs."""
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
                assert (kind is None) == (opcode != CONTINUATION), "fragments of two messages are mixed"
                kind = opcode if kind is None else kind
                pieces.append(payload)
                if final:
                    return kind, b"".join(pieces)

    def send_message(self, **members):
        self.send(frame(TEXT, json.dumps(members).encode()))

    def wait_for_answer(self, number):
        """Waits for the message with this id."""
        while True:
            opcode, payload = self.next_message()
            if opcode == CLOSE:
                raise ConnectionEnded(f"closed with {int.from_bytes(payload[:2], 'big')} {payload[2:]}")
            if opcode == TEXT:
                message = json.loads(payload)
                if message.get("id") == number:
                    return message

    def request(self, **members):
        """Sends a request; returns its answer, which may be an error."""
        self.number += 1
        self.send_message(**members, id=self.number)
        return self.wait_for_answer(self.number)

    def next_pong(self):
        """Returns the payload of the first pong not returned yet."""
        while not self.pongs:
            opcode, payload, _ = self.next_frame()
            if opcode == PONG:
                self.pongs.append(payload)
            assert opcode != CLOSE, payload
        return self.pongs.pop(0)

    def wait_for_close_code(self, answers=True):
        """Waits for the server's close frame, answers it, and asserts that the connection ends; returns the close code,
        None if there is none."""
        while True:
            opcode, payload = self.next_message()
            if opcode == CLOSE:
                if answers:
                    self.try_send(frame(CLOSE, payload[:2]))
                assert self.read_until_end() == b"", "something follows the close frame"
                return int.from_bytes(payload[:2], "big") if payload else None

    def wait_for_failure_code(self):
        """Waits until the server fails the connection; returns the close code, which must be present."""
        code = self.wait_for_close_code()
        assert code is not None
        return code

    def refuses_message_as_too_large(self):
        """Returns whether the message just sent is refused as too large, by an error or the end of the connection;
        asserts that it is not executed."""
        try:
            while True:
                opcode, payload = self.next_message()
                if opcode == CLOSE:
                    return int.from_bytes(payload[:2], "big") == 1009
                message = json.loads(payload)
                if message["type"] == "error":
                    return message["code"] == "too_large"
                assert message.get("id") is None and message["type"] != "welcome", "the message was executed"
        except ConnectionEnded:
            return True  # the server has reset the connection meanwhile


class SharedSession:
    """A session that all connections of a test join."""

    def __init__(self, server):
        self.server = server
        with WebSocket(server) as socket_:
            welcome = socket_.request(type="hello")
        self.name, self.token = welcome["session"], welcome["token"]

    def join(self, **keywords):
        socket_ = WebSocket(self.server, f"/ws/{self.name}", **keywords)
        welcome = socket_.request(type="hello", token=self.token)
        assert welcome["type"] == "welcome", welcome
        return socket_
