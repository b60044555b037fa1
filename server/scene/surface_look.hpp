#pragma once
// How the surfaces of a field are drawn.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fields/field.hpp"
#include "geometry/hyperplanes.hpp"
#include "scene/color.hpp"
#include "scene/look.hpp"
#include "slicing/surfaces/slice_surface.hpp"

namespace oval4d::scene {

/// A color scale for values: diverging, with gray in the middle (see divergingColor()), or sequential (see
/// sequentialColor()).
struct ValueScale {
    double least = 0, greatest = 1;  ///< the values at the ends
    bool diverging = false;
    Scheme scheme = Scheme::dark;

    /// Returns the color of a value; for NaN, noValueColor().
    Color color(double value) const;
    bool operator==(const ValueScale&) const = default;
};

/// Returns the scale for values in this range. If 0 lies in the middle four fifths of the range, the scale is
/// diverging, with gray at 0 and ends at equal distances from 0; otherwise it is sequential, from the least to the
/// greatest value.
ValueScale valueScaleFor(const fields::ValueRange& range, Scheme scheme = Scheme::dark);

/// Returns whether the colors of surfaces or caps show values: those of the second function if the field has one, else
/// those of the field's function.
inline bool colorsByValue(const Look& look) { return look.coloring == Coloring::value || look.caps == CapStyle::value; }

/// How the surfaces of a field are drawn.
struct SurfaceLook {
    /// The property that determines the color of each point. With `none`, all points have the color of their level or,
    /// if SurfaceLook::sliceColors is not empty, of their slice.
    enum class PointColoring : std::uint8_t { none, growth, value };

    /// The surface of one level.
    struct LevelLook {
        std::size_t index = 0;  ///< the index in FieldSettings::levels, which SliceSurface::levelIndex() also returns
        Color color = 0;
        double opacity = 1;  ///< 0 … 1
        bool caps = false;   ///< whether its caps are drawn
    };
    std::vector<LevelLook> levels;   ///< from the innermost to the outermost; empty if no surfaces are shown
    std::vector<Color> sliceColors;  ///< with Coloring::w: per slice, a color that replaces those of the levels; else
                                     ///< empty
    PointColoring pointColoring = PointColoring::none;  ///< for the points of level sets
    PointColoring capColoring = PointColoring::none;    ///< for the points of caps: none or value
    ValueScale scale;              ///< valid if one of the two members above is PointColoring::value
    Scheme scheme = Scheme::dark;  ///< of all colors

    /// Removes all levels, so that no surfaces are shown.
    void clear() {
        levels.clear();
        sliceColors.clear();
        pointColoring = capColoring = PointColoring::none;
    }
    bool empty() const { return levels.empty(); }
    Color color(const LevelLook& level, std::size_t slice) const {
        return sliceColors.empty() ? level.color : sliceColors[slice];
    }
    /// Returns the color of the contours of a level in the matrix, where w varies in most planes, so that `sliceColors`
    /// do not apply. `index`: LevelLook::index of one of `levels`.
    Color contourColor(std::size_t index) const { return std::ranges::find(levels, index, &LevelLook::index)->color; }
    bool colorsPoints() const { return pointColoring != PointColoring::none; }
    bool colorsCapPoints() const { return capColoring != PointColoring::none; }
    /// Returns the color of a point of a level set. Requires colorsPoints().
    Color pointColor(const slicing::SliceSurface& surface, std::size_t point) const;
    /// Returns the color of a point of a cap. Requires colorsCapPoints().
    Color capPointColor(const slicing::SliceSurface& surface, std::size_t point) const;
};

/// Returns the color of a point where the surface moves outward at the speed `growth` as w increases (see
/// SliceSurface::growth): amber where the body grows, blue where it shrinks, gray where it does not change.
Color growthColor(float growth, Scheme scheme = Scheme::dark);

/// Returns the color of level i of `count` levels on the background of `look`: levelColor() with Coloring::cell, else
/// plainColor(). Ignores colors that depend on the slice or the point.
Color surfaceColor(std::size_t i, std::size_t count, const Look& look);

/// Chooses how the surfaces of a field are drawn in the slices by `planes`. The innermost level is opaque; the other
/// levels are translucent, so that inner levels are visible through them. Only the outermost level has caps, because
/// these cover the caps of the other levels; with CapStyle::open, no level has caps. Overwrites `out`.
void chooseSurfaceLook(const fields::Field& field, const Look& look, const geometry::Hyperplanes& planes,
                       SurfaceLook& out);

}  // namespace oval4d::scene
