#include "fields/quantity.hpp"

#include <algorithm>
#include <array>

#include "text/ascii.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

std::string sanitizeQuantityText(std::string_view text) {
    if (text.find_first_not_of(' ') == std::string_view::npos) return {};
    if (text.size() <= kMaxQuantityText) return text::printable(text, kMaxQuantityText);
    // printable() keeps the characters that begin within the first kBegins bytes, and may append an ellipsis. The last
    // character may extend three bytes beyond kBegins, and the ellipsis has three bytes.
    constexpr std::size_t kBegins = kMaxQuantityText - 3 - 3;
    return text::printable(text, kBegins);
}

bool isQuantityText(std::string_view text) { return sanitizeQuantityText(text) == text; }

std::string unitOfProduct(std::span<const std::string> units) {
    static constexpr std::array<std::string_view, 5> kPowers{"", "", "²", "³", "⁴"};
    std::string product;
    for (std::size_t i = 0; i < units.size(); ++i) {
        const std::string& unit = units[i];
        if (unit.empty()) return {};
        if (std::ranges::find(units.first(i), unit) != units.begin() + static_cast<std::ptrdiff_t>(i)) continue;
        const auto power = static_cast<std::size_t>(std::ranges::count(units, unit));
        const bool isPlain = power == 1 || std::ranges::all_of(unit, text::isLetter);
        product += product.empty() ? "" : " ";
        product += isPlain ? unit : '(' + unit + ')';
        product += power < kPowers.size() ? std::string(kPowers.at(power)) : '^' + std::to_string(power);
    }
    return product;
}

std::string labelOf(const Quantity& quantity) {
    const auto& [name, unit] = quantity;
    return name + (name.empty() || unit.empty() ? "" : ", ") + unit;
}

}  // namespace oval4d::fields
