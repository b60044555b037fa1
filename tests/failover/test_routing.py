"""HAProxy sends uploads to the server that has their session open."""

import asyncio

import cluster
from array_clients import put, state_of
from array_files import npy, quadratic
from wire import Client

SESSIONS = 10  # with a random choice of the server, all uploads would reach theirs once in a thousand times


async def open_session(proxy):
    """Creates a session, and leaves it; returns its ID and token."""
    async with Client(proxy) as client:
        await client.request("key", key="k")  # once it is acknowledged, Redis has the session
        return {"session": client.welcome["session"], "token": client.welcome["token"]}


async def upload_to_open_sessions(proxy):
    for number in range(SESSIONS):
        async with Client(proxy, **await open_session(proxy)) as client:
            uploaded = await put(client, f"run{number}", npy(quadratic()))
            assert uploaded.status == 200, uploaded.body
            appended = await put(client, f"run{number}", npy(quadratic()), method="POST", moments=True)
            assert appended.status == 200, appended.body
            assert (await state_of(client))["polytope"]["name"] == f"run{number}"
            # A server from which another one has taken the session could not save this, and would close the connection.
            assert (await client.request("key", key="k"))["revision"] == appended.message["revision"] + 1


def test_uploads_reach_the_server_of_their_session(tmp_path):
    with cluster.Redis(tmp_path) as redis, cluster.start_server(redis, 0) as one, cluster.start_server(redis, 0) as two, \
            cluster.Proxy(tmp_path, [one.port, two.port]) as proxy:
        asyncio.run(upload_to_open_sessions(proxy))
