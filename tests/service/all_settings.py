"""Sessions in which every setting has a value that it does not have in a new session."""

import json
from pathlib import Path

SCHEMA = Path(__file__).parents[2] / "protocol/schema"

# Not settings, or told by others: `field` and `turning` follow from the object and the motion, and `last` repeats a
# rotation.
FOLLOWING = {"field", "turning", "last"}


def setting_names():
    """Returns the names of all settings, as in (name,) or (object, name)."""
    properties = {**json.loads((SCHEMA / "settings.schema.json").read_text(encoding="utf-8"))["properties"]}
    parts = json.loads((SCHEMA / "parts.schema.json").read_text(encoding="utf-8"))["properties"]
    names = set()
    for name, description in properties.items():
        if name in ("slices", "camera"):
            names |= {(name, member) for member in description["properties"]}
        elif name == "shown":
            names |= {(name, part) for part in parts}
        elif name not in FOLLOWING:
            names.add((name,))
    return names - {("slices", "w")}  # which moves the focus


async def polytope_with_settings(client):
    """Changes all settings that polytopes have."""
    await client.request("set", polytope="truncated tesseract", pace=2, follow=[0.1, 0, 0.2], boost=[0.3, 0.1, 0])
    await client.request("rotate", planes=["xw", "yz"], angles=[0.4, 1.1])
    state = await client.request("get", what="state")
    await client.request("set", slices={"count": 31, "spacing": 0.06, "focus": 4, "offset": 0.015}, alpha=0.3, beta=1.25,
                         step=0.01, view="matrix", color="kind", background="white", projection="orthogonal", eye=4,
                         camera={"azimuth": 0.4, "elevation": -0.2, "zoom": 1.5}, hidden=[0], faded=[1],
                         highlight={"element": "cell", "number": 9},
                         shown={part: not shown for part, shown in state["shown"].items()})
    here = await client.request("get", what="state")
    await client.request("set", point=[0.1, 0.2, -0.1, here["point"][3]])


async def field_with_settings(client):
    """Changes all settings that only fields have. The name is the one that addresses give to a formula."""
    await client.request("load", name="formula", format="formula", data="x^2 + y^2 + a*z^2 - w^2 < 0.2; a=0.4", values="x*w",
                         box=[[-1, 1], [-1, 1], [-1, 1], [-2, 1]])
    fog = [{"value": 0, "opacity": 0.5, "color": 16744448}, {"value": 1, "opacity": 0}]
    await client.request("set", levels=[0.1, 0.3], inside="above", caps="open", color="growth", fog=fog)


SESSIONS = [polytope_with_settings, field_with_settings]


def value(state, name):
    """Returns the value of a setting in a state; None if the state does not have it."""
    for member in name:
        state = state.get(member)
    return state["name"] if name == ("polytope",) else state
