#include "process/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "text/message_text.hpp"

namespace oval4d::process {

namespace {

using namespace std::chrono_literals;
using Clock = WaitLimit::Clock;

// The maximum size, in bytes, of the reason for which a child process failed (the body of MessageType::failed).
constexpr std::size_t kMaxReason = 64U << 10U;

/// The environment variables of a child process. First come the variables of this process; of those whose names begin
/// with OVAL4D_, only OVAL4D_FONT. Then come the variables in `added` whose names have not occurred yet.
class ChildEnvironment {
  public:
    explicit ChildEnvironment(const std::vector<std::string>& added) {
        for (char** each = environ; *each != nullptr; ++each) {
            const std::string_view entry = *each;
            if (!entry.starts_with("OVAL4D_") || entry.starts_with("OVAL4D_FONT=")) entries_.push_back(*each);
        }
        for (const std::string& entry : added) {
            const std::string_view name = std::string_view(entry).substr(0, entry.find('=') + 1);
            const auto isSame = [&](const char* other) { return std::string_view(other).starts_with(name); };
            // posix_spawn() takes pointers to non-const strings, but does not modify the strings.
            if (std::ranges::none_of(entries_, isSame)) entries_.push_back(const_cast<char*>(entry.c_str()));
        }
        entries_.push_back(nullptr);
    }
    char* const* data() const { return entries_.data(); }

  private:
    std::vector<char*> entries_;
};

[[noreturn]] void throwStartError(int error) {
    throw std::runtime_error(std::string("cannot start a process: ") + std::strerror(error));
}

// The time in which a process must exit after its channel was closed; after this time, the process is killed. The
// server then waits at most the same time for the killed process to exit, because a debugger, for example, may delay
// the exit.
constexpr auto kExitTimeout = 1s;

/// Waits until a process has exited, and sets `status` as waitpid(2) does. Returns false if the process is still
/// running after kExitTimeout.
bool waitForExit(pid_t process, int& status) {
    const auto limit = Clock::now() + kExitTimeout;
    for (auto pause = 100us;; pause *= 2) {
        if (waitpid(process, &status, WNOHANG) != 0) return true;
        if (Clock::now() > limit) return false;
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace

ChildProcess::ChildProcess(ChildOptions options) : options_(std::move(options)) {}

ChildProcess::~ChildProcess() {
    if (channel_) endProcess(false);
}

void ChildProcess::start() {
    if (channel_) return;
    std::erase_if(unreaped_, [](pid_t each) { return waitpid(each, nullptr, WNOHANG) != 0; });
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) throwStartError(errno);
    channel_ = std::make_unique<Channel>(sockets[0]);
    const Channel theirs(sockets[1]);

    // Close all file descriptors above kChildSocket in the child. Otherwise, the server's connections would stay open
    // while the child runs.
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, sockets[1], kChildSocket);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files, kChildSocket + 1);
    const ChildEnvironment environment(options_.environment);
    std::string name = "oval4d", command = options_.command;
    char* const words[] = {name.data(), command.data(), nullptr};
    const int error = posix_spawn(&process_, "/proc/self/exe", &files, nullptr, words, environment.data());
    posix_spawn_file_actions_destroy(&files);
    if (error == 0) {
        // The parent sets the child's priority, so that the priority already applies while the child starts. Starting
        // is most of the work of many child processes.
        if (options_.niceness > 0) setpriority(PRIO_PROCESS, static_cast<id_t>(process_), options_.niceness);
        return;
    }
    channel_.reset();
    throwStartError(error);
}

void ChildProcess::kill() {
    if (channel_) endProcess(true);
}

/// Closes the channel and ends the process. If `atOnce` is true, kills the process immediately; otherwise, only if it
/// has not exited after kExitTimeout. Returns a text with the signal or exit status of the process.
std::string ChildProcess::endProcess(bool atOnce) {
    channel_.reset();
    ready_ = false;
    int status = 0;
    if (atOnce || !waitForExit(process_, status)) {
        ::kill(process_, SIGKILL);
        if (!waitForExit(process_, status)) unreaped_.push_back(process_);
    }
    return WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                               : "status " + std::to_string(WEXITSTATUS(status));
}

WaitLimit ChildProcess::waitLimit(const std::stop_token& stop) const {
    return {Clock::now() + std::chrono::duration_cast<Clock::duration>(options_.timeout), stop};
}

void ChildProcess::awaitReadyMessage(TransferResult& transfer, const WaitLimit& limit) {
    MessageType type{};
    std::string reason;
    transfer = channel_->receive(type, reason, nullptr, limit, kMaxReason);
    if (transfer != TransferResult::complete) return;
    if (type != MessageType::ready) throw std::runtime_error(reason);
    ready_ = true;
}

void ChildProcess::converseWithRetry(const ConversationFunction& conversation, const std::stop_token& stop) {
    ProcessLoss loss{};
    for (int losses = 0; losses < 2; ++losses) {
        start();
        auto transfer = TransferResult::complete;
        bool talked = false;
        try {
            // If the process hangs while it starts, `talked` stays false: the conversation is not the cause, and is
            // repeated.
            if (!ready_) awaitReadyMessage(transfer, waitLimit(stop));
            talked = ready_;
            if (talked) transfer = conversation(*channel_, waitLimit(stop));
        } catch (...) {
            // Kill the process, because its late reply could disturb the next conversation.
            endProcess(true);
            throw;
        }
        if (transfer == TransferResult::complete) return;
        const std::string how = endProcess(transfer == TransferResult::timed_out);
        if (stop.stop_requested()) throw Canceled();
        loss = transfer == TransferResult::closed
                   ? ProcessLoss{false, "died: " + how}
                   : ProcessLoss{true, "hung: no answer in " + text::shortestDecimal(options_.timeout.count()) + " s"};
        options_.onLoss(loss);
        if (loss.hung && talked && !options_.repeatAfterHang)
            throw ProcessLostError("a process was lost in this conversation, it " + loss.description, true);
    }
    throw ProcessLostError("two processes were lost in a row, the second " + loss.description, false);
}

void initializeChild() {
    // Ignore these signals, because a terminal or a container sends them to all processes, but the server decides when
    // its children end.
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    // Without this call, a child that hangs or is stopped would outlive the server.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}

}  // namespace oval4d::process
