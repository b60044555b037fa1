#pragma once
// Slices objects by hyperplanes whose values of w are listed, because they are not evenly spaced.

#include "geometry/hyperplanes.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Sets `out`, except its surfaces and fogs, to the slices in the hyperplanes w = planes.listed[i]; `planes.listed`
/// must not be empty. Calls cut(plane, set) for each hyperplane; the function `cut` must write the slice in `plane` to
/// `set`.
template <typename Cut>
void cutEachHyperplane(const geometry::Hyperplanes& planes, SliceSet& out, Cut cut) {
    SliceSet one;
    out.planes = planes;
    out.clearSlices();
    for (const double w : planes.listed) {
        cut(geometry::Hyperplanes{0, 1, planes.spacing, w}, one);
        out.appendSlices(one);
    }
    out.rotatedVertices.swap(one.rotatedVertices);
}

}  // namespace oval4d::slicing
