"""Servers are killed and drained, and Redis is restarted, while hundreds of sessions press keys.

Every session goes on with the state that was last acknowledged to its client, none is lost or mixed up with another. How
long they were away is printed, and written to build/results/failover/figures.txt.
"""

import asyncio
import json
import os
import random
import signal
import time
from pathlib import Path

import cluster
import websockets
from harness import DEADLINE, SLOW
from wire import SUBPROTOCOL

SESSIONS = int(os.environ.get("OVAL4D_FAILOVER_SESSIONS") or 300)
FIGURES = cluster.ROOT / "build/results/failover/figures.txt"


class Session:
    """A client that presses keys and comes back by itself, at once and then with growing pauses."""

    def __init__(self, number, proxy):
        self.number, self.proxy = number, proxy
        self.path, self.token = "/ws", None
        self.acknowledged = self.pressed = 0
        self.start = None  # steps in the angles at revision 0
        self.away = []  # seconds, of each interruption
        self.faults = []
        self.ended = False

    async def run(self):
        lost = None
        pause = 0.1
        while not self.ended:
            try:
                async with websockets.connect(f"ws://127.0.0.1:{self.proxy.port}{self.path}", subprotocols=[SUBPROTOCOL],
                                              ping_interval=None, compression=None, open_timeout=5) as socket:
                    await self.enter(socket)
                    if lost is not None:
                        self.away.append(time.monotonic() - lost)
                    lost, pause = None, 0.1
                    while not self.ended:
                        await self.press(socket)
                        await asyncio.sleep(0.3 * (0.5 + random.random()))
            except (OSError, websockets.WebSocketException, asyncio.TimeoutError) as fault:
                if getattr(fault, "code", None) in (4401, 4404):
                    self.faults.append(f"session {self.number} is lost: {fault}")
                    return
                lost = lost or time.monotonic()
                await asyncio.sleep(pause * (0.5 + random.random()))
                pause = min(2 * pause, 5)

    async def ask(self, socket, id_, **message):
        await socket.send(json.dumps({"id": id_, **message}))
        while True:
            answer = json.loads(await asyncio.wait_for(socket.recv(), DEADLINE))
            if answer.get("id") == id_:
                return answer

    async def enter(self, socket):
        welcome = await self.ask(socket, 1, type="hello", **({"token": self.token} if self.token else {}))
        if welcome["type"] != "welcome":
            await asyncio.wait_for(socket.recv(), DEADLINE)  # the close that follows tells which error it was
        state = await self.ask(socket, 2, type="get", what="state")
        if self.token is None:
            self.path, self.token = f"/ws/{welcome['session']}", welcome["token"]
            self.start = self.steps(state)
            done = await self.ask(socket, 3, type="set", camera={"azimuth": (self.number + 1) / 1000})  # whose it is
            self.acknowledged = done["revision"]
            return
        if self.acknowledged and abs(state["camera"]["azimuth"] - (self.number + 1) / 1000) > 1e-9:
            self.faults.append(f"session {self.number} has another's state")
        if state["revision"] < self.acknowledged:
            self.faults.append(f"session {self.number} was at {self.acknowledged} and is at {state['revision']}")
        if self.steps(state) - self.start != max(0, state["revision"] - 1):
            self.faults.append(f"session {self.number} is in a state that never was: {state}")

    @staticmethod
    def steps(state):
        """Each key adds one step to α: with the one that set the camera, so many revisions."""
        return round(state["alpha"] / state["step"])

    async def press(self, socket):
        done = await self.ask(socket, 10 + self.pressed, type="key", key="k")
        self.pressed += 1
        if done["type"] == "done":
            self.acknowledged = max(self.acknowledged, done["revision"])
        else:
            self.faults.append(f"session {self.number}: {done}")


def figures(what, sessions, seen):
    """The times of the interruptions since `seen`."""
    times = sorted(t for session, count in zip(sessions, seen) for t in session.away[count:])
    assert times, f"{what}: nobody noticed"
    p50, p99 = times[len(times) // 2], times[int(len(times) * 0.99)]
    line = f"{what}: {len(times)} of {len(sessions)} sessions moved; away for {p50:.2f} s (median), {p99:.2f} s (99th), " \
           f"{times[-1]:.2f} s (longest)"
    print(line)
    with open(FIGURES, "a", encoding="utf-8") as file:
        file.write(line + "\n")
    assert times[-1] < 20 * SLOW


async def all_press(sessions):
    """Waits until every session has had a key acknowledged from now on."""
    before = [session.pressed for session in sessions]
    limit = time.monotonic() + 2 * DEADLINE
    while any(session.pressed <= count and not session.faults for session, count in zip(sessions, before)):
        assert time.monotonic() < limit, f"{sum(s.pressed <= c for s, c in zip(sessions, before))} sessions hang"
        await asyncio.sleep(0.05)
    faults = [fault for session in sessions for fault in session.faults]
    assert not faults, faults[:10]


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
