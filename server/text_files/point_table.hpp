#pragma once
// Tables of points: text files with a row of numbers for each point.

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec4.hpp>

namespace oval4d::text_files {

/// A row of a table of points.
struct PointRow {
    std::size_t line = 0;  ///< the number of the line in the file, counted from 1
    glm::dvec4 point{0};
    double radius = 0;                        ///< 0 if the row has none
    std::array<std::string_view, 4> numbers;  ///< the texts of the coordinates, as in ParsedCoordinate::text
};

/// What a table of points may contain.
struct PointTableOptions {
    std::size_t maxPoints = 0;
    bool radii = false;  ///< whether the points may have radii
};

/// Reads a table of points and calls `add` for each row. `text` must be a result of plainText(). Returns warnings, for
/// example about columns that were left out. Throws a FileError if the table does not follow the rules below, or if it
/// has more than PointTableOptions::maxPoints rows.
///
/// - The separator of the columns is the first of these that fits: a tab, if every row has at least four numbers
///   between tabs; a semicolon, if one stands inside a row; a comma, if one stands inside a row and the commas cannot
///   be decimal commas; a tab, if a row has at least four columns between tabs; blanks. If the separator is not a
///   comma, numbers may have decimal commas. Words in double quotes are read without the quotes. A separator at the end
///   of a row is ignored. Comments begin with #, or with % at the beginning of a line, and extend to the end of the
///   line.
/// - Without a header, the columns are x, y, z, w and, if points may have radii, an optional radius. Other orders and
///   further columns need a header. The further columns are left out, and may contain text.
/// - A first row without numbers is the header if it names at least two of the coordinates; otherwise, it is a title,
///   and left out. If the first row contains a number, a comment above it is the header, provided that it names every
///   column. If several comments do so, the last one is the header.
/// - The coordinates are called x, y, z and w, or t or time instead of w; the radius is called r or radius. A unit
///   may follow a name in brackets or after a slash.
/// - With a header, each row must have as many columns as the header; without one, as many as the first row. However,
///   if blanks separate the columns and the radius is the last column, each row may have a radius or none. A column
///   that is read must not be empty in any row. There must be at least one row.
std::vector<std::string> readPoints(std::string_view text, const PointTableOptions& options,
                                    const std::function<void(const PointRow&)>& add);

}  // namespace oval4d::text_files
