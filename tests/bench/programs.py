"""Runs the programs that measure, from the folder that is the first argument of report.py."""

import contextlib
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

BIN = Path(sys.argv[1])


def pictures(polytope, slices=21, width=1280, height=720, frames=40, **settings):
    """Runs bench_pictures; returns its measurements."""
    words = [polytope, slices, width, height, frames, *(f"{name}={value}" for name, value in settings.items())]
    done = subprocess.run([BIN / "bench_pictures", *map(str, words)], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


class Server:
    """A running server whose limits are high enough for bench_load."""

    def __enter__(self):
        self.log = tempfile.NamedTemporaryFile(prefix="oval4d-", suffix=".log")
        self.process = subprocess.Popen([BIN / "oval4d", "--port", "0", "--max-requests", "1000000",
                                         "--session-expiry", "2", "--max-client-requests", "10000000",
                                         "--max-new-sessions", "1000000", "--max-client-sessions", "1000000"], stderr=self.log,
                                        env={k: v for k, v in os.environ.items() if not k.startswith("OVAL4D")})
        for _ in range(200):
            time.sleep(0.05)
            if found := re.search(r"listening url=\S+:(\d+)", Path(self.log.name).read_text(encoding="utf-8")):
                self.port = found.group(1)
                with contextlib.suppress(urllib.error.URLError):
                    urllib.request.urlopen(f"http://127.0.0.1:{self.port}/readyz")
                    return self
        raise RuntimeError("the server does not start")

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.log.close()


def load(seconds=5):
    """Runs bench_load; returns its measurements by name."""
    with Server() as server:
        done = subprocess.run([BIN / "bench_load", server.port, str(seconds)], stdout=subprocess.PIPE, text=True,
                              check=True)
    return {row["what"]: row for row in map(json.loads, done.stdout.splitlines())}


def point_on_page():
    """Runs pointing.mjs; returns its measurements, a list with one entry per polytope and part of its picture."""
    done = subprocess.run(["node", str(Path(__file__).with_name("pointing.mjs"))], stdout=subprocess.PIPE, text=True,
                          check=True, env=os.environ | {"OVAL4D": str(BIN / "oval4d")})
    return [json.loads(line) for line in done.stdout.splitlines()]
