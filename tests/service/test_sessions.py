"""Sessions: sharing, leaving and returning."""

import pytest
from wire import Client, credentials_of, hello_refusal


async def test_several_clients_see_every_change(server):
    async with Client(server, stream="geometry") as one:
        async with Client(server, stream="geometry", encoding="cbor", **credentials_of(one)) as two, \
                Client(server, stream="frames", width=64, height=64, **credentials_of(one)) as three, \
                Client(server, **credentials_of(one)) as four:
            assert two.welcome["session"] == one.welcome["session"]
            for turn, client in enumerate((one, two, three, four), start=1):
                await client.request("key", key="r")
                assert (await one.wait_for_slices(turn))["revision"] == turn
                assert (await two.wait_for_slices(turn))["revision"] == turn
                await three.wait_for_frame(turn)
                await four.wait_for_state(turn)
                states = [(await c.wait_for_state(turn))["orientation"] for c in (one, two, three, four)]
                assert all(state == states[0] for state in states)


async def test_a_session_survives_a_reload(server):
    async with Client(server, stream="geometry") as client:
        await client.request("set", polytope="8-cell")
        await client.request("key", key="t")
        before = await client.request("get", what="state")
        credentials = credentials_of(client)
    async with Client(server, stream="geometry", **credentials) as client:
        after = await client.request("get", what="state")
        assert {**after, "id": 0, "object_serial": 0} == {**before, "id": 0, "object_serial": 0}
        assert (await client.wait_for_slices(before["revision"]))["revision"] == before["revision"]
        await client.request("undo")  # the history is also kept
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
async def test_joining_with_wrong_credentials_is_refused(server, change, code, close):
    async with Client(server) as owner:
        credentials = {name: value for name, value in {**credentials_of(owner), **change}.items() if value is not None}
        assert await hello_refusal(server, **credentials) == (code, close)
        await owner.request("key", key="y")


async def test_the_token_is_required_after_all_clients_have_left(server):
    async with Client(server) as owner:
        credentials = credentials_of(owner)
    assert await hello_refusal(server, credentials["session"], token="wrong") == ("bad_token", 4401)
    async with Client(server, **credentials) as owner:
        await owner.request("key", key="y")


async def test_leaving_during_a_frame_does_not_affect_other_clients(server):
    async with Client(server) as owner:
        await owner.request("set", polytope="600-cell")
        for _ in range(5):
            leaver = Client(server, stream="frames", **credentials_of(owner))
            async with leaver:
                await leaver.send("key", key="y")
                await leaver.send("get", id=77, what="frame", width=2000, height=1500)
                leaver.socket.transport.abort()
        await owner.request("key", key="y")
        assert len(await owner.request_frame(width=64, height=64)) > 100
