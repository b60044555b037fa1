#pragma once
// Checks of request headers that RFC 9110, RFC 9112 and RFC 6455 require, but that Beast's parser does not make.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace oval4d::net {

/// A request without a body, because no route accepts a body.
using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// The reason why a request is refused: an HTTP status and a message for the client.
struct HttpError {
    unsigned status;
    std::string reason;
};

/// Validates a request header; returns nothing if it is valid. A valid header announces no body, so the next request
/// begins directly after it. A valid header has at most one Host, Origin and Content-Length field. After a refusal, the
/// connection must be closed, because a proxy may disagree about where the request ends (request smuggling).
std::optional<HttpError> validateHeader(const HttpRequest& request);

/// Returns whether the request asks for an upgrade to WebSocket.
bool isWebSocketUpgrade(const HttpRequest& request);

/// Validates a WebSocket handshake (RFC 6455, section 4.2.1), but not its path or subprotocol; returns nothing if it is
/// valid.
std::optional<HttpError> validateHandshake(const HttpRequest& request);

/// Returns the values of all fields with this name, joined by commas (RFC 9110, section 5.3); an empty text if there is
/// no such field. The name is not case-sensitive.
std::string combinedFieldValue(const HttpRequest& request, std::string_view name);

}  // namespace oval4d::net
