"""A client of oval4d: exchanges messages with a server over a WebSocket, one call per message.

    with connect("http://127.0.0.1:8080/") as oval:
        oval.hello()
        oval.set(polytope="24-cell")
        oval.rotate("xw,yz", 0.39, 1.42)
        open("24-cell.png", "wb").write(oval.frame(1280, 720))

../README.md specifies the messages and their members. Needs python3-websockets (10 or later), and python3-cbor2 for
slices in CBOR. A separate thread handles the socket. Therefore any thread may call the client, and the connection stays
open while a script is idle.
"""

import array
import asyncio
import itertools
import json
import random
import re
import struct
import threading
import time
from urllib.parse import urlsplit, urlunsplit

import websockets

try:
    import cbor2
except ImportError:
    cbor2 = None

SUBPROTOCOL = "oval4d.v1"
PNG = b"\x89PNG\r\n\x1a\n"
RECONNECT_CODES = {None, 1001, 1006, 1012, 1013}  # close codes after which the client reconnects to its session


class Refused(Exception):
    """The server answered with an error; `code` is one of ../errors.json."""

    def __init__(self, code, message):
        super().__init__(f"{code}: {message}")
        self.code = code
        self.message = message


class Closed(Exception):
    """The connection has ended; `code` is the close code, or None if the connection broke."""

    def __init__(self, code, reason):
        super().__init__(f"the connection is closed ({code} {reason})".rstrip())
        self.code = code
        self.reason = reason


def connect(url="http://127.0.0.1:8080/", session=None, **options):
    """Connects to the server at `url` (http, https, ws or wss), and returns a Client. Opens a new session, or the
    session with the name `session`. The options are those of Client."""
    return Client(socket_url(url, session), **options)


def socket_url(url, session=None):
    """Returns the WebSocket URL for the URL of the page: http://host/prefix/?query → ws://host/prefix/ws?query."""
    parts = urlsplit(url)
    scheme = {"http": "ws", "https": "wss"}.get(parts.scheme, parts.scheme)
    path = parts.path.rstrip("/") + "/ws" + (f"/{session}" if session else "")
    return urlunsplit((scheme, parts.netloc, path, parts.query, ""))


class Client:
    """A connection to one session. `timeout` (seconds) applies to every call. If `show` is true, pictures of the stream
    are acknowledged as soon as they arrive. `headers` are added to the HTTP request that opens the connection.

    If the connection breaks, or the server closes it because the server stops, the client reconnects: at once, and then
    with growing pauses, for `timeout` seconds. Calls wait in the meantime. A call that was in progress raises Closed,
    because it is unknown whether the call took effect."""

    def __init__(self, url, timeout=30, show=True, headers=None):
        self.timeout = timeout
        self.show = show
        self._url = url
        self._headers = headers
        self._hello = {}
        self._reconnecting = False
        self._closing = False
        self.welcome = None  # the newest message of each kind, None before the first
        self.newest_state = None
        self.newest_slices = None
        self.newest_frame = None
        self.errors = []  # error messages that do not answer a call
        self.closed = None  # (code, reason) once the connection has ended for good
        self._ids = itertools.count(1)
        self._waiting = {}  # for the id of each call in progress: its answer, None until it arrives
        self._wants_bytes = set()  # ids of calls that are answered by a binary message, which precedes their done
        self._binary = None
        self._change = threading.Condition()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        try:
            self._socket = self._run(self._open(url, headers))
        except BaseException:
            self._stop()
            raise
        self._reader = asyncio.run_coroutine_threadsafe(self._read(), self._loop)

    # Messages

    def hello(self, stream="none", **members):
        """Sends the first message. `stream` is "geometry", "frames" or "none"; the other members are width, height,
        encoding and token."""
        return self.request("hello", stream=stream, **members)

    def key(self, key, shift=False, ctrl=False):
        return self.request("key", key=key, shift=shift, ctrl=ctrl)

    def rotate(self, planes, *angles):
        """Rotates by one angle in radians for each plane: rotate("xw", 0.1) or rotate("xw,yz", 0.1, 0.2)."""
        return self.request("rotate", planes=planes.split(","), angles=list(angles))

    def toward(self, element, number=None, immediately=False):
        """Turns a "vertex", "edge", "face" or "cell" toward +w: the one with this number, or else the closest one."""
        chosen = {} if number is None else {"number": number}
        return self.request("toward", element=element, immediately=immediately, **chosen)

    def set(self, **settings):
        return self.request("set", **settings)

    def command(self, line):
        return self.request("command", line=line)

    def load(self, name, data, format="off"):
        return self.request("load", name=name, data=data, format=format)

    def undo(self):
        return self.request("undo")

    def redo(self):
        return self.request("redo")

    def reset(self):
        return self.request("reset")

    def get(self, what, width=None, height=None):
        size = {} if width is None else {"width": width, "height": height}
        return self.request("get", what=what, **size)

    def state(self):
        return self.get("state")

    def slices(self, width=None, height=None):
        return self.get("slices", width, height)

    def frame(self, width=None, height=None):
        """Returns a picture as the bytes of a PNG file."""
        return self.get("frame", width, height)

    def at(self, x, y, width=None, height=None):
        """Returns what the picture shows at a point, in pixels from the upper left corner."""
        size = {} if width is None else {"width": width, "height": height}
        return self.request("get", what="at", x=x, y=y, **size)

    def file(self, format, **members):
        """Returns the bytes of an exported file. `format` is "stl", "3mf", …; the other members are of, body, size and
        label, as in `get`."""
        return self.request("get", what="file", format=format, **members)

    def catalogue(self):
        return self.get("catalogue")["polytopes"]

    def keymap(self):
        return self.get("keymap")["keys"]

    def shown(self, revision):
        """Tells the server that the picture of this revision has been presented."""
        self.send({"type": "shown", "revision": revision})

    def wait(self, revision, timeout=None):
        """Waits for the picture of this revision or of a later one, or for the state if the stream is "none". Returns
        the newest state."""

        def arrived():
            newest = {"geometry": self.newest_slices, "frames": self.newest_frame and png_state(self.newest_frame)}
            message = newest.get(self._stream, self.newest_state)
            return message is not None and message["revision"] >= revision

        self._wait_for(arrived, timeout, f"revision {revision}")
        return self.newest_state

    # Transport

    def request(self, type, **members):
        """Sends a message with an id and returns the answer; raises Refused if the answer is an error."""
        if type == "hello":
            self._stream = members.get("stream", "none")
            self._hello = members
        number = next(self._ids)
        with self._change:
            self._waiting[number] = None
            if members.get("what") in ("frame", "file"):
                self._wants_bytes.add(number)
        try:
            self.send({"type": type, "id": number, **members})
            self._wait_for(lambda: self._waiting[number] is not None, None, f"the answer to {type}")
            answer = self._waiting[number]
        finally:
            with self._change:
                del self._waiting[number]
                self._wants_bytes.discard(number)
        if isinstance(answer, Closed):
            raise answer
        if isinstance(answer, dict) and answer["type"] == "error":
            raise Refused(answer["code"], answer["message"])
        return answer

    def send(self, message):
        """Sends a message without an id, and does not wait: a dict as JSON; text and bytes unchanged."""
        if isinstance(message, dict):
            message = json.dumps(message)
        self._wait_for(lambda: not self._reconnecting, None, "the server")
        try:
            self._run(self._socket.send(message))
        except websockets.ConnectionClosed:
            raise Closed(self._socket.close_code, self._socket.close_reason or "") from None

    def close(self):
        self._closing = True
        if self._loop.is_running():
            self._run(self._socket.close())
            self._reader.result(self.timeout)
            self._stop()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    _stream = "none"

    async def _open(self, url, headers):
        options = {"subprotocols": [SUBPROTOCOL], "max_size": None, "compression": None}
        version = int(websockets.__version__.split(".")[0])
        if version >= 15:
            options["proxy"] = None
        if headers:
            options["additional_headers" if version >= 14 else "extra_headers"] = headers
        return await websockets.connect(url, **options)

    async def _read(self):
        while True:
            try:
                async for message in self._socket:
                    picture = self._receive(message)
                    if picture is not None and self.show:
                        await self._socket.send(json.dumps({"type": "shown", "revision": picture}))
            except websockets.ConnectionClosed:
                pass
            end = (self._socket.close_code, self._socket.close_reason or "")
            again = self.welcome is not None and end[0] in RECONNECT_CODES and not self._closing
            with self._change:
                for number, answer in self._waiting.items():
                    self._waiting[number] = answer or Closed(*end)
                self._reconnecting = again
                self.closed = None if again else end
                self._change.notify_all()
            if not again or not await self._return(end):
                return

    async def _return(self, end):
        """Reconnects to the session, on any server that answers. Returns whether the connection is open again."""
        last = time.monotonic() + self.timeout
        pause = 0.1
        parts = urlsplit(self._url)
        path = re.sub(r"/ws(/[^/]*)?$", "/ws/" + self.welcome["session"], parts.path)
        url = urlunsplit((parts.scheme, parts.netloc, path, parts.query, ""))
        while not self._closing and time.monotonic() < last:
            await asyncio.sleep(pause * (0.5 + random.random()))
            pause = min(2 * pause, 5)
            try:
                self._socket = await self._open(url, self._headers)
                await self._socket.send(json.dumps({**self._hello, "type": "hello", "token": self.welcome["token"]}))
            except (OSError, websockets.WebSocketException, asyncio.TimeoutError):
                continue
            with self._change:
                self._reconnecting = False
                self._change.notify_all()
            return True
        with self._change:
            self._reconnecting = False
            self.closed = end
            self._change.notify_all()
        return False

    def _receive(self, data):
        """Handles a message. Returns its revision if it is a picture of the stream, else None."""
        picture = None
        with self._change:
            if isinstance(data, bytes) and data.startswith(PNG):
                self._binary = self.newest_frame = data
                picture = png_state(data)["revision"]
                self._change.notify_all()
                return picture
            if isinstance(data, bytes) and not 0xA0 <= data[0] < 0xC0:  # not a CBOR map, so a file
                self._binary = data
                return None
            message = json.loads(data) if isinstance(data, str) else from_cbor(data)
            kind, number = message["type"], message.get("id")
            if kind == "slices" and number is None:
                picture = message["revision"]
            if kind in ("welcome", "state", "slices"):
                setattr(self, "welcome" if kind == "welcome" else "newest_" + kind, message)
            if number in self._waiting:
                framed = kind == "done" and number in self._wants_bytes
                self._waiting[number] = self._binary if framed else message
            elif kind == "error":
                self.errors.append(message)
            self._change.notify_all()
        return picture

    def _wait_for(self, happened, timeout, what):
        end = time.monotonic() + (self.timeout if timeout is None else timeout)
        with self._change:
            while not happened():
                if self.closed:
                    raise Closed(*self.closed)
                left = end - time.monotonic()
                if left <= 0:
                    raise TimeoutError(f"timed out waiting for {what}")
                self._change.wait(left)

    def _run(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(self.timeout)

    def _stop(self):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(self.timeout)
        self._loop.close()


def png_state(png):
    """Returns the state in a frame's iTXt chunk. Sent as a `set`, it restores the picture. Raises ValueError if the
    bytes are not a frame with a state."""
    at = len(PNG) if png.startswith(PNG) else len(png)
    while at + 12 <= len(png):
        size, kind = struct.unpack_from(">I4s", png, at)
        text = png[at + 8 : at + 8 + size]
        if kind == b"iTXt" and text.startswith(b"oval4d\0"):
            try:
                # The text follows the keyword, two flags, the language and the translated keyword.
                state = json.loads(text.split(b"\0", 5)[-1])
            except RecursionError:
                break
            if isinstance(state, dict):
                return state
        at += size + 12
    raise ValueError("not an oval4d frame: it contains no state")


def from_cbor(data):
    """Returns a slices message that is encoded in CBOR as a dict, with one dict per slice. Typed arrays become
    array.array of floats or integers. Raises ValueError if the bytes are not such a message."""
    if cbor2 is None:
        raise ImportError("decoding slices in CBOR needs python3-cbor2")

    def typed(_, tag):
        kind = {85: "f", 86: "d", 64: "B", 69: "H", 70: "I"}.get(tag.tag)
        return tag if kind is None else array.array(kind, tag.value)

    try:
        message = cbor2.loads(data, tag_hook=typed)
        message["slices"] = _slices_of(message["slices"])
        if "projection" in message:
            parts = message["projection"]["parts"]
            message["projection"]["parts"] = [look | own for look, own in zip(parts["looks"], _elements_of(parts))]
    except (cbor2.CBORDecodeError, ArithmeticError, AttributeError, LookupError, MemoryError, RecursionError,
            TypeError) as fault:
        raise ValueError(f"not a slices message in CBOR: {fault}") from fault
    return message


def _rows(flat, sizes, width=1):
    """Splits an array into consecutive parts. Part i has sizes[i] items, and each item has `width` numbers."""
    ends = list(itertools.accumulate(sizes, initial=0))
    return [flat[width * begin : width * end] for begin, end in zip(ends, ends[1:])]


def _elements_of(columns):
    """Returns one dict per slice, or per part of the projection, with its elements. `columns` has one array per property,
    with the values of all slices."""
    counts = columns["counts"]

    def of_each(lists):
        rows = [_rows(lists[name], counts[name]) for name in lists]
        return [dict(zip(lists, row)) for row in zip(*rows)]

    sides = _rows(columns["sides"], counts["faces"])
    properties = {"vertices": _rows(columns["vertices"], counts["vertices"], 3),
                  "edges": _rows(columns["edges"], counts["edges"], 2)}
    properties["faces"] = [{"begin": array.array("I", itertools.accumulate(own, initial=0)), "corners": corners}
                           for own, corners in zip(sides, _rows(columns["corners"], map(sum, sides)))]
    properties["of"] = of_each(columns["of"])
    if "seen" in columns:
        properties["seen"] = of_each(columns["seen"])
    elements = [dict(zip(properties, row)) for row in zip(*properties.values())]
    if "tints" in columns:
        for piece, tints in zip(elements, _rows(columns["tints"], counts["faces"])):
            if tints != piece["of"]["faces"]:
                piece["tints"] = tints
    if "balls" in columns:
        scales, opacities = (_rows(columns["balls"][name], counts["vertices"]) for name in ("scale", "opacity"))
        for piece, scale, opacity in zip(elements, scales, opacities):
            piece["balls"] = {"scale": scale, "opacity": opacity}
    return elements


def _slices_of(columns):
    """Returns one dict per slice."""
    threes = [3] * len(columns["index"])
    properties = {name: columns[name] for name in ("index", "w", "label", "label_size", "focus", "drawn")}
    properties |= {name: [row.tolist() for row in _rows(columns[name], threes)] for name in ("position", "label_at")}
    slices = [dict(zip(properties, row)) | own for *row, own in zip(*properties.values(), _elements_of(columns))]
    if "fill" in columns:
        fill = columns["fill"]
        points, triangles = fill["counts"]["points"], fill["counts"]["triangles"]
        parts = {"points": _rows(fill["points"], points, 3), "triangles": _rows(fill["triangles"], triangles, 3)}
        parts |= {name: _rows(fill[name], triangles) for name in ("tints", "seen") if name in fill}
        for piece, row in zip(slices, zip(*parts.values())):
            if row[1]:
                piece["fill"] = dict(zip(parts, row))
    return slices
