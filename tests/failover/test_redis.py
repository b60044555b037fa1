"""Sessions in Redis, including a Redis that is unavailable, full, or does not answer."""

import asyncio
import contextlib
import signal
import sqlite3

import cluster
import pytest
import all_settings
from test_stored_sessions import VERSIONS, data_options, expect_sessions
from wire import Client, hello_refusal, with_another_member


# Scripts that read a member of a hash, replace members, and read all members, as hexadecimal digits.
READ_HEX = """local text = redis.call('HGET', KEYS[1], ARGV[1])
return (text:gsub('.', function(c) return string.format('%02x', c:byte()) end))"""
WRITE_HEX = """for i = 1, #ARGV, 2 do
  local bytes = ARGV[i + 1]:gsub('..', function(digits) return string.char(tonumber(digits, 16)) end)
  redis.call('HSET', KEYS[1], ARGV[i], bytes)
end"""
READ_ALL_HEX = """local all = redis.call('HGETALL', KEYS[1])
for i, text in ipairs(all) do all[i] = text:gsub('.', function(c) return string.format('%02x', c:byte()) end) end
return table.concat(all, ' ')"""
FAILED_SAVES = 'oval4d_store_failures_total{operation="save"}'


@pytest.fixture(name="redis")
def prepare_redis(tmp_path):
    redis = cluster.Redis(tmp_path)
    yield redis
    if redis.process and redis.process.poll() is None:
        redis.kill()


def credentials_of(client):
    return {"session": client.welcome["session"], "token": client.welcome["token"]}


def readyz_contains(server, text):
    """Returns whether the body of /readyz contains the text; asserts that the status is 200."""
    answer = server.get("/readyz")
    assert answer.status == 200
    return text in answer.body.decode()


async def press_keys(server, times=1, **credentials):
    """Opens the session of `credentials`, or a new one, and presses a key `times` times; returns the session's ID and
    token, and the revision."""
    async with Client(server, **credentials) as client:
        for _ in range(times):
            done = await client.request("key", key="k")
        return credentials_of(client), done["revision"]


def test_redis_loses_no_setting_and_no_motion(redis):
    async def get_state(client):
        return await client.request("get", what="state")

    async def before_and_after(prepare, get):
        with cluster.start_server(redis, 0) as server:
            async with Client(server, stream="none") as client:
                await prepare(client)
                before = await get(client)
        with cluster.start_server(redis, 0) as server:
            async with Client(server, stream="none", **credentials_of(client)) as client:
                return before, await get(client)

    with redis:
        for prepare in all_settings.SESSIONS:
            before, after = asyncio.run(before_and_after(prepare, get_state))
            assert {**after, "id": 0, "object_serial": 0} == {**before, "id": 0, "object_serial": 0}
        before, after = asyncio.run(before_and_after(all_settings.polytope_in_motion, all_settings.motion))
        assert after == before == all_settings.MOTION


def stored_hashes(folder):
    """Yields the keys and the fields of the hashes in Redis that the version of a folder has for its stored sessions.

    A version stores the same records in Redis as in an SQLite file. The keys and the fields have been the same since
    0.1.0, except that 0.1.0 stored tokens as plain text.
    """
    uri = (folder / "sessions.sqlite").resolve().as_uri() + "?immutable=1"
    with contextlib.closing(sqlite3.connect(uri, uri=True)) as file:
        file.row_factory = sqlite3.Row
        for row in file.execute("SELECT * FROM session"):
            key = "oval4d:{" + row["id"] + "}"
            token = {"hash": row["token_hash"]} if "token_hash" in row.keys() else {"token": row["token"]}
            yield key, {"fence": str(row["fence"]), "owner": "", "whole": row["whole"], "head": row["head"], **token}
            objects = file.execute("SELECT key, bytes FROM polytope WHERE session = ?", (row["id"],))
            yield key + ":polytopes", dict(tuple(each) for each in objects)


@pytest.mark.parametrize("folder", VERSIONS, ids=lambda folder: folder.name)
def test_sessions_of_every_version_are_opened(redis, folder):
    redis.start()
    for key, fields in stored_hashes(folder):
        digits = {name: (value.encode() if isinstance(value, str) else value).hex() for name, value in fields.items()}
        redis.command("EVAL", WRITE_HEX, "1", key, *(word for field in digits.items() for word in field))
        assert redis.command("HLEN", key) == str(len(fields))
    with cluster.start_server(redis, 0, *data_options(folder)) as server:
        asyncio.run(expect_sessions(server, folder))


def test_another_server_takes_over_an_open_session(redis):
    async def interrupt_session():
        async with Client(one) as first:
            for i in range(1, 6):
                await first.request("key", key="t")
            await first.request("load", name="mine", format="points",
                                data="".join(f"{a} {b} {c} {d}\n" for a in (-1, 1) for b in (-1, 1) for c in (-1, 2)
                                             for d in (-1, 1)))
            before = await first.request("get", what="state")
            async with Client(two, **credentials_of(first)) as second:
                after = await second.request("get", what="state")
                assert {**after, "id": 0, "object_serial": 0} == {**before, "id": 0, "object_serial": 0}
                # The close code tells this client to reconnect, which leads it to the other server.
                assert await first.wait_for_close_code() == 1012
                await second.request("undo")
                assert (await second.request("get", what="state"))["polytope"]["name"] == "5-cell"
                await second.request("set", polytope="mine")
                async with Client(two, **credentials_of(first)) as again:
                    await again.request("key", key="y")
        one.wait_for(lambda: one.metric("oval4d_sessions_taken_total") == 1)

    redis.start()
    with cluster.start_server(redis, 0) as one, cluster.start_server(redis, 0) as two:
        asyncio.run(interrupt_session())


def test_sessions_are_saved_once_redis_starts(redis):
    with_redis = cluster.start_server(redis, 0)
    try:
        with_redis.wait_for(lambda: readyz_contains(with_redis, "Connection refused"))
        assert with_redis.metric("oval4d_store_up") == 0
        credentials, revision = asyncio.run(press_keys(with_redis, 3))
        # Leaves the session and returns; it is in memory only.
        again, revision = asyncio.run(press_keys(with_redis, 1, **credentials))
        assert (again, revision) == (credentials, 4)
        with_redis.wait_for(lambda: with_redis.metric("oval4d_unsaved_sessions") == 1)
        assert "store unavailable" in with_redis.log()
        redis.start()
        with_redis.wait_for(lambda: with_redis.get("/readyz").body == b"ready\n")
        with_redis.wait_for(lambda: with_redis.metric("oval4d_unsaved_sessions") == 0)
        with cluster.start_server(redis, 0) as other:
            assert asyncio.run(press_keys(other, 1, **credentials)) == (credentials, 5)
        with_redis.stop()
    finally:
        with_redis.kill()


def test_sessions_survive_a_full_redis(redis):
    redis.start()
    server = cluster.start_server(redis, 0)
    try:
        credentials, _ = asyncio.run(press_keys(server))
        redis.command("CONFIG", "SET", "maxmemory", "1")
        asyncio.run(press_keys(server, 3, **credentials))
        server.wait_for(lambda: readyz_contains(server, "OOM"))
        asyncio.run(press_keys(server, 3))
        redis.command("CONFIG", "SET", "maxmemory", "0")
        server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        assert asyncio.run(press_keys(server, 1, **credentials)) == (credentials, 5)
        server.stop()
    finally:
        server.kill()


def test_sessions_survive_a_hanging_redis(redis):
    async def interrupt_session():
        async with Client(server) as client:
            await client.request("key", key="k")
            redis.kill(signal.SIGSTOP)
            for i in range(20):
                assert (await client.request("key", key="k"))["revision"] == i + 2
                if i == 0:
                    failures = server.metric(FAILED_SAVES)
            # The server waits for the timeout once, not for each of the twenty keys.
            assert server.metric(FAILED_SAVES) < failures + 19
            redis.kill(signal.SIGCONT)
            return credentials_of(client)

    redis.start()
    server = cluster.start_server(redis, 0, "--store-timeout", 1)
    try:
        credentials = asyncio.run(interrupt_session())
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        with cluster.start_server(redis, 0) as other:
            assert asyncio.run(press_keys(other, 1, **credentials))[1] == 22
        assert server.metric(FAILED_SAVES) > 0
        server.stop()
    finally:
        server.kill()


def test_a_session_of_a_later_version_is_refused_and_stays_with_its_server(redis):
    redis.start()
    with cluster.start_server(redis, 0) as server:
        credentials, _ = asyncio.run(press_keys(server, 2))
        server.wait_for(lambda: server.metric("oval4d_open_sessions") == 0)
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        key = "oval4d:{" + credentials["session"] + "}"

        def evaluate(script, *arguments):
            return redis.command("EVAL", script, "1", key, *arguments)

        # A server of a later version has stored the session, and has it open.
        whole = bytes.fromhex(evaluate(READ_HEX, "whole"))
        evaluate(WRITE_HEX, "whole", with_another_member(whole).hex())
        redis.command("HSET", key, "owner", "later")
        assert redis.command("PERSIST", key) == "1", "an expiry period that begins again would be noticed"
        before = evaluate(READ_ALL_HEX)
        for _ in range(2):
            assert asyncio.run(hello_refusal(server, **credentials)) == ("later_version", 1013)
        assert evaluate(READ_ALL_HEX) == before
        assert redis.command("TTL", key) == "-1"
        assert redis.command("EXISTS", "oval4d:taken:later") == "0"
        assert "session of a later version refused" in server.log()

        # A session that the server can open is taken over from the other one.
        evaluate(WRITE_HEX, "whole", whole.hex())
        assert asyncio.run(press_keys(server, 1, **credentials)) == (credentials, 3)
        assert redis.command("EXISTS", "oval4d:taken:later") == "1"


def test_an_unreachable_session_is_not_reported_as_missing(redis):
    """The server tells the client to try again, and not that the session does not exist."""
    redis.start()
    with cluster.start_server(redis, 0) as one:
        credentials, _ = asyncio.run(press_keys(one))
    redis.kill()

    two = cluster.start_server(redis, 0)
    try:
        assert asyncio.run(hello_refusal(two, **credentials)) == ("internal", 1013)
        redis.start()
        two.wait_for(lambda: two.get("/readyz").body == b"ready\n")
        assert asyncio.run(press_keys(two, 1, **credentials))[1] == 2
        two.stop()
    finally:
        two.kill()
