"""Clients that press keys continuously, and check their session after every interruption."""

import asyncio
import json
import random
import time

import websockets
from harness import DEADLINE
from wire import SUBPROTOCOL


class Session:
    """A client that presses keys, and reconnects automatically: at once, then with growing pauses."""

    def __init__(self, number, proxy):
        self.number, self.proxy = number, proxy
        self.path, self.token = "/ws", None
        self.acknowledged = self.pressed = 0
        self.start = None  # α at revision 0, in steps
        self.away = []  # the duration of each interruption in seconds
        self.faults = []
        self.ended = False

    async def run(self):
        lost = None
        pause = 0.1
        while not self.ended:
            try:
                async with websockets.connect(f"ws://{self.proxy.host}:{self.proxy.port}{self.path}", subprotocols=[SUBPROTOCOL],
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
            await asyncio.wait_for(socket.recv(), DEADLINE)  # raises ConnectionClosed, whose code identifies the error
        state = await self.ask(socket, 2, type="get", what="state")
        if self.token is None:
            self.path, self.token = f"/ws/{welcome['session']}", welcome["token"]
            self.start = self.steps(state)
            # Identifies the session.
            done = await self.ask(socket, 3, type="set", camera={"azimuth": (self.number + 1) / 1000})
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
        """Returns α in steps. Each key adds one step, so it tells the revision (setting the camera is one more)."""
        return round(state["alpha"] / state["step"])

    async def press(self, socket):
        done = await self.ask(socket, 10 + self.pressed, type="key", key="k")
        self.pressed += 1
        if done["type"] == "done":
            self.acknowledged = max(self.acknowledged, done["revision"])
        else:
            self.faults.append(f"session {self.number}: {done}")


async def all_press(sessions):
    """Waits until every session has had one more key acknowledged."""
    before = [session.pressed for session in sessions]
    limit = time.monotonic() + 2 * DEADLINE
    while any(session.pressed <= count and not session.faults for session, count in zip(sessions, before)):
        assert time.monotonic() < limit, f"{sum(s.pressed <= c for s, c in zip(sessions, before))} sessions hang"
        await asyncio.sleep(0.05)
    faults = [fault for session in sessions for fault in session.faults]
    assert not faults, faults[:10]
