#pragma once
// Parses the target of an HTTP request into path and query.

#include <optional>
#include <string>
#include <string_view>

#include "session/query_text.hpp"

namespace oval4d::net {

/// A request target (RFC 9112, section 3.2).
struct RequestTarget {
    std::string path;       ///< percent-decoded
    std::string authority;  ///< host and port, such as "localhost:8080"; empty for a target in origin form
    session::QueryParameters query;
};

/// Parses "/path?name=value&…" (origin form) or "http://host:port/path?…" (absolute form; RFC 9112, section 3.2).
/// Decodes percent escapes; see session::parseQuery(). Returns an empty optional if an escape is malformed, the
/// authority is invalid, or the path does not begin with a slash.
std::optional<RequestTarget> parseRequestTarget(std::string_view text);

}  // namespace oval4d::net
