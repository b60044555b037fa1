#include "net/worker_pool.hpp"

#include <algorithm>
#include <utility>

#include "geometry/companion.hpp"

namespace oval4d::net {

namespace {

using namespace std::chrono_literals;

// So long after its last job a lane with short ones counts as active.
constexpr auto kActive = 1s;

void carryOut(const WorkerPool::Job& job, picture::Painter& painter) {
    try {
        job(painter);
    } catch (const picture::GivenUp&) {  // nobody waits for it any more
    }
}

}  // namespace

WorkerPool::WorkerPool(std::size_t threads, Job first) : count_(threads), lastShort_(Clock::now() - kActive) {
    for (std::size_t i = 0; i < count_; ++i) threads_.emplace_back([this, first] { run(first); });
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::post(Job job, LanePtr lane) {
    if (!lane) lane = common_;
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return;
        const Seconds due = std::max(now_, lane->due_);
        const Seconds expected = lane->expected_;
        lane->due_ = due + expected;
        if (expected <= kLong) lastShort_ = Clock::now();
        (expected <= kLong ? short_ : long_).emplace(due, Entry{std::move(job), std::move(lane), expected});
    }
    wake_.notify_one();
}

void WorkerPool::tidyLater() {
    {
        const std::lock_guard lock(mutex_);
        litter_ = true;
    }
    wake_.notify_one();
}

void WorkerPool::stop() {
    stopSource_.request_stop();
    Queue dropped[2];  // destroyed outside the lock: a job may own much
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        dropped[0].swap(short_);
        dropped[1].swap(long_);
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

std::size_t WorkerPool::waiting() const {
    const std::lock_guard lock(mutex_);
    return short_.size() + long_.size();
}

WorkerPool::Seconds WorkerPool::worked() const {
    const std::lock_guard lock(mutex_);
    return worked_;
}

/// The queue whose first job is to be begun now, if any is.
WorkerPool::Queue* WorkerPool::next() {
    const bool held = longRunning_ + 1 >= count_ && longRunning_ > 0 && Clock::now() - lastShort_ < kActive;
    if (long_.empty() || held) return short_.empty() ? nullptr : &short_;
    return short_.empty() || long_.begin()->first < short_.begin()->first ? &long_ : &short_;
}

void WorkerPool::run(const Job& first) {
    picture::Painter painter;
    carryOut(first, painter);
    std::unique_lock lock(mutex_);
    bool untidy = true;
    while (!stopping_) {
        Queue* const queue = next();
        if (queue == nullptr) {
            wait(lock, untidy, painter);
            continue;
        }
        untidy = true;
        Entry entry = std::move(queue->begin()->second);
        now_ = std::max(now_, queue->begin()->first);
        queue->erase(queue->begin());
        const bool isLong = queue == &long_;
        longRunning_ += isLong ? 1 : 0;
        lock.unlock();
        const auto start = Clock::now();
        {
            const geometry::Companion::Work work;
            carryOut(entry.job, painter);
        }
        entry.job = nullptr;  // what it owns is let go outside the lock
        const Seconds took = Clock::now() - start;
        lock.lock();
        longRunning_ -= isLong ? 1 : 0;
        finish(entry, took);
        if (!long_.empty()) wake_.notify_one();
    }
}

/// Waits for a job. A long one that is held back may begin when the short ones have been gone for long enough; and when
/// nothing comes for a while after a burst, its memory goes back to the system.
void WorkerPool::wait(std::unique_lock<std::mutex>& lock, bool& untidy, picture::Painter& painter) {
    if (!long_.empty()) {
        wake_.wait_for(lock, kActive);
        return;
    }
    if (!untidy && !litter_) return wake_.wait(lock);
    if (wake_.wait_for(lock, picture::Painter::kPause) == std::cv_status::no_timeout) return;
    untidy = litter_ = false;
    lock.unlock();
    painter.forget();
    lock.lock();
}

void WorkerPool::finish(const Entry& entry, Seconds took) {
    worked_ += took;
    entry.lane->due_ += took - entry.expected;
    entry.lane->expected_ = (entry.lane->expected_ + took) / 2;
}

}  // namespace oval4d::net
