#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::exports {

/// What to export: only the focus slice; all slices; the parallel coordinates or, for a field, the histogram; the
/// projection of the whole object; or the matrix of planar sections. Figures (SVG, PDF) contain one of the last three,
/// other formats neither `coordinates` nor `matrix`.
enum class Extent : std::uint8_t { focus, oval, coordinates, projection, matrix };

inline constexpr auto kExtents = std::to_array<text::Choice<Extent>>({{"focus", Extent::focus},
                                                                      {"oval", Extent::oval},
                                                                      {"coordinates", Extent::coordinates},
                                                                      {"projection", Extent::projection},
                                                                      {"matrix", Extent::matrix}});

}  // namespace oval4d::exports
