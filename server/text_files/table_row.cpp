#include "text_files/table_row.hpp"

#include <algorithm>
#include <string>

#include "text/words.hpp"

namespace oval4d::text_files {

namespace {

constexpr std::size_t kMinColumns = 4;  // the least number of columns of a row: one for each coordinate

// Returns the position of the first separator at or after `start`, or the end of the line if there is none. If the
// separator is a blank, a tab separates columns, too.
std::size_t endOfColumn(std::string_view line, char separator, std::size_t start) {
    const std::size_t end = separator == ' ' ? line.find_first_of(" \t", start) : line.find(separator, start);
    return std::min(end, line.size());
}

// Returns the content of a word in quotes, without blanks at its ends. Returns other words unchanged.
std::string_view withoutQuotes(std::string_view word) {
    const bool inQuotes = word.size() > 1 && word.starts_with('"') && word.ends_with('"');
    return inQuotes ? text::trimmed(word.substr(1, word.size() - 2)) : word;
}

bool hasSeparatorInside(std::string_view line, char separator) {
    const std::size_t last = line.find_last_not_of(std::string_view(separator == ';' ? "; \t" : ", \t"));
    return last != std::string_view::npos && line.find(separator) < last;
}

// How many of the columns between the tabs of a line are not empty, and how many are numbers.
struct TabColumnCounts {
    std::size_t filled = 0;      // number of columns that are not empty
    std::size_t numbers = 0;     // number of columns that are numbers
    bool decimalCommas = false;  // whether a number has a decimal comma
};

TabColumnCounts countTabColumns(std::string_view line, SplitTableRow& row) {
    TabColumnCounts result;
    splitColumns(line, '\t', row);
    for (const std::string_view column : row.columns) {
        if (!column.empty()) ++result.filled;
        if (column.ends_with(',') || !isNumber(column, DecimalMark::comma)) continue;
        ++result.numbers;
        result.decimalCommas = result.decimalCommas || column.find(',') != std::string_view::npos;
    }
    return result;
}

// Splits a line into words at blanks and tabs, and returns whether a word has a decimal comma. Returns an empty
// optional if commas may separate the columns: if there are fewer than four words, or if a word has two commas, or
// begins or ends with a comma. Overwrites `row`.
std::optional<bool> hasDecimalCommas(std::string_view line, SplitTableRow& row) {
    splitColumns(line, ' ', row);
    if (row.columns.size() < kMinColumns) return {};
    bool any = false;
    for (const std::string_view word : row.columns) {
        const std::size_t comma = word.find(',');
        if (comma == std::string_view::npos) continue;
        if (comma == 0 || word.ends_with(',') || word.find(',', comma + 1) != std::string_view::npos) return {};
        any = any || beginsLikeANumber(word);
    }
    return any;
}

// Returns whether a line is a row of a table, and not a header or a title. A row begins with a number, or has at least
// `least` numbers and at least as many numbers as other words.
bool isTableRow(std::string_view line, std::size_t least) {
    constexpr std::string_view kBetween = ";,\t \"";
    std::size_t numbers = 0, others = 0;
    for (std::size_t start = 0; (start = line.find_first_not_of(kBetween, start)) != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kBetween, start), line.size());
        if (isNumber(line.substr(start, end - start))) {
            ++numbers;
        } else {
            ++others;
        }
        if (numbers == 1 && others == 0) return true;
        start = end;
    }
    return numbers >= least && numbers >= others;
}

// Returns the line with the letter a in place of each quoted text that is not a number. Such texts may contain
// separators. The result is a view into `line` or `memory`.
std::string_view withoutTexts(std::string_view line, std::string& memory) {
    std::size_t open = line.find('"');
    if (open == std::string_view::npos) return line;
    memory.clear();
    while (open != std::string_view::npos) {
        const std::size_t close = line.find('"', open + 1);
        if (close == std::string_view::npos) break;
        memory += line.substr(0, open);
        const std::string_view word = line.substr(open, close + 1 - open);
        if (isNumber(withoutQuotes(word), DecimalMark::comma)) {
            memory += word;
        } else {
            memory += 'a';
        }
        line.remove_prefix(close + 1);
        open = line.find('"');
    }
    memory += line;
    return memory;
}

// Returns the format that fits all lines for which isTableRow(line, least) is true. Returns an empty optional if there
// are no such lines.
std::optional<TableFormat> formatOfRows(TableLines lines, std::size_t least) {
    bool semicolons = false, tabs = false, commas = false, decimalCommas = false, any = false;
    SplitTableRow row;
    std::string memory;
    while (const auto line = lines.nextLine()) {
        const std::string_view content = withoutTexts(line->content, memory);
        if (!isTableRow(content, least)) continue;
        any = true;
        const TabColumnCounts between = countTabColumns(content, row);
        // If a row has fewer columns between tabs, its tabs may be used like blanks.
        tabs = tabs || between.filled >= kMinColumns;
        // With four numbers between tabs, only the tabs separate columns; semicolons and commas are parts of texts or
        // numbers.
        if (between.numbers >= kMinColumns) {
            decimalCommas = decimalCommas || between.decimalCommas;
            continue;
        }
        semicolons = semicolons || hasSeparatorInside(content, ';');
        const auto decimal = hasDecimalCommas(content, row);
        commas = commas || (!decimal && hasSeparatorInside(content, ','));
        decimalCommas = decimalCommas || decimal.value_or(false);
    }
    if (!any) return {};
    if (semicolons) return TableFormat{';', DecimalMark::comma};
    if (commas && !decimalCommas) return TableFormat{','};
    return TableFormat{tabs ? '\t' : ' ', decimalCommas ? DecimalMark::comma : DecimalMark::point};
}

}  // namespace

std::optional<TableLine> TableLines::nextLine() {
    if (rest_.empty()) return {};
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view whole = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    const bool isComment = text::trimmed(whole).starts_with('%');  // MATLAB files have such comments
    const std::size_t hash = std::min(isComment ? whole.find('%') : whole.find('#'), whole.size());
    return TableLine{number_++, whole.substr(0, hash), text::trimmed(whole.substr(std::min(hash + 1, whole.size())))};
}

TableFormat tableFormatOf(TableLines lines) {
    // A line with fewer numbers than a point has coordinates may be a title. So first, a line that begins with a text
    // counts as a row only if it has at least kMinColumns numbers. If no line is a row by this rule, half as many
    // numbers are enough.
    for (const std::size_t least : {kMinColumns, kMinColumns / 2}) {
        if (const auto format = formatOfRows(lines, least)) return *format;
    }
    return {};
}

void splitColumns(std::string_view line, char separator, SplitTableRow& row) {
    row.columns.clear();
    const std::string separators = {separator, ' ', '\t'};
    std::string_view rest = line.substr(0, line.find_last_not_of(separators) + 1);
    row.endsWithSeparator = separator != ' ' && line.find(separator, rest.size()) != std::string_view::npos;
    while (!rest.empty()) {
        // `rest` ends with neither a blank nor a separator, so another column follows each separator.
        rest.remove_prefix(rest.find_first_not_of(separator == '\t' ? " " : " \t"));
        const std::size_t closingQuote = rest.starts_with('"') ? rest.find('"', 1) : std::string_view::npos;
        const bool inQuotes = closingQuote != std::string_view::npos;
        const std::size_t end = endOfColumn(rest, separator, inQuotes ? closingQuote : 0);
        row.columns.push_back(withoutQuotes(text::trimmed(rest.substr(0, end))));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
}

}  // namespace oval4d::text_files
