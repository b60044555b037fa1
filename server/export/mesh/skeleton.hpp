#pragma once
// The balls and bars of a slice, merged into one body.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The radii of balls and bars in millimeters.
struct SkeletonRadii {
    double ball = 0, bar = 0;
};

/// Returns the radii that balls and bars have in the picture, in millimeters. `scale` is in millimeters per unit of the
/// polytope.
SkeletonRadii skeletonRadii(const scene::Scene& scene, double scale);

/// Returns the estimated total number of triangles of all slices if skeletonOf() meshes them with cubes as wide as the
/// radius of a bar. Cubes half as wide give four times as many. `scale` is in millimeters per unit of the polytope.
double estimateTriangles(const slicing::SliceSet& slices, double scale, const SkeletonRadii& radii);

/// Returns the skeleton of slice i, meshed by marching tetrahedra in cubes that are `cube` millimeters wide. `scale` is
/// in millimeters per unit of the polytope.
Mesh skeletonOf(const slicing::SliceSet& slices, int i, double scale, const SkeletonRadii& radii, double cube,
                const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
