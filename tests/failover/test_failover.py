"""Servers are killed and drained, and Redis is restarted, while hundreds of sessions press keys.

Every session must continue from the state that was last acknowledged to its client, and none may be lost or mixed up
with another. The durations of the interruptions are printed, and written to build/results/failover/figures.txt.
"""

import asyncio
import os
import signal
from pathlib import Path

import cluster
from harness import DEADLINE, SLOW
from sessions import Session, all_press

SESSIONS = int(os.environ.get("OVAL4D_FAILOVER_SESSIONS") or 300)
FIGURES = cluster.ROOT / "build/results/failover/figures.txt"


def figures(what, sessions, seen):
    """Reports the durations of the interruptions after the first `seen` ones of each session."""
    times = sorted(t for session, count in zip(sessions, seen) for t in session.away[count:])
    assert times, f"{what}: nobody noticed"
    p50, p99 = times[len(times) // 2], times[int(len(times) * 0.99)]
    line = f"{what}: {len(times)} of {len(sessions)} sessions moved; away for {p50:.2f} s (median), {p99:.2f} s (99th), " \
           f"{times[-1]:.2f} s (longest)"
    print(line)
    with open(FIGURES, "a", encoding="utf-8") as file:
        file.write(line + "\n")
    assert times[-1] < 20 * SLOW


async def scenario(folder):
    with cluster.Redis(folder) as redis:
        ports = [cluster.free_port() for _ in range(3)]
        servers = [cluster.server(redis, port) for port in ports]
        tasks = []
        try:
            with cluster.Proxy(folder, ports) as proxy:
                sessions = [Session(number, proxy) for number in range(SESSIONS)]
                tasks = [asyncio.ensure_future(session.run()) for session in sessions]

                async def after(what, act, moved=True):
                    seen = [len(session.away) for session in sessions]
                    await all_press(sessions)
                    await act()
                    await all_press(sessions)
                    await all_press(sessions)
                    if moved:
                        figures(what, sessions, seen)

                async def kill():
                    servers[0].process.send_signal(signal.SIGKILL)
                    servers[0].process.wait()

                async def drain():
                    servers[1].process.send_signal(signal.SIGTERM)
                    await asyncio.get_running_loop().run_in_executor(None, servers[1].process.wait)

                async def start_again():
                    for i in (0, 1):
                        servers[i].kill()
                        servers[i] = cluster.server(redis, ports[i])

                async def restart_redis():
                    redis.kill()
                    await asyncio.sleep(1)
                    assert "the store fails" in servers[2].get("/readyz").body.decode()
                    redis.start()
                    for server in servers:
                        server.wait_for(lambda server=server: server.get("/readyz").body == b"ready\n")
                        server.wait_for(lambda server=server: server.metric("oval4d_unsaved_sessions") < SESSIONS / 10)

                async def kill_last():
                    servers[2].process.send_signal(signal.SIGKILL)
                    servers[2].process.wait()

                await after("start", lambda: asyncio.sleep(0), moved=False)
                await after("a server killed", kill)
                await after("a server drained", drain)
                await after("two servers come back", start_again, moved=False)
                await after("Redis restarted", restart_redis, moved=False)
                await after("the server killed that was there all the time", kill_last)
                for session in sessions:
                    session.ended = True
                await asyncio.wait_for(asyncio.gather(*tasks), DEADLINE)
                assert sum(session.pressed for session in sessions) > 5 * SESSIONS
        finally:
            for task in tasks:
                task.cancel()
            for server in servers:
                server.kill()


def test_every_session_goes_on(tmp_path):
    FIGURES.parent.mkdir(parents=True, exist_ok=True)
    FIGURES.unlink(missing_ok=True)
    asyncio.run(scenario(Path(tmp_path)))
