"""The WebSocket protocol, message by message."""

import asyncio
import math
from unittest.mock import ANY

import pytest
from harness import DEADLINE
from wire import ENCODINGS, SUBPROTOCOL, Client, Refused, connect

ALPHA = math.pi / 36


async def test_hello_is_answered_by_welcome_state_and_slices(server):
    async with Client(server, stream="geometry") as client:
        await client.wait_for_slices(0)
        assert client.socket.subprotocol == SUBPROTOCOL
        assert [m["type"] for m in client.messages[:3]] == ["welcome", "state", "slices"]
        welcome = client.messages[0]
        assert welcome["protocol"] == 1 and welcome["server"].startswith("oval4d ")
        assert welcome["session"] and welcome["token"] and welcome["limits"]["message"] == 8 << 20


async def test_the_initial_state_is_that_of_the_paper(server):
    async with Client(server) as client:
        state = await client.wait_for_state(0)
        assert state["polytope"] == {"name": "5-cell", "vertices": 5, "edges": 10, "faces": 10, "cells": 5,
                                     "kinds": [{"name": "tetrahedron", "cells": 5, "color": ANY}]}
        assert state["orientation"] == [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        assert state["alpha"] == state["beta"] == pytest.approx(ALPHA)
        assert state["slices"]["count"] == 21 and state["slices"]["focus"] == 0
        assert state["view"] == "oval" and state["turning"] is False and state["last"] is None
        assert all(shown for part, shown in state["shown"].items() if part not in ("cells", "sections"))


async def test_a_key_press_is_answered_and_streamed(server):
    async with Client(server, stream="geometry") as client:
        done = await client.request("key", key="y")
        assert done == {"type": "done", "id": done["id"], "revision": 1}
        slices, state = await client.wait_for_slices(1), await client.wait_for_state(1)
        assert client.messages.index(state) == client.messages.index(slices) - 1
        assert state["last"] == {"planes": ["xy", "zw"], "angles": [pytest.approx(ALPHA), pytest.approx(ALPHA)]}
        back = await client.request("key", key="y", shift=True)
        state = await client.wait_for_state(back["revision"])
        for row, expected in zip(state["orientation"], ([1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1])):
            assert row == pytest.approx(expected, abs=1e-12)


async def test_rotate_turns_by_the_given_angles(server):
    async with Client(server) as client:
        await client.request("rotate", planes=["xw", "yz"], angles=[0.3, 1.2])
        m = (await client.wait_for_state(1))["orientation"]
        assert [m[0][0], m[0][3], m[3][0]] == pytest.approx([math.cos(0.3), -math.sin(0.3), math.sin(0.3)])
        assert [m[1][1], m[1][2], m[2][1]] == pytest.approx([math.cos(1.2), -math.sin(1.2), math.sin(1.2)])


async def test_set_changes_all_given_members_or_none(server):
    async with Client(server) as client:
        await client.request("set", polytope="24-cell", slices={"count": 31, "spacing": 0.1, "focus": 2}, alpha=0.5)
        state = await client.wait_for_state(1)
        assert state["polytope"]["cells"] == 24 and state["alpha"] == 0.5
        assert state["slices"] == {"count": 31, "spacing": 0.1, "focus": 2, "offset": 0}
        with pytest.raises(Refused) as refused:
            await client.request("set", alpha=0.7, slices={"count": 4})
        assert refused.value.code == "out_of_range"
        assert (await client.request("get", what="state"))["alpha"] == 0.5


async def test_pong_tells_how_busy_the_workers_are(server):
    async with Client(server, stream="geometry") as client:
        before = await client.request("ping")
        assert before == {"type": "pong", "id": before["id"], "workers": ANY, "waiting": ANY, "busy": ANY, "time": ANY}
        assert before["workers"] >= 1 and before["waiting"] >= 0
        await client.request("get", what="frame")
        async with asyncio.timeout(DEADLINE):  # a picture's job ends soon after the picture is sent
            while (after := await client.request("ping"))["busy"] <= before["busy"]:
                pass
        assert before["time"] < after["time"]
        assert (await client.request("key", key="y"))["revision"] == 1, "a ping changes nothing"


async def test_undo_redo_and_reset_restore_states(server):
    async with Client(server) as client:
        start = await client.request("get", what="state")
        await client.request("key", key="r")
        turned = await client.request("get", what="state")
        assert turned["orientation"] != start["orientation"]
        await client.request("undo")
        assert (await client.request("get", what="state"))["orientation"] == start["orientation"]
        await client.request("redo")
        assert (await client.request("get", what="state"))["orientation"] == turned["orientation"]
        await client.request("reset")
        assert (await client.request("get", what="state"))["orientation"] == start["orientation"]
        with pytest.raises(Refused) as refused:
            await client.request("redo")
        assert refused.value.code == "nothing_to_undo"


async def test_commands_select_and_rotate_a_polytope(server):
    async with Client(server) as client:
        await client.request("command", line="polytope 600-cell")
        await client.request("command", line=":rotate xw,yz pi/8 pi/sqrt(3)-pi/8")
        state = await client.request("get", what="state")
        assert state["polytope"]["name"] == "600-cell"
        assert state["last"]["angles"] == pytest.approx([math.pi / 8, math.pi / math.sqrt(3) - math.pi / 8])


async def test_states_of_large_polytopes_name_their_sections(server):
    """Workers name them; clients without pictures are sent the newest state all the same, in the colors of each."""
    async with Client(server) as dark:
        session, token = dark.welcome["session"], dark.welcome["token"]
        async with Client(server, session, token=token, scheme="light") as light:
            await dark.request("set", polytope="600-cell")
            done = await dark.request("toward", element="vertex", immediately=True)
            colors = []
            for client in (dark, light):
                state = await client.wait_for_state(done["revision"])
                assert (state["section"]["name"], state["section"]["vertices"]) == ("", "icosidodecahedron")
                answer = await client.request("get", what="state")
                assert {name: value for name, value in answer.items() if name != "id"} == state
                colors.append(state["polytope"]["kinds"][0]["color"])
            assert colors[0] != colors[1]
            for _ in range(20):
                await dark.send("key", key="l")
            done = await dark.request("key", key="l")
            for client in (dark, light):
                assert (await client.wait_for_state(done["revision"]))["slices"]["focus"] == 21


async def test_a_loaded_polytope_is_shown_and_listed(server):
    simplex = ("4OFF\n5 10 10 5\n1 1 1 -0.447214\n1 -1 -1 -0.447214\n-1 1 -1 -0.447214\n-1 -1 1 -0.447214\n"
               "0 0 0 1.788854\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 2 3\n3 0 2 4\n3 0 3 4\n3 1 2 3\n3 1 2 4\n3 1 3 4\n"
               "3 2 3 4\n4 0 1 3 6\n4 0 2 4 7\n4 1 2 5 8\n4 3 4 5 9\n4 6 7 8 9\n")
    async with Client(server, stream="geometry") as client:
        done = await client.request("load", name="mine", format="off", data=simplex)
        state = await client.wait_for_state(done["revision"])
        assert state["polytope"] == {"name": "mine", "vertices": 5, "edges": 10, "faces": 10, "cells": 5,
                                     "kinds": [{"name": "tetrahedron", "cells": 5, "color": ANY}]}
        assert len((await client.wait_for_slices(done["revision"]))["coordinates"]) == 5
        known = (await client.request("get", what="catalogue"))["polytopes"]
        assert known[-1] == {"name": "mine", "family": "loaded", "aliases": [], "diagram": "", "schlaefli": "",
                             "vertices": 5, "edges": 10, "faces": 10, "cells": 5}
    async with Client(server) as another:
        elsewhere = (await another.request("get", what="catalogue"))["polytopes"]
        assert elsewhere == known[:-1], "another session has not loaded it"


async def test_get_returns_the_requested_data(server):
    async with Client(server) as client:
        catalogue = await client.request("get", what="catalogue")
        assert [p["name"] for p in catalogue["polytopes"]][:6] == [
            "5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"]
        keymap = await client.request("get", what="keymap")
        assert {"y", "2", "h", "u"} <= {key["key"] for key in keymap["keys"]}
        slices = await client.request("get", what="slices", width=400, height=300)
        assert slices["type"] == "slices" and slices["scene"]["viewport"] == {"width": 400, "height": 300}
        assert (await client.request("get", what="state"))["type"] == "state"
        assert (await client.request_frame(width=64, height=48)).startswith(b"\x89PNG")


async def test_every_request_with_an_id_is_answered_once(server):
    async with Client(server, stream="geometry") as client:
        await client.request("shown", revision=0)
        await client.request("key", key="g")  # the first key of "gg", which has no effect yet
        await client.request("key", key="G")
        await client.request("key", key="0")
        for number in range(1, 6):
            assert client.answer_to(number) is not None


async def test_a_second_hello_changes_the_stream(server):
    async with Client(server, stream="geometry") as client:
        await client.wait_for_slices(0)
        await client.request("key", key="2")
        await client.wait_for_slices(1)
        await client.request("hello", stream="frames", width=160, height=90)
        assert (await client.wait_for_frame(1)).startswith(b"\x89PNG")
        seen = len(client.messages)
        await client.request("hello", stream="none")
        done = await client.request("key", key="2")
        await client.wait_for_state(done["revision"])
        assert not [m for m in client.messages[seen:] if client.is_picture(m)]


async def test_a_command_that_changes_nothing_keeps_the_revision(server):
    async with Client(server) as client:
        first = await client.request("set", alpha=0.25)
        assert (await client.request("set", alpha=0.25))["revision"] == first["revision"]


async def test_a_state_message_can_be_sent_as_set(server):
    async with Client(server) as one, Client(server) as other:
        await one.request("set", polytope="16-cell", view="single", camera={"azimuth": 0.4})
        await one.request("rotate", planes=["xz", "yw"], angles=[0.2, 0.9])
        wanted = await one.request("get", what="state")
        await other.request("set", **{name: value for name, value in wanted.items() if name not in ("type", "id")})
        got = await other.request("get", what="state")
        for name in ("polytope", "slices", "view", "camera", "shown", "alpha", "last"):
            assert got[name] == wanted[name]
        for row, expected in zip(got["orientation"], wanted["orientation"]):
            assert row == pytest.approx(expected, abs=1e-12)


async def test_the_subprotocol_is_optional(server):
    async with connect(server, subprotocols=None) as socket:
        await socket.send('{"type":"hello"}')
        assert '"welcome"' in await socket.recv()


IDS = ["0", "1", "1000000", "100000", "123456789012", "9007199254740992", "-1", "-1000000", "-9007199254740992", "1.5"]


@pytest.mark.parametrize("encoding", ENCODINGS)
async def test_answers_repeat_the_id_of_the_request(server, encoding):
    async with connect(server) as socket:
        async def answer(request, id_):
            """Sends the request with this id; returns the answer as received (bytes or text) and decoded."""
            await socket.send(request.replace("}", f',"id":{id_}}}'))
            while True:
                data = await socket.recv()
                message = Client.decode(data)
                if isinstance(message, dict) and "id" in message:
                    return data, message

        await answer(f'{{"type":"hello","stream":"none","encoding":"{encoding}"}}', 7)
        for id_ in IDS:
            for request, type_ in [('{"type":"key","key":"y"}', "done"), ('{"type":"nonsense"}', "error"),
                                   ('{"type":"get","what":"state"}', "state"),
                                   ('{"type":"get","what":"slices"}', "slices"),
                                   ('{"type":"get","what":"keymap"}', "keymap")]:
                data, message = await answer(request, id_)
                assert message["type"] == type_
                assert repr(message["id"]) == id_
                if isinstance(data, str):
                    assert f'"id":{id_},' in data
