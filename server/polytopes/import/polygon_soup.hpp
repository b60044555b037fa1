#pragma once
// A polygon soup: the elements that a file lists, before it is known whether they form a polytope.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Vertices, 2-faces and cells as read from a file, with their positions in the file.
struct PolygonSoup {
    /// The position of an element in the file.
    struct SourcePosition {
        std::size_t line = 0;      ///< counted from 1
        std::uint32_t number = 0;  ///< its index among the 2-faces, or among the cells, of the file; from 0
    };

    std::vector<glm::dvec4> vertices;
    geometry::JaggedArray faces, cells;  ///< vertex loops and lists of 2-faces, as in Polytope
    std::vector<SourcePosition> faceSourcePositions, cellSourcePositions;  ///< parallel to `faces` and `cells`
};

/// Returns the size of a set of points: half the diagonal of its bounding box; 0 for no points. The tolerances of the
/// import are relative to this size.
double halfDiagonal(std::span<const glm::dvec4> points);

/// Throws an ImportError, with the element's line number, if a 2-face is not flat or a cell does not lie in a
/// hyperplane. Deviations of up to 0.5 % of the polytope's size (see halfDiagonal) are allowed. Also throws an
/// ImportError if all vertices lie in one hyperplane.
void checkFlat(const PolygonSoup& soup);

/// Calls makePolytope. Converts an InvalidPolytope exception to an ImportError with the element's line number.
Polytope build(PolygonSoup soup, std::string name);

}  // namespace oval4d::polytopes
