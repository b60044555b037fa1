#pragma once
// What the numbers of a field mean: what its values measure, and the units of its coordinates.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// What the values of a function measure, such as {"temperature", "K"}. A text is empty if it is unknown.
struct Quantity {
    std::string name, unit;
    bool operator==(const Quantity&) const = default;
    bool isKnown() const { return !name.empty() || !unit.empty(); }
};
void visitStoredMembers(serialization::ReadOrWritten<Quantity> auto& quantity, auto& visit) {
    auto& [name, unit] = quantity;
    visit.member(0, name);
    visit.member(1, unit);
}

/// The units of x, y, z and w; a text is empty if it is unknown.
using AxisUnits = std::array<std::string, 4>;

/// The maximum length in bytes of the names of quantities and of units.
inline constexpr std::size_t kMaxQuantityText = 64;

/// Returns `text` as the name of a quantity or as a unit: valid UTF-8 of at most kMaxQuantityText bytes. Control
/// characters and bytes that are not UTF-8 become "?" (see text::printable()), and "…" replaces the end of a text that
/// is too long. Returns an empty string for a text of blanks only.
std::string quantityText(std::string_view text);

/// Returns whether quantityText() leaves `text` as it is.
bool isQuantityText(std::string_view text);

/// Returns the unit of a product of numbers with these units: "m²" for m and m, "m s" for m and s, "(m/s)²" for m/s and
/// m/s. Returns an empty string if a unit is unknown.
std::string unitOfProduct(std::span<const std::string> units);

/// Returns "temperature, K" for {"temperature", "K"}, the only known text if one of them is unknown, and an empty
/// string if both are unknown.
std::string labelOf(const Quantity& quantity);

}  // namespace oval4d::fields
