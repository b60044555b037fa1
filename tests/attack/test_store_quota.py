"""A store that is full: its quota, which evicts sessions that are not open, and a full disk."""

import resource

import pytest
from harness import Server
from stores import (MIB, client_with_loaded_polytope, credentials_of, press_key, server_with_store, session_revision,
                    store_files, wait_until_saved)
from wire import Client


def store_size(store_path):
    return sum(file.stat().st_size for file in store_files(store_path) if file.exists())


async def test_the_store_quota_evicts_sessions(store_path):
    server = server_with_store(store_path, quota="1M")
    try:
        touched = [await press_key(server) for _ in range(2)]
        async with Client(server) as first:
            async with Client(server) as bare:
                untouched = credentials_of(bare)
            credentials = []
            for i in range(30):
                client = await client_with_loaded_polytope(server, i)
                credentials.append(credentials_of(client))
                await client.leave()
                assert store_size(store_path) <= MIB
            wait_until_saved(server, 1)
            assert server.get("/readyz").body == b"ready\n" and "sessions evicted" in server.log()
            assert store_size(store_path) <= MIB
            assert await session_revision(server, untouched) is None
            assert await session_revision(server, touched[0][0]) is None, "the oldest of the changed sessions must be evicted"
            assert await session_revision(server, credentials[-1]) == 1
            assert (await first.request("key", key="k"))["revision"] == 1
            saved = credentials_of(first)
        server.stop()
    finally:
        server.kill()
    with server_with_store(store_path, quota="1M") as server:
        assert await session_revision(server, saved) == 1


@pytest.mark.parametrize("place", ["file", "memory"])
async def test_open_sessions_are_never_evicted(store_path, place):
    store = f"sqlite:{store_path}" if place == "file" else "memory"
    server = Server("--workers", 1, "--store", store, "--store-quota", "1M")
    try:
        clients = []
        for i in range(25):
            clients.append(await client_with_loaded_polytope(server, i))
        if place == "file":
            server.wait_for(lambda: b"--store-quota" in server.get("/readyz").body)
            assert "store unavailable" in server.log() and server.metric("oval4d_store_up") == 0
            assert store_size(store_path) <= MIB
        for client in clients:
            assert (await client.request("key", key="k"))["revision"] == 2
        for client in clients[1:]:
            await client.leave()
        server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
        wait_until_saved(server, 1)
        kept = [await session_revision(server, credentials_of(client)) for client in clients]
        assert kept[0] == kept[-1] == 2 and kept.count(None) > 3
        await clients[0].leave()
        server.stop()
    finally:
        server.kill()


async def test_sessions_survive_a_full_disk(tmp_path):
    """A limit on the file size simulates a full disk."""
    store_path = tmp_path / "sessions.sqlite"
    server = server_with_store(store_path)
    try:
        kept, _ = await press_key(server)
        wait_until_saved(server)
        limit_file_size(server, 4096)
        async with Client(server) as client:
            assert (await client.request("key", key="k"))["revision"] == 1
            server.wait_for(lambda: b"the store is unavailable" in server.get("/readyz").body)
            assert server.get("/readyz").status == 200
            assert await session_revision(server, kept) == 1, "saved sessions must remain readable"
            assert (await client.request("key", key="k"))["revision"] == 2
            limit_file_size(server, -1)
            server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
            credentials = credentials_of(client)
        wait_until_saved(server)
        server.stop()
    finally:
        server.kill()
    with server_with_store(store_path) as server:
        assert await session_revision(server, credentials) == 2


def limit_file_size(server, size):
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
