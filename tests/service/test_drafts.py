"""Drafts: while a field turns or changes quickly, its pictures are coarser; once it rests, a complete one follows."""

import png
import pytest
from surfaces import field_client
from wire import Client

SIZE = {"width": 320, "height": 180}
TIGER = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 < 0.09"


async def turn(client, times):
    """Turns several times in quick succession: the server has received all turns before the first is answered. Returns
    the last revision."""
    for _ in range(times - 1):
        await client.send("rotate", planes=["xw"], angles=[0.02])
    return (await client.request("rotate", planes=["xw"], angles=[0.02]))["revision"]


async def turn_until_a_draft(client):
    """Turns until a draft has arrived; returns the last revision. Waits for a picture after each burst of turns, so that
    the turns stay below the maximum rate of messages however fast the server answers them."""
    while True:
        pictures = len(client.pictures())
        revision = await turn(client, 10)
        await client.wait_until(lambda: len(client.pictures()) > pictures)
        if any("draft" in m for m in client.states()):
            return revision


def triangles(message):
    return sum(len(piece["surface"]["triangles"]) for piece in message["slices"] if "surface" in piece)


async def test_slices_are_drafts_while_a_field_turns_and_complete_once_it_rests(server):
    async with field_client(server, TIGER, stream="geometry", **SIZE) as client:
        first = await client.wait_for_slices(1)
        last = await turn_until_a_draft(client)
        complete = await client.wait_for_slices(last)
        drafts = [m for m in client.streamed_messages("slices") if "draft" in m]
        assert drafts and all(1 < m["revision"] <= last for m in drafts)
        assert max(triangles(m) for m in drafts) < 0.7 * triangles(first)
        assert triangles(complete) == pytest.approx(triangles(first), rel=0.2)
        got = await client.request("get", what="slices", **SIZE)
        assert got["slices"] == complete["slices"] and "draft" not in got
        states = [m for m in client.states() if m["revision"] == last]
        assert "draft" not in states[-1]


async def test_the_last_frame_is_complete_and_equal_to_a_requested_one(server):
    async with field_client(server, TIGER, stream="frames", **SIZE) as client:
        last = await turn_until_a_draft(client)
        complete = await client.wait_for_frame(last)
        assert "draft" not in png.state_in(complete)
        assert png.pixels(complete) == png.pixels(await client.request_frame(**SIZE))
        assert any("draft" in m for m in client.states())


async def test_a_field_that_turns_continuously_has_drafts_until_it_stops(server):
    async with field_client(server, TIGER, stream="geometry", **SIZE) as client:
        await turn(client, 1)
        await client.request("set", turning=True)
        await client.wait_until(lambda: len([m for m in client.streamed_messages("slices") if "draft" in m]) > 5)
        done = await client.request("set", turning=False)
        complete = await client.wait_for_slices(done["revision"])
        got = await client.request("get", what="slices", **SIZE)
        assert got["slices"] == complete["slices"]


async def test_polytopes_have_one_picture_for_each_revision_and_no_drafts(server):
    async with Client(server, stream="geometry", **SIZE) as client:
        for _ in range(3):  # a second picture of a revision would come before pictures of later ones
            last = await turn(client, 20)
            await client.wait_for_slices(last)
        revisions = [m["revision"] for m in client.streamed_messages("slices")]
        assert len(revisions) == len(set(revisions))
        assert not any("draft" in m for m in client.states())


async def test_a_state_of_a_draft_is_a_valid_set(server):
    async with field_client(server, TIGER, stream="geometry", **SIZE) as client:
        await turn_until_a_draft(client)
        draft = next(m for m in client.states() if "draft" in m)
        await client.request("set", **{key: value for key, value in draft.items() if key != "type"})
