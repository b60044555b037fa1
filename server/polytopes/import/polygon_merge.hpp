#pragma once
// Merges the triangles between two cells into polygons.

#include <span>

#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"
#include "polytopes/import/hull_frame.hpp"
#include "polytopes/import/triangle_edges.hpp"

namespace oval4d::polytopes {

/// Merges triangles that share edges and lie in one plane, within the error bounds of the points, into convex polygons,
/// and adds the polygons to `faces`, as loops of indices of points. Where the triangles do not form a convex polygon,
/// adds them unmerged.
void addMergedPolygons(std::span<const Triangle> triangles, std::span<const glm::dvec4> points, const HullFrame& frame,
                       geometry::JaggedArray& faces);

}  // namespace oval4d::polytopes
