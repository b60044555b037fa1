"""Clients that press keys continuously, and check the state of their session after every interruption."""

import asyncio
import json
import random
import time

import websockets
from harness import DEADLINE
from wire import SUBPROTOCOL


class PressingClient:
    """A client that presses keys, and reconnects automatically: at once, then with growing pauses."""

    def __init__(self, number, proxy):
        self.number, self.proxy = number, proxy
        self.path, self.token = "/ws", None
        self.acknowledged = self.pressed = 0
        self.start = None  # α at revision 0, in steps
        self.interruptions = []  # the duration of each interruption in seconds
        self.faults = []
        self.stopping = False
        self.random = random.Random(number)

    async def run(self):
        lost_at, pause = None, 0.1
        while not self.stopping:
            try:
                async with websockets.connect(f"ws://{self.proxy.host}:{self.proxy.port}{self.path}", subprotocols=[SUBPROTOCOL],
                                              ping_interval=None, compression=None, open_timeout=DEADLINE / 4) as socket:
                    await self.join(socket)
                    if lost_at is not None:
                        self.interruptions.append(time.monotonic() - lost_at)
                    lost_at, pause = None, 0.1
                    while not self.stopping:
                        await self.press(socket)
                        await asyncio.sleep(0.3 * (0.5 + self.random.random()))
            except (OSError, websockets.WebSocketException, asyncio.TimeoutError) as fault:
                if getattr(fault, "code", None) in (4401, 4404):
                    self.faults.append(f"session {self.number} is lost: {fault}")
                    return
                lost_at = lost_at or time.monotonic()
                await asyncio.sleep(pause * (0.5 + self.random.random()))
                pause = min(2 * pause, 5)

    async def request(self, socket, id_, **message):
        await socket.send(json.dumps({"id": id_, **message}))
        while True:
            answer = json.loads(await asyncio.wait_for(socket.recv(), DEADLINE))
            if answer.get("id") == id_:
                return answer

    async def join(self, socket):
        welcome = await self.request(socket, 1, type="hello", **({"token": self.token} if self.token else {}))
        if welcome["type"] != "welcome":
            await asyncio.wait_for(socket.recv(), DEADLINE)  # raises ConnectionClosed, whose code identifies the error
        state = await self.request(socket, 2, type="get", what="state")
        if self.token is None:
            self.path, self.token = f"/ws/{welcome['session']}", welcome["token"]
            self.start = self.alpha_steps(state)
            # Identifies the session.
            done = await self.request(socket, 3, type="set", camera={"azimuth": (self.number + 1) / 1000})
            self.acknowledged = done["revision"]
            return
        if self.acknowledged and abs(state["camera"]["azimuth"] - (self.number + 1) / 1000) > 1e-9:
            self.faults.append(f"session {self.number} has the state of another session")
        if state["revision"] < self.acknowledged:
            self.faults.append(f"session {self.number} fell back from revision {self.acknowledged} to {state['revision']}")
        if self.alpha_steps(state) - self.start != max(0, state["revision"] - 1):
            self.faults.append(f"session {self.number} has angles that do not match its revision: {state}")

    @staticmethod
    def alpha_steps(state):
        """Returns α in steps. Each key adds one step, so α determines the number of keys."""
        return round(state["alpha"] / state["step"])

    async def press(self, socket):
        done = await self.request(socket, 10 + self.pressed, type="key", key="k")
        self.pressed += 1
        if done["type"] == "done":
            self.acknowledged = max(self.acknowledged, done["revision"])
        else:
            self.faults.append(f"session {self.number}: {done}")


async def wait_until_all_press(clients):
    """Waits until one more key of every client has been acknowledged; fails once none that waits for it makes progress."""
    before = {client: client.pressed for client in clients}
    limit = time.monotonic() + DEADLINE
    while waiting := [client for client in before if client.pressed <= before[client] and not client.faults]:
        if len(waiting) < len(before):
            before = {client: before[client] for client in waiting}
            limit = time.monotonic() + DEADLINE
        assert time.monotonic() < limit, f"{len(waiting)} sessions hang"
        await asyncio.sleep(0.05)
    faults = [fault for client in clients for fault in client.faults]
    assert not faults, faults[:10]
