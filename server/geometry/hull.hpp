#pragma once
// The convex hull of points.

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

struct Hull {
    std::vector<glm::dvec4> vertices;
    Lists faces, cells;  ///< as makePolytope takes them
};

/// The hull, by Qhull. Simplices whose hyperplanes agree within `rounding`, a length, are one cell. Throws an
/// ImportError if the points do not span four dimensions, or if the hull has more than `maxCells` cells.
Hull convexHull(std::span<const glm::dvec4> points, double rounding, std::size_t maxCells);

}  // namespace oval4d::geometry
