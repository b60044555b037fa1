"""Sessions in which every setting has a value that it does not have in a new session."""

import json
from pathlib import Path

SCHEMA = Path(__file__).parents[2] / "protocol/schema"

# Members of a state that are not settings of the picture. `field` follows from the object. `turning` and `playing` are
# motions. `last` is the rotation that turning repeats.
OTHER_MEMBERS = {"field", "turning", "playing", "last"}

# The motions and the last rotation that polytope_in_motion() sets.
MOTION = {"turning": True, "playing": True, "last": {"planes": ["xw"], "angles": [0]}}


def properties(schema):
    """Returns the properties that a schema describes."""
    return json.loads((SCHEMA / f"{schema}.schema.json").read_text(encoding="utf-8"))["properties"]


def descriptions():
    """Returns the schema of each setting by its name, as in (name,) or (object, name)."""
    found = {}
    for name, schema in {**properties("settings"), "shown": {"properties": properties("parts")}}.items():
        if name in ("slices", "camera", "shown"):
            found |= {(name, member): each for member, each in schema["properties"].items()}
        elif name not in OTHER_MEMBERS:
            found[(name,)] = schema
    del found["slices", "w"]  # not a setting: it moves the focus
    return found


def setting_names():
    """Returns the names of all settings, as in (name,) or (object, name)."""
    return set(descriptions())


def examples(of_fields):
    """Returns an example value for each of these settings, by name: if `of_fields` is true, the settings that only
    fields have; if it is false, all other settings except the polytope and the orientation. The value is the first
    example in the schema or, for what is shown or hidden, the opposite of the default."""
    return {name: schema["examples"][0] if "examples" in schema else not schema["default"]
            for name, schema in descriptions().items()
            if schema.get("x-fields-only", False) == of_fields and name not in (("polytope",), ("orientation",))}


def members(values):
    """Returns the members of a `set` message with these values."""
    message = {}
    for (*objects, member), each in values.items():
        (message.setdefault(objects[0], {}) if objects else message)[member] = each
    return message


async def polytope_with_settings(client):
    """Changes all settings that polytopes have."""
    await client.request("set", polytope="truncated tesseract")
    await client.request("rotate", planes=["xw", "yz"], angles=[0.4, 1.1])
    await client.request("set", **members(examples(of_fields=False)))


async def field_with_settings(client):
    """Changes all settings that only fields have. The name is the one that addresses give to a formula."""
    await client.request("load", name="formula", format="formula", data="x^2 + y^2 + a*z^2 - w^2 < 0.2; a=0.4", values="x*w",
                         box=[[-1, 1], [-1, 1], [-1, 1], [-2, 1]])
    await client.request("set", color="growth", **members(examples(of_fields=True)))


async def polytope_in_motion(client):
    """Lets the polytope turn, by the angle 0, which leaves the orientation as it is, and lets the focus play."""
    await client.request("rotate", **MOTION["last"])
    await client.request("set", turning=True, playing=True)


async def motion(client):
    """Returns the members of the session's state that MOTION has."""
    state = await client.request("get", what="state")
    return {name: state[name] for name in MOTION}


SESSIONS = [polytope_with_settings, field_with_settings]


def value(state, name):
    """Returns the value of a setting in a state; None if the state does not have it."""
    for member in name:
        state = state.get(member)
    return state["name"] if name == ("polytope",) else state
