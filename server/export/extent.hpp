#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::exports {

/// What to export: only the focus slice, all slices, the projection of the whole object, or the matrix of planar
/// sections. Only the figure formats (SVG, PDF) accept `matrix`. For `focus` and `oval`, a figure shows the parallel
/// coordinates or, for a field, the histogram.
enum class Extent : std::uint8_t { focus, oval, projection, matrix };

inline constexpr auto kExtents = std::to_array<text::Choice<Extent>>(
    {{"focus", Extent::focus}, {"oval", Extent::oval}, {"projection", Extent::projection}, {"matrix", Extent::matrix}});

}  // namespace oval4d::exports
