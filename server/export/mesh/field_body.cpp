#include "export/mesh/field_body.hpp"

#include <utility>
#include <vector>

#include "export/mesh/grid_snapping.hpp"

namespace oval4d::exports {

namespace {

// Returns the colors of the points of a surface, as in the picture. Points on the rims of caps belong to the caps and
// to the level set; they get the color of the level set. One pass is enough, because triangles of the level set come
// before triangles of the caps.
std::vector<scene::Color> pointColorsOf(const slicing::SliceSurface& surface, std::size_t level, scene::Color color,
                                        const scene::SurfaceLook& look) {
    std::vector<scene::Color> colors(surface.points.size(), color);
    if (!look.colorsPoints() && !look.colorsCapPoints()) return colors;
    std::vector<bool> onLevelSet(surface.points.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.levelIndex(t) != level) continue;
        for (const std::uint32_t corner : surface.triangles[t]) {
            if (!surface.isCap(t)) {
                onLevelSet[corner] = true;
                if (look.colorsPoints()) colors[corner] = look.pointColor(surface, corner);
            } else if (look.colorsCapPoints() && !onLevelSet[corner]) {
                colors[corner] = look.capPointColor(surface, corner);
            }
        }
    }
    return colors;
}

}  // namespace

Mesh fieldBodyOf(const scene::Scene& scene, const FieldSliceSurface& slice, int i, std::size_t level, double scale,
                 const RoundingGrid& grid, const ExportBudget& budget) {
    const slicing::SliceSurface& surface = slice.surface;
    const scene::SurfaceLook::LevelLook& look = scene.surfaces.levels[level];
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.levelIndex(t) == look.index) triangles.push_back(surface.triangles[t]);
    }
    if (triangles.empty()) return {};
    std::vector<glm::dvec3> points;
    points.reserve(surface.points.size());
    for (std::size_t p = 0; p < surface.points.size(); ++p) points.push_back(slice.point(p) * scale);
    SnappedSurface snapped = snapSurface(points, triangles, grid, budget);
    if (!isThickEnough(snapped.mesh, grid)) return {};
    const auto colors =
        pointColorsOf(surface, look.index, scene.surfaces.color(look, static_cast<std::size_t>(i)), scene.surfaces);
    for (const std::uint32_t source : snapped.source) {
        snapped.mesh.pointColors.push_back(colors[source]);
        snapped.mesh.pointValues.push_back(surface.values[source]);
    }
    return std::move(snapped.mesh);
}

}  // namespace oval4d::exports
