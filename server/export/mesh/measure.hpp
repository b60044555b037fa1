#pragma once
// The volume, area and centroid of a slice.

#include <cstdint>

#include <glm/vec3.hpp>

#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Measurements in the polytope's units. Regions that a star covers several times count several times, as usual for the
/// content of star polytopes.
struct Measures {
    std::size_t faces = 0;  ///< all loops of one cell count as one face
    double volume = 0;
    double area = 0;           ///< surface area; for a flat slice, that of both sides
    bool hasCentroid = false;  ///< false for an empty slice
    /// The centroid of the volume, or else, if that is zero, of the area, the edges or the points.
    glm::dvec3 centroid{0};
};

/// Measures slice i.
Measures measure(const slicing::SliceSet& slices, int i);

}  // namespace oval4d::exports
