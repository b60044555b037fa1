"""The types of messages in protocol/python/oval4d_messages, beside the schemas and the messages of a server."""

import json
import os
import shutil
import subprocess
import sys
import typing
from collections.abc import Sequence
from pathlib import Path

from harness import DEADLINE

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "protocol/python"))
import oval4d_messages  # noqa: E402
from oval4d_client import Client, connect  # noqa: E402

SCHEMAS = {path.name.split(".")[0]: json.loads(path.read_text(encoding="utf-8"))
           for path in sorted((ROOT / "protocol/schema").iterdir())}
TYPES = {typing.get_args(typing.get_type_hints(each)["type"])[0]: each
         for each in typing.get_args(typing.Union[oval4d_messages.Request, oval4d_messages.Answer])}


def fits(value, expected):
    """Returns whether a value, as JSON gives it, is of a type of Python."""
    origin, arguments = typing.get_origin(expected), typing.get_args(expected)
    if typing.is_typeddict(expected):
        members = typing.get_type_hints(expected)
        return (isinstance(value, dict) and expected.__required_keys__ <= value.keys() <= members.keys()
                and all(fits(member, members[name]) for name, member in value.items()))
    if origin is typing.Union:
        return any(fits(value, each) for each in arguments)
    if origin is typing.Literal:
        return any(type(value) is type(each) and value == each for each in arguments)
    if origin in (list, Sequence):
        return isinstance(value, list) and all(fits(item, arguments[0]) for item in value)
    if origin is dict:
        return isinstance(value, dict) and all(fits(item, arguments[1]) for item in value.values())
    if expected is float:
        return type(value) in (int, float)
    return type(value) is expected


def test_the_types_have_the_members_of_the_schemas():
    described = {name: schema for name, schema in SCHEMAS.items() if "const" in schema.get("properties", {}).get("type", {})}
    messages = {schema["properties"]["type"]["const"]: schema for name, schema in described.items() if name != "slices"}
    assert set(messages) == set(TYPES)
    for name, schema in messages.items():
        settings = SCHEMAS["settings"]["properties"] if schema.get("$ref") == "settings.schema.json" else {}
        assert set(typing.get_type_hints(TYPES[name])) == {*schema["properties"], *settings}, name
        assert TYPES[name].__required_keys__ == set(schema["required"]), name


def test_requests_have_the_answers_of_the_schemas():
    names = {**vars(typing), **vars(oval4d_messages)}
    annotations = [each.__annotations__ for each in typing.get_overloads(Client.request)]
    overloads = [(typing.get_args(eval(each["type"], names)), eval(each["return"], names)) for each in annotations]
    requests = [each for each in typing.get_args(oval4d_messages.Request) if each is not oval4d_messages.GetRequest]
    for request in requests:
        (name,) = typing.get_args(typing.get_type_hints(request)["type"])
        answers = [answer for types, answer in overloads if name in types]
        assert answers == [TYPES[SCHEMAS[name].get("x-answer", "done")]], name


def test_the_messages_of_a_server_are_of_their_types(server):
    with connect(server.url, timeout=DEADLINE) as oval:
        assert fits(oval.hello(width=640, height=480), oval4d_messages.Welcome)
        assert fits(oval.set(polytope="24-cell", highlight={"element": "cell", "number": 3}), oval4d_messages.Done)
        state = oval.state()
        assert fits(state, oval4d_messages.State)
        # A state can be sent back as a `set` message, in whole or in part.
        parts = {name: state[name] for name in ("polytope", "slices", "shown", "camera", "highlight", "orientation")}
        assert fits(parts, oval4d_messages.Settings)
        assert fits({"type": "set", "continues": True, **parts}, oval4d_messages.SetRequest)
        assert fits(oval.at(320, 240), oval4d_messages.At)
        for what in ("catalogue", "keymap", "critical", "address"):
            assert fits(oval.get(what), TYPES[what]), what
        assert fits(oval.ping(), oval4d_messages.Pong)
        assert fits(oval.request("measure", element="edge", number=0), oval4d_messages.Measured)
        oval.formula("x^2+y^2+z^2-w", levels=[0.5], inside="below")
        assert fits(oval.set(fog=[{"value": 0, "opacity": 0.5}, {"value": 1, "opacity": 0}]), oval4d_messages.Done)
        assert fits(oval.state(), oval4d_messages.State)


def test_the_types_refuse_other_members_and_values():
    rotation = {"type": "rotate", "planes": ["xw"], "angles": [0.1]}
    assert fits(rotation, oval4d_messages.RotateRequest)
    for wrong in ({"planes": ["xv"]}, {"angles": "0.1"}, {"type": "set"}, {"continues": 1}, {"speed": 1}):
        assert not fits(rotation | wrong, oval4d_messages.RotateRequest), wrong
    assert not fits({"type": "rotate", "planes": ["xw"]}, oval4d_messages.RotateRequest)


def test_the_client_is_usable_as_one_copied_file(server, tmp_path):
    shutil.copy(ROOT / "protocol/python/oval4d_client.py", tmp_path)
    script = ("import sys, oval4d_client\n"
              f"with oval4d_client.connect({server.url!r}, timeout={DEADLINE}) as oval:\n"
              "    print(oval.hello()['type'], oval.key('y')['revision'], 'oval4d_messages' in sys.modules)\n")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, timeout=DEADLINE,
                          capture_output=True, text=True, env=environment)
    assert done.stdout == "welcome 1 False\n"
