#pragma once
// Slicing by hyperplanes that are not evenly spaced.

#include "geometry/hyperplanes.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Sets `out` to the slices in the hyperplanes `planes.listed`, which must not be empty, except for surfaces and fogs.
/// Calls `cut` with each hyperplane and with a set in which it must write the slice.
template <typename Cut>
void cutEach(const geometry::Hyperplanes& planes, SliceSet& out, Cut cut) {
    SliceSet one;
    out.planes = planes;
    out.clearElements();
    for (const double w : planes.listed) {
        cut(geometry::Hyperplanes{0, 1, planes.spacing, w}, one);
        out.append(one);
    }
    out.rotatedVertices.swap(one.rotatedVertices);
}

}  // namespace oval4d::slicing
