#pragma once
// HTTP responses.

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

/// Returns a reply that caches must not keep without asking.
Reply uncachedReply(std::string type, SharedBytes body, unsigned status = 200);

/// Returns such a reply with a text of the type `type`.
Reply textReply(std::string type, std::string body, unsigned status = 200);

/// Returns a reply whose body is a message of the protocol.
Reply jsonReply(std::string message);

/// Returns a reply with the body `{"type":"error", …}` and the HTTP status `status`. If `status` is 0, the status is
/// derived from the error code.
Reply errorReply(const Error& error, unsigned status = 0);

/// Returns a reply with a plain text and no other headers, for requests that are refused before a route answers them.
Reply refusalReply(unsigned status, std::string text);

/// Returns such a reply with the status and the reason of a fault in the request's header.
Reply refusalReply(const HttpError& fault);

/// Returns such a reply with status 429, which tells the client to wait for ten seconds.
Reply tooManyReply(std::string text);

}  // namespace oval4d::net
