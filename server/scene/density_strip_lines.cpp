#include "scene/density_strip_lines.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/vec4.hpp>

namespace oval4d::scene {

namespace {

// Finds the vertex line that is nearest to a point. keepIfNearer() must get the lines in ascending order of their
// vertices.
class NearestLineFinder {
  public:
    void keepIfNearer(std::size_t vertex, double distance) {
        if (distance >= distance_ - kEqual) return;
        vertex_ = vertex;
        distance_ = distance;
    }

    // Returns the vertex of the nearest line. Returns an empty optional if the distance of this line is greater than
    // `reach`.
    std::optional<std::size_t> vertexWithin(double reach) const {
        return distance_ <= reach ? std::optional(vertex_) : std::nullopt;
    }

  private:
    // Distances that differ by less than this, in viewport heights, count as equal. Messages contain rounded
    // coordinates, which change the distances by less than this. So the page in the browser, which has the rounded
    // coordinates, finds the same line.
    static constexpr double kEqual = 1e-6;
    std::size_t vertex_ = 0;
    double distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<std::size_t> vertexInDensityStripAt(const Scene& scene, glm::dvec2 at) {
    const ParallelCoordinatesLayout& layout = scene.coordinates;
    // How far the point is to the right of the middle of axis x, in viewport heights.
    const double right = at.x - (layout.left + layout.lineWidth / 2);
    if (layout.lineStep <= 0 || right < -kLineReach || right > 3 * layout.lineStep + kLineReach) return std::nullopt;
    const double along = std::clamp(right / layout.lineStep, 0.0, 3.0);
    const int axis = std::min(static_cast<int>(along), 2);
    const double unit = layout.amplitude / scene.circumradius;
    const std::vector<glm::dvec4>& vertices = scene.slices->rotatedVertices;
    const auto distanceOf = [&](std::size_t v) {
        const double value = std::lerp(vertices[v][axis], vertices[v][axis + 1], along - axis);
        return std::abs(layout.zero + value * unit - at.y);
    };
    NearestLineFinder drawn;
    forEachLineOverDensityStrip(scene.highlight.ownVertices,
                                [&](std::uint32_t v) { drawn.keepIfNearer(v, distanceOf(v)); });
    if (const auto vertex = drawn.vertexWithin(layout.lineWidth)) return vertex;
    NearestLineFinder nearest;
    for (std::size_t v = 0; v < vertices.size(); ++v) nearest.keepIfNearer(v, distanceOf(v));
    return nearest.vertexWithin(kLineReach);
}

}  // namespace oval4d::scene
