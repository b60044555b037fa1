#include "net/connection.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "net/awaited.hpp"
#include "protocol/cpp/codec.hpp"
#include "store/secret.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using protocol::Error;
using protocol::ErrorCode;

namespace {

constexpr std::size_t kKeptBuffer = 64U << 10U;  // a larger one is given back after the message that needed it

constexpr std::size_t kPiece = 256U << 10U;  // bytes of a message that are written at once

}  // namespace

Connection::Connection(beast::tcp_stream stream, Services services, std::shared_ptr<Hub> hub, std::string session)
    : stream_(std::move(stream)),
      services_(services),
      hub_(std::move(hub)),
      wanted_(std::move(session)),
      rate_(services.options.maxRequests, RateLimit::Clock::now()),
      deadline_(stream_.get_executor()),
      drained_(stream_.get_executor()) {}

asio::awaitable<void> Connection::run(Upgrade upgrade) {
    setUp(upgrade.count(beast::http::field::sec_websocket_protocol) > 0);
    const auto [fault] = co_await stream_.async_accept(upgrade, kQuietly);
    if (fault) co_return;
    services_.metrics.webSockets.Increment();
    co_await converse();
    services_.metrics.webSockets.Decrement();
    ended_ = true;
    outbox_.clear();
    deadline_.cancel();
    if (session_) hub_->leave(std::exchange(session_, nullptr), shared_from_this());
    services_.pool.tidyLater();
}

void Connection::setUp(bool offered) {
    // From here on the WebSocket's own clock watches; two of them would fight.
    beast::get_lowest_layer(stream_).expires_never();
    const auto ping = steady(services_.options.pingInterval);
    stream_.set_option(websocket::stream_base::timeout{std::chrono::seconds(10), 2 * ping, true});
    stream_.set_option(websocket::stream_base::decorator([offered](websocket::response_type& response) {
        response.set(beast::http::field::server, "oval4d");
        if (offered) response.set(beast::http::field::sec_websocket_protocol, kSubprotocol);
    }));
    stream_.read_message_max(services_.options.maxMessage);
    stream_.auto_fragment(false);
}

asio::awaitable<void> Connection::converse() {
    for (;;) {
        co_await room();
        const auto [fault, size] = co_await stream_.async_read(buffer_, kQuietly);
        if (fault) {
            if (fault == websocket::error::message_too_big) services_.metrics.countError(ErrorCode::too_large);
            spdlog::debug("connection ended reason=\"{}\"", fault.message());
            co_return;
        }
        services_.metrics.messagesReceived.Increment();
        if (closing_) {
            // Nothing counts any more but the close frame.
        } else if (!stream_.got_text()) {
            tell({ErrorCode::bad_message, "messages to the server are JSON text, not binary"}, {});
            close(close_code::kNotText, "text expected");
        } else {
            co_await handle({static_cast<const char*>(buffer_.cdata().data()), buffer_.size()});
        }
        buffer_.consume(buffer_.size());
        if (buffer_.capacity() > kKeptBuffer) buffer_.shrink_to_fit();
    }
}

/// Waits until the client has read enough of its answers.
asio::awaitable<void> Connection::room() {
    while (unsent_ > services_.options.maxUnsent && !ended_) {
        drained_.expires_at(asio::steady_timer::time_point::max());
        co_await drained_.async_wait(kQuietly);
    }
}

asio::awaitable<void> Connection::handle(std::string_view text) {
    Id id;
    try {
        auto parsed = protocol::parseRequest(text, services_.options.maxDepth);
        const auto* bad = std::get_if<protocol::BadRequest>(&parsed);
        id = bad != nullptr ? bad->id : std::get<protocol::Request>(parsed).id;
        if (const auto verdict = rate_.take(RateLimit::Clock::now()); verdict != RateLimit::Verdict::allowed) {
            tell({ErrorCode::too_many, "at most " + std::to_string(services_.options.maxRequests) +
                                           " messages a second are carried out; this one was not"},
                 id);
            if (verdict == RateLimit::Verdict::hopeless) close(close_code::kPolicy, "too many requests");
        } else if (bad != nullptr) {
            tell(bad->error, id);
            if (bad->notJson) close(close_code::kNotJson, "not JSON");
        } else {
            co_await carryOut(std::move(std::get<protocol::Request>(parsed)));
        }
    } catch (const std::exception& fault) {
        spdlog::error("request failed fault=\"{}\"", fault.what());
        tell(kFault, id);
    }
}

asio::awaitable<void> Connection::carryOut(protocol::Request request) {
    if (auto* hello = std::get_if<protocol::Hello>(&request.body)) {
        co_await greet(std::move(*hello), request.id);
        co_return;
    }
    if (!session_) {
        tell({ErrorCode::hello_first, "the first message must be a hello"}, request.id);
        co_return;
    }
    if (const auto* get = std::get_if<protocol::Get>(&request.body); get != nullptr && get->viewport) {
        if (const auto fits = picture::checked(*get->viewport, services_.options.frame); !fits) {
            tell(fits.error(), request.id);
            co_return;
        }
    }
    co_await session_->carryOut(shared_from_this(), std::move(request));
}

asio::awaitable<void> Connection::greet(protocol::Hello hello, Id id) {
    if (const auto fits = picture::checked(hello.viewport, services_.options.frame); !fits) {
        tell(fits.error(), id);
        co_return;
    }
    const auto entered = co_await enter(hello);
    if (!entered) {
        tell(entered.error(), id);
        if (entered.error().code == ErrorCode::not_found) close(close_code::kNoSession, "no such session");
        if (entered.error().code == ErrorCode::bad_token) close(close_code::kBadToken, "wrong token");
        if (entered.error().code == ErrorCode::internal) close(close_code::kTryLater, "try again later");
        co_return;
    }
    session_ = *entered;
    co_await session_->greet(shared_from_this(), std::move(hello), id);
}

/// The session that this client is in, from its first hello on.
asio::awaitable<Hub::Joined> Connection::enter(protocol::Hello hello) {
    const std::string token = hello.token.value_or("");
    if (session_) {
        if (hello.token && !store::sameSecret(token, session_->ticket().token)) {
            co_return Error{ErrorCode::bad_token, "this token does not open the session"};
        }
        co_return session_;
    }
    if (wanted_.empty() && hello.token) {
        co_return Error{ErrorCode::bad_token, "a token opens the session in the path /ws/{session}"};
    }
    auto begin = entrance(token);
    co_return co_await awaited<Hub::Joined>(std::move(begin));
}

std::function<void(Hub::Done)> Connection::entrance(const std::string& token) {
    return [hub = hub_, ticket = store::Ticket{wanted_, token}](const Hub::Done& done) {
        if (ticket.id.empty()) {
            hub->create(done);
        } else {
            hub->join(ticket, done);
        }
    };
}

void Connection::tell(const Error& error, Id id) {
    services_.metrics.countError(error.code);
    send(textMessage(protocol::errorMessage(error, id)));
}

void Connection::send(Message message, std::function<void()> written) {
    asio::post(stream_.get_executor(),
               [self = shared_from_this(), message = std::move(message), written = std::move(written)]() mutable {
                   if (self->ended_ || self->closing_) return;
                   self->unsent_ += message.bytes.size();
                   self->outbox_.push_back({std::move(message), std::move(written)});
                   if (!self->writing_) self->writeNext();
               });
}

void Connection::close(std::uint16_t code, std::string reason) {
    asio::post(stream_.get_executor(), [self = shared_from_this(), code, reason = std::move(reason)]() mutable {
        if (!self->ended_) self->startClosing(code, std::move(reason));
    });
}

void Connection::stop() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] {
        while (self->outbox_.size() > (self->writing_ ? 1U : 0U)) self->outbox_.pop_back();
        if (!self->ended_) self->startClosing(close_code::kStopping, "the server is stopping; come back");
    });
}

/// Once what is queued is written, the close frame goes out; the read that is always pending sees the answer.
void Connection::startClosing(std::uint16_t code, std::string reason) {
    if (closing_) return;
    closing_.emplace(static_cast<websocket::close_code>(code), reason);
    if (!writing_) writeNext();
}

void Connection::writeNext() {
    writing_ = !outbox_.empty();
    if (writing_) {
        stream_.binary(outbox_.front().message.binary);
        writePiece(0);
    } else if (closing_ && !ended_) {
        stream_.async_close(*closing_, [self = shared_from_this()](boost::system::error_code) {});
    }
}

/// A long message goes out in fragments, each with time of its own: a slow client is no dead one.
void Connection::writePiece(std::size_t from) {
    const std::string_view rest = outbox_.front().message.bytes.view().substr(from);
    const std::string_view piece = rest.substr(0, kPiece);
    const bool last = piece.size() == rest.size();
    expectProgress();
    stream_.async_write_some(
        last, asio::buffer(piece),
        [self = shared_from_this(), last, to = from + piece.size()](boost::system::error_code fault, std::size_t) {
            if (last || fault || self->ended_) {
                self->written(fault);
            } else {
                ++self->writes_;
                self->writePiece(to);
            }
        });
}

void Connection::written(boost::system::error_code fault) {
    ++writes_;
    deadline_.cancel();
    if (ended_ || fault) {
        outbox_.clear();
        unsent_ = 0;
        writing_ = false;
        drained_.cancel();
        if (!ended_) beast::get_lowest_layer(stream_).close();
        return;
    }
    const Outgoing done = std::move(outbox_.front());
    outbox_.pop_front();
    unsent_ -= done.message.bytes.size();
    services_.metrics.bytesSent.Increment(static_cast<double>(done.message.bytes.size()));
    if (unsent_ <= services_.options.maxUnsent) drained_.cancel();
    if (done.written) done.written();
    writeNext();
}

/// Drops a client that does not take the piece being written in time.
void Connection::expectProgress() {
    deadline_.expires_after(steady(services_.options.writeTimeout));
    deadline_.async_wait([self = shared_from_this(), watched = writes_](boost::system::error_code cancelled) {
        if (cancelled || self->writes_ != watched || !self->writing_ || self->ended_) return;
        self->services_.metrics.slowReaders.Increment();
        spdlog::warn("client dropped: it does not read");
        beast::get_lowest_layer(self->stream_).close();
    });
}

}  // namespace oval4d::net
