#pragma once
// A 4-D polytope with all its elements and their incidences.

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"
#include "geometry/jagged_array.hpp"
#include "geometry/reference_frame.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::polytopes {

using geometry::CellType;

/// A 4-D polytope: a cell complex that is the boundary of one or more bodies. makePolytope() builds it. Threads and
/// sessions share a polytope by pointers to const. The center of a polytope that is built from a name is the
/// origin.
struct Polytope : geometry::CellComplex {
    /// The 2-faces around each edge, in cyclic order. The entry for 2-face f is 2 f + 1 if its vertex loop
    /// traverses the edge from the edge's first vertex to its second, else 2 f. Between an entry s and the next
    /// entry of its cycle lies the cell faceCells[s / 2][1 − s mod 2]; the first entry follows the last one. If
    /// several bodies meet in an edge, the edge has several cycles, which are stored one after another.
    geometry::JaggedArray edgeFaces;

    std::size_t cellCount() const { return cells.size(); }
};
static_assert(serialization::HasOwnMembers<Polytope, geometry::CellComplex, 1>,
              "visitStoredMembers() considers each member");
void visitStoredMembers(serialization::ReadOrWritten<Polytope> auto& polytope, auto& visit) {
    visit.member(0, serialization::asBase<geometry::CellComplex>(polytope));
    visit.recomputableMember(polytope.edgeFaces);
}

/// Returns the largest distance of a vertex from the mean of the vertices. Unlike the circumradius, this distance does
/// not depend on the position of the polytope.
double maxDistanceFromMean(const Polytope& polytope);

/// Thrown by makePolytope() for elements that do not form a valid polytope. Says which element is invalid.
class InvalidPolytope : public std::invalid_argument {
  public:
    /// What is invalid: the whole polytope, a 2-face or a cell.
    enum class FaultLocation : std::uint8_t { whole, face, cell };

    /// `number` is the index of the invalid 2-face or cell; 0 for the whole polytope. `fault` says what is wrong
    /// without naming the element, such as "does not lie in two cells". what() returns both, as in "2-face 7 does
    /// not lie in two cells".
    InvalidPolytope(FaultLocation element, std::size_t number, const std::string& fault);

    FaultLocation part;  ///< the kind of element that is invalid
    std::size_t index;   ///< the index of the 2-face or cell; 0 for the whole polytope
    std::string detail;  ///< what is wrong, without the name of the element
};

/// Builds a polytope from vertices, 2-faces (vertex loops) and cells (lists of 2-faces); computes its edges, incidences
/// and orientation. `typeOfCell` holds an arbitrary number for each cell; cells of the same type have the same number.
/// If `typeOfCell` is empty, cells of the same shape have the same type. The types of the result are numbered by
/// numberCellTypes().
///
/// Throws InvalidPolytope if a cell is not a connected closed orientable surface, if a 2-face does not lie in exactly
/// two cells, or if the boundary is not orientable. Also throws InvalidPolytope if there are no cells, if a 2-face has
/// fewer than 3 vertices or a cell fewer than 4 2-faces, if a loop lists the same vertex twice in a row, if an index is
/// out of range, if a coordinate is not finite, or if all vertices are at the origin.
Polytope makePolytope(std::string name, std::vector<glm::dvec4> vertices, geometry::JaggedArray faces,
                      geometry::JaggedArray cells, std::vector<std::uint32_t> typeOfCell = {});

/// Returns the polytope in the frame of reference `frame`, with the serial number `serial`. The linear map of `frame`
/// changes neither the incidences nor convexity, and preserves the orientation because its determinant is positive. The
/// transformed polytope has the name and the cell types of `polytope`.
Polytope transformedTo(const Polytope& polytope, const geometry::ReferenceFrame& frame, std::uint64_t serial);

/// Returns the memory that the polytope occupies, in bytes, without its names.
std::size_t memoryOf(const Polytope& polytope);

}  // namespace oval4d::polytopes
