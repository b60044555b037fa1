// Tests of the pool of threads that run jobs.

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "parallel/canceled.hpp"
#include "parallel/worker_pool.hpp"
#include "unit/parallel/virtual_clock.hpp"

namespace oval4d::parallel {
namespace {

using namespace std::chrono_literals;

class WorkerPools : public testing::Test {
  protected:
    using JobQueue = WorkerPool::JobQueuePtr;

    static JobQueue jobQueue() {
        return std::make_shared<WorkerPool::JobQueue>(std::make_shared<WorkerPool::ClientFlow>());
    }

    static void post(WorkerPool& pool, WorkerPool::Job job, const JobQueue& in, WorkerPool::Seconds cost = 1ms) {
        EXPECT_TRUE(pool.post(std::move(job), in, cost));
    }

    /// Returns the options of a pool in which only the jobs of busy() take (virtual) time.
    WorkerPool::PoolOptions options(std::size_t threads) const {
        return {.threads = threads, .now = clock_.now<FairQueue::Clock>()};
    }

    WorkerPool::Job busy(std::chrono::milliseconds time) {
        return [this, time](std::size_t) { clock_.advance(time); };
    }

    /// Returns a job that records the name `name`.
    WorkerPool::Job saying(std::string name) {
        return [this, name](std::size_t) {
            const std::lock_guard lock(mutex_);
            said_.push_back(name);
        };
    }

    /// Waits until all jobs that were posted so far in these job queues have ended.
    static void drain(WorkerPool& pool, const std::vector<JobQueue>& jobQueues) {
        for (const JobQueue& each : jobQueues) {
            std::promise<void> done;
            post(pool, [&done](std::size_t) { done.set_value(); }, each);
            done.get_future().wait();
        }
    }

    std::vector<std::string> said() {
        const std::lock_guard lock(mutex_);
        return said_;
    }

  private:
    support::VirtualClock clock_;
    std::mutex mutex_;
    std::vector<std::string> said_;
};

/// A gate that keeps a worker busy until it is opened. The job shares the state of the gate, so it may outlive the
/// gate.
class Gate {
  public:
    WorkerPool::Job job() {
        return [begun = begun_, opened = opened_](std::size_t) {
            begun->set_value();
            opened.wait();
        };
    }
    void awaitBegun() { begun_->get_future().wait(); }
    void open() { open_.set_value(); }

  private:
    const std::shared_ptr<std::promise<void>> begun_ = std::make_shared<std::promise<void>>();
    std::promise<void> open_;
    const std::shared_future<void> opened_ = open_.get_future().share();
};

TEST_F(WorkerPools, JobsAreCarriedOutInTurn) {
    WorkerPool pool(options(1));
    const JobQueue greedy = jobQueue(), modest = jobQueue(), other = jobQueue();
    Gate gate;
    post(pool, gate.job(), other);
    gate.awaitBegun();
    for (int i = 0; i < 3; ++i) post(pool, saying("greedy"), greedy, 5ms);
    post(pool, saying("modest"), modest, 4ms);
    gate.open();
    drain(pool, {modest, greedy});
    EXPECT_EQ(said(), (std::vector<std::string>{"modest", "greedy", "greedy", "greedy"}));
}

TEST_F(WorkerPools, EachWorkerHasANumberAndBeginsWithTheFirstJob) {
    std::mutex mutex;
    std::vector<std::size_t> begun;
    WorkerPool pool({.threads = 2, .onThreadStart = [&](std::size_t worker) {
                         const std::lock_guard lock(mutex);
                         begun.push_back(worker);
                     }});
    Gate one, two;
    post(pool, one.job(), jobQueue());
    post(pool, two.job(), jobQueue());
    one.awaitBegun();
    two.awaitBegun();  // both workers are now busy
    {
        const std::lock_guard lock(mutex);
        std::ranges::sort(begun);
        EXPECT_EQ(begun, (std::vector<std::size_t>{0, 1}));
    }
    one.open();
    two.open();
}

TEST_F(WorkerPools, CanceledJobsDoNoHarm) {
    WorkerPool pool(options(1));
    const JobQueue each = jobQueue();
    post(pool, [](std::size_t) { throw Canceled(); }, each);
    post(pool, saying("next"), each);
    drain(pool, {each});
    EXPECT_EQ(said(), std::vector<std::string>{"next"});
}

TEST_F(WorkerPools, LongJobsLeaveAWorkerToShortOnes) {
    WorkerPool pool(options(2));
    const JobQueue one = jobQueue(), two = jobQueue(), quick = jobQueue();
    post(pool, saying("quick"), quick);
    drain(pool, {quick});
    Gate gate;
    post(pool, gate.job(), one, 1s);
    gate.awaitBegun();
    post(pool, saying("long"), two, 1s);  // the second worker is free, but reserved for short jobs
    for (int i = 0; i < 5; ++i) {
        post(pool, saying("quick"), quick);
        drain(pool, {quick});
    }
    EXPECT_EQ(said(), std::vector<std::string>(6, "quick"));
    gate.open();
    while (said().size() < 7) std::this_thread::yield();
    EXPECT_EQ(said().back(), "long");
}

TEST_F(WorkerPools, LongJobsUseAllWorkersWhenNobodyElseIsThere) {
    WorkerPool pool(options(2));
    Gate first, second;
    post(pool, first.job(), jobQueue(), 200ms);
    post(pool, second.job(), jobQueue(), 200ms);
    first.awaitBegun();
    second.awaitBegun();  // returns only if both jobs run at the same time
    first.open();
    second.open();
}

/// If the jobs of a job queue took longer than estimated, the pool corrects the estimates of its next jobs.
TEST_F(WorkerPools, LearnsHowLongJobsTake) {
    WorkerPool pool(options(2));
    const JobQueue slow = jobQueue(), other = jobQueue(), quick = jobQueue();
    for (int i = 1; i <= 10; ++i) {
        post(pool, busy(100ms), slow, 20ms);
        while (pool.busyTime() < (i - 0.5) * 100ms) std::this_thread::yield();
    }
    post(pool, saying("quick"), quick);
    drain(pool, {quick});
    Gate gate;
    post(pool, gate.job(), other, 1s);
    gate.awaitBegun();
    post(pool, saying("slow"), slow, 20ms);
    post(pool, saying("quick"), quick);
    drain(pool, {quick});
    EXPECT_EQ(said(), (std::vector<std::string>{"quick", "quick"}));
    gate.open();
    while (said().size() < 3) std::this_thread::yield();
    EXPECT_EQ(said().back(), "slow");
}

TEST_F(WorkerPools, RefusesMoreThanMayWait) {
    WorkerPool pool({.threads = 1, .limits = {3, 2}});
    Gate gate;
    post(pool, gate.job(), jobQueue());
    gate.awaitBegun();
    const JobQueue greedy = jobQueue(), others = jobQueue();
    post(pool, saying("greedy"), greedy);
    post(pool, saying("greedy"), greedy);
    EXPECT_FALSE(pool.post(saying("refused"), greedy, 1ms));
    post(pool, saying("other"), others);
    EXPECT_FALSE(pool.post(saying("refused"), others, 1ms));
    gate.open();
    while (pool.waitingJobCount() > 0) std::this_thread::yield();
    post(pool, saying("other"), others);
    drain(pool, {greedy, others});
    EXPECT_EQ(said().size(), 4U);
    EXPECT_EQ(std::ranges::count(said(), "refused"), 0);
}

TEST_F(WorkerPools, StopDropsWhatWaits) {
    WorkerPool pool(options(1));
    Gate gate;
    post(pool, gate.job(), nullptr);
    gate.awaitBegun();
    for (int i = 0; i < 5; ++i) post(pool, saying("dropped"), nullptr);
    EXPECT_EQ(pool.waitingJobCount(), 5U);
    std::thread stopping([&] { pool.stop(); });
    while (!pool.stopToken().stop_requested()) std::this_thread::yield();
    while (pool.waitingJobCount() > 0) std::this_thread::yield();
    gate.open();
    stopping.join();
    post(pool, saying("too late"), nullptr);
    EXPECT_TRUE(said().empty());
}

}  // namespace
}  // namespace oval4d::parallel
