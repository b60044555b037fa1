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

namespace oval4d::file_reading {

/// The options of FileReaderPool.
struct FileReaderOptions {
    std::chrono::duration<double> timeout;  ///< the time allowed for reading one file
    std::chrono::duration<double> idle;     ///< the time without a file after which waiting processes end
    std::function<void(const process::ProcessLoss&)> onLoss;  ///< called on any thread
    std::vector<std::string> environment;                     ///< see process::ChildOptions
    std::size_t waiting;                                      ///< the maximum number of processes that wait for a file
};

/// A pool of processes that read files. Each process reads a single file and ends, so that a malicious file cannot
/// affect the next one. Then another process is started in advance and waits for a file. A waiting process ends if no
/// file comes within FileReaderOptions::idle. Thread-safe.
class FileReaderPool {
  public:
    explicit FileReaderPool(FileReaderOptions options);
    ~FileReaderPool();
    FileReaderPool(const FileReaderPool&) = delete;
    FileReaderPool& operator=(const FileReaderPool&) = delete;

    /// Reads a file as session::readObject does, but in another process. Also returns the error `too_large` if reading
    /// takes longer than the timeout, or more memory than a process may use. Blocks the calling thread. Throws
    /// process::Canceled if `stop` is requested. Throws std::runtime_error if the process dies and a second process
    /// that reads the same file dies, too; if no process can be started; or if the answer of the process is invalid.
    Result<session::LoadedObject> read(std::string_view format, std::string_view text, const std::string& name,
                                       const session::Limits& limits, const std::stop_token& stop);

  private:
    using Clock = std::chrono::steady_clock;
    using Process = std::unique_ptr<process::ChildProcess>;

    Process acquire();
    void retire(Process used);  // a process reads one file; another thread replaces it
    void replaceUsed(const std::stop_token& stop);

    const FileReaderOptions options_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    // The next three members are guarded by mutex_.
    std::vector<Process> waiting_, used_;  // processes that wait for a file; processes to be replaced
    Clock::time_point lastUsed_;           // when the reading of a file last ended
    std::jthread replacing_;               // runs replaceUsed(); declared last, because it uses the other members
};

}  // namespace oval4d::file_reading
