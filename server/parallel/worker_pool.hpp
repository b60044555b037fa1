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

/// Thrown when a job is rejected because the queue is full.
class QueueFull : public std::runtime_error {
  public:
    QueueFull() : std::runtime_error("too many jobs are queued") {}
};

/// Threads that run jobs in the order of a FairQueue. Each job receives the index of its worker, from 0, so that jobs
/// can use data of the worker. Thread-safe.
class WorkerPool {
  public:
    using Argument = std::size_t;  ///< of a job
    using Job = FairQueue::Job;
    using Seconds = FairQueue::Seconds;
    using Client = FairQueue::Client;
    using Lane = FairQueue::Lane;
    using ClientPtr = FairQueue::ClientPtr;
    using LanePtr = FairQueue::LanePtr;
    using Limits = FairQueue::Limits;

    struct Options {
        std::size_t threads = 1;
        Limits limits = {};
        Job first = [](std::size_t) {};  ///< run once by each worker before any other job
        /// Run by a worker that has been idle for kIdleDelay since its last job; frees cached memory.
        std::function<void(std::size_t worker)> whenIdle = [](std::size_t) {};
        ForkJoin* forkJoin = nullptr;  ///< is told which processors are busy; may be null
    };
    static constexpr std::chrono::seconds kIdleDelay{3};

    explicit WorkerPool(Options options);
    ~WorkerPool();

    /// Queues a job, whose estimated duration is `cost`. Jobs without a lane share one. A job must not throw, except
    /// Canceled after `stop`. Returns false, and drops the job, if the queue is full; after `stop`, drops the job.
    [[nodiscard]] bool post(Job job, LanePtr lane, Seconds cost);

    /// Makes a worker run `whenIdle` when it has been idle for kIdleDelay, even if no job runs before.
    void cleanUpWhenIdle();

    /// Finishes or cancels the running jobs, and drops the others.
    void stop();

    /// The token on which `stop` requests a stop; long jobs should then end early.
    std::stop_token stopToken() const { return stopSource_.get_token(); }

    std::size_t size() const { return threads_.size(); }
    std::size_t waiting() const;
    /// Whether a queued job could start if a thread were free.
    bool crowded();
    /// The total time that all threads have spent on jobs.
    Seconds worked() const;

  private:
    using Clock = FairQueue::Clock;

    void run(std::size_t worker);
    void wait(std::unique_lock<std::mutex>& lock, bool& used, std::size_t worker);

    const Options options_;
    const LanePtr common_ = std::make_shared<Lane>(std::make_shared<Client>());  // for jobs without a lane
    std::stop_source stopSource_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Guarded by mutex_, as are lanes and clients.
    FairQueue queue_;
    Seconds worked_{0};
    bool cleanUp_ = false;  // see cleanUpWhenIdle
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace oval4d::parallel
