#pragma once
// Checks whether requests and WebSocket handshakes are allowed: their host, their origin, their token and their path.

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

/// Returns the value of a header field; empty if there is none. The view refers to the memory of the request.
std::string_view headerField(const HttpRequest& request, boost::beast::http::field name);

/// Returns the parsed target of a request; nothing if it is malformed.
std::optional<RequestTarget> targetOf(const HttpRequest& request);

/// Returns whether pages of other sites must not request this target: the API and WebSockets, which cause work or
/// reveal data.
bool isRestricted(const RequestTarget& target);

/// Checks the access rules, and counts a wrong token on the client's account. If the request is refused, returns the
/// reply; otherwise returns nothing, and sets `cookie` if the reply is to set a cookie.
std::optional<Reply> checkAccess(const HttpRequest& request, const RequestTarget& target, const AccessControl& access,
                                 Client& client, std::string& cookie);

/// Returns the session id in a WebSocket path: "" for "/ws", "abc" for "/ws/abc", nothing for other paths.
std::optional<std::string> sessionIn(const std::string& path);

/// Checks a WebSocket handshake. `hasFurtherBytes`: whether the client has sent more than the handshake. If it is
/// refused, returns the reply; otherwise returns nothing, and sets `session` to the session id in the path.
std::optional<Reply> checkHandshake(const HttpRequest& request, const AccessControl& access, Client& client,
                                    bool hasFurtherBytes, std::string& session);

}  // namespace oval4d::net
