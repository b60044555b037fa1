#pragma once
// Chooses how the surfaces of a field are drawn: their colors and opacities.

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

/// A color scale for values. The scale is either diverging, with gray in the middle (see divergingColor()), or
/// sequential (see sequentialColor()).
struct ValueColorScale {
    double least = 0, greatest = 1;  ///< the values at the two ends of the scale
    bool diverging = false;
    ColorScheme scheme = ColorScheme::dark;

    /// Returns the color of a value. For NaN, returns noValueColor().
    Color colorOf(double value) const;
    bool operator==(const ValueColorScale&) const = default;
};

/// Returns the color scale for values in `range`. If 0 lies in the middle four fifths of the range, the scale is
/// diverging, with gray at 0 and ends at equal distances from 0. Otherwise the scale is sequential, from the least to
/// the greatest value.
ValueColorScale valueColorScaleFor(const fields::ValueRange& range, ColorScheme scheme = ColorScheme::dark);

/// Returns whether the colors of surfaces or caps show values. The values are those of the field's second function or,
/// if there is none, of its function.
inline bool colorsByValue(const Look& look) {
    return look.coloring == Coloring::value || look.caps == SurfaceCapStyle::value;
}

/// How the surfaces of a field are drawn: which levels are shown, in which colors and with which opacities.
struct SurfaceLook {
    /// The property that determines the color of each point of a surface. With `none`, all points have the color of
    /// their level or, if SurfaceLook::sliceColors is not empty, the color of their slice.
    enum class PointColoring : std::uint8_t { none, growth, value };

    /// How the surface of one level is drawn.
    struct LevelLook {
        std::size_t index = 0;  ///< the index of the level in FieldSettings::levels
        Color color = 0;
        double opacity = 1;  ///< the opacity of the surface, 0 … 1
        bool caps = false;   ///< whether the caps of the surface are drawn
    };
    /// The shown levels, from the innermost to the outermost; empty if no surfaces are shown.
    std::vector<LevelLook> levels;
    /// With Coloring::w: per slice, a color that replaces the colors of the levels; otherwise empty.
    std::vector<Color> sliceColors;
    PointColoring pointColoring = PointColoring::none;  ///< the coloring of the points of level sets
    PointColoring capColoring = PointColoring::none;    ///< the coloring of the points of caps: none or value
    ValueColorScale scale;                   ///< valid if pointColoring or capColoring is PointColoring::value
    ColorScheme scheme = ColorScheme::dark;  ///< the color scheme: for a dark or a light background

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
    /// Returns the color of the contours of a level in the matrix of planar sections. `index` is LevelLook::index of
    /// one of `levels`. In half of these planes, w varies, so `sliceColors` are not used.
    Color contourColor(std::size_t index) const { return std::ranges::find(levels, index, &LevelLook::index)->color; }
    bool colorsPoints() const { return pointColoring != PointColoring::none; }
    bool colorsCapPoints() const { return capColoring != PointColoring::none; }
    /// Returns the color of a point of a level set. Requires colorsPoints().
    Color pointColor(const slicing::SliceSurface& surface, std::size_t point) const;
    /// Returns the color of a point of a cap. Requires colorsCapPoints().
    Color capPointColor(const slicing::SliceSurface& surface, std::size_t point) const;
};

/// Returns the color of a point of a surface for Coloring::growth. `growth` is the speed at which the surface moves
/// outward there while w increases (see SliceSurface::growth). The color is amber where the body grows, blue where it
/// shrinks, and gray where it does not change.
Color growthColor(float growth, ColorScheme scheme = ColorScheme::dark);

/// Returns the color of level i of `count` levels on the background of `look`: levelColor() with Coloring::cell,
/// otherwise plainColor(). Ignores colors that depend on the slice or the point.
Color surfaceColor(std::size_t i, std::size_t count, const Look& look);

/// Chooses how the surfaces of `field` are drawn in the slices by `planes`, and writes the result to `out`. The
/// innermost level is opaque. The other levels are translucent, so that inner levels are visible through them. Only the
/// outermost level has caps, because its caps cover those of the other levels; with SurfaceCapStyle::open, no level has
/// caps. Overwrites `out`.
void chooseSurfaceLook(const fields::Field& field, const Look& look, const geometry::Hyperplanes& planes,
                       SurfaceLook& out);

}  // namespace oval4d::scene
