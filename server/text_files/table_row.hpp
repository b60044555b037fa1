#pragma once
// Splits the lines of a table in a text file into columns.

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "text_files/number.hpp"

namespace oval4d::text_files {

/// A line of a text file, split into its content and its comment. The comment begins at a mark: a % at the beginning of
/// the line, after any blanks, or else the first #.
struct TableLine {
    std::size_t number = 0;  ///< the number of the line in the file, counted from 1
    /// The text before the mark, including blanks at its ends; without a mark, the whole line.
    std::string_view content;
    std::string_view comment;  ///< the text after the mark, without blanks at its ends; empty without a mark
};

/// The lines of a text file, which nextLine() returns one after another.
class TableLines {
  public:
    /// `text` must outlive this object and the lines that nextLine() returns.
    explicit TableLines(std::string_view text) : rest_(text) {}

    /// Returns the next line, or an empty optional at the end of the text.
    std::optional<TableLine> nextLine();

  private:
    std::string_view rest_;
    std::size_t number_ = 1;
};

/// The format of a table: the separator of its columns, and the decimal mark of its numbers.
struct TableFormat {
    char separator = ' ';  ///< the separator of columns: ';', '\t', ',', or ' ' for any number of blanks
    DecimalMark mark = DecimalMark::point;
};

/// Returns the format that fits the rows of a table. Returns blanks and a decimal point if there are no rows.
TableFormat tableFormatOf(TableLines lines);

/// The columns of a line of a table.
struct SplitTableRow {
    std::vector<std::string_view> columns;  ///< the columns without surrounding blanks and quotes; columns may be empty
    bool endsWithSeparator = false;         ///< whether a separator other than a blank follows the last column
};

/// Splits a line into columns, and stores them in `row`. `separator` is as in TableFormat.
void splitColumns(std::string_view line, char separator, SplitTableRow& row);

}  // namespace oval4d::text_files
