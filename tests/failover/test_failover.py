"""Servers are killed and drained, and Redis is restarted, while hundreds of sessions press keys.

Every session must continue from the state that was last acknowledged to its client, and none may be lost or mixed up
with another. The durations of the interruptions are printed, and written to build/results/failover/figures.txt.
"""

import asyncio
import os
import signal
from pathlib import Path

import cluster
from harness import DEADLINE
from pressing_clients import PressingClient, wait_until_all_press

SESSIONS = int(os.environ.get("OVAL4D_FAILOVER_SESSIONS") or 300)
FIGURES = cluster.ROOT / "build/results/failover/figures.txt"


def report_interruptions(event, clients, earlier):
    """Reports the durations of the interruptions, without the first `earlier[i]` ones of client i."""
    times = sorted(t for client, count in zip(clients, earlier) for t in client.interruptions[count:])
    assert times, f"{event}: no client was interrupted"
    p50, p99 = times[len(times) // 2], times[int(len(times) * 0.99)]
    line = f"{event}: {len(times)} of {len(clients)} sessions moved; away for {p50:.2f} s (median), {p99:.2f} s (99th), " \
           f"{times[-1]:.2f} s (longest)"
    print(line)
    with open(FIGURES, "a", encoding="utf-8") as file:
        file.write(line + "\n")


async def run_scenario(folder):
    with cluster.Redis(folder) as redis:
        ports = [cluster.free_port() for _ in range(3)]
        servers = [cluster.start_server(redis, port) for port in ports]
        tasks = []
        try:
            with cluster.Proxy(folder, ports) as proxy:
                clients = [PressingClient(number, proxy) for number in range(SESSIONS)]
                tasks = [asyncio.ensure_future(client.run()) for client in clients]

                async def act_and_check(event, action, moved=True):
                    earlier = [len(client.interruptions) for client in clients]
                    await wait_until_all_press(clients)
                    await action()
                    await wait_until_all_press(clients)
                    await wait_until_all_press(clients)
                    if moved:
                        report_interruptions(event, clients, earlier)

                async def kill_first_server():
                    servers[0].process.send_signal(signal.SIGKILL)
                    servers[0].process.wait()

                async def drain_second_server():
                    servers[1].process.send_signal(signal.SIGTERM)
                    await asyncio.get_running_loop().run_in_executor(None, servers[1].process.wait)

                async def restart_servers():
                    for i in (0, 1):
                        servers[i].kill()
                        servers[i] = cluster.start_server(redis, ports[i])

                async def restart_redis():
                    redis.kill()
                    unavailable = lambda: "the store is unavailable" in servers[2].get("/readyz").body.decode()
                    await asyncio.to_thread(servers[2].wait_for, unavailable)
                    redis.start()  # meanwhile, no client presses a key
                    for server in servers:
                        server.wait_for(lambda server=server: server.get("/readyz").body == b"ready\n")
                        server.wait_for(lambda server=server: server.metric("oval4d_unsaved_sessions") < SESSIONS / 10)

                async def kill_third_server():
                    servers[2].process.send_signal(signal.SIGKILL)
                    servers[2].process.wait()

                await act_and_check("start", lambda: asyncio.sleep(0), moved=False)
                await act_and_check("a server killed", kill_first_server)
                await act_and_check("a server drained", drain_second_server)
                await act_and_check("two servers restarted", restart_servers, moved=False)
                await act_and_check("Redis restarted", restart_redis, moved=False)
                await act_and_check("the third server killed", kill_third_server)
                for client in clients:
                    client.stopping = True
                await asyncio.wait_for(asyncio.gather(*tasks), DEADLINE)
                assert sum(client.pressed for client in clients) > 5 * SESSIONS
        finally:
            for task in tasks:
                task.cancel()
            for server in servers:
                server.kill()


def test_every_session_survives_kills_drains_and_restarts(tmp_path):
    FIGURES.parent.mkdir(parents=True, exist_ok=True)
    FIGURES.unlink(missing_ok=True)
    asyncio.run(run_scenario(Path(tmp_path)))
