#pragma once
// The volume, area and centroid of a slice.

#include <cstdint>

#include <glm/vec3.hpp>

#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// The measurements of a slice, in the object's units. If the faces of a star polytope wind n times around a region,
/// the volume of the region counts n times in `volume` and `centroid`, as is usual for star polytopes.
struct SliceMeasurements {
    std::size_t faces = 0;     ///< number of faces; all loops cut from one cell count as one face
    double volume = 0;         ///< volume; 0 for a flat slice
    double area = 0;           ///< surface area; of a flat slice, the area of one side
    bool hasCentroid = false;  ///< whether `centroid` is valid; false for an empty slice
    /// The centroid of the volume. If the volume is 0, the centroid of the area. If the area is 0, too, the centroid of
    /// the edges. If the edges have no length, either, the centroid of the points.
    glm::dvec3 centroid{0};
};

/// Returns the measurements of slice i.
SliceMeasurements measureSlice(const slicing::SliceSet& slices, int i);

}  // namespace oval4d::exports
