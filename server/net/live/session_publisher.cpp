#include "net/live/session_publisher.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <exception>
#include <tuple>
#include <utility>

#include "net/live/errors.hpp"
#include "pipeline/cost.hpp"
#include "pipeline/focus_section.hpp"
#include "session/picture.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using wire::StreamKind;

namespace {

using namespace std::chrono_literals;

// The time between the rejection of a picture job by a full queue and the next attempt.
constexpr auto kRetryInterval = 100ms;

const Error kNoPicture{ErrorCode::internal, "this picture could not be made; the session continues"};

}  // namespace

SessionPublisher::SessionPublisher(Services services, Strand strand, std::string sessionId,
                                   std::shared_ptr<MeteredSession> metered)
    : services_(services),
      strand_(std::move(strand)),
      sessionId_(std::move(sessionId)),
      metered_(std::move(metered)),
      session_(metered_->value),
      draftTiming_(services_.clock.now()),
      motionTimer_(services_.clock, strand_),
      paceTimer_(services_.clock, strand_),
      retryTimer_(services_.clock, strand_),
      refineTimer_(services_.clock, strand_) {}

void SessionPublisher::addSubscriber(const std::shared_ptr<Peer>& peer, const PictureStreamKey& key) {
    assertOnStrand();
    JobQueuesOfClient jobQueues = jobQueuesOf(peer->client());
    subscribers_[peer.get()] = Subscriber{peer, std::move(jobQueues), key, {}};
}

const PictureStreamKey* SessionPublisher::streamOf(const Peer& peer) const {
    assertOnStrand();
    const auto subscriber = subscribers_.find(&peer);
    return subscriber == subscribers_.end() ? nullptr : &subscriber->second.streamKey;
}

SessionPublisher::JobQueuesOfClient SessionPublisher::jobQueuesOf(const ClientAccountPtr& own) const {
    for (const auto& [key, subscriber] : subscribers_) {
        if (subscriber.jobQueues.client == own) return subscriber.jobQueues;
    }
    return {own, std::make_shared<parallel::WorkerPool::JobQueue>(own->pictureFlow()),
            std::make_shared<parallel::WorkerPool::JobQueue>(own->exportFlow())};
}

void SessionPublisher::closeAll(std::uint16_t code, const std::string& reason) {
    assertOnStrand();
    for (const auto& [key, subscriber] : subscribers_) {
        if (const auto peer = subscriber.peer.lock()) peer->close(code, reason);
    }
}

void SessionPublisher::recordPictureShown(const Peer& peer, std::uint64_t ofRevision) {
    assertOnStrand();
    const auto subscriber = subscribers_.find(&peer);
    if (subscriber == subscribers_.end()) return;
    subscriber->second.pacing.recordShown(ofRevision);
    sendAndRequestPictures();
}

void SessionPublisher::sendAndRequestPictures() {
    assertOnStrand();
    advanceMotion();
    if (state_ && state_->revision != revision()) state_.reset();  // an old state may keep dropped objects alive
    std::vector<PictureStreamKey> missing;
    bool allServed = true;
    const slicing::Quality wanted = wantedQuality();
    for (auto& [key, subscriber] : subscribers_) {
        if (subscriber.pacing.newestRevisionSentOrSkipped() == revision() && subscriber.quality >= wanted) continue;
        if (subscriber.streamKey.stream == StreamKind::none) {
            if (subscriber.stateInFlight) continue;
            if (const SessionSnapshotPtr state = currentState()) {
                sendState(subscriber, *state);
            } else {
                requestState(subscriber);
            }
            continue;
        }
        allServed = false;
        if (!subscriber.pacing.maySendMore()) continue;
        if (const OutgoingMessage* picture = pictures_.find(subscriber.streamKey, revision(), wanted)) {
            sendStateAndPicture(subscriber, *picture);
        } else if (!inProgress_.isEncoding(subscriber.streamKey, revision(), wanted) &&
                   subscriber.pacing.maySendMore(inProgress_.countEncoding(subscriber.streamKey)) &&
                   std::ranges::find(missing, subscriber.streamKey) == missing.end()) {
            missing.push_back(subscriber.streamKey);
        }
    }
    if (!missing.empty()) requestPictures(std::move(missing));
    if (allServed) pictures_.clear();
    if (wanted == slicing::Quality::draft) scheduleFullQualityPictures();
}

/// Returns `draft` while a field moves or changes in quick succession, so that its pictures are made fast; otherwise
/// `full`.
slicing::Quality SessionPublisher::wantedQuality() const {
    if (slicing::fieldIn(session_.current.object) == nullptr) return slicing::Quality::full;
    return session_.current.isMoving() || draftTiming_.hasQuickChanges() ? slicing::Quality::draft
                                                                         : slicing::Quality::full;
}

/// Schedules pictures of full quality for the end of the period of quick changes (DraftTiming::quickChangesEndTime()).
/// Only the timer ends this period. So wantedQuality() returns `draft` until the timer expires, and a draft is
/// requested first even if the server was too busy to request it before quickChangesEndTime().
void SessionPublisher::scheduleFullQualityPictures() {
    if (session_.current.isMoving()) return;
    refineTimer_.startUnlessRunning(weak_from_this(), draftTiming_.quickChangesEndTime(),
                                    [](SessionPublisher& publisher) {
                                        publisher.draftTiming_.endQuickChangesIfRested(publisher.services_.clock.now());
                                        publisher.sendAndRequestPictures();
                                    });
}

/// Makes the next step of a motion (see session::advanceMotionBy()) if the step is due, and if a client has the current
/// revision and can receive the next one. Otherwise, does not make the step yet.
void SessionPublisher::advanceMotion() {
    assertOnStrand();
    if (!session_.current.isMoving()) {
        motionTiming_.stop();
        return;
    }
    if (inProgress_.isQueuedOrDrawing() ||
        std::ranges::none_of(subscribers_, [this](const auto& entry) { return isReadyForNextPicture(entry.second); }))
        return;
    const auto now = services_.clock.now();
    const auto passed = motionTiming_.stepIfDue(now);
    if (!passed) {
        motionTimer_.startUnlessRunning(weak_from_this(), motionTiming_.nextStepTime(),
                                        &SessionPublisher::sendAndRequestPictures);
        return;
    }
    const std::uint64_t before = revision();
    session::advanceMotionBy(session_, Seconds(*passed).count());
    if (revision() == before) return;  // for example, a turn by the angle 0; no next step is scheduled
    draftTiming_.recordChange(now);
    moved_();
}

bool SessionPublisher::isReadyForNextPicture(const Subscriber& subscriber) const {
    const bool hasNewest = subscriber.pacing.newestRevisionSentOrSkipped() == revision();
    if (!hasNewest && !inProgress_.isEncoding(subscriber.streamKey, revision(), slicing::Quality::draft)) return false;
    return subscriber.streamKey.stream == StreamKind::none
               ? !subscriber.stateInFlight
               : subscriber.pacing.maySendMore(inProgress_.countEncoding(subscriber.streamKey));
}

/// Queues a job that makes the pictures `wanted`. If a job is already queued, replaces what it makes. Does nothing
/// while the pictures of a job are being drawn, because sendAndRequestPictures() is called again afterward.
void SessionPublisher::requestPictures(std::vector<PictureStreamKey> wanted) {
    assertOnStrand();
    const slicing::Quality quality = wantedQuality();
    const bool isNew = !inProgress_.isQueuedOrDrawing();
    const parallel::WorkerPool::JobQueuePtr jobQueue = subscriberToCharge(wanted).jobQueues.pictures;
    Seconds cost{0};
    for (const PictureStreamKey& key : wanted) cost += pictureCost(session_.current, key, quality);
    RevisionPicturesJob next{inProgress_.currentOrNextJobNumber(),
                             session_.current,
                             revision(),
                             draftTiming_.lastChangeTime(),
                             quality,
                             pictures_.findSnapshot(revision(), quality),
                             std::move(wanted),
                             section_};
    {
        const std::lock_guard lock(queuedJobMutex_);
        if (!isNew && !queuedJob_) return;
        queuedJob_ = std::move(next);
    }
    if (!isNew) return;
    const auto job = [self = shared_from_this()](pipeline::Pipeline& pipeline) { self->makeQueuedPictures(pipeline); };
    if (services_.pictureWorkers.post(job, jobQueue, cost)) {
        inProgress_.recordQueued();
    } else {
        queuedJob_.reset();
        scheduleRetry();
    }
}

/// Returns the client in whose job queue a job for the pictures `wanted` waits. The job counts against this client's
/// share of the workers, so the clients that receive these pictures take turns.
const SessionPublisher::Subscriber& SessionPublisher::subscriberToCharge(
    const std::vector<PictureStreamKey>& wanted) const {
    std::vector<const Subscriber*> payers;
    for (const auto& [peer, subscriber] : subscribers_) {
        if (std::ranges::find(wanted, subscriber.streamKey) != wanted.end()) payers.push_back(&subscriber);
    }
    return *payers[inProgress_.currentOrNextJobNumber() % payers.size()];
}

/// Schedules another attempt after the pool has rejected a job because its queue was full.
void SessionPublisher::scheduleRetry() {
    retryTimer_.startUnlessRunning(weak_from_this(), services_.clock.now() + kRetryInterval,
                                   &SessionPublisher::sendAndRequestPictures);
}

void SessionPublisher::makeQueuedPictures(pipeline::Pipeline& pipeline) {
    RevisionPicturesJob job;
    {
        const std::lock_guard lock(queuedJobMutex_);
        job = std::move(*queuedJob_);
        queuedJob_.reset();
    }
    RevisionPictures result{job.number, job.revision, job.quality, job.snapshot, {}, {}};
    if (job.section) pipeline.reuseFocusSectionNames(*job.section);
    for (const PictureStreamKey& key : job.wanted) {
        try {
            if (!isSufficientFor(result.snapshot, key))
                result.snapshot = makeSnapshot(pipeline, job.state, job.revision, job.changed, key, job.quality);
            result.snapshot->stateTextFor(key.scheme);  // makes the text here, so that the strand need not make it
            std::function<void()> whenDrawn;
            if (&key == &job.wanted.back()) whenDrawn = [this, &job, &key] { onLastPictureDrawn(job, key); };
            result.pictures.emplace_back(key, makePicture(pipeline, *result.snapshot, key, {}, whenDrawn));
            services_.metrics.observe(pipeline.times());
        } catch (const std::exception& fault) {
            result.failed.emplace_back(key,
                                       logAndClassifyFailure(job.state, sessionId_, job.revision, fault, kNoPicture));
        }
    }
    asio::post(strand_, [self = shared_from_this(), result = std::move(result)]() mutable {
        self->onPictureJobDone(std::move(result));
    });
}

/// Called on a worker when the last picture of a job has been drawn, but not yet encoded. The next job may be queued
/// from now on.
void SessionPublisher::onLastPictureDrawn(const RevisionPicturesJob& job, const PictureStreamKey& key) {
    asio::post(strand_, [self = shared_from_this(),
                         drawn = PictureJobs::PictureBeingEncoded{job.number, job.revision, job.quality, key}] {
        self->inProgress_.recordLastPictureDrawn(drawn);
        self->sendAndRequestPictures();
    });
}

/// Sends the pictures that a worker has made to each client that has only older ones, even if the session has changed
/// since. So during very frequent changes, clients see every picture that the workers have time to make.
void SessionPublisher::onPictureJobDone(RevisionPictures result) {
    assertOnStrand();
    inProgress_.recordDone(result.job);
    if (result.snapshot && !isNamedSectionCurrent()) section_ = result.snapshot->section;
    pictures_.addUnlessOlder(result.snapshot, std::move(result.pictures));
    for (auto& [key, subscriber] : subscribers_) {
        if (subscriber.streamKey.stream == StreamKind::none || !subscriber.pacing.maySendMore()) continue;
        const auto newest = subscriber.pacing.newestRevisionSentOrSkipped();
        if (newest && std::tie(*newest, subscriber.quality) >= std::tie(result.revision, result.quality)) continue;
        if (const OutgoingMessage* picture = pictures_.find(subscriber.streamKey, result.revision, result.quality)) {
            sendStateAndPicture(subscriber, *picture);
        } else if (const auto failed = std::ranges::find(result.failed, subscriber.streamKey, &FailedPicture::first);
                   failed != result.failed.end()) {
            subscriber.pacing.recordSkipped(result.revision);
            subscriber.quality = result.quality;
            if (const auto peer = subscriber.peer.lock()) sendError(*peer, services_.metrics, failed->second, {});
        }
    }
    sendAndRequestPictures();
}

/// Sends the state of the newest snapshot, then `picture`, which shows this state.
void SessionPublisher::sendStateAndPicture(Subscriber& subscriber, const OutgoingMessage& picture) {
    const auto peer = subscriber.peer.lock();
    if (!peer) return;
    const SessionSnapshot& snapshot = *pictures_.snapshot();
    subscriber.pacing.recordSent(snapshot.revision);
    subscriber.quality = snapshot.quality;
    services_.metrics.countPicture(subscriber.streamKey.stream);
    peer->send({snapshot.stateTextFor(subscriber.streamKey.scheme), false});
    peer->send(picture,
               [weak = weak_from_this(), to = subscriber.peer, sent = snapshot.revision, since = snapshot.changed] {
                   const auto self = weak.lock();
                   if (!self) return;
                   const auto now = self->services_.clock.now();
                   self->services_.metrics.latency.Observe(Seconds(now - since).count());
                   asio::post(self->strand_, [self, to, sent, now] {
                       const auto written = self->subscribers_.find(to.lock().get());
                       if (written == self->subscribers_.end()) return;
                       written->second.pacing.recordWritten(sent, now);
                       self->scheduleShownTimeout();
                   });
               });
}

SessionSnapshotPtr SessionPublisher::currentState() {
    assertOnStrand();
    if (state_ && state_->revision == revision()) return state_;
    if (!isNamedSectionCurrent()) {
        if (!pipeline::FocusSectionNamer::isFast(session_.current.object)) return nullptr;
        section_ = pipeline::FocusSectionNamer().name(session::pictureRequestOf(session_.current));
    }
    return state_ = makeStateSnapshot(session_.current, revision(), lastChangeTime(), *section_);
}

/// Returns whether section_ still names the section in the focus slice of the current state. Most changes of the look
/// do not change the section.
bool SessionPublisher::isNamedSectionCurrent() const {
    const session::State& current = session_.current;
    return section_ && section_->isSectionOf(current.object, current.orientation, current.focusW());
}

std::function<SessionSnapshotPtr(pipeline::Pipeline&)> SessionPublisher::currentStateJob() const {
    return [state = session_.current, ofRevision = revision(), changed = lastChangeTime()](pipeline::Pipeline& worker) {
        return makeStateSnapshot(state, ofRevision, changed, worker.nameFocusSection(session::pictureRequestOf(state)));
    };
}

bool SessionPublisher::storeStateIfCurrent(const SessionSnapshotPtr& state) {
    assertOnStrand();
    if (state->revision != revision()) return false;
    state_ = state;
    section_ = state->section;
    return true;
}

/// Makes a worker name the section of the current state, for clients that receive only states. Does nothing if a worker
/// has already been asked for a state. The job waits in the job queue of `subscriber`.
void SessionPublisher::requestState(const Subscriber& subscriber) {
    assertOnStrand();
    if (stateRequested_) return;
    const auto job = [self = shared_from_this(), make = currentStateJob()](pipeline::Pipeline& pipeline) {
        SessionSnapshotPtr made;
        try {
            made = make(pipeline);
        } catch (const std::exception& fault) {
            spdlog::error("state failed session={} fault=\"{}\"", self->sessionId_, fault.what());
        }
        asio::post(self->strand_, [self, made] { self->onStateMade(made); });
    };
    stateRequested_ = services_.pictureWorkers.post(job, subscriber.jobQueues.pictures,
                                                    pipeline::focusSectionCost(session_.current.object));
    if (!stateRequested_) scheduleRetry();
}

/// Sends the state that a worker has made, even if the session has changed since, because it is newer than the states
/// that the clients have. `made` is null if the worker has failed.
void SessionPublisher::onStateMade(const SessionSnapshotPtr& made) {
    assertOnStrand();
    stateRequested_ = false;
    if (!made) return scheduleRetry();
    if (!storeStateIfCurrent(made)) {
        for (auto& [key, subscriber] : subscribers_) {
            const auto newest = subscriber.pacing.newestRevisionSentOrSkipped();
            if (subscriber.streamKey.stream == StreamKind::none && !subscriber.stateInFlight &&
                (!newest || *newest < made->revision))
                sendState(subscriber, *made);
        }
    }
    sendAndRequestPictures();
}

/// Sends the state of `snapshot` to a client that receives only states. Only one state at a time is on its way to a
/// client. If the state changes faster than the client's socket accepts messages, states in between are skipped.
void SessionPublisher::sendState(Subscriber& subscriber, const SessionSnapshot& snapshot) {
    const auto peer = subscriber.peer.lock();
    if (!peer) return;
    subscriber.pacing.recordSkipped(snapshot.revision);
    subscriber.quality = slicing::Quality::full;
    subscriber.stateInFlight = true;
    peer->send({snapshot.stateTextFor(subscriber.streamKey.scheme), false},
               [weak = weak_from_this(), to = subscriber.peer] {
                   const auto self = weak.lock();
                   if (!self) return;
                   asio::post(self->strand_, [self, to] {
                       const auto written = self->subscribers_.find(to.lock().get());
                       if (written == self->subscribers_.end()) return;
                       written->second.stateInFlight = false;
                       self->sendAndRequestPictures();
                   });
               });
}

/// Starts a timer for pictures that clients may never acknowledge. When the timer expires, assumeOverduePicturesShown()
/// marks the overdue pictures as shown.
void SessionPublisher::scheduleShownTimeout() {
    std::optional<Clock::time_point> first;
    for (const auto& [key, subscriber] : subscribers_) {
        const auto assumeShownTime = subscriber.pacing.assumeShownTime(shownTimeout());
        if (assumeShownTime && (!first || *assumeShownTime < *first)) first = assumeShownTime;
    }
    if (first) paceTimer_.startUnlessRunning(weak_from_this(), *first, &SessionPublisher::assumeOverduePicturesShown);
}

void SessionPublisher::assumeOverduePicturesShown() {
    for (auto& [key, subscriber] : subscribers_) subscriber.pacing.assumeShown(services_.clock.now(), shownTimeout());
    sendAndRequestPictures();
    scheduleShownTimeout();
}

SessionPublisher::Clock::duration SessionPublisher::shownTimeout() const {
    return std::chrono::duration_cast<Clock::duration>(services_.options.shownTimeout);
}

}  // namespace oval4d::net
