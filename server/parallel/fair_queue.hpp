#pragma once
// A job queue that divides the time of worker threads fairly among clients.

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

/// Decides by weighted fair queueing (A. Demers, S. Keshav, S. Shenker, 1989) which flow is served next. A flow is a
/// sequence of jobs, such as those of one client. A flow is active while it has waiting or running jobs. The cost of a
/// job is its running time, in seconds. To give a flow a larger weight, the caller divides the costs of its jobs by
/// this weight. The scheduler keeps three quantities, also in seconds:
/// - V is the virtual time: the service that each active flow would have received if all were served simultaneously.
///   When a job starts, V is raised to the job's S (J. Bennett, H. Zhang, 1996). Then V grows by the cost of the job
///   divided by the number of active flows.
/// - S is the virtual start time of the next job of a flow. It is the greater of two numbers: the F of the flow's
///   previous job, and V at the time when the flow was queued.
/// - F = S + cost is the virtual finish time of this job. The queued flow with the smallest F is served next. When its
///   job starts, F is raised to at least V − cost. When the job ends, the measured running time minus the cost is added
///   to F.
///
/// So the flows are served fairly:
/// - A flow that is new or was idle has an S of at least V: it gains no credit for idle time. Among flows whose S is V,
///   the flow whose next job costs least is served first.
/// - While a flow waits, its S and F are constant. Jobs of other flows start before its next job only if their F is
///   smaller. So the F of no other flow gets ahead of the S of the waiting flow by more than the cost of this next job.
/// - If a flow is queued while no flow is waiting, V is set to the largest F of all flows. The S of each flow that is
///   queued then is V, so no flow is ahead of another.
template <typename Flow>
class FairScheduler {
  public:
    using Seconds = std::chrono::duration<double>;
    // The waiting flows, ordered by virtual finish time; flows with equal times are in the order of insertion.
    using Queue = std::multimap<Seconds, Flow>;

    /// The data about one flow that the scheduler needs. The caller stores them with the flow.
    struct FlowState {
        /// If the flow is waiting: the virtual start time S of its next job. Otherwise: the virtual finish time F of
        /// the job that started last.
        Seconds finish{0};
        /// The position of the flow in the queue; empty unless the flow is waiting.
        std::optional<typename Queue::iterator> entry;
        std::size_t running = 0;  ///< the number of running jobs of the flow
    };

    bool empty() const { return queue_.empty(); }
    /// Returns the flow to serve next. The scheduler must not be empty.
    const Flow& nextFlow() const { return queue_.begin()->second; }
    /// Returns the number of active flows: those with waiting or running jobs.
    std::size_t activeFlows() const { return activeFlows_; }

    /// Queues a flow whose next job has the cost `nextCost`. If the flow is already queued, updates its position in the
    /// queue.
    void enqueueOrUpdateFlow(FlowState& state, Flow flow, Seconds nextCost) {
        if (state.entry) {
            queue_.erase(*state.entry);
        } else {
            if (queue_.empty()) virtualTime_ = maxFinish_;
            state.finish = std::max(state.finish, virtualTime_);
            if (state.running == 0) ++activeFlows_;
        }
        state.entry = queue_.emplace(state.finish + nextCost, std::move(flow));
    }
    /// Removes a flow from the queue. Does nothing if the flow is not queued.
    void remove(FlowState& state) {
        const auto entry = std::exchange(state.entry, std::nullopt);
        if (!entry) return;
        queue_.erase(*entry);
        if (state.running == 0) --activeFlows_;
    }
    /// Records that the next job of a queued flow starts. The caller must then call enqueueOrUpdateFlow() if the flow
    /// has another waiting job, and remove() otherwise.
    void recordStart(FlowState& state, Seconds cost) {
        virtualTime_ = std::max(virtualTime_, state.finish) + cost / activeFlows_;
        // Even if the costs of earlier jobs were wrong, the finish time F is less than V by at most the cost of this
        // job.
        state.finish = std::max(state.finish + cost, virtualTime_ - cost);
        maxFinish_ = std::max(maxFinish_, state.finish);
        ++state.running;
    }
    /// Records that a job of the flow ended. `excess` is the measured running time minus the cost of the job. If the
    /// flow is queued, the caller must then call enqueueOrUpdateFlow() again, because the virtual finish time of its
    /// next job has changed.
    void recordEnd(FlowState& state, Seconds excess) {
        state.finish += excess;
        maxFinish_ = std::max(maxFinish_, state.finish);
        if (--state.running == 0 && !state.entry) --activeFlows_;
    }

  private:
    Queue queue_;
    std::size_t activeFlows_ = 0;
    Seconds virtualTime_{0}, maxFinish_{0};  // the virtual time V, and the largest virtual finish time F of all flows
};

/// A queue that schedules jobs by hierarchical weighted fair queueing. Each job is in a job queue, for example that of
/// a session, and each job queue belongs to a client. The clients share the time of the threads equally. The job queues
/// of a client share the client's time equally.
///
/// The cost of a job is an estimate until the job ends; then the measured time replaces the estimate. Measured times
/// also correct the estimates of later jobs in the same job queue, in new job queues of the same client, and in the job
/// queues of new clients.
///
/// Jobs are not preempted, so long jobs could occupy all threads while short jobs wait. Therefore some threads are
/// reserved: a quarter of them, rounded down, but at least one. If there is only one thread, it is not reserved. A
/// reserved thread never starts a very long job (see kVeryLongJobThreshold). While a job queue with short jobs is
/// active (see kActivePeriod), a reserved thread does not start a long job either (see kLongJobThreshold).
///
/// Short jobs and long jobs are two classes. Within each class, clients are scheduled fairly. The two classes share the
/// time of the threads in proportion to the numbers of their active clients.
///
/// Not thread-safe. Starts no threads and reads no clock: the caller runs the jobs and passes the current time.
class FairQueue {
  public:
    using Job = std::function<void(std::size_t worker)>;
    using Seconds = std::chrono::duration<double>;
    using Clock = std::chrono::steady_clock;
    class ClientFlow;
    class JobQueue;
    /// The class of a job, which its cost determines (see kLongJobThreshold).
    enum JobCostClass : std::size_t { short_job, long_job };
    template <typename T>
    using PerJobCostClass = std::array<T, 2>;  // an array with one element for each JobCostClass
    using ClientFlowPtr = std::shared_ptr<ClientFlow>;
    using JobQueuePtr = std::shared_ptr<JobQueue>;

    /// The maximum numbers of waiting jobs: of all clients together, and of one client.
    struct Limits {
        std::size_t total = 10'000, perClient = 1000;
    };

    /// The cost, in seconds, above which a job is long; any other job is short. If jobs in general take longer than
    /// estimated, the threshold rises in proportion, to at most twice this value.
    static constexpr Seconds kLongJobThreshold{0.015};
    /// The cost, in seconds, above which a job is very long: it never starts on a reserved thread, even if no job queue
    /// with short jobs is active.
    static constexpr Seconds kVeryLongJobThreshold{0.25};
    /// How long a job queue is active after a short job was queued in it, unless the job queue is destroyed. However, a
    /// short job does not make its job queue active if a long job was queued there less than this time before.
    static constexpr std::chrono::seconds kActivePeriod{10};

    /// A job that popStartableJob() has returned. The caller must run the job at once, and then call recordJobEnd().
    struct StartableJob {
        Job job;
        JobQueuePtr jobQueue;
        Seconds estimate, cost;  ///< `estimate` was given to push(); `cost` is the corrected estimate; both in seconds
        JobCostClass jobClass;
    };

    /// `threads` is the number of threads that run the jobs, at least 1.
    FairQueue(std::size_t threads, Limits limits);
    ~FairQueue() { clear(); }
    FairQueue(const FairQueue&) = delete;
    FairQueue& operator=(const FairQueue&) = delete;

    /// Queues a job at the end of its job queue. `estimate` is the time that the job is expected to take. Returns
    /// false, and does not queue the job, if a limit on waiting jobs is reached.
    [[nodiscard]] bool push(Job job, const JobQueuePtr& jobQueue, Seconds estimate, Clock::time_point now);

    /// Removes and returns the job to start now. Returns an empty optional in two cases: if no job is waiting, or if
    /// all waiting jobs are long and must wait longer. Long jobs must wait if all threads that are not reserved run
    /// long jobs, and the next long job may not start on a reserved thread.
    std::optional<StartableJob> popStartableJob(Clock::time_point now);

    /// Records that the job `started` has ended. `took` is the measured running time.
    void recordJobEnd(const StartableJob& started, Seconds took);

    /// Removes and returns all waiting jobs, so that the caller can choose when to destroy them.
    std::deque<Job> clear();

    /// Returns the number of waiting jobs.
    std::size_t waitingJobCount() const { return waiting_; }
    /// Returns whether a waiting job could start if one more thread were free.
    bool hasStartableJob(Clock::time_point now);

  private:
    // Learns the ratio of measured to estimated times, with more weight for recent jobs.
    class EstimateCorrection {
      public:
        // Returns the factor by which estimates must be multiplied. `general` is the prior: the factor learned from a
        // larger group of jobs. While few jobs have been measured, the prior dominates.
        double correctionFactor(double general) const;
        void addMeasurement(Seconds estimate, Seconds took);

      private:
        Seconds estimated_{0}, measured_{0};  // the weighted sums of the estimated times and of the measured times
    };

    struct QueuedJob {
        Job job;
        Seconds estimate, cost;  // `estimate` was given to push(); `cost` is the corrected estimate; both in seconds
        JobCostClass jobClass;
    };

    // The scheduling data of one class: of all short jobs, or of all long jobs. `clients` schedules the clients of the
    // class. `scheduler_` chooses between the two classes; to it, each class is a flow with the state `state`.
    struct JobCostClassScheduler {
        FairScheduler<ClientFlowPtr> clients;
        FairScheduler<JobCostClass>::FlowState state;
    };

    using RecentJobQueues = std::list<std::pair<Clock::time_point, std::weak_ptr<JobQueue>>>;

    Seconds correctedCost(const JobQueue& jobQueue, Seconds estimate) const;
    Seconds costChargedToClass(JobCostClass jobClass, Seconds cost) const;
    static Seconds nextJobCost(const ClientFlow& client, JobCostClass jobClass);
    void updateJobQueueEntry(const JobQueuePtr& jobQueue);
    void updateClientEntry(const ClientFlowPtr& client, JobCostClass jobClass);
    void updateRecentShortQueues(const JobQueuePtr& jobQueue, JobCostClass jobClass, Clock::time_point now);
    bool longJobsMustWait(Clock::time_point now);
    void pruneRecentShortJobQueues(Clock::time_point now);

    const std::size_t maxLongRunning_;  // the number of threads that are not reserved (see FairQueue)
    const Limits limits_;
    std::size_t waiting_ = 0, longRunning_ = 0;  // the numbers of waiting jobs and of running long jobs
    PerJobCostClass<JobCostClassScheduler> classes_;
    FairScheduler<JobCostClass> scheduler_;  // decides which of the two classes is served next
    EstimateCorrection correction_;          // learned from the jobs of all clients
    RecentJobQueues
        recentShortJobQueues_;  // active job queues, each with the time of its last short job; earliest first
};

/// A client, for example all connections from one address. Clients share the threads. All jobs of a client must be in
/// the same FairQueue.
class FairQueue::ClientFlow {
    friend FairQueue;
    PerJobCostClass<FairScheduler<ClientFlowPtr>::FlowState>
        states_;  // per class: the client's state as a flow in JobCostClassScheduler::clients
    PerJobCostClass<FairScheduler<JobQueuePtr>> jobQueues_;  // per class: the scheduler of the client's job queues
    std::size_t waiting_ = 0;
    EstimateCorrection correction_;
};

/// A first-in, first-out queue of some jobs of a client, such as those for one session.
class FairQueue::JobQueue {
  public:
    explicit JobQueue(ClientFlowPtr client) : client_(std::move(client)) {}

  private:
    friend FairQueue;
    const ClientFlowPtr client_;
    PerJobCostClass<FairScheduler<JobQueuePtr>::FlowState> states_;
    std::deque<QueuedJob> jobs_;
    EstimateCorrection correction_;
    std::optional<RecentJobQueues::iterator>
        activity_;  // the position in FairQueue::recentShortJobQueues_; empty if the job queue is not active
    std::optional<Clock::time_point> lastLong_;  // the time when the last long job was queued; empty if there was none
};

}  // namespace oval4d::parallel
