#pragma once
// Sends the pictures and states of a session to its clients.

#include <boost/asio/io_context.hpp>
#include <boost/asio/strand.hpp>
#include <cassert>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "errors/error.hpp"
#include "net/live/draft_timing.hpp"
#include "net/live/metered_session.hpp"
#include "net/live/motion_timing.hpp"
#include "net/live/pacing.hpp"
#include "net/live/peer.hpp"
#include "net/live/picture_jobs.hpp"
#include "net/live/snapshot.hpp"
#include "net/live/snapshot_picture_cache.hpp"
#include "net/one_shot_timer.hpp"
#include "net/services.hpp"
#include "pipeline/pipeline.hpp"
#include "slicing/section_name.hpp"

namespace oval4d::net {

/// Sends the states of a session, and pictures of them, to all its clients. Each client receives pictures of the newest
/// state as fast as workers make them and the client shows them. At most one picture job of a session is queued or
/// being drawn. It makes the pictures of one revision for all clients that can receive them; clients with equal
/// PictureStreamKeys share a picture. A newer state replaces the state of a queued job. While a picture is encoded, the
/// next one may be drawn. While the object or the focus moves, the publisher makes one step whenever a client can
/// receive the next picture. Every function runs on the session's strand.
class SessionPublisher : public std::enable_shared_from_this<SessionPublisher> {
  public:
    using Strand = boost::asio::strand<boost::asio::io_context::executor_type>;
    using Clock = PicturePacing::Clock;
    /// A client, with the job queues for its work in this session: one in the pool for pictures, one in the pool for
    /// exports.
    struct JobQueuesOfClient {
        ClientAccountPtr client;
        parallel::WorkerPool::JobQueuePtr pictures, exports;
    };

    /// `sessionId` is for the log. `metered` is the session; its owner must call recordSessionChange() after each
    /// change.
    SessionPublisher(Services services, Strand strand, std::string sessionId, std::shared_ptr<MeteredSession> metered);

    /// Sets the function that is called after each step of a motion, so that its caller can save the changed session.
    /// Must be called before a client is added.
    void setMotionListener(std::function<void()> moved) { moved_ = std::move(moved); }

    /// Adds a client, or changes the pictures of a client that was added before. The client receives pictures of the
    /// kind `key`; if key.stream is `none`, only states.
    void addSubscriber(const std::shared_ptr<Peer>& peer, const PictureStreamKey& key);
    void remove(const Peer* peer) { subscribers_.erase(peer); }
    bool hasClients() const { return !subscribers_.empty(); }
    /// Returns the kind of pictures that a client receives; null if the client was not added. The pointer is valid
    /// until the next addSubscriber() or remove().
    const PictureStreamKey* streamOf(const Peer& peer) const;
    /// Returns the job queues of the client `own` in this session. All connections of the client to the session share
    /// these queues, so that several connections get no larger share of the workers than one.
    JobQueuesOfClient jobQueuesOf(const ClientAccountPtr& own) const;
    /// Closes the connections of all clients with a WebSocket close code and a reason.
    void closeAll(std::uint16_t code, const std::string& reason);

    /// Records that the session has reached a new revision.
    void recordSessionChange(Clock::time_point now) { draftTiming_.recordChange(now); }
    /// Makes only drafts of the pictures of a field until the session rests, as during quick changes (see DraftTiming).
    void beginDrafts() { draftTiming_.beginQuickChanges(); }
    /// Records that a client has shown the picture of this revision, and sends the next picture.
    void recordPictureShown(const Peer& peer, std::uint64_t ofRevision);
    /// Sends every client the newest state or picture, if it is ready and the client can receive it. Requests missing
    /// pictures. Must be called whenever the session may have changed, a client may have become able to receive a
    /// picture, or a worker may have become available.
    void sendAndRequestPictures();

    /// Returns the time at which the session reached its current revision.
    Clock::time_point lastChangeTime() const { return draftTiming_.lastChangeTime(); }
    /// Returns the current state with the names of its section, without slices. Returns null if naming the section may
    /// take long and no worker has named it yet.
    SessionSnapshotPtr currentState();
    /// Returns a job for a worker. The job names the section of the state that is now current, and returns this state.
    std::function<SessionSnapshotPtr(pipeline::Pipeline&)> currentStateJob() const;
    /// Keeps a state that a currentStateJob() has returned, with the name of its section. currentState() then returns
    /// this state without computing the name again. If the session has changed since the job was created, does nothing
    /// and returns false.
    bool storeStateIfCurrent(const SessionSnapshotPtr& state);

    /// Returns the section that was named last. It may belong to an earlier state. Empty if no section has been named.
    const std::optional<slicing::NamedSection>& lastNamedSection() const { return section_; }
    /// Returns the snapshot of the current revision in full quality; null if there is none.
    SessionSnapshotPtr currentFullSnapshot() const {
        return pictures_.findSnapshot(revision(), slicing::Quality::full);
    }

  private:
    // A connected client of this session, with what it has been sent.
    struct Subscriber {
        std::weak_ptr<Peer> peer;
        JobQueuesOfClient jobQueues;
        PictureStreamKey streamKey;
        PicturePacing pacing;
        slicing::Quality quality = slicing::Quality::full;  // quality of the newest picture that was sent
        bool stateInFlight = false;  // whether a `state` message is queued but not written; only if streamKey.stream is
                                     // `none`
    };
    // A picture that could not be made, and the reason.
    using FailedPicture = std::pair<PictureStreamKey, Error>;
    // A job that makes the pictures of one revision: one picture for each PictureStreamKey among the waiting clients.
    struct RevisionPicturesJob {
        std::uint64_t number = 0;  // identifies the job within the session; starts at 1
        session::State state;
        std::uint64_t revision = 0;
        Clock::time_point changed;  // the time at which the session reached this revision
        slicing::Quality quality = slicing::Quality::full;
        SessionSnapshotPtr
            snapshot;  // the snapshot of this revision and quality if it has already been made, else null
        std::vector<PictureStreamKey> wanted;          // the pictures to make
        std::optional<slicing::NamedSection> section;  // section_ at the creation of the job
    };
    // The result of a RevisionPicturesJob: the pictures that it has made, and those that have failed.
    struct RevisionPictures {
        std::uint64_t job = 0;  // number of the job
        std::uint64_t revision = 0;
        slicing::Quality quality = slicing::Quality::full;
        SessionSnapshotPtr snapshot;
        SnapshotPictureCache::MessagesByStream pictures;
        std::vector<FailedPicture> failed;
    };

    void assertOnStrand() const {
        assert(strand_.running_in_this_thread() && "the session is used outside its strand");
    }
    std::uint64_t revision() const { return session_.revision; }
    bool isNamedSectionCurrent() const;
    void advanceMotion();
    slicing::Quality wantedQuality() const;
    void scheduleFullQualityPictures();
    void requestPictures(std::vector<PictureStreamKey> wanted);
    const Subscriber& subscriberToCharge(const std::vector<PictureStreamKey>& wanted) const;
    void scheduleRetry();
    void onPictureJobDone(RevisionPictures result);
    void sendStateAndPicture(Subscriber& subscriber, const OutgoingMessage& picture);
    void requestState(const Subscriber& subscriber);
    void onStateMade(const SessionSnapshotPtr& made);
    void sendState(Subscriber& subscriber, const SessionSnapshot& snapshot);
    void scheduleShownTimeout();
    void assumeOverduePicturesShown();
    Clock::duration shownTimeout() const;
    bool isReadyForNextPicture(const Subscriber& subscriber) const;

    // The functions of this group run on a worker.
    void makeQueuedPictures(pipeline::Pipeline& pipeline);
    void onLastPictureDrawn(const RevisionPicturesJob& job, const PictureStreamKey& key);

    // The members of this group do not change after construction.
    const Services services_;  // declared first, because other members are initialized from it
    const Strand strand_;
    const std::string sessionId_;
    std::function<void()> moved_;

    // Only code on the strand uses the members of this group.
    const std::shared_ptr<MeteredSession> metered_;
    session::Session& session_;  // the value of metered_
    std::map<const Peer*, Subscriber> subscribers_;
    DraftTiming draftTiming_;
    MotionTiming motionTiming_;
    PictureJobs inProgress_;
    SnapshotPictureCache pictures_;  // kept while a client waits for a picture, else empty
    SessionSnapshotPtr state_;       // what currentState() has returned for the current revision; null if nothing
    bool stateRequested_ = false;    // whether a worker has been asked for a state
    std::optional<slicing::NamedSection> section_;  // a section in the focus slice: the one that was named last
    OneShotTimer motionTimer_, paceTimer_, retryTimer_, refineTimer_;

    // Shared by the strand and a worker.
    std::mutex queuedJobMutex_;
    // The job that waits for a worker; empty if there is none. Guarded by queuedJobMutex_. Needs no lock while the
    // worker pool has no RevisionPicturesJob of this session.
    std::optional<RevisionPicturesJob> queuedJob_;
};

}  // namespace oval4d::net
