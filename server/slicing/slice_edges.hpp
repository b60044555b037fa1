#pragma once
// A limit on the size of slices. The memory and the time that slices take are proportional to the number of their
// edges, and if a polytope has long edges, many of its slices have almost as many edges as the polytope has 2-faces.

#include <cstddef>
#include <stdexcept>

#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// Thrown by checkSliceEdges(). what() is a message for the user.
class TooManySliceEdges : public std::runtime_error {
  public:
    /// `found` and `allowed` are numbers of edges.
    TooManySliceEdges(std::size_t found, std::size_t allowed);
};

/// Returns an upper bound of the number of edges that all slices of the rotated object have together. It is the exact
/// number if no vertex lies in a hyperplane. For a field, these are the slices of the domain; a point cloud has no
/// edges. Takes time linear in the number of elements.
std::size_t sliceEdgeBound(const Object& object, const geometry::Rotation& orientation,
                           const geometry::Hyperplanes& planes);

/// Throws TooManySliceEdges if sliceEdgeBound() is greater than `allowed`. Returns in constant time if the numbers of
/// 2-faces and hyperplanes are so small that more than `allowed` edges are impossible.
void checkSliceEdges(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
                     std::size_t allowed);

}  // namespace oval4d::slicing
