#pragma once
// SandboxMode of the child processes: resource limits and a seccomp filter of system calls.

#include <cstddef>
#include <cstdint>
#include <string>

namespace oval4d::process {

/// Sets no_new_privs: neither this process nor its descendants can gain privileges by executing a program
/// (set-user-ID), ever. Must be called before threads are started. Returns false if the system does not support it.
bool forbidNewPrivileges();

enum class SandboxMode : std::uint8_t {
    automatic,  ///< if the system supports it
    off,
    required,
};

/// Whether child processes are to be confined by a filter of system calls. Tries to set such a filter; if that fails,
/// sets `why` to the reason, and throws std::runtime_error if the sandbox is required. Builds with a sanitizer have no
/// sandbox, because sanitizers need more system calls.
bool isSandboxed(SandboxMode wanted, std::string& why);

/// The task of a child process, which decides what its filter allows. Every child may allocate memory, read the clock,
/// wait, write to its log, use its channel (kChildSocket), and exit. It may not open, create, find or change files, use
/// the network, start programs, or access other processes.
enum class Role : std::uint8_t {
    draw,  ///< may also start threads, and execute code that it has compiled
    read,  ///< nothing else
};

struct Confinement {
    bool filtered = false;  ///< only the system calls that the role needs are allowed
    /// Bytes of address space beyond those already in use; 0: no limit. Ignored in builds with a sanitizer.
    std::size_t memory = 0;
    std::size_t files = 0;  ///< open files, including those open already; 0: no limit
};

/// Confines this process and all its threads irrevocably. A forbidden system call fails with EPERM; one that only an
/// intruder would make (to start a program, open a socket or access another process) kills the process. Also disables
/// core dumps, which would contain clients' data. Throws std::runtime_error.
void confine(Role role, const Confinement& confinement);

}  // namespace oval4d::process
