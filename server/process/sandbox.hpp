#pragma once
// The sandbox of the child processes: resource limits and a seccomp filter of system calls.

#include <cstddef>
#include <cstdint>
#include <string>

namespace oval4d::process {

/// Sets no_new_privs: from now on, neither this process nor its descendants can gain privileges by executing a
/// set-user-ID program. Must be called before threads are started. Returns false if the system does not support it.
bool forbidNewPrivileges();

/// The option that determines whether the server's child processes are sandboxed.
enum class SandboxMode : std::uint8_t {
    automatic,  ///< sandboxed if the system supports it
    off,        ///< never sandboxed
    required,   ///< sandboxed; the server does not start if the system does not support it
};

/// Returns whether child processes are to be confined by a filter of system calls. If `wanted` is `off`, returns false.
/// Otherwise, tries to set such a filter for a temporary thread, and returns whether this succeeds. If it fails, sets
/// `why` to the reason and, if `wanted` is `required`, throws std::runtime_error. Builds with a sanitizer have no
/// sandbox, because sanitizers need more system calls.
bool shouldSandbox(SandboxMode wanted, std::string& why);

/// The task of a child process, which determines the system calls that its filter allows. Every child may allocate
/// memory, read the clock, wait, write to standard error (the log), use its channel (kChildSocket), and exit. No child
/// may open, create, list or change files, use the network, start programs, or access other processes.
enum class SandboxRole : std::uint8_t {
    draw,        ///< draws pictures; may also start threads, and execute code that it compiles at run time
    parse_file,  ///< parses files that it receives over its channel; may do nothing more
};

/// The restrictions that a child process applies to itself.
struct Confinement {
    bool filtered = false;  ///< whether to allow only the system calls that the role needs
    /// The maximum number of bytes of private memory that the process may allocate in addition to what it already uses,
    /// whether it writes to the memory or not; 0 means no limit. Mapped files do not count. Ignored in builds with a
    /// sanitizer.
    std::size_t memory = 0;
    /// The maximum number of open file descriptors, including those already open; 0 means no limit. Ignored in builds
    /// with a sanitizer.
    std::size_t files = 0;
};

/// Confines this process and all its threads irrevocably. A forbidden system call fails with an error, usually EPERM; a
/// call that only an intruder would make (to start a program, open a socket or access another process) kills the
/// process. Also disables core dumps, which would contain clients' data. Throws std::runtime_error if the filter cannot
/// be set.
void confine(SandboxRole role, const Confinement& confinement);

}  // namespace oval4d::process
