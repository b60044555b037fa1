#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::fields {

/// The side of a level on which the body lies: where the function is below the level, or above it. Stored sessions
/// contain the numbers of the enumerators, so these numbers must not change.
enum class BodySide : std::uint8_t { below = 0, above = 1 };
inline constexpr auto kInsides =
    text::completeTable<text::NamedValue<BodySide>>({{"below", BodySide::below}, {"above", BodySide::above}});
constexpr const auto& choicesOf(BodySide /*type*/) { return kInsides; }

}  // namespace oval4d::fields
