#pragma once
// Conditional requests and byte ranges (RFC 9110, sections 13 and 14).

#include <cstddef>
#include <optional>
#include <string_view>

namespace oval4d::net {

/// Returns whether the header field If-None-Match contains the entity tag `tag`, whose quotes are included. A prefix W/
/// in the field does not matter (weak comparison). The field `*` matches any tag.
bool matchesEntityTag(std::string_view ifNoneMatch, std::string_view tag);

/// A range of bytes that a client requests from a file: `size` bytes from the offset `first`. If `satisfiable` is
/// false, the file has no byte in the requested range.
struct ByteRange {
    std::size_t first = 0, size = 0;
    bool satisfiable = true;
};

/// Parses the header field Range of a request for a file of `size` bytes. Returns an empty optional for units other
/// than bytes, for several ranges, and for a malformed field. The server then sends the whole file, because it may
/// ignore the field Range (RFC 9110, section 14.2).
std::optional<ByteRange> parseRange(std::string_view range, std::size_t size);

}  // namespace oval4d::net
