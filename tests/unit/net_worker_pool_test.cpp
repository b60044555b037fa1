// In which order jobs are carried out.

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "net/worker_pool.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

class WorkerPools : public testing::Test {
  protected:
    using Lane = WorkerPool::LanePtr;

    static Lane lane() { return std::make_shared<WorkerPool::Lane>(); }

    static WorkerPool::Job busy(std::chrono::milliseconds time) {
        return [time](picture::Painter&) { std::this_thread::sleep_for(time); };
    }

    /// A job that writes its name down.
    WorkerPool::Job saying(std::string name) {
        return [this, name](picture::Painter&) {
            const std::lock_guard lock(mutex_);
            said_.push_back(name);
        };
    }

    /// Waits until all that was posted in these lanes before has been carried out.
    static void drain(WorkerPool& pool, const std::vector<Lane>& lanes) {
        for (const Lane& each : lanes) {
            std::promise<void> done;
            pool.post([&done](picture::Painter&) { done.set_value(); }, each);
            done.get_future().wait();
        }
    }

    std::vector<std::string> said() {
        const std::lock_guard lock(mutex_);
        return said_;
    }

  private:
    std::mutex mutex_;
    std::vector<std::string> said_;
};

/// A worker that is kept busy until it is let go. The job holds what it needs: it may end after the gate.
class Gate {
  public:
    WorkerPool::Job job() {
        return [begun = begun_, opened = opened_](picture::Painter&) {
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

TEST_F(WorkerPools, JobsOfOneLaneKeepTheirOrder) {
    WorkerPool pool(1, [](picture::Painter&) {});
    const Lane one = lane();
    for (int i = 0; i < 20; ++i) pool.post(saying(std::to_string(i)), one);
    drain(pool, {one});
    const auto order = said();
    ASSERT_EQ(order.size(), 20U);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], std::to_string(i));
}

TEST_F(WorkerPools, WhoHasHadLessTimeIsNext) {
    WorkerPool pool(1, [](picture::Painter&) {});
    const Lane greedy = lane(), modest = lane(), other = lane();
    for (int i = 0; i < 3; ++i) pool.post(busy(5ms), greedy);
    drain(pool, {greedy});
    Gate gate;
    pool.post(gate.job(), other);
    gate.awaitBegun();
    for (int i = 0; i < 3; ++i) pool.post(saying("greedy"), greedy);
    pool.post(saying("modest"), modest);
    gate.open();
    drain(pool, {modest, greedy});
    EXPECT_EQ(said(), (std::vector<std::string>{"modest", "greedy", "greedy", "greedy"}));
}

TEST_F(WorkerPools, LongJobsLeaveAWorkerToShortOnes) {
    WorkerPool pool(2, [](picture::Painter&) {});
    const Lane one = lane(), two = lane(), quick = lane();
    for (const Lane& each : {one, two}) {
        for (int i = 0; i < 3; ++i) pool.post(busy(40ms), each);
    }
    drain(pool, {one, two});
    Gate gate;
    pool.post(saying("quick"), quick);
    pool.post(gate.job(), one);
    gate.awaitBegun();
    pool.post(saying("long"), two);  // one worker is free, but kept
    for (int i = 0; i < 5; ++i) {
        pool.post(saying("quick"), quick);
        drain(pool, {quick});
    }
    EXPECT_EQ(said(), std::vector<std::string>(6, "quick"));
    gate.open();
    drain(pool, {two});
    EXPECT_EQ(said().back(), "long");
}

TEST_F(WorkerPools, LongJobsUseAllWorkersWhenNobodyElseIsThere) {
    WorkerPool pool(2, [](picture::Painter&) {});
    const Lane one = lane(), two = lane();
    for (const Lane& each : {one, two}) {
        for (int i = 0; i < 3; ++i) pool.post(busy(40ms), each);
    }
    drain(pool, {one, two});
    Gate first, second;
    pool.post(first.job(), one);
    pool.post(second.job(), two);
    first.awaitBegun();
    second.awaitBegun();  // both run at once, or this test does not end
    first.open();
    second.open();
}

TEST_F(WorkerPools, StopDropsWhatWaits) {
    WorkerPool pool(1, [](picture::Painter&) {});
    Gate gate;
    pool.post(gate.job());
    gate.awaitBegun();
    for (int i = 0; i < 5; ++i) pool.post(saying("dropped"));
    EXPECT_EQ(pool.waiting(), 5U);
    std::thread stopping([&] { pool.stop(); });
    while (!pool.stopToken().stop_requested()) std::this_thread::yield();
    while (pool.waiting() > 0) std::this_thread::yield();
    gate.open();
    stopping.join();
    pool.post(saying("too late"));
    EXPECT_TRUE(said().empty());
}

}  // namespace
}  // namespace oval4d::net
