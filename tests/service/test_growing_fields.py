"""Growing fields: moments that are appended to an array, in messages and in uploads."""

import json
import re

import pytest
from array_clients import SIZE, load, put, state_of, unnumbered
from array_files import npy, quadratic
from harness import Server
from wire import Client, Refused


@pytest.mark.parametrize("by_http", [True, False])
async def test_appended_moments_equal_the_whole_array(server, by_http):
    values = quadratic((12, 9, 10, 11))
    async with Client(server) as client, Client(server) as whole:
        await load(client, "run", npy(values[:2]), box=[[-1, 1], [-1, 1], [-1, 1], [0, 1]])
        await load(whole, "run", npy(values), box=[[-1, 1], [-1, 1], [-1, 1], [0, 11]])
        settings = {"levels": [0.25], "inside": "above", "slices": {"count": 11, "spacing": 0.2}}
        for each in (client, whole):
            await each.request("set", **settings)
            await each.request("rotate", planes=["xw"], angles=[0.3])
        for moment in range(2, 12):
            if by_http:
                answer = await put(client, "run", npy(values[moment]), method="POST", moments=True)
                assert answer.status == 200, answer.body
            else:
                await load(client, "run", npy(values[moment : moment + 1]), append=True)
        grown, expected = [unnumbered(await state_of(each)) for each in (client, whole)]
        assert grown["revision"] == 13 and expected["revision"] == 3
        assert {**grown, "revision": 0, "object_serial": 0} == {**expected, "revision": 0, "object_serial": 0}
        grown, expected = [(await each.request("get", what="slices", **SIZE))["slices"] for each in (client, whole)]
        assert grown == expected and any("surface" in piece for piece in grown)
        await client.request("undo")  # undoes the rotation, but not the moments
        await whole.request("undo")
        grown, expected = [(await each.request("get", what="slices", **SIZE))["slices"] for each in (client, whole)]
        assert grown == expected


async def test_a_field_grows_while_another_object_is_shown(server):
    values = quadratic((4, 5, 6, 7))
    async with Client(server) as client:
        await load(client, "run", npy(values[:1]))
        await client.request("set", polytope="24-cell")
        done = await load(client, "run", npy(values[1:]), append=True)
        assert done["revision"] == 2 and (await state_of(client))["polytope"]["name"] == "24-cell"
        await client.request("set", polytope="run")
        await client.request("set", levels=[0.5])
        welcome = client.welcome
        slices = (await client.request("get", what="slices", **SIZE))["slices"]
    async with Client(server, welcome["session"], token=welcome["token"]) as again:  # reads it from the store
        assert (await again.request("get", what="slices", **SIZE))["slices"] == slices


@pytest.mark.parametrize("name, values, code, text", [
    ("run", quadratic((1, 5, 6, 8)), "bad_field", "8 × 6 × 5 samples along x, y and z, but the field has 7 × 6 × 5"),
    ("nothing", quadratic((1, 5, 6, 7)), "not_found", "no field called 'nothing'"),
    ("formula", quadratic((1, 5, 6, 7)), "bad_field", "only to an array"),
])
async def test_moments_that_do_not_fit_are_refused(server, name, values, code, text):
    async with Client(server) as client:
        await client.request("command", line="formula x")
        await load(client, "run", npy(quadratic((4, 5, 6, 7))))
        before = unnumbered(await state_of(client))
        with pytest.raises(Refused) as refused:
            await load(client, name, npy(values), append=True)
        assert refused.value.code == code and text in refused.value.text
        assert unnumbered(await state_of(client)) == before


async def test_a_growing_field_is_bounded():
    values = quadratic((4, 8, 8, 8))  # a moment has 2 KiB
    with Server("--max-field-bytes", "32k") as server:
        async with Client(server) as client:
            await load(client, "run", npy(values))
            for _ in range(3):
                await load(client, "run", npy(values), append=True)
            before = unnumbered(await state_of(client))
            slices = (await client.request("get", what="slices", **SIZE))["slices"]
            text = r"8 × 8 × 8 samples, at most 16 moments .*\(--max-field-bytes\).* would have 17; it stays as it was"
            for by_http in (False, True):
                if by_http:
                    answer = await put(client, "run", npy(values[0]), method="POST", moments=True)
                    assert answer.status == 413 and re.search(text, str(json.loads(answer.body))), answer.body
                else:
                    with pytest.raises(Refused, match=text) as refused:
                        await load(client, "run", npy(values[0]), append=True)
                    assert refused.value.code == "too_large"
                assert unnumbered(await state_of(client)) == before
                assert (await client.request("get", what="slices", **SIZE))["slices"] == slices


@pytest.mark.release_only
async def test_a_growing_field_is_held_once(server):
    """The history does not keep the shorter versions."""
    values = quadratic((2, 32, 32, 32))
    with Server("--max-client-bytes", "64M") as own:
        async with Client(own) as client:
            await load(client, "run", npy(values))
            for moment in range(60):
                await client.request("rotate", planes=["xw"], angles=[0.1])
                await load(client, "run", npy(values[moment % 2]), append=True)
            # There are 62 time steps of 128 KiB, plus a margin. Bytes reserved for a request are freed shortly after
            # its answer.
            own.wait_for(lambda: own.metric("oval4d_client_bytes") < 20 << 20)
            for _ in range(60):
                await client.request("undo")
            assert (await state_of(client))["polytope"]["name"] == "run"
