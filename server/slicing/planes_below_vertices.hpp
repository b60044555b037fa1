#pragma once
// Says how many of several parallel hyperplanes lie below each vertex of a polytope.

#include <cstdint>
#include <span>

namespace oval4d::slicing {

/// Says where the vertices of a polytope lie relative to parallel hyperplanes, which are numbered by ascending w.
/// below[v] is the number of hyperplanes strictly below vertex v. upTo[v] is the number of hyperplanes below or through
/// v. If upTo[v] > below[v], v lies in the hyperplane with the index below[v]. Does not own the arrays.
struct PlanesBelowVertices {
    std::span<const std::int32_t> below, upTo;
    bool anyOnPlane = false;  ///< whether any vertex lies in a hyperplane

    /// Returns whether the vertex lies in the hyperplane with the index `plane`.
    bool liesIn(std::uint32_t vertex, std::int32_t plane) const {
        return below[vertex] == plane && upTo[vertex] > plane;
    }
};

}  // namespace oval4d::slicing
