#include "net/live_session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "net/awaited.hpp"
#include "net/file_job.hpp"
#include "net/on_pool.hpp"
#include "protocol/cpp/codec.hpp"
#include "session/workshop.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using protocol::Error;
using protocol::Stream;

namespace {

// After a change. The store is to be at most a second behind, also where the machine is busy.
constexpr std::chrono::milliseconds kSaveDelay{250};

Message doneMessage(LiveSession::Id id, std::uint64_t revision) {
    return textMessage(protocol::doneMessage(id, revision));
}

std::function<std::monostate(picture::Painter&)> orderOf(const std::shared_ptr<session::Workshop>& workshop) {
    return [workshop](picture::Painter&) {
        workshop->work();
        return std::monostate{};
    };
}

}  // namespace

LiveSession::LiveSession(Services services, store::Keeper& keeper, store::Ticket ticket, session::Session value)
    : services_(services),
      keeper_(keeper),
      ticket_(std::move(ticket)),
      strand_(asio::make_strand(services.io)),
      session_(std::move(value)),
      changed_(Clock::now()),
      turnTimer_(strand_),
      paceTimer_(strand_),
      saveTimer_(strand_) {}

asio::awaitable<void> LiveSession::greet(std::shared_ptr<Peer> peer, protocol::Hello hello, Id id) {
    return asio::co_spawn(strand_, greetHere(std::move(peer), std::move(hello), id), asio::use_awaitable);
}

asio::awaitable<void> LiveSession::carryOut(std::shared_ptr<Peer> peer, protocol::Request request) {
    return asio::co_spawn(strand_, carryOutHere(std::move(peer), std::move(request)), asio::use_awaitable);
}

void LiveSession::leave(std::shared_ptr<Peer> peer, std::function<bool(const session::Session&)> left) {
    asio::post(strand_, [self = shared_from_this(), peer = std::move(peer), left = std::move(left)] {
        self->clients_.erase(peer.get());
        self->over_ = left(self->session_) || self->over_;
    });
}

void LiveSession::save(std::shared_ptr<void> until) {
    asio::post(strand_,
               [self = shared_from_this(), until = std::move(until)] { self->saveHere([until](bool /*written*/) {}); });
}

void LiveSession::dismiss() {
    asio::post(strand_, [self = shared_from_this()] {
        self->over_ = true;
        for (const auto& [key, client] : self->clients_) {
            if (const auto peer = client.peer.lock()) {
                peer->close(close_code::kStopping, "another server goes on with this session; come back");
            }
        }
    });
}

void LiveSession::saveHere(store::Keeper::Written written) {
    if (!over_) keeper_.save(ticket_.id, session_, store::Keeper::Part::whole, std::move(written));
}

/// To be called after each change that the store has not been given.
void LiveSession::saveSoon() {
    if (saveTimerSet_ || keeper_.pace() == store::Store::Pace::at_close) return;
    saveTimerSet_ = true;
    saveTimer_.expires_after(kSaveDelay);
    saveTimer_.async_wait([weak = weak_from_this()](boost::system::error_code) {
        if (const auto self = weak.lock()) {
            self->saveTimerSet_ = false;
            self->saveHere();
        }
    });
}

/// Gives the store what has changed, and tells when it has it.
std::function<void(std::function<void(bool)>)> LiveSession::keeping(store::Keeper::Part part) {
    session::Session value;
    if (part == store::Keeper::Part::whole) {
        value = session_;
    } else {
        value.now = session_.now;
        value.revision = revision();
    }
    return [self = shared_from_this(), part, value](const std::function<void(bool)>& written) {
        self->keeper_.save(self->ticket_.id, value, part, written);
    };
}

asio::awaitable<void> LiveSession::greetHere(std::shared_ptr<Peer> peer, protocol::Hello hello, Id id) {
    clients_[peer.get()] = Client{peer, {hello.stream, hello.encoding, hello.viewport}, {}, false};
    peer->send(textMessage(protocol::welcomeMessage(ticket_.id, ticket_.token, limitsText(services_.options), id)));
    update();
    co_return;
}

asio::awaitable<void> LiveSession::carryOutHere(std::shared_ptr<Peer> peer, protocol::Request request) {
    if (const auto* command = std::get_if<protocol::Command>(&request.body)) {
        co_await obey(peer, *command, request.id);
    } else if (const auto* shown = std::get_if<protocol::ShownRevision>(&request.body)) {
        if (request.id) peer->send(doneMessage(request.id, revision()));
        if (const auto client = clients_.find(peer.get()); client != clients_.end()) {
            client->second.pacing.shown(shown->revision);
            update();
        }
    } else if (const auto* get = std::get_if<protocol::Get>(&request.body)) {
        co_await answer(peer, *get, request.id);
    }
}

/// What takes long is done on a worker; the client's further messages wait for it, nobody else's do. Where another
/// server may have to go on with the session, a command is acknowledged once the store has what it did.
asio::awaitable<void> LiveSession::obey(std::shared_ptr<Peer> peer, const protocol::Command& command, Id id) {
    const auto workshop =
        std::make_shared<session::Workshop>(services_.options.session, session::Workshop::Pace::later);
    protocol::Result<std::monostate> done = kFault;
    std::uint64_t before = 0;
    session::PolytopePtr shown;
    try {
        for (;;) {
            before = revision();
            shown = session_.now.polytope;
            done = session::apply(session_, command, services_.options.session, *workshop);
            if (!workshop->ordered()) break;
            co_await onPool(services_.pool, orderOf(workshop), lane_);
        }
    } catch (const std::exception& fault) {
        spdlog::error("command failed session={} fault=\"{}\"", ticket_.id, fault.what());
        done = kFault;
    }
    if (!done) {
        tell(*peer, done.error(), id);
        co_return;
    }
    const std::uint64_t reached = revision();
    if (reached != before) {
        changed_ = Clock::now();
        saveSoon();
        if (keeper_.pace() == store::Store::Pace::at_once) {
            // The head has no room for what a command may have loaded.
            const bool whole = session_.now.polytope != shown;
            auto keep = keeping(whole ? store::Keeper::Part::whole : store::Keeper::Part::head);
            if (id) {
                const bool ours = co_await awaited<bool>(std::move(keep));
                if (!ours) co_return;  // the client is being sent to the server whose it is now
            } else {
                keep([](bool) {});
            }
        }
    }
    if (id) peer->send(textMessage(protocol::doneMessage(id, reached, workshop->warnings())));
    update();
}

asio::awaitable<void> LiveSession::answer(std::shared_ptr<Peer> peer, protocol::Get get, Id id) {
    const auto client = clients_.find(peer.get());
    if (client == clients_.end()) co_return;
    Want want = client->second.want;
    if (get.viewport) want.viewport = *get.viewport;
    switch (get.what) {
        case protocol::What::state:
            peer->send(textMessage(protocol::stateMessage(session_.now, revision(), id)));
            break;
        case protocol::What::catalogue: {
            std::vector<session::PolytopePtr> loaded;
            for (const auto& [name, polytope] : session_.loaded) loaded.push_back(polytope);
            peer->send(textMessage(protocol::catalogueMessage(id, loaded)));
            break;
        }
        case protocol::What::keymap:
            peer->send(textMessage(protocol::keymapMessage(id)));
            break;
        case protocol::What::slices:
            want.stream = Stream::geometry;
            co_await answerWithPicture(peer, want, id);
            break;
        case protocol::What::frame:
            want.stream = Stream::frames;
            co_await answerWithPicture(peer, want, id);
            break;
        case protocol::What::file:
            co_await answerWithFile(peer, get.file, id);
            break;
    }
}

asio::awaitable<void> LiveSession::answerWithFile(std::shared_ptr<Peer> peer, exports::Wish wish, Id id) {
    const std::uint64_t asked = revision();
    MadeFile made;
    try {
        made = co_await onPool(services_.files, fileJob(services_, session_.now, wish));
    } catch (const std::exception& fault) {
        spdlog::error("file failed session={} revision={} fault=\"{}\"", ticket_.id, asked, fault.what());
    }
    if (!made || !*made) {
        tell(*peer, made ? made->error() : kFault, id);
        co_return;
    }
    Message message;
    message.bytes = **made;
    message.binary = true;
    peer->send(std::move(message));
    peer->send(doneMessage(id, asked));
}

asio::awaitable<void> LiveSession::answerWithPicture(std::shared_ptr<Peer> peer, Want want, Id id) {
    const std::uint64_t asked = revision();
    bool failed = false;
    try {
        Message picture = co_await onPool(services_.pool, pictureJob(want, id), lane_);
        peer->send(std::move(picture));
        if (want.stream == Stream::frames) peer->send(doneMessage(id, asked));
    } catch (const std::exception& fault) {
        spdlog::error("picture failed session={} revision={} fault=\"{}\"", ticket_.id, asked, fault.what());
        failed = true;
    }
    if (failed) tell(*peer, kFault, id);
}

/// Makes the picture of the session as it is now.
std::function<Message(picture::Painter&)> LiveSession::pictureJob(const Want& want, Id id) const {
    const CutPtr known = cut_ && cut_->revision == revision() ? cut_ : nullptr;
    return [known, state = session_.now, asked = revision(), changed = changed_, want, id,
            &metrics = services_.metrics](picture::Painter& painter) {
        const CutPtr whole = serves(known, want) ? known : cut(painter, state, asked, changed, want);
        Message drawn = draw(painter, *whole, want, id);
        metrics.observe(painter.times());
        return drawn;
    };
}

void LiveSession::tell(Peer& peer, const Error& error, Id id) {
    services_.metrics.countError(error.code);
    peer.send(textMessage(protocol::errorMessage(error, id)));
}

}  // namespace oval4d::net
