"""Servers with a store in a file, the sessions that clients leave in it, and the files of the store."""

import random

from harness import Server
from wire import Client, Refused

MIB = 1 << 20


def server_with_store(store_path, quota="1G", **variables):
    return Server("--workers", 1, "--store", f"sqlite:{store_path}", "--store-quota", quota, **variables)


def wait_until_saved(server, open_sessions=0):
    """Waits until no more than so many sessions are open and everything is written to the store."""
    server.wait_for(lambda: server.metric("oval4d_open_sessions") <= open_sessions)
    server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)


def credentials_of(client):
    return {"session": client.welcome["session"], "token": client.welcome["token"]}


async def press_key(server, key="k", times=1, **credentials):
    """Opens the session of `credentials`, or a new one, and presses a key; returns the session's ID and token, and the
    revision."""
    async with Client(server, **credentials) as client:
        for _ in range(times):
            done = await client.request("key", key=key)
        return credentials_of(client), done["revision"]


async def create_sessions(server, count):
    """Creates sessions with different numbers of key presses; returns (ID and token, revision) of each."""
    made = []
    for i in range(count):
        credentials, revision = await press_key(server, times=i % 7 + 1)
        made.append((credentials, revision))
    return made


async def session_revision(server, credentials):
    """Returns the revision of a session, None if the server answers that there is no such session."""
    try:
        async with Client(server, **credentials) as client:
            return (await client.request("get", what="state"))["revision"]
    except Refused as refused:
        assert refused.code == "not_found", refused
        return None


def sphere_points(count, seed):
    """Returns random points of the 3-sphere, as text."""
    rng = random.Random(seed)
    points = ([rng.gauss(0, 1) for _ in range(4)] for _ in range(count))
    return "\n".join(" ".join(f"{x / sum(y * y for y in point) ** 0.5:.6f}" for x in point) for point in points)


def store_files(store_path):
    return [file for file in store_path.parent.iterdir() if file.name.startswith(store_path.name)]


def files_containing(store_path, text):
    return [file.name for file in store_files(store_path) if text.encode() in file.read_bytes()]


async def client_with_loaded_polytope(server, seed, **credentials):
    """Opens a session and loads a polytope of about 70 kB; returns the connected client."""
    client = Client(server, **credentials)
    await client.__aenter__()
    await client.request("load", name="mine", format="points", data=sphere_points(250, seed))
    return client
