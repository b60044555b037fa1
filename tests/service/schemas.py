"""Compares messages of the server with the JSON Schemas of the protocol."""

import functools
import json
from pathlib import Path

from jsonschema import Draft202012Validator

SCHEMAS = {path.name: json.loads(path.read_text(encoding="utf-8"))
           for path in Path(__file__).parents[2].joinpath("protocol/schema").glob("*.schema.json")}
# How many numbers, and how many other items, are compared at the beginning of each list. Comparing an item takes
# microseconds, and no schema states a longer length. Unit tests compare whole messages.
MOST_NUMBERS, MOST_ITEMS = 256, 20

_compared = set()


def answer_type(request, what=None):
    """Returns the type of the message that answers a request; `what` is the member of a `get`."""
    if request == "get":
        return "done" if what in ("frame", "file") else what
    return SCHEMAS[f"{request}.schema.json"].get("x-answer", "done")


def compare_with_schema(message):
    """Fails if a message does not conform to its schema, or has a member that the schema lacks. Messages of one type
    with the same members are compared once."""
    found = uncompared_shape(message)
    if found:
        faults = [f"/{'/'.join(map(str, fault.absolute_path))}: {fault.message}"
                  for fault in _validator(message["type"]).iter_errors(beginning(message))]
        assert not faults, f"{message['type']}: {faults}"
        _compared.add(found)


def uncompared_shape(message):
    """Returns the type and the shape of a message, or None if a message of this type and shape has been compared."""
    found = message["type"], shape(message)
    return None if found in _compared else found


def shape(value):
    """Returns the names of all members of a value, and the JSON types of their values."""
    if isinstance(value, dict):
        return frozenset((name, shape(member)) for name, member in value.items())
    if isinstance(value, list):
        return frozenset(map(shape, value[:MOST_ITEMS]))
    return float if isinstance(value, int) and not isinstance(value, bool) else type(value)


def beginning(value):
    """Returns a value without the ends of its long lists."""
    if isinstance(value, dict):
        return {name: beginning(member) for name, member in value.items()}
    if not isinstance(value, list):
        return value
    is_flat = not any(isinstance(item, (dict, list)) for item in value[:1])
    return [beginning(item) for item in value[:MOST_NUMBERS if is_flat else MOST_ITEMS]]


@functools.cache
def _validator(type_):
    name = f"{type_}.schema.json"
    assert name in SCHEMAS, f"no schema describes {type_}"
    files = {file: {"$id": file, **schema} for file, schema in SCHEMAS.items()}
    return Draft202012Validator({"$defs": files, "$ref": name, "unevaluatedProperties": False})
