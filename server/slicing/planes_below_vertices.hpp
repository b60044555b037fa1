#pragma once
// The positions of vertices among parallel hyperplanes.

#include <cstdint>
#include <span>

namespace oval4d::slicing {

/// The positions of a polytope's vertices relative to parallel hyperplanes, which are numbered by ascending w. below[v]
/// is the number of hyperplanes strictly below vertex v, and upTo[v] the number of hyperplanes below or through v. If
/// upTo[v] > below[v], v lies in the hyperplane with the index below[v]. Does not own the arrays.
struct PlanesBelowVertices {
    std::span<const std::int32_t> below, upTo;
    bool anyOnPlane = false;  ///< whether any vertex lies in a hyperplane

    /// Returns whether the vertex lies in the hyperplane with the index `plane`.
    bool liesIn(std::uint32_t vertex, std::int32_t plane) const {
        return below[vertex] == plane && upTo[vertex] > plane;
    }
};

}  // namespace oval4d::slicing
