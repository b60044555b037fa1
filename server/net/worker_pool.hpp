#pragma once
// The threads that slice and draw.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "picture/painter.hpp"

namespace oval4d::net {

/// A queue of jobs and threads that carry them out, each with a painter of its own for life. Its length is bounded by
/// those who post: a session has one job in it at most, a connection one request.
class WorkerPool {
  public:
    using Job = std::function<void(picture::Painter&)>;

    /// 0 threads: one a core. Each carries out `first` before any other job.
    WorkerPool(int threads, Job first);
    ~WorkerPool();

    /// A job must not throw. After `stop` it is dropped.
    void post(Job job);

    /// Finishes the jobs that are running and drops the others.
    void stop();

    /// Asks long jobs to end, from `stop` on.
    std::stop_token stopToken() const { return stopSource_.get_token(); }

    std::size_t size() const { return threads_.size(); }
    std::size_t waiting() const;
    /// The time spent on jobs, of all threads together.
    std::chrono::nanoseconds worked() const { return std::chrono::nanoseconds(worked_); }

  private:
    void run(const Job& first);

    std::stop_source stopSource_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Job> jobs_;   // guarded by mutex_
    bool stopping_ = false;  // guarded by mutex_
    std::atomic<std::int64_t> worked_ = 0;
    std::vector<std::thread> threads_;
};

}  // namespace oval4d::net
