#pragma once
// Limits the number of edges of slices. The memory and the time that slices take are proportional to this number. If a
// polytope has long edges, many of its slices have almost as many edges as the polytope has 2-faces.

#include <cstddef>
#include <stdexcept>

#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// An error that checkSliceEdges() throws: the slices have too many edges. what() is a message for the user.
class TooManySliceEdges : public std::runtime_error {
  public:
    /// `found` is the number of edges that the slices may have (see sliceEdgeBound()), and `allowed` the maximum
    /// number.
    TooManySliceEdges(std::size_t found, std::size_t allowed);
};

/// Returns an upper bound of the number of edges that all slices of `object`, rotated by `orientation`, have together.
/// The bound is exact if no vertex lies in a hyperplane. For a field, the slices are those of its domain; for a point
/// cloud, the bound is 0. Takes time linear in the number of elements.
std::size_t sliceEdgeBound(const Object& object, const geometry::Rotation& orientation,
                           const geometry::Hyperplanes& planes);

/// Throws TooManySliceEdges if sliceEdgeBound() is greater than `allowed`. Takes constant time if the numbers of
/// 2-faces and hyperplanes are so small that more than `allowed` edges are impossible.
void checkSliceEdges(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
                     std::size_t allowed);

}  // namespace oval4d::slicing
