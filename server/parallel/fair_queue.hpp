#pragma once
// The order in which jobs start.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace oval4d::parallel {

/// A weighted fair queueing scheduler for flows, such as clients (A. Demers, S. Keshav, S. Shenker, 1989). A caller
/// gives a flow more weight by dividing its costs. The next job of a flow has the virtual finish time F = max(V, F of
/// the flow's previous job) + cost, and the flow with the smallest F is served next. The virtual time V is the service
/// that each active flow would have received if all were served simultaneously: each job that starts advances it by
/// cost / active flows, and it is never less than the virtual start time F - cost of that job (J. Bennett, H. Zhang,
/// 1996).
/// - A flow that is new or was idle starts at V: idle time earns no credit, and a flow gets ahead of another one by at
///   most the difference between the costs of their jobs.
/// - V advances: each other flow gets ahead of a waiting flow by at most the cost of the waiting flow's own job.
/// - When no flow is waiting, V is set to the largest F, which resets all flows.
template <typename Flow>
class FairScheduler {
  public:
    using Seconds = std::chrono::duration<double>;
    using Queue = std::multimap<Seconds, Flow>;  // by virtual finish time; ties in order of insertion

    /// The scheduler's state of one flow, stored with the flow.
    struct FlowState {
        Seconds finish{0};                              ///< F of the job that started last
        std::optional<typename Queue::iterator> entry;  ///< set while the flow is waiting
        std::size_t running = 0;                        ///< number of running jobs
    };

    bool empty() const { return queue_.empty(); }
    const Flow& next() const { return queue_.begin()->second; }
    /// The number of active flows: those with waiting or running jobs.
    std::size_t activeFlows() const { return activeFlows_; }

    /// Queues a flow whose next job has this cost. If the flow is already queued, changes the cost.
    void enqueue(FlowState& state, Flow flow, Seconds cost) {
        if (state.entry) {
            queue_.erase(*state.entry);
        } else {
            if (queue_.empty()) virtualTime_ = maxFinish_;
            state.finish = std::max(state.finish, virtualTime_);
            if (state.running == 0) ++activeFlows_;
        }
        state.entry = queue_.emplace(state.finish + cost, std::move(flow));
    }
    void dequeue(FlowState& state) {
        const auto entry = std::exchange(state.entry, std::nullopt);
        if (!entry) return;
        queue_.erase(*entry);
        if (state.running == 0) --activeFlows_;
    }
    /// Records that the next job of a queued flow starts. The caller must then call `enqueue` or `dequeue`.
    void start(FlowState& state, Seconds cost) {
        virtualTime_ = std::max(virtualTime_, state.finish) + cost / activeFlows_;
        // The flow stays at most one job behind V even if estimates were wrong.
        state.finish = std::max(state.finish + cost, virtualTime_ - cost);
        maxFinish_ = std::max(maxFinish_, state.finish);
        ++state.running;
    }
    /// Records that a job of the flow ended and took `excess` longer than its cost. If the flow is queued, the caller
    /// must then call `enqueue`.
    void end(FlowState& state, Seconds excess) {
        state.finish += excess;
        maxFinish_ = std::max(maxFinish_, state.finish);
        if (--state.running == 0 && !state.entry) --activeFlows_;
    }

  private:
    Queue queue_;
    std::size_t activeFlows_ = 0;
    Seconds virtualTime_{0}, maxFinish_{0};  // V; the largest F of all flows
};

/// A queue of jobs with hierarchical weighted fair queueing: the clients share the time of the threads, and the
/// lanes (sessions) of a client share the client's time.
///
/// The cost of a job is estimated until the job ends; then the measured time replaces the estimate and corrects later
/// ones: those of its lane, those of new lanes of its client, and those of new clients.
///
/// Jobs are not preempted. Therefore a quarter of the threads, rounded down, but at least one if there are several,
/// start no very long jobs, and no long jobs while lanes with short jobs are active. Short jobs and long jobs are two
/// classes: within each, clients are scheduled fairly, and the classes share the threads in proportion to the
/// numbers of their active clients.
///
/// Uses no threads and no clock; not thread-safe.
class FairQueue {
  public:
    using Job = std::function<void(std::size_t worker)>;
    using Seconds = std::chrono::duration<double>;
    using Clock = std::chrono::steady_clock;
    class Client;
    class Lane;
    enum Length : std::size_t { short_job, long_job };
    template <typename T>
    using PerClass = std::array<T, 2>;
    using ClientPtr = std::shared_ptr<Client>;
    using LanePtr = std::shared_ptr<Lane>;

    /// The maximum numbers of waiting jobs.
    struct Limits {
        std::size_t all = 10'000, ofClient = 1000;
    };

    /// A job with a larger cost is long. Where all jobs take longer than estimated, the threshold is up to twice this.
    static constexpr Seconds kLongJob{0.015};
    /// A job with a larger cost is very long: it leaves threads free even if no lane with short jobs is active.
    static constexpr Seconds kVeryLongJob{0.25};
    /// A lane with short jobs is active for this long after its last job was queued, or until the lane is destroyed.
    static constexpr std::chrono::seconds kActive{10};

    /// A job that the caller must run now and then report with `finished`.
    struct Begun {
        Job job;
        LanePtr lane;
        Seconds estimate, cost;  ///< as posted; corrected by measured times
        Length length;
    };

    /// `threads`: the number of threads that run the jobs, at least 1.
    FairQueue(std::size_t threads, Limits limits);
    ~FairQueue() { clear(); }
    FairQueue(const FairQueue&) = delete;
    FairQueue& operator=(const FairQueue&) = delete;

    /// Queues a job. `estimate`: the time that it is expected to take. Returns false, and does not queue the job, if a
    /// limit is reached.
    [[nodiscard]] bool push(Job job, const LanePtr& lane, Seconds estimate, Clock::time_point now);

    /// Removes and returns the job to start now, if there is one.
    std::optional<Begun> pop(Clock::time_point now);

    /// Records that the job ended and took this long.
    void finished(const Begun& begun, Seconds took);

    /// Removes and returns all waiting jobs, so that the caller can destroy them at a time that suits it.
    std::deque<Job> clear();

    std::size_t waiting() const { return waiting_; }
    /// Whether a waiting job could start if a thread were free.
    bool crowded(Clock::time_point now);

  private:
    /// The ratio of measured to estimated times, weighted toward recent jobs.
    class Correction {
      public:
        /// The factor by which to multiply estimates. `general`: the prior, which dominates while few jobs have been
        /// measured.
        double factor(double general) const;
        void learn(Seconds estimate, Seconds took);

      private:
        Seconds estimated_{0}, measured_{0};
    };

    struct Waiting {
        Job job;
        Seconds estimate, cost;
        Length length;
    };

    /// The waiting jobs of one length.
    struct Class {
        FairScheduler<ClientPtr> clients;
        FairScheduler<Length>::FlowState state;
    };

    using Activity = std::list<std::pair<Clock::time_point, std::weak_ptr<Lane>>>;

    Seconds correctedCost(const Lane& lane, Seconds estimate) const;
    Seconds classCost(Length length, Seconds cost) const;
    static Seconds nextCost(const Client& client, Length length);
    void scheduleLane(const LanePtr& lane);
    void scheduleClient(const ClientPtr& client, Length length);
    void recordActivity(const LanePtr& lane, Length length, Clock::time_point now);
    bool longJobsMustWait(Clock::time_point now);
    void forgetInactive(Clock::time_point now);

    const std::size_t maxLongRunning_;  // while lanes with short jobs are active
    const Limits limits_;
    std::size_t waiting_ = 0, longRunning_ = 0;
    PerClass<Class> classes_;
    FairScheduler<Length> scheduler_;  // of the classes
    Correction correction_;
    Activity active_;  // lanes with short jobs and the time of their last job, in order of time
};

/// A client of one queue, such as all connections from one address.
class FairQueue::Client {
    friend FairQueue;
    PerClass<FairScheduler<ClientPtr>::FlowState> states_;
    PerClass<FairScheduler<LanePtr>> lanes_;
    std::size_t waiting_ = 0;
    Correction correction_;
};

/// A first-in, first-out sequence of jobs, such as those of one session.
class FairQueue::Lane {
  public:
    explicit Lane(ClientPtr client) : client_(std::move(client)) {}

  private:
    friend FairQueue;
    const ClientPtr client_;
    PerClass<FairScheduler<LanePtr>::FlowState> states_;
    std::deque<Waiting> jobs_;
    Correction correction_;
    std::optional<Activity::iterator> activity_;
    std::optional<Clock::time_point> lastLong_;  // when the last long job was queued
};

}  // namespace oval4d::parallel
