// Whose turn is next, in virtual time: jobs take as long as a test says.

#include "parallel/fair_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace oval4d::parallel {
namespace {

using namespace std::chrono_literals;
using Seconds = FairQueue::Seconds;
using Clock = FairQueue::Clock;
using LanePtr = FairQueue::LanePtr;

FairQueue::ClientPtr newClient() { return std::make_shared<FairQueue::Client>(); }
LanePtr newLane(const FairQueue::ClientPtr& client = newClient()) { return std::make_shared<FairQueue::Lane>(client); }

/// A pool whose clock and threads are these variables.
class Simulation {
  public:
    explicit Simulation(std::size_t threads, FairQueue::Limits limits = {}) : queue_(threads, limits), free_(threads) {}

    /// A job that is thought to take `estimate`, and takes `takes`; then it calls `done`.
    bool post(const LanePtr& lane, Seconds estimate, Seconds takes, std::function<void()> done = {}) {
        const auto job = [this, lane, takes, done = std::move(done)](std::size_t) { begun_ = {takes, done, lane}; };
        return queue_.push(job, lane, estimate, time());
    }
    bool post(const LanePtr& lane, Seconds takes, std::function<void()> done = {}) {
        return post(lane, takes, takes, std::move(done));
    }
    /// Something else that happens then.
    void at(Seconds when, std::function<void()> act) { events_.emplace(when, std::move(act)); }

    void run(Seconds until) {
        for (;;) {
            begin();
            if (events_.empty() || events_.begin()->first > until) break;
            now_ = events_.begin()->first;
            const auto act = std::move(events_.begin()->second);
            events_.erase(events_.begin());
            act();
        }
        now_ = until;
    }

    Seconds now() const { return now_; }
    std::size_t waiting() const { return queue_.waiting(); }
    Seconds usedBy(const LanePtr& lane) const { return used_.contains(lane.get()) ? used_.at(lane.get()) : Seconds(0); }
    std::size_t running() const { return running_; }
    /// Of all threads together, with jobs that are done.
    Seconds busy() const {
        Seconds sum{0};
        for (const auto& [lane, used] : used_) sum += used;
        return sum;
    }

  private:
    struct Job {
        Seconds takes{0};
        std::function<void()> done;
        LanePtr lane;
    };

    Clock::time_point time() const { return Clock::time_point(std::chrono::duration_cast<Clock::duration>(now_)); }

    void begin() {
        while (running_ < free_) {
            auto next = queue_.pop(time());
            if (!next) return;
            next->job(0);
            ++running_;
            at(now_ + begun_.takes, [this, begun = std::make_shared<FairQueue::Begun>(*next), job = begun_] {
                --running_;
                used_[job.lane.get()] += job.takes;
                queue_.finished(*begun, job.takes);
                if (job.done) job.done();
            });
        }
    }

    FairQueue queue_;
    const std::size_t free_;
    std::size_t running_ = 0;
    Seconds now_{0};
    std::multimap<Seconds, std::function<void()>> events_;
    std::map<const FairQueue::Lane*, Seconds> used_;
    Job begun_;
};

/// Posts one job after the other, each as soon as the one before is done.
void always(Simulation& in, const LanePtr& lane, Seconds takes) {
    EXPECT_TRUE(in.post(lane, takes, [&in, lane, takes] { always(in, lane, takes); }));
}

/// As always, but each job in a lane of its own: a session for each picture.
void alwaysNew(Simulation& in, const FairQueue::ClientPtr& client, Seconds takes) {
    EXPECT_TRUE(in.post(newLane(client), takes, [&in, client, takes] { alwaysNew(in, client, takes); }));
}

/// How long jobs of this length wait and take that come one every `period`, until `until`.
class Latencies {
  public:
    Latencies(Simulation& in, LanePtr lane, Seconds takes, Seconds period, Seconds until) : takes_(takes) {
        for (Seconds when = in.now() + period; when < until; when += period) {
            in.at(when, [this, &in, lane, when] {
                EXPECT_TRUE(in.post(lane, takes_, [this, &in, when] { all_.push_back(in.now() - when); }));
            });
        }
    }
    Seconds worst() const { return *std::ranges::max_element(all_); }
    Seconds median() const {
        auto sorted = all_;
        std::ranges::sort(sorted);
        return sorted[sorted.size() / 2];
    }
    std::size_t count() const { return all_.size(); }

  private:
    const Seconds takes_;
    std::vector<Seconds> all_;
};

TEST(FairQueue, JobsOfOneLaneKeepTheirOrder) {
    Simulation pool(1);
    const LanePtr lane = newLane();
    std::vector<int> order;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(pool.post(lane, i % 3 == 0 ? 50ms : 5ms, [&order, i] { order.push_back(i); }));
    }
    pool.run(10s);
    ASSERT_EQ(order.size(), 20U);
    EXPECT_TRUE(std::ranges::is_sorted(order));
}

TEST(FairQueue, WhoHasHadLessIsNext) {
    Simulation pool(1);
    const LanePtr greedy = newLane(), modest = newLane();
    std::vector<std::string> order;
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(pool.post(greedy, 5ms, [&order] { order.emplace_back("greedy"); }));
    }
    pool.at(12ms, [&] { EXPECT_TRUE(pool.post(modest, 5ms, [&order] { order.emplace_back("modest"); })); });
    pool.run(1s);
    EXPECT_EQ(order, (std::vector<std::string>{"greedy", "greedy", "greedy", "modest", "greedy", "greedy"}));
}

/// Whoever opens a session for each picture is not ahead of those who keep theirs.
TEST(FairQueue, NewLanesAreNotAhead) {
    for (const bool same : {false, true}) {
        Simulation pool(1);
        const FairQueue::ClientPtr mine = newClient();
        const LanePtr kept = newLane(mine);
        for (int i = 0; i < 6; ++i) alwaysNew(pool, same ? mine : newClient(), 14ms);
        const Latencies seen(pool, kept, 2800us, 103ms, 20s);
        pool.run(20s);
        EXPECT_GE(seen.count(), 190U);
        EXPECT_LE(seen.worst(), 30.8ms + 1us);  // the job that runs, one that was about to be begun, and its own
        EXPECT_LE(seen.median(), 24.1ms);
    }
}

/// Nor with jobs so long that they are of the other class, where one thread has to serve both.
TEST(FairQueue, NewLanesWithLongJobsAreNotAhead) {
    Simulation pool(1);
    for (int i = 0; i < 6; ++i) alwaysNew(pool, newClient(), 25ms);
    const Latencies seen(pool, newLane(), 5ms, 103ms, 20s);
    pool.run(20s);
    EXPECT_GE(seen.count(), 190U);
    EXPECT_LE(seen.worst(), 80ms + 1us);  // the job that runs, two that were about to be begun, and its own
}

/// Also where the jobs turn out longer than they were thought to be, again and again.
TEST(FairQueue, NewLanesAreChargedByWhatTheirClientsTook) {
    Simulation pool(1);
    const FairQueue::ClientPtr attacker = newClient();
    std::function<void()> again = [&] { EXPECT_TRUE(pool.post(newLane(attacker), 4ms, 28ms, again)); };
    for (int i = 0; i < 6; ++i) again();
    const Latencies seen(pool, newLane(), 5ms, 103ms, 20s);
    pool.run(20s);
    EXPECT_GE(seen.count(), 190U);
    EXPECT_LE(seen.worst(), 61ms + 1us);
    EXPECT_LE(seen.median(), 47ms);
}

TEST(FairQueue, ClientsShareEquallyHoweverManySessionsTheyHave) {
    for (const Seconds takes : {Seconds(10ms), Seconds(200ms)}) {
        Simulation pool(2);
        const FairQueue::ClientPtr many = newClient();
        const LanePtr one = newLane();
        std::vector<LanePtr> lanes;
        for (int i = 0; i < 100; ++i) lanes.push_back(newLane(many));
        for (const LanePtr& each : lanes) always(pool, each, takes);
        for (int i = 0; i < 4; ++i) always(pool, one, takes);
        pool.run(200s);
        EXPECT_NEAR(pool.usedBy(one).count(), 200, 10);
        const auto least = std::ranges::min(lanes, {}, [&](const LanePtr& each) { return pool.usedBy(each); });
        const auto most = std::ranges::max(lanes, {}, [&](const LanePtr& each) { return pool.usedBy(each); });
        EXPECT_LE(pool.usedBy(most) - pool.usedBy(least), 2 * takes);
    }
}

TEST(FairQueue, SessionsShareEquallyByTimeNotByJobs) {
    Simulation pool(1);
    const FairQueue::ClientPtr client = newClient();
    const LanePtr small = newLane(client), large = newLane(client);
    for (int i = 0; i < 4; ++i) {
        always(pool, small, 2ms);
        always(pool, large, 25ms);
    }
    pool.run(60s);
    EXPECT_NEAR(pool.usedBy(small).count(), 30, 1);
    EXPECT_NEAR(pool.usedBy(large).count(), 30, 1);
}

/// Ten clients flood the pool with short jobs: a long job is begun all the same, and others of it follow.
TEST(FairQueue, LongJobsAreNotStarved) {
    for (const std::size_t threads : {1U, 2U, 4U}) {
        Simulation pool(threads);
        for (int i = 0; i < 10; ++i) {
            const FairQueue::ClientPtr each = newClient();
            for (int k = 0; k < 8; ++k) alwaysNew(pool, each, 10ms);
        }
        pool.run(5s);
        const LanePtr lane = newLane();
        Seconds done{0};
        ASSERT_TRUE(pool.post(lane, 1s, [&] { done = pool.now(); }));
        pool.run(30s);
        EXPECT_GT(done, 0s);
        EXPECT_LE(done, 5s + 11s + 1s);  // ten others have as much first, at worst on one thread
    }
}

/// Nor are they by other long ones, while somebody's short ones keep a thread for themselves.
TEST(FairQueue, ALongJobOfANewClientWaitsForOneOfEachOtherAtMost) {
    Simulation pool(2);
    for (int i = 0; i < 4; ++i) {
        const FairQueue::ClientPtr each = newClient();
        for (int k = 0; k < 5; ++k) always(pool, newLane(each), 1s);
    }
    const Latencies seen(pool, newLane(), 10ms, 20ms, 199s);
    pool.run(100s);
    Seconds done{0};
    ASSERT_TRUE(pool.post(newLane(), 1s, [&] { done = pool.now(); }));
    pool.run(200s);
    EXPECT_GT(done, 0s);
    EXPECT_LE(done, 100s + 7s);
    EXPECT_LE(seen.worst(), 1s + 20ms);  // only at the start, before anybody knew of short jobs
}

TEST(FairQueue, AThreadIsKeptForShortJobsWhileSomebodyHasSome) {
    for (const std::size_t threads : {2U, 3U, 8U, 16U}) {
        Simulation pool(threads);
        const LanePtr quick = newLane();
        ASSERT_TRUE(pool.post(quick, 5ms));
        pool.run(10ms);
        for (int i = 0; i < 40; ++i) always(pool, newLane(), 2s);  // nothing was learned of these lanes yet
        const Latencies seen(pool, quick, 5ms, 500ms, 30s);
        pool.run(30s);
        EXPECT_GE(seen.count(), 58U);
        EXPECT_LE(seen.worst(), 5ms + 1us);
        EXPECT_EQ(pool.running(), threads - std::max<std::size_t>(1, threads / 4));
    }
}

TEST(FairQueue, LongJobsHaveAllThreadsWhenNobodyElseIsThere) {
    Simulation pool(4);
    LanePtr quick = newLane(), leaving = newLane();
    ASSERT_TRUE(pool.post(quick, 5ms));
    ASSERT_TRUE(pool.post(leaving, 5ms));
    for (int i = 0; i < 8; ++i) always(pool, newLane(), 100ms);
    pool.run(5s);
    EXPECT_EQ(pool.running(), 3U);
    pool.run(Seconds(FairQueue::kActive) + 1s);
    EXPECT_EQ(pool.running(), 4U);
    ASSERT_TRUE(pool.post(quick, 5ms));
    pool.run(pool.now() + 1s);
    EXPECT_EQ(pool.running(), 3U);
    quick = nullptr;  // the session is closed
    pool.run(pool.now() + 1s);
    EXPECT_EQ(pool.running(), 4U);
}

/// A visitor does not wait for jobs of seconds, though no short ones came before.
TEST(FairQueue, VeryLongJobsAlwaysLeaveAThread) {
    for (const std::size_t threads : {2U, 16U}) {
        Simulation pool(threads);
        for (int i = 0; i < 40; ++i) always(pool, newLane(), 2s);
        const Latencies seen(pool, newLane(), 5ms, 30s, 300s);
        pool.run(301s);
        EXPECT_EQ(seen.count(), 9U);
        EXPECT_LE(seen.worst(), 5ms + 1us);
    }
    Simulation one(1);  // which does all there is
    for (int i = 0; i < 4; ++i) always(one, newLane(), 2s);
    one.run(100s);
    EXPECT_NEAR(one.busy().count(), 100, 2);
}

/// One job that something disturbed makes no long one of the next.
TEST(FairQueue, SurprisesAreNotTakenForTheRule) {
    Simulation pool(2);
    const LanePtr quick = newLane();
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(pool.post(quick, 8ms));
    ASSERT_TRUE(pool.post(quick, 8ms, 800ms));
    pool.run(1s);
    for (int i = 0; i < 20; ++i) always(pool, newLane(), 2s);
    pool.run(2s);
    const Latencies seen(pool, quick, 8ms, 100ms, 20s);
    pool.run(20s);
    EXPECT_LE(seen.worst(), 8ms + 1us);
}

TEST(FairQueue, ShortJobsOfALaneWithLongOnesKeepNoThread) {
    Simulation pool(2);
    for (int i = 0; i < 4; ++i) {
        const LanePtr lane = newLane();
        always(pool, lane, 100ms);
        always(pool, lane, 1ms);
    }
    pool.run(10s);
    EXPECT_NEAR(pool.busy().count(), 20, 0.2);
}

/// After an hour of silence a lane has its turn like a new one, and no more.
TEST(FairQueue, TimeIsNotSavedUp) {
    Simulation pool(1);
    const LanePtr silent = newLane(), busy = newLane();
    ASSERT_TRUE(pool.post(silent, 10ms));
    for (int i = 0; i < 3; ++i) always(pool, busy, 10ms);
    pool.run(3600s);
    const Seconds before = pool.usedBy(busy);
    for (int i = 0; i < 3; ++i) always(pool, silent, 10ms);
    pool.run(3610s);
    EXPECT_NEAR((pool.usedBy(busy) - before).count(), 5, 0.1);
}

/// Nor are debts for ever: after a pause of all, who had all the time before has his share again.
TEST(FairQueue, NobodyOwesWhenNobodyWaits) {
    Simulation pool(1);
    const LanePtr one = newLane(), other = newLane();
    ASSERT_TRUE(pool.post(other, 10ms));
    ASSERT_TRUE(pool.post(one, 10ms, 1000s));  // estimated badly
    pool.run(2000s);
    for (int i = 0; i < 3; ++i) {
        always(pool, one, 10ms);
        always(pool, other, 10ms);
    }
    pool.run(2010s);
    EXPECT_NEAR(pool.usedBy(one).count(), 1005, 0.5);
    EXPECT_NEAR(pool.usedBy(other).count(), 5, 0.5);
}

/// A long job that waits for its turn earns its client no lead for short ones.
TEST(FairQueue, WaitingWithLongJobsGivesNoLeadForShortOnes) {
    Simulation pool(2);
    const LanePtr victim = newLane();
    std::vector<FairQueue::ClientPtr> attackers;
    for (int i = 0; i < 10; ++i) {
        attackers.push_back(newClient());
        for (int k = 0; k < 3; ++k) always(pool, newLane(attackers.back()), 1s);
    }
    const Latencies warm(pool, victim, 5ms, 50ms, 60s);
    pool.run(60s);
    for (const FairQueue::ClientPtr& each : attackers) {
        for (int k = 0; k < 20; ++k) always(pool, newLane(each), 5ms);
    }
    const Latencies seen(pool, victim, 5ms, 1s, 90s);
    pool.run(100s);
    EXPECT_EQ(seen.count(), 29U);
    EXPECT_LE(seen.worst(), 2 * 11 * 5ms);  // two jobs of each, not a second of them
}

TEST(FairQueue, MoreThanMayWaitAreRefused) {
    Simulation pool(1, {10, 4});
    const FairQueue::ClientPtr greedy = newClient();
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(pool.post(newLane(greedy), 10ms));
    EXPECT_FALSE(pool.post(newLane(greedy), 10ms));
    for (int i = 0; i < 6; ++i) EXPECT_TRUE(pool.post(newLane(), 10ms));
    EXPECT_FALSE(pool.post(newLane(), 10ms));
    EXPECT_EQ(pool.waiting(), 10U);
    pool.run(1s);
    EXPECT_EQ(pool.waiting(), 0U);
    EXPECT_TRUE(pool.post(newLane(greedy), 10ms));
}

TEST(FairQueue, ClearsWithAllThatWaits) {
    FairQueue queue(1, {});
    const LanePtr lane = newLane();
    auto owned = std::make_shared<int>(1);
    const auto job = [owned](std::size_t) {};
    EXPECT_TRUE(queue.push(job, lane, 1ms, {}));
    EXPECT_TRUE(queue.push(job, lane, 1s, {}));
    EXPECT_TRUE(queue.push(job, newLane(), 1s, {}));
    EXPECT_EQ(queue.clear().size(), 3U);
    EXPECT_EQ(owned.use_count(), 2);  // here, and in `job`
    EXPECT_EQ(queue.waiting(), 0U);
    EXPECT_FALSE(queue.pop({}));
    EXPECT_TRUE(queue.push(job, lane, 1ms, {}));
    EXPECT_TRUE(queue.pop({}));
}

}  // namespace
}  // namespace oval4d::parallel
