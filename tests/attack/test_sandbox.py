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
from harness import (DEADLINE, PROGRAM, Server, cpu_seconds, has_ended, is_sanitizer_build, process_state, wait_until)
from sandboxes import ALLOW, ERRNO, KILL, SeccompFilter, child_processes, soft_limit, status_value
from wire import Client, Refused

needs_sandbox = pytest.mark.skipif(is_sanitizer_build(), reason="sanitizer builds have no sandbox")
EPERM, ENOSYS = 1, 38
DIED, HUNG = 'oval4d_reading_losses_total{cause="died"}', 'oval4d_reading_losses_total{cause="hung"}'


def simplex_points():
    return "\n".join(" ".join(str(int(i == j)) for j in range(4)) for i in range(4)) + "\n-1 -1 -1 -1\n"


def moment_curve_points(count):
    """Returns points whose convex hull has count · (count − 3) / 2 cells, as text."""
    angles = [2 * math.pi * i / count for i in range(count)]
    return "".join(f"{math.cos(t)} {math.sin(t)} {math.cos(2 * t)} {math.sin(2 * t)}\n" for t in angles)


async def load_points(client, data=None, format_="points"):
    return await client.request("load", name="mine", format=format_, data=data or simplex_points())


async def load_refusal(client, data, format_="points"):
    with pytest.raises(Refused) as caught:
        await load_points(client, data, format_)
    return caught.value


async def cell_count(client):
    return (await client.request("get", what="state"))["polytope"]["cells"]


def reading_processes(server):
    return [pid for pid, subcommand in child_processes(server).items() if subcommand == "read"]


def kill_reading_processes(server):
    kill(reading_processes(server))


def kill(pids):
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def is_computing(pid):
    """Returns whether a process has used more CPU time than it needs until it waits for a file."""
    try:
        return cpu_seconds(pid) > 0.2
    except (FileNotFoundError, ProcessLookupError):
        return False


@contextlib.contextmanager
def suspended(server):
    """Suspends the server, so that it neither ends its child processes nor starts further ones."""
    os.kill(server.process.pid, signal.SIGSTOP)
    try:
        wait_until(lambda: process_state(server.process.pid) == "T", "the server to be suspended")
        yield
    finally:
        os.kill(server.process.pid, signal.SIGCONT)


def waits_for_the_server(pid):
    """Returns whether a child process of a suspended server sleeps, with its socket open. A process that the server has
    told to end does not: it runs until it has ended."""
    try:
        return process_state(pid) == "S" and os.readlink(f"/proc/{pid}/fd/3").startswith("socket:")
    except (FileNotFoundError, ProcessLookupError):
        return False


@contextlib.asynccontextmanager
async def server_with_child_processes(*options, **variables):
    """Yields a suspended server that has drawn a picture and read a file, and its child processes with their
    subcommands. A process that has read a file is replaced; either it or its successor is among them."""
    is_sandboxed = "off" not in options and not is_sanitizer_build()
    with Server(*options, **variables) as server:
        async with Client(server, stream="none") as client:
            await client.request_frame(width=320, height=200)
            end = time.monotonic() + DEADLINE
            while True:
                await load_points(client)
                with suspended(server):
                    found = child_processes(server)
                    ready = set(found.values()) == {"draw", "read"} and all(map(waits_for_the_server, found))
                    if ready and is_sandboxed:
                        ready = all(status_value(pid, "Seccomp") == 2 for pid in found)
                    if ready:
                        yield server, found
                        break
                assert time.monotonic() < end, f"the server has other child processes, or some are not ready: {found}"


@needs_sandbox
async def test_every_thread_of_the_child_processes_is_sandboxed():
    async with server_with_child_processes() as (server, found):
        assert status_value(server.process.pid, "NoNewPrivs") == 1
        for pid in found:
            for thread in os.listdir(f"/proc/{pid}/task"):
                assert status_value(pid, "Seccomp", thread) == 2 and status_value(pid, "NoNewPrivs", thread) == 1


@needs_sandbox
async def test_child_processes_have_resource_limits():
    async with server_with_child_processes("--load-memory", "100M", "--draw-memory", "2G") as (_, found):
        for pid, subcommand in found.items():
            assert soft_limit(pid, "Max core file size") == 0
            assert soft_limit(pid, "Max open files") < 32
            size = 1024 * status_value(pid, "VmData")  # private memory; a mapped file may exceed the limit
            assert soft_limit(pid, "Max data size") < size + {"read": 100 << 20, "draw": 2 << 30}[subcommand] + (1 << 20)


async def test_child_processes_cannot_access_the_sessions(tmp_path):
    async with server_with_child_processes(OVAL4D_STORE=f"sqlite:{tmp_path}/sessions.sqlite") as (server, found):
        assert any("sessions.sqlite" in file for file in server.open_files())
        for pid, subcommand in found.items():
            files = {int(file.name): os.readlink(file) for file in Path(f"/proc/{pid}/fd").iterdir()}
            assert files.pop(0) == files.pop(1) == "/dev/null"
            files.pop(2)  # the log of the server
            assert files.pop(3).startswith("socket:")
            assert all("memfd:oval4d-picture" in file for file in files.values()), files
            assert subcommand == "draw" or not files
            assert b"sessions.sqlite" not in Path(f"/proc/{pid}/environ").read_bytes()


@needs_sandbox
@pytest.mark.skipif(os.geteuid() != 0, reason="only root may read a filter")
async def test_seccomp_filters_allow_only_the_needed_system_calls():
    async with server_with_child_processes() as (server, found):
        for pid, subcommand in found.items():
            evaluate = SeccompFilter(pid).evaluate
            for name in ["execve", "execveat", "socket", "connect", "bind", "ptrace", "process_vm_readv", "bpf", "fork",
                         "process_vm_writev", "io_uring_setup", "userfaultfd", "unshare", "mount", "pidfd_getfd"]:
                assert evaluate(name)[0] == KILL, (subcommand, name)
            assert evaluate("read", arch=0x40000003)[0] == KILL  # a 32-bit (i386) system call
            for name in ["open", "openat", "openat2", "creat", "unlink", "unlinkat", "rename", "mkdir", "chmod", "link",
                         "symlink", "ftruncate", "truncate", "ioctl", "dup", "dup2", "memfd_create", "pipe2", "getdents64",
                         "setrlimit", "sendto", "recvfrom", "shmget", "msgget", "inotify_init1", "fanotify_init",
                         "chdir", "setxattr", "epoll_create1", "eventfd2", "pwrite64", "sendfile", "splice",
                         "perf_event_open", "seccomp", "personality", "syslog", "reboot", "clock_settime"]:
                assert evaluate(name) == (ERRNO, EPERM), (subcommand, name)
            for name in ["futex", "munmap", "brk", "exit_group", "rt_sigreturn", "poll", "clock_gettime"]:
                assert evaluate(name)[0] == ALLOW, (subcommand, name)
            assert evaluate("sendmsg", 3)[0] == evaluate("recvmsg", 3)[0] == evaluate("write", 2)[0] == ALLOW
            assert all(evaluate("sendmsg", file)[0] == ERRNO for file in (0, 2, 4, 100))
            assert all(evaluate("write", file)[0] == ERRNO for file in (0, 1, 3, 4))
            assert evaluate("tgkill", pid)[0] == ALLOW
            assert evaluate("kill", server.process.pid)[0] == evaluate("tgkill", server.process.pid)[0] == ERRNO
            assert evaluate("prlimit64", 0, 7, 0)[0] == ALLOW and evaluate("prlimit64", 0, 7, 4096)[0] == ERRNO
            thread = 0x3D0F00
            assert evaluate("clone", 17)[0] == ERRNO and evaluate("clone3") == (ERRNO, ENOSYS)
            assert evaluate("clone", thread)[0] == (ALLOW if subcommand == "draw" else ERRNO)
            assert evaluate("mmap", 0, 4096, 3)[0] == evaluate("mprotect", 4096, 4096, 1)[0] == ALLOW
            executable = ALLOW if subcommand == "draw" else ERRNO
            assert evaluate("mmap", 0, 4096, 5)[0] == evaluate("mprotect", 0, 4096, 7)[0] == executable


async def test_the_server_warns_and_works_where_seccomp_is_unavailable():
    class ServerWithoutSeccomp(Server):
        def start(self, command, environment):
            return subprocess.Popen(command, env=environment, stderr=self.log_file, preexec_fn=sandboxes.forbid_seccomp_filters)

    with ServerWithoutSeccomp() as server:
        assert "not in a sandbox" in server.log()
        async with Client(server, stream="none") as client:
            await client.request_frame(width=320, height=200)
            await load_points(client)
            assert await cell_count(client) == 5
    refused = subprocess.run([PROGRAM, "--port", "0", "--sandbox", "required"], preexec_fn=sandboxes.forbid_seccomp_filters,
                             capture_output=True, timeout=DEADLINE, check=False)
    assert refused.returncode == 1 and b"the sandbox is required, but not available" in refused.stderr


@needs_sandbox
async def test_the_sandbox_can_be_turned_off():
    async with server_with_child_processes("--sandbox", "off") as (server, found):
        assert all(status_value(pid, "Seccomp_filters") == status_value(os.getpid(), "Seccomp_filters") for pid in found)
        assert "sandbox" not in server.log()
    async with server_with_child_processes(OVAL4D_SANDBOX="required") as (_, found):
        assert all(status_value(pid, "Seccomp") == 2 for pid in found)


async def load_until_accepted(client):
    """Loads points; repeats it as long as the server refuses them, which a short time limit may cause."""
    end = time.monotonic() + DEADLINE
    while True:
        try:
            return await load_points(client)
        except Refused:
            assert time.monotonic() < end, "no file is accepted any more"


async def test_a_file_that_takes_too_long_is_refused_and_delays_no_other_client():
    with Server("--load-timeout", 1, "--max-hull-cells", 10**9, "--load-workers", 1) as server:
        async with Client(server, stream="none") as client, Client(server, stream="none") as other:
            await load_until_accepted(client)
            before, hung_before = server.anonymous_memory(), server.metric(HUNG)
            loading = asyncio.ensure_future(load_refusal(client, moment_curve_points(8000)))
            while not loading.done():
                await other.request("key", key="r")
                await other.request_frame(width=160, height=100)
                await asyncio.sleep(0.05)
            error = await loading
            assert error.code == "too_large" and "longer than 1 s" in error.text
            assert server.metric(HUNG) == hung_before + 1 and server.metric(DIED) == 0
            assert await cell_count(client) == 5
            await load_until_accepted(client)
            wait_until(lambda: server.anonymous_memory() < before + (64 << 20), "the server to free its memory")


async def test_a_server_stop_ends_the_processes_that_read():
    server = Server("--max-hull-cells", 10**9, "--stop-timeout", 0.1)
    try:
        async with Client(server, stream="none") as client:
            await client.send("load", name="mine", format="points", data=moment_curve_points(8000))
            wait_until(lambda: any(map(is_computing, reading_processes(server))), "a process that reads")
            reading = reading_processes(server)
            status_, _ = await asyncio.get_running_loop().run_in_executor(None, server.stop)
        assert status_ == 0
        wait_until(lambda: all(map(has_ended, reading)), "the end of the processes")
    finally:
        server.kill()


@needs_sandbox
async def test_a_file_that_needs_too_much_memory_is_refused():
    faces = 900_000  # eight bytes each in the file, much more in memory
    text = f"4OFF\n5 {faces} 0 1\n{simplex_points()}" + "3 0 1 2\n" * faces + "4 0 1 2 3\n"
    with Server("--load-memory", "64M") as server:
        async with Client(server, stream="none") as client:
            await load_points(client)
            before = server.anonymous_memory()
            for _ in range(3):
                error = await load_refusal(client, text, "off")
                assert error.code == "too_large" and "memory" in error.text
            assert await cell_count(client) == 5
            wait_until(lambda: server.anonymous_memory() < before + 3 * len(text), "the server to free its memory")
            assert server.metric(HUNG) == server.metric(DIED) == 0
            await load_points(client, moment_curve_points(60))
            assert await cell_count(client) == 60 * 57 // 2


async def test_killed_idle_reading_processes_are_replaced():
    server = Server()
    try:
        async with Client(server, stream="none") as client:
            await load_points(client)
            end = time.monotonic() + DEADLINE
            while server.metric(DIED) < 3:  # the server may have been about to replace a process
                assert time.monotonic() < end, "no loss is noticed"
                kill_reading_processes(server)
                await load_points(client, moment_curve_points(10))
                assert await cell_count(client) == 35
    finally:
        server.kill()


async def test_a_load_survives_one_killed_reading_process_and_fails_after_two():
    server = Server("--max-hull-cells", 10**9, "--load-memory", "16G")
    try:
        async with Client(server, stream="none") as client:
            while server.metric(DIED) == 0:  # until a process was killed while it read
                loading = asyncio.ensure_future(load_points(client, moment_curve_points(300)))
                while not loading.done() and not any(map(is_computing, reading_processes(server))):
                    await asyncio.sleep(0.01)
                # Kills only one process, because the server may pass the file on to another process at once.
                kill(list(filter(is_computing, reading_processes(server)))[:1])
                await loading
                assert await cell_count(client) == 300 * 297 // 2
            # Reading this file takes longer than killing two processes, even if the test itself is slow.
            loading = asyncio.ensure_future(load_refusal(client, moment_curve_points(8000)))
            while not loading.done():
                kill_reading_processes(server)
                await asyncio.sleep(0.01)
            assert (await loading).code == "internal"
            assert "two processes were lost in a row, the second died: signal 9" in server.log()
            assert await cell_count(client) == 300 * 297 // 2
            await load_points(client)
            assert await cell_count(client) == 5
        assert server.stop()[0] == 0
    finally:
        server.kill()


async def test_sessions_survive_randomly_killed_and_suspended_reading_processes():
    rng = random.Random(7)
    server = Server("--load-timeout", 1)
    try:
        async with Client(server, stream="none") as client:
            shown = None
            for count in [20, 100, 30, 150, 40, 120, 25, 200]:
                loading = asyncio.ensure_future(load_points(client, moment_curve_points(count)))
                await asyncio.sleep(rng.uniform(0, 0.06))
                for pid in reading_processes(server):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(pid, rng.choice([signal.SIGKILL, signal.SIGSTOP]))
                try:
                    await loading
                    shown = count * (count - 3) // 2
                except Refused as error:
                    assert error.code in ("internal", "too_large")
                assert shown is None or await cell_count(client) == shown
            # The server notices that idle reader processes are suspended only when it uses them, one after another.
            await load_until_accepted(client)
            assert await cell_count(client) == 5
        assert server.stop()[0] == 0 and not child_processes(server)
    finally:
        server.kill()


async def test_the_number_of_reading_processes_is_limited_and_returns_to_zero():
    with Server("--load-workers", 2) as server:
        assert not reading_processes(server)
        async with contextlib.AsyncExitStack() as stack:
            clients = [await stack.enter_async_context(Client(server, stream="none")) for _ in range(8)]
            loading = asyncio.ensure_future(asyncio.gather(*(load_points(each, moment_curve_points(250)) for each in clients)))
            most = 0
            while not loading.done():
                most = max(most, len(reading_processes(server)))
                await asyncio.sleep(0.01)
            await loading
            assert most <= 4, most  # two processes read, and two wait
            for _ in range(3):  # several times, since idle processes may have ended meanwhile
                for _ in range(20):
                    await asyncio.gather(*(load_points(each) for each in clients))
                wait_until(lambda: len(reading_processes(server)) <= 2, "the end of those that are too many")
                if reading_processes(server):
                    break
            wait_until(lambda: not reading_processes(server), "the end of the idle processes")
