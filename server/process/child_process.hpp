#pragma once
// Child processes that do risky work for the server. The server survives if they crash or hang.

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

/// The file descriptor by which a child process uses its channel to the server.
inline constexpr int kChildSocket = 3;

using parallel::Canceled;

/// Describes the loss of a process that died, or that hung and was killed.
struct ProcessLoss {
    bool hung;                ///< whether the process hung; false if it died
    std::string description;  ///< text for the log, such as "died: signal 11"
};

/// The options of a child process.
struct ChildOptions {
    std::string command;                    ///< the subcommand of this program that the child runs
    std::vector<std::string> environment;   ///< "NAME=value"; a variable that the child inherits takes precedence
    std::chrono::duration<double> timeout;  ///< a child that takes longer to start or for a conversation counts as hung
    bool repeatAfterHang = true;  ///< whether a conversation in which the child hung is repeated with a new child
    std::function<void(const ProcessLoss&)> onLoss;  ///< called when a child is lost, on any thread
    int niceness = 0;                                ///< nice value of the child: 0 (normal) to 19 (lowest priority)
};

/// Thrown when a conversation fails: the process was lost, and either the new process that replaced it was lost, too,
/// or the conversation was not repeated (see hung()).
class ProcessLostError : public std::runtime_error {
  public:
    ProcessLostError(const std::string& fault, bool hung) : std::runtime_error(fault), hung_(hung) {}
    /// Returns true if the conversation was not repeated because the process hung (see ChildOptions::repeatAfterHang).
    /// Returns false if both the process and the new process that replaced it were lost.
    bool hung() const { return hung_; }

  private:
    bool hung_;
};

/// A child process that runs this program. The process is started on demand, and a new process replaces it if it is
/// lost. The process ends when this object is destroyed or the server ends. It inherits only one file descriptor of the
/// server, standard error (the log). It inherits the environment variables of the server, except those named OVAL4D_…,
/// which may hold secrets; of these, it inherits only OVAL4D_FONT. Not thread-safe: one thread at a time may use an
/// object.
class ChildProcess {
  public:
    /// A function that sends messages to the process and receives the replies, within the WaitLimit that it gets.
    /// Returns the result of its last call of Channel::send() or Channel::receive().
    using ConversationFunction = std::function<TransferResult(const Channel&, const WaitLimit&)>;

    explicit ChildProcess(ChildOptions options);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Starts the process unless it is running. Does not wait until the process is ready. Throws std::runtime_error if
    /// the process cannot be started.
    void start();

    /// Starts the process if necessary, and calls `conversation` when the process is ready. If the process is lost,
    /// starts a new process and repeats the conversation once. However, if the process hung during `conversation` and
    /// ChildOptions::repeatAfterHang is false, does not repeat it. Throws:
    /// - Canceled if a stop is requested,
    /// - ProcessLostError if the new process is lost, too, or if the conversation is not repeated,
    /// - std::runtime_error if the process cannot be started, or reports that it failed to start,
    /// - what `conversation` throws, after killing the process.
    void converseWithRetry(const ConversationFunction& conversation, const std::stop_token& stop);

    /// Kills the process if it is running.
    void kill();

  private:
    std::string endProcess(bool atOnce);
    WaitLimit waitLimit(const std::stop_token& stop) const;
    void awaitReadyMessage(TransferResult& transfer, const WaitLimit& limit);

    const ChildOptions options_;
    std::unique_ptr<Channel> channel_;  // null while no process is running
    bool ready_ = false;
    pid_t process_ = 0;
    std::vector<pid_t> unreaped_;  // killed processes that did not end within kExitTimeout
};

/// Makes this process end when the server ends, and ignore SIGINT and SIGTERM. A child process must call this first.
void initializeChild();

}  // namespace oval4d::process
