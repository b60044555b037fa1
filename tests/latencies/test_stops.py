"""How long a server that is working takes to stop, compared with the time in which a server starts."""

import contextlib
import signal
import statistics
import time

import pytest
from harness import Server
from raw import WebSocket
from running_work import KINDS_OF_WORK, server_with_running_work

TIMEOUT = 0.3  # seconds that clients have to disconnect, which none of them does
TIMES = 3


@pytest.mark.parametrize("work", KINDS_OF_WORK)
def test_running_work_does_not_delay_a_stop(work):
    stops, starts = [], []
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT)[:TIMES]:
        with server_with_running_work(work, "--stop-timeout", TIMEOUT) as server:
            status, seconds = server.stop(number)
            assert status == 0
            stops.append(seconds - TIMEOUT)
        start = time.monotonic()
        with Server("--stop-timeout", TIMEOUT) as server, WebSocket(server) as idle:
            starts.append(time.monotonic() - start)
            idle.request(type="hello")
            with contextlib.suppress(AssertionError):
                idle_seconds = server.stop()[1] - TIMEOUT
    print(f"{work}: stops after the time limit {stops}, of an idle server {idle_seconds}, starts {starts}")
    assert statistics.median(stops) <= 2 * statistics.median(starts)
