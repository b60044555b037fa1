#pragma once
// Checks of request headers that RFC 9110, RFC 9112 and RFC 6455 require, but that Beast's parser does not make.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace oval4d::net {

/// The header of a request. A body, which only uploads have, is read separately.
using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// The reason why a request is refused: an HTTP status and a message for the client.
struct HttpError {
    unsigned status;
    std::string reason;
};

inline constexpr unsigned kUpgradeRequired = 426;  ///< HTTP status: the client must use another protocol

/// What the header of a request must say about a body.
enum class BodyRule : bool {
    none,      ///< the header must announce no body; the next request begins directly after the header
    required,  ///< the header must state the length of the body
};

/// Validates a request header; returns an empty optional if it is valid. A valid header has at most one Host, Origin
/// and Content-Length field, and announces no chunked body. After a refusal, the connection must be closed, because a
/// proxy may disagree about where the request ends (request smuggling).
std::optional<HttpError> validateHeader(const HttpRequest& request, BodyRule body);

/// Returns the length in bytes that a valid header announces for the body; 0 if it announces no body. Returns the
/// maximum of std::size_t if the length is greater.
std::size_t bodyLength(const HttpRequest& request);

/// Returns whether the request asks for an upgrade to WebSocket.
bool isWebSocketUpgrade(const HttpRequest& request);

/// Validates a WebSocket handshake (RFC 6455, section 4.2.1), but not its path or subprotocol; returns an empty
/// optional if it is valid.
std::optional<HttpError> validateHandshake(const HttpRequest& request);

/// Returns the values of all fields with this name, joined by commas (RFC 9110, section 5.3); an empty string if there
/// is no such field. The name is not case-sensitive.
std::string combinedFieldValue(const HttpRequest& request, std::string_view name);

}  // namespace oval4d::net
