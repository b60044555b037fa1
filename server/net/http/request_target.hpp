#pragma once
// Parses the target of an HTTP request into path and query.

#include <optional>
#include <string>
#include <string_view>

#include "session/query.hpp"

namespace oval4d::net {

/// A request target (RFC 9112, section 3.2).
struct RequestTarget {
    std::string path;                ///< percent-decoded
    std::string authority;           ///< host and port in absolute form, such as "localhost:8080"; empty in origin form
    session::QueryParameters query;  ///< names and values, percent-decoded
};

/// Parses "/path?name=value&…" (origin form) or "http://host:port/path?…" (absolute form; RFC 9112, section 3.2).
/// Decodes percent escapes and, in the values of the query, "+" as a blank unless it stands between two operands of
/// arithmetic; leaves out the parameters that protocol/address.json ignores. Reads "&amp;" as
/// "&", and escapes that were escaped again, as mailers and forums do. Returns nothing if an escape is malformed,
/// the authority is invalid, or the path does not begin with a slash.
std::optional<RequestTarget> parseRequestTarget(std::string_view text);

}  // namespace oval4d::net
