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
    std::chrono::duration<double> timeout;             ///< for reading one file
    std::chrono::duration<double> idle;                ///< processes end after this time without a file
    std::function<void(const process::Loss&)> onLoss;  ///< called on any thread
    std::vector<std::string> environment;              ///< see process::ChildOptions
    std::size_t waiting;                               ///< the most processes that wait for a file
};

/// Each process reads one file and ends, so that no file can affect the next one. Another process is then started in
/// advance for the next file; it ends if none comes for a while. Thread-safe.
class FileReaders {
  public:
    explicit FileReaders(ReaderOptions options);
    ~FileReaders();
    FileReaders(const FileReaders&) = delete;
    FileReaders& operator=(const FileReaders&) = delete;

    /// Like session::readObject, but in another process. Also fails with `too_large` if reading takes longer than the
    /// timeout, or more memory than a process may use. Blocks the calling thread. Throws process::Canceled;
    /// std::runtime_error if two processes die, none can be started, or the answer is not a valid object.
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
    std::vector<Process> waiting_, used_;
    Clock::time_point lastUsed_;
    std::jthread replacing_;  // last: it uses the other members
};

}  // namespace oval4d::reading
