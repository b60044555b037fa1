#pragma once
// HTTP replies, and functions that make the common kinds of replies.

#include <string>
#include <utility>
#include <vector>

#include "errors/error.hpp"
#include "net/http/request_validation.hpp"
#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// An HTTP response, independent of the HTTP library.
struct HttpReply {
    unsigned status = 200;
    std::string type;  ///< the Content-Type; if empty, the field is omitted
    SharedBytes body;
    std::vector<std::pair<std::string, std::string>> headers;
};

/// Returns a reply with the header field Cache-Control: no-cache. Caches must then ask the server before they use the
/// reply again.
HttpReply noCacheReply(std::string type, SharedBytes body, unsigned status = 200);

/// Returns a reply with a text as the body, and with Cache-Control: no-cache. `type` is the media type of the text.
HttpReply noCacheTextReply(std::string type, std::string body, unsigned status = 200);

/// Returns a reply with a JSON message of the oval4d protocol as the body, and with Cache-Control: no-cache.
HttpReply jsonReply(std::string message);

/// Returns a reply with the body `{"type":"error", …}`, and with Cache-Control: no-cache. `status` is the HTTP status;
/// 0 derives the status from the error code.
HttpReply errorReply(const Error& error, unsigned status = 0);

/// Returns a plain-text reply without further header fields, for requests that are refused before a route answers them.
HttpReply refusalReply(unsigned status, std::string text);

/// Returns the plain-text reply to a request with this fault in its header. If the status is kUpgradeRequired, the
/// reply's header fields name the WebSocket protocol.
HttpReply refusalReply(const HttpError& fault);

/// Returns a plain-text reply with status 429. Its header field Retry-After tells the client to wait for ten seconds.
HttpReply tooManyRequestsReply(std::string text);

}  // namespace oval4d::net
