#pragma once
// A job queue that divides the time of the worker threads fairly among clients.

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

/// Decides which flow is served next by weighted fair queueing (A. Demers, S. Keshav, S. Shenker, 1989). A flow is a
/// sequence of jobs, such as those of one client. The cost of a job is its running time; to give a flow more weight,
/// the caller divides its costs. The next job of a flow has the virtual finish time F = max(V, F of the flow's previous
/// job) + cost, and the flow with the smallest F is served next. The virtual time V is the service that each active
/// flow would have received if all were served simultaneously: each job that starts advances V by cost / active flows,
/// and V is never less than the virtual start time F − cost of that job (J. Bennett, H. Zhang, 1996).
/// - A flow that is new or was idle starts at V: idle time earns no credit, and a flow gets ahead of another one by at
///   most the difference between the costs of their jobs.
/// - V advances, so each other flow gets ahead of a waiting flow by at most the cost of the waiting flow's own job.
/// - If no flow is waiting when one is queued, V is set to the largest F, which resets all flows.
template <typename Flow>
class FairScheduler {
  public:
    using Seconds = std::chrono::duration<double>;
    using Queue = std::multimap<Seconds, Flow>;  // ordered by virtual finish time; equal times in order of insertion

    /// The scheduler's data about one flow, which the caller stores with the flow.
    struct FlowState {
        Seconds finish{0};                              ///< F of the job that started last
        std::optional<typename Queue::iterator> entry;  ///< position in the queue; empty unless the flow is waiting
        std::size_t running = 0;                        ///< number of running jobs
    };

    bool empty() const { return queue_.empty(); }
    /// Returns the flow to serve next. The scheduler must not be empty.
    const Flow& next() const { return queue_.begin()->second; }
    /// Returns the number of active flows: those with waiting or running jobs.
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
    /// Removes a flow from the queue, if it is queued.
    void dequeue(FlowState& state) {
        const auto entry = std::exchange(state.entry, std::nullopt);
        if (!entry) return;
        queue_.erase(*entry);
        if (state.running == 0) --activeFlows_;
    }
    /// Records that the next job of a queued flow starts. The caller must then call `enqueue` or `dequeue`.
    void start(FlowState& state, Seconds cost) {
        virtualTime_ = std::max(virtualTime_, state.finish) + cost / activeFlows_;
        // F is at most the cost of one job behind V, even if estimates were wrong.
        state.finish = std::max(state.finish + cost, virtualTime_ - cost);
        maxFinish_ = std::max(maxFinish_, state.finish);
        ++state.running;
    }
    /// Records that a job of the flow ended and took `excess` longer than its cost (less if negative). If the flow is
    /// queued, the caller must then call `enqueue`.
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

/// A queue of jobs with hierarchical weighted fair queueing: the clients share the time of the threads equally, and the
/// lanes of a client (such as its sessions) share the client's time equally.
///
/// The cost of a job is estimated until the job ends; then the measured time replaces the estimate. Measured times also
/// correct later estimates: those of the same lane, of new lanes of the same client, and of new clients.
///
/// Jobs are not preempted. Therefore some threads are kept free: a quarter of them, rounded down, but at least one
/// unless there is only one. They start no very long jobs, and no long jobs while a lane with short jobs is active.
/// Short jobs and long jobs are two classes: within each class, clients are scheduled fairly, and the classes share the
/// threads in proportion to the numbers of their active clients.
///
/// Not thread-safe. Starts no threads and reads no clock: the caller runs the jobs and passes the current time.
class FairQueue {
  public:
    using Job = std::function<void(std::size_t worker)>;
    using Seconds = std::chrono::duration<double>;
    using Clock = std::chrono::steady_clock;
    class Client;
    class Lane;
    enum JobLength : std::size_t { short_job, long_job };
    template <typename T>
    using PerClass = std::array<T, 2>;
    using ClientPtr = std::shared_ptr<Client>;
    using LanePtr = std::shared_ptr<Lane>;

    /// The maximum numbers of waiting jobs, of all clients together and of one client.
    struct Limits {
        std::size_t all = 10'000, ofClient = 1000;
    };

    /// A job with a larger cost is long. If jobs in general take longer than estimated, the threshold rises in
    /// proportion, to at most twice this value.
    static constexpr Seconds kLongJob{0.015};
    /// A job with a larger cost is very long: it does not start on a thread that is kept free, even if no lane with
    /// short jobs is active.
    static constexpr Seconds kVeryLongJob{0.25};
    /// A lane with short jobs is active for this long after its last job was queued, or until the lane is destroyed.
    static constexpr std::chrono::seconds kActive{10};

    /// A job that the caller must run now and whose end it must report with finished().
    struct Begun {
        Job job;
        LanePtr lane;
        Seconds estimate, cost;  ///< the estimate given to push(); the estimate corrected by measured times
        JobLength length;
    };

    /// `threads`: the number of threads that run the jobs, at least 1.
    FairQueue(std::size_t threads, Limits limits);
    ~FairQueue() { clear(); }
    FairQueue(const FairQueue&) = delete;
    FairQueue& operator=(const FairQueue&) = delete;

    /// Queues a job at the end of its lane. `estimate`: the time that the job is expected to take. Returns false, and
    /// does not queue the job, if a limit is reached.
    [[nodiscard]] bool push(Job job, const LanePtr& lane, Seconds estimate, Clock::time_point now);

    /// Removes and returns the job to start now; nothing if none is waiting or those that wait may not start yet.
    std::optional<Begun> pop(Clock::time_point now);

    /// Records that the job ended, and how long it took.
    void finished(const Begun& begun, Seconds took);

    /// Removes and returns all waiting jobs, so that the caller can choose when to destroy them.
    std::deque<Job> clear();

    /// Returns the number of waiting jobs.
    std::size_t waiting() const { return waiting_; }
    /// Returns whether a waiting job could start if one more thread were free.
    bool hasStartableJob(Clock::time_point now);

  private:
    /// Learns the ratio of measured to estimated times, weighted toward recent jobs.
    class Correction {
      public:
        /// Returns the factor by which to multiply estimates. `general`: the prior, a factor from other jobs, which
        /// dominates while few jobs have been measured.
        double factor(double general) const;
        void learn(Seconds estimate, Seconds took);

      private:
        Seconds estimated_{0}, measured_{0};
    };

    struct Waiting {
        Job job;
        Seconds estimate, cost;
        JobLength length;
    };

    /// The class of all jobs of one length: its clients with waiting jobs, and its own place in `scheduler_`.
    struct Class {
        FairScheduler<ClientPtr> clients;
        FairScheduler<JobLength>::FlowState state;
    };

    using RecentLanes = std::list<std::pair<Clock::time_point, std::weak_ptr<Lane>>>;

    Seconds correctedCost(const Lane& lane, Seconds estimate) const;
    Seconds classCost(JobLength length, Seconds cost) const;
    static Seconds nextCost(const Client& client, JobLength length);
    void scheduleLane(const LanePtr& lane);
    void scheduleClient(const ClientPtr& client, JobLength length);
    void recordActivity(const LanePtr& lane, JobLength length, Clock::time_point now);
    bool longJobsMustWait(Clock::time_point now);
    void forgetInactive(Clock::time_point now);

    const std::size_t maxLongRunning_;  // maximum number of running long jobs while lanes with short jobs are active
    const Limits limits_;
    std::size_t waiting_ = 0, longRunning_ = 0;
    PerClass<Class> classes_;
    FairScheduler<JobLength> scheduler_;  // decides which class is served next
    Correction correction_;               // from the jobs of all clients
    RecentLanes active_;                  // lanes with short jobs, with the time of their last job, in order of time
};

/// A client, such as all connections from one address. All of its jobs must be in the same queue.
class FairQueue::Client {
    friend FairQueue;
    PerClass<FairScheduler<ClientPtr>::FlowState> states_;
    PerClass<FairScheduler<LanePtr>> lanes_;
    std::size_t waiting_ = 0;
    Correction correction_;
};

/// A first-in, first-out queue of a client's jobs, such as those for one session.
class FairQueue::Lane {
  public:
    explicit Lane(ClientPtr client) : client_(std::move(client)) {}

  private:
    friend FairQueue;
    const ClientPtr client_;
    PerClass<FairScheduler<LanePtr>::FlowState> states_;
    std::deque<Waiting> jobs_;
    Correction correction_;
    std::optional<RecentLanes::iterator> activity_;  // position in active_; empty if the lane is not in it
    std::optional<Clock::time_point> lastLong_;      // when the last long job was queued
};

}  // namespace oval4d::parallel
