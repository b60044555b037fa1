#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::exports {

/// What to export. protocol/export_formats.json says which of these the files of a format can contain.
enum class Extent : std::uint8_t {
    focus,        ///< only the focus slice
    oval,         ///< all slices
    critical,     ///< the critical w of a polytope: those at which there are vertices
    object,       ///< the whole rotated object, in four dimensions
    coordinates,  ///< the parallel coordinates or, for a field, the histogram
    projection,   ///< the projection of the whole object
    matrix        ///< the matrix of planar sections
};

inline constexpr auto kExtents = std::to_array<text::Choice<Extent>>({{"focus", Extent::focus},
                                                                      {"oval", Extent::oval},
                                                                      {"critical", Extent::critical},
                                                                      {"object", Extent::object},
                                                                      {"coordinates", Extent::coordinates},
                                                                      {"projection", Extent::projection},
                                                                      {"matrix", Extent::matrix}});

}  // namespace oval4d::exports
