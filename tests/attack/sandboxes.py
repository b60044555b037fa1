"""Inspects sandboxed processes: reads their status and limits, and reads and interprets their seccomp filters."""

import ctypes
import os
import re
import struct
from pathlib import Path

PTRACE_DETACH, PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_SECCOMP_GET_FILTER = 17, 0x4206, 0x4207, 0x420C
WALL = 0x40000000
KILL, ERRNO, ALLOW = 0x80000000, 0x00050000, 0x7FFF0000

libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.restype = ctypes.c_long
libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
seccomp = ctypes.CDLL("libseccomp.so.2")
seccomp.seccomp_init.restype = ctypes.c_void_p
seccomp.seccomp_arch_native.restype = ctypes.c_uint32


class ArgumentComparison(ctypes.Structure):
    _fields_ = [("number", ctypes.c_uint), ("compare", ctypes.c_int), ("a", ctypes.c_uint64), ("b", ctypes.c_uint64)]


def syscall_number(name):
    return seccomp.seccomp_syscall_resolve_name(name.encode())


def child_processes(server):
    """Returns the server's live child processes: process ID to subcommand ("draw" or "read")."""
    found = {}
    for file in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = file.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
            words = file.with_name("cmdline").read_bytes().split(b"\0")
            if int(fields[1]) == server.process.pid and fields[0] != "Z" and words[0] == b"oval4d":
                found[int(file.parent.name)] = words[1].decode()
        except (OSError, IndexError):
            continue  # the process has ended meanwhile, or has not called exec yet
    return found


def status_value(pid, name, thread=None):
    """Returns a number of /proc/PID/status."""
    place = f"/proc/{pid}/task/{thread}/status" if thread else f"/proc/{pid}/status"
    found = re.search(rf"^{name}:\s+(\d+)", Path(place).read_text(encoding="ascii"), re.M)
    return int(found.group(1))


def soft_limit(pid, name):
    """Returns a soft resource limit, None if it is unlimited."""
    line = next(line for line in Path(f"/proc/{pid}/limits").read_text().splitlines() if line.startswith(name))
    value = line[len(name):].split()[0]
    return None if value == "unlimited" else int(value)


class SeccompFilter:
    """The seccomp filter that a process has installed last, read with ptrace."""

    def __init__(self, pid):
        self.pid = pid
        self.check_result(libc.ptrace(PTRACE_SEIZE, pid, None, None))
        try:
            self.check_result(libc.ptrace(PTRACE_INTERRUPT, pid, None, None))
            os.waitpid(pid, WALL)
            size = self.check_result(libc.ptrace(PTRACE_SECCOMP_GET_FILTER, pid, 0, None))
            buffer = ctypes.create_string_buffer(8 * size)
            self.check_result(libc.ptrace(PTRACE_SECCOMP_GET_FILTER, pid, 0, ctypes.cast(buffer, ctypes.c_void_p)))
        finally:
            libc.ptrace(PTRACE_DETACH, pid, None, None)
        self.instructions = list(struct.iter_unpack("=HBBI", buffer.raw))

    @staticmethod
    def check_result(result):
        if result < 0:
            raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
        return result

    def evaluate(self, name, *arguments, arch=None):
        """Returns what the filter does with this system call: (KILL, ERRNO or ALLOW, error number)."""
        arguments = [x & 0xFFFFFFFFFFFFFFFF for x in arguments] + [0] * (6 - len(arguments))
        data = struct.pack("=iIQ6Q", syscall_number(name), arch or seccomp.seccomp_arch_native(), 0, *arguments)
        position, accumulator, memory = 0, 0, {}
        while True:
            opcode, if_true, if_false, k = self.instructions[position]
            position += 1
            if opcode == 0x20:  # the BPF instruction ld [k]
                accumulator = struct.unpack_from("=I", data, k)[0]
            elif opcode == 0x60:  # the BPF instruction ld M[k]
                accumulator = memory[k]
            elif opcode == 0x02:  # the BPF instruction st M[k]
                memory[k] = accumulator
            elif opcode == 0x54:  # the BPF instruction and
                accumulator &= k
            elif opcode == 0x05:  # the BPF instruction ja
                position += k
            elif opcode in (0x15, 0x25, 0x35, 0x45):
                holds = {0x15: accumulator == k, 0x25: accumulator > k, 0x35: accumulator >= k,
                         0x45: accumulator & k != 0}[opcode]
                position += if_true if holds else if_false
            elif opcode == 0x06:  # the BPF instruction ret
                return k & 0xFFFF0000, k & 0xFFFF
            else:
                raise AssertionError(f"unknown BPF instruction: {opcode:#x}")


def forbid_seccomp_filters():
    """Called in a child process before exec: forbids further filters, as some container profiles do."""
    libc.prctl(38, 1, 0, 0, 0)  # PR_SET_NO_NEW_PRIVS; without it, only root may install a filter
    context = ctypes.c_void_p(seccomp.seccomp_init(ALLOW))
    action = ctypes.c_uint32(ERRNO | 1)
    comparison = (ArgumentComparison * 1)(ArgumentComparison(0, 4, 22, 0))  # SCMP_CMP_EQ, PR_SET_SECCOMP
    assert seccomp.seccomp_rule_add_array(context, action, syscall_number("seccomp"), 0, None) == 0
    assert seccomp.seccomp_rule_add_array(context, action, syscall_number("prctl"), 1, comparison) == 0
    assert seccomp.seccomp_load(context) == 0
