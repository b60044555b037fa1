#pragma once
// Import of polytopes from files.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/centering.hpp"
#include "polytopes/polytope.hpp"
#include "text_files/file_error.hpp"

namespace oval4d::polytopes {

/// The formats of files; see importPolytope().
enum class PolytopeFileFormat : std::uint8_t {
    off4,    ///< 4OFF, which lists the elements of a polytope
    points,  ///< a point x y z w on each line; the polytope is their convex hull
};

/// The limits of an import.
struct ImportLimits {
    std::size_t maxVertices = 100'000;   ///< the maximum number of vertices in a 4OFF file, or of points in a list
    std::size_t maxHullCells = 100'000;  ///< the maximum number of cells of the convex hull of a list of points
};

using text_files::FileError;

/// A polytope read from a file.
struct ImportedPolytope {
    Polytope polytope;
    std::vector<std::string> warnings;  ///< messages about repairs, moves, points left out, and uncertainties due to
                                        ///< rounding
};

/// Reads a polytope from the bytes of a text file (see text_files::decodePlainText()) and gives it the name `name`.
/// Returns a FileError if the file is not accepted.
///
/// A 4OFF file consists of the keyword 4OFF, or C4OFF, N4OFF or ST4OFF, in upper or lower case; the numbers of
/// vertices, 2-faces, edges and cells; a line x y z w for each vertex; a line for each 2-face, with the number of its
/// vertices followed by their indices; and a line for each cell, with the number of its 2-faces followed by their
/// indices. Indices start at 0. Text that follows a record on its line, such as a comment (#) or a color, is ignored.
/// However, a line may hold several records if it contains nothing else.
///
/// Each 2-face must be flat and each cell must lie in a hyperplane, to within 0.5 % of half the diagonal of the
/// bounding box of the vertices; this allows for coordinates with three decimals. The polytope must also meet the
/// conditions of makePolytope(). The following faults are repaired, with a warning: a wrong number of edges, vertices
/// on no 2-face, duplicate vertices, 2-faces in no cell, 2-faces without area, 2-faces that are given once for each of
/// their cells, 2-faces that pass through a vertex twice, cells that consist of several pieces, and 2-faces and cells
/// that are not exactly flat (see flattenOrSplit()).
///
/// A list of points is a table of the columns x, y, z and w (see text_files::readPoints()). The polytope is the convex
/// hull of the points. Parts of the hull that lie in one hyperplane, to the precision of the coordinates, become one
/// cell. The vertices are moved so that the cells are exactly flat; there is a warning only if a vertex is moved by
/// much more than this precision.
///
/// `centering` chooses the point, in the coordinates of the file, that becomes the origin; Polytope::originInFile
/// stores this point. Apart from this shift, vertices that need not be moved keep the coordinates of the file. The
/// memory use is bounded by the length of the text and by the limits: a short text that states large numbers of
/// elements does not cause large allocations.
std::variant<ImportedPolytope, FileError> importPolytope(PolytopeFileFormat format, std::string_view text,
                                                         std::string name, const ImportLimits& limits,
                                                         const geometry::Centering& centering = {});

/// Imports a polytope like importPolytope(), but `text` must be a result of text_files::decodePlainText().
std::variant<ImportedPolytope, FileError> importPlainText(PolytopeFileFormat format, std::string_view text,
                                                          std::string name, const ImportLimits& limits,
                                                          const geometry::Centering& centering = {});

/// Guesses the format of a file: 4OFF if its first word contains "OFF" in upper or lower case, else a list of points.
/// `text` is the text of the file (see text_files::decodePlainText()).
PolytopeFileFormat detectFileFormat(std::string_view text);

}  // namespace oval4d::polytopes
