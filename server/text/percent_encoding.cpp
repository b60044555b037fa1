#include "text/percent_encoding.hpp"

#include <charconv>

#include "text/ascii.hpp"

namespace oval4d::text {

std::optional<std::string> percentDecoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const std::string_view digits = text.substr(i + 1, 2);
        unsigned char byte = 0;
        const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
        if (fault != std::errc{} || end != digits.data() + 2) return {};
        out += static_cast<char>(byte);
        i += 2;
    }
    return out;
}

std::string percentEncoded(std::string_view text, std::string_view plain) {
    constexpr std::string_view kDigits = "0123456789ABCDEF", kMarks = "-._~";
    std::string out;
    out.reserve(text.size());
    for (const char c : text) {
        const bool isMark = kMarks.find(c) != kMarks.npos || plain.find(c) != plain.npos;
        if (isLetter(c) || isDigit(c) || isMark) {
            out += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            out += {'%', kDigits[byte / 16], kDigits[byte % 16]};
        }
    }
    return out;
}

}  // namespace oval4d::text
