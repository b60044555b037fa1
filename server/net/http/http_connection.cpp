// This file is long, because a connection is one class: its functions share the stream, its buffer and its deadlines.

#include "net/http/http_connection.hpp"

#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "net/coroutine_helpers.hpp"
#include "net/http/access_check.hpp"
#include "net/http/request_validation.hpp"
#include "net/http/upload.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "net/live/errors.hpp"
#include "net/pause.hpp"
#include "net/transfer_deadline.hpp"
#include "net/ws/websocket_connection.hpp"
#include "text/message_text.hpp"
#include "wire/messages.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

namespace {

constexpr std::uint32_t kMaxHeaderBytes = 16U << 10U;
constexpr std::size_t kReadBufferBytes = 64U << 10U;

// After a refusal, the server continues to read for at most this many bytes and this long. Closing a socket with unread
// bytes would reset the connection, and the client might not receive the reply.
constexpr std::size_t kMaxLingerBytes = 256U << 10U;
constexpr auto kLingerTime = std::chrono::seconds(1);

// The kernel's buffer of a socket contains at most about this many bytes that are not sent yet.
constexpr int kNotSentLowat = 256 << 10;

/// Serves the HTTP requests of one connection, one after another.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
  public:
    HttpConnection(asio::ip::tcp::socket socket, ServerContext context, ClientAccountPtr client,
                   ConnectionRegistry::AdmissionDecision admission)
        : stream_(std::move(socket)),
          context_(std::move(context)),
          client_(std::move(client)),
          registration_(context_.connections, client_),
          admission_(admission),
          deadline_(clock().makeTimer(stream_.get_executor())) {}

    asio::awaitable<void> run();

  private:
    asio::awaitable<std::optional<HttpRequest>> readRequest();
    asio::awaitable<bool> serveRequest(HttpRequest request);
    asio::awaitable<HttpReply> answer(const HttpRequest& request);
    std::optional<HttpReply> connectionRefusalReply() const;
    asio::awaitable<bool> serveUpload(HttpRequest request);
    asio::awaitable<std::optional<Result<LiveSession::CommandResult>>> restoreState(
        std::shared_ptr<LiveSession> session, std::shared_ptr<const fields::FileHandle> file);
    std::optional<HttpReply> checkUpload(const HttpRequest& request, UploadRequest& upload, std::string& token) const;
    asio::awaitable<SessionManager::JoinResult> joinSession(std::string session, std::string token);
    std::function<void(SessionManager::JoinHandler)> sessionJoiner(std::string session, std::string token) const;
    HttpReply replyTo(const Result<LiveSession::CommandResult>& applied);
    asio::awaitable<std::optional<HttpReply>> receiveBody(const HttpRequest& request, UploadedBody& body);
    asio::awaitable<bool> write(const HttpRequest& request, HttpReply reply);
    asio::awaitable<void> refuse(const HttpRequest& request, HttpReply reply);
    asio::awaitable<void> linger();
    void identifyClient(const HttpRequest& request);
    std::string crossOriginResourcePolicy(const RequestTarget& target) const;
    asio::awaitable<void> upgradeToWebSocket(HttpRequest request, std::string session);
    void end(ConnectionRegistry::EndReason reason);

    void startDeadline(TimerClock::Clock::duration timeout);
    void endDeadline();

    const ServerOptions& options() const { return context_.services.options; }
    const TimerClock& clock() const { return context_.services.clock; }

    beast::tcp_stream stream_;
    const ServerContext context_;
    ClientAccountPtr client_;
    ConnectionRegistry::Registration registration_;
    ConnectionRegistry::AdmissionDecision admission_;
    std::string resourcePolicy_;  // the Cross-Origin-Resource-Policy of the reply
    beast::flat_buffer buffer_{kReadBufferBytes};
    bool first_ = true, reading_ = false, stopping_ = false;
    const std::unique_ptr<Timer> deadline_;  // closes the stream when it expires
    std::uint64_t deadlineChanges_ = 0;      // how often deadline_ was started or ended; tells late calls of deadline_
    bool timedOut_ = false;                  // whether deadline_ has closed the stream
};

/// Returns the reply to a request that could not be parsed. Returns an empty optional if no reply is possible: the
/// client has disconnected, or has not sent a whole header in time.
std::optional<HttpReply> parseErrorReply(boost::system::error_code fault) {
    if (fault == http::error::header_limit || fault == http::error::buffer_overflow)
        return refusalReply(431, "the header is too long; at most 16 KiB are allowed\n");
    if (fault == http::error::end_of_stream || fault == http::error::partial_message) return {};
    const bool malformed = fault.category() == http::make_error_code(http::error::bad_method).category();
    return malformed ? std::optional(refusalReply(400, "malformed HTTP/1.1 request: " + fault.message() + "\n"))
                     : std::nullopt;
}

asio::awaitable<void> HttpConnection::run() {
    registration_.setEndHandler([weak = weak_from_this()](ConnectionRegistry::EndReason reason) {
        if (const auto self = weak.lock())
            asio::post(self->stream_.get_executor(), [self, reason] { self->end(reason); });
    });
    for (bool open = true; open && !stopping_;) {
        auto request = co_await readRequest();
        if (!request) break;
        registration_.setInUse(true);
        open = co_await serveRequest(std::move(*request));
        registration_.setInUse(false);
        first_ = false;
    }
    if (!stream_.socket().is_open())
        co_return;  // the socket was closed, or upgradeToWebSocket() has moved it to a WebSocket
    boost::system::error_code ignored;
    (void)stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

/// Serves one request. Resolves to whether another request may follow on this connection.
asio::awaitable<bool> HttpConnection::serveRequest(HttpRequest request) {
    const auto uploadTarget = targetOf(request);
    const bool uploads = uploadTarget && isUpload(std::string_view(request.method_string()), uploadTarget->path);
    if (auto fault = validateHeader(request, uploads ? RequestBodyRule::required : RequestBodyRule::none)) {
        co_await refuse(request, refusalReply(*fault));
        co_return false;
    }
    identifyClient(request);
    const auto wait = client_->countMessage(request.target().size(), clock().now());
    co_await pauseFor(clock(), stream_.get_executor(), wait);
    if (uploads) co_return co_await serveUpload(std::move(request));
    if (!isWebSocketUpgrade(request) || admission_ != ConnectionRegistry::AdmissionDecision::admitted) {
        HttpReply reply = co_await answer(request);
        co_return co_await write(request, std::move(reply));
    }
    std::string session;
    if (auto refusal = checkHandshake(request, context_.access, *client_, clock().now(), buffer_.size() > 0, session)) {
        co_await refuse(request, std::move(*refusal));
    } else {
        co_await upgradeToWebSocket(std::move(request), std::move(session));
    }
    co_return false;
}

asio::awaitable<std::optional<HttpRequest>> HttpConnection::readRequest() {
    http::request_parser<http::empty_body> parser;
    parser.header_limit(kMaxHeaderBytes);
    parser.body_limit(boost::none);  // not needed: the parser never reads a body
    // The timeout covers the reading of the whole header.
    startDeadline(toSteadyDuration(first_ ? options().helloTimeout : options().idleTimeout));
    reading_ = true;
    const auto [fault, size] = co_await http::async_read_header(stream_, buffer_, parser, kAsTuple);
    reading_ = false;
    endDeadline();
    if (!fault) co_return parser.release();
    if (auto reply = parseErrorReply(fault)) co_await refuse(HttpRequest(), std::move(*reply));
    co_return std::nullopt;
}

/// If a trusted proxy has sent the request, assigns the connection to the client that X-Forwarded-For names, and checks
/// whether that client has too many connections. Otherwise, does nothing.
void HttpConnection::identifyClient(const HttpRequest& request) {
    boost::system::error_code fault;
    const auto peer = stream_.socket().remote_endpoint(fault);
    if (fault || !context_.services.clients.isTrustedProxy(peer.address())) return;
    const auto origin =
        context_.services.clients.clientAddress(combinedFieldValue(request, "X-Forwarded-For"), peer.address());
    const ClientAccountPtr client = context_.services.clients.findOrCreate(origin, clock().now());
    if (client == client_) return;
    registration_.setClient(client);
    client_ = client;
    admission_ = context_.connections.makeRoomFor(*client_, 1);
}

/// If this connection exceeds a limit on connections, returns the refusal with which each of its requests is answered;
/// otherwise an empty optional.
std::optional<HttpReply> HttpConnection::connectionRefusalReply() const {
    if (admission_ == ConnectionRegistry::AdmissionDecision::server_full)
        return refusalReply(503, "the server has too many connections; try again later\n");
    if (admission_ == ConnectionRegistry::AdmissionDecision::client_full)
        return tooManyRequestsReply("this address has too many connections; close some or try again later\n");
    return {};
}

asio::awaitable<HttpReply> HttpConnection::answer(const HttpRequest& request) {
    if (auto refusal = connectionRefusalReply()) co_return std::move(*refusal);
    auto target = targetOf(request);
    if (!target) {
        co_return errorReply(
            {ErrorCode::bad_message,
             "the address is malformed: a % must be followed by two hexadecimal digits, as in %25, and "
             "the path begins with /"},
            400);
    }
    std::string cookie;
    // Health probes may use any host name and need no token, because they reveal only whether the server works.
    const bool probe = target->path == "/healthz" || target->path == "/readyz";
    if (!probe) {
        if (auto refusal = checkAccess(request, *target, context_.access, *client_, clock().now(), cookie))
            co_return std::move(*refusal);
    }
    resourcePolicy_ = crossOriginResourcePolicy(*target);
    const bool reads = request.method() == http::verb::get || request.method() == http::verb::head;
    if (reads && sessionIdInPath(target->path))
        co_return refusalReply(HttpError{kUpgradeRequired, "this path serves WebSockets: request an upgrade"});
    Routes::ParsedRequest parsed{std::string(request.method_string()),
                                 std::move(*target),
                                 combinedFieldValue(request, "If-None-Match"),
                                 combinedFieldValue(request, "Accept-Encoding"),
                                 std::string(headerField(request, http::field::range)),
                                 std::string(headerField(request, http::field::if_range)),
                                 client_};
    HttpReply reply = co_await context_.routes.answer(std::move(parsed));
    if (!cookie.empty()) reply.headers.emplace_back("Set-Cookie", std::move(cookie));
    co_return reply;
}

/// Receives an uploaded file. Loads its field into a session, or restores the state in the file. Checks the header and
/// joins the session before the body is read. If the upload is refused before the whole body is read, closes the
/// connection. Resolves to whether another request may follow on this connection.
asio::awaitable<bool> HttpConnection::serveUpload(HttpRequest request) {
    UploadRequest upload;
    std::string token;
    if (auto refusal = checkUpload(request, upload, token)) {
        co_await refuse(request, std::move(*refusal));
        co_return false;
    }
    const auto joined = co_await joinSession(upload.session, std::move(token));
    if (!joined) {
        HttpReply refusal = uploadErrorReply(joined.error());
        co_await refuse(request, std::move(refusal));
        co_return false;
    }
    const std::shared_ptr<LiveSession>& session = *joined;
    const struct SessionLeaveGuard {
        SessionManager& sessions;
        const std::shared_ptr<LiveSession>& session;
        ~SessionLeaveGuard() { sessions.leave(session, nullptr); }
    } leaving{*context_.sessions, session};
    UploadedBody body(client_);
    if (auto refusal = co_await receiveBody(request, body)) {
        co_await refuse(request, std::move(*refusal));
        co_return false;
    }
    if (!stream_.socket().is_open()) co_return false;
    const auto file = body.finish();
    std::optional<Result<LiveSession::CommandResult>> applied;
    if (upload.load) {
        upload.load->file = file;
        applied = co_await session->apply(client_, std::move(*upload.load));
    } else {
        applied = co_await restoreState(session, file);
    }
    HttpReply reply = replyTo(*applied);
    co_return co_await write(request, std::move(reply));
}

/// Restores the state that an uploaded file contains. A worker parses the file, because parsing may take long.
asio::awaitable<std::optional<Result<LiveSession::CommandResult>>> HttpConnection::restoreState(
    std::shared_ptr<LiveSession> session, std::shared_ptr<const fields::FileHandle> file) {
    constexpr parallel::WorkerPool::Seconds kRoughCost{0.1};
    try {
        auto work = parseStateFileJob(std::move(file), options().maxLoadMessageBytes);
        ParsedStateFile parsed = co_await runOnPool<ParsedStateFile>(
            context_.services.pictureWorkers.workers(), std::move(work), client_->pictureJobQueue(), kRoughCost);
        if (!*parsed) co_return parsed->error();
        co_return co_await session->apply(client_, std::move(**parsed));
    } catch (const parallel::QueueFull&) {
        co_return kTooManyJobs;
    }
}

HttpReply HttpConnection::replyTo(const Result<LiveSession::CommandResult>& applied) {
    if (applied) return jsonReply(wire::answerMessage(wire::Done{applied->revision, applied->warnings}, {}));
    context_.services.metrics.countError(applied.error().code);
    return uploadErrorReply(applied.error());
}

/// Checks the header of an upload. If the upload is refused, returns the reply. Otherwise returns an empty optional,
/// and sets `upload` and `token`. `token` is the session token in the request, which may be wrong.
std::optional<HttpReply> HttpConnection::checkUpload(const HttpRequest& request, UploadRequest& upload,
                                                     std::string& token) const {
    if (auto refusal = connectionRefusalReply()) return refusal;
    const auto target = targetOf(request);
    std::string cookie;
    if (auto refusal = checkAccess(request, *target, context_.access, *client_, clock().now(), cookie)) return refusal;
    auto parsed = parseUpload(std::string_view(request.method_string()), *target, context_.services.options.session);
    if (!parsed) return uploadErrorReply(parsed.error());
    const std::size_t most = parsed->load ? options().maxUpload : std::min(options().maxUpload, kMaxStateFile);
    if (bodyLength(request) > most) {
        return uploadErrorReply({ErrorCode::too_large, "an uploaded file may have at most " + std::to_string(most) +
                                                           " bytes" +
                                                           (most == options().maxUpload ? " (--max-upload)" : "")});
    }
    const auto given = request.find("Session-Token");
    if (given == request.end()) {
        return errorReply(
            {ErrorCode::bad_token, "an upload needs the session's token in the header field Session-Token"});
    }
    if (!client_->mayTryToken(clock().now()))
        return tooManyRequestsReply("this address has sent too many wrong tokens; try again in a minute\n");
    token = {given->value().data(), given->value().size()};
    upload = std::move(*parsed);
    return {};
}

asio::awaitable<SessionManager::JoinResult> HttpConnection::joinSession(std::string session, std::string token) {
    auto join = sessionJoiner(std::move(session), std::move(token));
    auto joined = co_await awaitCallback<SessionManager::JoinResult>(std::move(join));
    if (!joined && joined.error().code == ErrorCode::bad_token) client_->countWrongToken(clock().now());
    co_return joined;
}

std::function<void(SessionManager::JoinHandler)> HttpConnection::sessionJoiner(std::string session,
                                                                               std::string token) const {
    return [sessions = context_.sessions, client = client_,
            credentials = store::SessionCredentials{std::move(session), std::move(token)}](
               const SessionManager::JoinHandler& done) { sessions->join(credentials, client, done); };
}

/// Reads the body of a request with a valid header. If the body is refused, returns the reply. Otherwise returns an
/// empty optional: the body is complete, or the stream is closed because the client has left or sends too slowly.
asio::awaitable<std::optional<HttpReply>> HttpConnection::receiveBody(const HttpRequest& request, UploadedBody& body) {
    std::size_t left = bodyLength(request);
    TransferDeadline deadline(options(), context_.services.clock);
    if (left > 0 && buffer_.size() == 0 && request.count(http::field::expect) > 0) {
        constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
        startDeadline(deadline.nextFragmentTimeout());
        const auto [fault, size] = co_await asio::async_write(stream_, asio::buffer(kContinue), kAsTuple);
        endDeadline();
        if (fault) stream_.close();
    }
    while (left > 0 && stream_.socket().is_open()) {
        if (buffer_.size() == 0) {
            startDeadline(deadline.nextFragmentTimeout());
            reading_ = true;
            const auto [fault, size] = co_await stream_.async_read_some(buffer_.prepare(kReadBufferBytes), kAsTuple);
            reading_ = false;
            endDeadline();
            if (timedOut_) context_.services.metrics.droppedSlowClients.Increment();
            if (fault) stream_.close();
            buffer_.commit(size);
            deadline.countBytes(size);
        }
        const std::size_t taken = std::min(left, buffer_.size());
        if (auto error = body.append({static_cast<const char*>(buffer_.cdata().data()), taken})) {
            context_.services.metrics.countError(error->code);
            co_return uploadErrorReply(*error);
        }
        buffer_.consume(taken);
        left -= taken;
        const auto wait = client_->countBytes(taken, clock().now());
        co_await pauseFor(clock(), stream_.get_executor(), wait);
    }
    co_return std::nullopt;
}

/// Returns the Cross-Origin-Resource-Policy of a reply. If any foreign origin is allowed, pages of all origins may
/// embed replies of the API, because browsers do not tell which page embeds a picture.
std::string HttpConnection::crossOriginResourcePolicy(const RequestTarget& target) const {
    return isCrossSiteRestricted(target) && context_.access.allowsForeignOrigins() ? "cross-origin" : "same-origin";
}

/// Sends a refusal and closes the connection, because it is uncertain at which byte the next request would begin.
asio::awaitable<void> HttpConnection::refuse(const HttpRequest& request, HttpReply reply) {
    resourcePolicy_ = "same-origin";
    HttpRequest last(request);
    last.keep_alive(false);
    if (co_await write(last, std::move(reply))) co_return;
    co_await linger();
}

/// Reads and discards input for a short time, so that the client receives the reply that was sent before. Then closes
/// the socket.
asio::awaitable<void> HttpConnection::linger() {
    boost::system::error_code ignored;
    (void)stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    startDeadline(kLingerTime);
    buffer_.clear();
    for (std::size_t lingering = 0; lingering < kMaxLingerBytes;) {
        const auto [fault, size] = co_await stream_.async_read_some(buffer_.prepare(kReadBufferBytes), kAsTuple);
        if (fault) break;
        lingering += size;
    }
    endDeadline();
    stream_.close();
}

/// Writes a reply. Resolves to whether the connection stays open.
asio::awaitable<bool> HttpConnection::write(const HttpRequest& request, HttpReply reply) {
    http::response<http::span_body<const char>> response{static_cast<http::status>(reply.status), 11};
    const std::string_view body = request.method() == http::verb::head ? std::string_view() : reply.body.view();
    response.set(http::field::server, "oval4d");
    if (!reply.type.empty()) response.set(http::field::content_type, reply.type);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", resourcePolicy_.empty() ? "same-origin" : resourcePolicy_);
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    for (const auto& [name, value] : reply.headers) response.set(name, value);
    response.body() = {body.data(), body.size()};
    if (reply.status != 304) response.content_length(reply.body.size());
    const bool rejected = admission_ != ConnectionRegistry::AdmissionDecision::admitted;
    response.keep_alive(request.keep_alive() && !rejected && !stopping_);
    // Clients of HTTP/1.0 expect that the server closes the connection after the reply, unless this field says
    // otherwise.
    if (request.version() < 11 && response.keep_alive()) response.set(http::field::connection, "keep-alive");
    if (reply.status == kUpgradeRequired) response.set(http::field::connection, "close, upgrade");
    context_.services.metrics.countRequest(reply.status);
    // The log omits the query of the target, because the query may contain the token.
    const std::string_view target(request.target().data(), request.target().size());
    spdlog::debug("request method={} path=\"{}\" status={}", std::string_view(request.method_string()),
                  target.substr(0, target.find('?')), reply.status);
    http::response_serializer<http::span_body<const char>> serializer(response);
    TransferDeadline deadline(options(), context_.services.clock);
    while (!serializer.is_done()) {
        startDeadline(deadline.nextFragmentTimeout());
        const auto [fault, size] = co_await http::async_write_some(stream_, serializer, kAsTuple);
        endDeadline();
        if (fault) {
            if (timedOut_) context_.services.metrics.droppedSlowClients.Increment();
            co_return false;
        }
        deadline.countBytes(size);
    }
    co_return response.keep_alive();
}

asio::awaitable<void> HttpConnection::upgradeToWebSocket(HttpRequest request, std::string session) {
    auto connection =
        std::make_shared<WebSocketConnection>(std::move(stream_), context_.services, context_.sessions, client_,
                                              std::move(session), [this] { registration_.setInUse(true); });
    registration_.setInUse(false);
    registration_.setEndHandler([weak = std::weak_ptr(connection)](ConnectionRegistry::EndReason reason) {
        const auto self = weak.lock();
        if (!self) return;
        if (reason == ConnectionRegistry::EndReason::stopping) {
            self->closeForShutdown();
        } else {
            self->drop();
        }
    });
    // isWebSocketUpgrade() has checked the combined values of all fields Connection and of all fields Upgrade. Beast
    // checks only the first field of each name. So these fields are replaced by single ones with the values that Beast
    // requires.
    request.set(http::field::connection, "upgrade");
    request.set(http::field::upgrade, "websocket");
    co_await connection->serveClient(std::move(request));
}

/// Closes the stream after `timeout`, unless the deadline is started again or ended before. The operation that waits
/// for the client then fails.
void HttpConnection::startDeadline(TimerClock::Clock::duration timeout) {
    deadline_->start(clock().now() + timeout, [weak = weak_from_this(), started = ++deadlineChanges_] {
        const auto self = weak.lock();
        if (!self || self->deadlineChanges_ != started) return;
        self->timedOut_ = true;
        self->stream_.close();
    });
}

void HttpConnection::endDeadline() {
    ++deadlineChanges_;
    deadline_->cancel();
}

void HttpConnection::end(ConnectionRegistry::EndReason reason) {
    stopping_ = true;
    if (reading_ || reason == ConnectionRegistry::EndReason::evicted) stream_.close();
}

}  // namespace

asio::awaitable<void> serveHttp(asio::ip::tcp::socket socket, ServerContext context) {
    boost::system::error_code fault;
    (void)socket.set_option(asio::ip::tcp::no_delay(true), fault);
    // Limits the unsent bytes in the kernel's buffer, so that the server can see how fast a client reads.
    using NotSentLimit = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
    (void)socket.set_option(NotSentLimit(kNotSentLowat), fault);
    const auto peer = socket.remote_endpoint(fault);
    if (fault) co_return;  // the client has disconnected
    context.services.metrics.connections.Increment();
    auto& connections = context.services.metrics.connections;
    try {
        ClientAccountPtr client = context.services.clients.findOrCreate(peer.address(), context.services.clock.now());
        // The limit of connections per client does not apply to a trusted proxy, because its connections serve many
        // clients. Each request names its client in X-Forwarded-For.
        const bool isProxy = context.services.clients.isTrustedProxy(peer.address());
        const auto admission = context.connections.makeRoomFor(*client, 0, isProxy);
        co_await std::make_shared<HttpConnection>(std::move(socket), std::move(context), std::move(client), admission)
            ->run();
    } catch (const std::exception& failure) {
        spdlog::error("connection failed fault=\"{}\"", failure.what());
    }
    connections.Decrement();
}

}  // namespace oval4d::net
