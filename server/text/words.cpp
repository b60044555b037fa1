#include "text/words.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace oval4d::text {

namespace {

bool isSeparator(char c) { return c == '-' || c == '_' || std::isspace(static_cast<unsigned char>(c)) != 0; }

char toLower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

}  // namespace

std::vector<std::string_view> splitAtCommas(std::string_view text) {
    std::vector<std::string_view> parts;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        parts.push_back(text.substr(0, comma));
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return parts;
}

std::vector<std::string> lowerCaseWords(std::string_view text) {
    std::vector<std::string> words;
    bool apart = true;
    for (const char c : text) {
        if (!isSeparator(c)) {
            if (apart) words.emplace_back();
            words.back() += toLower(c);
        }
        apart = isSeparator(c);
    }
    return words;
}

std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end) {
    std::string text;
    for (std::size_t i = first; i < end; ++i) text += (text.empty() ? "" : " ") + words[i];
    return text;
}

std::string normalizedName(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (!isSeparator(c)) result += toLower(c);
    }
    return result;
}

std::size_t leadingUnicodeSpaceLength(std::string_view text) {
    using namespace std::string_view_literals;
    constexpr auto kSpaces = std::to_array({"\xC2\xA0"sv, "\xE2\x80\xAF"sv, "\xE2\x81\x9F"sv, "\xE3\x80\x80"sv});
    for (const std::string_view space : kSpaces) {
        if (text.starts_with(space)) return space.size();
    }
    // The UTF-8 encodings of U+2000 (en quad) to U+200A (hair space) begin with these two bytes.
    constexpr std::string_view kQuads = "\xE2\x80";
    if (!text.starts_with(kQuads) || text.size() == kQuads.size()) return 0;
    const auto last = static_cast<unsigned char>(text[kQuads.size()]);
    return last >= 0x80U && last <= 0x8AU ? kQuads.size() + 1 : 0;
}

std::string withPlainBlanks(std::string_view text) {
    std::string plain;
    plain.reserve(text.size());
    while (!text.empty()) {
        const std::size_t space = leadingUnicodeSpaceLength(text);
        plain += space > 0 ? ' ' : text[0];
        text.remove_prefix(std::max<std::size_t>(space, 1));
    }
    return plain;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

}  // namespace oval4d::text
