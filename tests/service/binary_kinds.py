"""The kinds of binary messages, as protocol/README.md lists them."""

import re
from pathlib import Path

README = Path(__file__).resolve().parents[2] / "protocol/README.md"


def listed_beginnings(text):
    """Returns the beginnings of messages in a list such as "0x89, 0xA0–0xBF" or "0x01 0x02": one or two bytes each."""
    found = []
    for part in text.replace("0x", "").split(", "):
        least, *greatest = map(bytes.fromhex, part.split("–"))
        found += [bytes([byte]) for byte in range(least[0], greatest[0][0] + 1)] if greatest else [least]
    return found


def beginnings():
    """Returns the beginnings of the messages of each kind, by the name of the kind; under "free", those that no kind
    has."""
    section = README.read_text(encoding="utf-8").split("### Binary messages\n")[1].split("\n### ")[0]
    kinds = {}
    for listed, meaning in re.findall(r"^\| (0x.*?) \| (.*?) \|$", section, re.MULTILINE):
        name = re.search(r"\[(\w+)\]", meaning)
        kinds[name[1] if name else "free"] = listed_beginnings(listed)
    return kinds


BEGINNINGS = beginnings()


def kind_of(message):
    """Returns the name of the kind of a binary message; "free" if no kind begins so."""
    for length in (2, 1):
        for name, known in BEGINNINGS.items():
            if message[:length] in known:
                return name
    raise ValueError("the message is empty")
