#pragma once
// A session with connected clients.

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/strand.hpp>
#include <cassert>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "net/live/critical_searches.hpp"
#include "net/live/draft_timing.hpp"
#include "net/live/made_pictures.hpp"
#include "net/live/motion_timing.hpp"
#include "net/live/pictures_in_progress.hpp"
#include "net/live/snapshot.hpp"
#include "net/one_shot_timer.hpp"
#include "net/services.hpp"
#include "net/shared_bytes.hpp"
#include "net/live/message.hpp"
#include "net/live/pacing.hpp"
#include "net/live/peer.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"
#include "store/write_behind_store.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// A session in use: holds the session's value and its clients, applies commands, and sends states and pictures to the
/// clients. Its data is used only on its strand. Every command is applied when it arrives. Pictures of the newest state
/// follow as fast as workers make them and clients show them. To this end, a session has at most one picture job that
/// is queued or being drawn. A newer state replaces the state of a queued job. While one picture is encoded, the next
/// one may be drawn. The picture of a revision is made once and shared by all clients with the same stream, encoding
/// and viewport. Public functions may be called from any thread.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
  public:
    using Strand = boost::asio::strand<boost::asio::io_context::executor_type>;
    using RequestId = std::optional<double>;  ///< the id of a request; empty if the request has none

    /// `client`: the client that opened the session; the session's memory counts against this client's byte account.
    /// `value`: the session, new or read from the store.
    LiveSession(Services services, store::WriteBehindStore& writeBehind, store::SessionCredentials credentials,
                ClientPtr client, session::Session value);

    const store::SessionCredentials& credentials() const { return credentials_; }

    /// Adds a client, or changes its stream if it was added before, and sends it the message `welcome`. The state and a
    /// picture follow.
    boost::asio::awaitable<void> welcome(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id);

    /// Executes a request of a client that was added with welcome(), and returns once the request is answered.
    boost::asio::awaitable<void> execute(std::shared_ptr<Peer> peer, wire::Request request);

    /// The result of a command.
    struct Applied {
        std::uint64_t revision = 0;
        std::vector<std::string> warnings;  ///< about the file that was loaded
        bool owned = true;                  ///< false if another server has taken over the session in the meantime
    };
    /// Applies a command for a client that need not be connected to the session. Connected clients see the change.
    /// Errors: those of session::apply(); `too_many` if a limit on bytes or jobs is reached; `internal` if another
    /// server has taken over the session. The awaited optional is never empty.
    boost::asio::awaitable<std::optional<Result<Applied>>> apply(ClientPtr client, session::Command command);

    /// Removes the client `peer`, or none if it is null, then calls `left` with the value of the session; both happen
    /// on the session's strand. `left` must return whether the session has no clients left. If it returns true, this
    /// object never writes the session to the store again.
    void leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left);

    /// Ends the searches for critical w that a client of the session has requested. They fail with `canceled`.
    void stopSearches(std::shared_ptr<Peer> peer);

    /// Writes the whole session to the store. Releases its reference to `completion` once the session is written, or
    /// once the store is found to be unavailable.
    void save(std::shared_ptr<void> completion = {});

    /// Closes all connections, and never writes the session to the store again. Must be called when another server has
    /// taken over the session.
    void disconnectAll();

  private:
    using Clock = Pacing::Clock;

    // A client's lanes in the worker pools for its jobs in this session.
    struct Lanes {
        ClientPtr client;
        parallel::WorkerPool::LanePtr pictures, exports;
    };
    // A connection to this session.
    struct Subscriber {
        std::weak_ptr<Peer> peer;
        Lanes lanes;
        StreamKey streamKey;
        Pacing pacing;
        slicing::Quality quality = slicing::Quality::full;  // quality of the newest sent picture
        bool stateInFlight = false;  // without a stream: whether a `state` message is queued, but not yet written
    };
    // A job that makes pictures of one revision.
    struct PictureJob {
        std::uint64_t number = 0;  // identifies the job within the session; starts at 1
        session::State state;
        std::uint64_t revision = 0;
        Clock::time_point changed;  // the time at which the session reached this revision
        slicing::Quality quality = slicing::Quality::full;
        SnapshotPtr snapshot;  // the snapshot of this revision and quality if it has already been made, else null
        std::vector<StreamKey> wanted;  // the pictures to make
    };
    // The result of a PictureJob.
    struct JobResult {
        std::uint64_t job = 0;  // number of the job
        std::uint64_t revision = 0;
        slicing::Quality quality = slicing::Quality::full;
        SnapshotPtr snapshot;
        MadePictures::List pictures;
        std::vector<StreamKey> failed;  // the pictures that could not be made
    };

    // The following functions run on the strand.
    void assertOnStrand() const {
        assert(strand_.running_in_this_thread() && "the session is used outside its strand");
    }
    boost::asio::awaitable<void> executeOnStrand(std::shared_ptr<Peer> peer, wire::Request request);
    // Each executes requests of one kind, and answers them.
    boost::asio::awaitable<void> run(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id);
    boost::asio::awaitable<void> run(std::shared_ptr<Peer> peer, session::Command command, RequestId id);
    boost::asio::awaitable<void> run(std::shared_ptr<Peer> peer, wire::PictureShown shown, RequestId id);
    boost::asio::awaitable<void> run(std::shared_ptr<Peer> peer, wire::Ping ping, RequestId id);
    boost::asio::awaitable<void> run(std::shared_ptr<Peer> peer, wire::Get get, RequestId id);
    Lanes lanesOf(const ClientPtr& own) const;
    boost::asio::awaitable<void> answerWithPicture(std::shared_ptr<Peer> peer, StreamKey key, RequestId id,
                                                   std::optional<glm::dvec2> point = {});
    void answerWithAddress(Peer& peer, RequestId id);
    boost::asio::awaitable<void> answerWithFile(std::shared_ptr<Peer> peer, exports::ExportRequest request,
                                                RequestId id);
    boost::asio::awaitable<void> answerWithCritical(std::shared_ptr<Peer> peer, RequestId id);
    boost::asio::awaitable<Result<slicing::CriticalPtr>> findCritical(std::shared_ptr<Peer> peer);
    std::shared_ptr<CriticalSearchRun> beginSearch(const std::shared_ptr<Peer>& peer);
    std::function<Message(pipeline::Pipeline&)> requestedJob(const StreamKey& key, RequestId id,
                                                             std::optional<glm::dvec2> point) const;
    boost::asio::awaitable<std::optional<Result<Applied>>> applyOnStrand(ClientPtr by, session::Command command);
    boost::asio::awaitable<Result<Applied>> perform(ClientPtr by, std::shared_ptr<Peer> peer,
                                                    const session::Command& command, bool awaitStore);
    std::shared_ptr<session::ObjectLoader> makeLoader() const;
    boost::asio::awaitable<std::optional<Error>> loadPending(ClientPtr by,
                                                             std::shared_ptr<session::ObjectLoader> loader,
                                                             std::shared_ptr<CriticalSearchRun> search);
    std::function<void(std::function<void(bool)>)> storeWriter(store::WriteBehindStore::SaveScope scope);
    void updateReservation(bool objectsChanged);
    void scheduleSave();
    void saveNow(store::WriteBehindStore::Written written = {});
    void sendError(Peer& peer, const Error& error, RequestId id);

    void update();
    void advanceMotion();
    slicing::Quality wantedQuality() const;
    void scheduleRefinement();
    void requestPictures(std::vector<StreamKey> wanted);
    const Subscriber& clientToCharge(const std::vector<StreamKey>& wanted) const;
    void scheduleRetry();
    void onJobDone(JobResult result);
    void sendPicture(Subscriber& client, const Message& picture);
    std::string stateText(RequestId id, scene::Scheme scheme) const;
    void sendState(Subscriber& client);
    void schedulePacing();
    void expirePictures();
    Clock::duration shownTimeout() const;
    bool readyForNext(const Subscriber& client) const;
    std::uint64_t revision() const { return session_.revision; }

    // The following functions run on a worker.
    void logFailedPicture(const session::State& state, std::uint64_t ofRevision, const std::exception& why);
    void runJob(pipeline::Pipeline& pipeline);
    void onDrawn(const PictureJob& job, const StreamKey& key);

    // Constant after construction.
    const Services services_;  // declared first: other members are initialized from it
    store::WriteBehindStore& writeBehind_;
    const store::SessionCredentials credentials_;
    const ClientPtr client_;
    Strand strand_;  // runs all code that uses the members of the next group

    // Used only on the strand.
    session::Session session_;
    std::size_t objectMemory_ = 0;  // session::ownObjectMemory() of session_
    ByteBudget::Reservation held_;  // reserves objectMemory_ and the memory of the history
    std::map<const Peer*, Subscriber> clients_;
    DraftTiming draftTiming_;
    MotionTiming motionTiming_;
    PicturesInProgress inProgress_;
    MadePictures pictures_;  // kept while a client waits for one, else empty
    SharedBytes stateText_;        // the `state` message of stateRevision_, for clients without a stream or a scheme
    std::optional<std::uint64_t> stateRevision_;
    CriticalSearches searches_;
    OneShotTimer motionTimer_, paceTimer_, saveTimer_, retryTimer_, refineTimer_;
    bool detached_ = false;  // whether this object must no longer write the session to the store

    // Shared by the strand and a worker.
    std::mutex queuedJobMutex_;
    // The job that waits for a worker; empty if there is none. Guarded by queuedJobMutex_, but needs no lock while no
    // job is posted.
    std::optional<PictureJob> queuedJob_;
};

}  // namespace oval4d::net
