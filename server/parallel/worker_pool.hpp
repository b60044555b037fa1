#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

#include "parallel/fair_queue.hpp"
#include "parallel/fork_join.hpp"

namespace oval4d::parallel {

/// An exception that callers of WorkerPool::post() throw, to report that the pool has rejected a job because its queue
/// is full.
class QueueFull : public std::runtime_error {
  public:
    QueueFull() : std::runtime_error("too many jobs are queued") {}
};

/// A pool of worker threads that run jobs in the order of a FairQueue, which divides the time of the threads fairly
/// among clients. Each job receives the index of its worker, from 0 to PoolOptions::threads − 1, so that the job can
/// use data that belong to the worker. Thread-safe. However, while stop() runs, neither size() nor stop() may be
/// called.
class WorkerPool {
  public:
    using JobArgument = std::size_t;  ///< the type of the argument of a job: the index of the worker
    using Job = FairQueue::Job;       ///< called with the index of the worker
    using Seconds = FairQueue::Seconds;
    using ClientFlow = FairQueue::ClientFlow;
    using JobQueue = FairQueue::JobQueue;
    using ClientFlowPtr = FairQueue::ClientFlowPtr;
    using JobQueuePtr = FairQueue::JobQueuePtr;
    using Limits = FairQueue::Limits;

    struct PoolOptions {
        std::size_t threads = 1;                 ///< the number of worker threads
        Limits limits = {};                      ///< the maximum numbers of waiting jobs
        Job onThreadStart = [](std::size_t) {};  ///< each worker calls this function once, before its other jobs
        /// A worker calls this function when it has been idle for kIdleDelay since its last job, to free cached memory.
        std::function<void(std::size_t worker)> whenIdle = [](std::size_t) {};
        ForkJoin* forkJoin = nullptr;  ///< if not null, it counts one more processor as busy during each job
        /// Returns the current time, with which jobs are scheduled and measured. Tests pass a function that returns a
        /// virtual time.
        std::function<FairQueue::Clock::time_point()> now = FairQueue::Clock::now;
    };
    static constexpr std::chrono::seconds kIdleDelay{3};

    explicit WorkerPool(PoolOptions options);
    ~WorkerPool();

    /// Queues `job` in `jobQueue`. `cost` is the estimated running time of the job. If `jobQueue` is null, queues the
    /// job in a common job queue for all such jobs. A job must not throw, except Canceled after stop(). Returns false,
    /// and drops the job, if a limit on the number of waiting jobs is reached (see PoolOptions::limits). After stop(),
    /// drops the job and returns true, because no limit is reached.
    [[nodiscard]] bool post(Job job, JobQueuePtr jobQueue, Seconds cost);

    /// Makes one worker call PoolOptions::whenIdle after it has been idle for kIdleDelay, even if it has run no job
    /// since its last call of `whenIdle`.
    void cleanUpWhenIdle();

    /// Drops the waiting jobs, requests the running jobs to stop, and waits until all threads have ended.
    void stop();

    /// Returns the token through which stop() requests a stop. Long jobs should check this token, and end early if a
    /// stop is requested.
    std::stop_token stopToken() const { return stopSource_.get_token(); }

    /// Returns the number of threads; 0 after stop().
    std::size_t size() const { return threads_.size(); }
    /// Returns the number of waiting jobs.
    std::size_t waitingJobCount() const;
    /// Returns whether a waiting job could start if one more thread were free.
    bool hasStartableJob();
    /// Returns the total running time, in seconds, of all jobs that have ended.
    Seconds busyTime() const;

  private:
    void runWorker(std::size_t worker);
    void waitForJobOrCleanUp(std::unique_lock<std::mutex>& lock, bool& used, std::size_t worker);

    const PoolOptions options_;
    // The job queue for all jobs that are posted with a null job queue.
    const JobQueuePtr common_ = std::make_shared<JobQueue>(std::make_shared<ClientFlow>());
    std::stop_source stopSource_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // The mutex mutex_ guards the next four members, and the contents of job queues and clients.
    FairQueue queue_;
    Seconds busyTime_{0};
    bool cleanUp_ = false;  // whether a worker must still call `whenIdle` because cleanUpWhenIdle() was called
    bool stopping_ = false;
    std::vector<std::thread> threads_;  // changed only by the constructor and stop()
};

}  // namespace oval4d::parallel
