#pragma once
// Divides the 2-faces and cells of imported polytopes into simplices.

#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Divides 2-faces into triangles and cells into tetrahedra. `faces` and `cells` say for each 2-face and each cell
/// whether to divide it; all 2-faces of a divided cell are divided, too. The diagonals that divide a 2-face start at
/// the vertex of the 2-face with the least index. The triangles that divide a cell join the vertex of the cell with the
/// least index to edges of the cell. The division is a pulling triangulation (De Loera, Rambau and Santos,
/// Triangulations, 4.3.2): neighboring cells divide their common 2-face in the same way. Each triangle of a 2-face is
/// the base of at most one tetrahedron in each of the two cells of the 2-face.
void splitIntoSimplices(PolygonSoup& soup, std::vector<bool> faces, const std::vector<bool>& cells);

}  // namespace oval4d::polytopes
