"""Sessions in a SQLite file survive restarts and crashes of the server, and damage to the file."""

import asyncio
import contextlib
import hashlib
import math
import random
import signal
import sqlite3
import subprocess

import pytest
import websockets
from harness import DEADLINE, PROGRAM, Server, is_sanitizer_build
from wire import Client, credentials_of, hello_refusal, with_another_member


@pytest.fixture(name="store_path")
def temporary_store_path(tmp_path):
    return tmp_path / "sessions.sqlite"


def execute_sql(store_path, statement, *values):
    """Executes an SQL statement on the file while no server uses it; returns the rows."""
    with contextlib.closing(sqlite3.connect(store_path, isolation_level=None)) as file:
        return file.execute(statement, values).fetchall()


def box_points():
    return "".join(f"{x} {y} {z} {w}\n" for x in (-1, 1) for y in (-1, 1.5) for z in (-1, 1) for w in (-1, 1.25))


async def test_a_session_and_its_polytopes_survive_a_restart(store_path):
    with Server("--store", f"sqlite:{store_path}") as server:
        async with Client(server) as client:
            await client.request("load", name="mine", format="points", data=box_points())
            await client.request("key", key="t")
            await client.request("set", polytope="snub 24-cell", color="kind", hidden=[0])
            await client.request("key", key="r")
            before = await client.request("get", what="state")
            credentials = credentials_of(client)
    with Server("--store", f"sqlite:{store_path}") as server:
        server.wait_for(lambda: server.metric("oval4d_sessions") == 1)
        async with Client(server, **credentials) as client:
            after = await client.request("get", what="state")
            assert {**after, "id": 0, "object_serial": 0} == {**before, "id": 0, "object_serial": 0}
            await client.request("undo")
            await client.request("undo")
            state = await client.request("get", what="state")
            assert (state["polytope"]["name"], state["polytope"]["vertices"]) == ("mine", 16)
            names = [p["name"] for p in (await client.request("get", what="catalogue"))["polytopes"]]
            assert "mine" in names
        assert await hello_refusal(server, credentials["session"], token="wrong") == ("bad_token", 4401)


async def test_a_store_file_is_used_by_only_one_server(store_path):
    with Server("--store", f"sqlite:{store_path}"):
        second = subprocess.run([PROGRAM, "--port", "0", "--store", f"sqlite:{store_path}"], capture_output=True, text=True,
                                timeout=DEADLINE, check=False)
        assert second.returncode == 1
        assert "in use by another server" in second.stderr


@pytest.mark.parametrize("store, expected_text", [
    ("disk", "the store must be memory, sqlite:PATH or redis://host, not 'disk'"),
    ("redis://host:x", "the Redis port must be a number from 1 to 65535"),
    ("sqlite:/proc/nowhere/sessions", "unable to open"),
])
def test_an_invalid_store_option_is_refused(store, expected_text):
    refused = subprocess.run([PROGRAM, "--port", "0", "--store", store], capture_output=True, text=True,
                             timeout=DEADLINE, check=False)
    assert refused.returncode == 1
    assert expected_text in refused.stderr


async def test_an_unreadable_record_is_reported_and_kept(store_path):
    with Server("--store", f"sqlite:{store_path}") as server:
        async with Client(server) as client:
            await client.request("key", key="t")
            credentials = credentials_of(client)
    execute_sql(store_path, "UPDATE session SET whole = ?", b"\x82\x07\x00")
    server = Server("--store", f"sqlite:{store_path}")
    try:
        assert await hello_refusal(server, **credentials) == ("not_found", 4404)
        assert "session cannot be read" in server.log() and "version 7" in server.log()
        async with Client(server) as client:  # the server still works
            await client.request("key", key="t")
        server.stop()
    finally:
        server.kill()
    assert (b"\x82\x07\x00",) in execute_sql(store_path, "SELECT whole FROM session")


def digest_of(*parts):
    """Returns the digest of a record: see recordDigest() in server/store/secret.hpp."""
    whole = b"".join(len(part).to_bytes(8, "little") + part for part in parts)
    return hashlib.blake2b(whole, digest_size=16).digest()


async def test_a_session_of_a_later_version_is_refused_and_kept(store_path):
    with Server("--store", f"sqlite:{store_path}") as server:
        async with Client(server) as client:
            await client.request("key", key="t")
            credentials = credentials_of(client)
    [[session, token_hash, whole]] = execute_sql(store_path, "SELECT id, token_hash, whole FROM session")
    later = with_another_member(whole)
    digest = digest_of(session.encode(), token_hash.encode(), later)
    execute_sql(store_path, "UPDATE session SET whole = ?, digest = ?", later, digest)
    before = execute_sql(store_path, "SELECT * FROM session")
    with Server("--store", f"sqlite:{store_path}") as server:
        for _ in range(2):
            assert await hello_refusal(server, **credentials) == ("later_version", 1013)
        assert "session of a later version refused" in server.log()
    assert execute_sql(store_path, "SELECT * FROM session") == before
    execute_sql(store_path, "UPDATE session SET whole = ?, digest = ?", whole,
                digest_of(session.encode(), token_hash.encode(), whole))
    with Server("--store", f"sqlite:{store_path}") as server:
        async with Client(server, **credentials) as client:
            assert (await client.request("get", what="state"))["revision"] == 1


class KeyPresser:
    """Presses k and K, each of which adds a step to α or β, so that the angles of a state determine its revision."""

    def __init__(self):
        self.credentials = {}
        self.start = None  # α and β at revision 0, in steps
        self.pressed = 0
        self.stored = self.acknowledged = 0  # revisions

    async def press(self, server, times=math.inf):
        """Checks the state of its session, then presses keys until the server ends, or `times` keys, and leaves."""
        async with Client(server, **self.credentials) as client:
            self.credentials = credentials_of(client)
            await self.check(client)
            while times > 0:
                done = await client.request("key", key="k" if self.pressed % 2 == 0 else "K")
                self.pressed += 1
                times -= 1
                self.acknowledged = done["revision"]

    async def check(self, client):
        state = await client.request("get", what="state")
        steps = round((state["alpha"] + state["beta"]) / state["step"])
        if self.start is None:
            self.start = steps - state["revision"]
        assert steps - state["revision"] == self.start, "the angles do not match the revision"
        # The server may have executed the last key without acknowledging it before the kill.
        assert self.stored <= state["revision"] <= self.acknowledged + 1
        self.acknowledged = state["revision"]


async def test_closed_sessions_survive_repeated_kills(store_path):
    """The server is killed while keys are pressed: every session has at least the state with which it was last closed
    and written, its state is one that it had, and the file stays valid."""
    pressers = [KeyPresser() for _ in range(12)]
    rng = random.Random(5)
    for round_ in range(4 if is_sanitizer_build() else 10):
        server = Server("--store", f"sqlite:{store_path}")
        try:
            await asyncio.gather(*(presser.press(server, rng.randrange(8)) for presser in pressers))
            await asyncio.to_thread(server.wait_for, lambda: server.metric("oval4d_open_sessions") == 0)
            await asyncio.to_thread(server.wait_for, lambda: server.metric("oval4d_unsaved_sessions") == 0)
            for presser in pressers:
                presser.stored = presser.acknowledged
            # In all rounds together, the angles do not reach their limits, which are 710 steps away.
            last = sum(presser.pressed for presser in pressers) + rng.randrange(500)
            tasks = [asyncio.ensure_future(presser.press(server)) for presser in pressers]
            while sum(presser.pressed for presser in pressers) < last:
                assert not any(task.done() for task in tasks), [task for task in tasks if task.done()]
                await asyncio.sleep(0.001)
            server.process.send_signal(signal.SIGKILL)
            for ended in await asyncio.gather(*tasks, return_exceptions=True):
                is_closed = isinstance(ended, (OSError, websockets.ConnectionClosed))
                assert is_closed or str(ended).startswith("the server closed the connection"), ended
        finally:
            server.kill()
        if round_ % 3 == 0:
            assert execute_sql(store_path, "PRAGMA integrity_check") == [("ok",)]
    assert sum(presser.pressed for presser in pressers) > 100


async def test_open_sessions_are_saved(store_path):
    saves = 'oval4d_store_seconds_count{operation="save"}'
    credentials = {}
    for round_ in range(3):
        server = Server("--store", f"sqlite:{store_path}")
        try:
            async with Client(server, **credentials) as client:
                credentials = credentials_of(client)
                for press in range(2):
                    before = server.metric(saves)
                    assert (await client.request("key", key="k"))["revision"] == 2 * round_ + press + 1
                    await asyncio.to_thread(server.wait_for, lambda: server.metric(saves) > before)
                server.process.send_signal(signal.SIGKILL)
                await client.wait_for_close_code()
        finally:
            server.kill()
