"""Binary messages begin with the bytes that protocol/README.md lists, at the server and in the Python client."""

import itertools
import sys
from pathlib import Path

import pytest
from binary_kinds import FIRST_BYTES
from exports import TABLE, fetch_file
from harness import DEADLINE
from test_readers import slices_and_frame
from wire import BINARY_ENCODINGS

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "protocol/python"))
import oval4d_client  # noqa: E402
from oval4d_client import Closed, connect, decode  # noqa: E402


def test_every_first_byte_belongs_to_one_kind_or_is_free():
    assert set(FIRST_BYTES) == {"file", "frame", "free", *BINARY_ENCODINGS}
    assert sorted(itertools.chain(*FIRST_BYTES.values())) == list(range(256))


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
async def test_slices_and_frames_begin_as_documented(server, encoding):
    slices, frame = await slices_and_frame(server, [], encoding)
    assert slices[0] in FIRST_BYTES[encoding] and frame[0] in FIRST_BYTES["frame"]


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row["name"])
def test_files_begin_as_documented(server, row):
    shown = "formula=x%5E2%2By%5E2%2Bz%5E2%2Bw%5E2%3C1" if row.get("objects") == "fields" else "polytope=24-cell"
    assert fetch_file(server, row["name"], shown)[0] in FIRST_BYTES["file"]


def test_the_python_client_knows_the_documented_kinds():
    known = {name: list(first) for name, (first, _) in oval4d_client.BINARY_KINDS.items()}
    assert known | {"free": FIRST_BYTES["free"]} == FIRST_BYTES


def test_the_python_client_refuses_other_binary_messages():
    for first in FIRST_BYTES["free"]:
        with pytest.raises(ValueError, match=f"begins with the byte {first:#04x}: this client knows no such message"):
            decode(bytes([first, 0x61]))
    with pytest.raises(ValueError, match="is empty: this client knows no such message"):
        decode(b"")


@pytest.mark.parametrize("encoding", BINARY_ENCODINGS)
def test_a_message_that_the_python_client_does_not_know_ends_the_connection(server, monkeypatch, encoding):
    monkeypatch.delitem(oval4d_client.BINARY_KINDS, encoding)
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
