#pragma once
// The balls and bars of a slice, grown together to one body.

#include "export/budget.hpp"
#include "export/mesh.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::exports {

/// In millimetres.
struct Thickness {
    double ball = 0, bar = 0;  ///< radii
};

/// As thick as the pictures show them.
Thickness thicknessFor(const geometry::Polytope& polytope, double scale);

/// About how many triangles the frames of all slices have if the cubes that they are meshed in are a bar's radius wide;
/// at half the width they have four times as many.
double coarseTriangles(const geometry::SliceSet& slices, double scale, const Thickness& thickness);

/// The frame of slice i, `scale` millimetres to the polytope's unit, meshed in cubes of this width.
Mesh frameOf(const geometry::SliceSet& slices, int i, double scale, const Thickness& thickness, double cube,
             const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
