"""Sessions: sharing, leaving and returning."""

import asyncio

import pytest
from harness import Server
from wire import Client, turned_away


def opened_by(client):
    return {"session": client.welcome["session"], "token": client.welcome["token"]}


async def test_several_clients_see_every_change(server):
    async with Client(server, stream="geometry") as one:
        async with Client(server, stream="geometry", encoding="cbor", **opened_by(one)) as two, \
                Client(server, stream="frames", width=64, height=64, **opened_by(one)) as three, \
                Client(server, **opened_by(one)) as four:
            assert two.welcome["session"] == one.welcome["session"]
            for turn, client in enumerate((one, two, three, four), start=1):
                await client.request("key", key="r")
                assert (await one.slices(turn))["revision"] == turn
                assert (await two.slices(turn))["revision"] == turn
                await three.frame_of(turn)
                await four.state(turn)
                states = [(await c.state(turn))["orientation"] for c in (one, two, three, four)]
                assert all(state == states[0] for state in states)


async def test_a_session_survives_a_reload(server):
    async with Client(server, stream="geometry") as client:
        await client.request("set", polytope="8-cell")
        await client.request("key", key="t")
        before = await client.request("get", what="state")
        keys = opened_by(client)
    async with Client(server, stream="geometry", **keys) as client:
        after = await client.request("get", what="state")
        assert {**after, "id": 0} == {**before, "id": 0}
        assert (await client.slices(before["revision"]))["revision"] == before["revision"]
        await client.request("undo")  # the history is kept, too
        await client.request("undo")
        assert (await client.request("get", what="state"))["polytope"]["name"] == "5-cell"


async def test_sessions_are_separate(server):
    async with Client(server) as one, Client(server) as two:
        assert one.welcome["session"] != two.welcome["session"]
        await one.request("key", key="y")
        assert (await two.request("get", what="state"))["revision"] == 0


@pytest.mark.parametrize("change, code, close", [
    ({"token": "wrong"}, "bad_token", 4401), ({"token": None}, "bad_token", 4401),
    ({"session": "nosuchsession"}, "not_found", 4404),
])
async def test_who_has_no_ticket_stays_outside(server, change, code, close):
    async with Client(server) as owner:
        ticket = {name: value for name, value in {**opened_by(owner), **change}.items() if value is not None}
        assert await turned_away(server, **ticket) == (code, close)
        await owner.request("key", key="y")


async def test_the_token_is_needed_while_nobody_is_there_too(server):
    async with Client(server) as owner:
        ticket = opened_by(owner)
    assert await turned_away(server, ticket["session"], token="wrong") == ("bad_token", 4401)
    async with Client(server, **ticket) as owner:
        await owner.request("key", key="y")


async def test_leaving_in_mid_frame_harms_nobody(server):
    async with Client(server) as owner:
        await owner.request("set", polytope="600-cell")
        for _ in range(5):
            leaver = Client(server, stream="frames", **opened_by(owner))
            async with leaver:
                await leaver.send("key", key="y")
                await leaver.send("get", id=77, what="frame", width=2000, height=1500)
                leaver.socket.transport.abort()
        await owner.request("key", key="y")
        assert len(await owner.frame(width=64, height=64)) > 100


async def test_sessions_expire_when_nobody_has_them_open():
    with Server("--session-expiry", 0.2) as server:
        async with Client(server) as staying:
            async with Client(server) as leaving:
                keys = opened_by(leaving)
            await asyncio.get_running_loop().run_in_executor(
                None, lambda: server.wait_for(lambda: server.metric("oval4d_sessions") == 1))
            assert await turned_away(server, **keys) == ("not_found", 4404)
            await staying.request("key", key="y")
