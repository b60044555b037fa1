#pragma once
// Skeletons: the balls and bars of a slice, merged into one body.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The radii of balls and bars in millimeters.
struct SkeletonRadii {
    double ball = 0, bar = 0;
};

/// Returns the radii, in millimeters, for which balls and bars have the proportions of the picture. `scale` is in
/// millimeters per unit of the polytope.
SkeletonRadii skeletonRadii(const scene::Scene& scene, double scale);

/// Returns an estimate of the number of triangles in the skeletons of all slices, if skeletonOf() uses cubes as wide as
/// the radius of a bar. Cubes half as wide give four times as many triangles. `scale` is in millimeters per unit of the
/// polytope.
double estimateSkeletonTriangles(const slicing::SliceSet& slices, double scale, const SkeletonRadii& radii);

/// Returns the skeleton of slice i, meshed by marching tetrahedra. The cubes are `cube` millimeters wide. `scale` is in
/// millimeters per unit of the polytope. Throws ExportRefused if `budget` is exceeded.
Mesh skeletonOf(const slicing::SliceSet& slices, int i, double scale, const SkeletonRadii& radii, double cube,
                const RoundingGrid& grid, const ExportBudget& budget);

}  // namespace oval4d::exports
