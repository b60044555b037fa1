#pragma once
// A polygon soup: vertices, 2-faces and cells that need not form a valid polytope.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Vertices, 2-faces and cells as read from a file, with the positions of the 2-faces and cells in the file.
struct PolygonSoup {
    /// The position of an element in the file.
    struct SourcePosition {
        std::size_t line = 0;      ///< the number of the line, counted from 1
        std::uint32_t number = 0;  ///< the index of the 2-face or cell in the file, counted from 0
    };

    std::vector<glm::dvec4> vertices;
    geometry::JaggedArray faces, cells;  ///< the vertex loop of each 2-face, and the 2-faces of each cell
    /// The positions of the elements of `faces` and `cells` in the file; empty for a polytope that is not from a 4OFF
    /// file.
    std::vector<SourcePosition> faceSourcePositions, cellSourcePositions;
};

/// The greatest permitted distance, relative to halfDiagonal(), of the vertices of a cell from one hyperplane, and of
/// the vertices of a 2-face from one plane. Coordinates with three decimals are precise enough.
inline constexpr double kFlatnessTolerance = 5e-3;

/// Returns half the diagonal of the bounding box of the points; 0 if there are no points. The tolerances of the import
/// are relative to this size.
double halfDiagonal(std::span<const glm::dvec4> points);

/// Returns a bound on the rounding errors of points whose coordinates are doubles. The bound is proportional to the
/// largest distance of a point from the origin.
double doublePrecisionErrorBound(std::span<const glm::dvec4> points);

/// Throws a FileError, with the element's line number, if a 2-face is not flat or a cell does not lie in a
/// hyperplane, to within kFlatnessTolerance times halfDiagonal(). Also throws a FileError if all vertices lie in one
/// hyperplane, to within 10⁻⁶ of halfDiagonal().
void checkFlatnessAndDimension(const PolygonSoup& soup);

/// Builds the polytope of the soup by makePolytope(). If the soup is not a valid polytope, throws a FileError with the
/// line number of the invalid element.
Polytope build(PolygonSoup soup, std::string name);

}  // namespace oval4d::polytopes
