"""A store contains no plain tokens of sessions: those that earlier versions have left are erased, in files and in Redis."""

import contextlib
import shutil
import sqlite3
import subprocess

from harness import DEADLINE, PROGRAM, Server, free_port, is_listening, wait_until
from stores import (create_sessions, credentials_of, files_containing, press_key, server_with_store, session_revision,
                    sphere_points, store_files, wait_until_saved)
from wire import Client, hello_refusal

# The tables in version 1 of the file, which stored tokens as plain text.
SCHEMA_VERSION_1 = """
    CREATE TABLE IF NOT EXISTS session (
        id TEXT PRIMARY KEY, token TEXT NOT NULL, fence INTEGER NOT NULL,
        touched INTEGER NOT NULL,  -- milliseconds since 1970
        whole BLOB NOT NULL, head BLOB NOT NULL) WITHOUT ROWID;
    CREATE INDEX IF NOT EXISTS session_touched ON session (touched);
    CREATE TABLE IF NOT EXISTS polytope (
        session TEXT NOT NULL REFERENCES session ON DELETE CASCADE, key TEXT NOT NULL, bytes BLOB NOT NULL,
        PRIMARY KEY (session, key));
    PRAGMA user_version = 1;"""

# The script with which servers of version 0.1.0 save sessions. Every byte counts, because Redis identifies scripts by
# their digest.
SAVE_SCRIPT_0_1_0 = """
local fence, owner = unpack(redis.call('HMGET', KEYS[1], 'fence', 'owner'))
local mine = tonumber(ARGV[3])
if fence then
  fence = tonumber(fence)
  if fence > mine or (fence == mine and owner and owner ~= '' and owner ~= ARGV[1]) then return 1 end
elseif ARGV[6] == '' then return 2 end
local keeper = ARGV[1]
if ARGV[7] == '1' then keeper = '' end
redis.call('HSET', KEYS[1], 'fence', mine, 'owner', keeper, 'head', ARGV[5])
if ARGV[6] ~= '' then
  redis.call('HSET', KEYS[1], 'token', ARGV[4], 'whole', ARGV[6])
  redis.call('PEXPIRE', KEYS[1], ARGV[2])
  redis.call('PEXPIRE', KEYS[2], ARGV[2])
end
local last = 8 + 2 * tonumber(ARGV[8])
for i = 9, last, 2 do redis.call('HSET', KEYS[2], ARGV[i], ARGV[i + 1]) end
if last > 8 then redis.call('PEXPIRE', KEYS[2], ARGV[2]) end
for i = last + 1, #ARGV do redis.call('HDEL', KEYS[2], ARGV[i]) end
return 0"""


def convert_to_version_1(store_path, tokens):
    """Rewrites the file in version 1, with tokens of deleted sessions left in its free pages."""
    with contextlib.closing(sqlite3.connect(store_path)) as file:
        sessions = file.execute("SELECT id, fence, touched, whole, head FROM session").fetchall()
        polytopes = file.execute("SELECT session, key, bytes FROM polytope").fetchall()
    for old in store_files(store_path):
        old.unlink()
    deleted_tokens = [f"tokenofsessionthatisgone{i:08}" for i in range(200)]
    with contextlib.closing(sqlite3.connect(store_path, isolation_level=None)) as file:
        file.execute("PRAGMA journal_mode = WAL")
        file.execute("PRAGMA secure_delete = OFF")
        file.executescript(SCHEMA_VERSION_1)
        for i, token in enumerate(deleted_tokens):
            file.execute("INSERT INTO session VALUES (?, ?, 1, 0, ?, '')", (f"gone{i}", token, b"x" * 900))
        file.execute("DELETE FROM session")
        for id_, *rest in sessions:
            file.execute("INSERT INTO session VALUES (?, ?, ?, ?, ?, ?)", (id_, tokens[id_], *rest))
        file.executemany("INSERT INTO polytope VALUES (?, ?, ?)", polytopes)
    store_path.chmod(0o644)
    assert [token for token in deleted_tokens if files_containing(store_path, token)]
    return deleted_tokens


async def test_version_1_sessions_are_converted_and_their_plain_tokens_erased(store_path):
    with server_with_store(store_path) as server:
        made = await create_sessions(server, 8)
        async with Client(server) as client:
            await client.request("load", name="mine", format="points", data=sphere_points(40, 1))
            made.append((credentials_of(client), 1))
    tokens = {credentials["session"]: credentials["token"] for credentials, _ in made}
    deleted_tokens = convert_to_version_1(store_path, tokens)
    assert all(files_containing(store_path, token) for token in tokens.values())
    # If the server is killed during the conversion of the file, the next start repeats the conversion.
    for log_bytes in (0, 1, 16 << 10):  # kills the server when SQLite's log has this size
        copy = store_path.with_name("killed.sqlite")
        log, output = copy.with_name(copy.name + "-wal"), copy.with_name("output")
        shutil.copy(store_path, copy)
        with output.open("wb") as file:
            killed = subprocess.Popen([PROGRAM, "--port", "0", "--store", f"sqlite:{copy}"], stderr=file)
        while killed.poll() is None and b" listening " not in output.read_bytes():
            if log.exists() and log.stat().st_size >= log_bytes:
                break
        killed.kill()
        killed.wait()
        shutil.move(copy, store_path)
        for suffix in ("-wal", "-shm"):
            if copy.with_name(copy.name + suffix).exists():
                shutil.move(copy.with_name(copy.name + suffix), store_path.with_name(store_path.name + suffix))
    server = server_with_store(store_path)
    try:
        for token in [*tokens.values(), *deleted_tokens]:
            assert not files_containing(store_path, token), "a running server has left a plain token in the file"
        for credentials, revision in made:
            assert await hello_refusal(server, credentials["session"], token="b" * 32) == ("bad_token", 4401)
            assert await session_revision(server, credentials) == revision
        async with Client(server, **made[-1][0]) as client:
            assert (await client.request("get", what="state"))["polytope"]["name"] == "mine"
        server.stop()
    finally:
        server.kill()
    for token in [*tokens.values(), *deleted_tokens]:
        assert not files_containing(store_path, token)
    with contextlib.closing(sqlite3.connect(store_path)) as file:
        assert file.execute("PRAGMA user_version").fetchone() == (2,)
        assert file.execute("PRAGMA integrity_check").fetchone() == ("ok",)


class Redis:
    def __init__(self, folder):
        self.port = free_port()
        self.process = subprocess.Popen(["redis-server", "--port", str(self.port), "--bind", "127.0.0.1", "--dir", folder,
                                         "--save", ""], stdout=subprocess.DEVNULL)
        wait_until(lambda: is_listening("127.0.0.1", self.port), "Redis")

    def command(self, *words):
        done = subprocess.run(["redis-cli", "-p", str(self.port), *words], capture_output=True, check=True)
        return done.stdout.decode(errors="replace").strip()

    def start_server(self, *options):
        return Server("--workers", 1, "--store", f"redis://127.0.0.1:{self.port}", "--store-timeout", DEADLINE, *options)

    def session_fields(self, credentials):
        return self.command("HKEYS", f"oval4d:{{{credentials['session']}}}").split()

    def rewrite_as_version_0_1_0(self, credentials):
        """Rewrites a session as a server of version 0.1.0 would have saved it."""
        key = f"oval4d:{{{credentials['session']}}}"
        self.command("HDEL", key, "hash")
        self.command("HSET", key, "token", credentials["token"])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


async def test_redis_contains_no_plain_tokens(tmp_path):
    with Redis(tmp_path) as redis:
        with redis.start_server() as server:
            credentials, _ = await press_key(server)
        assert "hash" in redis.session_fields(credentials) and "token" not in redis.session_fields(credentials)
        redis.rewrite_as_version_0_1_0(credentials)
        with redis.start_server() as server:
            assert await hello_refusal(server, credentials["session"], token="c" * 32) == ("bad_token", 4401)
            assert "token" not in redis.session_fields(credentials)
            assert await press_key(server, **credentials) == (credentials, 2)
        assert credentials["token"] not in redis.command("HGETALL", f"oval4d:{{{credentials['session']}}}")


async def test_redis_keeps_plain_tokens_for_servers_of_version_0_1_0(tmp_path):
    """Those servers find sessions by the plain-text token, which is therefore kept for the duration of the expiry."""
    with Redis(tmp_path) as redis:
        redis.command("SCRIPT", "LOAD", SAVE_SCRIPT_0_1_0)
        with redis.start_server() as server:
            credentials, _ = await press_key(server)
            other, _ = await press_key(server)
            wait_until_saved(server)
            assert {"hash", "token"} <= set(redis.session_fields(credentials)), "a new session"
            redis.rewrite_as_version_0_1_0(other)
            assert await press_key(server, **other) == (other, 2)
            wait_until_saved(server)
            assert {"hash", "token"} <= set(redis.session_fields(other)), "a session of the older server"
        assert int(redis.command("GET", "oval4d:tokens_hashed_since")) > 0
        redis.command("SET", "oval4d:tokens_hashed_since", "1")  # a time in January 1970
        with redis.start_server() as server:
            assert await press_key(server, **other) == (other, 3)
            server.wait_for(lambda: "token" not in redis.session_fields(other))
            assert await press_key(server, **other) == (other, 4)
            assert "token" not in redis.session_fields(other)
