#pragma once
// Splits text files into words, and parses whole numbers and coordinates.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "text_files/number.hpp"

namespace oval4d::text_files {

/// Splits a text into words at white space. Skips comments, which extend from # to the end of the line. The text must
/// be a result of plainText(), and must outlive the tokenizer and the words.
class Tokenizer {
  public:
    explicit Tokenizer(std::string_view text) : text_(text) {}

    /// Returns the number of the line of the word read last, counted from 1.
    std::size_t line() const { return line_; }

    /// Returns the next word, on this or a later line; empty at the end of the text.
    std::string_view next();

    /// Returns the next word on the current line; empty at the end of the line.
    std::string_view nextOnLine();

    /// Skips the rest of the current line. nextOnLine() then returns an empty word; next() reads the next line.
    void skipLine();

    /// Puts the last `count` bytes of the word that was read last back into the text, so that they are the next word.
    void putBack(std::size_t count) { at_ -= count; }

  private:
    std::string_view readWord();

    std::string_view text_;
    std::size_t at_ = 0, line_ = 1;
};

/// Parses an integer from 0 to 2³² − 1. Throws a FileError if the word is not such an integer, or is empty (at the end
/// of the file). `what` describes the expected word in the error message, such as "a number of vertices".
std::uint32_t parseCount(std::string_view word, std::size_t line, const std::string& what);

/// Parses and returns a coordinate. Throws a FileError with this line if the word is not one (see CoordinateReader), or
/// is empty (at the end of the file).
double parseCoordinate(std::string_view word, std::size_t line);

}  // namespace oval4d::text_files
