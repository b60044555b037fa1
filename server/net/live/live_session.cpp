#include "net/live/live_session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <tuple>
#include <utility>

#include "fields/field.hpp"
#include "net/coroutine_helpers.hpp"
#include "net/jobs/data_names.hpp"
#include "net/jobs/file_reader.hpp"
#include "net/jobs/export_job.hpp"
#include "net/jobs/loader_job.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "pipeline/cost.hpp"
#include "session/history.hpp"
#include "session/query.hpp"
#include "wire/messages.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using wire::Stream;

namespace {

using namespace std::chrono_literals;

// Delay from a change until the session is saved. The store must be at most a second behind the session, even on a busy
// machine.
constexpr std::chrono::milliseconds kSaveDelay{250};

Message doneMessage(LiveSession::RequestId id, std::uint64_t revision) {
    return textMessage(wire::doneMessage(id, revision));
}

// Time until the next attempt after the job queue was full.
constexpr auto kRetryInterval = 100ms;

const Error kLostField{
    ErrorCode::bad_field,
    "the file of this field has been changed or shortened, or cannot be read any more; load it again"};

/// Returns whether the samples of the field that is shown can no longer be read.
bool isFieldLost(const session::State& state) {
    const fields::Field* const field = slicing::fieldIn(state.object);
    return field != nullptr && field->isLost();
}

/// The completion handler of a coroutine of a session, which keeps the session alive until then.
struct KeepAlive {
    std::shared_ptr<LiveSession> session;
    void operator()(const std::exception_ptr& /*failure*/) const {}
};

const Error kNoPicture{ErrorCode::internal, "this picture could not be made; the session continues"};

}  // namespace

LiveSession::LiveSession(Services services, store::WriteBehindStore& writeBehind, store::SessionCredentials credentials,
                         ClientPtr client, session::Session value)
    : services_(services),
      writeBehind_(writeBehind),
      credentials_(std::move(credentials)),
      client_(std::move(client)),
      strand_(asio::make_strand(services.io)),
      session_(std::move(value)),
      objectMemory_(session::ownObjectMemory(session_)),
      held_(client_->byteAccount().forceReserve(objectMemory_ + session::historyMemory(session_))),
      draftTiming_(Clock::now()),
      motionTimer_(strand_),
      paceTimer_(strand_),
      saveTimer_(strand_),
      retryTimer_(strand_),
      refineTimer_(strand_) {}

asio::awaitable<void> LiveSession::welcome(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id) {
    return asio::co_spawn(strand_, run(std::move(peer), std::move(hello), id), asio::use_awaitable);
}

asio::awaitable<void> LiveSession::execute(std::shared_ptr<Peer> peer, wire::Request request) {
    return asio::co_spawn(strand_, executeOnStrand(std::move(peer), std::move(request)), asio::use_awaitable);
}

asio::awaitable<std::optional<Result<LiveSession::Applied>>> LiveSession::apply(ClientPtr client,
                                                                                session::Command command) {
    return asio::co_spawn(strand_, applyOnStrand(std::move(client), std::move(command)), asio::use_awaitable);
}

void LiveSession::leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left) {
    stopSearches(peer);
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer), left = std::move(left)] {
        self->clients_.erase(peer.get());
        self->detached_ = left(self->session_) || self->detached_;
    });
}

void LiveSession::stopSearches(std::shared_ptr<Peer> peer) {
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer)] {
        self->searches_.stop(peer);
    });
}

void LiveSession::save(std::shared_ptr<void> completion) {
    asio::post(strand_, [self = shared_from_this(), completion = std::move(completion)] {
        self->saveNow([completion](bool /*written*/) {});
    });
}

void LiveSession::disconnectAll() {
    asio::post(strand_, [self = shared_from_this()] {
        self->detached_ = true;
        for (const auto& [key, client] : self->clients_) {
            if (const auto peer = client.peer.lock()) {
                peer->close(close_code::kStopping, "another server has taken over this session");
            }
        }
    });
}

/// Adjusts the bytes reserved on the client's account to the memory of the session after a command. If that would
/// exceed the limit, forgets the older half of the undo steps.
void LiveSession::updateReservation(bool objectsChanged) {
    assertOnStrand();
    if (objectsChanged) objectMemory_ = session::ownObjectMemory(session_);
    const std::size_t bytes = objectMemory_ + session::historyMemory(session_);
    if (bytes > held_.size() && !held_.growTo(bytes)) {
        session::forgetOlderHalf(session_);
        objectMemory_ = session::ownObjectMemory(session_);
    }
    held_.resize(objectMemory_ + session::historyMemory(session_));
}

void LiveSession::saveNow(store::WriteBehindStore::Written written) {
    assertOnStrand();
    if (!detached_)
        writeBehind_.save(credentials_.id, session_, store::WriteBehindStore::SaveScope::whole, std::move(written));
}

/// Schedules a save. Must be called after each change.
void LiveSession::scheduleSave() {
    assertOnStrand();
    if (writeBehind_.writePolicy() == store::Store::WritePolicy::at_close) return;
    saveTimer_.start(weak_from_this(), Clock::now() + kSaveDelay, [](LiveSession& session) { session.saveNow(); });
}

/// Returns a function that writes the session, or only its head, to the store. The returned function calls its argument
/// when the write is done: see WriteBehindStore::save().
std::function<void(std::function<void(bool)>)> LiveSession::storeWriter(store::WriteBehindStore::SaveScope scope) {
    session::Session value;
    if (scope == store::WriteBehindStore::SaveScope::whole) {
        value = session_;
    } else {
        value.current = session_.current;
        value.revision = revision();
    }
    return [self = shared_from_this(), scope, value](const std::function<void(bool)>& written) {
        self->writeBehind_.save(self->credentials_.id, value, scope, written);
    };
}

asio::awaitable<void> LiveSession::run(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id) {
    assertOnStrand();
    Lanes lanes = lanesOf(peer->client());
    const StreamKey key{hello.stream, hello.encoding, hello.viewport, hello.scheme};
    clients_[peer.get()] = Subscriber{peer, std::move(lanes), key, {}};
    peer->send(
        textMessage(wire::welcomeMessage(credentials_.id, credentials_.token, limitsJson(services_.options), id)));
    update();
    co_return;
}

/// Returns the lanes of a client in this session. All connections of a client to a session share these lanes,
/// so that a client with several connections gets no larger share of the workers.
LiveSession::Lanes LiveSession::lanesOf(const ClientPtr& own) const {
    for (const auto& [key, client] : clients_) {
        if (client.lanes.client == own) return client.lanes;
    }
    return {own, std::make_shared<parallel::WorkerPool::Lane>(own->pictureFlow()),
            std::make_shared<parallel::WorkerPool::Lane>(own->exportFlow())};
}

asio::awaitable<void> LiveSession::executeOnStrand(std::shared_ptr<Peer> peer, wire::Request request) {
    assertOnStrand();
    // This does not compile if a kind of request has no function `run`.
    co_await std::visit([&](const auto& body) { return run(peer, body, request.id); }, request.body);
}

asio::awaitable<void> LiveSession::run(std::shared_ptr<Peer> peer, wire::PictureShown shown, RequestId id) {
    if (id) peer->send(doneMessage(id, revision()));
    if (const auto client = clients_.find(peer.get()); client != clients_.end()) {
        client->second.pacing.shown(shown.revision);
        update();
    }
    co_return;
}

asio::awaitable<void> LiveSession::run(std::shared_ptr<Peer> peer, wire::Ping /*ping*/, RequestId id) {
    const parallel::WorkerPool& workers = services_.pictureWorkers.workers();
    peer->send(textMessage(wire::pongMessage({workers.size(), workers.waiting(), workers.busyTime().count(),
                                              Seconds(Clock::now().time_since_epoch()).count()},
                                             id)));
    co_return;
}

asio::awaitable<void> LiveSession::run(std::shared_ptr<Peer> peer, session::Command command, RequestId id) {
    const auto applied = co_await perform(peer->client(), peer, command, id.has_value());
    if (!applied) {
        sendError(*peer, applied.error(), id);
        co_return;
    }
    if (!applied->owned) co_return;  // this client is being disconnected
    if (id) peer->send(textMessage(wire::doneMessage(id, applied->revision, applied->warnings)));
    update();
}

asio::awaitable<std::optional<Result<LiveSession::Applied>>> LiveSession::applyOnStrand(ClientPtr by,
                                                                                        session::Command command) {
    const auto applied = co_await perform(std::move(by), nullptr, command, true);
    if (applied && !applied->owned) co_return Result<Applied>(kInternalError);
    update();
    co_return applied;
}

/// Returns a loader that defers slow work.
std::shared_ptr<session::ObjectLoader> LiveSession::makeLoader() const {
    const session::CriticalSearch search{&services_.critical, services_.options.file.time};
    return std::make_shared<session::ObjectLoader>(services_.options.session, services_.polytopes,
                                                   session::ObjectLoader::Mode::deferred, fileReader(services_),
                                                   search);
}

/// Applies a command. Slow work runs on a worker: later messages of this client wait for it, but not those of other
/// clients. If several servers share the store, a command may be acknowledged only when its result is in the store;
/// with `awaitStore`, this function waits for that.
asio::awaitable<Result<LiveSession::Applied>> LiveSession::perform(ClientPtr by, std::shared_ptr<Peer> peer,
                                                                   const session::Command& command, bool awaitStore) {
    const auto loader = makeLoader();
    Result<std::monostate> done = kInternalError;
    std::uint64_t before = 0;
    slicing::Object source, shown;
    session::LoadedObjects loaded;
    try {
        for (;;) {
            before = revision();
            source = session_.current.source;
            shown = session_.current.object;
            loaded = session_.loaded;
            done = session::apply(session_, command, services_.options.session, *loader);
            if (!loader->isPending()) break;
            std::shared_ptr<CriticalSearchRun> search;
            if (loader->isSearchPending()) {
                search = beginSearch(peer);
                // The client's next message waits for this command, so otherwise nothing would be read from it.
                if (peer) peer->watchWhileExecuting();
            }
            if (auto refused = co_await loadPending(by, loader, std::move(search))) {
                done = std::move(*refused);
                break;
            }
        }
        if (done) updateReservation(session_.current.object != shown || session_.loaded != loaded);
    } catch (const parallel::QueueFull&) {
        done = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("command failed session={} fault=\"{}\"", credentials_.id, fault.what());
        done = kInternalError;
    }
    if (!done) co_return done.error();
    Applied applied{revision(), loader->warnings(), true};
    // The command may have extended a field that is not shown: then the source stays the same.
    const bool hasNewObject = session_.current.source != source || session_.loaded != loaded;
    if (applied.revision == before && !hasNewObject) co_return applied;
    if (applied.revision != before) draftTiming_.change(Clock::now());
    searches_.stopOthers(session_.current);
    // The draft of a field that is larger than memory comes much sooner than the first complete picture.
    const fields::Field* const field = slicing::fieldIn(session_.current.object);
    if (session_.current.source != source && field != nullptr && field->source) draftTiming_.begin();
    scheduleSave();
    if (writeBehind_.writePolicy() == store::Store::WritePolicy::at_once) {
        // The head of a record is saved without objects, so a new object requires a save of the whole session.
        auto write = storeWriter(hasNewObject ? store::WriteBehindStore::SaveScope::whole
                                              : store::WriteBehindStore::SaveScope::head);
        if (awaitStore) {
            applied.owned = co_await awaitCallback<bool>(std::move(write));
        } else {
            write([](bool) {});
        }
    }
    co_return applied;
}

/// Begins a search for the critical w of the current state.
std::shared_ptr<CriticalSearchRun> LiveSession::beginSearch(const std::shared_ptr<Peer>& peer) {
    assertOnStrand();
    return searches_.begin(peer, session_.current, services_.exportWorkers.stopToken());
}

/// Builds or reads the loader's pending object on a worker, or runs its `search`, which is otherwise null. Returns an
/// error if there is no room for the result.
asio::awaitable<std::optional<Error>> LiveSession::loadPending(ClientPtr by,
                                                               std::shared_ptr<session::ObjectLoader> loader,
                                                               std::shared_ptr<CriticalSearchRun> search) {
    auto reservation = client_->byteAccount().reserve(loader->bytesNeeded());
    if (!reservation) co_return kTooManyBytes;
    if (loader->pendingNeedsFile()) {
        co_await runOnPool<std::monostate>(services_.loadWorkers, loaderJob(loader), client_->loadLane(),
                                           loader->estimatedDuration());
    } else if (search) {
        co_await runOnPool<std::monostate>(services_.exportWorkers, loaderJob(loader, search->stopToken()),
                                           lanesOf(by).exports, loader->estimatedDuration());
    } else {
        co_await runOnPool<std::monostate>(services_.pictureWorkers.workers(), loaderJob(loader), lanesOf(by).pictures,
                                           loader->estimatedDuration());
    }
    const std::size_t bytes = loader->bytesLoaded();
    if (bytes > reservation->size() && !reservation->growTo(bytes)) co_return kTooManyBytes;
    co_return std::nullopt;
}

asio::awaitable<void> LiveSession::run(std::shared_ptr<Peer> peer, wire::Get get, RequestId id) {
    const auto client = clients_.find(peer.get());
    if (client == clients_.end()) co_return;
    StreamKey key = client->second.streamKey;
    if (get.viewport) key.viewport = *get.viewport;
    key.background = get.background;
    switch (get.what) {
        case wire::GetTarget::state:
            peer->send(textMessage(stateText(id, key.scheme)));
            break;
        case wire::GetTarget::catalogue: {
            const std::vector<std::string> names = co_await dataNames(services_, peer->client());
            std::vector<slicing::Object> loaded;
            for (const auto& [name, object] : session_.loaded) loaded.push_back(object);
            peer->send(textMessage(wire::catalogueMessage(id, loaded, names)));
            break;
        }
        case wire::GetTarget::keymap:
            peer->send(textMessage(wire::keymapMessage(id)));
            break;
        case wire::GetTarget::address:
            answerWithAddress(*peer, id);
            break;
        case wire::GetTarget::slices:
            key.stream = Stream::geometry;
            co_await answerWithPicture(peer, key, id);
            break;
        case wire::GetTarget::frame:
            key.stream = Stream::frames;
            co_await answerWithPicture(peer, key, id);
            break;
        case wire::GetTarget::at:
            key.stream = Stream::geometry;
            co_await answerWithPicture(peer, key, id, get.point);
            break;
        case wire::GetTarget::file:
            co_await answerWithFile(peer, get.file, id);
            break;
        case wire::GetTarget::critical:
            // The client's further messages do not wait for it.
            asio::co_spawn(strand_, answerWithCritical(peer, id), KeepAlive{shared_from_this()});
            break;
    }
}

void LiveSession::answerWithAddress(Peer& peer, RequestId id) {
    const auto query = session::queryFromState(session_.current, *makeLoader());
    if (query) {
        peer.send(textMessage(wire::addressMessage(session::queryText(*query), id)));
    } else {
        sendError(peer, query.error(), id);
    }
}

asio::awaitable<void> LiveSession::answerWithFile(std::shared_ptr<Peer> peer, exports::ExportRequest request,
                                                  RequestId id) {
    const std::uint64_t askedRevision = revision();
    ExportResult made;
    try {
        made = co_await runOnPool<ExportResult>(
            services_.exportWorkers, exportJob(services_, session_.current, request, peer->client()),
            lanesOf(peer->client()).exports, pipeline::exportCost(session_.current, request));
    } catch (const parallel::QueueFull&) {
        made = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("file failed session={} revision={} fault=\"{}\"", credentials_.id, askedRevision, fault.what());
    }
    if (!made || !*made) {
        sendError(*peer, made ? made->error() : kInternalError, id);
        co_return;
    }
    const FinishedFile& finished = **made;
    Message message;
    message.bytes = finished.bytes;
    message.binary = true;
    peer->send(std::move(message));
    peer->send(textMessage(wire::doneMessage(id, askedRevision, finished.warnings)));
}

asio::awaitable<void> LiveSession::answerWithCritical(std::shared_ptr<Peer> peer, RequestId id) {
    const std::uint64_t askedRevision = revision();
    const double originW = slicing::infoOf(session_.current.object).originInFile.w;
    Result<slicing::CriticalPtr> found = kInternalError;
    try {
        found = co_await findCritical(peer);
    } catch (const parallel::QueueFull&) {
        found = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("search failed session={} revision={} fault=\"{}\"", credentials_.id, askedRevision,
                      fault.what());
    }
    if (!found) {
        sendError(*peer, found.error(), id);
        co_return;
    }
    peer->send(textMessage(wire::criticalMessage(**found, originW, askedRevision, id)));
}

/// Finds the critical w of the current object. Unless they are known, an export worker searches for them.
asio::awaitable<Result<slicing::CriticalPtr>> LiveSession::findCritical(std::shared_ptr<Peer> peer) {
    const auto loader = makeLoader();
    const session::State asked = session_.current;
    auto found = loader->criticalSections(asked);
    if (!loader->isPending()) co_return found;
    auto search = beginSearch(peer);
    if (auto refused = co_await loadPending(peer->client(), loader, std::move(search))) co_return *refused;
    co_return loader->criticalSections(asked);
}

asio::awaitable<void> LiveSession::answerWithPicture(std::shared_ptr<Peer> peer, StreamKey key, RequestId id,
                                                     std::optional<glm::dvec2> point) {
    const std::uint64_t askedRevision = revision();
    std::optional<Error> failed;
    try {
        Message picture = co_await runOnPool<Message>(services_.pictureWorkers, requestedJob(key, id, point),
                                                      lanesOf(peer->client()).pictures,
                                                      pictureCost(session_.current, key, slicing::Quality::full));
        peer->send(std::move(picture));
        if (key.stream == Stream::frames) peer->send(doneMessage(id, askedRevision));
    } catch (const parallel::QueueFull&) {
        failed = kTooManyJobs;
    } catch (const std::exception& fault) {
        logFailedPicture(session_.current, askedRevision, fault);
        failed = isFieldLost(session_.current) ? kLostField : kInternalError;
    }
    if (failed) sendError(*peer, *failed, id);
}

/// Returns a job that makes a picture of the current state or, with a point, tells what the picture shows there.
std::function<Message(pipeline::Pipeline&)> LiveSession::requestedJob(const StreamKey& key, RequestId id,
                                                                      std::optional<glm::dvec2> point) const {
    const SnapshotPtr known = pictures_.find(revision(), slicing::Quality::full);
    return [known, state = session_.current, askedRevision = revision(), changed = draftTiming_.changed(), key, id, point,
            &metrics = services_.metrics](pipeline::Pipeline& pipeline) {
        const SnapshotPtr snapshot =
            suffices(known, key) ? known
                                 : makeSnapshot(pipeline, state, askedRevision, changed, key, slicing::Quality::full);
        if (point)
            return textMessage(
                pipeline.describePoint(state, snapshot->slices, askedRevision, id, key.viewport, *point));
        Message picture = makePicture(pipeline, *snapshot, key, id);
        metrics.observe(pipeline.times());
        return picture;
    };
}

void LiveSession::sendError(Peer& peer, const Error& error, RequestId id) {
    services_.metrics.countError(error.code);
    peer.send(textMessage(wire::errorMessage(error, id)));
}

/// Sends every client the newest state or picture, if the picture is ready and the client can receive it. Requests
/// pictures that are missing. Must be called whenever the session may have changed, a client may have become able to
/// receive a picture, or a worker may have become available.
void LiveSession::update() {
    assertOnStrand();
    advanceMotion();
    std::vector<StreamKey> missing;
    bool allServed = true;
    const slicing::Quality wanted = wantedQuality();
    for (auto& [key, client] : clients_) {
        if (client.pacing.newest() == revision() && client.quality >= wanted) continue;
        if (client.streamKey.stream == Stream::none) {
            if (!client.stateInFlight) sendState(client);
            continue;
        }
        allServed = false;
        if (!client.pacing.hasRoom()) continue;
        if (const Message* picture = pictures_.find(client.streamKey, revision(), wanted)) {
            sendPicture(client, *picture);
        } else if (!inProgress_.isEncoding(client.streamKey, revision(), wanted) &&
                   client.pacing.hasRoom(inProgress_.countEncoding(client.streamKey)) &&
                   std::ranges::find(missing, client.streamKey) == missing.end()) {
            missing.push_back(client.streamKey);
        }
    }
    if (!missing.empty()) requestPictures(std::move(missing));
    if (allServed) pictures_.clear();
    if (wanted == slicing::Quality::draft) scheduleRefinement();
}

/// Returns `draft` while a field moves or changes in quick succession, so that pictures follow fast; else `full`.
slicing::Quality LiveSession::wantedQuality() const {
    if (slicing::fieldIn(session_.current.object) == nullptr) return slicing::Quality::full;
    return session_.current.moves() || draftTiming_.isQuick() ? slicing::Quality::draft : slicing::Quality::full;
}

/// Schedules pictures of full quality for the time when the session has rested. Until the timer runs, the quality stays
/// the same, so that a busy server does not skip the draft right after a change.
void LiveSession::scheduleRefinement() {
    if (session_.current.moves()) return;
    refineTimer_.start(weak_from_this(), draftTiming_.restEnds(), [](LiveSession& session) {
        session.draftTiming_.rest(Clock::now());
        session.update();
    });
}

/// Moves an object that turns continuously or turns toward an element, if the next step is due and a client that has
/// the current revision can receive the next one.
void LiveSession::advanceMotion() {
    assertOnStrand();
    if (!session_.current.moves()) {
        motionTiming_.stop();
        return;
    }
    if (inProgress_.isDrawing() ||
        std::ranges::none_of(clients_, [this](const auto& entry) { return readyForNext(entry.second); }))
        return;
    const auto now = Clock::now();
    const auto passed = motionTiming_.step(now);
    if (!passed) {
        motionTimer_.start(weak_from_this(), motionTiming_.due(), &LiveSession::update);
        return;
    }
    const std::uint64_t before = revision();
    session::advance(session_, Seconds(*passed).count());
    if (revision() == before) return;  // it turns by the angle 0: there is nothing to send until the next command
    draftTiming_.change(now);
    scheduleSave();
}

bool LiveSession::readyForNext(const Subscriber& client) const {
    const bool hasNewest = client.pacing.newest() == revision();
    if (!hasNewest && !inProgress_.isEncoding(client.streamKey, revision(), slicing::Quality::draft)) return false;
    return client.streamKey.stream == Stream::none ? !client.stateInFlight
                                                   : client.pacing.hasRoom(inProgress_.countEncoding(client.streamKey));
}

/// Posts a job that makes these pictures, or replaces the job that is queued. Does nothing while the pictures of a job
/// are being drawn, because update() is called again afterward.
void LiveSession::requestPictures(std::vector<StreamKey> wanted) {
    assertOnStrand();
    const slicing::Quality quality = wantedQuality();
    const bool isNew = !inProgress_.isDrawing();
    const parallel::WorkerPool::LanePtr lane = clientToCharge(wanted).lanes.pictures;
    Seconds cost{0};
    for (const StreamKey& key : wanted) cost += pictureCost(session_.current, key, quality);
    PictureJob next{inProgress_.job(), session_.current,
                    revision(),        draftTiming_.changed(),
                    quality,           pictures_.find(revision(), quality),
                    std::move(wanted)};
    {
        const std::lock_guard lock(queuedJobMutex_);
        if (!isNew && !queuedJob_) return;
        queuedJob_ = std::move(next);
    }
    if (!isNew) return;
    const auto job = [self = shared_from_this()](pipeline::Pipeline& pipeline) { self->runJob(pipeline); };
    if (services_.pictureWorkers.post(job, lane, cost)) {
        inProgress_.queued();
    } else {
        queuedJob_.reset();
        scheduleRetry();
    }
}

/// Returns the client to whose lane a job is charged. The clients that receive the pictures of a job take turns.
const LiveSession::Subscriber& LiveSession::clientToCharge(const std::vector<StreamKey>& wanted) const {
    std::vector<const Subscriber*> payers;
    for (const auto& [peer, client] : clients_) {
        if (std::ranges::find(wanted, client.streamKey) != wanted.end()) payers.push_back(&client);
    }
    return *payers[inProgress_.job() % payers.size()];
}

/// Schedules another attempt after the pool has rejected a job because its queue is full.
void LiveSession::scheduleRetry() {
    retryTimer_.start(weak_from_this(), Clock::now() + kRetryInterval, &LiveSession::update);
}

void LiveSession::runJob(pipeline::Pipeline& pipeline) {
    PictureJob job;
    {
        const std::lock_guard lock(queuedJobMutex_);
        job = std::move(*queuedJob_);
        queuedJob_.reset();
    }
    JobResult result{job.number, job.revision, job.quality, job.snapshot, {}, {}};
    for (const StreamKey& key : job.wanted) {
        try {
            if (!suffices(result.snapshot, key))
                result.snapshot = makeSnapshot(pipeline, job.state, job.revision, job.changed, key, job.quality);
            std::function<void()> whenDrawn;
            if (&key == &job.wanted.back()) whenDrawn = [this, &job, &key] { onDrawn(job, key); };
            result.pictures.emplace_back(key, makePicture(pipeline, *result.snapshot, key, {}, whenDrawn));
            services_.metrics.observe(pipeline.times());
        } catch (const std::exception& fault) {
            logFailedPicture(job.state, job.revision, fault);
            result.failed.push_back(key);
        }
    }
    asio::post(strand_, [self = shared_from_this(), result = std::move(result)]() mutable {
        self->onJobDone(std::move(result));
    });
}

/// A lost file is no fault of the server.
void LiveSession::logFailedPicture(const session::State& state, std::uint64_t ofRevision, const std::exception& why) {
    if (isFieldLost(state)) {
        spdlog::warn("picture not made session={} revision={} reason=\"{}\"", credentials_.id, ofRevision, why.what());
    } else {
        spdlog::error("picture failed session={} revision={} fault=\"{}\"", credentials_.id, ofRevision, why.what());
    }
}

/// Called on a worker when the last picture of a job is drawn, but not yet encoded. From then on, the next job may be
/// queued.
void LiveSession::onDrawn(const PictureJob& job, const StreamKey& key) {
    asio::post(strand_,
               [self = shared_from_this(),
                drawn = PicturesInProgress::Encoding{job.number, job.revision, job.quality, key}] {
                   self->inProgress_.drawn(drawn);
                   self->update();
               });
}

/// Sends the pictures that a worker has made. The session may have changed in the meantime, but the pictures are still
/// newer than those that the clients have: if changes are very frequent, clients see all pictures that the workers have
/// time to make.
void LiveSession::onJobDone(JobResult result) {
    assertOnStrand();
    inProgress_.done(result.job);
    pictures_.add(result.snapshot, std::move(result.pictures));
    for (auto& [key, client] : clients_) {
        if (client.streamKey.stream == Stream::none || !client.pacing.hasRoom()) continue;
        const auto newest = client.pacing.newest();
        if (newest && std::tie(*newest, client.quality) >= std::tie(result.revision, result.quality)) continue;
        if (const Message* picture = pictures_.find(client.streamKey, result.revision, result.quality)) {
            sendPicture(client, *picture);
        } else if (std::ranges::find(result.failed, client.streamKey) != result.failed.end()) {
            client.pacing.skipped(result.revision);
            client.quality = result.quality;
            if (const auto peer = client.peer.lock())
                sendError(*peer, isFieldLost(session_.current) ? kLostField : kNoPicture, {});
        }
    }
    update();
}

/// Sends the state of the newest snapshot, followed by a picture of it.
void LiveSession::sendPicture(Subscriber& client, const Message& picture) {
    const auto peer = client.peer.lock();
    if (!peer) return;
    const Snapshot& snapshot = *pictures_.snapshot();
    client.pacing.sent(snapshot.revision);
    client.quality = snapshot.quality;
    services_.metrics.countPicture(client.streamKey.stream);
    peer->send({snapshot.stateTextFor(client.streamKey.scheme), false});
    peer->send(picture,
               [weak = weak_from_this(), to = client.peer, sent = snapshot.revision, since = snapshot.changed] {
                   const auto now = Clock::now();
                   const auto session = weak.lock();
                   if (!session) return;
                   session->services_.metrics.latency.Observe(Seconds(now - since).count());
                   asio::post(session->strand_, [session, to, sent, now] {
                       const auto written = session->clients_.find(to.lock().get());
                       if (written == session->clients_.end()) return;
                       written->second.pacing.written(sent, now);
                       session->schedulePacing();
                   });
               });
}

std::string LiveSession::stateText(RequestId id, scene::Scheme scheme) const {
    const auto section = pipeline::FocusSectionNamer().names(session_.current);
    return wire::stateMessage(session_.current, section, revision(), id, slicing::Quality::full, scheme);
}

/// Sends the newest state to a client without a stream, one message at a time: if the state changes faster than the
/// client's socket accepts messages, states in between are skipped.
void LiveSession::sendState(Subscriber& client) {
    const auto peer = client.peer.lock();
    if (!peer) return;
    SharedBytes text;
    if (client.streamKey.scheme == scene::Scheme::dark) {
        if (stateRevision_ != revision()) {
            stateText_ = SharedBytes(stateText({}, scene::Scheme::dark));
            stateRevision_ = revision();
        }
        text = stateText_;
    } else {
        text = SharedBytes(stateText({}, client.streamKey.scheme));
    }
    client.pacing.skipped(revision());
    client.quality = slicing::Quality::full;
    client.stateInFlight = true;
    peer->send({text, false}, [weak = weak_from_this(), to = client.peer] {
        const auto session = weak.lock();
        if (!session) return;
        asio::post(session->strand_, [session, to] {
            const auto written = session->clients_.find(to.lock().get());
            if (written == session->clients_.end()) return;
            written->second.stateInFlight = false;
            session->update();
        });
    });
}

/// Starts a timer for expirePictures(), after which pictures that clients have not acknowledged in time count as shown.
void LiveSession::schedulePacing() {
    std::optional<Clock::time_point> first;
    for (const auto& [key, client] : clients_) {
        const auto deadline = client.pacing.deadline(shownTimeout());
        if (deadline && (!first || *deadline < *first)) first = deadline;
    }
    if (first) paceTimer_.start(weak_from_this(), *first, &LiveSession::expirePictures);
}

void LiveSession::expirePictures() {
    for (auto& [key, client] : clients_) client.pacing.assumeShown(Clock::now(), shownTimeout());
    update();
    schedulePacing();
}

LiveSession::Clock::duration LiveSession::shownTimeout() const {
    return std::chrono::duration_cast<Clock::duration>(services_.options.shownTimeout);
}

}  // namespace oval4d::net
