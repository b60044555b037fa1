#!/usr/bin/python3
"""Writes keyboards.json: what the keys of keyboards of many languages type, from the data of the X Keyboard Extension.

Needs Debian's libxkbcommon0 and xkb-data. For each layout, maps the codes of KeyboardEvent.code to the characters typed
without and with Shift; dead keys and others that type nothing have an empty text."""

import ctypes
import json
from pathlib import Path

LAYOUTS = ["us", "gb", "fr", "be", "de", "ch", "es", "it", "pt", "se", "pl", "cz", "hu", "tr", "ru", "ua", "bg", "gr", "il",
           "ara", "us(dvorak)"]
ROWS = {2: [f"Digit{d}" for d in "1234567890"] + ["Minus", "Equal"],
        16: [f"Key{c}" for c in "QWERTYUIOP"] + ["BracketLeft", "BracketRight"],
        30: [f"Key{c}" for c in "ASDFGHJKL"] + ["Semicolon", "Quote", "Backquote"],
        43: ["Backslash"] + [f"Key{c}" for c in "ZXCVBNM"] + ["Comma", "Period", "Slash"]}
EVDEV = 8  # the difference between X's key codes and the kernel's

xkb = ctypes.CDLL("libxkbcommon.so.0")
for name in ("xkb_context_new", "xkb_keymap_new_from_names"):
    getattr(xkb, name).restype = ctypes.c_void_p
xkb.xkb_keysym_to_utf32.restype = ctypes.c_uint32


class Names(ctypes.Structure):
    _fields_ = [(name, ctypes.c_char_p) for name in ("rules", "model", "layout", "variant", "options")]


def keyboard(layout):
    """Returns the characters of each key without and with Shift."""
    base, _, variant = layout.rstrip(")").partition("(")
    names = Names(b"evdev", b"pc105", base.encode(), variant.encode(), b"")
    keymap = ctypes.c_void_p(xkb.xkb_keymap_new_from_names(ctypes.c_void_p(xkb.xkb_context_new(0)), ctypes.byref(names), 0))
    assert keymap, layout

    def typed(code, level):
        symbols = ctypes.POINTER(ctypes.c_uint32)()
        count = xkb.xkb_keymap_key_get_syms_by_level(keymap, code + EVDEV, 0, level, ctypes.byref(symbols))
        value = xkb.xkb_keysym_to_utf32(symbols[0]) if count == 1 else 0
        return chr(value) if value >= ord(" ") else ""

    codes = {name: first + i for first, row in ROWS.items() for i, name in enumerate(row)}
    return {name: [typed(code, level) for level in (0, 1)] for name, code in codes.items()}


if __name__ == "__main__":
    rows = ",\n".join(f"  {json.dumps(layout)}: {json.dumps(keyboard(layout), ensure_ascii=False)}" for layout in LAYOUTS)
    Path(__file__).with_name("keyboards.json").write_text(f"{{\n{rows}\n}}\n", encoding="utf-8")
