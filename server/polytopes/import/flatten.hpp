#pragma once
// Makes the 2-faces and cells of imported polytopes exactly flat.

#include <cstddef>
#include <cstdint>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// What flatten() has changed.
struct Flattening {
    double deviation = 0;        ///< before: how far a vertex was from the hyperplane that fits its cell best
    std::uint32_t farthest = 0;  ///< the cell with this deviation: its number in the file, if known, or its index
    std::size_t moved = 0;       ///< the number of vertices that were moved by more than `rounding`
    double distance = 0;         ///< the largest distance by which a vertex was moved
    std::size_t split = 0;       ///< the number of cells that were divided into tetrahedra
};

/// Moves the vertices so that those of each cell lie in one hyperplane, and those of each 2-face in one plane, to
/// within 10⁻¹² of `size`, halfDiagonal() of the vertices, or to within twice doubleRounding() of them if that is
/// larger; changes nothing if they do so already. Coordinates in files are rounded, and a hyperplane that nearly
/// contains a rounded cell would otherwise cut it in pieces that do not fit together. The moves are about as small as
/// possible: if the file is a rounded polytope, they are about as large as the rounding.
///
/// If a vertex would have to be moved by more than `maxDistance`, or if there are no such places for the vertices,
/// moves none. Then the 2-faces that are not flat are divided into triangles, and the cells that are not flat into
/// tetrahedra, as by splitIntoSimplices().
///
/// `rounding` is the largest distance of a move that is not worth a warning. Takes time linear in the number of
/// incidences of vertices and cells, up to a few seconds.
Flattening flatten(PolygonSoup& soup, double size, double maxDistance, double rounding);

}  // namespace oval4d::polytopes
