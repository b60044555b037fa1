"""A client of oval4d: exchanges messages with a server over a WebSocket.

    with connect("http://127.0.0.1:8080/") as oval:
        oval.hello()
        oval.set(polytope="24-cell")
        oval.rotate("xw,yz", 0.39, 1.42)
        open("24-cell.png", "wb").write(oval.frame(1280, 720))

../README.md specifies the messages and their members. request() sends any message. The other methods are for single
types of messages: they are shorter to call, or convert values. Needs python3-websockets (10 or later), python3-cbor2
for slices in CBOR, and python3-msgpack (1.0 or later) for slices in MessagePack. With python3-numpy, arrays can be
shown as fields, and the surfaces in slices are numpy arrays. A separate thread handles the socket. Therefore any thread
may call the client, and the connection stays open while a script is idle.

The package oval4d_messages beside this file has the types of messages. Only type checkers and editors need it.

This file is long, because the client is one file, so that a project can copy it.
"""

from __future__ import annotations

import array
import asyncio
import base64
import collections
import http.client
import io
import itertools
import json
import math
import operator
import os
import random
import re
import struct
import threading
import time
import warnings
from typing import TYPE_CHECKING, cast, overload
from urllib.parse import parse_qsl, quote, urlencode, urlsplit, urlunsplit

import websockets

try:
    import cbor2
except ImportError:
    cbor2 = None
try:
    import msgpack
except ImportError:
    msgpack = None
try:
    import numpy
except ImportError:
    numpy = None

if TYPE_CHECKING:
    from typing import Any, Literal, Optional, Union

    from oval4d_messages import (AnsweredByDone, At, CatalogueEntry, Critical, Done, ElementKind, ErrorMessage,
                                 Inside, KeyBinding, Measured, Pong, Request, Settings, State, Stream, Welcome)
    from typing_extensions import Unpack

SUBPROTOCOL = "oval4d.v1"
PNG = b"\x89PNG\r\n\x1a\n"
# The type codes of array.array for the typed arrays in slices messages. The keys are the CBOR tags of the typed arrays
# (RFC 8746); in MessagePack, the same numbers are extension types.
ARRAY_TYPES = {64: "B", 69: "H", 70: "I", 85: "f", 86: "d"}
# The type codes of array.array for numbers in BJData. The keys are the markers that precede the numbers.
BJDATA_TYPES = {b"i": "b", b"U": "B", b"I": "h", b"u": "H", b"l": "i", b"m": "I", b"L": "q", b"M": "Q", b"d": "f",
                b"D": "d"}
# The numpy types of the arrays that describe a surface. The keys are the names of the arrays.
SURFACE_TYPES = {"points": "f4", "normals": "f4", "triangles": "u4", "level": "u1", "cap": "u1", "colors": "u4",
                 "cap_colors": "u4"}
MAX_DATA = 1 << 20  # bytes: the file of a larger array is always uploaded by HTTP, never sent in a message
RECONNECT_CODES = {None, 1001, 1006, 1012, 1013}  # the client reconnects after these close codes; None: without a code
RETRY_ERRORS = {"later_version", "internal"}  # if hello is refused with these, the session exists: it is tried again


class Refused(Exception):
    """The server refused a request. `code` is one of ../errors.json or, after an upload, perhaps an HTTP status such as
    "502"."""

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


def _to_json(message):
    """Returns a message as JSON. Raises TypeError or ValueError if JSON cannot contain it."""
    def to_builtin(value):
        if hasattr(value, "tolist"):  # numpy's numbers and arrays
            listed = value.tolist()
            if not hasattr(listed, "tolist"):
                return listed
            if hasattr(listed, "is_integer"):  # numpy.longdouble, which tolist() does not convert
                return float(listed)
        raise TypeError(f"a message cannot contain {value!r}")

    try:
        text = json.dumps(message, allow_nan=False, ensure_ascii=False, default=to_builtin)
        text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise ValueError(f"a message cannot contain the lone surrogate {error.object[error.start]!r}") from None
    except ValueError as error:
        fault = "a list or dict that contains itself" if "Circular" in str(error) else "numbers that are not finite"
        raise ValueError(f"a message cannot contain {fault}: {message!r:.200}") from None
    return text


def connect(url: str = "http://127.0.0.1:8080/", session: Optional[str] = None, **options: Any) -> Client:
    """Connects to the server at `url` (http, https, ws or wss), and returns a Client. Opens the session that `session`
    names or, if it is None, the session to which `url` is a link. The page's button Share copies such links; hello()
    sends the token in the link. If there is neither, opens a new session. If the query of `url` describes a view, such
    as "?polytope=24-cell", hello() shows this view in a new session. The options are those of Client. Raises ValueError
    if the link to a session is damaged."""
    shared = dict(parse_qsl(urlsplit(url).fragment, keep_blank_values=True))
    if shared and not (shared.get("session") and shared.get("token")):
        raise ValueError("the link to a shared session is damaged: it must end in #session=…&token=…")
    session = session or shared.get("session")
    parts = urlsplit(url)
    # A token in the query is the one that the server requires of all clients. The token of a session is in the
    # fragment.
    access = [part for part in parts.query.split("&") if part.startswith("token=")]
    has_view = not session and len(access) < len([part for part in parts.query.split("&") if part])
    address = socket_url(urlunsplit(parts._replace(query="&".join(access))), session)
    return Client(address, token=shared.get("token"), view=parts.query if has_view else "", **options)


def socket_url(url: str, session: Optional[str] = None) -> str:
    """Returns the WebSocket URL for the URL of the page: http://host/prefix/?query → ws://host/prefix/ws?query. With a
    session, its path ends in /ws/session."""
    parts = urlsplit(url)
    scheme = {"http": "ws", "https": "wss"}.get(parts.scheme, parts.scheme)
    path = parts.path.rstrip("/") + "/ws" + (f"/{quote(session, safe='')}" if session else "")
    return urlunsplit((scheme, parts.netloc, path, parts.query, ""))


class Client:
    """A connection to one session. Every call waits at most `timeout` seconds. If `show` is true, pictures of the
    stream are acknowledged as soon as they arrive. `headers` are added to the HTTP request that opens the connection.
    `token` is the token of an existing session. `view` is the query of an address; the first hello() shows the view
    that the query describes.

    If the connection breaks, or a server that stops closes it, the client tries to reconnect for `timeout` seconds,
    with growing pauses. It also tries again if a server cannot open the session, for example because a later version of
    oval4d has stored the session. New calls wait in the meantime. A call that was in progress raises Closed, because it
    is unknown whether the call took effect."""

    def __init__(self, url, timeout=30, show=True, headers=None, token=None, view=""):
        self.timeout = timeout
        self._token = {} if token is None else {"token": token}
        self._view = view
        self.show = show
        self._url = url
        self._headers = headers
        self._hello = {}
        self._reconnecting = False
        self._closing = False
        # The newest message of each type and the newest frame; None before the first one arrives.
        self.welcome: Optional[Welcome] = None
        self.newest_state: Optional[State] = None
        self.newest_slices: Optional[dict[str, Any]] = None
        self.newest_frame: Optional[bytes] = None
        self.errors: list[ErrorMessage] = []  # error messages that do not answer a call
        self._live = None  # set by live(); called with each frame of the stream
        # The revision and the bytes of a frame, until the next message shows whether the frame answers a call or
        # belongs to the stream.
        self._held = None
        self.closed = None  # (code, reason) after the connection has ended for good
        self._ids = itertools.count(1)
        self._waiting = {}  # the calls in progress: from the id to the answer, or to None before the answer arrives
        self._wants_bytes = set()  # ids of calls whose answer is a binary message, followed by a done
        self._binary = None  # the bytes of the newest frame or file; they answer a call if its done follows
        self._change = threading.Condition()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        try:
            self._socket = asyncio.run_coroutine_threadsafe(self._open_socket(url, headers), self._loop).result()
        except BaseException:
            self._stop_loop()
            raise
        self._reader = asyncio.run_coroutine_threadsafe(self._run_connection(), self._loop)

    # Methods that send messages

    def hello(self, stream: Stream = "none", **members: Any) -> Welcome:
        """Sends the first message. `stream` is "geometry", "frames" or "none"; `members` may be width, height,
        encoding, scheme and token. Then shows the view of the address given to connect(), if there is one."""
        welcome = self.request("hello", stream=stream, **self._token | members)
        view, self._view = self._view, ""
        if view:
            self.open_address(view)
        return welcome

    def key(self, key: str, shift: bool = False, ctrl: bool = False) -> Done:
        return self.request("key", key=key, shift=shift, ctrl=ctrl)

    def rotate(self, planes: str, *angles: float) -> Done:
        """Rotates by one angle in radians for each plane: rotate("xw", 0.1) or rotate("xw,yz", 0.1, 0.2)."""
        return self.request("rotate", planes=planes.split(","), angles=list(angles))

    def toward(self, element: ElementKind, number: Optional[int] = None, immediately: bool = False) -> Done:
        """Turns a "vertex", "edge", "face" or "cell" toward +w: the one with this number or, if `number` is None, the
        closest one. If the closest one is already there, turns the next one. If `immediately` is true, the object jumps
        instead of turning step by step."""
        chosen = {} if number is None else {"number": number}
        return self.request("toward", element=element, immediately=immediately, **chosen)

    def set(self, **settings: Unpack[Settings]) -> Done:
        return self.request("set", **settings)

    def restore(self, source) -> Done:
        """Sets all settings to those of a state, but starts neither turning nor playing. `source` is the state as a
        dict, the path of a file, or the bytes of a file. The file is a picture by oval4d, which contains its state, or
        a state as JSON. Raises ValueError if `source` contains no state."""
        if isinstance(source, (str, os.PathLike)):
            with open(source, "rb") as file:
                source = file.read()
        try:
            state = source if isinstance(source, dict) else png_state(source) if source.startswith(PNG) else json.loads(source)
        except RecursionError:
            state = None
        if not isinstance(state, dict) or state.get("type") != "state":
            raise ValueError('not a state of oval4d, whose "type" is "state"')
        settings = {name: value for name, value in state.items() if name not in ("type", "id")}
        return self.request("set", **settings | {"turning": False, "playing": False})

    def open_address(self, query: str) -> Done:
        """Shows the view that the query of an address describes, such as "polytope=24-cell&rotate=xw:0.3"."""
        return self.request("address", query=query.removeprefix("?"))

    def address(self) -> str:
        """Returns the query of an address that opens the view of the session."""
        return self.get("address")["query"]

    def command(self, line: str) -> Done:
        return self.request("command", line=line)

    def load(self, name: str, data: str, format: str = "off", box=None, **members: Any) -> Done:
        """Loads an object and shows it. `data` is the text of a file, the Base64 text of an array file, or a formula;
        `format` says which. `box` is as in formula(). `members` are further members of the message `load`, such as
        axes."""
        domain = {} if box is None else {"box": [[float(low), float(high)] for low, high in box]}
        return self.request("load", name=name, data=data, format=format, **domain, **members)

    def formula(self, formula: str, box=None, levels=None, inside: Optional[Inside] = None, name: str = "formula",
                values: Optional[str] = None) -> Done:
        """Shows the field of a formula of x, y, z and w, such as "x^2+y^2+z^2-w < a; a=0.5". `box` is its domain: four
        pairs of numbers; without it, all coordinates are from -2 to 2. `levels` are up to four values at which surfaces
        are shown; without them, 0. `inside` says on which side of a level the body lies: "below" or "above"; without
        it, "below". `values` is a second formula, such as "a*x"; its values color the surfaces. One undo() reverts all
        this. Raises Refused if the server refuses the formula, the levels or `inside`. If it refuses only the levels or
        `inside`, the field is shown nevertheless."""
        colored = {} if values is None else {"values": values}
        return self._request_levels(self.load(name, formula, "formula", box, **colored), levels, inside)

    def field(self, name: str, array, axes: Optional[str] = None, spacing=None, origin=None, levels=None,
              inside: Optional[Inside] = None, values=None) -> Done:
        """Shows a numpy array of 1 to 4 dimensions as a field. `axes` names the axis of each index; t means w. Without
        it, an array of n dimensions has the last n axes of "tzyx". `spacing` is the distance between samples: a number,
        or four numbers along x, y, z and w. `origin` (four numbers) is the place of the first sample. Without both, the
        server chooses them. `levels` and `inside` are as in formula(), but without them, the level is in the middle of
        the values, and the inside is above. `values` colors the surfaces: another array of the same shape, or a formula
        of x, y, z and w in the units of the box. A numpy array does not state its units. Pictures name the units only
        if upload() reads them from a NetCDF, HDF5 or NIfTI file (see state())."""
        samples = _sample_array(array)
        axes = axes or "tzyx"[-samples.ndim :]
        box = None if spacing is None and origin is None else _box_of_array(samples.shape, axes, spacing, origin)
        return self._request_levels(self._send_array(name, samples, values, axes=axes, box=box), levels, inside)

    def append(self, name: str, array, axes: Optional[str] = None, values=None) -> Done:
        """Adds moments to the field `name`, after its last w, for example while a simulation runs. The numpy array is
        one moment with the axes "zyx", or several with the axes "tzyx". If the field has an array of `values`, the
        moments need one, too. The settings stay the same. undo() does not remove the moments."""
        samples = _sample_array(array)
        return self._send_array(name, samples, values, axes=axes or "tzyx"[-samples.ndim :], append=True)

    def upload(self, name: str, data, format: Optional[str] = None, axes: Optional[str] = None, box=None,
               variable: Optional[str] = None, append: bool = False, values: Optional[str] = None,
               values_variable: Optional[str] = None) -> Done:
        """Uploads an array file by HTTP, and shows its array as a field. `data` is the bytes of the file, or a file
        that is open in binary mode. `format` is "npy", "netcdf", "hdf5" or "nifti"; if it is None, the server detects
        it. `box` is as in formula(), and `axes` as in field(). `variable` names one of several arrays in the file. The
        formula `values`, or the array `values_variable` of the same file, colors the surfaces. If `append` is true,
        adds the moments in the file, as append() does. Raises Refused, also if the file is larger than the server
        accepts."""
        flat = None if box is None else ",".join(repr(float(end)) for side in box for end in side)
        query = {"format": format, "axes": axes, "box": flat, "variable": variable, "values": values,
                 "values_variable": values_variable}
        parts = urlsplit(self._url)
        path = re.sub(r"/ws(/[^/]*)?$", "", parts.path) + "/api/v1/sessions/" + quote(self.welcome["session"], safe="")
        path += "/fields/" + quote(name, safe="") + ("/moments" if append else "")
        query = "&".join(filter(None, [parts.query, urlencode({k: v for k, v in query.items() if v}, quote_via=quote)]))
        size = len(data) if isinstance(data, (bytes, bytearray, memoryview)) else data.seek(0, io.SEEK_END)
        if size > self.welcome["limits"]["upload"]:  # otherwise the server would close the connection during the upload
            raise Refused("too_large", f"the server accepts files of at most {self.welcome['limits']['upload']} bytes")
        if hasattr(data, "seek"):
            data.seek(0)
        kind = http.client.HTTPSConnection if parts.scheme in ("wss", "https") else http.client.HTTPConnection
        connection = kind(parts.hostname, parts.port, timeout=self.timeout)
        try:
            headers = {**dict(self._headers or {}), "Session-Token": self.welcome["token"], "Content-Length": str(size)}
            connection.request("POST" if append else "PUT", f"{path}?{query}", data, headers)
            answer = connection.getresponse()
            text = answer.read().decode(errors="replace")
        finally:
            connection.close()
        media = (answer.getheader("Content-Type") or "").partition(";")[0]
        message = json.loads(text) if media == "application/json" else None
        if isinstance(message, dict) and message.get("type") == "error":
            raise Refused(message["code"], message["message"])
        if answer.status != 200 or message is None:
            reason = text.strip() if media == "text/plain" else answer.reason  # an HTML page of a proxy is not quoted
            if answer.status == 413:
                reason += f": the server accepts files of at most {self.welcome['limits']['upload']} bytes"
            raise Refused(str(answer.status), reason)
        return message

    def _request_levels(self, done, levels, inside):
        settings = {} if levels is None else {"levels": [float(level) for level in levels]}
        settings |= {} if inside is None else {"inside": inside}
        return self.request("set", continues=True, **settings) if settings else done

    def _send_array(self, name, samples, values=None, box=None, **members):
        format = "npy"
        if values is None or isinstance(values, str):
            file = io.BytesIO()
            numpy.save(file, samples, allow_pickle=False)
            data = file.getvalue()
            members |= {} if values is None else {"values": values}
        else:
            format, data = "netcdf", _netcdf_file({"field": samples, "values": _sample_array(values)})
            members |= {"variable": "field", "values_variable": "values"}
        if len(data) > MAX_DATA or 4 * len(data) > 2 * self.welcome["limits"]["message"]:
            return self.upload(name, data, format, box=box, **members)
        return self.load(name, base64.b64encode(data).decode(), format, box, **members)

    def undo(self) -> Done:
        return self.request("undo")

    def redo(self) -> Done:
        return self.request("redo")

    def reset(self) -> Done:
        return self.request("reset")

    def get(self, what: str, width: Optional[int] = None, height: Optional[int] = None,
            background: Optional[str] = None) -> Any:
        size = {} if width is None else {"width": width, "height": height}
        ground = {} if background is None else {"background": background}
        return self.request("get", what=what, **size, **ground)

    def state(self) -> State:
        """Returns a state message. If a field comes from a file that states units, state()["field"] has "units", the
        units of the axes, such as {"x": "m", "w": "s"}, and "quantity", what the values measure, such as {"name":
        "temperature", "unit": "K"}. What the file does not state is absent:

            unit = oval.state()["field"].get("quantity", {}).get("unit", "")"""
        return self.get("state")

    def slices(self, width: Optional[int] = None, height: Optional[int] = None,
               background: Optional[str] = None) -> dict[str, Any]:
        """Returns a slices message. A slice of a field has a "surface" if its hyperplane meets one. In the surface,
        "points", "normals" and "triangles" are numpy arrays of shape (n, 3), and "level", "cap", "colors" and
        "cap_colors" are numpy arrays of shape (n,); without numpy, all are lists. The triangles are triples of points,
        counterclockwise as seen from outside; the triangles of each level form a closed surface. If the field has fog,
        the slice has a "fog": its "values" are a numpy array with the indices z, y, x; without numpy, they are bytes
        with x fastest."""
        return self.get("slices", width, height, background)

    def frame(self, width: Optional[int] = None, height: Optional[int] = None,
              background: Optional[str] = None) -> bytes:
        """Returns a picture as the bytes of a PNG file. `width` and `height` are in pixels; without them, the size in
        hello() applies. `background` is "dark", "light", "white" or "transparent"; if it is None, the background of the
        session applies."""
        return self.get("frame", width, height, background)

    def _repr_png_(self):
        """Shows the picture in a notebook."""
        return self.frame(960, 540)

    def live(self, width: int = 960, height: int = 540) -> None:
        """Shows the picture in a notebook, and renews it after every change of the session: by this script, on the
        page, or by other clients. The stream is then "frames". Needs IPython, which every notebook has. Raises
        RuntimeError outside of a notebook."""
        from IPython.display import Image, display

        def as_image(png):
            return Image(data=png, format="png", width=width, height=height)

        self._live = None
        kept = {name: value for name, value in self._hello.items() if name in ("scheme", "encoding")}
        self.hello("frames", width=width, height=height, **kept)
        handle = display(as_image(self.frame(width, height)), display_id=True)
        if handle is None:
            raise RuntimeError("live() shows its picture in a notebook, and this is none")
        self._live = lambda png: handle.update(as_image(png))

    def at(self, x: float, y: float, width: Optional[int] = None, height: Optional[int] = None) -> At:
        """Returns what the picture shows at the point (x, y), in pixels from the upper left corner. `width` and
        `height` are the size of the picture in pixels; without them, the size in hello() applies."""
        size = {} if width is None else {"width": width, "height": height}
        return self.request("get", what="at", x=x, y=y, **size)

    def file(self, format: str, **members: Any) -> bytes:
        """Returns the bytes of an exported file. `format` is "stl", "3mf", …; `members` may be of, body, size, label,
        at, fit and exact, as in the message `get`. Issues a UserWarning for what the file lacks, such as empty
        slices."""
        return self.request("get", what="file", format=format, **members)

    def critical(self) -> Critical:
        """Returns the critical message: the values of w at which the section by the hyperplane w changes its type. Its
        "sections", in the order of w, have "w" and "change"; those of a field also have "level", and "components",
        "cavities" and "euler" of the body below and above w. For a field, the search may take seconds."""
        return self.get("critical")

    def catalogue(self) -> list[CatalogueEntry]:
        return self.get("catalogue")["polytopes"]

    def keymap(self) -> list[KeyBinding]:
        return self.get("keymap")["keys"]

    def ping(self) -> Pong:
        """Returns a pong: how busy the server is. Its members are in protocol/README.md."""
        return self.request("ping")

    def shown(self, revision: int) -> None:
        """Tells the server that the picture of this revision has been presented."""
        self.send({"type": "shown", "revision": revision})

    def wait(self, revision: int, timeout: Optional[float] = None) -> State:
        """Waits for the picture of this revision or of a later one, or for the state if the stream is "none". A picture
        that is only a draft of a field does not count. Returns the newest state. Raises TimeoutError after `timeout`
        seconds (if `timeout` is None, the client's own applies), and Closed if the connection has ended."""

        def arrived():
            newest = {"geometry": self.newest_slices, "frames": self.newest_frame and png_state(self.newest_frame)}
            message = newest.get(self._stream, self.newest_state)
            return message is not None and message["revision"] >= revision and "draft" not in message

        self._wait_for(arrived, timeout, f"revision {revision}")
        return cast("State", self.newest_state)  # the server sends a state before its picture

    # Sending and receiving

    @overload
    def request(self, type: Literal["hello"], **members: Any) -> Welcome: ...
    @overload
    def request(self, type: Literal["measure"], **members: Any) -> Measured: ...
    @overload
    def request(self, type: Literal["ping"], **members: Any) -> Pong: ...
    @overload
    def request(self, type: AnsweredByDone, **members: Any) -> Done: ...
    @overload
    def request(self, type: str, **members: Any) -> Any: ...

    def request(self, type: str, **members: Any) -> Any:
        """Sends a message of any type with an id, and returns the answer. Raises Refused if the answer is an error,
        Closed if the connection ends, and TimeoutError if no answer arrives."""
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
        if isinstance(answer, tuple):
            answer, lacks = answer
            for text in lacks:
                warnings.warn(text, stacklevel=3)  # the warning names the line that called file()
        return answer

    def send(self, message: Union[Request, dict[str, Any], str, bytes]) -> None:
        """Sends a message without an id, and does not wait for an answer. A dict is sent as JSON, in which numpy's
        numbers and arrays become numbers and lists; text and bytes are sent unchanged. Raises ValueError if JSON cannot
        contain the dict, because it has numbers that are not finite or text that is not Unicode."""
        if isinstance(message, dict):
            message = _to_json(message)
        self._wait_for(lambda: not self._reconnecting, None, "the server")
        try:
            self._run_coroutine(self._socket.send(message))
        except websockets.ConnectionClosed:
            raise Closed(self._socket.close_code, self._socket.close_reason or "") from None

    def close(self) -> None:
        self._closing = True
        if self._loop.is_running():
            self._run_coroutine(self._socket.close())
            self._reader.result(self.timeout)
            self._stop_loop()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_):
        self.close()

    _stream = "none"

    async def _open_socket(self, url, headers):
        options = {"subprotocols": [SUBPROTOCOL], "max_size": None, "compression": None, "open_timeout": self.timeout}
        version = int(websockets.__version__.split(".")[0])
        if version >= 15:
            options["proxy"] = None
        if headers:
            options["additional_headers" if version >= 14 else "extra_headers"] = headers
        return await websockets.connect(url, **options)

    async def _run_connection(self):
        while True:
            unreadable = None
            try:
                async for message in self._socket:
                    pictures = self._handle_message(message)
                    for _, picture in pictures:
                        self._pass_to_live(picture)
                    if pictures and self.show:
                        await self._socket.send(json.dumps({"type": "shown", "revision": pictures[-1][0]}))
            except websockets.ConnectionClosed:
                pass
            except (ImportError, ValueError) as fault:  # this client cannot decode the message
                unreadable = fault
                await self._socket.close(1003)
            end = (self._socket.close_code, self._socket.close_reason or "")
            if unreadable:
                end = (1003, str(unreadable))
            again = self.welcome is not None and end[0] in RECONNECT_CODES and not self._closing
            with self._change:
                for number, answer in self._waiting.items():
                    self._waiting[number] = answer or Closed(*end)
                self._reconnecting = again
                self.closed = None if again else end
                self._change.notify_all()
            if not again or not await self._reconnect(end):
                return

    async def _reconnect(self, end):
        """Reconnects to the session, on any server that answers at the URL. Returns whether the connection is open
        again. `end` is the close code and the reason of the last connection."""
        last = time.monotonic() + self.timeout
        pause = 0.1
        parts = urlsplit(self._url)
        path = re.sub(r"/ws(/[^/]*)?$", "/ws/" + self.welcome["session"], parts.path)
        url = urlunsplit((parts.scheme, parts.netloc, path, parts.query, ""))
        while not self._closing and time.monotonic() < last:
            await asyncio.sleep(pause * (0.5 + random.random()))
            pause = min(2 * pause, 5)
            try:
                self._socket = await self._open_socket(url, self._headers)
                if self._closing:
                    await self._socket.close()
                    break
                await self._socket.send(json.dumps({**self._hello, "type": "hello", "token": self.welcome["token"]}))
                answer = await asyncio.wait_for(self._socket.recv(), max(0.0, last - time.monotonic()))
            except (OSError, websockets.WebSocketException, asyncio.TimeoutError):
                continue
            refusal = json.loads(answer) if isinstance(answer, str) else {}
            if refusal.get("type") == "error" and refusal["code"] in RETRY_ERRORS:
                end = (1013, refusal["message"])
                await self._socket.close()
                continue
            self._handle_message(answer)
            with self._change:
                self._reconnecting = False
                self._change.notify_all()
            return True
        with self._change:
            self._reconnecting = False
            self.closed = end
            self._change.notify_all()
        return False

    def _handle_message(self, data):
        """Handles a message. Returns the pictures that are now known to belong to the stream, each with its revision. A
        frame that arrives while a call waits for bytes belongs to the stream, unless the done of the call follows."""
        with self._change:
            message = decode(data)
            held, self._held = self._held, None
            pictures = [] if held is None else [held]
            if isinstance(message, bytes):
                self._binary = message
                if message[0] == PNG[0]:  # a frame, not a file
                    self.newest_frame = message
                    picture = (png_state(message)["revision"], message)
                    if self._wants_bytes:
                        self._held = picture
                    else:
                        pictures.append(picture)
            else:
                kind, number = message["type"], message.get("id")
                if kind == "slices" and number is None:
                    pictures.append((message["revision"], message))
                if kind in ("welcome", "state", "slices"):
                    setattr(self, "welcome" if kind == "welcome" else "newest_" + kind, message)
                if number in self._waiting:
                    framed = kind == "done" and number in self._wants_bytes
                    # The call may still be pending in another thread, but the next frame does not answer it.
                    self._wants_bytes.discard(number)
                    if framed:
                        pictures.clear()
                    self._waiting[number] = (self._binary, message.get("warnings", [])) if framed else message
                elif kind == "error":
                    self.errors.append(message)
            self._change.notify_all()
        return pictures

    def _pass_to_live(self, picture):
        """Passes a picture of the stream, if the picture is a frame, to the function that live() has set."""
        try:
            if self._live and isinstance(picture, bytes):
                self._live(picture)
        except Exception:  # the notebook may have been closed; the session goes on
            self._live = None

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

    def _run_coroutine(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(self.timeout)

    def _stop_loop(self):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(self.timeout)
        self._loop.close()


def _sample_array(values):
    """Returns the values as a numpy array. Floats of more than 32 bits become float32, in which the server computes.
    Masked values become NaN; an array that has some is converted to float32."""
    if numpy is None:
        raise ImportError("arrays need python3-numpy")
    if numpy.ma.is_masked(values):
        values = values.astype("f4").filled(numpy.nan)
    values = numpy.asarray(values)
    return values.astype("f4") if values.dtype.kind == "f" and values.dtype.itemsize > 4 else values


def _netcdf_file(arrays):
    """Returns a NetCDF file (classic, with 64-bit offsets) that contains these arrays as float32. `arrays` is a dict of
    numpy arrays by name. Raises ValueError if their shapes differ."""
    shape = next(iter(arrays.values())).shape
    if any(values.shape != shape for values in arrays.values()):
        raise ValueError("the arrays must have the same shape")

    def padded_name(name):
        return struct.pack(">i", len(name)) + name.encode() + bytes(-len(name) % 4)

    def tagged_list(tag, items):
        return struct.pack(">ii", tag, len(items)) + b"".join(items)

    data = [values.astype(">f4").tobytes() for values in arrays.values()]
    absent, number, dimension, variable = bytes(8), 5, 10, 11  # codes of the NetCDF format: an empty list, float32, two lists

    def header(begin):
        dimensions = [padded_name(f"d{i}") + struct.pack(">i", size) for i, size in enumerate(shape)]
        variables = []
        for name, bytes_of in zip(arrays, data):
            places = struct.pack(f">i{len(shape)}i", len(shape), *range(len(shape)))
            size = min(len(bytes_of), 0xFFFFFFFC)
            variables.append(padded_name(name) + places + absent + struct.pack(">iIq", number, size, begin))
            begin += len(bytes_of)
        return b"CDF\x02" + bytes(4) + tagged_list(dimension, dimensions) + absent + tagged_list(variable, variables)

    return header(len(header(0))) + b"".join(data)


def _box_of_array(shape, axes, spacing, origin):
    """Returns the box of an array, a pair of ends for each of x, y, z and w. Both ends are equal along an axis that the
    array does not have."""
    spacing = (1 if spacing is None else spacing,) * 4 if spacing is None or numpy.isscalar(spacing) else spacing
    sizes = dict(zip(axes.replace("t", "w"), shape))
    lows = (0, 0, 0, 0) if origin is None else origin
    return [(low, low + step * (sizes.get(axis, 1) - 1)) for axis, low, step in zip("xyzw", lows, spacing)]


def png_state(png: bytes) -> dict[str, Any]:
    """Returns the state that a PNG file by oval4d contains in an iTXt chunk. restore() shows it again. Raises
    ValueError if the bytes are not a PNG file with a state."""
    at = len(PNG) if png.startswith(PNG) else len(png)
    while at + 12 <= len(png):
        size, kind = struct.unpack_from(">I4s", png, at)
        text = png[at + 8 : at + 8 + size]
        if kind == b"iTXt" and text.startswith(b"oval4d\0"):
            try:
                # Before the text come the keyword, two flags, the language and the translated keyword.
                state = json.loads(text.split(b"\0", 5)[-1])
            except RecursionError:
                break
            if isinstance(state, dict):
                return state
        at += size + 12
    raise ValueError("not an oval4d frame: it contains no state")


def decode(data):
    """Decodes a message from the server. Returns a dict for text and for slices, as from_json(), from_cbor(),
    from_msgpack() and from_bjdata() do, and the unchanged bytes for frames and files. Raises ValueError if no kind of
    binary message begins as the bytes do, or if the bytes are not a message of their kind."""
    if isinstance(data, str):
        return from_json(data)
    # Kinds that are recognized by two bytes are tried before kinds that are recognized by one.
    for kind in sorted(BINARY_KINDS.values(), key=lambda kind: kind.second_byte is None):
        if data and data[0] in kind.first_bytes and kind.second_byte in (None, *data[1:2]):
            return kind.read(data)
    what = f"begins with the byte {data[0]:#04x}" if data else "is empty"
    raise ValueError(f"a binary message {what}: this client knows no such message")


def from_json(text):
    """Returns a JSON message as a dict. The surfaces and the fog of a slices message are as slices() describes them."""
    message = json.loads(text)
    if isinstance(message, dict) and message.get("type") == "slices":
        for piece in message["slices"]:
            if "surface" in piece and numpy is not None:
                piece["surface"] = {name: numpy.array(value, SURFACE_TYPES[name]) if name in SURFACE_TYPES else value
                                    for name, value in piece["surface"].items()}
            if "fog" in piece:
                fog = piece["fog"]
                fog["values"] = _fog_values_as_array(bytes(itertools.chain(*fog["values"])), fog["size"])
    return message


def from_cbor(data):
    """Decodes a slices message in CBOR to a dict, with one dict per slice. Typed arrays become array.array of floats or
    integers; surfaces and fog are as slices() describes them. Raises ValueError if the bytes are not such a message."""
    if cbor2 is None:
        raise ImportError("decoding slices in CBOR needs python3-cbor2")

    def decode_typed_array(_, tag):
        kind = ARRAY_TYPES.get(tag.tag)
        return tag if kind is None else array.array(kind, tag.value)

    return _decode_slices("CBOR", lambda: cbor2.loads(data, tag_hook=decode_typed_array), cbor2.CBORDecodeError)


def from_msgpack(data):
    """Decodes a slices message in MessagePack, with the same result as from_cbor()."""
    if msgpack is None:
        raise ImportError("decoding slices in MessagePack needs python3-msgpack")

    def decode_typed_array(code, content):
        kind = ARRAY_TYPES.get(code)
        return msgpack.ExtType(code, content) if kind is None else array.array(kind, content)

    return _decode_slices("MessagePack", lambda: msgpack.unpackb(data, ext_hook=decode_typed_array),
                          msgpack.UnpackException)


def from_bjdata(data):
    """Decodes a slices message in BJData, with the same result as from_cbor(). Reads the part of BJData that the server
    writes (../README.md, "BJData"), and needs no package for that."""
    at = 0

    def take(size):
        nonlocal at
        if not 0 <= size <= len(data) - at:
            raise ValueError("it is cut off")
        at += size
        return data[at - size : at]

    def number(marker):
        layout = "<" + BJDATA_TYPES[marker]
        return struct.unpack(layout, take(struct.calcsize(layout)))[0]

    def text(marker_of_length):
        return take(number(marker_of_length)).decode()

    def typed_array():
        values = array.array(BJDATA_TYPES[take(1)])
        if take(1) != b"#":
            raise ValueError("a typed array has no count")
        values.frombytes(take(values.itemsize * number(take(1))))
        return values

    def value(marker):
        if marker == b"{":
            members = {}
            while (marker := take(1)) != b"}":
                name = text(marker)
                members[name] = value(take(1))
            return members
        if marker == b"[":
            marker = take(1)
            if marker == b"$":
                return typed_array()
            items = []
            while marker != b"]":
                items.append(value(marker))
                marker = take(1)
            return items
        if marker == b"S":
            return text(take(1))
        return marker == b"T" if marker in (b"T", b"F") else number(marker)

    def whole_message():
        message = value(take(1))
        if at < len(data):
            raise ValueError("there are bytes after its end")
        return message

    return _decode_slices("BJData", whole_message, ValueError)


def _decode_slices(encoding, read, failure):
    """Returns the slices message that read() decodes, with one dict per slice. Raises a ValueError that names the
    encoding if read() decodes no such message. `failure` is the exception by which read() itself reports a fault."""
    try:
        message = read()
        message["slices"] = _slices_of(message["slices"])
        if "projection" in message:
            parts = message["projection"]["parts"]
            message["projection"]["parts"] = [look | own for look, own in zip(parts["looks"], _elements_of(parts))]
    except (failure, ArithmeticError, AttributeError, LookupError, MemoryError, RecursionError, TypeError) as fault:
        raise ValueError(f"not a slices message in {encoding}: {fault}") from fault
    return message


# A kind of binary message: the possible first bytes, the function that decodes a message and, if two bytes identify the
# kind, the second byte.
BinaryMessageKind = collections.namedtuple("BinaryMessageKind", "first_bytes read second_byte", defaults=[None])

# The kinds of binary messages by name (see "Binary messages" in ../README.md). Each encoding of slices is a kind with
# its own name.
BINARY_KINDS = {"file": BinaryMessageKind(range(0x21, 0x7F), bytes),
                "frame": BinaryMessageKind(range(0x89, 0x8A), bytes),
                "cbor": BinaryMessageKind(range(0xA0, 0xC0), from_cbor),
                "msgpack": BinaryMessageKind(range(0xDF, 0xE0), from_msgpack),
                "bjdata": BinaryMessageKind(range(0x7B, 0x7C), from_bjdata, second_byte=0x55)}


def _split_by_sizes(flat, sizes, width=1):
    """Splits an array into consecutive parts. Part i has sizes[i] items, and each item has `width` numbers."""
    ends = list(itertools.accumulate(sizes, initial=0))
    return [flat[width * begin : width * end] for begin, end in zip(ends, ends[1:])]


def _elements_of(columns):
    """Returns one dict per slice, or per part of the projection, with its elements. `columns` has one array per
    property, with the values of all slices or parts."""
    counts = columns["counts"]

    def elements_of_lists(lists):
        rows = [_split_by_sizes(lists[name], counts[name]) for name in lists]
        return [dict(zip(lists, row)) for row in zip(*rows)]

    sides = _split_by_sizes(columns["sides"], counts["faces"])
    properties = {"vertices": _split_by_sizes(columns["vertices"], counts["vertices"], 3),
                  "edges": _split_by_sizes(columns["edges"], counts["edges"], 2)}
    properties["faces"] = [{"begin": array.array("I", itertools.accumulate(own, initial=0)), "corners": corners}
                           for own, corners in zip(sides, _split_by_sizes(columns["corners"], map(sum, sides)))]
    properties["of"] = elements_of_lists(columns["of"])
    if "seen" in columns:
        properties["seen"] = elements_of_lists(columns["seen"])
    elements = [dict(zip(properties, row)) for row in zip(*properties.values())]
    if "tints" in columns:
        for piece, tints in zip(elements, _split_by_sizes(columns["tints"], counts["faces"])):
            if tints != piece["of"]["faces"]:
                piece["tints"] = tints
    if "balls" in columns:
        scales, opacities = (_split_by_sizes(columns["balls"][name], counts["vertices"]) for name in ("scale", "opacity"))
        for piece, scale, opacity in zip(elements, scales, opacities):
            piece["balls"] = {"scale": scale, "opacity": opacity}
    if "fill" in columns:
        fill = columns["fill"]
        points, triangles = fill["counts"]["points"], fill["counts"]["triangles"]
        parts = {"points": _split_by_sizes(fill["points"], points, 3), "triangles": _split_by_sizes(fill["triangles"], triangles, 3)}
        parts |= {name: _split_by_sizes(fill[name], triangles) for name in ("tints", "seen") if name in fill}
        for piece, row in zip(elements, zip(*parts.values())):
            if row[1]:
                piece["fill"] = dict(zip(parts, row))
    return elements


def _slices_of(columns):
    """Returns one dict per slice. `columns` has one array per property, with the values of all slices."""
    threes = [3] * len(columns["index"])
    properties = {name: columns[name] for name in ("index", "w", "label", "label_size", "focus", "drawn")}
    properties |= {name: [row.tolist() for row in _split_by_sizes(columns[name], threes)] for name in ("position", "label_at")}
    slices = [dict(zip(properties, row)) | own for *row, own in zip(*properties.values(), _elements_of(columns))]
    if "surface" in columns:
        for piece, surface in zip(slices, _surfaces_of(columns["surface"])):
            if len(surface["triangles"]):
                piece["surface"] = surface
    if "fog" in columns:
        for piece, fog in zip(slices, _fogs_of(columns["fog"])):
            if len(fog["values"]):
                piece["fog"] = fog
    return slices


def _fogs_of(columns):
    """Returns the fog of each slice as a dict. `columns` has one array per property, with the values of all slices."""
    sizes = _split_by_sizes(columns["size"], [1] * len(columns["step"]), 3)
    walls = _split_by_sizes(columns["walls"], columns["counts"]["walls"], 4)
    values = _split_by_sizes(columns["values"], [math.prod(map(operator.index, size)) for size in sizes])
    minima = _split_by_sizes(columns["min"], [1] * len(sizes), 3)
    return [{"size": size.tolist(), "min": least.tolist(), "step": step,
             "walls": [own[i : i + 4].tolist() for i in range(0, len(own), 4)], "values": _fog_values_as_array(row, size)}
            for size, least, step, own, row in zip(sizes, minima, columns["step"], walls, values)]


def _fog_values_as_array(values, size):
    """Returns the values of fog, whose x varies fastest, in the form that slices() describes."""
    if numpy is not None:
        return numpy.frombuffer(bytearray(values), numpy.uint8).reshape(tuple(reversed(size)))
    return bytes(values)


def _surfaces_of(columns):
    """Returns the surface of each slice as a dict. `columns` has one array per property, with the values of all
    slices."""
    counts = columns["counts"]

    def shaped(flat, name, width):
        if numpy is not None:
            values = numpy.array(flat, SURFACE_TYPES[name])
            return values if width == 1 else values.reshape(-1, width)
        return list(flat) if width == 1 else [list(flat[i : i + width]) for i in range(0, len(flat), width)]

    surfaces = {"color": columns["color"]} if "color" in columns else {}
    for name, of, width in (("points", "points", 3), ("normals", "points", 3), ("triangles", "triangles", 3),
                            ("level", "triangles", 1), ("cap", "triangles", 1), ("colors", "points", 1),
                            ("cap_colors", "points", 1)):
        if name in columns:
            surfaces[name] = [shaped(row, name, width) for row in _split_by_sizes(columns[name], counts[of], width)]
    return [dict(zip(surfaces, row)) for row in zip(*surfaces.values())]
