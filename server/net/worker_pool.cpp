#include "net/worker_pool.hpp"

#include <algorithm>
#include <utility>

namespace oval4d::net {

WorkerPool::WorkerPool(int threads, Job first) {
    const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
    const unsigned count = threads > 0 ? static_cast<unsigned>(threads) : cores;
    for (unsigned i = 0; i < count; ++i) threads_.emplace_back([this, first] { run(first); });
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::post(Job job) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return;
        jobs_.push_back(std::move(job));
    }
    wake_.notify_one();
}

void WorkerPool::stop() {
    stopSource_.request_stop();
    std::deque<Job> dropped;  // destroyed outside the lock: a job may own much
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        dropped.swap(jobs_);
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

std::size_t WorkerPool::waiting() const {
    const std::lock_guard lock(mutex_);
    return jobs_.size();
}

void WorkerPool::run(const Job& first) {
    picture::Painter painter;
    first(painter);
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
            if (stopping_) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        const auto start = std::chrono::steady_clock::now();
        job(painter);
        worked_ += std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
    }
}

}  // namespace oval4d::net
