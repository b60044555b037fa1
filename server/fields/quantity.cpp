#include "fields/quantity.hpp"

#include "text/message_text.hpp"

namespace oval4d::fields {

std::string quantityText(std::string_view text) {
    if (text.find_first_not_of(' ') == std::string_view::npos) return {};
    if (text.size() <= kMaxQuantityText) return text::printable(text, kMaxQuantityText);
    // printable() keeps the characters that begin within a number of bytes. The last of them may have four bytes, and
    // the ellipsis has three.
    constexpr std::size_t kBegins = kMaxQuantityText - 3 - 3;
    return text::printable(text, kBegins);
}

bool isQuantityText(std::string_view text) { return quantityText(text) == text; }

std::string labelOf(const Quantity& quantity) {
    const auto& [name, unit] = quantity;
    return name + (name.empty() || unit.empty() ? "" : ", ") + unit;
}

}  // namespace oval4d::fields
