#include "text_files/table_row.hpp"

#include <algorithm>
#include <string>

#include "text/words.hpp"

namespace oval4d::text_files {

namespace {

constexpr std::size_t kMinColumns = 4;  // the coordinates of a point

// Returns the position of the first separator at or after `start`, or the end of the line.
std::size_t endOfColumn(std::string_view line, char separator, std::size_t start) {
    const std::size_t end = separator == ' ' ? line.find_first_of(" \t", start) : line.find(separator, start);
    return std::min(end, line.size());
}

// Returns the content of a word in quotes without the blanks at its ends, and other words as they are.
std::string_view withoutQuotes(std::string_view word) {
    const bool inQuotes = word.size() > 1 && word.starts_with('"') && word.ends_with('"');
    return inQuotes ? text::trimmed(word.substr(1, word.size() - 2)) : word;
}

bool hasSeparatorInside(std::string_view line, char separator) {
    const std::size_t last = line.find_last_not_of(std::string_view(separator == ';' ? "; \t" : ", \t"));
    return last != std::string_view::npos && line.find(separator) < last;
}

// Returns whether tabs separate at least as many numbers as a point has. Otherwise, tabs and blanks are mixed.
bool hasColumnsBetweenTabs(std::string_view line, TableRow& row) {
    split(line, '\t', row);
    const auto filled = [](std::string_view column) { return !column.empty(); };
    return static_cast<std::size_t>(std::ranges::count_if(row.columns, filled)) >= kMinColumns;
}

// Returns whether a line is of words separated by blanks, some of which have a comma inside, but none at its ends.
bool hasDecimalCommas(std::string_view line, TableRow& row) {
    split(line, ' ', row);
    const auto inside = [](std::string_view word) { return word.find(',') != std::string_view::npos; };
    const auto atEnd = [](std::string_view word) { return word.starts_with(',') || word.ends_with(','); };
    return row.columns.size() >= kMinColumns && std::ranges::any_of(row.columns, inside) &&
           std::ranges::none_of(row.columns, atEnd);
}

}  // namespace

std::optional<TableLine> TableLines::next() {
    if (rest_.empty()) return {};
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view whole = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    const std::size_t hash = std::min(whole.find('#'), whole.size());
    return TableLine{number_++, whole.substr(0, hash), text::trimmed(whole.substr(std::min(hash + 1, whole.size())))};
}

TableFormat formatOf(TableLines lines) {
    bool semicolons = false, tabs = false, commas = false, decimalCommas = false;
    TableRow row;
    while (const auto line = lines.next()) {
        const std::size_t start = std::min(line->content.find_first_not_of(";,\"\t "), line->content.size());
        if (!beginsLikeANumber(line->content.substr(start))) continue;  // a header
        semicolons = semicolons || hasSeparatorInside(line->content, ';');
        tabs = tabs || hasColumnsBetweenTabs(line->content, row);
        commas = commas || hasSeparatorInside(line->content, ',');
        decimalCommas = decimalCommas || hasDecimalCommas(line->content, row);
    }
    if (semicolons) return {';', DecimalMark::comma};
    if (commas && !decimalCommas) return {','};
    return {tabs ? '\t' : ' ', decimalCommas ? DecimalMark::comma : DecimalMark::point};
}

void split(std::string_view line, char separator, TableRow& row) {
    row.columns.clear();
    const std::string separators = {separator, ' ', '\t'};
    std::string_view rest = line.substr(0, line.find_last_not_of(separators) + 1);
    row.endsWithSeparator = separator != ' ' && line.find(separator, rest.size()) != std::string_view::npos;
    while (!rest.empty()) {
        // The last character is neither a blank nor a separator, so each separator is followed by a further column.
        rest.remove_prefix(rest.find_first_not_of(separator == '\t' ? " " : " \t"));
        const std::size_t closingQuote = rest.starts_with('"') ? rest.find('"', 1) : std::string_view::npos;
        const bool inQuotes = closingQuote != std::string_view::npos;
        const std::size_t end = endOfColumn(rest, separator, inQuotes ? closingQuote : 0);
        row.columns.push_back(withoutQuotes(text::trimmed(rest.substr(0, end))));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
}

}  // namespace oval4d::text_files
