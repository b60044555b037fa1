#pragma once
// Import of polytopes from files.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The formats of files; see importPolytope().
enum class FileFormat : std::uint8_t {
    off4,    ///< 4OFF, which lists the elements of a polytope
    points,  ///< a point x y z w on each line; the polytope is their convex hull
};

/// The limits of an import.
struct ImportLimits {
    std::size_t maxVertices = 100'000;   ///< the maximum number of vertices in a 4OFF file, or of points in a list
    std::size_t maxHullCells = 100'000;  ///< the maximum number of cells of the convex hull of a list of points
};

/// The reason why a file was refused.
struct ImportError {
    std::size_t line = 0;  ///< counted from 1; 0 if no single line is the cause
    std::string reason;
    bool tooLarge = false;  ///< the file exceeds a limit
};

/// A polytope read from a file.
struct Imported {
    Polytope polytope;
    std::vector<std::string> warnings;  ///< repairs, points left out, and uncertainties due to rounding
};

/// Reads a polytope from the text of a file and gives it this name. Returns an ImportError if the file is refused.
///
/// A 4OFF file consists of "4OFF"; the numbers of vertices, 2-faces, edges and cells; a line x y z w for each vertex; a
/// line for each 2-face, with the number of its vertices followed by their indices; and a line for each cell, with the
/// number of its 2-faces followed by their indices. Indices start at 0. Comments (#) and anything that follows a record
/// on the same line, such as colors, are ignored. Each 2-face must be flat and each cell must lie in a hyperplane, to
/// within 0.5 % of half the diagonal of the bounding box of the vertices; this allows for coordinates with three
/// decimals. The polytope must also meet the conditions of makePolytope(). The following faults are repaired, with a
/// warning: a wrong number of edges, vertices on no 2-face, duplicate vertices, 2-faces in no cell, 2-faces that are
/// given once for each of their cells, 2-faces that pass through a vertex twice, and cells that consist of several
/// pieces.
///
/// A list of points has four coordinates on each line, separated by blanks, commas or semicolons; a first line that
/// does not begin with a number is ignored as a header. The polytope is the convex hull of the points. Parts of the
/// hull that lie in one hyperplane, to the precision of the coordinates in the file, become one cell.
///
/// The vertices keep the coordinates of the file. Memory use is bounded by the length of the text and by the limits: a
/// short text cannot cause large allocations by stating large numbers of elements.
std::variant<Imported, ImportError> importPolytope(FileFormat format, std::string_view text, std::string name,
                                                   const ImportLimits& limits);

/// Guesses the format of a file: 4OFF if its first word ends with "OFF", else a list of points.
FileFormat detectFileFormat(std::string_view text);

}  // namespace oval4d::polytopes
