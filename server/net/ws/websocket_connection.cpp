// This file is long, because a connection is one class: reading, executing and writing share state, such as whether the
// connection is closing.

#include "net/ws/websocket_connection.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "net/coroutine_helpers.hpp"
#include "net/jobs/parse_long_message_job.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "net/live/errors.hpp"
#include "net/pause.hpp"
#include "store/secret.hpp"
#include "wire/messages.hpp"
#include "wire/parse.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;

namespace {

constexpr std::size_t kMaxIdleBuffer = 64U << 10U;   // in bytes; a larger buffer of a handled message is shrunk
constexpr std::size_t kWriteFragment = 256U << 10U;  // maximum number of bytes per write
constexpr std::size_t kReadChunk = 64U << 10U;       // maximum number of bytes per read

// The number of bytes that may be queued for a connection even if the client's byte account is full.
constexpr std::size_t kMinQueue = 64U << 10U;

constexpr double kParseSecondsPerByte = 1e-8;  // the estimated time to parse one byte of a long message

}  // namespace

WebSocketConnection::WebSocketConnection(beast::tcp_stream stream, Services services,
                                         std::shared_ptr<SessionManager> sessions, ClientAccountPtr client,
                                         std::string session, std::function<void()> joined)
    : stream_(std::move(stream)),
      services_(services),
      sessions_(std::move(sessions)),
      client_(std::move(client)),
      requestedId_(std::move(session)),
      joined_(std::move(joined)),
      rate_(services.options.maxRequestsPerSecond, services.clock.now()),
      deadline_(services.clock.makeTimer(stream_.get_executor())),
      helloDeadline_(services.clock.makeTimer(stream_.get_executor())),
      drainedSignal_(stream_.get_executor()),
      executedSignal_(stream_.get_executor()) {}

asio::awaitable<void> WebSocketConnection::serveClient(UpgradeRequest upgrade) {
    configureStream(upgrade.count(beast::http::field::sec_websocket_protocol) > 0);
    const auto [fault] = co_await stream_.async_accept(upgrade, kAsTuple);
    if (fault) co_return;
    services_.metrics.webSockets.Increment();
    startHelloTimer();
    co_await readLoop();
    services_.metrics.webSockets.Decrement();
    ended_ = true;
    // A client that no longer sends may also no longer read, so a pending write might never end. Closing the socket
    // ends the write. Until the handler of the write is called, outbox_ must keep the message, because the write reads
    // its bytes.
    beast::get_lowest_layer(stream_).close();
    if (!writing_) outbox_.clear();
    deadline_->cancel();
    helloDeadline_->cancel();
    if (session_) sessions_->leave(std::exchange(session_, nullptr), shared_from_this());
    services_.pictureWorkers.workers().cleanUpWhenIdle();
}

void WebSocketConnection::configureStream(bool offersSubprotocol) {
    // The WebSocket stream has its own timeouts, so Beast requires that the TCP stream has none. Beast measures the
    // timeouts of the WebSocket stream with the system's clock, not with Services::clock.
    beast::get_lowest_layer(stream_).expires_never();
    const auto ping = toSteadyDuration(services_.options.pingInterval);
    stream_.set_option(websocket::stream_base::timeout{std::chrono::seconds(10), 2 * ping, true});
    stream_.set_option(websocket::stream_base::decorator([offersSubprotocol](websocket::response_type& response) {
        response.set(beast::http::field::server, "oval4d");
        if (offersSubprotocol) response.set(beast::http::field::sec_websocket_protocol, kSubprotocol);
    }));
    stream_.read_message_max(services_.options.maxRequestBytes);  // raised to maxLoadMessageBytes after the hello
    stream_.auto_fragment(false);
}

/// Starts a timer that closes the connection if no hello has arrived in time. The timer does nothing if a hello is
/// being handled at the deadline, because reading its session from the store may take long. If this hello fails,
/// handleHello() closes the connection.
void WebSocketConnection::startHelloTimer() {
    helloDue_ = services_.clock.now() + toSteadyDuration(services_.options.helloTimeout);
    helloDeadline_->start(helloDue_, [weak = weak_from_this()] {
        const auto self = weak.lock();
        if (self && !self->session_ && !self->joining_ && !self->ended_) self->closeWithoutHello();
    });
}

void WebSocketConnection::closeWithoutHello() {
    sendError({ErrorCode::hello_first, "no hello arrived in time"}, {});
    close(close_code::kPolicy, "no hello");
}

/// Executes the client's messages one after another. While a message takes long, the next one is read, because Beast
/// notices the client's pongs only while it reads. Before the client has joined a session, only one message at a time
/// is read, because the hello changes the maximum length of messages.
asio::awaitable<void> WebSocketConnection::readLoop() {
    ReceivedMessage incoming = co_await readMessage();
    while (!incoming.fault) {
        swap(buffer_, message_);
        startHandling(std::move(incoming));
        incoming = co_await readAhead();
        co_await waitUntil(executedSignal_, [this] { return !executing_; });
    }
    if (incoming.fault == websocket::error::message_too_big) services_.metrics.countError(ErrorCode::too_large);
    spdlog::debug("connection ended reason=\"{}\"", incoming.fault.message());
}

/// Starts to handle the message in `message_`. `executing_` is true until the message has been handled. Asio's
/// operator && could run handleMessage() together with readAhead(). It is not used, because it cancels coroutines in a
/// way that is not thread-safe if one of them awaits another strand, here the session's
/// (https://github.com/chriskohlhoff/asio/issues/1348).
void WebSocketConnection::startHandling(ReceivedMessage incoming) {
    executing_ = true;
    watching_ = false;
    asio::co_spawn(stream_.get_executor(), handleMessage(std::move(incoming)),
                   [self = shared_from_this()](const std::exception_ptr& /*failure*/) {
                       self->discardMessage();
                       self->executing_ = false;
                       self->executedSignal_.cancel();
                   });
}

void WebSocketConnection::discardMessage() {
    message_.consume(message_.size());
    if (message_.capacity() > kMaxIdleBuffer) message_.shrink_to_fit();
}

/// Reads the next message. First waits until the current message has been executed, so that a client that closes the
/// connection right after a request still receives the answer. After the client has joined a session, the wait ends
/// early when a pong may be due, or when watchForDisconnect() is called for a long search.
asio::awaitable<WebSocketConnection::ReceivedMessage> WebSocketConnection::readAhead() {
    if (session_) {
        executedSignal_.expires_after(toSteadyDuration(services_.options.pingInterval / 2));
        if (executing_ && !watching_) co_await executedSignal_.async_wait(kAsTuple);
    } else {
        co_await waitUntil(executedSignal_, [this] { return !executing_; });
    }
    ReceivedMessage next = co_await readMessage();
    if (next.fault && session_) session_->stopSearches(shared_from_this());
    co_return next;
}

/// Handles the message in `message_`.
asio::awaitable<void> WebSocketConnection::handleMessage(ReceivedMessage incoming) {
    services_.metrics.messagesReceived.Increment();
    const auto wait = client_->countMessage(message_.size(), services_.clock.now());
    co_await pauseFor(services_.clock, stream_.get_executor(), wait);
    if (closing_) {
        // Messages that arrive before the client's close frame are ignored.
    } else if (!incoming.isText) {
        sendError({ErrorCode::bad_message, "messages to the server must be JSON text, not binary"}, {});
        close(close_code::kNotText, "text expected");
    } else if (incoming.refusal) {
        sendError(*incoming.refusal, incoming.id);
    } else {
        co_await parseAndExecute({static_cast<const char*>(message_.cdata().data()), message_.size()});
    }
}

/// Reads one message into `buffer_`. A message that is refused because of its length is read to its end and discarded.
asio::awaitable<WebSocketConnection::ReceivedMessage> WebSocketConnection::readMessage() {
    ReceivedMessage incoming;
    bool checked = false;
    co_await waitUntil(drainedSignal_, [this] { return unsent_ <= services_.options.maxUnsent; });
    do {
        const auto [fault, size] = co_await stream_.async_read_some(buffer_, kReadChunk, kAsTuple);
        incoming.fault = fault;
        if (fault) break;
        if (!checked && buffer_.size() > services_.options.maxRequestBytes) {
            checked = true;
            // Only one long message at a time may take memory.
            co_await waitUntil(executedSignal_, [this] { return !executing_; });
            admitOrRefuseLongMessage(incoming);
        }
        if (incoming.refusal) {
            client_->countMessage(buffer_.size(), services_.clock.now());
            buffer_.consume(buffer_.size());
        }
    } while (!stream_.is_message_done());
    incoming.isText = stream_.got_text();
    co_return incoming;
}

/// Decides from the beginning of a long message whether to keep it. Keeps a message whose type is `load` or still
/// unknown, if the client's byte account has room. Otherwise sets `incoming.refusal`.
void WebSocketConnection::admitOrRefuseLongMessage(ReceivedMessage& incoming) {
    constexpr std::size_t kCopies = 3;  // the message, its parsed members, and a member while it is reallocated
    const auto seen =
        wire::peekRequest({static_cast<const char*>(buffer_.cdata().data()), services_.options.maxRequestBytes});
    incoming.id = seen.id;
    if (seen.type && *seen.type != "load") {
        incoming.refusal = messageTooLongError(services_.options);
    } else if (auto held = client_->byteAccount().reserve(kCopies * services_.options.maxLoadMessageBytes)) {
        incoming.held = std::move(*held);
    } else {
        incoming.refusal = kTooManyBytes;
    }
}

/// Waits until `isTrue` returns true or the connection has ended. Calls `isTrue` again each time the timer `changed` is
/// canceled.
asio::awaitable<void> WebSocketConnection::waitUntil(asio::steady_timer& changed, std::function<bool()> isTrue) {
    while (!isTrue() && !ended_) {
        changed.expires_at(asio::steady_timer::time_point::max());
        co_await changed.async_wait(kAsTuple);
    }
}

asio::awaitable<void> WebSocketConnection::parseAndExecute(std::string_view text) {
    RequestId id;
    try {
        if (const auto verdict = rate_.countRequest(services_.clock.now()); verdict != RateLimit::Verdict::allowed) {
            sendError({ErrorCode::too_many, "at most " + std::to_string(services_.options.maxRequestsPerSecond) +
                                                " messages per second are allowed; this one was ignored"},
                      wire::peekRequest(text.substr(0, services_.options.maxRequestBytes)).id);
            if (verdict == RateLimit::Verdict::abusive) close(close_code::kPolicy, "too many requests");
            co_return;
        }
        auto parsed = co_await parseMessage(text);
        discardMessage();  // the text of a long message must not stay in memory while its object is built
        const auto* bad = std::get_if<wire::BadRequest>(&parsed);
        id = bad != nullptr ? bad->id : std::get<wire::Request>(parsed).id;
        if (bad != nullptr) {
            sendError(bad->error, id);
            if (bad->notJson) close(close_code::kNotJson, "not JSON");
        } else {
            co_await execute(std::move(std::get<wire::Request>(parsed)));
        }
    } catch (const parallel::QueueFull&) {
        sendError(kTooManyJobs, id);
    } catch (const std::exception& fault) {
        spdlog::error("request failed fault=\"{}\"", fault.what());
        sendError(kInternalError, id);
    }
}

/// Parses a message. A worker parses messages longer than ServerOptions::maxRequestBytes.
asio::awaitable<MessageParseResult> WebSocketConnection::parseMessage(std::string_view text) {
    if (text.size() <= services_.options.maxRequestBytes)
        co_return wire::parseRequest(text, services_.options.maxDepth);
    auto work = parseLongMessageJob(text, services_.options);
    co_return co_await runOnPool<MessageParseResult>(services_.pictureWorkers.workers(), std::move(work),
                                                     client_->pictureJobQueue(),
                                                     Seconds(kParseSecondsPerByte * static_cast<double>(text.size())));
}

asio::awaitable<void> WebSocketConnection::execute(wire::Request request) {
    if (auto* hello = std::get_if<wire::Hello>(&request.body)) {
        co_await handleHello(std::move(*hello), request.id);
        co_return;
    }
    if (!session_) {
        sendError({ErrorCode::hello_first, "the first message must be a hello"}, request.id);
        co_return;
    }
    if (const auto* get = std::get_if<wire::Get>(&request.body); get != nullptr && get->viewport) {
        if (const auto fits = pipeline::checkViewport(*get->viewport, services_.options.frame); !fits) {
            sendError(fits.error(), request.id);
            co_return;
        }
    }
    co_await session_->execute(shared_from_this(), std::move(request));
}

asio::awaitable<void> WebSocketConnection::handleHello(wire::Hello hello, RequestId id) {
    const pipeline::PictureSizeLimits& limits = services_.options.frame;
    const auto viewport = pipeline::checkViewport(hello.viewport.value_or(pipeline::defaultViewport(limits)), limits);
    if (!viewport) {
        sendError(viewport.error(), id);
        co_return;
    }
    hello.viewport = *viewport;
    SessionManager::JoinResult joined = kInternalError;
    joining_ = true;
    try {
        joined = co_await joinOrCreateSession(hello);
    } catch (const std::exception& fault) {
        spdlog::error("session cannot be joined fault=\"{}\"", fault.what());
    }
    joining_ = false;  // reached also after an exception, so that the deadline of the hello applies again
    if (!joined) {
        sendError(joined.error(), id);
        if (joined.error().code == ErrorCode::not_found) close(close_code::kNoSession, "no such session");
        if (joined.error().code == ErrorCode::bad_token) close(close_code::kBadToken, "wrong token");
        if (joined.error().code == ErrorCode::internal || joined.error().code == ErrorCode::later_version)
            close(close_code::kTryLater, "try again later");
        if (!session_ && helloDue_ <= services_.clock.now()) closeWithoutHello();
        co_return;
    }
    if (!session_) {
        session_ = *joined;
        helloDeadline_->cancel();
        stream_.read_message_max(services_.options.maxLoadMessageBytes);
        if (joined_) joined_();
    }
    co_await session_->addAndWelcome(shared_from_this(), std::move(hello), id);
}

/// Joins or creates the session that a hello requests. If the connection has joined a session before, returns that
/// session.
asio::awaitable<SessionManager::JoinResult> WebSocketConnection::joinOrCreateSession(wire::Hello hello) {
    const std::string token = hello.token.value_or("");
    if (session_) {
        if (hello.token && !store::equalInConstantTime(token, session_->credentials().token)) {
            co_return Error{ErrorCode::bad_token, "this token does not match the session"};
        }
        co_return session_;
    }
    if (requestedId_.empty() && hello.token) {
        co_return Error{ErrorCode::bad_token, "a token requires a session in the path: /ws/{session}"};
    }
    // After too many wrong tokens, even correct tokens are refused, so that a client that guesses tokens learns
    // nothing.
    if (hello.token && !client_->mayTryToken(services_.clock.now()))
        co_return Error{ErrorCode::too_many, "this address has sent too many wrong tokens; try again in a minute"};
    auto open = sessionOpener(token);
    auto joined = co_await awaitCallback<SessionManager::JoinResult>(std::move(open));
    if (!joined && joined.error().code == ErrorCode::bad_token) client_->countWrongToken(services_.clock.now());
    co_return joined;
}

/// Returns a function that joins the requested session, or creates one if none is requested. The function calls its
/// argument with the result.
std::function<void(SessionManager::JoinHandler)> WebSocketConnection::sessionOpener(const std::string& token) {
    return [sessions = sessions_, client = client_,
            credentials = store::SessionCredentials{requestedId_, token}](const SessionManager::JoinHandler& done) {
        if (credentials.id.empty()) {
            sessions->createSession(client, done);
        } else {
            sessions->join(credentials, client, done);
        }
    };
}

void WebSocketConnection::sendError(const Error& error, RequestId id) {
    net::sendError(*this, services_.metrics, error, id);
}

void WebSocketConnection::send(OutgoingMessage message, std::function<void()> written) {
    asio::post(stream_.get_executor(),
               [self = shared_from_this(), message = std::move(message), written = std::move(written)]() mutable {
                   if (self->ended_ || self->closing_) return;
                   const std::size_t size = message.bytes.size();
                   auto& account = self->client_->byteAccount();
                   auto held = account.reserve(size);
                   if (!held && self->unsent_ + size > kMinQueue) return self->closeForUnreadBytes();
                   self->unsent_ += size;
                   self->outbox_.push_back(
                       {std::move(message), std::move(written), held ? std::move(*held) : account.forceReserve(size)});
                   if (!self->writing_) self->writeNext();
               });
}

/// Closes the connection, because the client has too many unread messages: its byte account has no room for another
/// one.
void WebSocketConnection::closeForUnreadBytes() {
    services_.metrics.droppedSlowClients.Increment();
    spdlog::warn("client dropped: too many unread bytes client={}", client_->name());
    startClosing(close_code::kTryLater, "too many unread bytes");
}

void WebSocketConnection::watchForDisconnect() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] {
        self->watching_ = true;
        self->executedSignal_.cancel();
    });
}

void WebSocketConnection::close(std::uint16_t code, std::string reason) {
    asio::post(stream_.get_executor(), [self = shared_from_this(), code, reason = std::move(reason)]() mutable {
        if (!self->ended_) self->startClosing(code, std::move(reason));
    });
}

void WebSocketConnection::closeForShutdown() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] {
        while (self->outbox_.size() > (self->writing_ ? 1U : 0U)) {
            self->unsent_ -= self->outbox_.back().message.bytes.size();
            self->outbox_.pop_back();
        }
        self->drainedSignal_.cancel();  // wakes readMessage(), which waits while too many bytes are unsent
        if (!self->ended_) self->startClosing(close_code::kStopping, "the server is stopping");
    });
}

void WebSocketConnection::drop() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] { beast::get_lowest_layer(self->stream_).close(); });
}

/// Sends a close frame after the queued messages. The pending read then receives the client's close frame, which ends
/// the read loop.
void WebSocketConnection::startClosing(std::uint16_t code, std::string reason) {
    if (closing_) return;
    closing_.emplace(static_cast<websocket::close_code>(code), reason);
    if (!writing_) writeNext();
}

void WebSocketConnection::writeNext() {
    writing_ = !outbox_.empty();
    if (writing_) {
        stream_.binary(outbox_.front().message.binary);
        transferDeadline_.emplace(services_.options, services_.clock);
        writeFragmentsFrom(0);
    } else if (closing_ && !ended_) {
        stream_.async_close(*closing_, [self = shared_from_this()](boost::system::error_code) {});
    }
}

/// Writes the first message in the queue, from the offset `from` to its end, in fragments. Each fragment has its own
/// deadline, so a slow client is not dropped as long as it reads fast enough (see TransferDeadline).
void WebSocketConnection::writeFragmentsFrom(std::size_t from) {
    const std::string_view rest = outbox_.front().message.bytes.view().substr(from);
    const std::string_view fragment = rest.substr(0, kWriteFragment);
    const bool last = fragment.size() == rest.size();
    startWriteDeadline();
    stream_.async_write_some(
        last, asio::buffer(fragment),
        [self = shared_from_this(), last, to = from + fragment.size()](boost::system::error_code fault, std::size_t) {
            if (last || fault || self->ended_) {
                self->onMessageWritten(fault);
            } else {
                ++self->writes_;
                self->transferDeadline_->countBytes(kWriteFragment);
                self->writeFragmentsFrom(to);
            }
        });
}

void WebSocketConnection::onMessageWritten(boost::system::error_code fault) {
    ++writes_;
    deadline_->cancel();
    if (ended_ || fault) {
        outbox_.clear();
        unsent_ = 0;
        writing_ = false;
        drainedSignal_.cancel();
        if (!ended_) beast::get_lowest_layer(stream_).close();
        return;
    }
    const QueuedMessage done = std::move(outbox_.front());
    outbox_.pop_front();
    unsent_ -= done.message.bytes.size();
    services_.metrics.bytesSent.Increment(static_cast<double>(done.message.bytes.size()));
    if (unsent_ <= services_.options.maxUnsent) drainedSignal_.cancel();
    if (done.written) done.written();
    writeNext();
}

/// Starts the deadline of the current write. If the write is not complete at the deadline, the client is dropped.
void WebSocketConnection::startWriteDeadline() {
    const auto due = services_.clock.now() + transferDeadline_->nextFragmentTimeout();
    deadline_->start(due, [self = shared_from_this(), watched = writes_] {
        if (self->writes_ != watched || !self->writing_ || self->ended_) return;
        self->services_.metrics.droppedSlowClients.Increment();
        spdlog::warn("client dropped: it reads too slowly");
        beast::get_lowest_layer(self->stream_).close();
    });
}

}  // namespace oval4d::net
