#include "export/drawing/ascii_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace oval4d::exports {

namespace {

using AsciiReplacement = std::pair<std::string_view, std::string_view>;

constexpr auto kSigns = std::to_array<AsciiReplacement>({
    {"\u00B5", "u"},  // micro sign
    {"\u03BC", "u"},  // Greek letter mu
    {"\u00B0", "deg"},
    {"\u00C5", "A"},  // letter A with ring (ångström)
    {"\u212B", "A"},
    {"\u03A9", "Ohm"},  // Greek letter omega
    {"\u2126", "Ohm"},
    {"\u2030", "permil"},
    {"\u00B7", "*"},
    {"\u22C5", "*"},
    {"\u00D7", "*"},
    {"\u2212", "-"},
    {"\u2026", "..."},
});
constexpr auto kSuperscripts = std::to_array<AsciiReplacement>({
    {"\u2070", "0"},
    {"\u00B9", "1"},
    {"\u00B2", "2"},
    {"\u00B3", "3"},
    {"\u2074", "4"},
    {"\u2075", "5"},
    {"\u2076", "6"},
    {"\u2077", "7"},
    {"\u2078", "8"},
    {"\u2079", "9"},
    {"\u207B", "-"},
});

// Returns the replacement for the character at the start of `text`; null if the table has none.
template <typename Table>
const AsciiReplacement* replacementIn(const Table& table, std::string_view text) {
    const auto found =
        std::ranges::find_if(table, [&](const AsciiReplacement& each) { return text.starts_with(each.first); });
    return found == table.end() ? nullptr : &*found;
}

}  // namespace

std::string asciiText(std::string_view text) {
    std::string ascii;
    bool isRaised = false;  // whether the previous character was a superscript
    while (!text.empty()) {
        const AsciiReplacement* const raised = replacementIn(kSuperscripts, text);
        const AsciiReplacement* const found = raised != nullptr ? raised : replacementIn(kSigns, text);
        if (raised != nullptr && !isRaised) ascii += '^';
        isRaised = raised != nullptr;
        const auto isAscii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
        if (found != nullptr) {
            ascii += found->second;
            text.remove_prefix(found->first.size());
        } else if (isAscii(text.front())) {
            ascii += text.front();
            text.remove_prefix(1);
        } else {
            ascii += '?';
            const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; };
            text.remove_prefix(1);
            while (!text.empty() && continues(text.front())) text.remove_prefix(1);
        }
    }
    return ascii;
}

}  // namespace oval4d::exports
