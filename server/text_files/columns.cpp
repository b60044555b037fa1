#include "text_files/columns.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "text/message_text.hpp"
#include "text/words.hpp"
#include "text_files/file_error.hpp"
#include "text_files/number.hpp"
#include "text_files/tokenizer.hpp"

namespace oval4d::text_files {

namespace {

constexpr std::string_view kCoordinates = "xyzw";
constexpr std::size_t kRadius = 4;  // the index of the radius, after those of the coordinates

// The word in quotes, as it is written in the file.
std::string quoted(std::string_view word) { return text::inQuotes(word); }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

// A line of the file, without its comment.
struct Line {
    std::size_t number = 0;
    std::string_view content, comment;  // trimmed; the comment without #
};

class Lines {
  public:
    Lines(std::string_view text, std::size_t firstNumber) : rest_(text), number_(firstNumber) {}

    std::optional<Line> next() {
        if (rest_.empty()) return {};
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        const std::string_view whole = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        const std::size_t hash = std::min(whole.find('#'), whole.size());
        return Line{number_++, trimmed(whole.substr(0, hash)), trimmed(whole.substr(std::min(hash + 1, whole.size())))};
    }

  private:
    std::string_view rest_;
    std::size_t number_;
};

// How the columns of a file are separated, and its numbers written.
struct Dialect {
    char separator = ' ';  // ';', '\t', ',', or ' ' for any number of blanks
    DecimalMark mark = DecimalMark::point;
};

// The columns of a line. A separator at its end begins no further column.
struct Row {
    std::vector<std::string_view> columns;
    bool endsWithSeparator = false;
};

// Splits a line into columns, without the quotes around them.
void split(std::string_view line, char separator, Row& row) {
    row.columns.clear();
    row.endsWithSeparator = false;
    const auto separates = [&](char c) { return separator == ' ' ? isBlank(c) : c == separator; };
    while (true) {
        line = trimmed(line);
        if (line.empty()) break;
        row.endsWithSeparator = false;
        std::size_t end = 0;
        std::string_view word;
        if (line.front() == '"' && line.find('"', 1) != std::string_view::npos) {
            const std::size_t close = line.find('"', 1);
            word = trimmed(line.substr(1, close - 1));
            end = close + 1;
            while (end < line.size() && !separates(line[end])) ++end;
        } else {
            while (end < line.size() && !separates(line[end])) ++end;
            word = trimmed(line.substr(0, end));
        }
        row.columns.push_back(word);
        row.endsWithSeparator = end < line.size();
        line.remove_prefix(std::min(end + 1, line.size()));
        if (separator == '\t' && row.endsWithSeparator) {
            // Trimming would remove the tabs of empty columns.
            while (line.starts_with('\t')) {
                row.columns.emplace_back();
                line.remove_prefix(1);
            }
        }
    }
    if (separator == ' ') row.endsWithSeparator = false;
}

bool hasSeparatorInside(std::string_view line, char separator) {
    const std::size_t last = line.find_last_not_of(std::string{separator, ' ', '\t'});
    return last != std::string_view::npos && line.find(separator) < last;
}

// Returns whether a line is of words separated by blanks, some of which have a comma inside, but none at its ends.
bool hasDecimalCommas(std::string_view line, Row& row) {
    split(line, ' ', row);
    const auto inside = [](std::string_view word) { return word.find(',') != std::string_view::npos; };
    const auto atEnd = [](std::string_view word) { return word.starts_with(',') || word.ends_with(','); };
    return row.columns.size() >= kCoordinates.size() && std::ranges::any_of(row.columns, inside) &&
           std::ranges::none_of(row.columns, atEnd);
}

Dialect dialectOf(Lines lines) {
    bool semicolons = false, tabs = false, commas = false, decimalCommas = false;
    Row row;
    while (const auto line = lines.next()) {
        if (!beginsLikeANumber(line->content.starts_with('"') ? line->content.substr(1) : line->content)) continue;
        semicolons = semicolons || hasSeparatorInside(line->content, ';');
        if (hasSeparatorInside(line->content, '\t')) {
            split(line->content, '\t', row);
            tabs = tabs || row.columns.size() >= kCoordinates.size();  // otherwise tabs and blanks are mixed
        }
        commas = commas || hasSeparatorInside(line->content, ',');
        decimalCommas = decimalCommas || hasDecimalCommas(line->content, row);
    }
    if (semicolons) return {';', DecimalMark::comma};
    if (commas && !decimalCommas) return {','};
    return {tabs ? '\t' : ' ', decimalCommas ? DecimalMark::comma : DecimalMark::point};
}

// The position of each coordinate and of the radius among the columns of a row.
struct Layout {
    std::array<std::optional<std::size_t>, kRadius + 1> columns;
    std::size_t count = 0;     // the number of columns of each row; 0 if there is no header
    std::string otherColumns;  // names of the columns that are left out, in quotes
};

std::string_view withoutQuotes(std::string_view word) {
    return word.size() > 1 && word.starts_with('"') && word.ends_with('"') ? word.substr(1, word.size() - 2) : word;
}

// Reads the names of columns. Returns nothing if they are not those of at least two coordinates.
std::optional<Layout> layoutOf(std::span<const std::string_view> names) {
    Layout layout;
    layout.count = names.size();
    std::vector<std::string> normalized;
    for (const std::string_view name : names) normalized.push_back(text::normalizedName(withoutQuotes(name)));
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
        layout.otherColumns += names[i].empty() ? "column " + std::to_string(i + 1) : quoted(withoutQuotes(names[i]));
    }
    return coordinates >= 2 ? std::optional(layout) : std::nullopt;
}

// Splits the names in a header, which may be separated otherwise than the rows.
void splitNames(std::string_view line, const Dialect& dialect, Row& row) {
    split(line, dialect.separator, row);
    if (row.columns.size() > 1) return;
    for (const char separator : {';', '\t', ',', ' '}) {
        split(line, separator, row);
        if (row.columns.size() > 1) return;
    }
}

class PointReader {
  public:
    PointReader(std::string_view text, Radii radii, const std::function<void(const PointRow&)>& add,
                std::size_t firstLine)
        : lines_(text, firstLine), dialect_(dialectOf(lines_)), radii_(radii), add_(add) {}

    std::vector<std::string> read() {
        bool first = true;
        std::string_view comment;
        while (const auto line = lines_.next()) {
            if (line->content.empty()) {
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
    bool readHeader(const Line& line, std::string_view comment) {
        splitNames(line.content, dialect_, row_);
        const bool isRow = std::ranges::any_of(row_.columns, beginsLikeANumber);
        std::optional<Layout> layout;
        if (isRow) {
            splitNames(comment, dialect_, row_);
            layout = layoutOf(row_.columns);
            const auto found = [](const auto& column) { return column.has_value(); };
            if (!layout || !std::all_of(layout->columns.begin(), layout->columns.begin() + kRadius, found))
                return false;
        } else {
            layout = layoutOf(row_.columns);
            if (!layout) {
                warnings_.push_back("line " + std::to_string(line.number) + ", " + quoted(line.content) +
                                    ", has no numbers and was left out");
                return true;
            }
        }
        for (std::size_t i = 0; i < kRadius; ++i) {
            if (!layout->columns[i])
                throwFileError(line.number, std::string("the header names no column ") + kCoordinates[i] +
                                                "; it must name x, y, z and w");
        }
        layout_ = std::move(*layout);
        if (radii_ == Radii::none && layout_.columns[kRadius]) {
            const auto at = *std::exchange(layout_.columns[kRadius], std::nullopt);
            if (!layout_.otherColumns.empty()) layout_.otherColumns += ", ";
            layout_.otherColumns += quoted(withoutQuotes(row_.columns[at]));
        }
        if (!layout_.otherColumns.empty()) warnings_.push_back("these columns were left out: " + layout_.otherColumns);
        return !isRow;
    }

    void readRow(const Line& line) {
        std::string_view content = line.content;
        if (dialect_.separator != ';' && content.ends_with(';')) content.remove_suffix(1);  // as in lists of MATLAB
        split(content, dialect_.separator, row_);
        const std::size_t most = layout_.count > 0 ? layout_.count : kRadius + (radii_ == Radii::none ? 0 : 1);
        const std::size_t size = row_.columns.size();
        const auto empty = std::ranges::find(row_.columns, std::string_view{});
        if (empty != row_.columns.end() || (row_.endsWithSeparator && size < std::max(expected_, layout_.count)))
            throwFileError(line.number, "the column is empty",
                           static_cast<std::size_t>(empty - row_.columns.begin()) + 1);
        if (layout_.count > 0 && size != layout_.count)
            throwFileError(line.number, "the row has " + std::to_string(size) + " columns, but the header names " +
                                            std::to_string(layout_.count));
        if (size < kRadius)
            throwFileError(line.number, "a point has " + std::to_string(size) + " coordinates; four are needed");
        if (size > most)
            throwFileError(line.number, quoted(row_.columns[most]) + " follows a point's " +
                                            (most == kRadius ? "four coordinates" : "radius") +
                                            "; a header x y z w says which columns to read");
        if (expected_ == 0) expected_ = size;
        PointRow point;
        point.line = line.number;
        for (std::size_t i = 0; i < kRadius; ++i) {
            const std::size_t at = layout_.columns[i].value_or(i);
            const Coordinate& read = number(line, at, readers_[i]);
            point.point[static_cast<int>(i)] = read.value;
            point.numbers[i] = read.text;
        }
        const std::optional<std::size_t> radius = layout_.count > 0 ? layout_.columns[kRadius]
                                                  : size > kRadius  ? std::optional(kRadius)
                                                                    : std::nullopt;
        if (radius) {
            point.radius = number(line, *radius, readers_[kRadius]).value;
            if (point.radius < 0) throwFileError(line.number, "a radius is negative", *radius + 1);
            if (layout_.count == 0 && !std::exchange(warnedOfRadius_, true))
                warnings_.emplace_back("the fifth column was read as radius");
        }
        add_(point);
    }

    Coordinate number(const Line& line, std::size_t column, NumberReader& reader) const {
        Coordinate read = reader.read(row_.columns[column], dialect_.mark);
        if (!read.fault.empty())
            throwFileError(line.number, quoted(row_.columns[column]) + ' ' + read.fault, column + 1);
        return read;
    }

    Lines lines_;
    const Dialect dialect_;
    const Radii radii_;
    const std::function<void(const PointRow&)>& add_;
    Layout layout_;
    Row row_;
    std::array<NumberReader, kRadius + 1> readers_;
    std::size_t expected_ = 0;  // the number of columns of the first row; 0 before it
    bool warnedOfRadius_ = false;
    std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> readPoints(std::string_view text, Radii radii, const std::function<void(const PointRow&)>& add,
                                    std::size_t firstLine) {
    return PointReader(text, radii, add, firstLine).read();
}

}  // namespace oval4d::text_files
