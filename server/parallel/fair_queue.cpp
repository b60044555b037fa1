#include "parallel/fair_queue.hpp"

#include <algorithm>

namespace oval4d::parallel {

namespace {

using Seconds = FairQueue::Seconds;

constexpr Seconds kMinCost{1e-4};  // the minimum cost of a job, in seconds, so that no job is free

// Each new measurement multiplies the weights of the earlier measurements by this factor.
constexpr double kDecay = 0.75;
// The weight of the prior `general` in EstimateCorrection::correctionFactor(): as much as that of measured jobs whose
// estimated times add up to kPriorWeight.
constexpr Seconds kPriorWeight{0.02};
// Other programs sometimes delay a job. Therefore, before a correction is learned from the measured time of a job, this
// time is reduced to at most kMaxOverrun times the job's cost.
constexpr double kMaxOverrun = 2;
constexpr double kMaxCorrection = 8;  // a correction multiplies or divides an estimate by at most this factor

}  // namespace

double FairQueue::EstimateCorrection::correctionFactor(double general) const {
    return std::clamp((measured_ + general * kPriorWeight) / (estimated_ + kPriorWeight), 1 / kMaxCorrection,
                      kMaxCorrection);
}

void FairQueue::EstimateCorrection::addMeasurement(Seconds estimate, Seconds took) {
    estimated_ = kDecay * estimated_ + estimate;
    measured_ = kDecay * measured_ + took;
}

FairQueue::FairQueue(std::size_t threads, Limits limits)
    : maxLongRunning_(threads > 1 ? threads - std::max<std::size_t>(1, threads / 4) : 1), limits_(limits) {}

Seconds FairQueue::correctedCost(const JobQueue& jobQueue, Seconds estimate) const {
    const double ofClient = jobQueue.client_->correction_.correctionFactor(correction_.correctionFactor(1));
    return std::max(kMinCost, jobQueue.correction_.correctionFactor(ofClient) * estimate);
}

/// Returns `cost` divided by the weight of `jobClass`: the cost of a job for `scheduler_`. The flows of `scheduler_`
/// are the two classes (all short jobs, and all long jobs). The weight of a class is the number of its active clients.
Seconds FairQueue::costChargedToClass(JobCostClass jobClass, Seconds cost) const {
    return cost / std::max<std::size_t>(1, classes_[jobClass].clients.activeFlows());
}

bool FairQueue::push(Job job, const JobQueuePtr& jobQueue, Seconds estimate, Clock::time_point now) {
    ClientFlow& client = *jobQueue->client_;
    if (waiting_ >= limits_.total || client.waiting_ >= limits_.perClient) return false;
    ++waiting_;
    ++client.waiting_;
    estimate = std::max(kMinCost, estimate);
    const Seconds cost = correctedCost(*jobQueue, estimate);
    const JobCostClass jobClass =
        cost > kLongJobThreshold * std::clamp(correction_.correctionFactor(1), 1.0, 2.0) ? long_job : short_job;
    jobQueue->jobs_.push_back({std::move(job), estimate, cost, jobClass});
    updateRecentShortQueues(jobQueue, jobClass, now);
    if (jobQueue->jobs_.size() == 1) updateJobQueueEntry(jobQueue);
    return true;
}

std::optional<FairQueue::StartableJob> FairQueue::popStartableJob(Clock::time_point now) {
    if (scheduler_.empty()) return std::nullopt;
    const JobCostClass jobClass = longJobsMustWait(now) ? short_job : scheduler_.nextFlow();
    JobCostClassScheduler& ofClass = classes_[jobClass];
    if (ofClass.clients.empty()) return std::nullopt;
    const ClientFlowPtr client = ofClass.clients.nextFlow();
    const JobQueuePtr jobQueue = client->jobQueues_[jobClass].nextFlow();
    QueuedJob first = std::move(jobQueue->jobs_.front());
    jobQueue->jobs_.pop_front();
    --waiting_;
    --client->waiting_;
    if (jobClass == long_job) ++longRunning_;
    scheduler_.recordStart(ofClass.state, costChargedToClass(jobClass, first.cost));
    ofClass.clients.recordStart(client->states_[jobClass], first.cost);
    client->jobQueues_[jobClass].recordStart(jobQueue->states_[jobClass], first.cost);
    client->jobQueues_[jobClass].remove(jobQueue->states_[jobClass]);
    updateClientEntry(client, jobClass);
    if (!jobQueue->jobs_.empty()) updateJobQueueEntry(jobQueue);
    return StartableJob{std::move(first.job), jobQueue, first.estimate, first.cost, jobClass};
}

void FairQueue::recordJobEnd(const StartableJob& started, Seconds took) {
    JobQueue& jobQueue = *started.jobQueue;
    ClientFlow& client = *jobQueue.client_;
    const JobCostClass jobClass = started.jobClass;
    if (jobClass == long_job) --longRunning_;
    for (EstimateCorrection* each : {&jobQueue.correction_, &client.correction_, &correction_})
        each->addMeasurement(started.estimate, std::min(took, kMaxOverrun * started.cost));
    const Seconds more = took - started.cost;
    scheduler_.recordEnd(classes_[jobClass].state, costChargedToClass(jobClass, more));
    classes_[jobClass].clients.recordEnd(client.states_[jobClass], more);
    client.jobQueues_[jobClass].recordEnd(jobQueue.states_[jobClass], more);
    if (jobQueue.states_[jobClass].entry) {
        updateJobQueueEntry(started.jobQueue);
    } else {
        updateClientEntry(jobQueue.client_, jobClass);
    }
}

Seconds FairQueue::nextJobCost(const ClientFlow& client, JobCostClass jobClass) {
    return client.jobQueues_[jobClass].nextFlow()->jobs_.front().cost;
}

/// Updates the position of a job queue among the job queues of its client, for the class of its first job. Then updates
/// the positions of the client and of this class (see updateClientEntry()). Must be called when the first job of the
/// job queue, or its virtual finish time, has changed. The job queue must not be empty.
void FairQueue::updateJobQueueEntry(const JobQueuePtr& jobQueue) {
    const QueuedJob& first = jobQueue->jobs_.front();
    jobQueue->client_->jobQueues_[first.jobClass].enqueueOrUpdateFlow(jobQueue->states_[first.jobClass], jobQueue,
                                                                      first.cost);
    updateClientEntry(jobQueue->client_, first.jobClass);
}

/// Updates the position of a client among the clients of the class `jobClass` (all short jobs, or all long jobs).
/// Removes the client from them if the client has no waiting job of this class. Then updates the position of the class
/// in `scheduler_` in the same way. Must be called when the client's next job of this class, or the client's virtual
/// finish time, has changed.
void FairQueue::updateClientEntry(const ClientFlowPtr& client, JobCostClass jobClass) {
    JobCostClassScheduler& ofClass = classes_[jobClass];
    if (client->jobQueues_[jobClass].empty()) {
        ofClass.clients.remove(client->states_[jobClass]);
    } else {
        ofClass.clients.enqueueOrUpdateFlow(client->states_[jobClass], client, nextJobCost(*client, jobClass));
    }
    if (ofClass.clients.empty()) {
        scheduler_.remove(ofClass.state);
    } else {
        scheduler_.enqueueOrUpdateFlow(
            ofClass.state, jobClass, costChargedToClass(jobClass, nextJobCost(*ofClass.clients.nextFlow(), jobClass)));
    }
}

/// Records that a job of the class `jobClass` is queued in `jobQueue`. If the job is short, puts the job queue at the
/// end of `recentShortJobQueues_`, unless a long job was queued in it within the last kActivePeriod. While
/// `recentShortJobQueues_` is not empty, no long job starts on a reserved thread. So these threads stay free for the
/// short jobs of the job queues in `recentShortJobQueues_`.
void FairQueue::updateRecentShortQueues(const JobQueuePtr& jobQueue, JobCostClass jobClass, Clock::time_point now) {
    pruneRecentShortJobQueues(now);
    if (jobClass == long_job) jobQueue->lastLong_ = now;
    if (jobQueue->lastLong_ && now - *jobQueue->lastLong_ <= kActivePeriod) return;
    if (const auto before = std::exchange(jobQueue->activity_,
                                          recentShortJobQueues_.emplace(recentShortJobQueues_.end(), now, jobQueue))) {
        recentShortJobQueues_.erase(*before);
    }
}

void FairQueue::pruneRecentShortJobQueues(Clock::time_point now) {
    for (; !recentShortJobQueues_.empty(); recentShortJobQueues_.pop_front()) {
        const auto& [last, weak] = recentShortJobQueues_.front();
        const JobQueuePtr jobQueue = weak.lock();
        if (jobQueue && now - last <= kActivePeriod) return;
        if (jobQueue) jobQueue->activity_.reset();
    }
}

/// Returns whether long jobs must wait. They must wait if long jobs run on all threads that are not reserved, and the
/// next long job may not start on a reserved thread.
bool FairQueue::longJobsMustWait(Clock::time_point now) {
    if (longRunning_ < maxLongRunning_) return false;
    pruneRecentShortJobQueues(now);
    const FairScheduler<ClientFlowPtr>& clients = classes_[long_job].clients;
    return !recentShortJobQueues_.empty() ||
           (!clients.empty() && nextJobCost(*clients.nextFlow(), long_job) > kVeryLongJobThreshold);
}

bool FairQueue::hasStartableJob(Clock::time_point now) {
    return waiting_ > 0 && !(classes_[short_job].clients.empty() && longJobsMustWait(now));
}

std::deque<FairQueue::Job> FairQueue::clear() {
    std::deque<Job> dropped;
    while (!scheduler_.empty()) {
        const JobCostClass jobClass = scheduler_.nextFlow();
        const ClientFlowPtr client = classes_[jobClass].clients.nextFlow();
        const JobQueuePtr jobQueue = client->jobQueues_[jobClass].nextFlow();
        client->waiting_ -= jobQueue->jobs_.size();
        waiting_ -= jobQueue->jobs_.size();
        for (QueuedJob& each : jobQueue->jobs_) dropped.push_back(std::move(each.job));
        jobQueue->jobs_.clear();
        client->jobQueues_[jobClass].remove(jobQueue->states_[jobClass]);
        updateClientEntry(client, jobClass);
    }
    return dropped;
}

}  // namespace oval4d::parallel
