"""Servers that are working when they are to stop."""

import contextlib
import random

from harness import Server, cpu_seconds
from raw import Socket, WebSocket, request
from sandboxes import child_processes

KINDS_OF_WORK = ["files", "files by websocket", "loads", "pictures", "slow readers"]
LONG_FILE = "/api/v1/file.stl?polytope=120-cell&of=oval&body=frame"  # takes seconds to export


def sphere_points(count):
    """Returns points whose convex hull takes some time to compute, as text."""
    rng = random.Random(4)
    lines = []
    for _ in range(count):
        point = [rng.gauss(0, 1) for _ in range(4)]
        size = sum(x * x for x in point) ** 0.5
        lines.append(" ".join(f"{x / size:.17g}" for x in point))
    return "\n".join(lines)


def is_computing(server, subcommand):
    """Returns whether a child process of this kind has used more CPU time than it needs until it waits for work."""
    with contextlib.suppress(OSError):  # the process may just have ended
        return any(cpu_seconds(pid) > 0.2 for pid, kind in child_processes(server).items() if kind == subcommand)
    return False


@contextlib.contextmanager
def server_with_running_work(work, *options):
    """Yields a server that works for four clients, which do not disconnect."""
    with Server("--max-file-triangles", 100_000_000, *options) as server, contextlib.ExitStack() as stack:
        points = sphere_points(6000) if work == "loads" else ""
        for _ in range(4):
            if work in ("files", "slow readers"):
                raw = stack.enter_context(Socket(server, receive_buffer=4096))
                raw.send(request(LONG_FILE if work == "files" else LONG_FILE.replace("120-cell", "24-cell")))
                continue
            peer = stack.enter_context(WebSocket(server))
            peer.request(type="hello", stream="frames" if work == "pictures" else "none", width=4096, height=4096)
            if work == "files by websocket":
                peer.request(type="command", line="polytope 120-cell")
                peer.send_message(type="get", what="file", format="stl", of="oval", body="frame")
            if work == "loads":
                peer.send_message(type="load", name="mine", format="points", data=points)
            if work == "pictures":
                peer.send_message(type="command", line="polytope omnitruncated 120-cell")
                peer.send_message(type="command", line="rotate xw,yz 0.3 0.2")
        server.wait_for({
            "slow readers": lambda: server.metric("oval4d_file_seconds_count") >= 1,
            "loads": lambda: is_computing(server, "read"),
            "pictures": lambda: is_computing(server, "draw"),
        }.get(work, lambda: server.metric("oval4d_files_under_way") >= 1))
        yield server
