"""Attacks on a server's store: its files are read, replaced, damaged and filled, and the server is killed."""

import asyncio
import contextlib
import os
import random
import resource
import shutil
import signal
import sqlite3
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "service"))
from harness import DEADLINE, PROGRAM, Server, answers, free_port, run, until  # noqa: E402
from wire import Client, Refused, turned_away  # noqa: E402

MIB = 1 << 20

# The tables of version 1 of the file, which stored tokens as plain text.
TABLES_1 = """
    CREATE TABLE IF NOT EXISTS session (
        id TEXT PRIMARY KEY, token TEXT NOT NULL, fence INTEGER NOT NULL,
        touched INTEGER NOT NULL,  -- milliseconds since 1970
        whole BLOB NOT NULL, head BLOB NOT NULL) WITHOUT ROWID;
    CREATE INDEX IF NOT EXISTS session_touched ON session (touched);
    CREATE TABLE IF NOT EXISTS polytope (
        session TEXT NOT NULL REFERENCES session ON DELETE CASCADE, key TEXT NOT NULL, bytes BLOB NOT NULL,
        PRIMARY KEY (session, key));
    PRAGMA user_version = 1;"""

# The exact script with which servers of version 0.1.0 save sessions: Redis identifies scripts by their digest.
SAVE_1 = """
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


@pytest.fixture(name="path")
def file_path(tmp_path):
    return tmp_path / "store" / "sessions.sqlite"


def on_file(path, quota="1G", **variables):
    return Server("--workers", 1, "--store", f"sqlite:{path}", "--store-quota", quota, **variables)


def opened_by(client):
    return {"session": client.welcome["session"], "token": client.welcome["token"]}


async def pressed(server, key="k", times=1, **keys):
    """Opens the session of `keys`, or a new one, and presses a key; returns the session's ID and token, and the
    revision."""
    async with Client(server, **keys) as client:
        for _ in range(times):
            done = await client.request("key", key=key)
        return opened_by(client), done["revision"]


async def many(server, count):
    """Creates sessions with different numbers of key presses; returns (ID and token, revision) of each."""
    made = []
    for i in range(count):
        keys, revision = await pressed(server, times=i % 7 + 1)
        made.append((keys, revision))
    return made


async def revision_of(server, keys):
    """Returns the revision of a session, None if the server answers that there is no such session."""
    try:
        async with Client(server, **keys) as client:
            return (await client.request("get", what="state"))["revision"]
    except Refused as refused:
        assert refused.code == "not_found", refused
        return None


def sphere(count, seed):
    """Returns random points of the 3-sphere, as text."""
    chance = random.Random(seed)
    points = ([chance.gauss(0, 1) for _ in range(4)] for _ in range(count))
    return "\n".join(" ".join(f"{x / sum(y * y for y in point) ** 0.5:.6f}" for x in point) for point in points)


def files_of(path):
    return [file for file in path.parent.iterdir() if file.name.startswith(path.name)]


def modes(path):
    return {stat.S_IMODE(file.lstat().st_mode) for file in files_of(path)}


def holds(path, text):
    return [file.name for file in files_of(path) if text.encode() in file.read_bytes()]


def as_version_1(path, tokens):
    """Rewrites the file in version 1, with tokens of deleted sessions left in its free pages."""
    with contextlib.closing(sqlite3.connect(path)) as file:
        sessions = file.execute("SELECT id, fence, touched, whole, head FROM session").fetchall()
        polytopes = file.execute("SELECT session, key, bytes FROM polytope").fetchall()
    for old in files_of(path):
        old.unlink()
    gone = [f"tokenofsessionthatisgone{i:08}" for i in range(200)]
    with contextlib.closing(sqlite3.connect(path, isolation_level=None)) as file:
        file.execute("PRAGMA journal_mode = WAL")
        file.execute("PRAGMA secure_delete = OFF")
        file.executescript(TABLES_1)
        for i, token in enumerate(gone):
            file.execute("INSERT INTO session VALUES (?, ?, 1, 0, ?, '')", (f"gone{i}", token, b"x" * 900))
        file.execute("DELETE FROM session")
        for id_, *rest in sessions:
            file.execute("INSERT INTO session VALUES (?, ?, ?, ?, ?, ?)", (id_, tokens[id_], *rest))
        file.executemany("INSERT INTO polytope VALUES (?, ?, ?)", polytopes)
    path.chmod(0o644)
    assert [token for token in gone if holds(path, token)]
    return gone


def refused(path, *options):
    ended = run("--port", 0, "--store", f"sqlite:{path}", *options, text=True)
    assert ended.returncode == 1, ended.stderr
    return ended.stderr


# --- Permissions of the files


@pytest.mark.parametrize("mask", [0o000, 0o022, 0o777])
async def test_no_file_of_the_store_is_open_to_others(path, mask):
    before = os.umask(mask)
    try:
        server = on_file(path)
    finally:
        os.umask(before)
    try:
        keys, _ = await pressed(server)
        await asyncio.sleep(1)  # changes are written after 0.25 s
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        assert modes(path) == {0o600} and len(files_of(path)) > 1
        assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700
        assert not holds(path, keys["token"]) and holds(path, keys["session"])
    finally:
        server.kill()
    assert modes(path) == {0o600}
    for file in files_of(path):
        file.chmod(0o644)
    with on_file(path) as server:
        assert modes(path) == {0o600} and "mode=0644" in server.log()
        assert await pressed(server, **keys) == (keys, 2)
        assert await turned_away(server, keys["session"], token="a" * 32) == ("bad_token", 4401)


def test_what_is_no_file_of_ours_is_refused_and_left(tmp_path):
    def file(name, data):
        (tmp_path / name).write_bytes(data)
        return tmp_path / name

    text = file("letter.txt", b"Dear reader, " * 1000)
    modes_before = {"letter.txt": 0o640, "other.db": 0o644}
    text.chmod(0o640)
    assert "is not a database" in refused(text)
    assert text.read_bytes() == b"Dear reader, " * 1000
    with contextlib.closing(sqlite3.connect(tmp_path / "other.db")) as other:
        other.execute("CREATE TABLE address (name TEXT)")
    (tmp_path / "other.db").chmod(0o644)
    before = (tmp_path / "other.db").read_bytes()
    assert "database of another program" in refused(tmp_path / "other.db")
    assert (tmp_path / "other.db").read_bytes() == before
    with contextlib.closing(sqlite3.connect(tmp_path / "later.db")) as later:
        later.executescript("CREATE TABLE session (id); CREATE TABLE polytope (id); PRAGMA user_version = 3")
    assert "later version" in refused(tmp_path / "later.db")
    (tmp_path / "folder").mkdir()
    assert "is a folder" in refused(tmp_path / "folder")
    os.mkfifo(tmp_path / "pipe")
    assert "is a pipe" in refused(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(text)
    assert "symbolic link" in refused(tmp_path / "link")
    file("empty", b"")
    (tmp_path / "empty-wal").symlink_to(text)
    assert "empty-wal is a symbolic link" in refused(tmp_path / "empty")
    assert {file.name: stat.S_IMODE(file.stat().st_mode) for file in (text, tmp_path / "other.db")} == modes_before
    if os.geteuid() == 0:
        os.chown(file("strangers", b""), 12345, 12345)
        assert "belongs to user 12345" in refused(tmp_path / "strangers")


# --- Tokens


async def test_sessions_of_version_1_open_and_their_tokens_go(path):
    with on_file(path) as server:
        made = await many(server, 8)
        async with Client(server) as client:
            await client.request("load", name="mine", format="points", data=sphere(40, 1))
            made.append((opened_by(client), 1))
    tokens = {keys["session"]: keys["token"] for keys, _ in made}
    gone = as_version_1(path, tokens)
    assert all(holds(path, token) for token in tokens.values())
    # If the server is killed during the conversion, the next start repeats it.
    for wait in (0.01, 0.03, 0.06):
        copy = path.with_name("killed.sqlite")
        shutil.copy(path, copy)
        killed = subprocess.Popen([PROGRAM, "--port", "0", "--store", f"sqlite:{copy}"], stderr=subprocess.DEVNULL)
        time.sleep(wait)
        killed.kill()
        killed.wait()
        shutil.move(copy, path)
        for beside in ("-wal", "-shm"):
            if copy.with_name(copy.name + beside).exists():
                shutil.move(copy.with_name(copy.name + beside), path.with_name(path.name + beside))
    server = on_file(path)
    try:
        for token in [*tokens.values(), *gone]:
            assert not holds(path, token), "while it runs"
        for keys, revision in made:
            assert await turned_away(server, keys["session"], token="b" * 32) == ("bad_token", 4401)
            assert await revision_of(server, keys) == revision
        async with Client(server, **made[-1][0]) as client:
            assert (await client.request("get", what="state"))["polytope"]["name"] == "mine"
        server.stop()
    finally:
        server.kill()
    for token in [*tokens.values(), *gone]:
        assert not holds(path, token)
    with contextlib.closing(sqlite3.connect(path)) as file:
        assert file.execute("PRAGMA user_version").fetchone() == (2,)
        assert file.execute("PRAGMA integrity_check").fetchone() == ("ok",)


class Redis:
    def __init__(self, folder):
        self.port = free_port()
        self.process = subprocess.Popen(["redis-server", "--port", str(self.port), "--bind", "127.0.0.1", "--dir", folder,
                                         "--save", ""], stdout=subprocess.DEVNULL)
        until(lambda: answers("127.0.0.1", self.port), "Redis")

    def ask(self, *words):
        said = subprocess.run(["redis-cli", "-p", str(self.port), *words], capture_output=True, check=True)
        return said.stdout.decode(errors="replace").strip()

    def server(self, *options):
        return Server("--workers", 1, "--store", f"redis://127.0.0.1:{self.port}", *options)

    def fields(self, keys):
        return self.ask("HKEYS", f"oval4d:{{{keys['session']}}}").split()

    def older(self, keys):
        """Rewrites a session as a server of version 0.1.0 would have saved it."""
        key = f"oval4d:{{{keys['session']}}}"
        self.ask("HDEL", key, "hash")
        self.ask("HSET", key, "token", keys["token"])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


async def test_redis_has_no_tokens(tmp_path):
    with Redis(tmp_path) as redis:
        with redis.server() as server:
            keys, _ = await pressed(server)
        assert "hash" in redis.fields(keys) and "token" not in redis.fields(keys)
        redis.older(keys)
        with redis.server() as server:
            assert await turned_away(server, keys["session"], token="c" * 32) == ("bad_token", 4401)
            assert "token" not in redis.fields(keys)
            assert await pressed(server, **keys) == (keys, 2)
        assert keys["token"] not in redis.ask("HGETALL", f"oval4d:{{{keys['session']}}}")


async def test_redis_is_used_by_servers_of_version_0_1_0_too(tmp_path):
    """Those servers find sessions by the plain-text token, which is therefore kept for the duration of the expiry."""
    with Redis(tmp_path) as redis:
        redis.ask("SCRIPT", "LOAD", SAVE_1)
        with redis.server("--session-expiry", 6) as server:
            start = time.monotonic()
            keys, _ = await pressed(server)
            other, _ = await pressed(server)
            if time.monotonic() - start < 4:
                assert {"hash", "token"} <= set(redis.fields(keys)), "one that is new"
            redis.older(other)
            async with Client(server, **other) as client:
                await client.request("key", key="k")
                if time.monotonic() - start < 4:
                    assert {"hash", "token"} <= set(redis.fields(other)), "one that was taken over"
                server.wait_for(lambda: "token" not in redis.fields(other))
                assert time.monotonic() - start > 4
            assert await pressed(server, **other) == (other, 3)
            assert "token" not in redis.fields(other)


# --- Damaged files


async def test_bits_are_turned_and_ends_cut_off(path):
    """Every session is unchanged or reported as lost; the server works, and keeps the damaged file."""
    with on_file(path) as server:
        made = await many(server, 24)
    whole = path.read_bytes()
    chance = random.Random(11)
    salvaged = 0
    for round_ in range(6):
        for file in files_of(path):
            file.unlink()
        damaged = bytearray(whole)
        if round_ % 3 == 2:
            del damaged[chance.randrange(1000, len(damaged)):]
        for _ in range(3):
            damaged[chance.randrange(4096, len(damaged)) if len(damaged) > 4096 else 200] ^= 1 << chance.randrange(8)
        path.write_bytes(damaged)
        server = on_file(path)
        try:
            revisions = await asyncio.gather(*[revision_of(server, keys) for keys, _ in made])
            lost = sum(found is None for found in revisions)
            for (keys, revision), found in zip(made, revisions):
                assert found in (None, revision)
            log = server.log()
            if lost:
                assert "store salvaged" in log or "sessions damaged, and lost" in log
            if "store salvaged" in log:
                salvaged += 1
                if round_ == 2:
                    assert "lost=0 " not in log, "an end was cut off"
                aside = [file for file in files_of(path) if ".damaged-" in file.name and not file.name.endswith("-wal")]
                assert [file.read_bytes() for file in aside] == [bytes(damaged)]
                assert f"set_aside={aside[0]}" in log
            await pressed(server)
            assert modes(path) == {0o600}
            server.stop()
        finally:
            server.kill()
    assert salvaged >= 2


async def test_damage_while_it_runs(path):
    with on_file(path) as server:
        made = []
        for seed in range(55):
            client = await loaded(server, seed)
            made.append((opened_by(client), 1))
            await client.leave()
    mine = made.pop()[0]
    assert path.stat().st_size > 2.2 * MIB  # more than SQLite caches in memory
    server = on_file(path)
    try:
        async with Client(server, **mine) as client:
            with open(path, "r+b") as file:
                for page in range(2, path.stat().st_size // 4096):
                    file.seek(4096 * page)
                    file.write(b"\xa5" * 4096)
            for keys, _ in made:  # opening them may fail
                with contextlib.suppress(Refused):
                    await pressed(server, **keys)
            await client.request("key", key="k")
            server.wait_for(lambda: "store salvaged" in server.log())
            server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
            server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        assert (await pressed(server, times=2, **mine))[1] == 4
        server.stop()
    finally:
        server.kill()
    server = on_file(path)
    try:
        async with Client(server, **mine) as client:
            state = await client.request("get", what="state")
            assert (state["revision"], state["polytope"]["name"]) == (4, "mine")
    finally:
        server.kill()


async def test_two_servers_begin_at_once_on_a_damaged_file(path):
    with on_file(path) as server:
        made = await many(server, 10)
    damaged = bytearray(path.read_bytes())
    damaged[-4096:] = b"\x5a" * 4096
    path.write_bytes(damaged)
    both = [subprocess.Popen([PROGRAM, "--port", "0", "--store", f"sqlite:{path}"], stderr=subprocess.PIPE, text=True)
            for _ in range(2)]
    limit = time.monotonic() + DEADLINE
    while all(one.poll() is None for one in both):
        assert time.monotonic() < limit, "two servers have one file"
        time.sleep(0.02)
    ended, serving = sorted(both, key=lambda one: one.poll() is None)
    try:
        assert "in use by another server" in ended.communicate()[1]
        assert serving.poll() is None
    finally:
        serving.send_signal(signal.SIGKILL)
        serving.communicate()
    assert len([file for file in files_of(path) if ".damaged-" in file.name and not file.name.endswith("-wal")]) <= 1
    with on_file(path) as server:
        kept = [await revision_of(server, keys) for keys, _ in made]
        assert sum(revision is not None for revision in kept) > 0


# --- Quota and full disks


def taken(path):
    return sum(file.stat().st_size for file in files_of(path) if file.exists())


async def loaded(server, seed, **keys):
    """Opens a session and loads a polytope of about 70 kB; returns the connected client."""
    client = Client(server, **keys)
    await client.__aenter__()
    await client.request("load", name="mine", format="points", data=sphere(250, seed))
    return client


async def test_a_quota_is_kept(path):
    server = on_file(path, quota="1M")
    try:
        touched = [await pressed(server) for _ in range(2)]
        async with Client(server) as first:
            async with Client(server) as bare:
                untouched = opened_by(bare)
            keys = []
            for i in range(30):
                client = await loaded(server, i)
                keys.append(opened_by(client))
                await client.leave()
                assert taken(path) <= MIB
            server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
            assert server.get("/readyz").body == b"ready\n" and "sessions evicted" in server.log()
            assert taken(path) <= MIB
            assert await revision_of(server, untouched) is None
            assert await revision_of(server, touched[0][0]) is None, "the first of those that were changed"
            assert await revision_of(server, keys[-1]) == 1
            assert (await first.request("key", key="k"))["revision"] == 1
            saved = opened_by(first)
        server.stop()
    finally:
        server.kill()
    with on_file(path, quota="1M") as server:
        assert await revision_of(server, saved) == 1


@pytest.mark.parametrize("place", ["file", "memory"])
async def test_sessions_that_are_open_are_never_given_up(path, place):
    store = f"sqlite:{path}" if place == "file" else "memory"
    server = Server("--workers", 1, "--store", store, "--store-quota", "1M")
    try:
        clients = []
        for i in range(25):
            clients.append(await loaded(server, i))
        if place == "file":
            server.wait_for(lambda: b"--store-quota" in server.get("/readyz").body)
            assert "store fails" in server.log() and server.metric("oval4d_store_up") == 0
            assert taken(path) <= MIB
        for client in clients:
            assert (await client.request("key", key="k"))["revision"] == 2
        for client in clients[1:]:
            await client.leave()
        server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        kept = [await revision_of(server, opened_by(client)) for client in clients]
        assert kept[0] == kept[-1] == 2 and kept.count(None) > 3
        await clients[0].leave()
        server.stop()
    finally:
        server.kill()


async def test_the_disk_is_full(tmp_path):
    """A limit on the file size simulates a full disk."""
    path = tmp_path / "sessions.sqlite"
    server = on_file(path)
    try:
        kept, _ = await pressed(server)
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        limit_file_size(server, 4096)
        async with Client(server) as client:
            assert (await client.request("key", key="k"))["revision"] == 1
            server.wait_for(lambda: b"the store fails" in server.get("/readyz").body)
            assert server.get("/readyz").status == 200
            assert await revision_of(server, kept) == 1, "what is there can be read"
            assert (await client.request("key", key="k"))["revision"] == 2
            limit_file_size(server, -1)
            server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
            keys = opened_by(client)
        server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        server.stop()
    finally:
        server.kill()
    with on_file(path) as server:
        assert await revision_of(server, keys) == 2


def limit_file_size(server, size):
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
