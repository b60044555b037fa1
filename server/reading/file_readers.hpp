#pragma once
// The pool of processes that read clients' files for the server.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "errors/error.hpp"
#include "process/child_process.hpp"
#include "session/load.hpp"
#include "session/session.hpp"

namespace oval4d::reading {

struct ReaderOptions {
    std::chrono::duration<double> timeout;                    ///< the time allowed for reading one file
    std::chrono::duration<double> idle;                       ///< waiting processes end after this time without a file
    std::function<void(const process::ProcessLoss&)> onLoss;  ///< called on any thread
    std::vector<std::string> environment;                     ///< see process::ChildOptions
    std::size_t waiting;                                      ///< the maximum number of waiting processes
};

/// A pool of processes that read files. Each process reads a single file and ends, so that a malicious file cannot
/// affect the next one. Another process is then started in advance and waits for the next file; it ends if none comes
/// for a while. Thread-safe.
class FileReaders {
  public:
    explicit FileReaders(ReaderOptions options);
    ~FileReaders();
    FileReaders(const FileReaders&) = delete;
    FileReaders& operator=(const FileReaders&) = delete;

    /// Reads a file as session::readObject does, but in another process. Also returns the error `too_large` if reading
    /// takes longer than the timeout, or more memory than a process may use. Blocks the calling thread. Throws
    /// process::Canceled if `stop` is requested, and std::runtime_error if the process dies and so does the process
    /// that tries again, if no process can be started, or if the answer of the process is invalid.
    Result<session::LoadedObject> read(std::string_view format, std::string_view text, const std::string& name,
                                       const session::Limits& limits, const std::stop_token& stop);

  private:
    using Clock = std::chrono::steady_clock;
    using Process = std::unique_ptr<process::ChildProcess>;

    Process acquire();
    void release(Process used);
    void replaceUsed(const std::stop_token& stop);

    const ReaderOptions options_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    // Guarded by mutex_.
    std::vector<Process> waiting_, used_;  // waiting for a file; done with one, to be replaced
    Clock::time_point lastUsed_;           // when a file was last read
    std::jthread replacing_;               // runs replaceUsed(); declared last, because it uses the other members
};

}  // namespace oval4d::reading
