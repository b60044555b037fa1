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
from harness import DEADLINE, PROGRAM, Server, free_port, is_listening, run_oval4d, wait_until  # noqa: E402
from wire import Client, Refused, hello_refusal  # noqa: E402

MIB = 1 << 20

# The tables of version 1 of the file, which stored tokens as plain text.
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

# The exact script with which servers of version 0.1.0 save sessions: Redis identifies scripts by their digest.
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


@pytest.fixture(name="store_path")
def temporary_store_path(tmp_path):
    return tmp_path / "store" / "sessions.sqlite"


def server_with_store(store_path, quota="1G", **variables):
    return Server("--workers", 1, "--store", f"sqlite:{store_path}", "--store-quota", quota, **variables)


def wait_until_saved(server, open_sessions=0):
    """Waits until no more than so many sessions are open and everything is written to the store. An open session that
    has changed counts as unsaved only when it is passed to the store, a quarter of a second later."""
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


def file_modes(store_path):
    return {stat.S_IMODE(file.lstat().st_mode) for file in store_files(store_path)}


def files_containing(store_path, text):
    return [file.name for file in store_files(store_path) if text.encode() in file.read_bytes()]


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


def start_error(store_path, *options):
    ended = run_oval4d("--port", 0, "--store", f"sqlite:{store_path}", *options, text=True)
    assert ended.returncode == 1, ended.stderr
    return ended.stderr


# --- Permissions of the files


@pytest.mark.parametrize("mask", [0o000, 0o022, 0o777])
async def test_store_files_are_accessible_only_to_their_owner(store_path, mask):
    before = os.umask(mask)
    try:
        server = server_with_store(store_path)
    finally:
        os.umask(before)
    try:
        credentials, _ = await press_key(server)
        server.wait_for(lambda: files_containing(store_path, credentials["session"]))
        wait_until_saved(server)
        assert file_modes(store_path) == {0o600} and len(store_files(store_path)) > 1
        assert stat.S_IMODE(store_path.parent.stat().st_mode) == 0o700
        assert not files_containing(store_path, credentials["token"]) and files_containing(store_path, credentials["session"])
    finally:
        server.kill()
    assert file_modes(store_path) == {0o600}
    for file in store_files(store_path):
        file.chmod(0o644)
    with server_with_store(store_path) as server:
        assert file_modes(store_path) == {0o600} and "mode=0644" in server.log()
        assert await press_key(server, **credentials) == (credentials, 2)
        assert await hello_refusal(server, credentials["session"], token="a" * 32) == ("bad_token", 4401)


def test_files_of_other_programs_are_refused_and_unchanged(tmp_path):
    def file(name, data):
        (tmp_path / name).write_bytes(data)
        return tmp_path / name

    text = file("letter.txt", b"Dear reader, " * 1000)
    modes_before = {"letter.txt": 0o640, "other.db": 0o644}
    text.chmod(0o640)
    assert "is not a database" in start_error(text)
    assert text.read_bytes() == b"Dear reader, " * 1000
    with contextlib.closing(sqlite3.connect(tmp_path / "other.db")) as other:
        other.execute("CREATE TABLE address (name TEXT)")
    (tmp_path / "other.db").chmod(0o644)
    before = (tmp_path / "other.db").read_bytes()
    assert "database of another program" in start_error(tmp_path / "other.db")
    assert (tmp_path / "other.db").read_bytes() == before
    with contextlib.closing(sqlite3.connect(tmp_path / "later.db")) as later:
        later.executescript("CREATE TABLE session (id); CREATE TABLE polytope (id); PRAGMA user_version = 3")
    assert "later version" in start_error(tmp_path / "later.db")
    (tmp_path / "folder").mkdir()
    assert "is a folder" in start_error(tmp_path / "folder")
    os.mkfifo(tmp_path / "pipe")
    assert "is a pipe" in start_error(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(text)
    assert "symbolic link" in start_error(tmp_path / "link")
    file("empty", b"")
    (tmp_path / "empty-wal").symlink_to(text)
    assert "empty-wal is a symbolic link" in start_error(tmp_path / "empty")
    assert {file.name: stat.S_IMODE(file.stat().st_mode) for file in (text, tmp_path / "other.db")} == modes_before
    if os.geteuid() == 0:
        os.chown(file("strangers", b""), 12345, 12345)
        assert "belongs to user 12345" in start_error(tmp_path / "strangers")


# --- Tokens


async def test_version_1_sessions_are_converted_and_their_plain_tokens_erased(store_path):
    with server_with_store(store_path) as server:
        made = await create_sessions(server, 8)
        async with Client(server) as client:
            await client.request("load", name="mine", format="points", data=sphere_points(40, 1))
            made.append((credentials_of(client), 1))
    tokens = {credentials["session"]: credentials["token"] for credentials, _ in made}
    deleted_tokens = convert_to_version_1(store_path, tokens)
    assert all(files_containing(store_path, token) for token in tokens.values())
    # If the server is killed during the conversion, the next start repeats it.
    for log_bytes in (0, 1, 16 << 10):  # it is killed once SQLite's log has this size, or once it has started
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
        redis.command("SET", "oval4d:tokens_hashed_since", "1")  # in January 1970
        with redis.start_server() as server:
            assert await press_key(server, **other) == (other, 3)
            server.wait_for(lambda: "token" not in redis.session_fields(other))
            assert await press_key(server, **other) == (other, 4)
            assert "token" not in redis.session_fields(other)


# --- Damaged files


async def test_corrupted_and_truncated_files_are_salvaged(store_path):
    """Every session is unchanged or reported as lost; the server works, and keeps the damaged file."""
    with server_with_store(store_path) as server:
        made = await create_sessions(server, 24)
    whole = store_path.read_bytes()
    rng = random.Random(11)
    salvaged = 0
    for round_ in range(6):
        for file in store_files(store_path):
            file.unlink()
        damaged = bytearray(whole)
        if round_ % 3 == 2:
            del damaged[rng.randrange(1000, len(damaged)):]
        for _ in range(3):
            damaged[rng.randrange(4096, len(damaged)) if len(damaged) > 4096 else 200] ^= 1 << rng.randrange(8)
        store_path.write_bytes(damaged)
        server = server_with_store(store_path)
        try:
            revisions = await asyncio.gather(*[session_revision(server, credentials) for credentials, _ in made])
            lost = sum(found is None for found in revisions)
            for (credentials, revision), found in zip(made, revisions):
                assert found in (None, revision)
            log = server.log()
            if lost:
                assert "store salvaged" in log or "sessions damaged, and lost" in log
            if "store salvaged" in log:
                salvaged += 1
                if round_ == 2:
                    assert "lost=0 " not in log, "a truncated file has lost sessions"
                aside = [file for file in store_files(store_path) if ".damaged-" in file.name and not file.name.endswith("-wal")]
                assert [file.read_bytes() for file in aside] == [bytes(damaged)]
                assert f"set_aside={aside[0]}" in log
            await press_key(server)
            assert file_modes(store_path) == {0o600}
            server.stop()
        finally:
            server.kill()
    assert salvaged >= 2


async def test_a_file_corrupted_while_the_server_runs_is_salvaged(store_path):
    with server_with_store(store_path) as server:
        made = []
        for seed in range(55):
            client = await client_with_loaded_polytope(server, seed)
            made.append((credentials_of(client), 1))
            await client.leave()
    mine = made.pop()[0]
    assert store_path.stat().st_size > 2.2 * MIB  # more than SQLite caches in memory
    server = server_with_store(store_path)
    try:
        async with Client(server, **mine) as client:
            with open(store_path, "r+b") as file:
                for page in range(2, store_path.stat().st_size // 4096):
                    file.seek(4096 * page)
                    file.write(b"\xa5" * 4096)
            for credentials, _ in made:  # opening them may fail
                with contextlib.suppress(Refused):
                    await press_key(server, **credentials)
            await client.request("key", key="k")
            server.wait_for(lambda: "store salvaged" in server.log())
            server.wait_for(lambda: server.get("/readyz").body == b"ready\n")
            server.wait_for(lambda: server.metric("oval4d_unsaved_sessions") == 0)
        assert (await press_key(server, times=2, **mine))[1] == 4
        server.stop()
    finally:
        server.kill()
    server = server_with_store(store_path)
    try:
        async with Client(server, **mine) as client:
            state = await client.request("get", what="state")
            assert (state["revision"], state["polytope"]["name"]) == (4, "mine")
    finally:
        server.kill()


async def test_only_one_of_two_servers_opens_a_damaged_file(store_path):
    with server_with_store(store_path) as server:
        made = await create_sessions(server, 10)
    damaged = bytearray(store_path.read_bytes())
    damaged[-4096:] = b"\x5a" * 4096
    store_path.write_bytes(damaged)
    both = [subprocess.Popen([PROGRAM, "--port", "0", "--store", f"sqlite:{store_path}"], stderr=subprocess.PIPE, text=True)
            for _ in range(2)]
    limit = time.monotonic() + DEADLINE
    while all(process.poll() is None for process in both):
        assert time.monotonic() < limit, "two servers use the same file"
        time.sleep(0.02)
    ended, serving = sorted(both, key=lambda process: process.poll() is None)
    try:
        assert "in use by another server" in ended.communicate()[1]
        assert serving.poll() is None
    finally:
        serving.send_signal(signal.SIGKILL)
        serving.communicate()
    assert len([file for file in store_files(store_path) if ".damaged-" in file.name and not file.name.endswith("-wal")]) <= 1
    with server_with_store(store_path) as server:
        kept = [await session_revision(server, credentials) for credentials, _ in made]
        assert sum(revision is not None for revision in kept) > 0


# --- Quota and full disks


def store_size(store_path):
    return sum(file.stat().st_size for file in store_files(store_path) if file.exists())


async def client_with_loaded_polytope(server, seed, **credentials):
    """Opens a session and loads a polytope of about 70 kB; returns the connected client."""
    client = Client(server, **credentials)
    await client.__aenter__()
    await client.request("load", name="mine", format="points", data=sphere_points(250, seed))
    return client


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
