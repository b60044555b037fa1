"""Fairness: a session stays responsive while other clients request as much as they can.

Each test measures the latency of a session alone, and then during an attack. Attackers run in separate processes, so
that they do not delay the measurement itself.
"""

import asyncio
import contextlib
import http.client
import itertools
import json
import multiprocessing
import statistics
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from harness import SLOW, Server
from wire import Client, Refused

HEAVY = "omnitruncated 120-cell"
VICTIM = "127.0.0.1"
OTHERS = [f"127.0.0.{n}" for n in range(2, 12)]
ALONE, BESIDE = 1 * SLOW, 3 * SLOW  # seconds of measuring


def distribution(seconds):
    ordered = sorted(seconds)
    return statistics.median(ordered), ordered[int(0.99 * (len(ordered) - 1))], ordered[-1]


async def press(server, seconds, address=VICTIM):
    """Turns the 5-cell key by key; returns the seconds from each key to its frame."""
    latencies = []
    async with Client(server, stream="frames", width=1280, height=720, address=address) as client:
        await client.frame_of(0)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            pressed = time.monotonic()
            client.messages.clear()
            done = await client.request("key", key="r")
            await client.frame_of(done["revision"])
            latencies.append(time.monotonic() - pressed)
    return latencies


# --- Attacks: coroutine functions (server, address, …), which are repeated until their process is killed


async def new_session_for_each(server, address, polytope, side=2048):
    async with Client(server, stream="none", address=address) as client:
        await client.request("set", polytope=polytope)
        await client.frame(width=side, height=side)


async def kept_session(server, address, polytope, side=2048):
    async with Client(server, stream="none", address=address) as client:
        await client.request("set", polytope=polytope)
        while True:
            client.messages.clear()
            await client.request("key", key="r")
            await client.frame(width=side, height=side)


async def stream(server, address, polytope, kind, side=2048):
    async with Client(server, stream=kind, width=side, height=side, address=address) as client:
        await client.request("set", polytope=polytope)
        while True:
            done = await client.request("key", key="r")
            await client.slices(done["revision"]) if kind == "geometry" else await client.frame_of(done["revision"])
            del client.messages[:-20]


async def over_http(server, address, polytope, side=2048):
    def ask():
        connection = http.client.HTTPConnection(server.host, server.port, timeout=60, source_address=(address, 0))
        with contextlib.closing(connection):
            name = polytope.replace(" ", "%20")
            connection.request("GET", f"/api/v1/frame.png?polytope={name}&width={side}&height={side}")
            connection.getresponse().read()
    await asyncio.to_thread(ask)


def points(count):
    """Returns points that are evenly but irregularly distributed on the 3-sphere, as text."""
    golden = [0.8566748838545029, 0.733891856627126, 0.6287067210378087]
    rows = []
    for i in range(count):
        u = [(0.5 + i * g) % 1 * 2 - 1 for g in golden]
        last = (i * 0.5385972572236101) % 1 * 2 - 1
        length = sum(x * x for x in (*u, last)) ** 0.5 or 1
        rows.append(" ".join(f"{x / length:.6f}" for x in (*u, last)))
    return "\n".join(rows)


POINTS = points(600)


async def loads(server, address):
    async with Client(server, stream="none", address=address) as client:
        for number in itertools.count():
            client.messages.clear()
            with contextlib.suppress(Refused):
                await client.request("load", name=f"mine {number % 3}", format="points", data=POINTS)


async def repeat(attack, server, address, arguments):
    while True:
        try:
            await attack(server, address, *arguments)
        except (Refused, OSError, AssertionError, asyncio.TimeoutError):
            await asyncio.sleep(0.05)


def attackers(address, attack, arguments, host_and_port, count):
    """Runs `count` attackers; the main function of an attacking process."""
    class Place:
        host, port = host_and_port

    async def all_of_them():
        await asyncio.gather(*(repeat(attack, Place, address, arguments) for _ in range(count)))
    asyncio.run(all_of_them())


@contextlib.contextmanager
def attacked(server, parties):
    """Runs attackers during the `with` block, one process per party."""
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=attackers, daemon=True,
                                 args=(address, attack, arguments, (server.host, server.port), count))
                 for address, attack, arguments, count in parties]
    for process in processes:
        process.start()
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


def measure(parties, options=()):
    with Server(*options) as server:
        asyncio.run(press(server, 0.5))  # warm-up
        alone = asyncio.run(press(server, ALONE))
        with attacked(server, parties):
            time.sleep(1.5 * SLOW)  # gives the attackers time to begin
            beside = asyncio.run(press(server, BESIDE))
    return distribution(alone), distribution(beside), len(beside)


def same(attack, arguments, count):
    return [(VICTIM, attack, arguments, count)]


def others(attack, arguments, count):
    return [(address, attack, arguments, 1) for address in OTHERS[:count]]


ATTACKS = {
    "three sessions for each frame, heavy": same(new_session_for_each, (HEAVY,), 3),
    "six sessions for each frame, 5-cell": same(new_session_for_each, ("5-cell",), 6),
    "three addresses, sessions for each frame, heavy": others(new_session_for_each, (HEAVY,), 3),
    "six addresses, sessions for each frame, 5-cell": others(new_session_for_each, ("5-cell",), 6),
    "ten kept sessions": same(kept_session, (HEAVY,), 10),
    "streams of frames": same(stream, (HEAVY, "frames"), 6),
    "streams of slices": same(stream, (HEAVY, "geometry"), 6),
    "small streams of slices": same(stream, ("5-cell", "geometry"), 8),
    "frames over HTTP, one address": [(OTHERS[0], over_http, (HEAVY,), 8)],
    "frames over HTTP, six addresses": others(over_http, ("5-cell",), 6),
    "loads": same(loads, (), 4),
}


@pytest.mark.parametrize("name", ATTACKS)
def test_another_session_goes_on_beside(name):
    for _ in range(2):  # another program may have disturbed the first attempt
        alone, beside, count = measure(ATTACKS[name])
        print(json.dumps({"attack": name, "alone ms": [round(1e3 * x, 1) for x in alone],
                          "beside ms": [round(1e3 * x, 1) for x in beside], "pictures": count}))
        if beside[0] <= 5 * alone[0] and beside[1] <= 20 * alone[0]:
            return
    assert beside[0] <= 5 * alone[0], f"the median is {beside[0] / alone[0]:.1f} times its own alone"
    assert beside[1] <= 20 * alone[0], f"the 99th percentile is {beside[1] / alone[0]:.1f} times the median alone"


def test_twenty_heavy_sessions_leave_room():
    for _ in range(2):
        alone, beside, count = measure(same(kept_session, (HEAVY, 4096), 20))
        print(json.dumps({"attack": "twenty of 4096²", "alone ms": [round(1e3 * x, 1) for x in alone],
                          "beside ms": [round(1e3 * x, 1) for x in beside], "pictures": count}))
        if beside[1] < 0.5 * SLOW:
            return
    assert beside[1] < 0.5 * SLOW


@pytest.mark.parametrize("option", ["--max-jobs", "--max-client-jobs"])
def test_as_many_jobs_wait_as_may(option):
    """Requests beyond the limit on queued jobs are refused; pictures of a session's stream are only delayed."""
    path = f"/api/v1/frame.png?polytope={HEAVY.replace(' ', '%20')}&width=1024&height=1024"
    with Server("--workers", 1, option, 2) as server:
        with ThreadPoolExecutor(12) as pool:
            answers = [pool.submit(server.get, path) for _ in range(12)]
            latencies = asyncio.run(press(server, 0.5))
            answers = [answer.result() for answer in answers]
        refused = [answer for answer in answers if answer.status == 503]
        # The number of refusals depends on timing: the polytope must be built, and the stream occupies a place.
        assert {answer.status for answer in answers} == {200, 503}
        assert {json.loads(answer.body)["code"] for answer in refused} == {"too_many"}
        assert latencies
        assert server.get(path).status == 200
