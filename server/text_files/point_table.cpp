#include "text_files/point_table.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "text/message_text.hpp"
#include "text/words.hpp"
#include "text_files/file_error.hpp"
#include "text_files/number.hpp"
#include "text_files/table_row.hpp"

namespace oval4d::text_files {

namespace {

constexpr std::string_view kCoordinates = "xyzw";
constexpr std::size_t kRadiusIndex = 4;  // index of the radius; x, y, z and w have the indices 0 to 3
// The maximum number of titles: lines of text that are neither comments nor the header. The line after so many titles
// is read as a row of numbers.
constexpr std::size_t kMaxTitles = 10;

// The positions of the coordinates and the radius among the columns of a row.
struct ColumnLayout {
    std::array<std::optional<std::size_t>, kRadiusIndex + 1> columns;
    std::size_t count = 0;  // number of columns of each row; 0 without a header
    // Whether the radius is the last column; if blanks separate the columns, rows may then lack it.
    bool radiusMayMiss = false;
    std::string otherColumns;     // the names of columns that are not read, in quotes, separated by commas
    std::string_view radiusName;  // name of the radius in the header

    bool hasAllCoordinates() const {
        return std::all_of(columns.begin(), columns.begin() + kRadiusIndex,
                           [](const auto& at) { return at.has_value(); });
    }
    // Returns whether the columns x, y, z and w come in this order.
    bool isInAxisOrder() const { return std::ranges::is_sorted(std::span(columns).first(kRadiusIndex)); }
};

// Returns the name of a column without its unit, which may follow in brackets or after a slash, as in "t [s]" or "t/s".
std::string_view withoutUnit(std::string_view name) {
    const std::string_view before = text::trimmed(name.substr(0, name.find_first_of("[({/")));
    return before.empty() ? name : before;
}

// Removes units, such as "[s]", from a list of names. The list is a header that was split at blanks: "x", "t", "[s]".
void removeUnits(std::vector<std::string_view>& names) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        constexpr std::string_view kOpening = "[({", kClosing = "])}";
        const std::size_t kind = names[i].empty() ? std::string_view::npos : kOpening.find(names[i].front());
        if (i == 0 || kind == std::string_view::npos) {
            names[kept++] = names[i];
            continue;
        }
        while (!names[i].ends_with(kClosing[kind]) && i + 1 < names.size()) ++i;
    }
    names.resize(kept);
}

// Returns the layout of a table whose columns have these names. Returns an empty optional if fewer than two names are
// names of coordinates. If no column is called w, a column called t or time is w.
std::optional<ColumnLayout> columnLayoutOf(std::span<const std::string_view> names) {
    ColumnLayout layout;
    layout.count = names.size();
    std::vector<std::string> normalized;
    for (const std::string_view name : names) normalized.push_back(text::normalizedName(withoutUnit(name)));
    const bool hasW = std::ranges::find(normalized, "w") != normalized.end();
    std::size_t coordinates = 0;
    for (std::size_t i = 0; i < normalized.size(); ++i) {
        std::string name = normalized[i];
        if (!hasW && (name == "t" || name == "time")) name = "w";
        std::optional<std::size_t> member;
        if (name.size() == 1 && kCoordinates.find(name[0]) != std::string_view::npos)
            member = kCoordinates.find(name[0]);
        if (name == "r" || name == "radius") member = kRadiusIndex;
        if (member && !layout.columns[*member]) {
            layout.columns[*member] = i;
            coordinates += *member < kRadiusIndex ? 1 : 0;
            if (*member == kRadiusIndex) layout.radiusName = names[i];
            continue;
        }
        if (!layout.otherColumns.empty()) layout.otherColumns += ", ";
        layout.otherColumns += names[i].empty() ? "column " + std::to_string(i + 1) : text::inQuotes(names[i]);
    }
    layout.radiusMayMiss = layout.columns[kRadiusIndex] == layout.count - 1;
    return coordinates >= 2 ? std::optional(std::move(layout)) : std::nullopt;
}

// Reads names of columns from a line. Tries several separators, because the names may be separated in another way than
// the rows. Returns the first layout for which `accepts` returns true, or an empty optional if there is none.
// Overwrites `row`.
std::optional<ColumnLayout> findColumnLayout(std::string_view line, const TableFormat& format, SplitTableRow& row,
                                             const std::function<bool(const ColumnLayout&)>& accepts) {
    for (const char separator : {format.separator, ';', '\t', ',', ' '}) {
        splitColumns(line, separator, row);
        if (separator == ' ') removeUnits(row.columns);
        if (auto layout = columnLayoutOf(row.columns); layout && accepts(*layout)) return layout;
    }
    return {};
}

// Returns the part of a comment that may name the columns: "x, y, z, w" for "columns: (x, y, z, w)".
std::string_view columnNamesInComment(std::string_view comment) {
    if (const std::size_t colon = comment.find_last_of(":="); colon != std::string_view::npos)
        comment = text::trimmed(comment.substr(colon + 1));
    const std::size_t end = std::min(comment.find_first_of(" \t"), comment.size());
    const std::string first = text::normalizedName(comment.substr(0, end));
    if (first == "columns" || first == "coordinates" || first == "fields") comment = text::trimmed(comment.substr(end));
    const bool inBrackets = comment.size() > 1 && (comment.starts_with('(') || comment.starts_with('[')) &&
                            (comment.ends_with(')') || comment.ends_with(']')) &&
                            comment.find_first_of(")]") == comment.size() - 1;
    return inBrackets ? comment.substr(1, comment.size() - 2) : comment;
}

// Returns whether a line tells Excel the separator: "sep=;", for example, or "sep=" and a tab. The caller skips such a
// line, because tableFormatOf() finds the separator from the rows.
bool isSeparatorStatement(std::string_view line) {
    line = text::trimmed(line);
    return line.size() <= 5 && text::normalizedName(line.substr(0, 4)) == "sep=";
}

class PointTableReader {
  public:
    PointTableReader(std::string_view text, const PointTableOptions& options,
                     const std::function<void(const PointRow&)>& add)
        : lines_(text), format_(tableFormatOf(lines_)), options_(options), add_(add) {}

    std::vector<std::string> read() {
        bool first = true;  // true until a header or a row was read
        std::size_t titles = 0;
        std::vector<TableLine> comments;
        while (const auto line = lines_.nextLine()) {
            if (text::trimmed(line->content).empty()) {
                if (first && !line->comment.empty()) comments.push_back(*line);
                continue;
            }
            if (line->number == 1 && isSeparatorStatement(line->content)) continue;
            const bool isText = first && readHeader(*line, comments);
            first = isText && layout_.count == 0 && ++titles < kMaxTitles;
            if (!isText) readRow(*line);
        }
        if (rows_ == 0) {
            throwFileError(0, layout_.count > 0 ? "the table has a header, but no rows"
                                                : "the file has no rows of numbers, so it is not a table of points");
        }
        return std::move(warnings_);
    }

  private:
    // Reads the header, if there is one. `line` is the first line that is neither a comment nor an earlier title.
    // `comments` are the comments above `line`. If `line` contains a number, looks for the header in `comments`, and
    // returns false. Also returns false if `line` is a faulty row of numbers. Otherwise, returns true: `line` is then
    // the header or, if it names fewer than two coordinates, a title, which is left out. Throws a FileError if the
    // header lacks a coordinate.
    bool readHeader(const TableLine& line, std::span<const TableLine> comments) {
        splitColumns(line.content, format_.separator, row_);
        const auto number = [&](std::string_view word) { return isNumber(word, format_.mark); };
        if (std::ranges::any_of(row_.columns, number)) {
            splitRow(line);
            readComments(comments);
            return false;
        }
        const bool likeNumbers = std::ranges::any_of(row_.columns, beginsLikeANumber);
        auto layout = findColumnLayout(line.content, format_, row_, &ColumnLayout::hasAllCoordinates);
        if (!layout) layout = findColumnLayout(line.content, format_, row_, [](const ColumnLayout&) { return true; });
        // A faulty row of numbers: readRow() will report the word that is not a number.
        if (!layout && likeNumbers) return false;
        if (!layout) {
            warnings_.push_back("line " + std::to_string(line.number) + ", " +
                                text::inQuotes(text::trimmed(line.content)) + ", has no numbers and was left out");
            return true;
        }
        for (std::size_t i = 0; i < kRadiusIndex; ++i) {
            if (!layout->columns[i])
                throwFileError(line.number, std::string("the header names no column ") + kCoordinates[i] +
                                                "; it must name x, y, z and w");
        }
        setLayout(std::move(*layout));
        return true;
    }

    // Looks for a header in the comments above the first row, which must be in `row_`. A comment is a header if it
    // names x, y, z and w and has as many names as the row has columns. A row that ends with a separator may have fewer
    // columns; a row without the radius, one column less. The last such comment is used. Without such a comment, the
    // columns are x, y, z, w in this order; a warning then names the first comment with another order, because it was
    // not used.
    void readComments(std::span<const TableLine> comments) {
        const SplitTableRow first = row_;
        const auto fits = [&](const ColumnLayout& layout) {
            const std::size_t size = first.columns.size();
            const bool sameSize = size == layout.count || (first.endsWithSeparator && size < layout.count);
            const bool radiusMisses = format_.separator == ' ' && layout.radiusMayMiss && size + 1 == layout.count;
            return layout.hasAllCoordinates() && (sameSize || radiusMisses);
        };
        for (std::size_t i = comments.size(); i-- > 0;) {
            if (auto layout = findColumnLayout(columnNamesInComment(comments[i].comment), format_, row_, fits))
                return setLayout(std::move(*layout));
        }
        for (const TableLine& line : comments) {
            const auto layout =
                findColumnLayout(columnNamesInComment(line.comment), format_, row_, &ColumnLayout::hasAllCoordinates);
            if (!layout || layout->isInAxisOrder()) continue;
            warnings_.push_back("the comment in line " + std::to_string(line.number) +
                                " does not name each column of the rows, and was not read as a header");
            return;
        }
    }

    // Uses `layout` for the rows, and warns about columns that are not read.
    void setLayout(ColumnLayout layout) {
        layout_ = std::move(layout);
        if (!options_.radii && std::exchange(layout_.columns[kRadiusIndex], std::nullopt)) {
            if (!layout_.otherColumns.empty()) layout_.otherColumns += ", ";
            layout_.otherColumns += text::inQuotes(layout_.radiusName);
        }
        if (!layout_.otherColumns.empty()) warnings_.push_back("these columns were left out: " + layout_.otherColumns);
    }

    // Returns whether the content of a column matters. The index `column` counts from 0. Without a header, every column
    // matters; with a header, only the coordinates and the radius.
    bool isColumnRead(std::size_t column) const {
        return layout_.count == 0 || std::ranges::find(layout_.columns, std::optional(column)) != layout_.columns.end();
    }

    // Throws a FileError if `row_` has too few or too many columns, or if a column that is read is empty. If the row
    // ends with a separator, first appends the columns that it lacks, as empty columns.
    void checkColumns(std::size_t line) {
        auto& columns = row_.columns;
        const std::size_t needed = layout_.count > 0 ? layout_.count : std::max(firstSize_, kRadiusIndex);
        if (row_.endsWithSeparator && columns.size() < needed) columns.resize(needed);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (columns[i].empty() && isColumnRead(i)) throwFileError(line, "the column is empty", i + 1);
        }
        const std::size_t size = columns.size();
        const bool radiusMisses = format_.separator == ' ' && layout_.radiusMayMiss && size + 1 == layout_.count;
        if (layout_.count > 0 && size != layout_.count && !radiusMisses)
            throwFileError(line, "the row has " + std::to_string(size) + " columns, but the header names " +
                                     std::to_string(layout_.count));
        if (size < kRadiusIndex)
            throwFileError(line, "a point has " + std::to_string(size) + " coordinates; four are needed");
        const std::size_t most = layout_.count > 0 ? layout_.count : kRadiusIndex + (options_.radii ? 1 : 0);
        if (size > most)
            throwFileError(line, text::inQuotes(columns[most]) + " follows a point's " +
                                     (most == kRadiusIndex ? "four coordinates" : "radius") +
                                     "; a header x y z w says which columns to read");
        if (firstSize_ == 0) firstSize_ = size;
        if (format_.separator != ' ' && size != firstSize_)
            throwFileError(line, "the row has " + std::to_string(size) + " columns, but the first row has " +
                                     std::to_string(firstSize_));
    }

    // Splits the row in `line` into columns, and stores them in `row_`.
    void splitRow(const TableLine& line) {
        std::string_view content = line.content;
        const std::size_t last = content.find_last_not_of(" \t");
        // Drop a semicolon at the end of the row. In MATLAB, a semicolon ends each row of a matrix.
        if (format_.separator != ';' && content[last] == ';') content = content.substr(0, last);
        splitColumns(content, format_.separator, row_);
    }

    void readRow(const TableLine& line) {
        if (rows_++ == options_.maxPoints)
            throw FileError{line.number,
                            "there are more than " + std::to_string(options_.maxPoints) + " points, the most allowed",
                            true};
        splitRow(line);
        checkColumns(line.number);
        PointRow point;
        point.line = line.number;
        for (std::size_t i = 0; i < kRadiusIndex; ++i) {
            const std::size_t at = layout_.columns[i].value_or(i);
            const ParsedCoordinate& read = parseCoordinate(line, at, readers_[i]);
            point.point[static_cast<int>(i)] = read.value;
            point.numbers[i] = read.text;
        }
        const std::optional<std::size_t> radius =
            layout_.count > 0 ? layout_.columns[kRadiusIndex] : std::optional(kRadiusIndex);
        if (radius && *radius < row_.columns.size()) {
            point.radius = parseCoordinate(line, *radius, readers_[kRadiusIndex]).value;
            if (point.radius < 0) throwFileError(line.number, "a radius is negative", *radius + 1);
            if (layout_.count == 0 && !std::exchange(warnedOfRadius_, true))
                warnings_.emplace_back("the fifth column was read as radius");
        }
        add_(point);
    }

    ParsedCoordinate parseCoordinate(const TableLine& line, std::size_t column, CoordinateReader& reader) const {
        ParsedCoordinate read = reader.read(row_.columns[column], format_.mark);
        if (!read.fault.empty())
            throwFileError(line.number, text::inQuotes(row_.columns[column]) + ' ' + read.fault, column + 1);
        return read;
    }

    TableLines lines_;
    const TableFormat format_;
    const PointTableOptions& options_;
    const std::function<void(const PointRow&)>& add_;
    ColumnLayout layout_;
    SplitTableRow row_;
    std::array<CoordinateReader, kRadiusIndex + 1> readers_;
    std::size_t rows_ = 0;
    std::size_t firstSize_ = 0;  // number of columns of the first row; 0 before the first row
    bool warnedOfRadius_ = false;
    std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> readPoints(std::string_view text, const PointTableOptions& options,
                                    const std::function<void(const PointRow&)>& add) {
    return PointTableReader(text, options, add).read();
}

}  // namespace oval4d::text_files
