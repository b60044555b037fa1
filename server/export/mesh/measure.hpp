#pragma once
// The volume, area and centroid of a slice.

#include <cstdint>

#include <glm/vec3.hpp>

#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// The measurements of a slice, in the polytope's units. A region that a star covers several times counts as many
/// times, as usual for the content of star polytopes.
struct Measures {
    std::size_t faces = 0;     ///< the number of faces; all loops of one cell count as one face
    double volume = 0;         ///< 0 for a flat slice
    double area = 0;           ///< surface area; for a flat slice, that of both sides
    bool hasCentroid = false;  ///< false for an empty slice
    /// The centroid of the volume. If the volume is zero, that of the area; if both are zero, that of the edges or of
    /// the points.
    glm::dvec3 centroid{0};
};

/// Returns the measurements of slice i.
Measures measure(const slicing::SliceSet& slices, int i);

}  // namespace oval4d::exports
