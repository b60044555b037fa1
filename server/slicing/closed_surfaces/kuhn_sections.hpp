#pragma once
// The subdivision of 4-D lattice cells into simplices, and the sections of these simplices by hyperplanes.
//
// The corners of a lattice cell are numbered 0 … 15: bit a of the number is set if the corner is at the upper end of
// the cell along axis a. A chain is a sequence of five corners, from 0 to 15, in which each corner has all bits of the
// corner before it, and one more bit. The Freudenthal (Kuhn) subdivision has one pentatope (4-simplex) for each chain
// (H. Freudenthal, Annals of Mathematics 43, 1942). All cells are subdivided in the same way, so that neighboring cells
// share whole facets. The corners of every simplex of the lattice can be put in an order in which no coordinate
// decreases.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/gtc/type_precision.hpp>

namespace oval4d::slicing {

/// A pentatope (4-simplex) of the subdivision of a lattice cell.
struct Pentatope {
    /// A chain of corners of the cell, from corner 0 to corner 15, as described at the top of this file.
    std::array<std::uint8_t, 5> corners{};
    bool positive = true;  ///< whether det(c1 − c0, …, c4 − c0) > 0 for the corners c0 … c4, in lattice coordinates

    /// Returns the axis along which the pentatope's corner i + 1 lies above its corner i, for i from 0 to 3.
    int axisToNextCorner(std::size_t i) const;
    /// Returns the corner that the neighboring pentatope across a facet does not share with this pentatope. The facet
    /// is the one opposite to this pentatope's corner i. The result is an offset from corner 0 of the cell, in lattice
    /// steps.
    glm::ivec4 cornerAcrossFacet(std::size_t i) const;
};

/// Returns the 24 pentatopes into which each lattice cell is divided.
const std::array<Pentatope, 24>& kuhnPentatopes();

/// An edge of a pentatope: the indices in Pentatope::corners of its two ends, the smaller index first.
using PentatopeEdge = std::array<std::uint8_t, 2>;

/// A tetrahedron that is part of the section of a pentatope by a hyperplane.
struct SectionTetrahedron {
    static constexpr std::uint8_t kInner = 0xff;

    /// Corner k of the tetrahedron lies on the edge edges[k] of the pentatope.
    std::array<PentatopeEdge, 4> edges{};
    /// Entry k tells where the face opposite to corner k of the tetrahedron lies. It is i if the face lies in the facet
    /// opposite to corner i of the pentatope, and kInner if the face lies in the interior of the section.
    std::array<std::uint8_t, 4> facets{};
};

/// The corners of each face of a tetrahedron with a positive signed volume (see pentatopeSection()). Face k is opposite
/// to corner k, and its corners are counterclockwise as seen from outside.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kTetrahedronFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Returns the section of a pentatope (4-simplex) by a hyperplane, divided into tetrahedra. Bit i of `above` is set if
/// corner i of the pentatope lies in or above the hyperplane. The section is empty, one tetrahedron, or a prism, which
/// is divided into three tetrahedra.
///
/// Each quadrilateral side of the prism is the section of a facet with two corners above the hyperplane and two below
/// it. Each corner of the side lies on an edge that joins an upper to a lower corner of the facet. The side is divided
/// by a diagonal. One end of the diagonal lies on the edge between the first upper and the first lower corner, and its
/// other end on the edge between the last upper and the last lower corner. This rule depends only on the facet.
/// Therefore the two pentatopes that share the facet divide the side in the same way.
///
/// `positive` says whether det(c1 − c0, c2 − c0, c3 − c0, c4 − c0) is positive for the corners c0 … c4 of the
/// pentatope, in coordinates (x, y, z, h). Here, x, y and z are coordinates in the hyperplane, and h is the height
/// above it. For both values of `positive`, each tetrahedron with the corners a0 … a3 has a positive signed volume
/// det(a1 − a0, a2 − a0, a3 − a0) / 6, in coordinates (x, y, z).
std::span<const SectionTetrahedron> pentatopeSection(unsigned above, bool positive);

}  // namespace oval4d::slicing
