"""The image built from docker/Dockerfile, and the server in it, run as the image's user."""

import asyncio
import contextlib
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import image

sys.path.insert(0, str(image.ROOT / "tests/service"))
import harness  # noqa: E402
import png  # noqa: E402
from wire import Client  # noqa: E402

SIZE = {"width": 320, "height": 180}


def test_the_image_configuration(built_image):
    config = built_image.config
    assert config["User"] == "999"
    assert config["Entrypoint"] == ["oval4d"]
    assert "8080/tcp" in config["ExposedPorts"] and "/var/lib/oval4d" in config["Volumes"]
    assert config["StopSignal"] == "SIGTERM"
    assert config["Labels"]["org.opencontainers.image.licenses"] == "MIT"
    assert "readyz" in built_image.description["Docker"]["config"]["Healthcheck"]["Test"][-1]


def test_the_image_contains_the_server_and_no_build_tools(built_image):
    files = built_image.files
    for tool in ("gcc", "g++", "cc", "c++", "clang", "make", "cmake", "ninja", "node", "npm", "git", "curl", "wget", "python3"):
        for folder in ("usr/bin", "usr/local/bin", "bin"):
            assert not (files / folder / tool).is_symlink() and not (files / folder / tool).exists(), tool
    assert not (files / "oval4d").exists()
    assert (files / "usr/share/oval4d/web_client/index.html").is_file()


def test_the_size_of_the_image_is_limited(built_image):
    files = built_image.files
    status = (files / "var/lib/dpkg/status").read_text(encoding="utf-8")
    sizes = {}
    for entry in status.split("\n\n"):
        fields = dict(re.findall(r"^([\w-]+): (.*)$", entry, re.MULTILINE))
        if "Installed-Size" in fields:
            sizes[fields["Package"]] = int(fields["Installed-Size"]) / 1024
    whole = int(image.run("du", "-sm", files).split()[0])
    parts = sorted(sizes.items(), key=lambda item: -item[1])[:6]
    lines = [f"image: {whole} MB", *(f"  {name}: {size:.0f} MB" for name, size in parts),
             f"  oval4d itself: {os.path.getsize(files / 'usr/bin/oval4d') / 1e6:.0f} MB"]
    print("\n".join(lines))
    figures = image.ROOT / "build/results/container/figures.txt"
    figures.parent.mkdir(parents=True, exist_ok=True)
    figures.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert whole < 600


class ContainedServer(harness.Server):
    """Runs the image's entry point without options, as the image's user, with all files read-only except the volume."""

    def __init__(self, files, variables):
        self.files = files
        super().__init__(**variables)

    def start(self, command, environment):
        script = f"""
            mount --bind {self.files} {self.files} && mount -o remount,bind,ro {self.files} &&
            mount -t tmpfs -o mode=700,uid=999,gid=999 none {self.files}/var/lib/oval4d &&
            mount --bind /dev {self.files}/dev && mount -t proc none {self.files}/proc &&
            exec chroot --userspec=999:999 {self.files} oval4d
        """
        return subprocess.Popen(["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c", script],
                                env=environment, stderr=self.log_file, stdin=subprocess.DEVNULL)

    def stop(self, *_):
        os.kill(self.server_pid(), signal.SIGTERM)
        return self.process.wait(harness.DEADLINE), 0

    def server_pid(self):
        """Returns the process ID of the server; the test's own child process is unshare, which waits for it."""
        return int(image.run("pgrep", "-P", self.process.pid))


def test_the_server_in_the_image_draws_the_same_pictures(built_image):
    files, environment = built_image.files, built_image.variables

    async def state_and_pixels(server):
        async with Client(server, stream="none", **SIZE) as client:
            await client.request("set", polytope="24-cell")
            for key in "yrtk2":
                await client.request("key", key=key)
            state = await client.request("get", what="state")
            return {**state, "id": 0, "object_serial": 0}, png.pixels(await client.request_frame())

    with contextlib.ExitStack() as stack:
        inside = stack.enter_context(
            ContainedServer(files, environment | harness.LONG_TIME_VARIABLES | {"OVAL4D_PORT": "0", "OVAL4D_HOST": "127.0.0.1"}))
        outside = stack.enter_context(harness.Server())
        status = Path(f"/proc/{inside.server_pid()}/status").read_text(encoding="ascii")
        assert re.search(r"^Uid:\s+999\s+999", status, re.MULTILINE)
        assert asyncio.run(state_and_pixels(inside)) == asyncio.run(state_and_pixels(outside))
        assert b"<title>" in inside.get("/").body
        healthcheck = re.search(r'CMD (\["bash".*\])', (image.ROOT / "docker/Dockerfile").read_text(encoding="utf-8"))
        done = subprocess.run(["chroot", "--userspec=999:999", files, *json.loads(healthcheck[1])], check=False,
                              env={**environment, "OVAL4D_PORT": str(inside.port)})
        assert done.returncode == 0
        assert inside.metric("oval4d_sessions") == 1  # the session is stored in the volume
