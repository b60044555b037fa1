"""Large messages do not delay the requests of other clients."""

import time

from harness import Server
from measuring import SAMPLES, Comparison, under_attack
from raw import TEXT, ConnectionEnded, WebSocket, frame

ATTACKER, OTHER = "127.0.0.2", "127.0.0.3"


async def send_large_commands(server, address):
    """Sends commands that are larger than the server allows, and connects again whenever it ends the connection."""
    data = frame(TEXT, b'{"type":"command","line":"' + b"x" * 8_000_000 + b'"}')
    while True:
        try:
            with WebSocket(server, source=address) as peer:
                peer.request(type="hello")
                while True:
                    peer.send(data)
                    peer.next_message()
        except (ConnectionEnded, OSError):
            time.sleep(0.02)


def test_large_commands_do_not_delay_other_clients():
    options = ("--io-threads", 1, "--max-new-sessions", 100_000, "--max-client-sessions", 2000)
    found = Comparison("large commands")
    with Server(*options) as attacked, Server(*options) as control, under_attack(attacked, [(ATTACKER, send_large_commands, (), 1)], 0.05):
        with WebSocket(attacked, source=OTHER) as victim, WebSocket(control, source=OTHER) as other:
            for peer in (victim, other):
                peer.request(type="hello")
            for _ in range(SAMPLES):
                for peer, samples in ((victim, found.attacked), (other, found.control)):
                    start = time.perf_counter()
                    peer.request(type="key", key="y")
                    samples.append(time.perf_counter() - start)
    # An answer takes a tenth of a millisecond. Parsing a command of this length would take a hundred times as long.
    found.assert_at_most(20, 60)
