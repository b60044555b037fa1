#include "net/live/live_session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "fields/field.hpp"
#include "net/coroutine_helpers.hpp"
#include "net/jobs/data_names.hpp"
#include "net/jobs/export_job.hpp"
#include "net/jobs/file_reader.hpp"
#include "net/jobs/loader_job.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "net/live/errors.hpp"
#include "pipeline/cost.hpp"
#include "session/query.hpp"
#include "session/settings.hpp"
#include "slicing/element.hpp"
#include "wire/messages.hpp"
#include "wire/state_message.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using wire::Stream;

namespace {

constexpr const char* kTakenOverReason = "another server has taken over this session";

OutgoingMessage textAnswer(const wire::Answer& answer, LiveSession::RequestId id) {
    return textMessage(wire::answerMessage(answer, id));
}

/// The completion handler of a coroutine, which keeps the session alive until the coroutine has ended.
struct KeepSessionAlive {
    std::shared_ptr<LiveSession> session;
    void operator()(const std::exception_ptr& /*failure*/) const {}
};

}  // namespace

LiveSession::LiveSession(Services services, store::WriteBehindStore& writeBehind, store::SessionCredentials credentials,
                         store::Fence fence, AddressAccountPtr client, session::Session value)
    : services_(services),
      credentials_(std::move(credentials)),
      strand_(asio::make_strand(services.io)),
      metered_(std::make_shared<MeteredSession>(std::move(client), std::move(value))),
      session_(metered_->value),
      streams_(std::make_shared<PictureStreams>(services, strand_, credentials_.id, metered_)),
      // The saver shares the ownership of metered_.
      saver_(std::make_shared<SessionSaver>(writeBehind, credentials_.id, fence,
                                            std::shared_ptr<const session::Session>(metered_, &metered_->value),
                                            callAfterOn(strand_))) {
    streams_->whenMoved([weak = std::weak_ptr(saver_)] {
        if (const auto saver = weak.lock()) saver->scheduleSave();
    });
}

asio::awaitable<void> LiveSession::addAndWelcome(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id) {
    return execute(std::move(peer), {id, std::move(hello)});
}

asio::awaitable<void> LiveSession::execute(std::shared_ptr<Peer> peer, wire::Request request) {
    return asio::co_spawn(strand_, executeOnStrand(std::move(peer), std::move(request)), asio::use_awaitable);
}

asio::awaitable<std::optional<Result<LiveSession::CommandResult>>> LiveSession::apply(AddressAccountPtr client,
                                                                                      session::Command command) {
    return asio::co_spawn(strand_, applyOnStrand(std::move(client), std::move(command)), asio::use_awaitable);
}

void LiveSession::leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left) {
    stopSearches(peer);
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer), left = std::move(left)] {
        self->streams_->remove(peer.get());
        if (left(self->session_)) self->saver_->detach();
    });
}

void LiveSession::stopSearches(std::shared_ptr<Peer> peer) {
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer)] { self->searches_.stop(peer); });
}

void LiveSession::save(std::shared_ptr<void> completion) {
    asio::post(strand_, [self = shared_from_this(), completion = std::move(completion)] {
        self->saver_->saveNow([completion](bool /*written*/) {});
    });
}

void LiveSession::detachAndDisconnectAll() {
    asio::post(strand_, [self = shared_from_this()] {
        self->saver_->detach();
        self->streams_->closeAll(close_code::kStopping, kTakenOverReason);
    });
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id) {
    assertOnStrand();
    if (saver_->isDetached()) {  // detachAndDisconnectAll() was called after this client had joined the session
        peer->close(close_code::kStopping, kTakenOverReason);
        co_return;
    }
    streams_->add(peer, {hello.stream, hello.encoding, hello.viewport.value_or(scene::Viewport{}), hello.scheme});
    peer->send(
        textMessage(wire::welcomeMessage(credentials_.id, credentials_.token, limitsJson(services_.options), id)));
    streams_->sendAndRequestPictures();
    co_return;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::PictureShown shown,
                                                    RequestId id) {
    if (id) peer->send(textAnswer(wire::Done{revision()}, id));
    streams_->pictureShown(*peer, shown.revision);
    co_return;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Measure measure, RequestId id) {
    // Measure State::source, which has the coordinates of the object's file, and not State::object, which is
    // State::source transformed to the frame of reference.
    const slicing::Object& object = session_.current.source;
    const slicing::Element element{measure.element, measure.number};
    if (const auto exists = session::checkElement(object, element); !exists) {
        sendError(*peer, services_.metrics, exists.error(), id);
        co_return;
    }
    const slicing::ElementMeasurements found = slicing::measureElement(object, element);
    wire::Measured measured{revision(), found.length, found.area, found.volume, found.center};
    if (element.kind == slicing::ElementKind::cell) measured.kind = slicing::typeOfCells(object)[element.index];
    peer->send(textAnswer(measured, id));
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Ping /*ping*/, RequestId id) {
    const parallel::WorkerPool& workers = services_.pictureWorkers.workers();
    peer->send(textAnswer(wire::Pong{workers.size(), workers.waiting(), workers.busyTime().count(),
                                     Seconds(Clock::now().time_since_epoch()).count()},
                          id));
    co_return;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, session::Command command,
                                                    RequestId id) {
    const auto applied = co_await applyCommand(peer->client(), peer, command, id.has_value());
    if (!applied) {
        sendError(*peer, services_.metrics, applied.error(), id);
        co_return;
    }
    if (!applied->owned) co_return;  // this client is being disconnected
    if (id) peer->send(textAnswer(wire::Done{applied->revision, applied->warnings}, id));
    streams_->sendAndRequestPictures();
}

asio::awaitable<std::optional<Result<LiveSession::CommandResult>>> LiveSession::applyOnStrand(
    AddressAccountPtr by, session::Command command) {
    const auto applied = co_await applyCommand(std::move(by), nullptr, command, true);
    if (applied && !applied->owned) co_return Result<CommandResult>(kInternalError);
    streams_->sendAndRequestPictures();
    co_return applied;
}

/// Returns a loader that defers slow work (ObjectLoader::Mode::deferred).
std::shared_ptr<session::ObjectLoader> LiveSession::makeLoader() const {
    const session::CriticalSearchOptions search{&services_.critical, services_.options.file.time};
    return std::make_shared<session::ObjectLoader>(services_.options.session, services_.polytopes,
                                                   session::ObjectLoader::Mode::deferred, fileReader(services_),
                                                   search);
}

/// Applies a command. Slow work runs on a worker: later messages of this client wait for it, but not those of other
/// clients. If several servers share the store and `awaitStore` is true, this function returns only when the result is
/// in the store, because a command must not be acknowledged before that.
asio::awaitable<Result<LiveSession::CommandResult>> LiveSession::applyCommand(AddressAccountPtr by,
                                                                              std::shared_ptr<Peer> peer,
                                                                              const session::Command& command,
                                                                              bool awaitStore) {
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
            std::shared_ptr<CriticalSearchHandle> search;
            if (loader->isSearchPending()) {
                search = registerSearch(peer);
                // Without this call, the connection would not read for some time while this command runs, and would
                // notice too late that the client has left.
                if (peer) peer->watchForDisconnect();
            }
            if (auto refused = co_await completePending(by, loader, std::move(search))) {
                done = std::move(*refused);
                break;
            }
        }
        if (done) metered_->adjustReservationOrTrimUndo(session_.current.object != shown || session_.loaded != loaded);
    } catch (const parallel::QueueFull&) {
        done = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("command failed session={} fault=\"{}\"", credentials_.id, fault.what());
        done = kInternalError;
    }
    if (!done) co_return done.error();
    CommandResult applied{revision(), loader->warnings(), true};
    // A command that extends a field that is not shown changes `loaded`, but not State::source.
    const bool hasNewObject = session_.current.source != source || session_.loaded != loaded;
    if (applied.revision == before && !hasNewObject) co_return applied;
    if (applied.revision != before) streams_->sessionChanged(Clock::now());
    searches_.stopUnneeded(session_.current);
    // The first picture of a new field that is larger than memory is a draft, because a picture of full quality takes
    // much longer.
    const fields::Field* const field = slicing::fieldIn(session_.current.object);
    if (session_.current.source != source && field != nullptr && field->source) streams_->beginDrafts();
    saver_->scheduleSave();
    if (auto write = saver_->writeBeforeAcknowledgment(hasNewObject)) {
        if (awaitStore) {
            applied.owned = co_await awaitCallback<bool>(std::move(*write));
        } else {
            (*write)([](bool) {});
        }
    }
    co_return applied;
}

/// Registers a search for the critical values of w of the current object (see slicing/critical/), so that the search
/// can be stopped. completePending() runs the search.
std::shared_ptr<CriticalSearchHandle> LiveSession::registerSearch(const std::shared_ptr<Peer>& peer) {
    assertOnStrand();
    return searches_.add(peer, session_.current, services_.exportWorkers.stopToken());
}

/// Builds or reads the loader's pending object on a worker. If a search is pending instead, an export worker runs it.
/// `search`: the registration of the pending search; null if no search is pending. Returns an error if there is no room
/// for the result, else an empty optional.
asio::awaitable<std::optional<Error>> LiveSession::completePending(AddressAccountPtr by,
                                                                   std::shared_ptr<session::ObjectLoader> loader,
                                                                   std::shared_ptr<CriticalSearchHandle> search) {
    auto reservation = metered_->client()->byteAccount().reserve(loader->memoryNeeded());
    if (!reservation) co_return kTooManyBytes;
    if (loader->pendingNeedsFile()) {
        co_await runOnPool<std::monostate>(services_.loadWorkers, loaderJob(loader), metered_->client()->loadJobQueue(),
                                           loader->estimatedDuration());
    } else if (search) {
        co_await runOnPool<std::monostate>(services_.exportWorkers, loaderJob(loader, search->stopToken()),
                                           streams_->jobQueuesOf(by).exports, loader->estimatedDuration());
    } else {
        co_await runOnPool<std::monostate>(services_.pictureWorkers.workers(), loaderJob(loader),
                                           streams_->jobQueuesOf(by).pictures, loader->estimatedDuration());
    }
    const std::size_t bytes = loader->loadedObjectMemory();
    if (bytes > reservation->size() && !reservation->growTo(bytes)) co_return kTooManyBytes;
    co_return std::nullopt;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Get get, RequestId id) {
    const StreamKey* const stream = streams_->streamOf(*peer);
    if (stream == nullptr) co_return;
    StreamKey key = *stream;
    if (get.viewport) key.viewport = *get.viewport;
    key.background = get.background;
    switch (get.what) {
        case wire::GetTarget::state:
            peer->send(textMessage(stateText(session_, id, key.scheme)));
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
            answerWithOpenAddress(*peer, id);
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
            // The search may take long, so the client's further messages do not wait for this answer.
            asio::co_spawn(strand_, answerWithCriticalValues(peer, id), KeepSessionAlive{shared_from_this()});
            break;
    }
}

void LiveSession::answerWithOpenAddress(Peer& peer, RequestId id) {
    const auto query = session::queryFromState(session_.current, *makeLoader());
    if (query) {
        peer.send(textAnswer(session::OpenAddress{session::queryText(*query)}, id));
    } else {
        sendError(peer, services_.metrics, query.error(), id);
    }
}

asio::awaitable<void> LiveSession::answerWithFile(std::shared_ptr<Peer> peer, exports::ExportRequest request,
                                                  RequestId id) {
    const std::uint64_t askedRevision = revision();
    ExportResult made;
    try {
        made = co_await runOnPool<ExportResult>(
            services_.exportWorkers, exportJob(services_, session_.current, request, peer->client()),
            streams_->jobQueuesOf(peer->client()).exports, pipeline::exportCost(session_.current, request));
    } catch (const parallel::QueueFull&) {
        made = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("file failed session={} revision={} fault=\"{}\"", credentials_.id, askedRevision, fault.what());
    }
    if (!made || !*made) {
        sendError(*peer, services_.metrics, made ? made->error() : kInternalError, id);
        co_return;
    }
    const FinishedFile& finished = **made;
    OutgoingMessage message;
    message.bytes = finished.bytes;
    message.binary = true;
    peer->send(std::move(message));
    peer->send(textAnswer(wire::Done{askedRevision, finished.warnings}, id));
}

asio::awaitable<void> LiveSession::answerWithCriticalValues(std::shared_ptr<Peer> peer, RequestId id) {
    const std::uint64_t askedRevision = revision();
    const double originW = slicing::infoOf(session_.current.object).originInFile.w;
    Result<slicing::CriticalPtr> found = kInternalError;
    try {
        found = co_await findCriticalValues(peer);
    } catch (const parallel::QueueFull&) {
        found = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("search failed session={} revision={} fault=\"{}\"", credentials_.id, askedRevision,
                      fault.what());
    }
    if (!found) {
        sendError(*peer, services_.metrics, found.error(), id);
        co_return;
    }
    peer->send(textMessage(wire::criticalMessage(**found, originW, askedRevision, id)));
}

/// Finds the critical values of w of the current object. Unless they are known, an export worker searches for them.
asio::awaitable<Result<slicing::CriticalPtr>> LiveSession::findCriticalValues(std::shared_ptr<Peer> peer) {
    const auto loader = makeLoader();
    const session::State asked = session_.current;
    auto found = loader->criticalSections(asked);
    if (!loader->isPending()) co_return found;
    auto search = registerSearch(peer);
    if (auto refused = co_await completePending(peer->client(), loader, std::move(search))) co_return *refused;
    co_return loader->criticalSections(asked);
}

asio::awaitable<void> LiveSession::answerWithPicture(std::shared_ptr<Peer> peer, StreamKey key, RequestId id,
                                                     std::optional<glm::dvec2> point) {
    const std::uint64_t askedRevision = revision();
    std::optional<Error> failed;
    try {
        OutgoingMessage picture = co_await runOnPool<OutgoingMessage>(
            services_.pictureWorkers, requestedJob(key, id, point), streams_->jobQueuesOf(peer->client()).pictures,
            pictureCost(session_.current, key, slicing::Quality::full));
        peer->send(std::move(picture));
        if (key.stream == Stream::frames) peer->send(textAnswer(wire::Done{askedRevision}, id));
    } catch (const parallel::QueueFull&) {
        failed = kTooManyJobs;
    } catch (const std::exception& fault) {
        failed = pictureError(session_.current, credentials_.id, askedRevision, fault, kInternalError);
    }
    if (failed) sendError(*peer, services_.metrics, *failed, id);
}

/// Returns a job that makes a picture of the current state or, with a point, tells what the picture shows at this
/// point.
std::function<OutgoingMessage(pipeline::Pipeline&)> LiveSession::requestedJob(const StreamKey& key, RequestId id,
                                                                              std::optional<glm::dvec2> point) const {
    const SnapshotPtr known = streams_->currentFullSnapshot();
    return [known, state = session_.current, askedRevision = revision(), changed = streams_->lastChangeTime(), key, id,
            point, &metrics = services_.metrics](pipeline::Pipeline& pipeline) {
        const SnapshotPtr snapshot =
            suffices(known, key) ? known
                                 : makeSnapshot(pipeline, state, askedRevision, changed, key, slicing::Quality::full);
        if (point)
            return textMessage(
                pipeline.describePoint(state, snapshot->slices, askedRevision, id, key.viewport, *point));
        OutgoingMessage picture = makePicture(pipeline, *snapshot, key, id);
        metrics.observe(pipeline.times());
        return picture;
    };
}

// This function is last in the file, because the specializations of executeAndAnswer() must be declared before it.
asio::awaitable<void> LiveSession::executeOnStrand(std::shared_ptr<Peer> peer, wire::Request request) {
    assertOnStrand();
    // The body is moved, because that of a `load` message may be large.
    co_await std::visit([&](auto& body) { return executeAndAnswer(peer, std::move(body), request.id); }, request.body);
}

}  // namespace oval4d::net
