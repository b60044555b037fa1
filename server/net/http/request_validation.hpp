#pragma once
// Checks of request headers that RFC 9110, RFC 9112 and RFC 6455 require, but that Beast's parser does not make.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace oval4d::net {

/// The header of a request. Bodies are read separately; only uploads have one.
using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// A fault that makes the server refuse a request: an HTTP status, and the reason as a text for the client.
struct HttpError {
    unsigned status;
    std::string reason;
};

inline constexpr unsigned kUpgradeRequired = 426;  ///< HTTP status: the client must switch to another protocol

/// What a request's header must say about a body.
enum class RequestBodyRule : bool {
    none,      ///< no body may be announced; the next request follows the header
    required,  ///< the header must state the length of the body
};

/// Validates a request header. Returns an empty optional if the header is valid. A valid header has at most one of each
/// of the fields Host, Origin and Content-Length, and announces no chunked body. After a refusal, the caller must close
/// the connection, because a proxy may disagree about where the request ends (request smuggling).
std::optional<HttpError> validateHeader(const HttpRequest& request, RequestBodyRule body);

/// Returns the length of the body in bytes, as a valid header announces it; 0 if there is no body. Lengths above the
/// maximum of std::size_t give this maximum.
std::size_t bodyLength(const HttpRequest& request);

/// Returns whether the request asks for an upgrade to WebSocket.
bool isWebSocketUpgrade(const HttpRequest& request);

/// Validates the header fields of a WebSocket handshake (RFC 6455, section 4.2.1). Does not check the path and the
/// subprotocol. Returns an empty optional if the fields are valid.
std::optional<HttpError> validateHandshake(const HttpRequest& request);

/// Returns the values of all header fields with this name, joined by commas (RFC 9110, section 5.3). Returns an empty
/// string if there is no such field. The name is not case-sensitive.
std::string combinedFieldValue(const HttpRequest& request, std::string_view name);

}  // namespace oval4d::net
