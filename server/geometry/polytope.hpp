#pragma once
// A 4-D polytope with all its elements and their incidences.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// Lists of varying length, one after the other: list i is items[begin[i]] … items[begin[i + 1] - 1].
struct Lists {
    std::vector<std::uint32_t> begin{0};
    std::vector<std::uint32_t> items;

    std::size_t size() const { return begin.size() - 1; }
    std::span<const std::uint32_t> operator[](std::size_t i) const {
        return {items.data() + begin[i], begin[i + 1] - begin[i]};
    }
    void add(std::span<const std::uint32_t> list);
    bool operator==(const Lists&) const = default;
};

/// A kind of cells.
struct CellKind {
    std::string name;         ///< "truncated tetrahedron"
    std::uint32_t cells = 0;  ///< how many there are
    bool operator==(const CellKind&) const = default;
};

/// Vertices, edges, 2-faces and cells, immutable once built. Indices are 0-based and 32 bits wide.
struct Polytope {
    std::string name;
    std::vector<glm::dvec4> vertices;                 ///< centred at the origin
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< pairs of vertices
    Lists faces;                                      ///< each 2-face as a loop of vertices
    Lists faceEdges;                                  ///< edge i of a 2-face joins its vertices i and i + 1
    Lists edgeFaces;                                  ///< the 2-faces f around each edge, neighbours side by side, as
                                                      ///< 2 f + 1 where the loop runs along the edge from its first
                                                      ///< vertex on, else as 2 f; between s and the one behind it is
                                                      ///< the cell faceCells[s / 2][1 − s mod 2]
    Lists cells;                                      ///< each cell as its 2-faces
    std::vector<std::int8_t> cellSigns;               ///< beside cells.items: +1 where the 2-face's loop runs
                                                      ///< counter-clockwise seen from outside the cell, else −1;
                                                      ///< a 2-face has opposite signs in its two cells
    std::vector<std::array<std::uint32_t, 2>> faceCells;  ///< the two cells of each 2-face: its sign is −1 in the first
    std::vector<std::uint32_t> cellKinds;                 ///< the kind of each cell, a number into `kinds`
    std::vector<CellKind> kinds;                          ///< the kinds of cells
    std::uint64_t serial = 0;                             ///< no two built in one process share it: what caches go by
    bool convexFaces = true;                              ///< no 2-face is dented or a star
    bool convex = true;                                   ///< the boundary of a convex body
    double circumradius = 0;                              ///< the largest distance of a vertex from the origin

    std::size_t cellCount() const { return cells.size(); }
};

/// What is wrong with a polytope that cannot be built, and in which of its elements.
class Unsound : public std::invalid_argument {
  public:
    enum class Part : std::uint8_t { whole, face, cell };

    /// `fault` goes on from the element's name: "does not lie in two cells".
    Unsound(Part element, std::size_t number, const std::string& fault);

    Part part;
    std::size_t index;  ///< of the 2-face or cell
    std::string detail;
};

/// Builds edges, incidences and orientation from vertices, 2-faces (vertex loops) and cells (2-faces).
/// Throws Unsound, saying what is wrong, unless every cell is a closed orientable surface and
/// every 2-face lies in exactly two cells. `cellKinds` tells the kinds of cells apart by any numbers; where it is
/// empty, cells of the same shape are of one kind. Kinds are named by their shape and numbered from the rarest on.
Polytope makePolytope(std::string name, std::vector<glm::dvec4> vertices, Lists faces, Lists cells,
                      std::vector<std::uint32_t> cellKinds = {});

}  // namespace oval4d::geometry
