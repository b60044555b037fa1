// Tests of weighted fair queueing, simulated in virtual time: a job takes as long as the test says.

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
using JobQueuePtr = FairQueue::JobQueuePtr;

FairQueue::ClientFlowPtr newClient() { return std::make_shared<FairQueue::ClientFlow>(); }
JobQueuePtr newJobQueue(const FairQueue::ClientFlowPtr& client = newClient()) {
    return std::make_shared<FairQueue::JobQueue>(client);
}

/// A simulated pool of threads with a virtual clock.
class Simulation {
  public:
    explicit Simulation(std::size_t threads, FairQueue::Limits limits = {}) : queue_(threads, limits), free_(threads) {}

    /// Posts a job with an estimated and an actual duration. Calls `done` when the job ends. Returns false if the job
    /// is refused.
    bool post(const JobQueuePtr& jobQueue, Seconds estimate, Seconds takes, std::function<void()> done = {}) {
        const auto job = [this, jobQueue, takes, done = std::move(done)](std::size_t) {
            begun_ = {takes, done, jobQueue};
        };
        return queue_.push(job, jobQueue, estimate, time());
    }
    bool post(const JobQueuePtr& jobQueue, Seconds takes, std::function<void()> done = {}) {
        return post(jobQueue, takes, takes, std::move(done));
    }
    /// Schedules a call of `act` at the virtual time `when`.
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
    std::size_t waitingJobCount() const { return queue_.waitingJobCount(); }
    Seconds usedBy(const JobQueuePtr& jobQueue) const {
        return used_.contains(jobQueue.get()) ? used_.at(jobQueue.get()) : Seconds(0);
    }
    std::size_t running() const { return running_; }
    /// Returns the time that all threads together have spent on completed jobs.
    Seconds busy() const {
        Seconds sum{0};
        for (const auto& [jobQueue, used] : used_) sum += used;
        return sum;
    }

  private:
    struct Job {
        Seconds takes{0};
        std::function<void()> done;
        JobQueuePtr jobQueue;
    };

    Clock::time_point time() const { return Clock::time_point(std::chrono::duration_cast<Clock::duration>(now_)); }

    void begin() {
        while (running_ < free_) {
            auto next = queue_.popStartableJob(time());
            if (!next) return;
            next->job(0);
            ++running_;
            at(now_ + begun_.takes, [this, begun = std::make_shared<FairQueue::StartableJob>(*next), job = begun_] {
                --running_;
                used_[job.jobQueue.get()] += job.takes;
                queue_.recordJobEnd(*begun, job.takes);
                if (job.done) job.done();
            });
        }
    }

    FairQueue queue_;
    const std::size_t free_;
    std::size_t running_ = 0;
    Seconds now_{0};
    std::multimap<Seconds, std::function<void()>> events_;
    std::map<const FairQueue::JobQueue*, Seconds> used_;
    Job begun_;
};

/// Posts jobs of the duration `takes` to a job queue forever: each as soon as the previous one ends.
void always(Simulation& in, const JobQueuePtr& jobQueue, Seconds takes) {
    EXPECT_TRUE(in.post(jobQueue, takes, [&in, jobQueue, takes] { always(in, jobQueue, takes); }));
}

/// Posts jobs of the duration `takes` forever, each in a new job queue, like a client that opens a session for each
/// picture. Each job is posted as soon as the previous one ends.
void alwaysNew(Simulation& in, const FairQueue::ClientFlowPtr& client, Seconds takes) {
    EXPECT_TRUE(in.post(newJobQueue(client), takes, [&in, client, takes] { alwaysNew(in, client, takes); }));
}

/// The latencies (waiting time plus duration) of jobs that are posted every `period` until the time `until`.
class Latencies {
  public:
    Latencies(Simulation& in, JobQueuePtr jobQueue, Seconds takes, Seconds period, Seconds until) : takes_(takes) {
        for (Seconds when = in.now() + period; when < until; when += period) {
            in.at(when, [this, &in, jobQueue, when] {
                EXPECT_TRUE(in.post(jobQueue, takes_, [this, &in, when] { all_.push_back(in.now() - when); }));
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
    const JobQueuePtr jobQueue = newJobQueue();
    std::vector<int> order;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(pool.post(jobQueue, i % 3 == 0 ? 50ms : 5ms, [&order, i] { order.push_back(i); }));
    }
    pool.run(10s);
    ASSERT_EQ(order.size(), 20U);
    EXPECT_TRUE(std::ranges::is_sorted(order));
}

TEST(FairQueue, WhoHasHadLessIsNext) {
    Simulation pool(1);
    const JobQueuePtr greedy = newJobQueue(), modest = newJobQueue();
    std::vector<std::string> order;
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(pool.post(greedy, 5ms, [&order] { order.emplace_back("greedy"); }));
    }
    pool.at(12ms, [&] { EXPECT_TRUE(pool.post(modest, 5ms, [&order] { order.emplace_back("modest"); })); });
    pool.run(1s);
    EXPECT_EQ(order, (std::vector<std::string>{"greedy", "greedy", "greedy", "modest", "greedy", "greedy"}));
}

/// A client that opens a session for each picture gains no advantage over a client that keeps its session.
TEST(FairQueue, NewLanesAreNotAhead) {
    for (const bool same : {false, true}) {
        Simulation pool(1);
        const FairQueue::ClientFlowPtr mine = newClient();
        const JobQueuePtr kept = newJobQueue(mine);
        for (int i = 0; i < 6; ++i) alwaysNew(pool, same ? mine : newClient(), 14ms);
        const Latencies seen(pool, kept, 2800us, 103ms, 20s);
        pool.run(20s);
        EXPECT_GE(seen.count(), 190U);
        // The worst latency: the rest of the running job, a job that was just about to begin, and the duration of the
        // job itself.
        EXPECT_LE(seen.worst(), 30.8ms + 1us);
        EXPECT_LE(seen.median(), 24.1ms);
    }
}

/// A client with a new job queue for each long job gains no advantage either. One thread serves both long and short
/// jobs.
TEST(FairQueue, NewLanesWithLongJobsAreNotAhead) {
    Simulation pool(1);
    for (int i = 0; i < 6; ++i) alwaysNew(pool, newClient(), 25ms);
    const Latencies seen(pool, newJobQueue(), 5ms, 103ms, 20s);
    pool.run(20s);
    EXPECT_GE(seen.count(), 190U);
    // The running job, two jobs that were just about to begin, and the duration of the job itself.
    EXPECT_LE(seen.worst(), 80ms + 1us);
}

/// A client with a new job queue for each job gains no advantage even if its jobs repeatedly take longer than
/// estimated.
TEST(FairQueue, NewLanesAreChargedByWhatTheirClientsTook) {
    Simulation pool(1);
    const FairQueue::ClientFlowPtr attacker = newClient();
    std::function<void()> again = [&] { EXPECT_TRUE(pool.post(newJobQueue(attacker), 4ms, 28ms, again)); };
    for (int i = 0; i < 6; ++i) again();
    const Latencies seen(pool, newJobQueue(), 5ms, 103ms, 20s);
    pool.run(20s);
    EXPECT_GE(seen.count(), 190U);
    EXPECT_LE(seen.worst(), 61ms + 1us);
    EXPECT_LE(seen.median(), 47ms);
}

TEST(FairQueue, ClientsShareEquallyHoweverManySessionsTheyHave) {
    for (const Seconds takes : {Seconds(10ms), Seconds(200ms)}) {
        Simulation pool(2);
        const FairQueue::ClientFlowPtr many = newClient();
        const JobQueuePtr one = newJobQueue();
        std::vector<JobQueuePtr> jobQueues;
        for (int i = 0; i < 100; ++i) jobQueues.push_back(newJobQueue(many));
        for (const JobQueuePtr& each : jobQueues) always(pool, each, takes);
        for (int i = 0; i < 4; ++i) always(pool, one, takes);
        pool.run(200s);
        EXPECT_NEAR(pool.usedBy(one).count(), 200, 10);
        const auto least = std::ranges::min(jobQueues, {}, [&](const JobQueuePtr& each) { return pool.usedBy(each); });
        const auto most = std::ranges::max(jobQueues, {}, [&](const JobQueuePtr& each) { return pool.usedBy(each); });
        EXPECT_LE(pool.usedBy(most) - pool.usedBy(least), 2 * takes);
    }
}

TEST(FairQueue, SessionsShareEquallyByTimeNotByJobs) {
    Simulation pool(1);
    const FairQueue::ClientFlowPtr client = newClient();
    const JobQueuePtr small = newJobQueue(client), large = newJobQueue(client);
    for (int i = 0; i < 4; ++i) {
        always(pool, small, 2ms);
        always(pool, large, 25ms);
    }
    pool.run(60s);
    EXPECT_NEAR(pool.usedBy(small).count(), 30, 1);
    EXPECT_NEAR(pool.usedBy(large).count(), 30, 1);
}

/// A long job begins in time, even if ten clients flood the pool with short jobs.
TEST(FairQueue, LongJobsAreNotStarved) {
    for (const std::size_t threads : {1U, 2U, 4U}) {
        Simulation pool(threads);
        for (int i = 0; i < 10; ++i) {
            const FairQueue::ClientFlowPtr each = newClient();
            for (int k = 0; k < 8; ++k) alwaysNew(pool, each, 10ms);
        }
        pool.run(5s);
        const JobQueuePtr jobQueue = newJobQueue();
        Seconds done{0};
        ASSERT_TRUE(pool.post(jobQueue, 1s, [&] { done = pool.now(); }));
        pool.run(30s);
        EXPECT_GT(done, 0s);
        // On one thread, each of the ten other clients may get the same time before the long job.
        EXPECT_LE(done, 5s + 11s + 1s);
    }
}

/// A long job of a new client waits for at most one long job of each other client, even while short jobs of another
/// client occupy a thread.
TEST(FairQueue, ALongJobOfANewClientWaitsForOneOfEachOtherAtMost) {
    Simulation pool(2);
    for (int i = 0; i < 4; ++i) {
        const FairQueue::ClientFlowPtr each = newClient();
        for (int k = 0; k < 5; ++k) always(pool, newJobQueue(each), 1s);
    }
    const Latencies seen(pool, newJobQueue(), 10ms, 20ms, 199s);
    pool.run(100s);
    Seconds done{0};
    ASSERT_TRUE(pool.post(newJobQueue(), 1s, [&] { done = pool.now(); }));
    pool.run(200s);
    EXPECT_GT(done, 0s);
    EXPECT_LE(done, 100s + 7s);
    EXPECT_LE(seen.worst(), 1s + 20ms);  // happens only at the start, before a thread is reserved for short jobs
}

TEST(FairQueue, AThreadIsKeptForShortJobsWhileSomebodyHasSome) {
    for (const std::size_t threads : {2U, 3U, 8U, 16U}) {
        Simulation pool(threads);
        const JobQueuePtr quick = newJobQueue();
        ASSERT_TRUE(pool.post(quick, 5ms));
        pool.run(10ms);
        // The durations of jobs in these job queues are not known yet.
        for (int i = 0; i < 40; ++i) always(pool, newJobQueue(), 2s);
        const Latencies seen(pool, quick, 5ms, 500ms, 30s);
        pool.run(30s);
        EXPECT_GE(seen.count(), 58U);
        EXPECT_LE(seen.worst(), 5ms + 1us);
        EXPECT_EQ(pool.running(), threads - std::max<std::size_t>(1, threads / 4));
    }
}

TEST(FairQueue, LongJobsHaveAllThreadsWhenNobodyElseIsThere) {
    Simulation pool(4);
    JobQueuePtr quick = newJobQueue(), leaving = newJobQueue();
    ASSERT_TRUE(pool.post(quick, 5ms));
    ASSERT_TRUE(pool.post(leaving, 5ms));
    for (int i = 0; i < 8; ++i) always(pool, newJobQueue(), 100ms);
    pool.run(5s);
    EXPECT_EQ(pool.running(), 3U);
    pool.run(Seconds(FairQueue::kActivePeriod) + 1s);
    EXPECT_EQ(pool.running(), 4U);
    ASSERT_TRUE(pool.post(quick, 5ms));
    pool.run(pool.now() + 1s);
    EXPECT_EQ(pool.running(), 3U);
    quick = nullptr;  // destroys the job queue, as if the session was closed
    pool.run(pool.now() + 1s);
    EXPECT_EQ(pool.running(), 4U);
}

/// A short job does not wait for jobs that take seconds, even if there were no short jobs before.
TEST(FairQueue, VeryLongJobsAlwaysLeaveAThread) {
    for (const std::size_t threads : {2U, 16U}) {
        Simulation pool(threads);
        for (int i = 0; i < 40; ++i) always(pool, newJobQueue(), 2s);
        const Latencies seen(pool, newJobQueue(), 5ms, 30s, 300s);
        pool.run(301s);
        EXPECT_EQ(seen.count(), 9U);
        EXPECT_LE(seen.worst(), 5ms + 1us);
    }
    Simulation one(1);  // the only thread runs all jobs, also very long ones
    for (int i = 0; i < 4; ++i) always(one, newJobQueue(), 2s);
    one.run(100s);
    EXPECT_NEAR(one.busy().count(), 100, 2);
}

/// After one job that was unusually slow, the next job of its job queue does not count as long.
TEST(FairQueue, SurprisesAreNotTakenForTheRule) {
    Simulation pool(2);
    const JobQueuePtr quick = newJobQueue();
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(pool.post(quick, 8ms));
    ASSERT_TRUE(pool.post(quick, 8ms, 800ms));
    pool.run(1s);
    for (int i = 0; i < 20; ++i) always(pool, newJobQueue(), 2s);
    pool.run(2s);
    const Latencies seen(pool, quick, 8ms, 100ms, 20s);
    pool.run(20s);
    EXPECT_LE(seen.worst(), 8ms + 1us);
}

TEST(FairQueue, ShortJobsOfALaneWithLongOnesKeepNoThread) {
    Simulation pool(2);
    for (int i = 0; i < 4; ++i) {
        const JobQueuePtr jobQueue = newJobQueue();
        always(pool, jobQueue, 100ms);
        always(pool, jobQueue, 1ms);
    }
    pool.run(10s);
    EXPECT_NEAR(pool.busy().count(), 20, 0.2);
}

/// Idle time gives no credit: a job queue that was idle for an hour gets the same share as a new job queue.
TEST(FairQueue, TimeIsNotSavedUp) {
    Simulation pool(1);
    const JobQueuePtr silent = newJobQueue(), busy = newJobQueue();
    ASSERT_TRUE(pool.post(silent, 10ms));
    for (int i = 0; i < 3; ++i) always(pool, busy, 10ms);
    pool.run(3600s);
    const Seconds before = pool.usedBy(busy);
    for (int i = 0; i < 3; ++i) always(pool, silent, 10ms);
    pool.run(3610s);
    EXPECT_NEAR((pool.usedBy(busy) - before).count(), 5, 0.1);
}

/// If no job is waiting, earlier differences are forgotten: a job queue that had all the time before gets its fair
/// share again.
TEST(FairQueue, NobodyOwesWhenNobodyWaits) {
    Simulation pool(1);
    const JobQueuePtr one = newJobQueue(), other = newJobQueue();
    ASSERT_TRUE(pool.post(other, 10ms));
    ASSERT_TRUE(pool.post(one, 10ms, 1000s));  // the job takes much longer than estimated
    pool.run(2000s);
    for (int i = 0; i < 3; ++i) {
        always(pool, one, 10ms);
        always(pool, other, 10ms);
    }
    pool.run(2010s);
    EXPECT_NEAR(pool.usedBy(one).count(), 1005, 0.5);
    EXPECT_NEAR(pool.usedBy(other).count(), 5, 0.5);
}

/// A client whose long jobs wait gains no advantage for its short jobs.
TEST(FairQueue, WaitingWithLongJobsGivesNoLeadForShortOnes) {
    Simulation pool(2);
    const JobQueuePtr victim = newJobQueue();
    std::vector<FairQueue::ClientFlowPtr> attackers;
    for (int i = 0; i < 10; ++i) {
        attackers.push_back(newClient());
        for (int k = 0; k < 3; ++k) always(pool, newJobQueue(attackers.back()), 1s);
    }
    const Latencies warm(pool, victim, 5ms, 50ms, 60s);
    pool.run(60s);
    for (const FairQueue::ClientFlowPtr& each : attackers) {
        for (int k = 0; k < 20; ++k) always(pool, newJobQueue(each), 5ms);
    }
    const Latencies seen(pool, victim, 5ms, 1s, 90s);
    pool.run(100s);
    EXPECT_EQ(seen.count(), 29U);
    EXPECT_LE(seen.worst(), 2 * 11 * 5ms);  // the time of two short jobs of each client
}

TEST(FairQueue, MoreThanMayWaitAreRefused) {
    Simulation pool(1, {10, 4});
    const FairQueue::ClientFlowPtr greedy = newClient();
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(pool.post(newJobQueue(greedy), 10ms));
    EXPECT_FALSE(pool.post(newJobQueue(greedy), 10ms));
    for (int i = 0; i < 6; ++i) EXPECT_TRUE(pool.post(newJobQueue(), 10ms));
    EXPECT_FALSE(pool.post(newJobQueue(), 10ms));
    EXPECT_EQ(pool.waitingJobCount(), 10U);
    pool.run(1s);
    EXPECT_EQ(pool.waitingJobCount(), 0U);
    EXPECT_TRUE(pool.post(newJobQueue(greedy), 10ms));
}

TEST(FairQueue, ClearsWithAllThatWaits) {
    FairQueue queue(1, {});
    const JobQueuePtr jobQueue = newJobQueue();
    auto owned = std::make_shared<int>(1);
    const auto job = [owned](std::size_t) {};
    EXPECT_TRUE(queue.push(job, jobQueue, 1ms, {}));
    EXPECT_TRUE(queue.push(job, jobQueue, 1s, {}));
    EXPECT_TRUE(queue.push(job, newJobQueue(), 1s, {}));
    EXPECT_EQ(queue.clear().size(), 3U);
    EXPECT_EQ(owned.use_count(), 2);  // one owner is here, and one is in `job`
    EXPECT_EQ(queue.waitingJobCount(), 0U);
    EXPECT_FALSE(queue.popStartableJob({}));
    EXPECT_TRUE(queue.push(job, jobQueue, 1ms, {}));
    EXPECT_TRUE(queue.popStartableJob({}));
}

}  // namespace
}  // namespace oval4d::parallel
