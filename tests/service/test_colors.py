"""Coloring of faces, and hidden and faded kinds of cells: by message, command and query, in both streams."""

import json
import urllib.parse

import pytest
from png import pixels, state_in
from wire import Client, Refused

TESSERACT = "truncated tesseract"  # has two kinds of cells: 0 for truncated cubes, 1 for tetrahedra


def fetch_frame(server, **members):
    return server.get("/api/v1/frame.png?" + urllib.parse.urlencode(
        {"polytope": TESSERACT, "width": 160, "height": 90, **members}, quote_via=urllib.parse.quote))


async def color_settings(client):
    state = await client.request("get", what="state")
    return state["color"], state["hidden"], state["faded"]


async def test_messages_and_commands_change_the_same_settings(server):
    async with Client(server) as client:
        await client.request("set", polytope=TESSERACT)
        assert await color_settings(client) == ("cell", [], [])
        for message, line, result in (
            ({"color": "kind"}, ":color kind", ("kind", [], [])),
            ({"hidden": [1]}, ":hide tetrahedron", ("kind", [1], [])),
            ({"faded": [0, 1]}, ":set faded=0,1", ("kind", [], [0, 1])),
            ({"hidden": [0], "faded": [0]}, ":hide 0", None),
            ({"color": "w", "hidden": [], "faded": []}, ":set color=w hidden=none faded=none", ("w", [], [])),
        ):
            await client.request("set", **message)
            by_message = await color_settings(client)
            assert result in (None, by_message)
            await client.request("undo")
            await client.request("command", line=line)
            by_command = await color_settings(client)
            assert by_command == by_message if result else by_command[1] == by_message[1] == [0]
        await client.request("key", key="y")
        assert await color_settings(client) == ("w", [], []), "a rotation keeps the colors"
        await client.request("set", hidden=[1])
        await client.request("set", polytope="24-cell")
        assert await color_settings(client) == ("w", [], []), "another polytope has other kinds of cells"


@pytest.mark.parametrize("members, code, expected_text", [
    ({"color": "red"}, "bad_message", "plain"),
    ({"color": 3}, "bad_message", "color"),
    ({"hidden": [2]}, "out_of_range", "2 kinds of cells, 0 to 1"),
    ({"hidden": [-1]}, "", "hidden"),
    ({"hidden": [0.5]}, "", "hidden"),
    ({"faded": [4294967296]}, "", "faded"),
    ({"faded": 1}, "bad_message", "faded"),
    ({"hidden": ["tetrahedron"]}, "bad_message", "hidden"),
    ({"color": "kind", "faded": [9]}, "out_of_range", "there is no 9"),
])
async def test_invalid_settings_change_nothing(server, members, code, expected_text):
    async with Client(server) as client:
        await client.request("set", polytope=TESSERACT, color="w", hidden=[1])
        with pytest.raises(Refused) as caught:
            await client.request("set", **members)
        assert code in caught.value.code and expected_text in caught.value.text
        assert await color_settings(client) == ("w", [1], [])


@pytest.mark.parametrize("line, code, expected_text", [
    (":color red", "bad_expression", "plain"),
    (":color", "bad_expression", "color"),
    (":hide", "bad_expression", "truncated cube"),
    (":hide cube", "bad_expression", "truncated cube"),
    (":fade 7", "out_of_range", "there is no 7"),
    (":set hidden=x", "bad_expression", "number"),
    (":set faded=5", "out_of_range", "there is no 5"),
])
async def test_invalid_commands_change_nothing(server, line, code, expected_text):
    async with Client(server) as client:
        await client.request("set", polytope=TESSERACT, color="w", faded=[1])
        with pytest.raises(Refused) as caught:
            await client.request("command", line=line)
        assert caught.value.code == code and expected_text in caught.value.text
        assert await color_settings(client) == ("w", [], [1])


@pytest.mark.parametrize("members, status, expected_text", [
    ({"color": "red"}, 400, "plain"), ({"hidden": "x"}, 400, "number"), ({"hidden": "2"}, 400, "there is no 2"),
    ({"faded": "0,,9"}, 400, "there is no 9"),
])
def test_invalid_queries_get_an_explanatory_error(server, members, status, expected_text):
    answer = fetch_frame(server, **members)
    assert answer.status == status and expected_text in json.loads(answer.body)["message"]


def test_color_settings_of_a_query_change_the_picture(server):
    pictures = {}
    for name, members in {"all": {}, "kind": {"color": "kind"}, "w": {"color": "w"}, "plain": {"color": "plain"},
                          "hidden": {"hidden": "1"}, "faded": {"faded": "1"}, "nothing": {"hidden": "0,1"}}.items():
        answer = fetch_frame(server, **members)
        assert answer.status == 200
        state = state_in(answer.body)
        assert state["color"] == members.get("color", "cell")
        for list_ in ("hidden", "faded"):
            assert state[list_] == [int(kind) for kind in members.get(list_, "").split(",") if kind]
        pictures[name] = pixels(answer.body)[1]
    assert len(set(pictures.values())) == len(pictures), "two settings give the same picture"


async def test_slices_state_which_faces_are_visible(server):
    async with Client(server, stream="geometry") as client:
        await client.request("set", polytope=TESSERACT)
        done = await client.request("set", faded=[1])
        message = await client.wait_for_slices(done["revision"])
        tetrahedra = 0
        for piece in message["slices"]:
            for of, seen in zip(piece["of"]["faces"], piece["seen"]["faces"]):
                if of < 24:
                    assert seen in (1, 2)
                    tetrahedra += seen == 1
        assert 0 < tetrahedra
        done = await client.request("set", hidden=[0, 1], color="plain")
        message = await client.wait_for_slices(done["revision"])
        assert {seen for piece in message["slices"] for seen in piece["seen"]["edges"]} == {0}
        assert len(set(message["scene"]["colors"]["cells"])) == 1
        done = await client.request("set", hidden=[])
        assert not any("seen" in piece for piece in (await client.wait_for_slices(done["revision"]))["slices"])
