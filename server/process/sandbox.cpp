#include "process/sandbox.hpp"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <span>
#include <stdexcept>
#include <thread>

#include "process/child_process.hpp"

namespace oval4d::process {

namespace {

void throwOnSeccompError(int error) {
    if (error < 0) throw std::runtime_error(std::string("cannot filter system calls: ") + std::strerror(-error));
}

// The system calls that the filter allows for all tasks, with any arguments. They affect only the process and its open
// files.
constexpr auto kCommonCalls = std::to_array<const char*>({"brk",
                                                          "clock_getres",
                                                          "clock_gettime",
                                                          "clock_nanosleep",
                                                          "close",
                                                          "exit",
                                                          "exit_group",
                                                          "fstat",
                                                          "futex",
                                                          "futex_time64",
                                                          "futex_waitv",
                                                          "getcpu",
                                                          "getegid",
                                                          "geteuid",
                                                          "getgid",
                                                          "getpid",
                                                          "getppid",
                                                          "getrandom",
                                                          "getrusage",
                                                          "gettid",
                                                          "gettimeofday",
                                                          "getuid",
                                                          "lseek",
                                                          "madvise",
                                                          "membarrier",
                                                          "munmap",
                                                          "nanosleep",
                                                          "newfstatat",
                                                          "poll",
                                                          "ppoll",
                                                          "read",
                                                          "restart_syscall",
                                                          "rseq",
                                                          "rt_sigaction",
                                                          "rt_sigprocmask",
                                                          "rt_sigreturn",
                                                          "rt_sigtimedwait",
                                                          "sched_getaffinity",
                                                          "sched_yield",
                                                          "set_robust_list",
                                                          "set_tid_address",
                                                          "sigaltstack",
                                                          "statx",
                                                          "sysinfo",
                                                          "time",
                                                          "times",
                                                          "uname"});

// The system calls that Mesa (the graphics library) makes in its threads. All except arch_prctl concern the processor
// affinity or the priority of a thread.
constexpr auto kThreadCalls = std::to_array<const char*>(
    {"arch_prctl", "getpriority", "sched_get_priority_max", "sched_get_priority_min", "sched_getparam",
     "sched_getscheduler", "sched_setaffinity", "sched_setscheduler", "setpriority"});

// The system calls for which the kernel kills the process. No library makes these calls, so they show that an attacker
// controls the process. All other forbidden calls fail with an error, because new versions of libraries may try new
// calls, and can handle errors.
constexpr auto kIntruderCalls = std::to_array<const char*>({"accept",
                                                            "accept4",
                                                            "bind",
                                                            "bpf",
                                                            "chroot",
                                                            "connect",
                                                            "execve",
                                                            "execveat",
                                                            "fork",
                                                            "init_module",
                                                            "finit_module",
                                                            "io_uring_setup",
                                                            "kcmp",
                                                            "kexec_load",
                                                            "keyctl",
                                                            "listen",
                                                            "mount",
                                                            "open_by_handle_at",
                                                            "pidfd_getfd",
                                                            "pidfd_open",
                                                            "pivot_root",
                                                            "process_vm_readv",
                                                            "process_vm_writev",
                                                            "ptrace",
                                                            "setns",
                                                            "socket",
                                                            "socketpair",
                                                            "unshare",
                                                            "userfaultfd",
                                                            "vfork"});

/// A seccomp filter. `otherwise` is the action for system calls without a rule. If `allThreads` is true, the filter
/// applies to all threads of the process, else only to the calling thread. Rules for calls that this architecture lacks
/// are skipped.
class SeccompFilter {
  public:
    SeccompFilter(std::uint32_t otherwise, bool allThreads) : context_(seccomp_init(otherwise), &seccomp_release) {
        if (!context_) throwOnSeccompError(-ENOMEM);
        throwOnSeccompError(seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_TSYNC, allThreads ? 1 : 0));
        // Kill the process for system calls of another architecture, such as 32-bit calls on x86-64, because this
        // program never makes such calls.
        throwOnSeccompError(seccomp_attr_set(context_.get(), SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS));
        // The value 2 stores the rules as a binary tree, which makes each system call faster.
        throwOnSeccompError(seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_OPTIMIZE, 2));
    }

    void addRule(std::uint32_t action, std::span<const char* const> names) {
        for (const char* name : names) addRule(action, name, {});
    }
    void addRule(std::uint32_t action, const char* name, std::initializer_list<scmp_arg_cmp> arguments) {
        const int call = seccomp_syscall_resolve_name(name);
        if (call == __NR_SCMP_ERROR) return;
        const int error = seccomp_rule_add_array(context_.get(), action, call, static_cast<unsigned>(arguments.size()),
                                                 arguments.begin());
        if (error != -EDOM) throwOnSeccompError(error);  // EDOM means that this architecture lacks the call
    }
    void load() { throwOnSeccompError(seccomp_load(context_.get())); }

  private:
    std::unique_ptr<void, decltype(&seccomp_release)> context_;
};

scmp_arg_cmp argumentIs(unsigned argument, std::uint64_t value) { return {argument, SCMP_CMP_EQ, value, 0}; }
scmp_arg_cmp argumentHasAll(unsigned argument, std::uint64_t bits) {
    return {argument, SCMP_CMP_MASKED_EQ, bits, bits};
}
scmp_arg_cmp argumentHasNone(unsigned argument, std::uint64_t bits) { return {argument, SCMP_CMP_MASKED_EQ, bits, 0}; }

#ifdef OVAL4D_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

void limitResource(decltype(RLIMIT_AS) resource, rlim_t most) {
    rlimit now{};
    if (getrlimit(resource, &now) != 0) return;
    now.rlim_max = std::min(now.rlim_max, most);
    now.rlim_cur = std::min(now.rlim_cur, now.rlim_max);
    setrlimit(resource, &now);
}

/// Returns the size, in bytes, of the private writable memory in use: the memory that RLIMIT_DATA limits, and the
/// stack.
std::size_t privateMemoryInUse() {
    std::array<std::size_t, 6> pages{};  // the columns of statm: size, resident, shared, text, lib, data
    std::ifstream statm("/proc/self/statm");
    for (std::size_t& each : pages) statm >> each;
    return pages.back() * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Returns whether a filter of system calls can be set on this system. If not, sets `why` to the reason.
bool canFilterSystemCalls(std::string& why) {
    if (kSanitized) {
        why = "this is a build with a sanitizer";
        return false;
    }
    // Only a trial shows whether a filter can be set: the filter of a container may forbid it. The trial filter applies
    // to a temporary thread and ends with it.
    std::thread([&why] {
        try {
            SeccompFilter filter(SCMP_ACT_ALLOW, false);
            filter.load();
        } catch (const std::exception& fault) {
            why = fault.what();
        }
    }).join();
    return why.empty();
}

/// Restricts all threads of this process to the system calls that `role` needs.
void filterSystemCalls(SandboxRole role) {
    SeccompFilter filter(SCMP_ACT_ERRNO(EPERM), true);
    filter.addRule(SCMP_ACT_ALLOW, kCommonCalls);
    for (const char* name : {"recvmsg", "sendmsg"}) filter.addRule(SCMP_ACT_ALLOW, name, {argumentIs(0, kChildSocket)});
    for (const char* name : {"write", "writev"}) filter.addRule(SCMP_ACT_ALLOW, name, {argumentIs(0, STDERR_FILENO)});
    // abort() needs to send a signal to its own process.
    const auto own = static_cast<std::uint64_t>(getpid());
    for (const char* name : {"kill", "tgkill"}) filter.addRule(SCMP_ACT_ALLOW, name, {argumentIs(0, own)});
    filter.addRule(SCMP_ACT_ALLOW, "fcntl", {argumentIs(1, F_GETFL)});
    // Allow the process to read its limits, but not to change them: the argument for new limits must be null.
    filter.addRule(SCMP_ACT_ALLOW, "prlimit64", {argumentIs(0, 0), argumentIs(2, 0)});
    // A filter cannot inspect the arguments of clone3, because they are in memory. Fail with ENOSYS, so that the C
    // library uses clone.
    filter.addRule(SCMP_ACT_ERRNO(ENOSYS), "clone3", {});
    // Forbid mmap with both of these flags: the rules below allow mmap if at least one of the flags is not set.
    // Together, the flags request shared memory without a file, which would not count toward the memory limit.
    constexpr auto kNotTogether = std::to_array<std::uint64_t>({MAP_SHARED, MAP_ANONYMOUS});
    if (role == SandboxRole::draw) {
        for (const char* name : {"mprotect", "mremap"}) filter.addRule(SCMP_ACT_ALLOW, name, {});
        for (const std::uint64_t flag : kNotTogether)
            filter.addRule(SCMP_ACT_ALLOW, "mmap", {argumentHasNone(3, flag)});
        filter.addRule(SCMP_ACT_ALLOW, kThreadCalls);
        constexpr std::uint64_t kThread = CLONE_VM | CLONE_SIGHAND | CLONE_THREAD;
        filter.addRule(SCMP_ACT_ALLOW, "clone", {argumentHasAll(0, kThread)});
        filter.addRule(SCMP_ACT_ALLOW, "prctl", {argumentIs(0, PR_SET_NAME)});
    } else {
        filter.addRule(SCMP_ACT_ALLOW, "mremap", {});
        filter.addRule(SCMP_ACT_ALLOW, "mprotect", {argumentHasNone(2, PROT_EXEC)});
        for (const std::uint64_t flag : kNotTogether)
            filter.addRule(SCMP_ACT_ALLOW, "mmap", {argumentHasNone(2, PROT_EXEC), argumentHasNone(3, flag)});
    }
    filter.addRule(SCMP_ACT_KILL_PROCESS, kIntruderCalls);
    filter.load();
}

/// Sets the resource limits, and disables core dumps, which would contain data of clients.
void limitResources(const Confinement& limits) {
    limitResource(RLIMIT_CORE, 0);
    if (kSanitized) return;
    // Limit RLIMIT_DATA and not RLIMIT_AS, because RLIMIT_AS also counts mapped files, which may be larger than the
    // main memory.
    if (limits.memory > 0) limitResource(RLIMIT_DATA, privateMemoryInUse() + limits.memory);
    if (limits.files > 0) limitResource(RLIMIT_NOFILE, limits.files);
}

}  // namespace

bool forbidNewPrivileges() { return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0; }

bool shouldSandbox(SandboxMode wanted, std::string& why) {
    if (wanted == SandboxMode::off) return false;
    if (canFilterSystemCalls(why)) return true;
    if (wanted == SandboxMode::required) throw std::runtime_error("the sandbox is required, but not available: " + why);
    return false;
}

void confine(SandboxRole role, const Confinement& confinement) {
    limitResources(confinement);
    if (confinement.filtered) filterSystemCalls(role);
}

}  // namespace oval4d::process
