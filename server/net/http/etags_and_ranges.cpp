#include "net/http/etags_and_ranges.hpp"

#include <algorithm>
#include <charconv>

#include "text/words.hpp"

namespace oval4d::net {

namespace {

/// Parses a decimal number of bytes. For a number above the maximum of std::size_t, returns this maximum. Returns an
/// empty optional unless the text consists of digits.
std::optional<std::size_t> parseByteCount(std::string_view digits) {
    std::size_t value = 0;
    const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (fault == std::errc::result_out_of_range && end == digits.data() + digits.size())
        return static_cast<std::size_t>(-1);
    if (fault != std::errc{} || end != digits.data() + digits.size()) return {};
    return value;
}

}  // namespace

bool matchesEntityTag(std::string_view ifNoneMatch, std::string_view tag) {
    if (text::trimmed(ifNoneMatch) == "*") return true;
    // Searches for quotes instead of commas: an entity tag may contain commas, but never quotes.
    for (std::size_t open = ifNoneMatch.find('"'); open != std::string_view::npos; open = ifNoneMatch.find('"', open)) {
        const std::size_t close = ifNoneMatch.find('"', open + 1);
        if (close == std::string_view::npos) return false;
        if (ifNoneMatch.substr(open, close + 1 - open) == tag) return true;
        open = close + 1;
    }
    return false;
}

std::optional<ByteRange> parseRange(std::string_view range, std::size_t size) {
    constexpr std::string_view kUnit = "bytes=";
    if (!range.starts_with(kUnit)) return {};
    const std::string_view spec = text::trimmed(range.substr(kUnit.size()));
    const std::size_t dash = spec.find('-');
    if (dash == std::string_view::npos || spec.find(',') != std::string_view::npos) return {};
    const std::string_view from = spec.substr(0, dash), to = spec.substr(dash + 1);
    if (from.empty()) {
        const auto suffix = parseByteCount(to);
        if (!suffix) return {};
        const std::size_t length = std::min(*suffix, size);
        return ByteRange{size - length, length, length > 0};
    }
    const auto first = parseByteCount(from);
    const auto last = to.empty() ? std::optional(static_cast<std::size_t>(-1)) : parseByteCount(to);
    if (!first || !last || *last < *first) return {};
    if (*first >= size) return ByteRange{0, 0, false};
    return ByteRange{*first, std::min(*last, size - 1) - *first + 1, true};
}

}  // namespace oval4d::net
