"""Sessions that earlier versions have stored are opened with every setting that they had, and their undo steps."""

import asyncio
import json
import math
import re
import shutil
from pathlib import Path

import all_settings
import pytest
from harness import Server
from wire import Client

ROOT = Path(__file__).resolve().parents[2]
VERSIONS = sorted(path for path in Path(__file__).with_name("stored_sessions").iterdir() if path.is_dir())


def version():
    """Returns the version of these sources."""
    return re.search(r"project\(oval4d VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


async def state_at_rest(client):
    """Returns the state after the motion toward an element, if there is one, has ended."""
    while True:
        state = await client.request("get", what="state")
        if state["turning"] or state.get("playing") or not state.get("moving"):  # version 0.1.0 does not say this
            return state
        await asyncio.sleep(0.01)


def expect_contains(value, stored, where):
    """Asserts that a part of a state is what was stored. Later versions may have more members, and know the names of
    more sections."""
    if isinstance(stored, dict):
        for name, member in stored.items():
            assert name in value, f"{where}/{name}"
            expect_contains(value[name], member, f"{where}/{name}")
    elif isinstance(stored, list):
        assert len(value) == len(stored), where
        for i, (each, item) in enumerate(zip(value, stored)):
            expect_contains(each, item, f"{where}/{i}")
    elif isinstance(stored, float):
        assert math.isclose(value, stored, rel_tol=1e-12, abs_tol=1e-12), where
    elif not (where.endswith("/section/name") and stored == ""):
        assert value == stored, where


def data_options(folder):
    """Returns the options of a server that opens the sessions of a folder."""
    return ("--data", folder / "data") if (folder / "data").exists() else ()


async def expect_sessions(server, folder):
    """Asserts that a server opens the sessions of a folder as they were stored."""
    sessions = json.loads((folder / "sessions.json").read_text(encoding="utf-8"))
    assert sessions
    for stored in sessions:
        async with Client(server, stored["session"], token=stored["token"]) as client:
            for state in stored["states"]:  # the newest state is first
                expect_contains(await client.request("get", what="state"), state, stored["name"])
                if state is not stored["states"][-1]:
                    await client.request("undo")
            if "next" in stored:
                await client.request(stored["next"]["type"], **stored["next"]["members"])
                expect_contains(await state_at_rest(client), stored["next"]["state"], stored["name"])


@pytest.mark.parametrize("folder", VERSIONS, ids=lambda folder: folder.name)
async def test_sessions_of_every_version_are_opened(tmp_path, folder):
    shutil.copy(folder / "sessions.sqlite", tmp_path)
    store = f"sqlite:{tmp_path}/sessions.sqlite"
    with Server("--store", store, "--session-expiry", "1e9", *data_options(folder)) as server:
        await expect_sessions(server, folder)


def test_the_sessions_of_this_version_have_all_that_it_stores():
    file = Path(__file__).with_name("stored_sessions") / version() / "sessions.json"
    how = "a new version or setting needs new stored sessions: run tests/service/stored_sessions/make"
    assert file.exists(), how
    sessions = json.loads(file.read_text(encoding="utf-8"))
    states = [state for session in sessions for state in session["states"]]
    states += [session["next"]["state"] for session in sessions if "next" in session]
    for name in all_settings.setting_names() | {("turning",), ("playing",), ("last",)}:
        values = {json.dumps(all_settings.value(state, name)) for state in states if name[0] in state}
        assert len(values) > 1, f"{'.'.join(name)} has the same value in all sessions: {how}"
    found = {member for state in states for member in state.get("field", {})}
    # Only an array too large for a test has an estimated range. Members about a part of an array in the data folder are
    # not stored, because they are read again.
    follows = {"estimated", "region", "resolution"}
    assert found >= all_settings.properties("settings")["field"]["properties"].keys() - follows, how
