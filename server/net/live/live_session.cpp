#include "net/live/live_session.hpp"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "fields/field.hpp"
#include "net/coroutine_helpers.hpp"
#include "net/live/errors.hpp"
#include "parallel/worker_pool.hpp"
#include "session/object_loader.hpp"
#include "wire/messages.hpp"

namespace oval4d::net {

namespace asio = boost::asio;

namespace {

constexpr const char* kTakenOverReason = "another server has taken over this session";

}  // namespace

LiveSession::LiveSession(Services services, store::WriteBehindStore& writeBehind, store::SessionCredentials credentials,
                         store::FencingToken fence, ClientAccountPtr client, session::Session value)
    : services_(services),
      credentials_(std::move(credentials)),
      strand_(asio::make_strand(services.io)),
      metered_(std::make_shared<MeteredSession>(std::move(client), std::move(value))),
      session_(metered_->value),
      publisher_(std::make_shared<SessionPublisher>(services, strand_, credentials_.id, metered_)),
      loading_(std::make_shared<ObjectLoading>(services, metered_, publisher_)),
      answers_(std::make_shared<RequestAnswerer>(services, strand_, credentials_.id, metered_, publisher_, loading_)),
      // The saver shares the ownership of metered_.
      saver_(std::make_shared<SessionSaver>(writeBehind, credentials_.id, fence,
                                            std::shared_ptr<const session::Session>(metered_, &metered_->value),
                                            services_.clock, strand_)),
      refinement_(std::make_shared<FieldRefinement>(
          strand_, metered_, [streams = publisher_] { return streams->hasClients(); },
          [loading = loading_](session::LoadObject load, std::stop_token stop) {
              return loading->readArrayInBackground(std::move(load), std::move(stop));
          },
          [streams = publisher_, saver = saver_, &clock = services_.clock] {
              streams->recordSessionChange(clock.now());
              saver->scheduleSave();
              streams->sendAndRequestPictures();
          })) {
    publisher_->setMotionListener([weak = std::weak_ptr(saver_)] {
        if (const auto saver = weak.lock()) saver->scheduleSave();
    });
}

asio::awaitable<void> LiveSession::addAndWelcome(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id) {
    return execute(std::move(peer), {id, std::move(hello)});
}

asio::awaitable<void> LiveSession::execute(std::shared_ptr<Peer> peer, wire::Request request) {
    return asio::co_spawn(strand_, executeOnStrand(std::move(peer), std::move(request)), asio::use_awaitable);
}

asio::awaitable<std::optional<Result<LiveSession::CommandResult>>> LiveSession::apply(ClientAccountPtr client,
                                                                                      session::Command command) {
    return asio::co_spawn(strand_, applyOnStrand(std::move(client), std::move(command)), asio::use_awaitable);
}

void LiveSession::leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left) {
    stopSearches(peer);
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer), left = std::move(left)] {
        self->publisher_->remove(peer.get());
        self->refinement_->startOrStopAsNeeded();
        if (left(self->session_)) self->saver_->stopSaving();
    });
}

void LiveSession::stopSearches(std::shared_ptr<Peer> peer) {
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer)] {
        self->loading_->criticalSearches().stopSearchesOf(peer);
    });
}

void LiveSession::save(std::shared_ptr<void> completion) {
    asio::post(strand_, [self = shared_from_this(), completion = std::move(completion)] {
        self->saver_->saveNow([completion](bool /*written*/) {});
    });
}

void LiveSession::detachAndDisconnectAll() {
    asio::post(strand_, [self = shared_from_this()] {
        self->saver_->stopSaving();
        self->publisher_->closeAll(close_code::kStopping, kTakenOverReason);
    });
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Hello hello, RequestId id) {
    assertOnStrand();
    if (saver_->hasStoppedSaving()) {  // detachAndDisconnectAll() was called after this client had joined the session
        peer->close(close_code::kStopping, kTakenOverReason);
        co_return;
    }
    publisher_->addSubscriber(peer,
                              {hello.stream, hello.encoding, hello.viewport.value_or(scene::Viewport{}), hello.scheme});
    peer->send(
        textMessage(wire::welcomeMessage(credentials_.id, credentials_.token, limitsJson(services_.options), id)));
    publisher_->sendAndRequestPictures();
    refinement_->startOrStopAsNeeded();
    co_return;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::PictureShown shown,
                                                    RequestId id) {
    if (id) peer->send(textAnswer(wire::Done{revision()}, id));
    publisher_->recordPictureShown(*peer, shown.revision);
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
    publisher_->sendAndRequestPictures();
}

asio::awaitable<std::optional<Result<LiveSession::CommandResult>>> LiveSession::applyOnStrand(
    ClientAccountPtr by, session::Command command) {
    const auto applied = co_await applyCommand(std::move(by), nullptr, command, true);
    if (applied && !applied->owned) co_return Result<CommandResult>(kInternalError);
    publisher_->sendAndRequestPictures();
    co_return applied;
}

/// Applies a command of the client `by`. `peer` is the client's connection, or null. Slow work runs on a worker; later
/// messages over this connection wait for the work, those of other connections do not. If several servers share the
/// store and `awaitStore` is true, returns only after the store has the result, because a command must not be
/// acknowledged before.
asio::awaitable<Result<LiveSession::CommandResult>> LiveSession::applyCommand(ClientAccountPtr by,
                                                                              std::shared_ptr<Peer> peer,
                                                                              const session::Command& command,
                                                                              bool awaitStore) {
    session::ObjectLoader loader = loading_->makeLoader();
    const session::Limits& limits = services_.options.session;
    Result<std::monostate> done = kInternalError;
    std::uint64_t before = 0;
    slicing::Object source, shown;
    session::LoadedObjects loaded;
    session::ComputedOutcome outcome;
    try {
        while (session::needsLoading(session_, command, limits, loader, outcome)) {
            // While this command runs, the connection would otherwise not read for some time, and would notice too late
            // that the client has left.
            if (peer && loader.isSearchPending()) peer->watchForDisconnect();
            if (auto refused = co_await loading_->completePending(by, peer, loader)) co_return *refused;
        }
        before = revision();
        source = session_.current.source;
        shown = session_.current.object;
        loaded = session_.loaded;
        done = session::apply(session_, command, limits, loader, std::move(outcome));
        if (done) metered_->adjustReservationOrTrimUndo(session_.current.object != shown || session_.loaded != loaded);
    } catch (const parallel::QueueFull&) {
        done = kTooManyJobs;
    } catch (const std::exception& fault) {
        done = logAndClassifyFailure(session_.current, credentials_.id, revision(), fault, kInternalError);
    }
    if (!done) co_return done.error();
    CommandResult applied{revision(), loader.warnings(), true};
    // A command that extends a field that is not shown changes `loaded`, but not State::source.
    const bool hasNewObject = session_.current.source != source || session_.loaded != loaded;
    if (applied.revision == before && !hasNewObject) co_return applied;
    if (applied.revision != before) publisher_->recordSessionChange(services_.clock.now());
    loading_->criticalSearches().stopUnneededSearches(session_.current);
    refinement_->startOrStopAsNeeded();
    // The first picture of a new field that is larger than memory is a draft, because a picture in full quality takes
    // much longer.
    const fields::Field* const field = slicing::fieldIn(session_.current.object);
    if (session_.current.source != source && field != nullptr && field->source) publisher_->beginDrafts();
    saver_->scheduleSave();
    if (auto write = saver_->writeFunctionBeforeAcknowledgment(hasNewObject)) {
        if (awaitStore) {
            applied.owned = co_await awaitCallback<bool>(std::move(*write));
        } else {
            (*write)([](bool) {});
        }
    }
    co_return applied;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Get get, RequestId id) {
    return answers_->answerGet(std::move(peer), std::move(get), id);
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Measure measure, RequestId id) {
    answers_->answer(*peer, measure, id);
    co_return;
}

template <>
asio::awaitable<void> LiveSession::executeAndAnswer(std::shared_ptr<Peer> peer, wire::Ping ping, RequestId id) {
    answers_->answer(*peer, ping, id);
    co_return;
}

// This function is last in the file, because the specializations of executeAndAnswer(), which it uses, must be declared
// before it.
asio::awaitable<void> LiveSession::executeOnStrand(std::shared_ptr<Peer> peer, wire::Request request) {
    assertOnStrand();
    // The body is moved, because the body of a `load` message may be large.
    co_await std::visit([&](auto& body) { return executeAndAnswer(peer, std::move(body), request.id); }, request.body);
}

}  // namespace oval4d::net
