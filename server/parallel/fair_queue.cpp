#include "parallel/fair_queue.hpp"

#include <algorithm>

namespace oval4d::parallel {

namespace {

using Seconds = FairQueue::Seconds;

constexpr Seconds kMinCost{1e-4};  // the minimum cost of a job: no job is free

constexpr double kDecay = 0.75;  // each new measurement multiplies the weights of earlier ones by this factor
// In EstimateCorrection::factor(), the prior `general` has the same weight as measured jobs whose estimates add up to
// this time.
constexpr Seconds kPriorWeight{0.02};
// Before a correction is learned from the measured time of a job, this time is reduced to at most this multiple of the
// job's cost, because other programs sometimes delay a job.
constexpr double kMaxOverrun = 2;
constexpr double kMaxCorrection = 8;  // a correction multiplies or divides an estimate by at most this factor

}  // namespace

double FairQueue::EstimateCorrection::factor(double general) const {
    return std::clamp((measured_ + general * kPriorWeight) / (estimated_ + kPriorWeight), 1 / kMaxCorrection,
                      kMaxCorrection);
}

void FairQueue::EstimateCorrection::learn(Seconds estimate, Seconds took) {
    estimated_ = kDecay * estimated_ + estimate;
    measured_ = kDecay * measured_ + took;
}

FairQueue::FairQueue(std::size_t threads, Limits limits)
    : maxLongRunning_(threads > 1 ? threads - std::max<std::size_t>(1, threads / 4) : 1), limits_(limits) {}

Seconds FairQueue::correctedCost(const Lane& lane, Seconds estimate) const {
    const double ofClient = lane.client_->correction_.factor(correction_.factor(1));
    return std::max(kMinCost, lane.correction_.factor(ofClient) * estimate);
}

/// Returns the cost of a job as `scheduler_` counts it for the job's class (all short jobs, or all long ones): the cost
/// divided by the weight of the class, which is its number of active clients.
Seconds FairQueue::classCost(JobLength length, Seconds cost) const {
    return cost / std::max<std::size_t>(1, classes_[length].clients.activeFlows());
}

bool FairQueue::push(Job job, const LanePtr& lane, Seconds estimate, Clock::time_point now) {
    ClientFlow& client = *lane->client_;
    if (waiting_ >= limits_.total || client.waiting_ >= limits_.perClient) return false;
    ++waiting_;
    ++client.waiting_;
    estimate = std::max(kMinCost, estimate);
    const Seconds cost = correctedCost(*lane, estimate);
    const JobLength length =
        cost > kLongJobThreshold * std::clamp(correction_.factor(1), 1.0, 2.0) ? long_job : short_job;
    lane->jobs_.push_back({std::move(job), estimate, cost, length});
    updateActiveLanes(lane, length, now);
    if (lane->jobs_.size() == 1) scheduleLane(lane);
    return true;
}

std::optional<FairQueue::DueJob> FairQueue::pop(Clock::time_point now) {
    if (scheduler_.empty()) return std::nullopt;
    const JobLength length = longJobsMustWait(now) ? short_job : scheduler_.next();
    JobClass& jobClass = classes_[length];
    if (jobClass.clients.empty()) return std::nullopt;
    const ClientFlowPtr client = jobClass.clients.next();
    const LanePtr lane = client->lanes_[length].next();
    QueuedJob first = std::move(lane->jobs_.front());
    lane->jobs_.pop_front();
    --waiting_;
    --client->waiting_;
    if (length == long_job) ++longRunning_;
    scheduler_.recordStart(jobClass.state, classCost(length, first.cost));
    jobClass.clients.recordStart(client->states_[length], first.cost);
    client->lanes_[length].recordStart(lane->states_[length], first.cost);
    client->lanes_[length].remove(lane->states_[length]);
    scheduleClient(client, length);
    if (!lane->jobs_.empty()) scheduleLane(lane);
    return DueJob{std::move(first.job), lane, first.estimate, first.cost, length};
}

void FairQueue::finished(const DueJob& started, Seconds took) {
    Lane& lane = *started.lane;
    ClientFlow& client = *lane.client_;
    const JobLength length = started.length;
    if (length == long_job) --longRunning_;
    for (EstimateCorrection* each : {&lane.correction_, &client.correction_, &correction_})
        each->learn(started.estimate, std::min(took, kMaxOverrun * started.cost));
    const Seconds more = took - started.cost;
    scheduler_.recordEnd(classes_[length].state, classCost(length, more));
    classes_[length].clients.recordEnd(client.states_[length], more);
    client.lanes_[length].recordEnd(lane.states_[length], more);
    if (lane.states_[length].entry) {
        scheduleLane(started.lane);
    } else {
        scheduleClient(lane.client_, length);
    }
}

Seconds FairQueue::nextCost(const ClientFlow& client, JobLength length) {
    return client.lanes_[length].next()->jobs_.front().cost;
}

/// Updates the positions of a lane, of its client and of the class of the lane's first job in the queues of their
/// schedulers. Must be called when the lane's first job or virtual finish time has changed. The lane must not be empty.
void FairQueue::scheduleLane(const LanePtr& lane) {
    const QueuedJob& first = lane->jobs_.front();
    lane->client_->lanes_[first.length].enqueueFlow(lane->states_[first.length], lane, first.cost);
    scheduleClient(lane->client_, first.length);
}

/// Updates the positions of a client and of the class of jobs of this length in the queues of their schedulers; removes
/// from its queue each of the two that has no waiting job of this length. Must be called when the client's next job of
/// this length, or the client's virtual finish time, has changed.
void FairQueue::scheduleClient(const ClientFlowPtr& client, JobLength length) {
    JobClass& jobClass = classes_[length];
    if (client->lanes_[length].empty()) {
        jobClass.clients.remove(client->states_[length]);
    } else {
        jobClass.clients.enqueueFlow(client->states_[length], client, nextCost(*client, length));
    }
    if (jobClass.clients.empty()) {
        scheduler_.remove(jobClass.state);
    } else {
        scheduler_.enqueueFlow(jobClass.state, length, classCost(length, nextCost(*jobClass.clients.next(), length)));
    }
}

/// Records that the lane queues a job of this length. Puts the lane at the end of `recentShortLanes_`, unless it has
/// queued a long job within the last kActivePeriod. While `recentShortLanes_` is not empty, no long job starts on a
/// reserved thread, so that these threads stay free for the short jobs of the lanes in `recentShortLanes_`.
void FairQueue::updateActiveLanes(const LanePtr& lane, JobLength length, Clock::time_point now) {
    pruneRecentShortLanes(now);
    if (length == long_job) lane->lastLong_ = now;
    if (lane->lastLong_ && now - *lane->lastLong_ <= kActivePeriod) return;
    if (const auto before =
            std::exchange(lane->activity_, recentShortLanes_.emplace(recentShortLanes_.end(), now, lane))) {
        recentShortLanes_.erase(*before);
    }
}

void FairQueue::pruneRecentShortLanes(Clock::time_point now) {
    for (; !recentShortLanes_.empty(); recentShortLanes_.pop_front()) {
        const auto& [last, weak] = recentShortLanes_.front();
        const LanePtr lane = weak.lock();
        if (lane && now - last <= kActivePeriod) return;
        if (lane) lane->activity_.reset();
    }
}

/// Returns whether long jobs must wait: long jobs run on all threads that are not reserved, and the next long job may
/// not start on a reserved one.
bool FairQueue::longJobsMustWait(Clock::time_point now) {
    if (longRunning_ < maxLongRunning_) return false;
    pruneRecentShortLanes(now);
    const FairScheduler<ClientFlowPtr>& clients = classes_[long_job].clients;
    return !recentShortLanes_.empty() ||
           (!clients.empty() && nextCost(*clients.next(), long_job) > kVeryLongJobThreshold);
}

bool FairQueue::hasStartableJob(Clock::time_point now) {
    return waiting_ > 0 && !(classes_[short_job].clients.empty() && longJobsMustWait(now));
}

std::deque<FairQueue::Job> FairQueue::clear() {
    std::deque<Job> dropped;
    while (!scheduler_.empty()) {
        const JobLength length = scheduler_.next();
        const ClientFlowPtr client = classes_[length].clients.next();
        const LanePtr lane = client->lanes_[length].next();
        client->waiting_ -= lane->jobs_.size();
        waiting_ -= lane->jobs_.size();
        for (QueuedJob& each : lane->jobs_) dropped.push_back(std::move(each.job));
        lane->jobs_.clear();
        client->lanes_[length].remove(lane->states_[length]);
        scheduleClient(client, length);
    }
    return dropped;
}

}  // namespace oval4d::parallel
