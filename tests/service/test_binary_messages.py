"""Binary messages begin with the bytes that protocol/README.md lists, at the server and in the Python client."""

import itertools
import sys
from pathlib import Path

import pytest
from binary_kinds import BEGINNINGS, kind_of
from exports import TABLE, fetch_file
from harness import DEADLINE
from test_readers import slices_and_frame
from wire import BINARY_ENCODINGS

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402
from oval4d_client import BinaryMessageKind, Closed, connect, decode  # noqa: E402


def test_every_first_byte_belongs_to_one_kind_or_is_free():
    assert set(BEGINNINGS) == {"file", "frame", "free", *BINARY_ENCODINGS}
    listed = list(itertools.chain(*BEGINNINGS.values()))
    assert len(listed) == len(set(listed)) and max(map(len, listed)) <= 2
    assert {beginning for beginning in listed if len(beginning) == 1} == {bytes([first]) for first in range(256)}


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
async def test_slices_and_frames_begin_as_documented(server, encoding):
    slices, frame = await slices_and_frame(server, [], encoding)
    assert kind_of(slices) == encoding and kind_of(frame) == "frame"


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row["name"])
def test_files_begin_as_documented(server, row):
    shown = "formula=x%5E2%2By%5E2%2Bz%5E2%2Bw%5E2%3C1" if row.get("objects") == "fields" else "polytope=24-cell"
    assert kind_of(fetch_file(server, row["name"], shown)) == "file"


@pytest.mark.parametrize("text", [b'{"type":"Scene"}', b'{ "a":1}', b"{\n}", b"{}", b"{"])
def test_a_file_may_be_json(text):
    assert kind_of(text) == "file" and decode(text) == text


def test_the_python_client_knows_the_documented_kinds():
    def beginnings_of(kind):
        second = [] if kind.second_byte is None else [kind.second_byte]
        return [bytes([first, *second]) for first in kind.first_bytes]

    known = {name: beginnings_of(kind) for name, kind in oval4d_client.BINARY_KINDS.items()}
    assert known | {"free": BEGINNINGS["free"]} == BEGINNINGS


def test_the_python_client_looks_for_two_bytes_before_one(monkeypatch):
    monkeypatch.setitem(oval4d_client.BINARY_KINDS, "other", BinaryMessageKind(range(0x7E, 0x7F), lambda _: "other", 0x55))
    assert [decode(data) for data in (b"~U", b"~U~")] == ["other", "other"]
    assert [decode(data) for data in (b"~", b"~~U", b"U~")] == [b"~", b"~~U", b"U~"]


def test_the_python_client_refuses_other_binary_messages():
    for first in BEGINNINGS["free"]:
        says = f"begins with the byte 0x{first.hex()}: this client knows no such message"
        with pytest.raises(ValueError, match=says):
            decode(first + b"a")
    with pytest.raises(ValueError, match="is empty: this client knows no such message"):
        decode(b"")


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
def test_a_message_that_the_python_client_does_not_know_ends_the_connection(server, monkeypatch, encoding):
    monkeypatch.setattr(oval4d_client, "BINARY_KINDS", {})
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello(encoding=encoding)
        with pytest.raises(Closed, match="begins with the byte 0x..: this client knows no such message") as closed:
            oval.slices()
        assert closed.value.code == 1003


@pytest.mark.parametrize("encoding, package", [("cbor", "cbor2"), ("msgpack", "msgpack")])
def test_a_missing_package_ends_the_connection(server, monkeypatch, encoding, package):
    monkeypatch.setattr(oval4d_client, package, None)
    with connect(server.url, timeout=DEADLINE) as oval:
        oval.hello(encoding=encoding)
        with pytest.raises(Closed, match=f"needs python3-{package}"):
            oval.slices()
