#pragma once
// Child processes that do risky work for the server. The server survives if a child process crashes or hangs.

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "parallel/canceled.hpp"
#include "process/channel.hpp"

namespace oval4d::process {

/// The file descriptor of a child process for its channel to the server.
inline constexpr int kChildSocket = 3;

using parallel::Canceled;

/// The loss of a child process: it died, or it hung and was killed.
struct ProcessLoss {
    bool hung;                ///< whether the process hung; false if it died
    std::string description;  ///< text for the log, such as "died: signal 11"
};

/// The options of a child process.
struct ChildOptions {
    std::string command;                   ///< the subcommand of this program that the child runs
    std::vector<std::string> environment;  ///< definitions "NAME=value"; a value that the child inherits from the
                                           ///< server takes precedence
    /// The maximum time for the start of a child, and for each conversation. A child that takes longer counts as hung.
    std::chrono::duration<double> timeout;
    /// Whether a conversation during which the child hung is repeated with a new child.
    bool repeatAfterHang = true;
    std::function<void(const ProcessLoss&)> onLoss;  ///< called when a child process is lost; may be called on any
                                                     ///< thread
    int niceness = 0;                                ///< scheduling priority of the child: 0 (normal) to 19 (lowest)
};

/// The error of a conversation that failed because the child process was lost. Either the process that replaced it was
/// lost, too, or the conversation was not repeated (see hasHung()).
class ProcessLostError : public std::runtime_error {
  public:
    ProcessLostError(const std::string& fault, bool hung) : std::runtime_error(fault), hung_(hung) {}
    /// Returns true if the process hung, so that the conversation was not repeated (see ChildOptions::repeatAfterHang).
    /// Returns false if both the process and the process that replaced it were lost.
    bool hasHung() const { return hung_; }

  private:
    bool hung_;
};

/// A child process that runs this program. The process is started on demand, and replaced by a new process if it is
/// lost. It ends when this object is destroyed or the server ends. The only file descriptor that the process inherits
/// is standard error (the log). The process inherits the server's environment variables, except those whose names begin
/// with OVAL4D_, which may hold secrets. Of these, only OVAL4D_FONT is inherited. Not thread-safe: only one thread at a
/// time may use an object.
class ChildProcess {
  public:
    /// A function that sends messages to the process and receives the replies, within the given WaitLimit. Returns the
    /// result of its last call of Channel::send() or Channel::receive().
    using ConversationFunction = std::function<TransferResult(const Channel&, const WaitLimit&)>;

    explicit ChildProcess(ChildOptions options);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Starts the process unless it is running, and does not wait until it is ready. Throws std::runtime_error if the
    /// process cannot be started.
    void start();

    /// Calls `conversation` when the process is ready; starts the process if necessary. If the process is lost, starts
    /// a new process and repeats the conversation once. However, does not repeat the conversation if the process hung
    /// during `conversation` and ChildOptions::repeatAfterHang is false. Throws:
    /// - Canceled if a stop is requested;
    /// - ProcessLostError if the new process is lost, too, or if the conversation is not repeated;
    /// - std::runtime_error if the process cannot be started, or reports that its start has failed;
    /// - exceptions of `conversation`, after killing the process.
    void converseWithRetry(const ConversationFunction& conversation, const std::stop_token& stop);

    /// Kills the process if it is running.
    void kill();

  private:
    std::string endProcess(bool atOnce);
    WaitLimit waitLimit(const std::stop_token& stop) const;
    void awaitReadyMessage(TransferResult& transfer, const WaitLimit& limit);

    const ChildOptions options_;
    std::unique_ptr<Channel> channel_;  // null while no process runs
    bool ready_ = false;
    pid_t process_ = 0;
    std::vector<pid_t> unreaped_;  // killed processes that did not exit within kExitTimeout
};

/// Makes this process, a child process, end when the server ends, and ignore SIGINT and SIGTERM. A child process must
/// call this function first.
void initializeChild();

}  // namespace oval4d::process
