#pragma once
// Cell complexes in R⁴: vertices, edges, 2-faces and cells, and the incidences between them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"
#include "geometry/object_info.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::geometry {

/// A cell complex in R⁴: vertices, and optionally edges, 2-faces and cells. A cell complex need not be a manifold.
/// Every kind of object with edges is derived from CellComplex, so that slicing, projecting and measuring have one
/// implementation for all kinds. Indices are 0-based and have 32 bits.
struct CellComplex : ObjectInfo {
    std::vector<glm::dvec4> vertices;                     ///< the positions of the vertices, in arbitrary units
    std::vector<std::array<std::uint32_t, 2>> edges;      ///< pairs of vertices, the smaller index first
    JaggedArray faces;                                    ///< the vertex loop of each 2-face
    JaggedArray faceEdges;                                ///< the edges of each 2-face: entry i of a row is the edge
                                                          ///< from corner i to the next corner of the vertex loop
    JaggedArray cells;                                    ///< the 2-faces of each cell; empty if there are no cells
    std::vector<std::int8_t> cellSigns;                   ///< the sign of each entry of cells.items: +1 if the vertex
                                                          ///< loop of the 2-face is counterclockwise seen from outside
                                                          ///< the cell, else −1; each 2-face has the sign +1 in one of
                                                          ///< its two cells, and −1 in the other
    std::vector<std::array<std::uint32_t, 2>> faceCells;  ///< the two cells of each 2-face: first the cell in which the
                                                          ///< sign of the 2-face is −1; empty if there are no cells
    std::vector<std::uint32_t> typeOfCell;                ///< the type of each cell, an index into `cellTypes`
    bool convexFaces = true;                              ///< whether every 2-face is a convex polygon
};
static_assert(serialization::HasOwnMembers<CellComplex, ObjectInfo, 9>, "visitStoredMembers() considers each member");
void visitStoredMembers(serialization::ReadOrWritten<CellComplex> auto& complex, auto& visit) {
    visit.member(0, serialization::asBase<ObjectInfo>(complex));
    visit.member(1, complex.vertices, ObjectInfo::kStoredCoordinates);
    visit.member(2, complex.faces);
    visit.member(3, complex.cells);
    visit.member(4, complex.typeOfCell);
    visit.recomputableMember(complex.edges);
    visit.recomputableMember(complex.faceEdges);
    visit.recomputableMember(complex.cellSigns);
    visit.recomputableMember(complex.faceCells);
    visit.recomputableMember(complex.convexFaces);
}

/// Sets `edges` and `faceEdges`, which must be empty, from the vertex loops of the 2-faces. In each loop, successive
/// vertices must be different, and so must the last and the first one.
void findEdges(CellComplex& complex);

/// Returns whether every 2-face is a convex polygon. A 2-face that is not flat is not convex.
bool hasConvexFaces(const CellComplex& complex);

/// Returns the memory that the rows of `array` occupy on the heap, in bytes.
std::size_t memoryOfRows(const JaggedArray& array);

/// Returns the memory that the vertices, edges, 2-faces and cells of `complex` occupy on the heap, in bytes.
std::size_t memoryOfElements(const CellComplex& complex);

}  // namespace oval4d::geometry
