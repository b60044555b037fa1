"""Sessions in Redis, including a Redis that is unavailable, full, or does not answer."""

import asyncio
import signal
import time

import cluster
import pytest
from harness import DEADLINE
from wire import Client, turned_away


@pytest.fixture(name="redis")
def running_redis(tmp_path):
    redis = cluster.Redis(tmp_path)
    yield redis
    if redis.process and redis.process.poll() is None:
        redis.kill()


def opened_by(client):
    return {"session": client.welcome["session"], "token": client.welcome["token"]}


def says(server, text):
    """Returns whether the text of /readyz contains this; its status must be 200 nevertheless."""
    answer = server.get("/readyz")
    assert answer.status == 200
    return text in answer.body.decode()


async def pressed(server, times=1, **keys):
    """Opens the session of `keys`, or a new one, and presses a key `times` times; returns the session's ID and token,
    and the revision."""
    async with Client(server, **keys) as client:
        for _ in range(times):
            done = await client.request("key", key="k")
        return opened_by(client), done["revision"]


def test_another_server_goes_on_at_once(redis):
    async def scene():
        async with Client(one) as first:
            for i in range(1, 6):
                await first.request("key", key="t")
            await first.request("load", name="mine", format="points",
                                data="".join(f"{a} {b} {c} {d}\n" for a in (-1, 1) for b in (-1, 1) for c in (-1, 2)
                                             for d in (-1, 1)))
            before = await first.request("get", what="state")
            async with Client(two, **opened_by(first)) as second:
                assert {**await second.request("get", what="state"), "id": 0} == {**before, "id": 0}
                # The code that tells this client to reconnect, and so to join the other server.
                assert await first.closed() == 1012
                await second.request("undo")
                assert (await second.request("get", what="state"))["polytope"]["name"] == "5-cell"
                await second.request("set", polytope="mine")
                async with Client(two, **opened_by(first)) as again:
                    await again.request("key", key="y")
        assert one.metric("oval4d_sessions_taken_total") == 1

    redis.start()
    with cluster.server(redis, 0) as one, cluster.server(redis, 0) as two:
        asyncio.run(scene())


def test_redis_is_not_there_at_the_start(redis):
    with_redis = cluster.server(redis, 0)
    try:
        with_redis.wait_for(lambda: says(with_redis, "Connection refused"))
        assert with_redis.metric("oval4d_store_up") == 0
        keys, revision = asyncio.run(pressed(with_redis, 3))
        # Leaves the session and returns; it is in memory only.
        again, revision = asyncio.run(pressed(with_redis, 1, **keys))
        assert (again, revision) == (keys, 4)
        assert with_redis.metric("oval4d_unsaved_sessions") == 1
        assert "store fails" in with_redis.log()
        redis.start()
        with_redis.wait_for(lambda: with_redis.get("/readyz").body == b"ready\n")
        with_redis.wait_for(lambda: with_redis.metric("oval4d_unsaved_sessions") == 0)
        with cluster.server(redis, 0) as other:
            assert asyncio.run(pressed(other, 1, **keys)) == (keys, 5)
        with_redis.stop()
    finally:
        with_redis.kill()


def test_redis_is_full(redis):
    redis.start()
    server = cluster.server(redis, 0)
    try:
        keys, _ = asyncio.run(pressed(server))
        redis.ask("CONFIG", "SET", "maxmemory", "1")
        asyncio.run(pressed(server, 3, **keys))
        server.wait_for(lambda: says(server, "OOM"))
        asyncio.run(pressed(server, 3))
        redis.ask("CONFIG", "SET", "maxmemory", "0")
        server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        assert asyncio.run(pressed(server, 1, **keys)) == (keys, 5)
        server.stop()
    finally:
        server.kill()


def test_redis_hangs(redis):
    async def scene():
        async with Client(server) as client:
            await client.request("key", key="k")
            redis.kill(signal.SIGSTOP)
            start = time.monotonic()
            for i in range(20):
                assert (await client.request("key", key="k"))["revision"] == i + 2
            redis.kill(signal.SIGCONT)
            # The server waits for the timeout once, not for each of the twenty keys.
            assert time.monotonic() - start < DEADLINE / 2
            return opened_by(client)

    redis.start()
    server = cluster.server(redis, 0, "--store-timeout", 0.2)
    try:
        keys = asyncio.run(scene())
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        with cluster.server(redis, 0) as other:
            assert asyncio.run(pressed(other, 1, **keys))[1] == 22
        assert server.metric('oval4d_store_failures_total{operation="save"}') > 0
        server.stop()
    finally:
        server.kill()


def test_a_session_elsewhere_is_not_called_lost(redis):
    """The client is told to try again, not that the session does not exist."""
    redis.start()
    with cluster.server(redis, 0) as one:
        keys, _ = asyncio.run(pressed(one))
    redis.kill()

    two = cluster.server(redis, 0)
    try:
        assert asyncio.run(turned_away(two, **keys)) == ("internal", 1013)
        redis.start()
        two.wait_for(lambda: two.get("/readyz").body == b"ready\n")
        assert asyncio.run(pressed(two, 1, **keys))[1] == 2
        two.stop()
    finally:
        two.kill()
