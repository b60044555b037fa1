#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::fields {

/// Which side of a level belongs to the body that the level bounds: where the function is below or above the level.
/// Stored sessions contain the numbers of the enumerators, so these numbers must not change.
enum class Inside : std::uint8_t { below = 0, above = 1 };
inline constexpr auto kInsides =
    text::completeTable<text::NamedValue<Inside>>({{"below", Inside::below}, {"above", Inside::above}});
constexpr const auto& choicesOf(Inside /*type*/) { return kInsides; }

}  // namespace oval4d::fields
