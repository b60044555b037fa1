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

/// A row of a table of points: a point, and its radius if it has one.
struct PointRow {
    std::size_t line = 0;  ///< the number of the line in the file, counted from 1
    glm::dvec4 point{0};
    double radius = 0;                        ///< the radius; 0 if the row has none
    std::array<std::string_view, 4> numbers;  ///< the coordinates as texts, in the form of ParsedCoordinate::text
};

/// The limits of a table of points.
struct PointTableOptions {
    std::size_t maxPoints = 0;
    bool radii = false;  ///< whether the points may have radii
};

/// Reads a table of points and calls `add` for each row. `text` must be a result of decodePlainText(). Returns
/// warnings, for example about columns that were left out. Throws a FileError if the table violates a rule below, or
/// has more than PointTableOptions::maxPoints rows.
///
/// - The separator of columns is the first of these that fits: a tab, if every row has at least four numbers between
///   tabs; a semicolon, if there is one inside a row; a comma, if there is one inside a row and the commas cannot be
///   decimal commas; a tab, if a row has at least four nonempty columns between tabs; blanks.
/// - Numbers may have decimal commas if the separator is not a comma. Words in double quotes are read without the
///   quotes. A separator at the end of a row is ignored. Comments begin with #, or with % at the beginning of a line,
///   and extend to the end of the line.
/// - Without a header, the columns are x, y, z, w and, if points may have radii, an optional radius. Other orders and
///   further columns require a header. Further columns may contain text, and are left out.
/// - A first row without numbers is the header if it names at least two coordinates. Otherwise, it is a title and is
///   left out. If the first row contains a number, the last comment above it that names every column is the header.
/// - The coordinates are called x, y, z and w; w may also be called t or time. The radius is called r or radius. A unit
///   may follow a name, in brackets or after a slash.
/// - Each row must have as many columns as the header; without a header, as many as the first row. However, if blanks
///   separate the columns and the radius is the last column, rows may omit the radius. A column that is read must not
///   be empty in any row. There must be at least one row.
std::vector<std::string> readPoints(std::string_view text, const PointTableOptions& options,
                                    const std::function<void(const PointRow&)>& add);

}  // namespace oval4d::text_files
