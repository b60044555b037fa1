#pragma once
// The meaning of the numbers of a field: the quantity that its values measure, and the units of its coordinates.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// What the values of a function measure, such as {"temperature", "K"}. The name or the unit is empty if it is unknown.
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

/// The units of x, y, z and w; an unknown unit is an empty text.
using AxisUnits = std::array<std::string, 4>;

/// The maximum length in bytes of the names of quantities and of units.
inline constexpr std::size_t kMaxQuantityText = 64;

/// Returns `text` as a valid name of a quantity or a unit: UTF-8 of at most kMaxQuantityText bytes. Replaces control
/// characters and bytes that are not UTF-8 by "?" (see text::printable()), and the end of a text that is too long by
/// "…". Returns an empty string for a text of blanks only.
std::string sanitizeQuantityText(std::string_view text);

/// Returns whether sanitizeQuantityText() leaves `text` as it is.
bool isQuantityText(std::string_view text);

/// Returns the unit of a product of numbers with these units: "m²" for m and m, "m s" for m and s, "(m/s)²" for m/s and
/// m/s. Returns an empty string if a unit is unknown.
std::string unitOfProduct(std::span<const std::string> units);

/// Returns a label such as "temperature, K" for {"temperature", "K"}. If only the name or the unit is known, returns
/// this text; if neither is known, returns an empty string.
std::string labelOf(const Quantity& quantity);

}  // namespace oval4d::fields
