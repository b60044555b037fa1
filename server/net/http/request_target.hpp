#pragma once
// Parses the target of an HTTP request into a path and a query.

#include <optional>
#include <string>
#include <string_view>

#include "session/query_text.hpp"

namespace oval4d::net {

/// The parsed target of an HTTP request (RFC 9112, section 3.2).
struct RequestTarget {
    std::string path;       ///< percent-decoded
    std::string authority;  ///< host and port, such as "localhost:8080"; empty if the target has none
    session::QueryParameters query;
};

/// Parses a request target such as "/path?name=value&…" (origin form) or "http://host:port/path?…" (absolute form; RFC
/// 9112, section 3.2). Decodes percent escapes, those of the query as session::parseQuery() does. Returns an empty
/// optional if an escape is malformed, the authority is invalid, or the path does not begin with a slash.
std::optional<RequestTarget> parseRequestTarget(std::string_view text);

}  // namespace oval4d::net
