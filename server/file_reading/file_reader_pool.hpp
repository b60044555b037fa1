#pragma once
// The pool of processes that read clients' files, outside the server process.

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
    std::chrono::duration<double> timeout;  ///< the time in seconds that reading one file may take
    std::chrono::duration<double> idle;     ///< the time in seconds without a read file after which waiting processes
                                            ///< are killed
    std::function<void(const process::ProcessLoss&)> onLoss;  ///< called on any thread when a process dies unexpectedly
    std::vector<std::string> environment;                     ///< the environment variables of the processes, as in
                                                              ///< process::ChildOptions::environment
    std::size_t maxWaiting;                                   ///< the maximum number of processes that wait for a file
};

/// A function that makes a new file of the size `bytes`, and reserves its space on the disk. A reader process writes
/// samples to the file. Called on the thread that calls FileReaderPool::read(). Errors: `too_large` and `too_many` if
/// there is no room for the file.
using FileAllocator = std::function<Result<std::shared_ptr<const fields::FileHandle>>(std::size_t bytes)>;

/// A pool of processes that read files. A process reads a single file and ends, so that a malicious file cannot affect
/// the reading of the next file. A new process then replaces this process, and waits for the next file. If no file is
/// read for the time FileReaderOptions::idle, the waiting processes are killed. Thread-safe.
class FileReaderPool {
  public:
    explicit FileReaderPool(FileReaderOptions options);
    ~FileReaderPool();
    FileReaderPool(const FileReaderPool&) = delete;
    FileReaderPool& operator=(const FileReaderPool&) = delete;

    /// Reads the file, series or folder of `load` as session::readObject() does, but in another process. Returns when
    /// the process has read it.
    ///
    /// If `allocate` is given, arrays of more than Limits::maxFieldBytes are allowed. Their samples stay in the file,
    /// which is mapped, or are written to a new file that `allocate` makes. For each kBytesPerSecond bytes of a new
    /// file, the process may take one second more than FileReaderOptions::timeout.
    ///
    /// Errors: those of session::readObject() and of `allocate`; `too_large` if the process needs more memory or time
    /// than it may use. Throws process::Canceled if `stop` is requested. Throws std::runtime_error if the process dies
    /// and a second process for the same file dies, too; if no process can be started; or if the answer of the process
    /// is invalid.
    Result<session::ObjectWithWarnings> read(const session::LoadObject& load, const session::Limits& limits,
                                             const std::stop_token& stop, const FileAllocator& allocate = {});

    static constexpr std::size_t kBytesPerSecond = std::size_t{16} << 20U;

  private:
    using Clock = std::chrono::steady_clock;
    using ChildProcessPtr = std::unique_ptr<process::ChildProcess>;

    ChildProcessPtr acquireProcess();
    void retireProcess(
        ChildProcessPtr used);  // gives a process that has read a file to the thread of replaceUsedProcesses()
    void replaceUsedProcesses(const std::stop_token& stop);

    const FileReaderOptions options_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    // mutex_ guards the next three members.
    std::vector<ChildProcessPtr> waiting_, used_;  // the processes that wait for a file; the processes that
                                                   // replaceUsedProcesses() must replace
    Clock::time_point lastUsed_;                   // when a process last finished reading a file
    std::jthread replacing_;  // the thread of replaceUsedProcesses(); declared last, because it uses the other members
};

}  // namespace oval4d::file_reading
