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
    std::chrono::duration<double> idle;     ///< waiting processes end if no file is read for this time
    std::function<void(const process::ProcessLoss&)> onLoss;  ///< called when a process is lost, on any thread
    std::vector<std::string> environment;                     ///< see process::ChildOptions
    std::size_t maxWaiting;                                   ///< the maximum number of processes that wait for a file
};

/// Makes a new file of this size in bytes, with its space reserved on the disk, to which a reader process may write
/// samples. Called on the thread that calls FileReaderPool::read(). Errors: `too_large` and `too_many` if there is no
/// room for it.
using FileAllocator = std::function<Result<std::shared_ptr<const fields::FileHandle>>(std::size_t bytes)>;

/// A pool of processes that read files. Each process reads a single file and ends, so that a malicious file cannot
/// affect the reading of the next one. A new process then replaces it, and waits for the next file. A waiting process
/// ends if no file comes within FileReaderOptions::idle. Thread-safe.
class FileReaderPool {
  public:
    explicit FileReaderPool(FileReaderOptions options);
    ~FileReaderPool();
    FileReaderPool(const FileReaderPool&) = delete;
    FileReaderPool& operator=(const FileReaderPool&) = delete;

    /// Reads a file as session::readObject() does, but in another process. Returns when the file has been read.
    ///
    /// If `allocate` is given, arrays of more than Limits::maxFieldBytes are allowed: their samples stay in the file,
    /// which is mapped, or are in a new file that `allocate` makes. The timeout (FileReaderOptions::timeout) is
    /// extended by one second for each kBytesPerSecond bytes of a new file.
    ///
    /// Errors: those of session::readObject() and of `allocate`, and `too_large` if the process needs more memory or
    /// time than is allowed. Throws process::Canceled if `stop` is requested. Throws std::runtime_error if the process
    /// dies and a second process that reads the same file dies, too; if no process can be started; or if the answer of
    /// the process is invalid.
    Result<session::ObjectWithWarnings> read(const session::LoadObject& load, const session::Limits& limits,
                                             const std::stop_token& stop, const FileAllocator& allocate = {});

    static constexpr std::size_t kBytesPerSecond = std::size_t{16} << 20U;

  private:
    using Clock = std::chrono::steady_clock;
    using ChildProcessPtr = std::unique_ptr<process::ChildProcess>;

    ChildProcessPtr acquire();
    void retire(ChildProcessPtr used);  // passes a process that has read a file to the thread of replaceUsed()
    void replaceUsed(const std::stop_token& stop);

    const FileReaderOptions options_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    // The next three members are guarded by mutex_.
    std::vector<ChildProcessPtr> waiting_, used_;  // processes that wait for a file; processes to be replaced
    Clock::time_point lastUsed_;                   // when the reading of a file last ended
    std::jthread replacing_;  // runs replaceUsed(); declared last, because it uses the other members
};

}  // namespace oval4d::file_reading
