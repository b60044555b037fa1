"""Reads the chunks, the state and the pixels of PNG files."""

import io
import json
import struct
import zlib

from PIL import Image

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def chunks(png):
    """Returns (name, data) of each chunk; asserts that its checksum is correct."""
    assert png.startswith(SIGNATURE)
    at = len(SIGNATURE)
    found = []
    while at < len(png):
        length, name = struct.unpack_from(">I4s", png, at)
        data = png[at + 8:at + 8 + length]
        assert struct.unpack_from(">I", png, at + 8 + length)[0] == zlib.crc32(name + data)
        found.append((name.decode(), data))
        at += 12 + length
    assert found[-1][0] == "IEND"
    return found


def state_in(png):
    """Returns the state in the file: an uncompressed iTXt chunk with the keyword oval4d, right after IHDR."""
    name, data = chunks(png)[1]
    assert name == "iTXt"
    keyword, rest = data.split(b"\0", 1)
    assert keyword == b"oval4d" and rest.startswith(b"\0\0\0\0")
    return json.loads(rest[4:].decode("utf-8"))


def pixels(png):
    """Returns ((width, height), RGB bytes)."""
    image = Image.open(io.BytesIO(png))
    assert image.mode == "RGB"
    return image.size, image.tobytes()
