#include "polytopes/import/file_tokenizer.hpp"

#include <charconv>
#include <cmath>
#include <utility>

namespace oval4d::polytopes {

void throwImportError(std::size_t line, std::string reason) { throw ImportError{line, std::move(reason)}; }

FileTokenizer::FileTokenizer(std::string_view text, bool commas) : text_(text), commas_(commas) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
}

std::string_view FileTokenizer::next() {
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '#') {
            skipLine();
            if (at_ == text_.size()) break;
        }
        if (isBreak(text_[at_])) {
            ++line_;
        } else if (!isBlank(text_[at_])) {
            return word();
        }
    }
    return {};
}

std::string_view FileTokenizer::nextOnLine() {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
    if (at_ == text_.size() || isBreak(text_[at_]) || text_[at_] == '#') return {};
    return word();
}

void FileTokenizer::skipLine() {
    while (at_ < text_.size() && !isBreak(text_[at_])) ++at_;
}

bool FileTokenizer::isBlank(char c) const {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || (commas_ && (c == ',' || c == ';'));
}

std::string_view FileTokenizer::word() {
    const std::size_t start = at_;
    while (at_ < text_.size() && !isBreak(text_[at_]) && !isBlank(text_[at_]) && text_[at_] != '#') ++at_;
    return text_.substr(start, at_ - start);
}

std::string inQuotes(std::string_view word) {
    constexpr std::size_t kLongest = 24;
    std::string text = "'";
    for (const char c : word.substr(0, kLongest)) text += c > ' ' && c < 0x7F ? c : '?';
    return text + (word.size() > kLongest ? "…'" : "'");
}

std::uint32_t parseCount(std::string_view word, std::size_t line, const std::string& what) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty()) throwImportError(line, "the file ends where " + what + " is expected");
    if (error != std::errc{} || end != word.data() + word.size())
        throwImportError(line, inQuotes(word) + " is not " + what);
    return value;
}

bool tryParseCoordinate(std::string_view word, double& value) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range && word.find("e-") != std::string_view::npos) {
        value = 0;  // underflow
        return true;
    }
    return error == std::errc{} && end == word.data() + word.size() && std::abs(value) <= kMaxCoordinate;
}

double parseCoordinate(std::string_view word, std::size_t line) {
    double value = 0;
    if (word.empty()) throwImportError(line, "the file ends where a coordinate is expected");
    if (!tryParseCoordinate(word, value))
        throwImportError(line, inQuotes(word) + " is not a coordinate (a number within ±1e14)");
    return value;
}

}  // namespace oval4d::polytopes
