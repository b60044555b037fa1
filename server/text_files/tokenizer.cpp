#include "text_files/tokenizer.hpp"

#include <charconv>
#include <system_error>

#include "text/message_text.hpp"
#include "text_files/file_error.hpp"

namespace oval4d::text_files {

namespace {

// Returns whether a character separates the words of a line in a text from decodePlainText().
bool isBlank(char c) { return c == ' ' || c == '\t'; }

}  // namespace

std::string_view Tokenizer::nextWord() {
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '#') {
            skipLine();
            if (at_ == text_.size()) break;
        }
        if (text_[at_] == '\n') {
            ++line_;
        } else if (!isBlank(text_[at_])) {
            return readWord();
        }
    }
    return {};
}

std::string_view Tokenizer::nextWordOnLine() {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
    if (at_ == text_.size() || text_[at_] == '\n' || text_[at_] == '#') return {};
    return readWord();
}

void Tokenizer::skipLine() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
}

std::string_view Tokenizer::readWord() {
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && !isBlank(text_[at_]) && text_[at_] != '#') ++at_;
    return text_.substr(start, at_ - start);
}

std::uint32_t parseCount(std::string_view word, std::size_t line, const std::string& what) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty()) throwFileError(line, "the file ends where " + what + " is expected");
    if (error != std::errc{} || end != word.data() + word.size())
        throwFileError(line, text::inQuotes(word) + " is not " + what);
    return value;
}

double parseCoordinate(std::string_view word, std::size_t line) {
    if (word.empty()) throwFileError(line, "the file ends where a coordinate is expected");
    CoordinateReader reader;
    const ParsedCoordinate read = reader.read(word);
    if (!read.fault.empty()) throwFileError(line, text::inQuotes(word) + ' ' + read.fault);
    return read.value;
}

}  // namespace oval4d::text_files
