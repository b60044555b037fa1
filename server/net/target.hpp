#pragma once
// The target of an HTTP request: path and query.

#include <optional>
#include <string>
#include <string_view>

#include "session/query.hpp"

namespace oval4d::net {

struct Target {
    std::string path;  ///< decoded
    session::Query query;
};

/// Takes apart "/path?name=value&…". Percent signs are decoded; a plus stays a plus, for queries hold arithmetic.
/// Nothing if a percent sign is not followed by two hexadecimal digits, or the path does not begin with a slash.
std::optional<Target> parseTarget(std::string_view text);

}  // namespace oval4d::net
