#include "text/message_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "text/decimal.hpp"

namespace oval4d::text {

namespace {

// Returns the Levenshtein distance of two texts. The running time is proportional to the product of their lengths, so
// both must be short.
std::size_t editDistance(std::string_view a, std::string_view b) {
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

constexpr std::size_t kMaxQuotedBytes = 60;

// Returns the length, in bytes, of the UTF-8 character that begins at byte `at` of `text`; 0 if no character begins
// there. The limits on the second byte exclude overlong forms, surrogates, and code points above U+10FFFF (RFC 3629,
// section 4).
std::size_t characterAt(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
    const unsigned char lead = byte(0);
    const std::size_t size = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
    if (size == 0 || at + size > text.size()) return 0;
    const unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned most = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    if (size > 1 && (byte(1) < least || byte(1) > most)) return 0;
    for (std::size_t i = 2; i < size; ++i) {
        if ((byte(i) & 0xC0U) != 0x80) return 0;
    }
    return size;
}

}  // namespace

std::string_view closestMatch(std::string_view text, std::span<const std::string_view> candidates) {
    text = text.substr(0, kMaxQuotedBytes);
    std::string_view best;
    std::size_t least = 2 * kMaxQuotedBytes;
    for (const std::string_view candidate : candidates) {
        // Skip a candidate that is too long to be closer than `best`, because the distance is at least the difference
        // of the lengths. This saves time if a file has thousands of long names.
        if (candidate.size() > text.size() + least / 2) continue;
        // Among candidates at the same distance, prefer candidates of the same length: "25-cell" more likely means
        // 24-cell than 5-cell.
        const std::size_t d = 2 * editDistance(text, candidate) + (candidate.size() == text.size() ? 0 : 1);
        if (d < least && d <= candidate.size() + 1) {
            least = d;
            best = candidate;
        }
    }
    return best;
}

std::string didYouMean(std::string_view text, std::span<const std::string_view> candidates) {
    const std::string_view name = closestMatch(text, candidates);
    return name.empty() ? std::string{} : " (did you mean '" + std::string(name) + "'?)";
}

std::string commaSeparated(std::span<const std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) {
        if (!list.empty()) list += ", ";
        list += name;
    }
    return list;
}

std::string joinedWithOr(std::span<const std::string_view> names) {
    if (names.size() < 2) return commaSeparated(names);
    return commaSeparated(names.first(names.size() - 1)) + " or " + std::string(names.back());
}

bool isUtf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t size = characterAt(text, at);
        if (size == 0) return false;
        at += size;
    }
    return true;
}

std::string inQuotes(std::string_view text) { return "'" + printable(text, kMaxQuotedBytes) + "'"; }

std::string printable(std::string_view text, std::size_t maxBytes) {
    std::string shown;
    std::size_t at = 0;
    while (at < text.size() && at < maxBytes) {
        const std::size_t size = characterAt(text, at);
        const bool printable = size > 1 || (size == 1 && text[at] >= ' ' && text[at] != 0x7F);
        shown += printable ? text.substr(at, size) : "?";
        at += std::max<std::size_t>(size, 1);
    }
    if (at < text.size()) shown += "…";
    return shown;
}

std::string shortestDecimal(double value) {
    if (isExactInteger(value)) return std::to_string(static_cast<std::int64_t>(value));
    std::array<char, 32> buffer;
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

std::string roundedDecimal(double value) {
    constexpr int kDigits = 6;
    const double size = std::abs(value);
    std::string text;
    if (isExactInteger(size)) {
        text = std::to_string(static_cast<std::int64_t>(size));
    } else {
        const bool isFixed = size >= 1e-5 && size < 1e15;
        const int decimals =
            isFixed ? std::max(0, kDigits - 1 - static_cast<int>(std::floor(std::log10(size)))) : kDigits - 1;
        std::array<char, 64> buffer;
        const auto format = isFixed ? std::chars_format::fixed : std::chars_format::scientific;
        const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), size, format, decimals);
        text.assign(buffer.data(), result.ptr);
        if (text.find('.') != std::string::npos) {
            const std::size_t end = std::min(text.find('e'), text.size());
            std::size_t kept = text.find_last_not_of('0', end - 1) + 1;
            if (text[kept - 1] == '.') --kept;
            text.erase(kept, end - kept);
        }
    }
    return value < 0 ? "\u2212" + text : text;
}

std::string outsideBoundsText(double least, double most, std::string_view unit, double value) {
    const std::string rounded = roundedDecimal(value);
    const bool isClose = rounded == roundedDecimal(least) || rounded == roundedDecimal(most);
    const auto plain = [&](double number) {
        if (!isClose) return roundedDecimal(number);
        return (number < 0 ? "\u2212" : "") + shortestDecimal(std::abs(number));
    };
    return "from " + plain(least) + " to " + plain(most) + std::string(unit) + ", not " + plain(value);
}

}  // namespace oval4d::text
