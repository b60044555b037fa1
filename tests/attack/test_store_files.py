"""The files of a server's store: who can read them, files of other programs, and damaged files."""

import asyncio
import contextlib
import os
import random
import shutil
import signal
import sqlite3
import stat
import subprocess
import time

import pytest
from harness import DEADLINE, PROGRAM, run_oval4d
from stores import (MIB, client_with_loaded_polytope, create_sessions, credentials_of, files_containing, press_key,
                    server_with_store, session_revision, store_files, wait_until_saved)
from wire import Client, Refused, hello_refusal


def file_modes(store_path):
    return {stat.S_IMODE(file.lstat().st_mode) for file in store_files(store_path)}


def start_error(store_path, *options):
    ended = run_oval4d("--port", 0, "--store", f"sqlite:{store_path}", *options, text=True)
    assert ended.returncode == 1, ended.stderr
    return ended.stderr


# --- Only the owner may read the files of the store


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
    before = (tmp_path / "later.db").read_bytes()
    assert "later version" in start_error(tmp_path / "later.db")
    assert (tmp_path / "later.db").read_bytes() == before
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


def test_files_of_a_killed_server_of_a_later_version_are_unchanged(tmp_path):
    """The server that is killed leaves a log, which SQLite would write into the file."""
    with contextlib.closing(sqlite3.connect(tmp_path / "open.db")) as later:
        later.executescript("PRAGMA journal_mode = WAL; CREATE TABLE session (id); CREATE TABLE polytope (id);"
                            "PRAGMA user_version = 3; PRAGMA wal_checkpoint(TRUNCATE); INSERT INTO session VALUES (1)")
        for suffix in ("", "-wal"):
            shutil.copy(tmp_path / f"open.db{suffix}", tmp_path / f"later.db{suffix}")
    before = {file: file.read_bytes() for file in store_files(tmp_path / "later.db")}
    assert len(before) == 2 and all(before.values())
    assert "later version" in start_error(tmp_path / "later.db")
    assert {file: file.read_bytes() for file in store_files(tmp_path / "later.db")} == before


# --- The server salvages what it can from damaged files


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
    assert store_path.stat().st_size > 2.2 * MIB  # more than SQLite's cache in memory
    server = server_with_store(store_path)
    try:
        async with Client(server, **mine) as client:
            with open(store_path, "r+b") as file:
                for page in range(2, store_path.stat().st_size // 4096):
                    file.seek(4096 * page)
                    file.write(b"\xa5" * 4096)
            for credentials, _ in made:  # it may be impossible to open them
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
