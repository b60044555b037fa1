"""No setting is lost in a SQLite file, a picture, a `state` message or an address, and no motion but in an address."""

import json

import all_settings
import numpy
import pytest
from harness import Server
from test_restoring import session_with, settings
from wire import Client


async def test_each_setting_is_changed(server):
    changed = set()
    for prepare in all_settings.SESSIONS:
        async with Client(server, stream="none") as client:
            before = await client.request("get", what="state")
            await prepare(client)
            after = await client.request("get", what="state")
            changed |= {name for name in all_settings.setting_names()
                        if all_settings.value(after, name) != all_settings.value(before, name)}
    assert changed == all_settings.setting_names()


@pytest.mark.parametrize("prepare", all_settings.SESSIONS)
async def test_a_sqlite_file_loses_no_setting(tmp_path, prepare):
    store = ("--store", f"sqlite:{tmp_path}/sessions.sqlite")
    with Server(*store) as server:
        async with Client(server, stream="none") as client:
            await prepare(client)
            before = await client.request("get", what="state")
    with Server(*store) as server:
        async with Client(server, client.welcome["session"], token=client.welcome["token"], stream="none") as client:
            after = await client.request("get", what="state")
            assert {**after, "id": 0, "object_serial": 0} == {**before, "id": 0, "object_serial": 0}


@pytest.mark.parametrize("prepare", all_settings.SESSIONS)
async def test_pictures_states_and_addresses_lose_no_setting(server, prepare):
    async with Client(server, stream="none") as client:
        await prepare(client)
        state = await client.request("get", what="state")
        picture = await client.request_frame(width=320, height=200)
        query = (await client.request("get", what="address"))["query"]
    for body in (picture, json.dumps(state).encode()):
        async with session_with(server, body) as other:
            assert settings(await other.request("get", what="state")) == settings(state)
    async with Client(server, stream="none") as other:
        await other.request("address", query=query)
        opened = await other.request("get", what="state")
        for name in all_settings.setting_names() - {("orientation",)}:
            assert all_settings.value(opened, name) == pytest.approx(all_settings.value(state, name)), name
        assert numpy.allclose(opened["orientation"], state["orientation"])


async def test_only_addresses_lose_a_motion(tmp_path):
    store = ("--store", f"sqlite:{tmp_path}/sessions.sqlite")
    with Server(*store) as server:
        async with Client(server, stream="none") as client:
            await all_settings.polytope_in_motion(client)
            assert await all_settings.motion(client) == all_settings.MOTION
            state = await client.request("get", what="state")
            picture = await client.request_frame(width=320, height=200)
            query = (await client.request("get", what="address"))["query"]
        for body in (picture, json.dumps(state).encode()):
            async with session_with(server, body) as other:
                assert await all_settings.motion(other) == all_settings.MOTION
        async with Client(server, stream="none") as other:
            await other.request("address", query=query)
            # All who open an address see the same picture, whenever they open it. An address therefore contains no
            # motion. It does not contain the last rotation either, because no picture shows it.
            assert await all_settings.motion(other) == {"turning": False, "playing": False, "last": None}
    with Server(*store) as server:
        async with Client(server, client.welcome["session"], token=client.welcome["token"], stream="none") as client:
            assert await all_settings.motion(client) == all_settings.MOTION


async def test_an_address_that_is_written_by_hand_begins_a_motion(server):
    async with Client(server, stream="none") as client:
        await client.request("address", query="rotate=xw:0&turning=on&playing=on")
        assert await all_settings.motion(client) == all_settings.MOTION
