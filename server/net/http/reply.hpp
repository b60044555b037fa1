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
struct Reply {
    unsigned status = 200;
    std::string type;  ///< the Content-Type; if empty, the field is omitted
    SharedBytes body;
    std::vector<std::pair<std::string, std::string>> headers;
};

/// Returns a reply that caches must not use again without asking the server (Cache-Control: no-cache).
Reply noCacheReply(std::string type, SharedBytes body, unsigned status = 200);

/// Like noCacheReply(), with a text as the body. `type`: the media type of the text.
Reply noCacheTextReply(std::string type, std::string body, unsigned status = 200);

/// Like noCacheTextReply(), with a JSON message of the oval4d protocol as the body.
Reply jsonReply(std::string message);

/// Like noCacheTextReply(), with the body `{"type":"error", …}` and the HTTP status `status`. If `status` is 0, the
/// status is derived from the error code.
Reply errorReply(const Error& error, unsigned status = 0);

/// Returns a reply with a plain text and empty `headers`, for requests that are refused before a route answers them.
Reply refusalReply(unsigned status, std::string text);

/// Returns the plain-text reply to a request whose header has this fault, with the status and the reason of the fault.
/// If the status is kUpgradeRequired, the header fields of the reply name the WebSocket protocol.
Reply refusalReply(const HttpError& fault);

/// Like refusalReply(), with status 429 and the header field Retry-After, which tells the client to wait for ten
/// seconds.
Reply tooManyReply(std::string text);

}  // namespace oval4d::net
