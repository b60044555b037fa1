#pragma once
// The threads that slice and draw.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "picture/painter.hpp"

namespace oval4d::net {

/// Jobs that wait, and threads that carry them out, each with a painter of its own for life. The pool's time is shared
/// out fairly: jobs are posted in lanes, one for each session, and the job of the lane that has had the least time is
/// next (start-time fair queueing: P. Goyal, H. Vin, H. Cheng, 1997). A job once begun is not interrupted; so while
/// lanes with short jobs are active, one thread is kept free of the long ones. The queue is bounded by those who post:
/// a session has one picture in it at most, a connection one request.
class WorkerPool {
  public:
    using Job = std::function<void(picture::Painter&)>;
    using Seconds = std::chrono::duration<double>;

    /// Whose jobs take turns with those of other lanes. Belongs to one pool.
    class Lane {
        friend WorkerPool;
        Seconds due_{0};       // on the pool's clock: when the lane has had its share
        Seconds expected_{0};  // of its next job, by the last ones
    };
    using LanePtr = std::shared_ptr<Lane>;

    /// A job expected to take longer than this is a long one.
    static constexpr Seconds kLong{0.015};

    /// Each thread carries out `first` before any other job.
    WorkerPool(std::size_t threads, Job first);
    ~WorkerPool();

    /// A job must not throw, but picture::GivenUp after `stop`. After `stop` it is dropped. All jobs without a lane
    /// share one.
    void post(Job job, LanePtr lane = nullptr);

    /// Has memory that was let go of elsewhere given back to the system when there has been no job for a while, as that
    /// of jobs is.
    void tidyLater();

    /// Finishes the jobs that are running, or lets them give up, and drops the others.
    void stop();

    /// Asks long jobs to end, from `stop` on.
    std::stop_token stopToken() const { return stopSource_.get_token(); }

    std::size_t size() const { return threads_.size(); }
    std::size_t waiting() const;
    /// The time spent on jobs, of all threads together.
    Seconds worked() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Entry {
        Job job;
        LanePtr lane;
        Seconds expected;
    };
    using Queue = std::multimap<Seconds, Entry>;  // by the time on the pool's clock at which it is due; equals in order

    void run(const Job& first);
    Queue* next();
    void wait(std::unique_lock<std::mutex>& lock, bool& untidy, picture::Painter& painter);
    void finish(const Entry& entry, Seconds took);

    const std::size_t count_;
    const LanePtr common_ = std::make_shared<Lane>();  // of jobs without a lane
    std::stop_source stopSource_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Guarded by mutex_, as lanes are.
    Queue short_, long_;
    Seconds now_{0};  // the pool's clock: the due time of the job begun last
    Seconds worked_{0};
    std::size_t longRunning_ = 0;
    Clock::time_point lastShort_;  // when a short job was last posted
    bool litter_ = false;          // see tidyLater
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace oval4d::net
