"""Fairness: a session stays responsive while other clients request as much as they can.

During an attack, the latency of a session is compared with that of a session of a server that nobody attacks.
"""

import asyncio
import contextlib
import http.client
import itertools

import numpy
import pytest
from harness import Server
from measuring import compare_frames
from wire import Client, Refused

HEAVY = "omnitruncated 120-cell"
VICTIM_ADDRESS = "127.0.0.1"
OTHER_ADDRESSES = [f"127.0.0.{n}" for n in range(2, 12)]


# --- The attacks: coroutine functions of (server, address, …), which are repeated until their process is killed


async def new_session_per_frame(server, address, polytope, side=2048):
    async with Client(server, stream="none", address=address) as client:
        await client.request("set", polytope=polytope)
        await client.request_frame(width=side, height=side)


async def frames_of_one_session(server, address, polytope, side=2048):
    async with Client(server, stream="none", address=address) as client:
        await client.request("set", polytope=polytope)
        while True:
            client.messages.clear()
            await client.request("key", key="r")
            await client.request_frame(width=side, height=side)


async def turning_stream(server, address, polytope, kind, side=2048):
    async with Client(server, stream=kind, width=side, height=side, address=address, compares=False) as client:
        await client.request("set", polytope=polytope)
        while True:
            done = await client.request("key", key="r")
            wait = client.wait_for_slices if kind == "geometry" else client.wait_for_frame
            await wait(done["revision"])
            del client.messages[:-20]


async def frames_over_http(server, address, polytope, side=2048):
    def request_frame():
        connection = http.client.HTTPConnection(server.host, server.port, timeout=60, source_address=(address, 0))
        with contextlib.closing(connection):
            name = polytope.replace(" ", "%20")
            connection.request("GET", f"/api/v1/frame.png?polytope={name}&width={side}&height={side}")
            connection.getresponse().read()
    await asyncio.to_thread(request_frame)


def sphere_points(count):
    """Returns points that are evenly but irregularly distributed on the 3-sphere, as text."""
    golden = [0.8566748838545029, 0.733891856627126, 0.6287067210378087]
    rows = []
    for i in range(count):
        u = [(0.5 + i * g) % 1 * 2 - 1 for g in golden]
        last = (i * 0.5385972572236101) % 1 * 2 - 1
        length = sum(x * x for x in (*u, last)) ** 0.5 or 1
        rows.append(" ".join(f"{x / length:.6f}" for x in (*u, last)))
    return "\n".join(rows)


POINTS = sphere_points(600)


async def repeated_loads(server, address):
    async with Client(server, stream="none", address=address) as client:
        for number in itertools.count():
            client.messages.clear()
            with contextlib.suppress(Refused):
                await client.request("load", name=f"mine {number % 3}", format="points", data=POINTS)


HEAVY_FORMULA = "x" + "*y/z*w/x" * 249 + "*y/z*w"  # nearly as long, and with nearly as many instructions, as allowed


async def turning_field(server, address, slices, kind, side=720):
    async with Client(server, stream=kind, width=side, height=side, address=address, compares=False) as client:
        await client.request("load", name="heavy", format="formula", data=HEAVY_FORMULA)
        await client.request("set", slices={"count": slices})
        while True:
            done = await client.request("key", key="r")
            wait = client.wait_for_slices if kind == "geometry" else client.wait_for_frame
            await wait(done["revision"])
            del client.messages[:-20]


HUGE = "huge.npy"


def write_huge_array(folder):
    """Writes an array in which surfaces are everywhere."""
    axes = [numpy.linspace(-1, 1, 80, dtype="f4") for _ in range(4)]
    t, z, y, x = numpy.meshgrid(*axes, indexing="ij", sparse=True)
    waves = (numpy.sin(19 * x + 5 * t) * numpy.cos(17 * y) + numpy.sin(15 * z - 7 * x) * numpy.cos(13 * t + 3 * y))
    numpy.save(folder / HUGE, waves.astype("f4"))


@contextlib.asynccontextmanager
async def huge_field(server, address, **hello):
    """A client whose session shows all that there is of the huge array: levels, fog, and values on surfaces and caps."""
    async with Client(server, address=address, compares=False, **hello) as client:
        await client.request("load", name="huge", path=HUGE, values=HEAVY_FORMULA.removesuffix("*y/z*w"))
        await client.request("set", levels=[-0.5, -0.1, 0.3, 0.7], caps="value", slices={"count": 201},
                             fog=[{"value": -1.5, "opacity": 0.5}, {"value": 1.5, "opacity": 0.9}])
        yield client


async def turning_huge_field(server, address, kind, side=720):
    """Turns without end. Each turn but every third also ends a search for critical w."""
    async with huge_field(server, address, stream=kind, width=side, height=side) as client:
        for turn in itertools.count():
            done = await client.request("key", key="r")
            wait = client.wait_for_slices if kind == "geometry" else client.wait_for_frame
            await wait(done["revision"])
            if turn % 3 != 0:
                await client.send("get", what="critical")
            del client.messages[:-20]


async def searching_huge_field(server, address):
    async with huge_field(server, address, stream="none") as client:
        while True:
            client.messages.clear()
            await client.request("get", what="critical", deadline=120)
            await client.request("key", key="r")


def from_victim_address(attack, arguments, count):
    return [(VICTIM_ADDRESS, attack, arguments, count)]


def from_other_addresses(attack, arguments, count):
    return [(address, attack, arguments, 1) for address in OTHER_ADDRESSES[:count]]


ATTACKS = {
    "new session per frame, heavy polytope, 3 clients": from_victim_address(new_session_per_frame, (HEAVY,), 3),
    "new session per frame, 5-cell, 6 clients": from_victim_address(new_session_per_frame, ("5-cell",), 6),
    "new session per frame, heavy polytope, 3 addresses": from_other_addresses(new_session_per_frame, (HEAVY,), 3),
    "new session per frame, 5-cell, 6 addresses": from_other_addresses(new_session_per_frame, ("5-cell",), 6),
    "frames of 10 sessions": from_victim_address(frames_of_one_session, (HEAVY,), 10),
    "6 streams of frames": from_victim_address(turning_stream, (HEAVY, "frames"), 6),
    "6 streams of slices": from_victim_address(turning_stream, (HEAVY, "geometry"), 6),
    "8 streams of slices of the 5-cell": from_victim_address(turning_stream, ("5-cell", "geometry"), 8),
    "frames over HTTP, 1 address": [(OTHER_ADDRESSES[0], frames_over_http, (HEAVY,), 8)],
    "frames over HTTP, 6 addresses": from_other_addresses(frames_over_http, ("5-cell",), 6),
    **{f"{kind} of a heavy formula, {slices} slices, {count} clients":
       from_victim_address(turning_field, (slices, kind), count)
       for kind, slices, count in [("geometry", 21, 2), ("geometry", 201, 2), ("frames", 21, 2), ("frames", 201, 6)]},
    **{f"2 clients that turn a huge field as {kind}, and 2 that search its critical w":
       from_victim_address(turning_huge_field, (kind,), 2) + from_victim_address(searching_huge_field, (), 2)
       for kind in ("geometry", "frames")},
    "20 sessions with frames of 4096 × 4096 pixels": from_victim_address(frames_of_one_session, (HEAVY, 4096), 20),
    "4 clients that load points": from_victim_address(repeated_loads, (), 4),
}


@pytest.fixture(scope="module")
def data_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    write_huge_array(folder)
    return folder


@pytest.fixture(name="control_server", scope="module")
def start_control_server():
    """A server that nobody attacks."""
    with Server() as server:
        yield server


@pytest.mark.parametrize("name", ATTACKS)
def test_a_session_stays_responsive_during_an_attack(name, data_folder, control_server):
    with Server("--data", data_folder) as server:
        compare_frames(name, server, control_server, ATTACKS[name], VICTIM_ADDRESS).assert_at_most(4, 10)
