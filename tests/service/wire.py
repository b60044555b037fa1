"""A client that hides nothing: every message received is kept, in order."""

import asyncio
import itertools
import json

import cbor2
import websockets
from harness import DEADLINE

SUBPROTOCOL = "oval4d.v1"


def connect(server, session="", **keywords):
    """A bare WebSocket. Pings are the server's business, and sizes are not limited here."""
    url = f"ws://{server.host}:{server.port}/ws" + (f"/{session}" if session else "")
    keywords.setdefault("subprotocols", [SUBPROTOCOL])
    return websockets.connect(url, max_size=None, max_queue=None, ping_interval=None, compression=None, **keywords)


def status_of(refusal):
    """The HTTP status of a refused handshake, whatever the library's version calls it."""
    return refusal.status_code if hasattr(refusal, "status_code") else refusal.response.status_code


class Refused(Exception):
    """An error message that answered a request."""

    def __init__(self, message):
        super().__init__(f"{message['code']}: {message['message']}")
        self.code, self.text = message["code"], message["message"]


class Client:
    """`async with Client(server, stream="geometry") as client:` has said hello and been welcomed.

    `messages` is all that came: dictionaries, and bytes for frames and files. With `shows`, each picture is acknowledged.
    """

    def __init__(self, server, session="", shows=True, address=None, **hello):
        self.server, self.session, self.shows = server, session, shows
        self.connecting = {} if address is None else {"local_addr": (address, 0)}  # from this one of its addresses
        self.hello = hello
        self.messages = []
        self.close_code = None
        self._ids = itertools.count(1)
        self._news = asyncio.Condition()

    async def __aenter__(self):
        self.socket = await connect(self.server, self.session, **self.connecting)
        self._reader = asyncio.ensure_future(self._read())
        try:
            self.welcome = await self.request("hello", **self.hello)
        except BaseException:
            await self.leave()
            raise
        return self

    async def __aexit__(self, *_):
        await self.leave()

    async def leave(self):
        await self.socket.close()
        await self._reader

    async def _read(self):
        try:
            async for data in self.socket:
                message = self.decode(data)
                self.messages.append(message)
                if self.shows and self.is_picture(message):
                    await self.send("shown", revision=self.states()[-1]["revision"])
                async with self._news:
                    self._news.notify_all()
        except websockets.ConnectionClosed:
            pass
        self.close_code = self.socket.close_code
        async with self._news:
            self._news.notify_all()

    @staticmethod
    def decode(data):
        if isinstance(data, str):
            return json.loads(data)
        return cbor2.loads(data) if 0xa0 <= data[0] < 0xc0 else data  # a map; else a frame or a file

    @staticmethod
    def is_picture(message):
        return isinstance(message, bytes) or message["type"] == "slices"

    async def send(self, type_, **members):
        await self.socket.send(json.dumps({"type": type_, **members}))

    async def request(self, type_, **members):
        """Sends with an id, and returns what answers it; an error is raised."""
        number = next(self._ids)
        await self.send(type_, id=number, **members)
        answer = await self.until(lambda: self.answer(number))
        if answer["type"] == "error":
            raise Refused(answer)
        return answer

    def answer(self, number):
        found = [m for m in self.messages if isinstance(m, dict) and m.get("id") == number]
        assert len(found) < 2, f"answered more than once: {found}"
        return found[0] if found else None

    async def frame(self, **members):
        """Asks for a frame: the PNG file that came right before its `done`."""
        done = await self.request("get", what="frame", **members)
        return self.messages[self.messages.index(done) - 1]

    async def until(self, condition, deadline=DEADLINE):
        """The condition's first true value; it is looked at whenever a message came."""
        async with self._news:
            while True:
                value = condition()
                if value:
                    return value
                assert self.close_code is None, f"closed with {self.close_code} before it came"
                await asyncio.wait_for(self._news.wait(), deadline)

    async def closed(self):
        """The code with which the server closed."""
        async with self._news:
            while self.close_code is None:
                await asyncio.wait_for(self._news.wait(), DEADLINE)
        return self.close_code

    def of_type(self, type_):
        """Messages of the stream: those that answer a request are left out."""
        return [m for m in self.messages if isinstance(m, dict) and m["type"] == type_ and "id" not in m]

    def states(self):
        return self.of_type("state")

    def pictures(self):
        return [m for m in self.messages if self.is_picture(m) and not (isinstance(m, dict) and "id" in m)]

    async def state(self, revision):
        """The streamed state of this revision, or the first newer one."""
        return await self.until(lambda: next((m for m in self.states() if m["revision"] >= revision), None))

    async def slices(self, revision):
        return await self.until(lambda: next((m for m in self.of_type("slices") if m["revision"] >= revision), None))

    async def frame_of(self, revision):
        """The streamed frame that followed the state of this revision or a newer one."""
        def found():
            for at, message in enumerate(self.messages[:-1]):
                if isinstance(message, dict) and message["type"] == "state" and message["revision"] >= revision:
                    if isinstance(self.messages[at + 1], bytes):
                        return self.messages[at + 1]
            return None
        return await self.until(found)


async def turned_away(server, session="", **hello):
    """Says hello where it is not welcome: the error's code, and the code of the close that follows."""
    async with connect(server, session) as socket:
        await socket.send(json.dumps({"type": "hello", **hello}))
        error = json.loads(await socket.recv())
        try:
            await asyncio.wait_for(socket.recv(), DEADLINE)
        except websockets.ConnectionClosed:
            pass
        return error["code"], socket.close_code
