"""Starts a real server for a test, sends it HTTP requests, and inspects its processes."""

import contextlib
import http.client
import itertools
import os
import re
import signal
import socket
import subprocess
import tempfile
import time
import urllib.parse
from pathlib import Path

PROGRAM = Path(os.environ.get("OVAL4D_SERVER") or os.environ.get("OVAL4D") or "build/release/bin/oval4d").resolve()


def is_sanitizer_build():
    program = PROGRAM.read_bytes() if PROGRAM.exists() else b""
    return b"__tsan_init" in program or b"__asan_init" in program


# What a test waits for counts as hung after this many seconds. No other limit bounds how long anything may take.
DEADLINE = int(Path(__file__).parents[1].joinpath("hang_limit_seconds").read_text(encoding="ascii"))

# A value for the server's own time limits. A test about one of these limits sets it to another value. No other test
# depends on the limits, however slow the machine is.
LONG_TIME = 10 * DEADLINE
LONG_TIMES = {name: LONG_TIME for name in ("--data-connect-timeout", "--data-timeout", "--draw-timeout", "--hello-timeout",
                                           "--idle-timeout", "--load-timeout", "--max-file-time", "--write-timeout")}
# A client may be silent for twice this time. During a long command, the server reads nothing for half of this time. The
# Python client gives up if one of its own pings is unanswered for 40 s.
LONG_TIMES["--ping-interval"] = DEADLINE / 2
# The same time limits as environment variables, for servers that tests start without options.
LONG_TIME_VARIABLES = {f"OVAL4D_{name[2:].upper().replace('-', '_')}": str(time) for name, time in LONG_TIMES.items()}


def free_port():
    """Returns a TCP port that belongs to this process until its end.

    Only a program with a fixed port can take this port: it is outside the range from which the kernel chooses ports,
    and other tests see that the abstract socket of its name is taken.
    """
    first, last = map(int, Path("/proc/sys/net/ipv4/ip_local_port_range").read_text(encoding="ascii").split())
    for port in itertools.chain(range(first - 1, 9999, -1), range(last + 1, 1 << 16)):
        mark = socket.socket(socket.AF_UNIX)
        try:
            mark.bind(f"\0oval4d-test-port-{port}")
            with socket.socket() as probe:
                probe.bind(("127.0.0.1", port))
        except OSError:
            mark.close()
            continue
        _port_marks.append(mark)
        return port
    raise AssertionError("no port is free outside the range from which the kernel chooses")


_port_marks = []


def is_listening(host, port):
    """Returns whether a program listens at this address and port."""
    with socket.socket() as probe:
        probe.settimeout(DEADLINE)
        return probe.connect_ex((host, port)) == 0


def wait_until(condition, what):
    """Waits until the condition is true; fails after the deadline with a message that names `what`."""
    limit = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < limit, f"timed out waiting for {what}"
        time.sleep(0.01)


def wait_for_processes_to_end(pids):
    """Waits for the end of processes that were sent a signal; the kernel may take a while to end a stopped process."""
    wait_until(lambda: all(map(has_ended, pids)), "the end of the processes")


def process_state(pid):
    """Returns the state of the process in /proc: "T" if it is suspended, "t" if it has stopped for its tracer, "Z" if
    it has ended but its parent has not waited for it yet, and "X" if it does not exist."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace").rsplit(") ", 1)[1][0]
    except (FileNotFoundError, ProcessLookupError):
        return "X"


def has_ended(pid):
    """Returns whether the process has ended; a zombie counts as ended."""
    return process_state(pid) in "XZ"


def cpu_seconds(pid):
    """Returns the CPU time of a process in seconds."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Server:
    """A running server on its own port. `options` are command-line arguments, `variables` environment variables."""

    def __init__(self, *options, **variables):
        self.log_file = tempfile.NamedTemporaryFile(prefix="oval4d-", suffix=".log")
        environment = {name: value for name, value in os.environ.items() if not name.startswith("OVAL4D")}
        defaults = [("--port", 0), ("--workers", 2), ("--io-threads", 2), *LONG_TIMES.items()]
        arguments = [word for pair in defaults if pair[0] not in options for word in pair]
        command = [str(PROGRAM), *map(str, arguments), *map(str, options)]
        self.process = self.start(command, environment | variables)
        try:
            self.url = self.wait_for(lambda: re.search(r"listening url=(\S+)", self.log())).group(1)
            parts = urllib.parse.urlsplit(self.url)
            self.host, self.port, self.token = parts.hostname, parts.port, parts.query.removeprefix("token=")
            self.wait_for(lambda: self.get("/readyz").status == 200)
        except BaseException:
            self.kill()
            raise

    def start(self, command, environment):
        return subprocess.Popen(command, env=environment, stderr=self.log_file, stdin=subprocess.DEVNULL)

    def log(self):
        return Path(self.log_file.name).read_text(encoding="utf-8", errors="replace")

    def wait_for(self, condition):
        """Returns the condition's first true value; fails if the server ends first, or after the deadline."""
        limit = time.monotonic() + DEADLINE
        while True:
            value = condition()
            if value:
                return value
            assert self.process.poll() is None, f"the server has ended: {self.log()}"
            assert time.monotonic() < limit, f"timed out; the log: {self.log()}"
            time.sleep(0.01)

    def get(self, path, method="GET", **headers):
        """Sends one request and returns the http.client response, with the content as `.body`. In the names of headers,
        _ stands for -."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=DEADLINE)
        with contextlib.closing(connection):
            connection.putrequest(method, path, skip_host="Host" in headers, skip_accept_encoding=True)
            for name, value in headers.items():
                connection.putheader(name.replace("_", "-"), value)
            connection.endheaders()
            answer = connection.getresponse()
            answer.body = answer.read()
            return answer

    def metric(self, name):
        """Returns a value of /metrics, 0 if it is absent; `name` includes the labels."""
        for line in self.get("/metrics").body.decode().splitlines():
            if line.rsplit(" ", 1)[0] == name:
                return float(line.rsplit(" ", 1)[1])
        return 0.0

    def drawing_processes(self):
        """Returns the process IDs of the server's live drawing processes."""
        children = []
        for file in Path("/proc").glob("[0-9]*/stat"):
            try:
                parent = file.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()[1]
                # A process that is ending, or that has not called exec yet, has another command line or none.
                if int(parent) == self.process.pid and file.with_name("cmdline").read_bytes() == b"oval4d\0draw\0":
                    children.append(int(file.parent.name))
            except OSError:
                continue  # the process has ended meanwhile
        return children

    def signal_drawing_processes(self, number):
        """Sends a signal to all drawing processes; returns their process IDs."""
        pids = self.drawing_processes()
        for pid in pids:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, number)
        return pids

    def suspend_drawing_processes(self):
        """Suspends all drawing processes; returns their process IDs once none of them runs."""
        pids = self.signal_drawing_processes(signal.SIGSTOP)
        wait_until(lambda: all(has_ended(pid) or process_state(pid) in "Tt" for pid in pids), "suspended processes")
        return pids

    def open_files(self):
        """Returns the targets of the server's open file descriptors."""
        targets = []
        for file in Path(f"/proc/{self.process.pid}/fd").iterdir():
            with contextlib.suppress(FileNotFoundError):  # the file has been closed meanwhile
                targets.append(os.readlink(file))
        return targets

    def resident_memory(self):
        """Returns the server's resident memory in bytes."""
        pages = Path(f"/proc/{self.process.pid}/statm").read_text(encoding="ascii").split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE")

    def peak_memory(self):
        """Returns the greatest resident memory that the server has had so far, in bytes."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return 1024 * int(re.search(r"VmHWM:\s+(\d+) kB", status).group(1))

    def anonymous_memory(self, pid=None):
        """Returns the anonymous resident memory of the server, or of another process, in bytes. It does not include
        code and the pixels that the server shares with drawing processes."""
        status = Path(f"/proc/{pid or self.process.pid}/status").read_text(encoding="ascii")
        return 1024 * int(re.search(r"RssAnon:\s+(\d+) kB", status).group(1))

    def stop(self, number=signal.SIGTERM):
        """Sends a signal that ends the server; returns the exit status and the seconds until the end."""
        start = time.monotonic()
        self.process.send_signal(number)
        try:
            return self.process.wait(DEADLINE), time.monotonic() - start
        finally:
            self.kill()

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            status, _ = self.stop()
            assert status == 0, self.log()
        assert "fault=" not in self.log(), self.log()
        self.log_file.close()


def run_oval4d(*arguments, **keywords):
    """Runs the program with these arguments until it ends."""
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, timeout=DEADLINE, check=False,
                          **keywords)
