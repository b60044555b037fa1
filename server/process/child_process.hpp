#pragma once
// Child processes that do risky work for the server: it survives if they crash or hang.

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

/// The file descriptor of the child's end of the channel.
inline constexpr int kChildSocket = 3;

using parallel::Canceled;

/// The loss of a process that died, or that hung and was killed.
struct Loss {
    bool hung;
    std::string how;  ///< for the log
};

/// The options of a child process.
struct ChildOptions {
    std::string command;                      ///< the subcommand of this program
    std::vector<std::string> environment;     ///< "NAME=value", added unless the server's environment has that name
    std::chrono::duration<double> timeout;    ///< of a start and of each conversation; a slower process has hung
    bool repeatAfterHang = true;              ///< whether to repeat a conversation in which the process hung
    std::function<void(const Loss&)> onLoss;  ///< called on any thread
    int niceness = 0;                         ///< scheduling priority, as for nice(1)
};

/// A conversation failed because its processes were lost.
class ProcessLost : public std::runtime_error {
  public:
    ProcessLost(const std::string& fault, bool hung) : std::runtime_error(fault), hung_(hung) {}
    /// Whether the process hung in the conversation itself, which was not repeated.
    bool hung() const { return hung_; }

  private:
    bool hung_;
};

/// A child process that runs this program, started on demand, and again after it was lost. It ends with this object, or
/// with the program. It inherits no file descriptors of the server except standard error (the log), and no environment
/// variables OVAL4D_… except OVAL4D_FONT, because they may hold secrets. Not thread-safe: one thread at a time may use
/// an object.
class ChildProcess {
  public:
    /// A conversation with the process. Returns the result of its last transfer.
    using Talk = std::function<Transfer(const Channel&, const Deadline&)>;

    explicit ChildProcess(ChildOptions options);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Starts the process unless it is running, and does not wait until it is ready. Throws std::runtime_error.
    void start();

    /// Calls `talk` when the process is ready, and once more with a new process if the first is lost. Throws Canceled;
    /// ProcessLost if both are lost; std::runtime_error if the process cannot be started or reports that it failed to
    /// begin; and what `talk` throws, after killing the process.
    void converse(const Talk& talk, const std::stop_token& stop);

    /// Kills the process if it is running.
    void kill();

  private:
    std::string end(bool atOnce);
    Deadline deadline(const std::stop_token& stop) const;
    void awaitReady(Transfer& transfer, const Deadline& deadline);

    const ChildOptions options_;
    std::unique_ptr<Channel> channel_;  // null: not running
    bool ready_ = false;
    pid_t process_ = 0;
    std::vector<pid_t> unreaped_;  // killed, but not ended yet
};

/// Must be called by a child first: makes it end when the server ends, and ignore SIGINT and SIGTERM.
void beginChild();

}  // namespace oval4d::process
