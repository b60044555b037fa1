#pragma once
// Divides the 2-faces and cells of imported polytopes into simplices.

#include <vector>

#include "polytopes/import/polygon_soup.hpp"

namespace oval4d::polytopes {

/// Divides 2-faces into triangles and cells into tetrahedra. `faces` and `cells` say of each 2-face and cell whether it
/// is to be divided; all 2-faces of a divided cell are divided, too. A 2-face is divided by the diagonals from its
/// first vertex, and a cell by the triangles between its first vertex and its edges. The first vertex is the one with
/// the least index; therefore neighboring cells agree (a pulling triangulation: De Loera, Rambau and Santos,
/// Triangulations, 4.3.2). There are at most two tetrahedra for each triangle.
void splitIntoSimplices(PolygonSoup& soup, std::vector<bool> faces, const std::vector<bool>& cells);

}  // namespace oval4d::polytopes
