#pragma once
// Writes the true shape of one element of a 4-D object, such as a cell, as a slice.

#include "geometry/rotation.hpp"
#include "slicing/element.hpp"
#include "slicing/object.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Writes an element to `out` as the only slice: the element's vertices and edges and, for a cell, its 2-faces, whose
/// loops are counterclockwise seen from outside. The element is rotated by `orientation`, and then by the rotation that
/// turns its direction to +w (see rotationToW()). Therefore the element lies in a hyperplane w = const, where it has
/// its true shape and size. The source numbers of the slice's vertices, edges and faces say which elements of the
/// object they are, as for elements that lie in a hyperplane (see SliceSet). Overwrites `out`; `out.rotatedVertices` is
/// empty. Requires element.index < elementCount(object, element.kind).
void writeElementAsSlice(const Object& object, const Element& element, const geometry::Rotation& orientation,
                         SliceSet& out);

}  // namespace oval4d::slicing
