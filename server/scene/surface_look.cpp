#include "scene/surface_look.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oval4d::scene {

Color growthColor(float growth, ColorScheme scheme) {
    return divergingColor(std::atan(growth) * 2 / std::numbers::pi, scheme);
}

Color ValueColorScale::colorOf(double value) const {
    if (std::isnan(value)) return noValueColor();
    const double at = greatest > least ? (value - least) / (greatest - least) : 0.5;
    return diverging ? divergingColor(2 * at - 1, scheme) : sequentialColor(at, scheme);
}

ValueColorScale valueColorScaleFor(const fields::ValueRange& range, ColorScheme scheme) {
    // 0 divides the range of values into two parts. The scale is diverging only if the shorter part is at least this
    // fraction of the longer part.
    constexpr double kLeastSide = 1.0 / 9;
    const auto& [least, greatest] = range;
    const double reach = std::max(-least, greatest);
    if (least < 0 && greatest > 0 && std::min(-least, greatest) >= kLeastSide * reach)
        return {-reach, reach, true, scheme};
    return {least, greatest, false, scheme};
}

Color SurfaceLook::pointColor(const slicing::SliceSurface& surface, std::size_t point) const {
    return pointColoring == PointColoring::growth ? growthColor(surface.growth[point], scheme)
                                                  : scale.colorOf(surface.coloringValues()[point]);
}

Color SurfaceLook::capPointColor(const slicing::SliceSurface& surface, std::size_t point) const {
    return scale.colorOf(surface.coloringValues()[point]);
}

Color surfaceColor(std::size_t i, std::size_t count, const Look& look) {
    const ColorScheme scheme = schemeForBackground(look.background);
    return look.coloring == Coloring::cell ? levelColor(i, count, scheme) : plainColor(scheme);
}

void chooseSurfaceLook(const fields::Field& field, const Look& look, const geometry::Hyperplanes& planes,
                       SurfaceLook& out) {
    constexpr double kOuterOpacity = 0.4;
    const slicing::FieldSettings& settings = look.field;
    const Coloring coloring = look.coloring;
    const std::size_t count = settings.levels.size();
    out.scheme = schemeForBackground(look.background);
    out.levels.resize(count);
    for (std::size_t i = 0; i < count; ++i) out.levels[i] = {i, surfaceColor(i, count, look), kOuterOpacity, false};
    const bool below = settings.inside == fields::BodySide::below;
    std::ranges::sort(out.levels, [&](const SurfaceLook::LevelLook& a, const SurfaceLook::LevelLook& b) {
        const double first = settings.levels[a.index], second = settings.levels[b.index];
        return below ? first < second : first > second;
    });
    if (count > 0) {
        out.levels.front().opacity = 1;
        out.levels.back().caps = look.caps != SurfaceCapStyle::open;
    }
    using PointColoring = SurfaceLook::PointColoring;
    out.pointColoring = coloring == Coloring::growth  ? PointColoring::growth
                        : coloring == Coloring::value ? PointColoring::value
                                                      : PointColoring::none;
    out.capColoring = look.caps == SurfaceCapStyle::value ? PointColoring::value : PointColoring::none;
    if (colorsByValue(look)) out.scale = valueColorScaleFor(field.coloringRange->typicalRange(), out.scheme);
    out.sliceColors.clear();
    if (coloring != Coloring::w) return;
    for (int i = 0; i < planes.count; ++i)
        out.sliceColors.push_back(divergingColor(planes.w(i) / field.circumradius, out.scheme));
}

}  // namespace oval4d::scene
