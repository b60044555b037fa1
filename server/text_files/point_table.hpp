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
    std::size_t line = 0;  ///< counted from 1
    glm::dvec4 point{0};
    double radius = 0;                        ///< 0 if the row has none
    std::array<std::string_view, 4> numbers;  ///< the coordinates as they are written; see ParsedCoordinate::text
};

/// What a table of points may contain.
struct PointTableOptions {
    std::size_t maxPoints = 0;
    bool radii = false;  ///< the points may have radii
};

/// Reads a table of points from a text that plainText() has returned, calls `add` for each row, and returns warnings:
/// what was left out or read as a radius. Throws a FileError with line and column if a row is refused, or if there are
/// too many rows.
///
/// - The columns are separated by tabs if there are at least four numbers between tabs; else by semicolons, else by
///   commas (unless these may be decimal commas), else by tabs, else by blanks. Where semicolons, tabs or blanks
///   separate them, numbers may have decimal commas. Words in double quotes are read without the quotes. A separator
///   at the end of a row is ignored. Comments begin with # and extend to the end of the line.
/// - The columns are x, y, z, w and, if points may have radii, an optional radius. Other orders and further columns,
///   which may be text, need a header: a first row in which no word is a number, or a comment above the first row that
///   has a name for each column. The header names the columns x, y, z, w (or t, or time, if none is called w), and r or
///   radius; other columns are left out. Units in brackets may follow the names. A first row without numbers that names
///   fewer than two of the coordinates is a title, and left out.
/// - Each row must have as many columns as the header, or, without a header, as the first row; where blanks separate
///   the columns, some rows may have a radius in the last column and others none. A column that is read must not be
///   empty in any row. There must be a row.
std::vector<std::string> readPoints(std::string_view text, const PointTableOptions& options,
                                    const std::function<void(const PointRow&)>& add);

}  // namespace oval4d::text_files
