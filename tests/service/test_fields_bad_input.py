"""Formulas, boxes and levels that are not valid: the error says what is wrong and where, and nothing changes."""

import asyncio
import json
import re
from urllib.parse import quote, urlencode

import pytest
from harness import run_oval4d
from surfaces import field_client, load_field
from wire import Client, Refused

SIZE = {"width": 480, "height": 270}
MANY_CONSTANTS = "x; " + ", ".join(f"c{n}=1" for n in range(17))


@pytest.mark.parametrize("formula, position, text", [
    ("", 1, "a formula is expected"),
    (" \t\n", 1, "a formula is expected"),
    ("x+", 3, "a number, a name or '(' is expected"),
    ("x^2 + y^2 +* z", 12, "a number, a name or '(' is expected"),
    ("(x+y", 5, "a ')' is missing"),
    ("x+y)", 4, "a '(' is missing"),
    ("2x", 2, "a product is written 2*x"),
    ("x y", 3, "a product is written 2*x"),
    ("x $ y", 3, "an operator is expected"),
    ("sin x", 5, "'(' is expected after sin"),
    ("sin(x", 6, "a ')' is missing"),
    ("sin(x, y)", 1, "sin needs 1 argument, not 2"),
    ("x + min(y)", 5, "min needs at least 2 arguments, not 1"),
    ("foo(x)", 1, "known functions are abs, min"),
    ("x + sine(y)", 5, "did you mean"),
    ("xy", 1, "a product is written x*y"),
    ("x + a", 5, "a constant needs a value after the formula"),
    ("rad + x", 1, "is expected after a number"),
    ("x < y < z", 7, "only one comparison is allowed"),
    ("(x < 1) + y", 4, "only outside of parentheses"),
    ("x =", 4, "a number, a name or '(' is expected"),
    ("1e999*x", 1, "too large or too small"),
    ("π*é", 3, "a number, a name or '(' is expected"),  # counts characters, not bytes
    ("a*x;", 5, "the name of a constant is expected"),
    ("a*x; a", 7, "'=' is expected after a"),
    ("a*x; a=", 8, "a number, a name or '(' is expected"),
    ("a*x; a=1, a=2", 11, "has a value already"),
    ("x; y=2", 4, "has a meaning already"),
    ("a*x; a=b*x, b=1", 8, "nothing before this is called 'b'"),
    ("a*x; a=1/0", 8, "not a finite number"),
    ("a*x; a=(1<2)", 10, "comparison"),
    (MANY_CONSTANTS, MANY_CONSTANTS.index("c16") + 1, "at most 16 constants"),
    ("(" * 70 + "x" + ")" * 70, 66, "nests too deeply"),
    ("x" + "+x" * 1000, 2001, "at most 2000 bytes"),
    ("x" + "*y/z*w/x" * 250, 2001, "at most 2000 bytes"),
])
async def test_a_wrong_formula_is_refused_with_the_position_of_the_mistake(server, formula, position, text):
    async with Client(server) as client:
        before = await client.request("get", what="state")
        requests = [("load", {"name": "wrong", "format": "formula", "data": formula})]
        if formula.strip() and len(formula) < 1000:
            requests.append(("command", {"line": "formula " + formula}))
        for type_, members in requests:
            with pytest.raises(Refused) as refused:
                await client.request(type_, **members)
            assert refused.value.code == "bad_expression" and text in refused.value.text
            assert int(re.search(r"position (\d+):", refused.value.text).group(1)) == position
        assert {**await client.request("get", what="state"), "id": 0} == {**before, "id": 0}
        await load_field(client, "x")  # the connection and the session still work


async def test_a_formula_at_the_limits_is_accepted(server):
    async with Client(server) as client:
        await load_field(client, "x" + "*y/z*w/x" * 249 + "*y/z*w")  # has 999 operations
        await load_field(client, "(" * 64 + "x" + ")" * 64)
        await load_field(client, " " * 1999 + "x")


async def test_a_formula_of_too_many_instructions_is_refused(server):
    async with Client(server) as client:
        formula = "+".join(f"smin({name},{n},9)" for n in range(36) for name in "xyzw")
        with pytest.raises(Refused, match="instructions; the most allowed are 1000") as refused:
            await load_field(client, formula)
        assert refused.value.code == "bad_expression"
        await load_field(client, "x")


SIDES = '[-1,1],[-1,1],[-1,1]'


@pytest.mark.parametrize("box, code, text", [
    (f"[{SIDES},[1,1]]", "out_of_range", "along w"),
    (f"[[1,-1],{SIDES}]", "out_of_range", "along x are in the wrong order"),
    (f"[{SIDES},[-1e308,1e308]]", "out_of_range", "1e30"),
    (f"[{SIDES},[0,1e-400]]", "out_of_range", "along w"),
    (f"[{SIDES}]", "bad_message", "box"),
    (f"[{SIDES},{SIDES}]", "bad_message", "box"),
    (f"[{SIDES},[1]]", "bad_message", "box"),
    (f"[{SIDES},[1,2,3]]", "bad_message", "box"),
    (f'[{SIDES},["0",1]]', "bad_message", "box"),
    (f"[{SIDES},[null,1]]", "bad_message", "box"),
    ("[]", "bad_message", "box"), ("{}", "bad_message", "box"), ("2", "bad_message", "box"), ("null", "bad_message", "box"),
])
async def test_a_wrong_box_is_refused(server, box, code, text):
    async with field_client(server, "w") as client:
        before = await client.request("get", what="state")
        await client.socket.send('{"type":"load","id":4711,"name":"b","format":"formula","data":"x","box":%s}' % box)
        error = await client.wait_until(lambda: client.answer_to(4711))
        assert (error["type"], error["code"]) == ("error", code), error
        assert text in error["message"]
        assert {**await client.request("get", what="state"), "id": 0} == {**before, "id": 0}
        await load_field(client, "x", [[-1, 1], [-1, 1], [-1, 1], [0, 1]])


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999"])
@pytest.mark.parametrize("message", [
    '{"type":"load","id":4711,"name":"b","format":"formula","data":"x","box":[[-1,1],[-1,1],[-1,1],[0,%s]]}',
    '{"type":"set","id":4711,"levels":[0,%s]}',
])
async def test_nonfinite_numbers_are_refused(server, message, number):
    async with field_client(server, "w") as client, field_client(server, "w") as bystander:
        await client.socket.send(message % number)
        error = await client.wait_until(lambda: next((m for m in client.messages if m["type"] == "error"), None))
        if error["code"] == "bad_json":  # NaN and Infinity are not valid JSON
            assert number != "1e999" and await client.wait_for_close_code() == 1007
            credentials = {"session": client.session or client.welcome["session"], "token": client.welcome["token"]}
            async with Client(server, **credentials) as again:
                state = await again.request("get", what="state")
        else:
            assert error["code"] in ("bad_message", "out_of_range")
            state = await client.request("get", what="state")
        assert (state["polytope"]["name"], state["levels"], state["revision"]) == ("field", [0], 1)
        await bystander.request("key", key="y")


@pytest.mark.parametrize("format_, data", [
    ("points", "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1"), ("cloud", "1 0 0 0\n0 1 0 0"),
])
async def test_polytopes_take_no_box(server, format_, data):
    async with Client(server) as client:
        with pytest.raises(Refused, match="only formulas and arrays take a box"):
            await client.request("load", name="with", format=format_, data=data, box=[[-1, 1]] * 4)
        await client.request("key", key="y")


@pytest.mark.parametrize("query, text", [
    ("box=-1,1,-1,1,-1,1,-1,1", "box needs a formula"),
    ("formula=", "expected"),
    ("formula=x&polytope=24-cell", "at the same time"),
    ("formula=x&box=0,1", "eight numbers"),
])
async def test_a_wrong_query_is_refused(server, query, text):
    answer = server.get("/api/v1/frame.png?" + query)
    assert answer.status == 400
    assert text in answer.body.decode()


@pytest.mark.parametrize("settings, code, text", [
    ({"levels": []}, "", "levels"),
    ({"levels": [1, 2, 3, 4, 5]}, "", "levels"),
    ({"levels": [0.5, 0.5]}, "out_of_range", "different"),
    ({"levels": [0, -0.0]}, "out_of_range", "different"),
    ({"levels": [1e31]}, "out_of_range", "levels"),
    ({"levels": [-1e31, 0]}, "out_of_range", "levels"),
    ({"levels": 1}, "bad_message", "levels"),
    ({"levels": ["1"]}, "bad_message", "levels"),
    ({"levels": [None]}, "bad_message", "levels"),
    ({"levels": [0.1], "inside": "between"}, "bad_message", "inside"),
    ({"inside": 1}, "bad_message", "inside"),
    ({"fog": [{"value": 0, "opacity": 1}]}, "out_of_range", "2 to 8 points"),
    ({"fog": [{"value": n, "opacity": 1} for n in range(9)]}, "bad_message", "fog"),
    ({"fog": [{"value": 1, "opacity": 1}, {"value": 0, "opacity": 0}]}, "out_of_range", "order of their values"),
    ({"fog": [{"value": 0, "opacity": 1}, {"value": -0.0, "opacity": 0}]}, "out_of_range", "different"),
    ({"fog": [{"value": 0, "opacity": 1.5}, {"value": 1, "opacity": 0}]}, "out_of_range", "opacity"),
    ({"fog": [{"value": 0, "opacity": 1}, {"value": 1e31, "opacity": 0}]}, "out_of_range", "value"),
    ({"fog": [{"value": 0, "opacity": 1, "color": -1}, {"value": 1, "opacity": 0}]}, "", "color"),
    ({"fog": [{"value": 0, "opacity": 1, "color": 0x1000000}, {"value": 1, "opacity": 0}]}, "", "color"),
    ({"fog": [{"value": 0}, {"value": 1, "opacity": 0}]}, "bad_message", "opacity"),
    ({"fog": [[0, 1], [1, 0]]}, "bad_message", "fog"),
    ({"fog": None}, "bad_message", "fog"),
    ({"fog": "off"}, "bad_message", "fog"),
])
async def test_wrong_levels_are_refused(server, settings, code, text):
    async with field_client(server, "x*y - z*w") as client:
        await client.request("set", levels=[0.25, -0.25], inside="above")
        before = await client.request("get", what="state")
        with pytest.raises(Refused, match=text) as refused:
            await client.request("set", alpha=1, **settings)
        assert code in refused.value.code and refused.value.code in ("bad_message", "out_of_range")
        assert {**await client.request("get", what="state"), "id": 0} == {**before, "id": 0}
        await client.request("set", levels=[0.125])


@pytest.mark.parametrize("line, text", [
    ("set levels=", ""), ("set levels=1,1", "different"), ("set levels=1,2,3,4,5", "levels"), ("set levels=1e31", "levels"),
    ("set levels=1/0", ""), ("set levels=1,,2", ""), ("set inside=between", "below"), ("fog", "value:opacity"),
    ("fog 0:1", "2 to 8"), ("fog 1:0,0:1", "order"), ("fog 0:1:orange,1:0", "RRGGBB"),
])
async def test_wrong_levels_of_the_command_line_are_refused(server, line, text):
    async with field_client(server, "x*y - z*w") as client:
        with pytest.raises(Refused, match=text):
            await client.request("command", line=line)
        state = await client.request("get", what="state")
        assert (state["levels"], state["inside"], state["revision"]) == ([0], "below", 1)


@pytest.mark.parametrize("settings", [{"levels": [1]}, {"inside": "above"}, {"fog": []}])
async def test_polytopes_and_clouds_have_no_levels(server, settings):
    async with Client(server) as client:
        with pytest.raises(Refused, match="the 5-cell is not a field") as refused:
            await client.request("set", **settings)
        assert refused.value.code == "out_of_range"
        await client.request("load", name="cloud", format="cloud", data="1 0 0 0\n0 1 0 0")
        with pytest.raises(Refused, match="is not a field"):
            await client.request("set", **settings)
        await client.request("key", key="y")


@pytest.mark.parametrize("query, code, text", [
    ({"formula": "x y"}, "bad_expression", "position 3"),
    ({"formula": "x", "box": "-1,1,-1,1,-1,1,2"}, "bad_expression", "eight"),
    ({"formula": "x", "box": "-1,1,-1,1,-1,1,0,2,3"}, "bad_expression", "eight"),
    ({"formula": "x", "box": "-1,1,-1,1,-1,1,2,2"}, "out_of_range", "along w"),
    ({"formula": "x", "box": "-1,1,-1,1,-1,1,a,2"}, "bad_expression", "box"),
    ({"formula": "x", "box": "-1,1,-1,1,-1,1,nan,2"}, "bad_expression", "box"),
    ({"formula": "x", "levels": "1,1"}, "out_of_range", "different"),
    ({"formula": "x", "levels": "1e31"}, "out_of_range", "levels"),
    ({"formula": "x", "levels": ""}, "bad_expression", ""),
    ({"formula": "x", "inside": "between"}, "bad_expression", "below"),
    ({"polytope": "24-cell", "levels": "1"}, "out_of_range", "not a field"),
    ({"formula": "x", "fog": "1"}, "bad_expression", "value:opacity"),
    ({"formula": "x", "fog": "1:0,0:1"}, "out_of_range", "order"),
])
async def test_invalid_queries_are_explained(server, query, code, text):
    answer = await asyncio.to_thread(server.get, "/api/v1/frame.png?" + urlencode({**query, **SIZE}, quote_via=quote))
    assert answer.status == 400, f"{answer.status} {answer.body[:100]}"
    error = json.loads(answer.body)
    assert code in error["code"] and text in error["message"], error
    words = [f"--{name}={value}" for name, value in query.items()]
    done = await asyncio.to_thread(run_oval4d, "render", "-o", "/dev/null", *words)
    assert done.returncode != 0 and text in (done.stdout + done.stderr).decode()
