#pragma once
// Volume, area and centre of a slice.

#include <cstdint>

#include <glm/vec3.hpp>

#include "geometry/slice_set.hpp"

namespace oval4d::exports {

/// In the polytope's units. Where a star covers a place more than once, it counts as often, as is usual for the
/// content of star polytopes.
struct Measures {
    std::size_t faces = 0;  ///< all loops of one cell are one face
    double volume = 0;
    double area = 0;  ///< of the surface; of a flat slice, of both its sides
    bool hasCentroid = false;
    glm::dvec3 centroid{
        0};  ///< of the volume; where there is none, of the area, the edges or the points that there are
};

/// Measures slice i.
Measures measure(const geometry::SliceSet& slices, int i);

}  // namespace oval4d::exports
