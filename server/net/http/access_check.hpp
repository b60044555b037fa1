#pragma once
// Decides whether a request or a WebSocket handshake is allowed, by its host, origin, token and path.

#include <boost/beast/http/field.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "net/clients.hpp"
#include "net/http/access_control.hpp"
#include "net/http/reply.hpp"
#include "net/http/request_target.hpp"
#include "net/http/request_validation.hpp"

namespace oval4d::net {

/// Returns the value of a header field; an empty view if there is none. The view refers to the memory of the request.
std::string_view headerField(const HttpRequest& request, boost::beast::http::field name);

/// Parses the target (path and query) of a request. Returns an empty optional if the target is malformed.
std::optional<RequestTarget> targetOf(const HttpRequest& request);

/// Returns whether pages of other sites must not request this target. True for the API and for WebSockets, because
/// their answers cost time or reveal data.
bool isCrossSiteRestricted(const RequestTarget& target);

/// Checks a request by the rules of `access`. `now` is the present time. A wrong token counts against the rate limit of
/// `client`. If the request is refused, returns the reply. If the request is allowed, returns an empty optional, and
/// sets `cookie` to the value of the reply's field Set-Cookie, or to an empty string if the reply needs no cookie.
std::optional<HttpReply> checkAccess(const HttpRequest& request, const RequestTarget& target,
                                     const AccessControl& access, ClientAccount& client,
                                     ClientAccount::Clock::time_point now, std::string& cookie);

/// Returns the session id in a WebSocket path: "" for "/ws", "abc" for "/ws/abc". Returns an empty optional for other
/// paths.
std::optional<std::string> sessionIdInPath(const std::string& path);

/// Checks a WebSocket handshake, also by the rules of `access`. `now` is the present time. `hasFurtherBytes` tells
/// whether the client has already sent bytes after the handshake. If the handshake is refused, returns the reply. If
/// the handshake is allowed, returns an empty optional, and sets `session` to the session id in the path.
std::optional<HttpReply> checkHandshake(const HttpRequest& request, const AccessControl& access, ClientAccount& client,
                                        ClientAccount::Clock::time_point now, bool hasFurtherBytes,
                                        std::string& session);

}  // namespace oval4d::net
