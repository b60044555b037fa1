"""A WebSocket client that keeps every received message, in order."""

import asyncio
import itertools
import json
import sys
from pathlib import Path

import websockets
from harness import DEADLINE
from schemas import answer_type, compare_with_schema, uncompared_shape

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "protocol/python"))
import oval4d_client  # noqa: E402

SUBPROTOCOL = "oval4d.v1"
_HELLO = json.loads((ROOT / "protocol/schema/hello.schema.json").read_text(encoding="utf-8"))
ENCODINGS = _HELLO["properties"]["encoding"]["enum"]  # the encodings of `slices` messages
BINARY_ENCODINGS = [encoding for encoding in ENCODINGS if encoding != "json"]


def connect(server, session="", **keywords):
    """Opens a WebSocket without hello; the client sends no pings and does not limit the size of messages."""
    url = f"ws://{server.host}:{server.port}/ws" + (f"/{session}" if session else "")
    keywords.setdefault("subprotocols", [SUBPROTOCOL])
    keywords.setdefault("open_timeout", DEADLINE)
    return websockets.connect(url, max_size=None, max_queue=None, ping_interval=None, compression=None, **keywords)


def handshake_status(refusal):
    """Returns the HTTP status of a refused handshake, with any version of the library."""
    return refusal.status_code if hasattr(refusal, "status_code") else refusal.response.status_code


class Refused(Exception):
    """Raised if a request is answered by an error message."""

    def __init__(self, message):
        super().__init__(f"{message['code']}: {message['message']}")
        self.code, self.text = message["code"], message["message"]


class Client:
    """A session's client: `async with Client(server, stream="geometry") as client:` sends hello and awaits welcome.

    `messages` holds everything received: dictionaries, and bytes for frames and files. `address` is the local address.
    If `acknowledges`, the client sends `shown` for each picture. If `compares`, it compares at the end the JSON
    messages that it has received with the schemas; of messages of one type with the same members, only the first. A
    client that measures latencies must not compare, because finding the members of a message takes milliseconds.
    """

    def __init__(self, server, session="", acknowledges=True, address=None, compares=True, **hello):
        self.server, self.session, self.acknowledges = server, session, acknowledges
        self.connect_options = {} if address is None else {"local_addr": (address, 0)}
        self.compares = compares
        self.hello = hello
        self.messages = []
        self._uncompared = {}
        self.close_code = None
        self._ids = itertools.count(1)
        self._changed = asyncio.Condition()

    async def __aenter__(self):
        self.socket = await connect(self.server, self.session, **self.connect_options)
        self._reader = asyncio.ensure_future(self._read())
        try:
            self.welcome = await self.request("hello", **self.hello)
        except BaseException:
            await self.leave()
            raise
        return self

    async def __aexit__(self, exception, *_):
        await self.leave()
        if exception is None:
            for text in self._uncompared.values():
                compare_with_schema(json.loads(text))

    async def leave(self):
        await self.socket.close()
        await self._reader

    async def _read(self):
        try:
            async for data in self.socket:
                message = self.decode(data)
                self.messages.append(message)
                if self.compares and isinstance(data, str) and (found := uncompared_shape(message)):
                    self._uncompared.setdefault(found, data)
                if self.acknowledges and self.is_picture(message):
                    await self.send("shown", revision=self.states()[-1]["revision"])
                async with self._changed:
                    self._changed.notify_all()
        except websockets.ConnectionClosed:
            pass
        self.close_code = self.socket.close_code
        async with self._changed:
            self._changed.notify_all()

    @staticmethod
    def decode(data):
        """Returns JSON as it is, and binary messages as the Python client decodes them."""
        return json.loads(data) if isinstance(data, str) else oval4d_client.decode(data)

    @staticmethod
    def is_picture(message):
        return isinstance(message, bytes) or message["type"] == "slices"

    async def send(self, type_, **members):
        await self.socket.send(json.dumps({"type": type_, **members}))

    async def request(self, type_, *, deadline=DEADLINE, **members):
        """Sends a request with an id and returns its answer; raises Refused for an error."""
        number = next(self._ids)
        await self.send(type_, id=number, **members)
        answer = await self.wait_until(lambda: self.answer_to(number), deadline)
        if answer["type"] == "error":
            raise Refused(answer)
        assert answer["type"] == answer_type(type_, members.get("what"))
        return answer

    def answer_to(self, number):
        found = [m for m in self.messages if isinstance(m, dict) and m.get("id") == number]
        assert len(found) < 2, f"answered more than once: {found}"
        return found[0] if found else None

    async def request_frame(self, **members):
        """Requests a frame; returns the PNG file, which arrives right before `done`."""
        done = await self.request("get", what="frame", **members)
        return self.messages[self.messages.index(done) - 1]

    async def wait_until(self, condition, deadline=DEADLINE):
        """Returns the condition's first true value; checks it after every message."""
        async with self._changed:
            while True:
                value = condition()
                if value:
                    return value
                assert self.close_code is None, f"the server closed the connection with {self.close_code}"
                await asyncio.wait_for(self._changed.wait(), deadline)

    async def wait_for_close_code(self):
        """Waits for the server to close; returns the close code."""
        async with self._changed:
            while self.close_code is None:
                await asyncio.wait_for(self._changed.wait(), DEADLINE)
        return self.close_code

    def streamed_messages(self, type_):
        """Returns the messages of this type in the stream, without the answers to requests."""
        return [m for m in self.messages if isinstance(m, dict) and m["type"] == type_ and "id" not in m]

    def states(self):
        return self.streamed_messages("state")

    def pictures(self):
        return [m for m in self.messages if self.is_picture(m) and not (isinstance(m, dict) and "id" in m)]

    async def wait_for_state(self, revision):
        """Waits for the streamed state of this revision, or the first newer one."""
        return await self.wait_until(lambda: next((m for m in self.states() if m["revision"] >= revision), None))

    async def wait_for_slices(self, revision):
        """Waits for the streamed slices of this revision or a newer one that are not a draft."""
        def found():
            pictures = self.streamed_messages("slices")
            return next((m for m in pictures if m["revision"] >= revision and "draft" not in m), None)
        return await self.wait_until(found)

    async def wait_for_frame(self, revision):
        """Waits for the streamed frame that follows the state of this revision or a newer one, and is not a draft."""
        def found():
            for at, message in enumerate(self.messages[:-1]):
                is_state = isinstance(message, dict) and message["type"] == "state"
                if is_state and message["revision"] >= revision and "draft" not in message:
                    if isinstance(self.messages[at + 1], bytes):
                        return self.messages[at + 1]
            return None
        return await self.wait_until(found)


def credentials_of(client):
    return {"session": client.welcome["session"], "token": client.welcome["token"]}


def with_another_member(whole):
    """Returns the record of a session as a later version might store it: its CBOR array has one more member."""
    assert 0x80 < whole[0] < 0x97, "an array of fewer than 23 members"
    return bytes([whole[0] + 1]) + whole[1:] + b"\xf4"  # adds a member with the value false


async def hello_refusal(server, session="", **hello):
    """Sends a hello that the server refuses; returns the error code, and the close code that follows."""
    async with connect(server, session) as socket:
        await socket.send(json.dumps({"type": "hello", **hello}))
        error = json.loads(await socket.recv())
        compare_with_schema(error)
        try:
            await asyncio.wait_for(socket.recv(), DEADLINE)
        except websockets.ConnectionClosed:
            pass
        return error["code"], socket.close_code
