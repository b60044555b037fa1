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
constexpr std::size_t kRadius = 4;  // the index of the radius, after those of the coordinates

// The position of each coordinate and of the radius among the columns of a row.
struct Layout {
    std::array<std::optional<std::size_t>, kRadius + 1> columns;
    std::size_t count = 0;     // the number of columns of each row; 0 if there is no header
    std::string otherColumns;  // names of the columns that are left out, in quotes
};

// Reads the names of columns. Returns nothing if they are not those of at least two coordinates.
std::optional<Layout> layoutOf(std::span<const std::string_view> names) {
    Layout layout;
    layout.count = names.size();
    std::vector<std::string> normalized;
    for (const std::string_view name : names) normalized.push_back(text::normalizedName(name));
    const bool hasW = std::ranges::find(normalized, "w") != normalized.end();
    std::size_t coordinates = 0;
    for (std::size_t i = 0; i < normalized.size(); ++i) {
        std::string name = normalized[i];
        if (!hasW && (name == "t" || name == "time")) name = "w";
        std::optional<std::size_t> member;
        if (name.size() == 1 && kCoordinates.find(name[0]) != std::string_view::npos)
            member = kCoordinates.find(name[0]);
        if (name == "r" || name == "radius") member = kRadius;
        if (member && !layout.columns[*member]) {
            layout.columns[*member] = i;
            coordinates += *member < kRadius ? 1 : 0;
            continue;
        }
        if (!layout.otherColumns.empty()) layout.otherColumns += ", ";
        layout.otherColumns += names[i].empty() ? "column " + std::to_string(i + 1) : text::inQuotes(names[i]);
    }
    return coordinates >= 2 ? std::optional(layout) : std::nullopt;
}

// Splits the names in a header, which may be separated otherwise than the rows.
void splitNames(std::string_view line, const TableFormat& format, TableRow& row) {
    split(line, format.separator, row);
    if (row.columns.size() > 1) return;
    for (const char separator : {';', '\t', ',', ' '}) {
        split(line, separator, row);
        if (row.columns.size() > 1) return;
    }
}

class PointReader {
  public:
    PointReader(std::string_view text, const PointTableOptions& options,
                const std::function<void(const PointRow&)>& add)
        : lines_(text, options.firstLine), format_(formatOf(lines_)), options_(options), add_(add) {}

    std::vector<std::string> read() {
        bool first = true;
        std::string_view comment;
        while (const auto line = lines_.next()) {
            if (text::trimmed(line->content).empty()) {
                if (!line->comment.empty()) comment = line->comment;
                continue;
            }
            if (std::exchange(first, false) && readHeader(*line, comment)) continue;
            readRow(*line);
        }
        return std::move(warnings_);
    }

  private:
    // Reads the header from the first line that is not blank, or the comment above it. Returns whether the line is not
    // a row.
    bool readHeader(const TableLine& line, std::string_view comment) {
        splitNames(line.content, format_, row_);
        const bool isRow = std::ranges::any_of(row_.columns, beginsLikeANumber);
        std::optional<Layout> layout;
        if (isRow) {
            splitNames(comment, format_, row_);
            layout = layoutOf(row_.columns);
            const auto found = [](const auto& column) { return column.has_value(); };
            if (!layout || !std::all_of(layout->columns.begin(), layout->columns.begin() + kRadius, found))
                return false;
        } else {
            layout = layoutOf(row_.columns);
            if (!layout) {
                warnings_.push_back("line " + std::to_string(line.number) + ", " +
                                    text::inQuotes(text::trimmed(line.content)) + ", has no numbers and was left out");
                return true;
            }
        }
        for (std::size_t i = 0; i < kRadius; ++i) {
            if (!layout->columns[i])
                throwFileError(line.number, std::string("the header names no column ") + kCoordinates[i] +
                                                "; it must name x, y, z and w");
        }
        layout_ = std::move(*layout);
        if (!options_.radii && layout_.columns[kRadius]) {
            const auto at = *std::exchange(layout_.columns[kRadius], std::nullopt);
            if (!layout_.otherColumns.empty()) layout_.otherColumns += ", ";
            layout_.otherColumns += text::inQuotes(row_.columns[at]);
        }
        if (!layout_.otherColumns.empty()) warnings_.push_back("these columns were left out: " + layout_.otherColumns);
        return !isRow;
    }

    // Returns whether a column of the rows is a coordinate or a radius.
    bool isRead(std::size_t column) const {
        return layout_.count == 0 || std::ranges::find(layout_.columns, std::optional(column)) != layout_.columns.end();
    }

    // Refuses the row if it has too few or too many columns, or if one that is read is empty.
    void checkColumns(std::size_t line) {
        auto& columns = row_.columns;
        const std::size_t needed = layout_.count > 0 ? layout_.count : std::max(firstSize_, kRadius);
        if (row_.endsWithSeparator && columns.size() < needed) columns.resize(needed);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (columns[i].empty() && isRead(i)) throwFileError(line, "the column is empty", i + 1);
        }
        const std::size_t size = columns.size();
        if (layout_.count > 0 && size != layout_.count)
            throwFileError(line, "the row has " + std::to_string(size) + " columns, but the header names " +
                                     std::to_string(layout_.count));
        if (size < kRadius)
            throwFileError(line, "a point has " + std::to_string(size) + " coordinates; four are needed");
        const std::size_t most = layout_.count > 0 ? layout_.count : kRadius + (options_.radii ? 1 : 0);
        if (size > most)
            throwFileError(line, text::inQuotes(columns[most]) + " follows a point's " +
                                     (most == kRadius ? "four coordinates" : "radius") +
                                     "; a header x y z w says which columns to read");
        if (firstSize_ == 0) firstSize_ = size;
        if (format_.separator != ' ' && size != firstSize_)
            throwFileError(line, "the row has " + std::to_string(size) + " columns, but the first row has " +
                                     std::to_string(firstSize_));
    }

    void readRow(const TableLine& line) {
        if (rows_++ == options_.maxPoints)
            throw FileError{line.number,
                            "there are more than " + std::to_string(options_.maxPoints) + " points, the most allowed",
                            true};
        std::string_view content = line.content;
        const std::size_t last = content.find_last_not_of(" \t");
        if (format_.separator != ';' && content[last] == ';') content = content.substr(0, last);  // a list of MATLAB
        split(content, format_.separator, row_);
        checkColumns(line.number);
        PointRow point;
        point.line = line.number;
        for (std::size_t i = 0; i < kRadius; ++i) {
            const std::size_t at = layout_.columns[i].value_or(i);
            const ParsedNumber& read = number(line, at, readers_[i]);
            point.point[static_cast<int>(i)] = read.value;
            point.numbers[i] = read.text;
        }
        const std::optional<std::size_t> radius = layout_.count > 0               ? layout_.columns[kRadius]
                                                  : row_.columns.size() > kRadius ? std::optional(kRadius)
                                                                                  : std::nullopt;
        if (radius) {
            point.radius = number(line, *radius, readers_[kRadius]).value;
            if (point.radius < 0) throwFileError(line.number, "a radius is negative", *radius + 1);
            if (layout_.count == 0 && !std::exchange(warnedOfRadius_, true))
                warnings_.emplace_back("the fifth column was read as radius");
        }
        add_(point);
    }

    ParsedNumber number(const TableLine& line, std::size_t column, NumberReader& reader) const {
        ParsedNumber read = reader.read(row_.columns[column], format_.mark);
        if (!read.fault.empty())
            throwFileError(line.number, text::inQuotes(row_.columns[column]) + ' ' + read.fault, column + 1);
        return read;
    }

    TableLines lines_;
    const TableFormat format_;
    const PointTableOptions& options_;
    const std::function<void(const PointRow&)>& add_;
    Layout layout_;
    TableRow row_;
    std::array<NumberReader, kRadius + 1> readers_;
    std::size_t rows_ = 0;
    std::size_t firstSize_ = 0;  // the number of columns of the first row; 0 before it
    bool warnedOfRadius_ = false;
    std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> readPoints(std::string_view text, const PointTableOptions& options,
                                    const std::function<void(const PointRow&)>& add) {
    return PointReader(text, options, add).read();
}

}  // namespace oval4d::text_files
