#pragma once
// Polytopes from files.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

enum class FileFormat : std::uint8_t {
    off4,    ///< 4OFF
    points,  ///< a point a line, x y z w: the polytope is their convex hull
};

struct ImportLimits {
    std::size_t maxVertices = 100'000;   ///< of the polytope, or points of a list
    std::size_t maxHullCells = 100'000;  ///< of the hull of a list of points
};

/// Why a file was refused.
struct ImportError {
    std::size_t line = 0;  ///< counted from 1; 0 where the fault is not in one line
    std::string reason;
    bool tooLarge = false;  ///< it is over a limit
};

struct Imported {
    Polytope polytope;
    std::vector<std::string> warnings;  ///< what was repaired
};

/// 4OFF: "4OFF", then the numbers of vertices, 2-faces, edges and cells, a line x y z w for each vertex, a line "n i …"
/// of vertices for each 2-face and of 2-faces for each cell, counted from 0. Comments (#) and what follows a record in
/// its line (colours) are passed over. The 2-faces must be flat and each cell must lie in a hyperplane, within the
/// rounding of a file with three decimals; makePolytope's conditions apply. Repaired, with a warning: a wrong number of
/// edges, vertices that no 2-face uses, points given twice, 2-faces in no cell or given once for each of their cells,
/// 2-faces that pass a vertex twice, cells of several pieces.
///
/// Points: four coordinates a line, between blanks, commas or semicolons; a first line of words is taken for their
/// names. Simplices of the hull that lie in one hyperplane, to the file's own precision, are one cell.
///
/// Coordinates are kept as they are. Memory stays in proportion to the text, whatever counts it claims, and to the
/// limits.
std::variant<Imported, ImportError> importPolytope(FileFormat format, std::string_view text, std::string name,
                                                   const ImportLimits& limits);

/// What a file seems to be: 4OFF if its first word ends with OFF.
FileFormat formatOf(std::string_view text);

}  // namespace oval4d::geometry
