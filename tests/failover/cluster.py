"""Runs several servers, Redis and HAProxy on loopback: the services of docker/compose.yaml, without Docker."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/service"))
from harness import DEADLINE, LONG_TIME, Server, free_port, is_listening, wait_until  # noqa: E402

NO_OUTPUT = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


class Redis:
    """A redis-server with its data in `folder`; tests stop, pause and restart it."""

    def __init__(self, folder, *options):
        self.port = free_port()
        self.words = ["redis-server", "--port", str(self.port), "--bind", "127.0.0.1", "--dir", str(folder), "--save", "",
                      "--appendonly", "yes", *options]
        self.process = None
        self.url = f"redis://127.0.0.1:{self.port}"

    def start(self):
        self.process = subprocess.Popen(self.words, **NO_OUTPUT)
        wait_until(lambda: self.command("PING") == "PONG", "Redis")

    def command(self, *words):
        output = subprocess.run(["redis-cli", "-p", str(self.port), *words], capture_output=True, text=True, check=False,
                                timeout=DEADLINE)
        return output.stdout.strip()

    def kill(self, number=signal.SIGKILL):
        if self.process:
            self.process.send_signal(number)
        if number not in (signal.SIGSTOP, signal.SIGCONT):
            self.process.wait()

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.kill()


class Proxy:
    """HAProxy with docker/haproxy.cfg, except for the addresses of the servers."""

    def __init__(self, folder, servers):
        self.host, self.port = "127.0.0.1", free_port()
        text = (ROOT / "docker/haproxy.cfg").read_text(encoding="utf-8")
        text = text.replace("bind :8080", f"bind 127.0.0.1:{self.port}")
        # A server may take long to answer a health check. One that is killed or drained refuses it at once.
        text = text.replace("defaults\n", f"defaults\n    timeout check {DEADLINE}s\n")
        text = re.sub(r"resolvers names\n(    .*\n)+", "", text)
        server_lines = "\n    ".join(f"server oval4d{i} 127.0.0.1:{port}" for i, port in enumerate(servers, 1))
        text, replaced = re.subn(r"server-template .*", server_lines, text)
        assert replaced == 2
        path = folder / "haproxy.cfg"
        path.write_text(text, encoding="utf-8")
        checked = subprocess.run(["haproxy", "-c", "-f", path], capture_output=True, text=True, check=False)
        assert checked.returncode == 0, checked.stderr
        self.process = subprocess.Popen(["haproxy", "-db", "-f", path], **NO_OUTPUT)
        wait_until(lambda: is_listening(self.host, self.port), "HAProxy")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


def start_server(redis, port, *options):
    # A slow Redis does not count as failed.
    patience = () if "--store-timeout" in options else ("--store-timeout", LONG_TIME)
    return Server("--port", port, "--store", redis.url, "--log-level", "debug" if os.environ.get("DEBUG") else "info",
                  "--workers", "1", *patience, *options)
