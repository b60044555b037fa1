#include "net/http_session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <optional>

#include "net/awaited.hpp"
#include "net/connection.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using protocol::ErrorCode;

namespace {

constexpr auto kIdle = std::chrono::seconds(30);  // for a whole request to arrive, or a piece of a reply to be taken
constexpr std::uint32_t kLongestHeader = 16U << 10U;
constexpr std::uint64_t kLongestBody = 16U << 10U;  // nothing here takes one

using Request = http::request<http::string_body>;

class HttpSession : public std::enable_shared_from_this<HttpSession> {
  public:
    HttpSession(asio::ip::tcp::socket socket, Front front, bool full)
        : stream_(std::move(socket)), front_(std::move(front)), place_(front_.registry), full_(full) {}

    asio::awaitable<void> run();

  private:
    asio::awaitable<std::optional<Request>> read();
    asio::awaitable<Reply> answer(const Request& request);
    asio::awaitable<bool> write(const Request& request, Reply reply);
    std::optional<Reply> refusal(const Request& request, const std::string& token, std::string& cookie) const;
    std::optional<Reply> upgradeRefusal(const Request& request, std::string& session) const;
    asio::awaitable<void> upgrade(Request request, std::string session);
    void stop();

    beast::tcp_stream stream_;
    const Front front_;
    Registry::Place place_;
    const bool full_;
    beast::flat_buffer buffer_;
    bool reading_ = false, stopping_ = false;
};

std::string_view field(const Request& request, http::field name) {
    const auto found = request.find(name);
    if (found == request.end()) return {};
    return {found->value().data(), found->value().size()};
}

std::optional<Target> targetOf(const Request& request) {
    return parseTarget({request.target().data(), request.target().size()});
}

std::string tokenIn(const session::Query& query) {
    const auto found = std::ranges::find(query, "token", &session::Query::value_type::first);
    return found == query.end() ? std::string() : found->second;
}

Reply plain(unsigned status, std::string text) {
    return {status, "text/plain; charset=utf-8", Bytes(std::move(text)), {}};
}

/// "/ws" → "", "/ws/abc" → "abc"; nothing for other paths.
std::optional<std::string> sessionIn(const std::string& path) {
    if (path == "/ws" || path == "/ws/") return "";
    if (path.starts_with("/ws/")) return path.substr(4);
    return {};
}

bool offersSubprotocol(std::string_view offered) {
    return offered.empty() || http::token_list(beast::string_view(offered.data(), offered.size())).exists(kSubprotocol);
}

/// What is answered to a request that cannot be read; nothing where nobody is there to read the answer.
std::optional<Reply> complaintAbout(boost::system::error_code fault) {
    if (fault == http::error::header_limit) return plain(431, "the header is too long\n");
    if (fault == http::error::body_limit) return plain(413, "the body is too long\n");
    if (fault == http::error::end_of_stream || fault == http::error::partial_message) return {};
    const bool malformed = fault.category() == http::make_error_code(http::error::bad_method).category();
    return malformed ? std::optional(plain(400, "this is not HTTP/1.1\n")) : std::nullopt;
}

asio::awaitable<void> HttpSession::run() {
    place_.onStop([weak = weak_from_this()] {
        if (const auto self = weak.lock()) asio::post(self->stream_.get_executor(), [self] { self->stop(); });
    });
    for (bool open = true; open && !stopping_;) {
        auto request = co_await read();
        if (!request) break;
        if (beast::websocket::is_upgrade(*request) && !full_) {
            std::string session;
            if (auto refused = upgradeRefusal(*request, session)) {
                co_await write(*request, std::move(*refused));
                break;
            }
            co_await upgrade(std::move(*request), std::move(session));
            co_return;
        }
        Reply reply = co_await answer(*request);
        open = co_await write(*request, std::move(reply));
    }
    boost::system::error_code ignored;
    (void)stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

asio::awaitable<std::optional<Request>> HttpSession::read() {
    http::request_parser<http::string_body> parser;
    parser.header_limit(kLongestHeader);
    parser.body_limit(kLongestBody);
    stream_.expires_after(kIdle);
    reading_ = true;
    const auto [fault, size] = co_await http::async_read(stream_, buffer_, parser, kQuietly);
    reading_ = false;
    if (!fault) co_return parser.release();
    if (auto complaint = complaintAbout(fault)) {
        Request unread;
        unread.keep_alive(false);
        co_await write(unread, std::move(*complaint));
    }
    co_return std::nullopt;
}

/// The reply to a request that may not be carried out, if it may not.
std::optional<Reply> HttpSession::refusal(const Request& request, const std::string& token, std::string& cookie) const {
    const Credentials credentials{field(request, http::field::host), field(request, http::field::origin),
                                  field(request, http::field::authorization), field(request, http::field::cookie),
                                  token};
    switch (front_.access.judge(credentials)) {
        case Access::Verdict::bad_host:
            return plain(403, "this server does not answer by that host name (--allow-host)\n");
        case Access::Verdict::bad_origin:
            return plain(403, "pages of that origin may not use this server (--allow-origin)\n");
        case Access::Verdict::bad_token: {
            Reply reply = plain(401, "a token is needed: ?token=… in the address, or a bearer token\n");
            reply.headers.emplace_back("WWW-Authenticate", "Bearer");
            return reply;
        }
        case Access::Verdict::allowed:
            break;
    }
    cookie = front_.access.cookieFor(credentials);
    return {};
}

/// The reply to a request for a WebSocket that is not to be had; else `session` is the one that it asks for.
std::optional<Reply> HttpSession::upgradeRefusal(const Request& request, std::string& session) const {
    const auto target = targetOf(request);
    const auto wanted = target ? sessionIn(target->path) : std::nullopt;
    if (!wanted) return errorReply({ErrorCode::not_found, "WebSockets are at /ws and /ws/{session}"});
    std::string cookie;
    if (auto refused = refusal(request, tokenIn(target->query), cookie)) return refused;
    if (!offersSubprotocol(field(request, http::field::sec_websocket_protocol))) {
        return plain(400, "this server speaks the subprotocol " + std::string(kSubprotocol) + " only\n");
    }
    session = *wanted;
    return {};
}

asio::awaitable<Reply> HttpSession::answer(const Request& request) {
    if (full_) co_return plain(503, "the server has as many connections as it can take; try again later\n");
    auto target = targetOf(request);
    if (!target) co_return plain(400, "the request's target cannot be read\n");
    std::string cookie;
    // Probes come from the machine that runs this one, by any name and without a token; they learn nothing else.
    const bool probe = target->path == "/healthz" || target->path == "/readyz";
    if (!probe) {
        if (auto refused = refusal(request, tokenIn(target->query), cookie)) co_return std::move(*refused);
    }
    Routes::Inquiry inquiry{std::string(request.method_string()), std::move(*target),
                            std::string(field(request, http::field::if_none_match)),
                            std::string(field(request, http::field::accept_encoding))};
    Reply reply = co_await front_.routes.answer(std::move(inquiry));
    if (!cookie.empty()) reply.headers.emplace_back("Set-Cookie", std::move(cookie));
    co_return reply;
}

/// Whether the connection stays open.
asio::awaitable<bool> HttpSession::write(const Request& request, Reply reply) {
    http::response<http::span_body<const char>> response{static_cast<http::status>(reply.status), 11};
    const std::string_view body = request.method() == http::verb::head ? std::string_view() : reply.body.view();
    response.set(http::field::server, "oval4d");
    if (!reply.type.empty()) response.set(http::field::content_type, reply.type);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    for (const auto& [name, value] : reply.headers) response.set(name, value);
    response.body() = {body.data(), body.size()};
    response.content_length(reply.body.size());
    response.keep_alive(request.keep_alive() && !full_ && !stopping_ && reply.status != 413 && reply.status != 431);
    front_.services.metrics.countRequest(reply.status);
    // Without the query, which may hold the token.
    const std::string_view target(request.target().data(), request.target().size());
    spdlog::debug("request method={} path=\"{}\" status={}", std::string_view(request.method_string()),
                  target.substr(0, target.find('?')), reply.status);
    http::response_serializer<http::span_body<const char>> serializer(response);
    while (!serializer.is_done()) {
        stream_.expires_after(kIdle);  // for each piece that the socket takes
        const auto [fault, size] = co_await http::async_write_some(stream_, serializer, kQuietly);
        if (fault) co_return false;
    }
    co_return response.keep_alive();
}

asio::awaitable<void> HttpSession::upgrade(Request request, std::string session) {
    auto connection = std::make_shared<Connection>(std::move(stream_), front_.services, front_.hub, std::move(session));
    place_.onStop([weak = std::weak_ptr(connection)] {
        if (const auto self = weak.lock()) self->stop();
    });
    co_await connection->run(std::move(request));
}

void HttpSession::stop() {
    stopping_ = true;
    if (reading_) stream_.close();
}

}  // namespace

asio::awaitable<void> serve(asio::ip::tcp::socket socket, Front front, bool full) {
    boost::system::error_code ignored;
    (void)socket.set_option(asio::ip::tcp::no_delay(true), ignored);
    front.services.metrics.connections.Increment();
    auto& connections = front.services.metrics.connections;
    try {
        co_await std::make_shared<HttpSession>(std::move(socket), std::move(front), full)->run();
    } catch (const std::exception& fault) {
        spdlog::error("connection failed fault=\"{}\"", fault.what());
    }
    connections.Decrement();
}

}  // namespace oval4d::net
