"""The Python and TypeScript clients refuse damaged messages as documented, without much memory."""

import json
import random
import resource
import subprocess
import sys
from pathlib import Path

import cbor2
import pytest
from harness import DEADLINE
from wire import BINARY_ENCODINGS, ENCODINGS, connect

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "protocol/python"))
from oval4d_client import BINARY_KINDS, png_state  # noqa: E402

# The functions of the Python client that read binary data. The keys are the suffixes of the files that write_messages()
# makes.
READERS = {encoding: BINARY_KINDS[encoding].read for encoding in BINARY_ENCODINGS} | {"png": png_state}

# States whose messages together have all members: tints, hidden and faded cells, crossing faces, a density strip, and
# surfaces of a field.
STATES = [[], ["polytope 8-cell"], ["polytope 5,7-duoprism", "rotate xw 0.5", "hide 0", "fade 1"],
          ["polytope 5/2,5-duoprism", "rotate xw,yz 0.3 0.1", "fade 0"], ["polytope 120-cell", "set slices=1"],
          ["formula x*y < z - w", "set slices=3 color=growth"]]


async def slices_and_frame(server, lines, encoding):
    """Returns a `slices` message and a frame of the state that these commands produce, as received."""
    async with connect(server) as socket:
        await socket.send(json.dumps({"type": "hello", "encoding": encoding}))
        for line in lines:
            await socket.send(json.dumps({"type": "command", "line": line}))
        await socket.send(json.dumps({"type": "get", "id": 1, "what": "slices", "width": 640, "height": 360}))
        await socket.send(json.dumps({"type": "get", "id": 2, "what": "frame", "width": 64, "height": 48}))
        slices = frame = None
        while slices is None or frame is None:
            message = await socket.recv()
            if isinstance(message, bytes) and message.startswith(b"\x89PNG"):
                frame = message
            elif isinstance(message, bytes) or '"slices","id":1' in message[:40]:
                slices = message
        return slices if isinstance(slices, bytes) else slices.encode(), frame


@pytest.fixture(scope="module")
def message_folder(tmp_path_factory):
    """Returns a folder for messages in each state and format; the first test fills it."""
    return tmp_path_factory.mktemp("messages")


async def write_messages(server, folder):
    if any(folder.glob("*.json")):
        return
    for number, lines in enumerate(STATES):
        for encoding in ENCODINGS:
            slices, frame = await slices_and_frame(server, lines, encoding)
            (folder / f"{number}.{encoding}").write_bytes(slices)
        (folder / f"{number}.png").write_bytes(frame)
    (folder / "query.link").write_text("?polytope=24-cell&rotate=xw,yz:pi/8,0.2&slices=31&view=%C3%B6&token=x%20y")


def damaged_copy(data, rng):
    """Returns a copy with some bytes changed, removed, repeated, or set to large values."""
    out = bytearray(data)
    for _ in range(1 + rng.randrange(4)):
        at, some = rng.randrange(len(out) + 1), 1 + rng.randrange(16)
        kind = rng.randrange(5)
        if kind == 0:
            out[at:at + 1] = bytes([rng.randrange(256)])
        elif kind == 1:
            out[at:at + 1] = bytes(byte ^ 1 << rng.randrange(8) for byte in out[at:at + 1])
        elif kind == 2:
            del out[at:at + some]
        elif kind == 3:
            out[at:at] = out[at:at + some]
        else:
            out[at:at + some] = b"\xff" * len(out[at:at + some])
        if rng.randrange(16) == 0:
            del out[at:]
    return bytes(out)


@pytest.mark.release_only
async def test_the_python_client_reads_or_refuses_damaged_messages(server, message_folder):
    await write_messages(server, message_folder)
    rng = random.Random(11)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for kind, read in READERS.items():
        refused = 0
        for file in sorted(message_folder.glob(f"*.{kind}")):
            whole = file.read_bytes()
            assert read(whole)["revision"] == len(STATES[int(file.stem)])
            for _ in range(600):
                data = damaged_copy(whole, rng)
                try:
                    assert isinstance(read(data), dict)
                except ValueError:
                    refused += 1
        assert refused > 100, f"few damaged {kind} messages were refused"
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert grown < 300_000, f"reading took {grown} KiB"


@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n", b"\x81" * 100_000, b"\xa1" * 1000,
                                  b"\x9b" + b"\x7f" * 8, b"\xbb" + b"\x7f" * 8, b"\x5b" + b"\x7f" * 8, b"\xd8\x55\x43abc",
                                  b"\xc4\x82\x1b" + b"\x7f" * 8 + b"\x01", b"\xa1\x66slices\xa0",
                                  b"\xa1\x66slices\xa1\x66counts\xf6", b"\xdf" + b"\x7f" * 4, b"\xdd" * 1000,
                                  b"\xc7\x03\x55abc", b"\xdf\0\0\0\x01\xa6slices\x80",
                                  b"{", b"{i\xff", b"[Si\xfd", b"{U\x01aN}", b"{d" + bytes(4) + b"T}", b"[" * 1000, b"[$",
                                  b"[$S#U\x01a", b"[$d$U\x01abcd", b"[$d#M" + b"\xff" * 8, b"[$d#U\x02abcdefg",
                                  b"{U\x06slices{}}", b"{U\x06slices{U\x06countsF}}", b"{}{}"])
def test_the_python_client_refuses_invalid_data_with_value_error(data):
    for read in READERS.values():
        with pytest.raises(ValueError):
            read(data)
    text = b"[" * 50_000
    with pytest.raises(ValueError):  # nested more deeply than the stack of a recursive reader allows
        png_state(b"\x89PNG\r\n\x1a\n" + len(text + b"oval4d" + bytes(5)).to_bytes(4, "big") + b"iTXtoval4d" + bytes(5) + text + bytes(4))


def test_the_python_client_refuses_a_text_as_the_size_of_fog():
    columns = dict.fromkeys(("index", "w", "label", "label_size", "focus", "drawn", "position", "label_at", "sides",
                             "vertices", "edges", "corners"), [])
    columns["counts"] = columns["of"] = {kind: [] for kind in ("vertices", "edges", "faces")}
    size = ["a" * 1000, 10_000, 10_000]  # the product would be a text of 100 GB
    columns["fog"] = {"size": size, "min": [0, 0, 0], "step": [1], "walls": [], "counts": {"walls": [0]}, "values": []}
    with pytest.raises(ValueError, match="interpreted as an integer"):
        READERS["cbor"](cbor2.dumps({"type": "slices", "slices": columns}))


@pytest.mark.release_only
async def test_the_typescript_client_reads_or_refuses_damaged_messages(server, message_folder):
    await write_messages(server, message_folder)
    counts = read_damaged(message_folder)
    assert set(counts) == {*ENCODINGS, "png", "link"}
    assert all(counts[encoding]["refused"] > 200 for encoding in ENCODINGS) and counts["link"]["refused"] == 0


def read_damaged(message_folder):
    """Lets the TypeScript client read damaged copies of the messages in the folder; returns what happened, by format."""
    modules = ROOT / "web_client/node_modules"
    entry = message_folder / "readers.ts"
    entry.write_text("".join(f'export * from "{ROOT / file}";\n' for file in
                             ("protocol/ts/arena.ts", "protocol/ts/decode.ts", "web_client/src/link.ts")))
    subprocess.run([modules / ".bin/esbuild", entry, "--bundle", "--format=esm", "--log-level=error",
                    f"--alias:@oval4d/protocol={ROOT}/protocol/ts/index.ts", f"--outfile={message_folder}/readers.mjs"],
                   check=True, env={"NODE_PATH": str(modules), "PATH": "/usr/bin:/bin:/usr/local/bin"})
    done = subprocess.run(["node", "--max-old-space-size=256", ROOT / "tests/service/read_damaged.mjs", message_folder, "7"],
                          capture_output=True, text=True, timeout=DEADLINE)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
