"""The drawing and reading processes: what the sandbox allows, and that no session is lost when they die or hang."""

import asyncio
import contextlib
import math
import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pytest
import sandboxes
from harness import DEADLINE, PROGRAM, SLOW, Server, has_ended, sanitized, until
from sandboxes import ALLOW, ERRNO, KILL, Filter, children, limit, status
from wire import Client, Refused

filtered = pytest.mark.skipif(sanitized(), reason="sanitizers ask the system for more")
EPERM, ENOSYS = 1, 38
DIED, HUNG = 'oval4d_reading_losses_total{cause="died"}', 'oval4d_reading_losses_total{cause="hung"}'


def simplex():
    return "\n".join(" ".join(str(int(i == j)) for j in range(4)) for i in range(4)) + "\n-1 -1 -1 -1\n"


def moment_curve(count):
    """Returns points whose convex hull has count · (count − 3) / 2 cells, as text."""
    angles = [2 * math.pi * i / count for i in range(count)]
    return "".join(f"{math.cos(t)} {math.sin(t)} {math.cos(2 * t)} {math.sin(2 * t)}\n" for t in angles)


async def load(client, data=None, format_="points"):
    return await client.request("load", name="mine", format=format_, data=data or simplex())


async def refusal(client, data, format_="points"):
    with pytest.raises(Refused) as caught:
        await load(client, data, format_)
    return caught.value


async def cells(client):
    return (await client.request("get", what="state"))["polytope"]["cells"]


def readers(server):
    return [pid for pid, word in children(server).items() if word == "read"]


def waiting_reader(server):
    """Waits until only one reading process is left, which waits for a file; returns its process ID."""
    found, since = [], time.monotonic()

    def stays():
        nonlocal found, since
        if readers(server) != found:
            found, since = readers(server), time.monotonic()
        return len(found) == 1 and time.monotonic() - since > 0.2 * SLOW

    until(stays, "a process that waits for a file")
    return found[0]


@contextlib.asynccontextmanager
async def with_both(*options, **variables):
    """Yields a server that has drawn a picture and read a file, and its child processes with their subcommands."""
    with Server(*options, **variables) as server:
        async with Client(server, stream="none") as client:
            await client.frame(width=320, height=200)
            await load(client)
            waiting_reader(server)
            await asyncio.sleep(0.3 * SLOW)  # until the waiting reader has set up its sandbox
            found = children(server)
            assert set(found.values()) == {"draw", "read"}
            yield server, found


@filtered
async def test_all_are_confined():
    async with with_both() as (server, found):
        assert status(server.process.pid, "NoNewPrivs") == 1
        for pid in found:
            for thread in os.listdir(f"/proc/{pid}/task"):
                assert status(pid, "Seccomp", thread) == 2 and status(pid, "NoNewPrivs", thread) == 1


@filtered
async def test_their_memory_and_files_are_limited():
    async with with_both("--load-memory", "100M", "--draw-memory", "2G") as (_, found):
        for pid, word in found.items():
            assert limit(pid, "Max core file size") == 0
            assert limit(pid, "Max open files") < 32
            begun = 1024 * status(pid, "VmSize")
            assert limit(pid, "Max address space") < begun + {"read": 100 << 20, "draw": 2 << 30}[word] + (1 << 20)


async def test_they_hold_nothing_of_the_sessions(tmp_path):
    async with with_both(OVAL4D_STORE=f"sqlite:{tmp_path}/sessions.sqlite") as (server, found):
        assert any("sessions.sqlite" in file for file in server.files())
        for pid, word in found.items():
            files = {int(file.name): os.readlink(file) for file in Path(f"/proc/{pid}/fd").iterdir()}
            assert files.pop(0) == files.pop(1) == "/dev/null"
            files.pop(2)  # the server's log
            assert files.pop(3).startswith("socket:")
            assert all("memfd:oval4d-picture" in file for file in files.values()), files
            assert word == "draw" or not files
            assert b"sessions.sqlite" not in Path(f"/proc/{pid}/environ").read_bytes()


@filtered
@pytest.mark.skipif(os.geteuid() != 0, reason="only root may read a filter")
async def test_the_filters_refuse_all_but_work():
    async with with_both() as (server, found):
        for pid, word in found.items():
            made = Filter(pid)
            for name in ["execve", "execveat", "socket", "connect", "bind", "ptrace", "process_vm_readv", "bpf", "fork",
                         "process_vm_writev", "io_uring_setup", "userfaultfd", "unshare", "mount", "pidfd_getfd"]:
                assert made(name)[0] == KILL, (word, name)
            assert made("read", arch=0x40000003)[0] == KILL  # as a 32-bit (i386) system call
            for name in ["open", "openat", "openat2", "creat", "unlink", "unlinkat", "rename", "mkdir", "chmod", "link",
                         "symlink", "ftruncate", "truncate", "ioctl", "dup", "dup2", "memfd_create", "pipe2", "getdents64",
                         "setrlimit", "sendto", "recvfrom", "shmget", "msgget", "inotify_init1", "fanotify_init",
                         "chdir", "setxattr", "epoll_create1", "eventfd2", "pwrite64", "sendfile", "splice",
                         "perf_event_open", "seccomp", "personality", "syslog", "reboot", "clock_settime"]:
                assert made(name) == (ERRNO, EPERM), (word, name)
            for name in ["futex", "munmap", "brk", "exit_group", "rt_sigreturn", "poll", "clock_gettime"]:
                assert made(name)[0] == ALLOW, (word, name)
            assert made("sendmsg", 3)[0] == made("recvmsg", 3)[0] == made("write", 2)[0] == ALLOW
            assert all(made("sendmsg", file)[0] == ERRNO for file in (0, 2, 4, 100))
            assert all(made("write", file)[0] == ERRNO for file in (0, 1, 3, 4))
            assert made("tgkill", pid)[0] == ALLOW
            assert made("kill", server.process.pid)[0] == made("tgkill", server.process.pid)[0] == ERRNO
            assert made("prlimit64", 0, 7, 0)[0] == ALLOW and made("prlimit64", 0, 7, 4096)[0] == ERRNO
            thread = 0x3D0F00
            assert made("clone", 17)[0] == ERRNO and made("clone3") == (ERRNO, ENOSYS)
            assert made("clone", thread)[0] == (ALLOW if word == "draw" else ERRNO)
            assert made("mmap", 0, 4096, 3)[0] == made("mprotect", 4096, 4096, 1)[0] == ALLOW
            assert made("mmap", 0, 4096, 5)[0] == made("mprotect", 0, 4096, 7)[0] == (ALLOW if word == "draw" else ERRNO)


async def test_where_filters_cannot_be_set_the_server_warns_and_goes_on():
    class Forbidden(Server):
        def start(self, words, environment):
            return subprocess.Popen(words, env=environment, stderr=self.log_file, preexec_fn=sandboxes.forbid_filters)

    with Forbidden() as server:
        assert "not in a sandbox" in server.log()
        async with Client(server, stream="none") as client:
            await client.frame(width=320, height=200)
            await load(client)
            assert await cells(client) == 5
    refused = subprocess.run([PROGRAM, "--port", "0", "--sandbox", "required"], preexec_fn=sandboxes.forbid_filters,
                             capture_output=True, timeout=DEADLINE, check=False)
    assert refused.returncode == 1 and b"the sandbox is required, but not available" in refused.stderr


@filtered
async def test_it_can_be_turned_off():
    async with with_both("--sandbox", "off") as (server, found):
        assert all(status(pid, "Seccomp_filters") == status(os.getpid(), "Seccomp_filters") for pid in found)
        assert "sandbox" not in server.log()
    async with with_both(OVAL4D_SANDBOX="required") as (_, found):
        assert all(status(pid, "Seccomp") == 2 for pid in found)


async def test_what_takes_long_to_read_is_refused_and_nobody_waits_for_it():
    with Server("--load-timeout", SLOW, "--max-hull-cells", 10**9, "--load-workers", 1) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            await load(client)
            before = server.own_memory()
            started = time.monotonic()
            loading = asyncio.ensure_future(refusal(client, moment_curve(8000)))
            while not loading.done():
                await other.request("key", key="r")
                await other.frame(width=160, height=100)
                await asyncio.sleep(0.05)
            error = await loading
            assert error.code == "too_large" and f"longer than {SLOW:g} s" in error.text
            assert time.monotonic() - started < SLOW + DEADLINE / 2
            assert await cells(client) == 5
            await load(client)
            assert server.own_memory() < before + (64 << 20)
            assert server.metric(HUNG) == 1 and server.metric(DIED) == 0


async def test_a_server_that_is_to_stop_waits_for_no_file():
    server = Server("--max-hull-cells", 10**9, "--stop-timeout", 0.5)
    try:
        async with Client(server, stream="none") as client:
            await load(client)
            await client.send("load", name="mine", format="points", data=moment_curve(8000))
            until(lambda: readers(server), "a process that reads")
            await asyncio.sleep(0.3 * SLOW)
            reading = readers(server)
            status_, seconds = await asyncio.get_running_loop().run_in_executor(None, server.stop)
        assert status_ == 0 and seconds < 0.5 + 2 * SLOW and all(map(has_ended, reading))
    finally:
        server.kill()


@filtered
async def test_what_takes_much_memory_to_read_is_refused_and_the_server_stays_small():
    faces = 900_000  # eight bytes each in the file, many times as much in memory
    text = f"4OFF\n5 {faces} 0 1\n{simplex()}" + "3 0 1 2\n" * faces + "4 0 1 2 3\n"
    with Server("--load-memory", "64M") as server:
        async with Client(server, stream="none") as client:
            await load(client)
            before = server.own_memory()
            for _ in range(3):
                error = await refusal(client, text, "off")
                assert error.code == "too_large" and "memory" in error.text
            assert await cells(client) == 5
            until(lambda: server.own_memory() < before + 3 * len(text), "the memory that it had before, and a message's")
            assert server.metric(HUNG) == server.metric(DIED) == 0
            await load(client, moment_curve(60))
            assert await cells(client) == 60 * 57 // 2


async def test_readers_that_are_killed_as_they_wait_are_replaced():
    server = Server()
    try:
        async with Client(server, stream="none") as client:
            await load(client)
            for _ in range(3):
                os.kill(waiting_reader(server), signal.SIGKILL)
                await load(client, moment_curve(10))
                assert await cells(client) == 35
            assert server.metric(DIED) == 3
    finally:
        server.kill()


async def test_one_that_is_killed_at_a_file_is_replaced_and_two_are_a_fault_of_the_server():
    server = Server("--max-hull-cells", 10**9)
    try:
        async with Client(server, stream="none") as client:
            await load(client)
            waiting_reader(server)
            loading = asyncio.ensure_future(load(client, moment_curve(300)))
            await asyncio.sleep(0.1)
            for pid in readers(server):
                os.kill(pid, signal.SIGKILL)
            await loading
            assert await cells(client) == 300 * 297 // 2
            loading = asyncio.ensure_future(refusal(client, moment_curve(301)))
            while not loading.done():
                for pid in readers(server):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(pid, signal.SIGKILL)
                await asyncio.sleep(0.01)
            assert (await loading).code == "internal"
            assert "two processes were lost in a row, the second died: signal 9" in server.log()
            assert await cells(client) == 300 * 297 // 2
            await load(client)
            assert await cells(client) == 5
        assert server.stop()[0] == 0
    finally:
        server.kill()


async def test_nothing_is_lost_whatever_befalls_readers():
    chance = random.Random(7)
    server = Server("--load-timeout", max(2, round(SLOW)))
    try:
        async with Client(server, stream="none") as client:
            shown = None
            for count in [20, 100, 30, 150, 40, 120, 25, 200]:
                loading = asyncio.ensure_future(load(client, moment_curve(count)))
                await asyncio.sleep(chance.uniform(0, 0.06))
                for pid in readers(server):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(pid, chance.choice([signal.SIGKILL, signal.SIGSTOP]))
                try:
                    await loading
                    shown = count * (count - 3) // 2
                except Refused as error:
                    assert error.code in ("internal", "too_large")
                assert shown is None or await cells(client) == shown
            # The server detects waiting readers that were stopped only when it uses them, one by one.
            while True:
                with contextlib.suppress(Refused):
                    await load(client)
                    break
            assert await cells(client) == 5
        assert server.stop()[0] == 0 and not children(server)
    finally:
        server.kill()


async def test_so_many_read_at_once_and_none_when_there_is_nothing_to_read():
    with Server("--load-workers", 2) as server:
        assert not readers(server)
        async with contextlib.AsyncExitStack() as stack:
            clients = [await stack.enter_async_context(Client(server, stream="none")) for _ in range(8)]
            loading = asyncio.ensure_future(asyncio.gather(*(load(each, moment_curve(250)) for each in clients)))
            most = 0
            while not loading.done():
                most = max(most, len(readers(server)))
                await asyncio.sleep(0.01)
            await loading
            assert 1 <= most <= 4, most  # two are reading, and two wait
            for _ in range(20):
                await asyncio.gather(*(load(each) for each in clients))
            await asyncio.sleep(SLOW)
            assert len(readers(server)) <= 2, "no more wait than can read at once"
            until(lambda: not readers(server), "the end of those that wait for nothing")
