#include "net/http/access_check.hpp"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>

#include "net/ws/websocket_connection.hpp"
#include "text/message_text.hpp"

namespace oval4d::net {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

// Returns the parts of a request that the access rules check.
AccessCheckInput accessCheckInputOf(const HttpRequest& request, const RequestTarget& target) {
    const session::QueryParameters& query = target.query;
    const auto token = std::ranges::find(query, "token", &session::QueryParameters::value_type::first);
    const auto field = [&](std::string_view name) {
        const auto found = request.find(name);
        return found == request.end() ? std::string_view() : std::string_view(found->value());
    };
    // A request target with a host (absolute form) overrides the field Host (RFC 9112, section 3.2.2).
    return {target.authority.empty() ? headerField(request, http::field::host) : std::string_view(target.authority),
            headerField(request, http::field::origin),
            headerField(request, http::field::authorization),
            headerField(request, http::field::cookie),
            token == query.end() ? std::string_view() : std::string_view(token->second),
            field("Sec-Fetch-Site"),
            field("Sec-Fetch-Mode"),
            field("Sec-Fetch-Dest")};
}

// Returns whether the server supports one of the WebSocket subprotocols that a client offers, or the client offers
// none. `offered` is the value of the header field, a list of names. Names are case-sensitive (RFC 6455, section 11.5).
bool acceptsSubprotocol(const std::string& offered) {
    const http::token_list names(offered);
    return offered.empty() || std::ranges::any_of(names, [](beast::string_view name) { return name == kSubprotocol; });
}

}  // namespace

std::string_view headerField(const HttpRequest& request, http::field name) {
    const auto found = request.find(name);
    if (found == request.end()) return {};
    return {found->value().data(), found->value().size()};
}

std::optional<RequestTarget> targetOf(const HttpRequest& request) {
    return parseRequestTarget({request.target().data(), request.target().size()});
}

std::optional<std::string> sessionIdInPath(const std::string& path) {
    if (path == "/ws" || path == "/ws/") return "";
    if (path.starts_with("/ws/")) return path.substr(4);
    return {};
}

bool isCrossSiteRestricted(const RequestTarget& target) {
    return target.path.starts_with("/api/") || target.path.starts_with("/ws");
}

std::optional<HttpReply> checkAccess(const HttpRequest& request, const RequestTarget& target,
                                     const AccessControl& access, ClientAccount& client,
                                     ClientAccount::Clock::time_point now, std::string& cookie) {
    AccessCheckInput fields = accessCheckInputOf(request, target);
    // Everybody may load the files of the web client, so such a request may have any Origin. Otherwise, the client
    // would not load behind a proxy that changes Host, because Host would then differ from Origin.
    if (!isCrossSiteRestricted(target)) fields.origin = {};
    switch (access.check(fields)) {
        case AccessControl::Verdict::bad_host:
            return refusalReply(403, "this server does not accept the host name " + text::inQuotes(fields.host) +
                                         "; allow it with --allow-host\n");
        case AccessControl::Verdict::bad_origin:
            return refusalReply(403, "pages of " + text::inQuotes(fields.origin) +
                                         " may not use this server, because the request's Host is " +
                                         text::inQuotes(fields.host) +
                                         "; a proxy must pass the header Host on, or allow the origin with "
                                         "--allow-origin\n");
        case AccessControl::Verdict::bad_token: {
            if (!client.mayTryToken(now)) return tooManyRequestsReply("too many wrong tokens; try again in a minute\n");
            if (AccessControl::presentsToken(fields)) client.countWrongToken(now);
            HttpReply reply = errorReply({ErrorCode::bad_token,
                                          "this server requires a token: open the address that it "
                                          "printed at startup, or send Authorization: Bearer …"});
            reply.headers.emplace_back("WWW-Authenticate", "Bearer");
            return reply;
        }
        case AccessControl::Verdict::allowed:
            break;
    }
    // After too many wrong tokens, even correct tokens are refused, so that a client that guesses tokens learns
    // nothing.
    if (access.requiresToken() && !client.mayTryToken(now))
        return tooManyRequestsReply("too many wrong tokens; try again in a minute\n");
    if (isCrossSiteRestricted(target) && access.isUnwantedCrossSite(fields))
        return refusalReply(403, "pages of other sites may not request this (--allow-origin)\n");
    cookie = access.tokenCookieFor(fields);
    return {};
}

std::optional<HttpReply> checkHandshake(const HttpRequest& request, const AccessControl& access, ClientAccount& client,
                                        ClientAccount::Clock::time_point now, bool hasFurtherBytes,
                                        std::string& session) {
    const auto target = targetOf(request);
    const auto wanted = target ? sessionIdInPath(target->path) : std::nullopt;
    if (!wanted) return errorReply({ErrorCode::not_found, "WebSockets are served at /ws and /ws/{session}"});
    std::string cookie;
    if (auto refusal = checkAccess(request, *target, access, client, now, cookie)) return refusal;
    if (auto fault = validateHandshake(request)) return refusalReply(*fault);
    if (!acceptsSubprotocol(combinedFieldValue(request, "Sec-WebSocket-Protocol")))
        return refusalReply(400, "the only supported WebSocket subprotocol is " + std::string(kSubprotocol) + "\n");
    if (hasFurtherBytes) return refusalReply(400, "a client must send nothing before the reply to its handshake\n");
    session = *wanted;
    return {};
}

}  // namespace oval4d::net
