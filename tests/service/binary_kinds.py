"""The kinds of binary messages, as protocol/README.md lists them."""

import re
from pathlib import Path

README = Path(__file__).resolve().parents[2] / "protocol/README.md"


def listed_bytes(text):
    """Returns the bytes of a list such as "0x89, 0xA0–0xBF"."""
    found = []
    for least, greatest in re.findall(r"0x([0-9A-F]{2})(?:–0x([0-9A-F]{2}))?", text):
        found += range(int(least, 16), int(greatest or least, 16) + 1)
    return found


def first_bytes():
    """Returns the first bytes of each kind, by the name of the kind, and of "free" those that no kind has."""
    section = README.read_text(encoding="utf-8").split("### Binary messages\n")[1].split("\n### ")[0]
    kinds = {}
    for listed, meaning in re.findall(r"^\| (0x.*?) \| (.*?) \|$", section, re.MULTILINE):
        name = re.search(r"\[(\w+)\]", meaning)
        kinds[name[1] if name else "free"] = listed_bytes(listed)
    return kinds


FIRST_BYTES = first_bytes()
