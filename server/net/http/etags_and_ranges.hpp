#pragma once
// Conditional requests and byte ranges (RFC 9110, sections 13 and 14).

#include <cstddef>
#include <optional>
#include <string_view>

namespace oval4d::net {

/// Returns whether an If-None-Match field matches an entity tag by weak comparison. `tag` includes its quotes. The
/// field `*` matches any tag.
bool matchesEntityTag(std::string_view ifNoneMatch, std::string_view tag);

/// The range of bytes that a Range field requests: `size` bytes from offset `first`. If `satisfiable` is false, the
/// range contains no byte of the representation.
struct ByteRange {
    std::size_t first = 0, size = 0;
    bool satisfiable = true;
};

/// Parses a Range field for a representation of `size` bytes. Returns an empty optional if the server should send the
/// whole representation: for units other than bytes, for several ranges, and for malformed fields. A server may ignore
/// all of these (RFC 9110, section 14.2).
std::optional<ByteRange> parseRange(std::string_view range, std::size_t size);

}  // namespace oval4d::net
