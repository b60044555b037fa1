#pragma once
// The lines of a table in a text file, and their columns.

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "text_files/number.hpp"

namespace oval4d::text_files {

/// A line of a text file, divided at the mark with which its comment begins: a % at the beginning of the line, or else
/// the first #.
struct TableLine {
    std::size_t number = 0;    ///< the number of the line in the file, counted from 1
    std::string_view content;  ///< the text before the mark, including blanks at its ends
    std::string_view comment;  ///< the text after the mark, without blanks at its ends
};

/// The lines of a text file, one after the other.
class TableLines {
  public:
    /// `text` must outlive this object and the lines that next() returns.
    explicit TableLines(std::string_view text) : rest_(text) {}

    /// Returns the next line; an empty optional at the end of the text.
    std::optional<TableLine> next();

  private:
    std::string_view rest_;
    std::size_t number_ = 1;
};

/// How the columns of a table are separated, and which decimal mark its numbers have.
struct TableFormat {
    char separator = ' ';  ///< ';', '\t', ',', or ' ' for any number of blanks
    DecimalMark mark = DecimalMark::point;
};

/// Returns the format of a table: the separator and the decimal mark that fit its rows; blanks and a point if there are
/// no rows.
TableFormat formatOf(TableLines lines);

/// The columns of a line.
struct TableRow {
    std::vector<std::string_view> columns;  ///< without the blanks and quotes around them; some may be empty
    bool endsWithSeparator = false;         ///< whether a separator other than a blank follows the last column
};

/// Sets `row` to the columns of a line. `separator` is as in TableFormat.
void split(std::string_view line, char separator, TableRow& row);

}  // namespace oval4d::text_files
