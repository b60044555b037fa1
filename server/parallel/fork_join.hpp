#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace oval4d::parallel {

/// Runs two independent jobs in parallel. The calling thread runs the first job, and a helper thread runs the second.
/// If the helper thread is in use, or all processors are busy, the calling thread runs both jobs, because the total
/// throughput is then higher. Waking the helper thread takes about 10 µs. Thread-safe.
class ForkJoin {
  public:
    using Job = std::function<void()>;

    /// Makes ForkJoin::invoke() count one more processor as busy, as long as this object exists.
    class BusyProcessorGuard {
      public:
        explicit BusyProcessorGuard(ForkJoin& forkJoin) : busy_(forkJoin.busyProcessors_) { ++busy_; }
        ~BusyProcessorGuard() { --busy_; }
        BusyProcessorGuard(const BusyProcessorGuard&) = delete;
        BusyProcessorGuard& operator=(const BusyProcessorGuard&) = delete;

      private:
        std::atomic<unsigned>& busy_;
    };

    /// Starts the helper thread, unless there is only one processor.
    ForkJoin();
    ~ForkJoin();
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;

    /// Runs both jobs, and returns when both have ended. If a job throws an exception, rethrows this exception; if both
    /// jobs throw, rethrows the exception of the first job. If the first job throws, the second job may not have run.
    void invoke(const Job& first, const Job& second);

  private:
    void runHelperThread();

    const unsigned processors_ = std::thread::hardware_concurrency();
    std::atomic<unsigned> busyProcessors_ = 0;
    std::atomic_flag taken_;  // set while the helper thread serves a caller
    std::mutex mutex_;
    std::condition_variable changed_;
    // The mutex mutex_ guards the next three members.
    const Job* job_ = nullptr;   // the job for the helper thread; null if there is none
    std::exception_ptr thrown_;  // the exception of the helper thread's last job; null if the job threw none
    bool ending_ = false;
    std::thread thread_;  // the helper thread; only the constructor assigns it, so reading it needs no lock
};

/// Runs both jobs with `forkJoin`. If `forkJoin` is null, runs one job after the other on the calling thread.
void invoke(ForkJoin* forkJoin, const ForkJoin::Job& first, const ForkJoin::Job& second);

}  // namespace oval4d::parallel
