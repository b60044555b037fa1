#pragma once
// The sandbox of child processes: limits on resources, and a seccomp filter of system calls.

#include <cstddef>
#include <cstdint>
#include <string>

namespace oval4d::process {

/// Sets the flag no_new_privs of this process: from now on, neither this process nor its descendants gain privileges by
/// executing a set-user-ID program. Must be called before threads are started. Returns false if the system does not
/// support the flag.
bool forbidNewPrivileges();

/// The option that says whether the server's child processes are sandboxed.
enum class SandboxMode : std::uint8_t {
    automatic,  ///< sandboxed if the system supports a sandbox
    off,        ///< never sandboxed
    required,   ///< sandboxed; the server does not start on a system that does not support a sandbox
};

/// Returns whether child processes are to have a filter of system calls. Returns false if `wanted` is `off`. Otherwise,
/// tries to set a filter for a temporary thread, and returns whether this succeeds. If it fails, sets `why` to the
/// reason and, if `wanted` is `required`, throws std::runtime_error. Builds with a sanitizer have no sandbox, because
/// sanitizers need more system calls.
bool shouldSandbox(SandboxMode wanted, std::string& why);

/// The task of a child process, which determines the allowed system calls. Every child may allocate memory, read the
/// clock, wait, write to standard error (the log), use its channel (kChildSocket), and exit. No child may open, create,
/// list or change files, use the network, start programs, or access other processes.
enum class SandboxRole : std::uint8_t {
    draw,        ///< draws pictures; may also start threads and execute code that it generates at run time
    parse_file,  ///< parses files that come over its channel; may do nothing more
};

/// The restrictions that a child process applies to itself.
struct Confinement {
    bool filtered = false;  ///< whether to allow only the system calls that the task needs
    /// The maximum private memory, in bytes, that the process may allocate in addition to its present memory; 0 for no
    /// limit. Memory counts when it is allocated, even if it is never written. Mapped files do not count. Ignored in
    /// builds with a sanitizer.
    std::size_t memory = 0;
    /// The maximum number of open file descriptors, including those already open; 0 for no limit. Ignored in builds
    /// with a sanitizer.
    std::size_t files = 0;
};

/// Restricts this process and all its threads for the rest of their lives. A forbidden system call fails with an error,
/// usually EPERM. A call that only an intruder would make (to start a program, open a socket or access another process)
/// kills the process. Also disables core dumps, which would contain data of clients. Throws std::runtime_error if the
/// filter cannot be set.
void confine(SandboxRole role, const Confinement& confinement);

}  // namespace oval4d::process
