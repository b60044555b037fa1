#pragma once
// A 4-D polytope with all its elements and incidences.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/jagged_array.hpp"
#include "geometry/object_info.hpp"

namespace oval4d::polytopes {

using geometry::CellType;

/// Vertices, edges, 2-faces and cells, immutable once built. Indices are 0-based and 32 bits wide.
struct Polytope : geometry::ObjectInfo {
    std::vector<glm::dvec4> vertices;                 ///< in the catalogue, centered at the origin
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< pairs of vertices, the smaller index first
    geometry::JaggedArray faces;                      ///< the vertex loop of each 2-face
    geometry::JaggedArray faceEdges;                  ///< edge i of a 2-face joins its vertices i and i + 1
    geometry::JaggedArray edgeFaces;                  ///< the 2-faces around each edge, in cyclic order: 2-face f is
                                                      ///< stored as 2 f + 1 if its vertex loop traverses the edge
                                                      ///< from its first vertex to its second, else as 2 f. The cell
                                                      ///< between entry s and the next is
                                                      ///< faceCells[s / 2][1 − s mod 2]
    geometry::JaggedArray cells;                      ///< the 2-faces of each cell
    std::vector<std::int8_t> cellSigns;               ///< parallel to cells.items: +1 if the vertex loop of the 2-face
                                                      ///< is counterclockwise seen from outside the cell, else −1;
                                                      ///< a 2-face has opposite signs in its two cells
    std::vector<std::array<std::uint32_t, 2>> faceCells;  ///< the two cells of each 2-face; its sign is −1 in the first
    std::vector<std::uint32_t> typeOfCell;                ///< the type of each cell, an index into `cellTypes`
    bool convexFaces = true;                              ///< every 2-face is a convex polygon

    std::size_t cellCount() const { return cells.size(); }
};

/// Returns the largest distance of a vertex from the mean of the vertices. Unlike the circumradius, it is independent
/// of the position of the polytope.
double extentOf(const Polytope& polytope);

/// Thrown for element lists that do not form a valid polytope; identifies the invalid element.
class InvalidPolytope : public std::invalid_argument {
  public:
    enum class Part : std::uint8_t { whole, face, cell };

    /// `fault` continues a sentence whose subject is the element: "does not lie in two cells".
    InvalidPolytope(Part element, std::size_t number, const std::string& fault);

    Part part;
    std::size_t index;   ///< of the 2-face or cell; 0 for the whole polytope
    std::string detail;  ///< `fault`, without the element's name
};

/// Builds a polytope with its edges, incidences and orientation from vertices, 2-faces (vertex loops) and cells (lists
/// of 2-faces). Throws InvalidPolytope unless every cell is a closed orientable surface, every 2-face lies in exactly
/// two cells, and the boundary is orientable. `typeOfCell` holds an arbitrary type label for each cell; if it is
/// empty, cells of the same shape are of one type. Cell types are named after their shape and numbered from the rarest
/// to the most common.
Polytope makePolytope(std::string name, std::vector<glm::dvec4> vertices, geometry::JaggedArray faces,
                      geometry::JaggedArray cells, std::vector<std::uint32_t> typeOfCell = {});

/// Returns the memory used by a polytope in bytes, not counting names.
std::size_t bytesOf(const Polytope& polytope);

}  // namespace oval4d::polytopes
