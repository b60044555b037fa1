#pragma once
// What is exported as text: numbers, coordinates, the polytope itself.

#include <string>

#include "geometry/polytope.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::exports {

/// 4OFF of the polytope as turned, in its own units; read again, it is the same polytope.
std::string off(const geometry::Polytope& polytope, const geometry::SliceSet& slices);

/// One row for each slice: n, w, the numbers of vertices, edges and faces, volume, area, and the centroid; after an
/// empty line the critical w, at which the slices change their form, each with the number of vertices at this level.
std::string csv(const geometry::Polytope& polytope, const geometry::SliceSet& slices);

/// The parallel coordinates of the vertices as turned.
std::string svg(const geometry::Polytope& polytope, const geometry::SliceSet& slices);

}  // namespace oval4d::exports
