#pragma once
// The user's choices of how the object is displayed.

#include <array>
#include <cstdint>
#include <vector>

#include "scene/parts.hpp"
#include "text/choice.hpp"

namespace oval4d::scene {

/// The slices that are shown: all of them on the oval, or only the focus slice.
enum class View : std::uint8_t { oval, single };
inline constexpr auto kViews = std::to_array<text::Choice<View>>({{"oval", View::oval}, {"single", View::single}});

/// The property of a cell that determines its color and that of the faces cut from it.
enum class Coloring : std::uint8_t {
    cell,       ///< the cell itself
    cell_type,  ///< the cell type, which messages call a kind
    w,          ///< the w of the cell's center after the rotation
    plain,      ///< none: all cells have the same color
};
inline constexpr auto kColorings = std::to_array<text::Choice<Coloring>>(
    {{"cell", Coloring::cell}, {"kind", Coloring::cell_type}, {"w", Coloring::w}, {"plain", Coloring::plain}});

/// The cell types that are not fully visible, as indices into ObjectInfo::cellTypes. Each list is sorted; no cell type
/// occurs twice, nor in both lists.
struct CellTypeFilter {
    std::vector<std::uint32_t> hidden, faded;
    bool operator==(const CellTypeFilter&) const = default;
};

/// The viewer's changes to the camera: its rotation about its target in radians, and a factor of magnification. The
/// defaults mean no change.
struct Orbit {
    double azimuth = 0, elevation = 0, zoom = 1;
    bool operator==(const Orbit&) const = default;
};

/// All of the user's choices of how the object is displayed.
struct Look {
    View view = View::oval;
    Parts parts;
    Orbit orbit;
    Coloring coloring = Coloring::cell;
    CellTypeFilter cellTypes = {};
    bool operator==(const Look&) const = default;
};

}  // namespace oval4d::scene
