"""How long a server that is working takes to stop, compared with the time in which a server starts."""

import signal
import statistics
import time

import pytest
from harness import Server
from running_work import KINDS_OF_WORK, server_with_running_work

TIMEOUT = 0.3  # seconds that clients have to disconnect; none of them does


@pytest.mark.parametrize("work", KINDS_OF_WORK)
def test_running_work_does_not_delay_a_stop(work):
    stops, starts = [], []
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        with server_with_running_work(work, "--stop-timeout", TIMEOUT) as server:
            status, seconds = server.stop(number)
            assert status == 0
            stops.append(seconds - TIMEOUT)
        start = time.monotonic()
        with Server():
            starts.append(time.monotonic() - start)
    figures = f"{work}: seconds of stops beyond the time limit {stops}, of starts {starts}"
    print(figures)
    assert statistics.median(stops) <= 4 * statistics.median(starts), figures
