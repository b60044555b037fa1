#pragma once
// Splits text files into words, and parses whole numbers and coordinates.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "text_files/number.hpp"

namespace oval4d::text_files {

/// A tokenizer that splits a text into words at white space. Skips comments, which extend from # to the end of the
/// line. The text must be a result of decodePlainText(), and must outlive the tokenizer and the words.
class Tokenizer {
  public:
    explicit Tokenizer(std::string_view text) : text_(text) {}

    /// Returns the number of the line with the last word, counted from 1.
    std::size_t lineNumber() const { return line_; }

    /// Returns the next word, on the current or a later line. Returns an empty string at the end of the text.
    std::string_view nextWord();

    /// Returns the next word on the current line. Returns an empty string at the end of the line and before a comment.
    std::string_view nextWordOnLine();

    /// Skips the rest of the current line. Then nextWordOnLine() returns an empty string, and nextWord() continues on
    /// the next line.
    void skipLine();

    /// Puts the last `count` bytes of the last word back, so that these bytes are the next word.
    void putBack(std::size_t count) { at_ -= count; }

  private:
    std::string_view readWord();

    std::string_view text_;
    std::size_t at_ = 0, line_ = 1;
};

/// Parses an integer from 0 to 2³² − 1. Throws a FileError with this line if the word is not such an integer, or is
/// empty, which means the end of the file. `what` describes the expected word in the error message, such as "a number
/// of vertices".
std::uint32_t parseCount(std::string_view word, std::size_t line, const std::string& what);

/// Parses a coordinate (see CoordinateReader). Throws a FileError with this line if the word is not a coordinate, or is
/// empty, which means the end of the file.
double parseCoordinate(std::string_view word, std::size_t line);

}  // namespace oval4d::text_files
