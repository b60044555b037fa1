#pragma once
// Checks of request headers that RFC 9110, 9112 and 6455 require and that Beast's parser does not make.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace oval4d::net {

/// A request without a body: no route accepts one.
using Request = boost::beast::http::request<boost::beast::http::empty_body>;

/// The reason why a request is refused: an HTTP status and a message for the client.
struct Refusal {
    unsigned status;
    std::string reason;
};

/// Validates a request header; returns nothing if it is valid. A valid header announces no body, so the next request
/// begins right after it, and has at most one Host, Origin and Content-Length field. After a refusal the connection
/// must be closed, since a proxy may see the end of the request elsewhere (request smuggling).
std::optional<Refusal> validateHeader(const Request& request);

/// Whether the request asks for an upgrade to WebSocket.
bool isWebSocketUpgrade(const Request& request);

/// Validates a WebSocket handshake except for its path (RFC 6455, section 4.2.1); returns nothing if it is valid.
std::optional<Refusal> validateHandshake(const Request& request);

/// The combined value of all fields with this name, in any case, joined by commas (RFC 9110, section 5.3); empty if
/// there is none.
std::string combinedFieldValue(const Request& request, std::string_view name);

}  // namespace oval4d::net
