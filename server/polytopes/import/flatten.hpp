#pragma once
// Makes the 2-faces and cells of imported polytopes exactly flat.

#include <cstddef>
#include <cstdint>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// A report of what flattenOrSplit() has found and changed.
struct FlatteningReport {
    /// The largest distance of a vertex from the best-fitting hyperplane of one of its cells or 2-faces, before any
    /// change.
    double deviation = 0;
    /// The cell whose hyperplane has this deviation, or one of the two cells of a 2-face with this deviation. The value
    /// is the number of the cell in the 4OFF file, counted from 0. For a polytope that is not from a 4OFF file, the
    /// value is the index of the cell in PolygonSoup::cells.
    std::uint32_t leastFlatCell = 0;
    std::size_t moved = 0;  ///< the number of vertices that were moved by more than the argument `rounding`
    double distance = 0;    ///< the largest distance by which a vertex was moved
    std::size_t split = 0;  ///< the number of cells that were divided into tetrahedra
};

/// Moves the vertices so that the vertices of each cell lie in one hyperplane, and the vertices of each 2-face in one
/// plane. Coordinates in files are rounded: without the moves, a slicing hyperplane that nearly contains a rounded cell
/// would cut it into pieces that do not fit together. The moves are about as small as possible: if the file contains
/// rounded coordinates of an exactly flat polytope, the moves are about as large as the rounding.
///
/// After the moves, the distance of a vertex from its hyperplanes and planes is at most 10⁻¹² of `size` or, if that is
/// larger, twice doublePrecisionErrorBound(). `size` is halfDiagonal() of the vertices. If all distances are already so
/// small, nothing is changed.
///
/// If a vertex would have to be moved by more than `maxDistance`, or if no places are found at which all cells and
/// 2-faces are flat, moves no vertex. Instead, splitIntoSimplices() divides the 2-faces that are not flat into
/// triangles, and the cells that are not flat into tetrahedra.
///
/// FlatteningReport::moved counts only moves by more than `rounding`, because smaller ones are not worth a warning.
/// Takes time linear in the number of incidences of vertices and cells, up to a few seconds.
FlatteningReport flattenOrSplit(PolygonSoup& soup, double size, double maxDistance, double rounding);

}  // namespace oval4d::polytopes
