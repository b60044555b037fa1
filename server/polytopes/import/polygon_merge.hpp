#pragma once
// Merges the triangles between two cells into polygons.

#include <span>

#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"
#include "polytopes/import/hull_frame.hpp"
#include "polytopes/import/triangle_edges.hpp"

namespace oval4d::polytopes {

/// Merges triangles into convex polygons, and adds each polygon to `faces` as a loop of indices into `points`.
/// Triangles are merged if they share edges and lie in one plane, within the error bounds of the points. Triangles that
/// do not form a convex polygon are added unmerged.
void addMergedPolygons(std::span<const Triangle> triangles, std::span<const glm::dvec4> points, const HullFrame& frame,
                       geometry::JaggedArray& faces);

}  // namespace oval4d::polytopes
