"""How much of the newest changes a kill of the server loses, with many sessions compared with one."""

import asyncio
import random
import signal
import statistics
import time

import websockets
from harness import Server
from wire import Client

PRESSES = 30


async def press_until_killed(server, acknowledged, rng, pressed):
    """Presses keys; appends the time and the revision of each acknowledged change, and sets `pressed` after PRESSES."""
    try:
        async with Client(server) as client:
            acknowledged.append((client.welcome["session"], client.welcome["token"]))
            while True:
                done = await client.request("key", key="k" if len(acknowledged) % 2 else "K")
                acknowledged.append((time.monotonic(), done["revision"]))
                if len(acknowledged) > PRESSES:
                    pressed.set()
                await asyncio.sleep(rng.uniform(0, 0.06))
    except (OSError, websockets.ConnectionClosed, AssertionError):
        assert server.process.poll() is not None or pressed.is_set()


async def lost_seconds(store_path, sessions, rng):
    """Returns, for each session, how long before the kill it made the oldest change that is lost."""
    store = ("--store", f"sqlite:{store_path}")
    logs, events = [[] for _ in range(sessions)], [asyncio.Event() for _ in range(sessions)]
    server = Server(*store)
    try:
        tasks = [asyncio.ensure_future(press_until_killed(server, log, rng, event)) for log, event in zip(logs, events)]
        await asyncio.gather(*(event.wait() for event in events))
        await asyncio.sleep(rng.uniform(0, 0.5))
        server.process.send_signal(signal.SIGKILL)
        killed = time.monotonic()
        await asyncio.gather(*tasks)
    finally:
        server.kill()
    lost = []
    with Server(*store) as server:
        for (session, token), *changes in logs:
            async with Client(server, session, token=token) as client:
                stored = (await client.request("get", what="state"))["revision"]
            lost.append(max((killed - at for at, revision in changes if revision > stored), default=0))
    return lost


async def test_many_sessions_lose_hardly_more_than_one(tmp_path):
    rng = random.Random(6)
    many, one = [], []
    for round_ in range(4):
        many += await lost_seconds(tmp_path / f"many {round_}", 12, rng)
        for repeated in range(4):
            one += await lost_seconds(tmp_path / f"one {round_} {repeated}", 1, rng)
    print(f"lost seconds: {statistics.median(many):.3f} of 12 sessions, {statistics.median(one):.3f} of one")
    assert statistics.median(many) < 3 * statistics.median(one)
