"""Runs the services of docker/compose.yaml without a Docker engine. Each container has its own network namespace and
address, and finds the others through a name server. The servers come from the image; HAProxy and Redis are those of
this machine.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import image
import yaml

sys.path.insert(0, str(image.ROOT / "tests/service"))
from harness import DEADLINE, LONG_TIME_VARIABLES, is_listening, wait_until  # noqa: E402

FILE = image.ROOT / "docker/compose.yaml"
BRIDGE, NET = "oval4d-br", "10.213.77"
TOOLS = ("ip", "dnsmasq", "haproxy", "redis-server", "unshare", "setpriv")


def reason_to_skip():
    """Returns why this machine cannot run the composition, None if it can."""
    absent = [tool for tool in TOOLS if shutil.which(tool) is None]
    if absent:
        return f"{' and '.join(absent)} cannot be installed"
    try:
        remove_all_containers()
        image.run("ip", "link", "add", BRIDGE, "type", "bridge")
        remove_all_containers()
    except AssertionError as fault:
        return f"this machine does not allow new networks: {fault}"
    return None


class Container:
    """A process and its children in their own network, mount and process namespaces."""

    def __init__(self, folder, number, service, script):
        self.host, self.service, self.name = f"{NET}.{number}", service, f"oval4d-{number}"
        self.log_path = folder / f"{service}-{number}.log"
        for arguments in (["netns", "add", self.name],
                          ["link", "add", self.name, "type", "veth", "peer", "name", "eth0", "netns", self.name],
                          ["link", "set", self.name, "master", BRIDGE, "up"],
                          ["-n", self.name, "address", "add", f"{self.host}/24", "dev", "eth0"],
                          ["-n", self.name, "link", "set", "eth0", "up"],
                          ["-n", self.name, "link", "set", "lo", "up"]):
            image.run("ip", *arguments)
        with open(self.log_path, "wb") as log:
            self.process = subprocess.Popen(
                ["ip", "netns", "exec", self.name, "unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-ec", script],
                stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)

    def is_listening(self, port):
        assert self.process.poll() is None, self.log()
        return is_listening(self.host, port)

    def log(self):
        return self.log_path.read_text(encoding="utf-8", errors="replace")

    def stop(self, number=signal.SIGTERM):
        """Sends a signal to the container's first process, as `docker stop` does; returns its exit status."""
        first_process = image.run("pgrep", "-P", self.process.pid)
        os.kill(int(first_process), number)
        return self.process.wait(DEADLINE)

    def remove(self):
        remove_namespace(self.name)
        self.process.wait()


def remove_namespace(name):
    """Kills all processes in a network namespace, and deletes the namespace."""
    def process_ids():
        return image.run("ip", "netns", "pids", name).split()

    for process in process_ids():
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(process), signal.SIGKILL)
    wait_until(lambda: not process_ids(), "the end of a container")
    image.run("ip", "netns", "delete", name)
    with contextlib.suppress(AssertionError):  # the link may have been deleted with the namespace
        image.run("ip", "link", "delete", name)


def remove_all_containers():
    """Removes all namespaces and the bridge, including those of an earlier run that was killed."""
    for line in image.run("ip", "netns", "list").splitlines():
        if line.startswith("oval4d-"):
            remove_namespace(line.split()[0])
    with contextlib.suppress(AssertionError):
        image.run("ip", "link", "delete", BRIDGE)


class Composition:
    """Runs the services of compose.yaml as `docker compose up` does. A name server listens on the bridge's address."""

    def __init__(self, folder, image_files, image_variables):
        self.folder, self.files, self.image_variables = folder, image_files, image_variables
        self.services = yaml.safe_load(FILE.read_text(encoding="utf-8"))["services"]
        self.containers = []
        self.last_number = 10
        self.resolv_file = folder / "resolv.conf"
        self.resolv_file.write_text(f"nameserver {NET}.1\n", encoding="ascii")
        self.hosts_file = folder / "hosts"
        self.hosts_file.touch()
        self.name_server = None

    def __enter__(self):
        try:
            for arguments in (["link", "add", BRIDGE, "type", "bridge"], ["address", "add", f"{NET}.1/24", "dev", BRIDGE],
                              ["link", "set", BRIDGE, "up"]):
                image.run("ip", *arguments)
            self.name_server = subprocess.Popen(
                ["setpriv", "--pdeathsig=KILL", "dnsmasq", "--keep-in-foreground", "--conf-file=/dev/null", "--no-resolv", "--no-hosts", "--user=root",
                 f"--addn-hosts={self.hosts_file}", f"--listen-address={NET}.1", "--bind-interfaces", "--pid-file",
                 "--local-ttl=1"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            wait_until(lambda: is_listening(f"{NET}.1", 53), "the name server")  # before that, SIGHUP would end it
            self.start_container("redis", self.redis_script())
            for _ in range(self.services["oval4d"]["deploy"]["replicas"]):
                self.start_container("oval4d", self.server_script())
            self.proxy = self.start_container("proxy", self.proxy_script())
            self.proxy.port = int(self.services["proxy"]["ports"][0].rsplit(":", 1)[1])
            wait_until(lambda: self.proxy.is_listening(self.proxy.port), "the proxy")
            return self
        except BaseException:
            self.__exit__()
            raise

    def __exit__(self, *_):
        for container in self.containers:
            container.remove()
        if self.name_server:
            self.name_server.kill()
            self.name_server.wait()
        remove_all_containers()

    def servers(self):
        return [container for container in self.containers if container.service == "oval4d"]

    def start_container(self, service, script):
        """Starts one more container of this service, and adds its address to the service's name."""
        self.last_number += 1
        container = Container(self.folder, self.last_number, service, script)
        self.containers.append(container)
        self.update_host_names()
        return container

    def add_server(self):
        """Starts one more oval4d server."""
        return self.start_container("oval4d", self.server_script())

    def remove_container(self, container):
        """Removes a container that has ended."""
        self.containers.remove(container)
        container.remove()
        self.update_host_names()

    def update_host_names(self):
        lines = [f"{container.host} {container.service}\n" for container in self.containers]
        self.hosts_file.write_text("".join(lines), encoding="ascii")
        self.name_server.send_signal(signal.SIGHUP)  # makes dnsmasq read the file again

    def server_script(self):
        """Returns a script that runs the server with the image's files, read-only except for the volume, as the image's
        user and without capabilities."""
        service = self.services["oval4d"]
        assert service["read_only"] and service["cap_drop"] == ["ALL"] and service["security_opt"] == ["no-new-privileges:true"]
        variables = self.image_variables | LONG_TIME_VARIABLES | service["environment"]
        settings = " ".join(f"{name}='{value}'" for name, value in variables.items())
        files = self.files
        mount_tmpfs = "\n".join(f"            mount -t tmpfs -o mode=1777 none {files}{folder}" for folder in service["tmpfs"])
        return f"""
            mount --bind {files} {files}
            mount --bind {self.resolv_file} {files}/etc/resolv.conf
            mount -o remount,bind,ro {files}
            mount -t tmpfs -o mode=700,uid=999,gid=999 none {files}/var/lib/oval4d
{mount_tmpfs}
            mount --bind /dev {files}/dev
            mount -t proc none {files}/proc
            exec env -i {settings} chroot {files} setpriv --reuid 999 --regid 999 --clear-groups --no-new-privs \
                --bounding-set=-all --inh-caps=-all oval4d
        """

    def redis_script(self):
        """Returns a script that runs Redis without protected mode, as its Docker image does: only the other containers
        can reach its network."""
        folder = self.folder / "redis"
        folder.mkdir()
        return f"cd {folder}; exec {self.services['redis']['command']} --protected-mode no"

    def proxy_script(self):
        source, target, mode = self.services["proxy"]["volumes"][0].split(":")
        assert (target, mode) == ("/usr/local/etc/haproxy/haproxy.cfg", "ro")
        return f"mount --bind {self.resolv_file} /etc/resolv.conf; exec haproxy -W -db -f {Path(FILE.parent, source).resolve()}"
