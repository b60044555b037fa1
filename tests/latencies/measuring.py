"""Measures a latency of a server that other clients load as much as they can, and of a control.

The control is a second server, which nobody loads. One operation on each alternates with the other, so both are delayed
alike by whatever else the machine does, and their ratio tells what the load of the server costs its other clients. Only
statistics that a few outliers do not move are compared: medians, and 90th percentiles of hundreds of samples.

Attackers run in separate processes at the lowest priority: they stand for other machines, whose processors the server
does not share. At normal priority, the time that they take from the attacked server's processes, but not from the idle
ones of the control, would count as the server's fault.
"""

import asyncio
import contextlib
import multiprocessing
import os
import time
from pathlib import Path

from harness import wait_until
from wire import Client, Refused

SAMPLES = 300


def quantile(values, share):
    """Returns the least value that is at least as large as this share of the values."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


class Comparison:
    """Seconds that one operation took at the attacked server and at the control."""

    def __init__(self, name):
        self.name, self.attacked, self.control = name, [], []
        self.processors = 0.0  # processors that the attacked server used on average

    def ratio(self, share):
        """Returns this quantile at the attacked server, divided by that of the control."""
        return quantile(self.attacked, share) / quantile(self.control, share)

    def assert_at_most(self, median, quantile_90):
        """Asserts bounds on the ratios, and prints all figures."""
        print(self)
        assert self.ratio(0.5) <= median, str(self)
        assert self.ratio(0.9) <= quantile_90, str(self)

    def __str__(self):
        def figures(samples):
            return " ".join(f"{1e3 * quantile(samples, share):.1f}" for share in (0.5, 0.9, 0.99, 1))
        return (f"{self.name}: ms at 50 90 99 100 %: {figures(self.attacked)}, control {figures(self.control)}; ratios "
                f"{self.ratio(0.5):.2f} {self.ratio(0.9):.2f}, {len(self.attacked)} samples; the attacked server used "
                f"{self.processors:.2f} processors")


# --- How much processor time a server uses


def processor_time(pid):
    """Returns the processor time, in seconds, of a process and its children."""
    total, parents = {}, {}
    for file in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            fields = file.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
            total[int(file.parent.name)] = int(fields[11]) + int(fields[12])
            parents[int(file.parent.name)] = int(fields[1])
    return sum(ticks for each, ticks in total.items() if pid in (each, parents[each])) / os.sysconf("SC_CLK_TCK")


def wait_until_busy(server, seconds):
    """Waits until the server has used this much processor time."""
    start = processor_time(server.process.pid)
    wait_until(lambda: processor_time(server.process.pid) >= start + seconds, "the attack to begin")


# --- Processes that repeat an attack


async def repeat_attack(attack, server, address, arguments):
    while True:
        try:
            await attack(server, address, *arguments)
        except (Refused, OSError, AssertionError, asyncio.TimeoutError):
            await asyncio.sleep(0.05)


def run_attackers(address, attack, arguments, host_and_port, count):
    """Runs `count` attackers; the main function of an attacking process."""
    class ServerAddress:
        host, port = host_and_port

    os.nice(19)

    async def run_all():
        await asyncio.gather(*(repeat_attack(attack, ServerAddress, address, arguments) for _ in range(count)))
    asyncio.run(run_all())


@contextlib.contextmanager
def under_attack(server, attacks, seconds=0.5):
    """Runs attacking processes, one for each (address, attack, arguments, number of clients). The `with` block begins
    once the server has worked for them for some seconds of processor time."""
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=run_attackers, daemon=True,
                                 args=(address, attack, arguments, (server.host, server.port), count))
                 for address, attack, arguments, count in attacks]
    for process in processes:
        process.start()
    try:
        wait_until_busy(server, seconds)
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


# --- The measured operation: pressing a key and waiting for its frame


async def press_keys(servers, latencies, count, address):
    """Presses keys in one session of each server, one after the other; appends the seconds from each key to its frame."""
    async with contextlib.AsyncExitStack() as stack:
        clients = []
        for server in servers:
            client = Client(server, stream="frames", width=1280, height=720, address=address)
            clients.append(await stack.enter_async_context(client))
            await client.wait_for_frame(0)
        for _ in range(count):
            for client, samples in zip(clients, latencies):
                pressed = time.perf_counter()
                client.messages.clear()
                done = await client.request("key", key="r")
                await client.wait_for_frame(done["revision"])
                samples.append(time.perf_counter() - pressed)


def compare_frames(name, attacked_server, control_server, attacks, address):
    """Compares the latencies of frames during the attacks."""
    servers, found = (attacked_server, control_server), Comparison(name)
    asyncio.run(press_keys(servers, ([], []), 30, address))  # warm-up: everything is built and in memory
    with under_attack(attacked_server, attacks):
        start, used = time.perf_counter(), processor_time(attacked_server.process.pid)
        for _ in range(3):  # new sessions must be served soon, too
            asyncio.run(press_keys(servers, (found.attacked, found.control), SAMPLES // 3, address))
        used = processor_time(attacked_server.process.pid) - used
        found.processors = used / (time.perf_counter() - start)
    return found
