#include "protocol/cpp/suggest.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <numeric>
#include <vector>

namespace oval4d::protocol {

namespace {

// Levenshtein's distance; both texts are short.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

constexpr std::size_t kLongest = 60;

// The length of the UTF-8 character at this place, or 0 if there is none.
std::size_t characterAt(std::string_view text, std::size_t at) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t size = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
    if (at + size > text.size()) return 0;
    for (std::size_t i = 1; i < size; ++i) {
        if ((static_cast<unsigned char>(text[at + i]) & 0xC0U) != 0x80) return 0;
    }
    return size;
}

}  // namespace

std::string_view nearest(std::string_view text, std::span<const std::string_view> candidates) {
    text = text.substr(0, kLongest);
    std::string_view best;
    std::size_t least = 2 * kLongest;
    for (const std::string_view candidate : candidates) {
        // Of equals the one of the same length: "25-cell" is rather 24-cell than 5-cell.
        const std::size_t d = 2 * distance(text, candidate) + (candidate.size() == text.size() ? 0 : 1);
        if (d < least && d <= candidate.size() + 1) {
            least = d;
            best = candidate;
        }
    }
    return best;
}

std::string didYouMean(std::string_view text, std::span<const std::string_view> candidates) {
    const std::string_view name = nearest(text, candidates);
    return name.empty() ? std::string{} : " (did you mean '" + std::string(name) + "'?)";
}

std::string listed(std::span<const std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) {
        if (!list.empty()) list += ", ";
        list += name;
    }
    return list;
}

std::string inQuotes(std::string_view text) {
    std::string shown = "'";
    std::size_t at = 0;
    while (at < text.size() && at < kLongest) {
        const std::size_t size = characterAt(text, at);
        const bool printable = size > 1 || (size == 1 && text[at] >= ' ' && text[at] != 0x7F);
        shown += printable ? text.substr(at, size) : "?";
        at += std::max<std::size_t>(size, 1);
    }
    if (at < text.size()) shown += "…";
    return shown + "'";
}

std::string shortest(double value) {
    std::array<char, 32> buffer;
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

}  // namespace oval4d::protocol
