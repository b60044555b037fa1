"""Requests beyond the limit on queued pictures are refused; pictures of a session's stream are only delayed."""

import asyncio
import json
import signal
from concurrent.futures import ThreadPoolExecutor

import pytest
from harness import Server, wait_until
from wire import Client

PICTURE = "/api/v1/frame.png?polytope=24-cell&width=64&height=64"


@pytest.mark.parametrize("option", ["--max-jobs", "--max-client-jobs"])
async def test_requests_beyond_the_job_limit_are_refused(option):
    with Server("--workers", 1, option, 2) as server, ThreadPoolExecutor(12) as pool:
        async with Client(server, stream="frames", width=64, height=64) as client:
            await client.wait_for_frame(0)
            assert server.get(PICTURE).status == 200
            # While nothing is drawn, one picture is in progress and two wait; the others are refused. There is one
            # picture less if the third request comes before the worker takes the first.
            server.suspend_drawing_processes()
            answers = [pool.submit(server.get, PICTURE) for _ in range(12)]
            wait_until(lambda: sum(answer.done() for answer in answers) >= 9, "refusals")
            done = await client.request("key", key="r")
            server.signal_drawing_processes(signal.SIGCONT)
            answers = [await asyncio.wrap_future(answer) for answer in answers]
            refused = [answer for answer in answers if answer.status == 503]
            assert {answer.status for answer in answers} == {200, 503} and len(refused) in (9, 10)
            assert {json.loads(answer.body)["code"] for answer in refused} == {"too_many"}
            await client.wait_for_frame(done["revision"])
            assert server.get(PICTURE).status == 200
