#include "parallel/worker_pool.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "parallel/canceled.hpp"

namespace oval4d::parallel {

namespace {

using namespace std::chrono_literals;

// The interval at which a free thread checks whether a queued long job may start now.
constexpr auto kRecheckInterval = 1s;

void runJob(const WorkerPool::Job& job, std::size_t worker) {
    try {
        job(worker);
    } catch (const Canceled&) {  // a stop was requested, so nobody needs the result of the job
    }
}

}  // namespace

WorkerPool::WorkerPool(PoolOptions options) : options_(std::move(options)), queue_(options_.threads, options_.limits) {
    for (std::size_t i = 0; i < options_.threads; ++i) threads_.emplace_back([this, i] { runWorker(i); });
}

WorkerPool::~WorkerPool() { stop(); }

bool WorkerPool::post(Job job, JobQueuePtr jobQueue, Seconds cost) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return true;
        if (!queue_.push(std::move(job), jobQueue ? jobQueue : common_, cost, options_.now())) return false;
    }
    wake_.notify_one();
    return true;
}

void WorkerPool::cleanUpWhenIdle() {
    {
        const std::lock_guard lock(mutex_);
        cleanUp_ = true;
    }
    wake_.notify_one();
}

void WorkerPool::stop() {
    stopSource_.request_stop();
    std::deque<Job> dropped;  // destroyed after the lock is released, because a job may own much memory
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        dropped = queue_.clear();
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

std::size_t WorkerPool::waitingJobCount() const {
    const std::lock_guard lock(mutex_);
    return queue_.waitingJobCount();
}

bool WorkerPool::hasStartableJob() {
    const std::lock_guard lock(mutex_);
    return queue_.hasStartableJob(options_.now());
}

WorkerPool::Seconds WorkerPool::busyTime() const {
    const std::lock_guard lock(mutex_);
    return busyTime_;
}

void WorkerPool::runWorker(std::size_t worker) {
    runJob(options_.onThreadStart, worker);
    std::unique_lock lock(mutex_);
    bool used = true;
    while (!stopping_) {
        auto next = queue_.popStartableJob(options_.now());
        if (!next) {
            waitForJobOrCleanUp(lock, used, worker);
            continue;
        }
        used = true;
        lock.unlock();
        const auto start = options_.now();
        {
            std::optional<ForkJoin::BusyProcessorGuard> work;
            if (options_.forkJoin != nullptr) work.emplace(*options_.forkJoin);
            runJob(next->job, worker);
        }
        next->job = nullptr;  // destroys what the job owns now, while the mutex is not locked
        const Seconds took = options_.now() - start;
        lock.lock();
        busyTime_ += took;
        queue_.recordJobEnd(*next, took);
        if (queue_.waitingJobCount() > 0)
            wake_.notify_one();  // a long job that had to wait may be allowed to start now
    }
}

/// Waits until a job may be ready to start. If `used` or cleanUp_ is true and no job is queued within kIdleDelay, runs
/// `whenIdle` and sets both to false. `used` says whether the worker has run a job since it last ran `whenIdle`; it is
/// true if the worker has never run `whenIdle`.
void WorkerPool::waitForJobOrCleanUp(std::unique_lock<std::mutex>& lock, bool& used, std::size_t worker) {
    if (queue_.waitingJobCount() > 0) {
        wake_.wait_for(lock, kRecheckInterval);
        return;
    }
    if (!used && !cleanUp_) return wake_.wait(lock);
    if (wake_.wait_for(lock, kIdleDelay) == std::cv_status::no_timeout) return;
    used = cleanUp_ = false;
    lock.unlock();
    options_.whenIdle(worker);
    lock.lock();
}

}  // namespace oval4d::parallel
