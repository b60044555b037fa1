#pragma once
// Splits text files of numbers into words, and parses the numbers.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "polytopes/import/import.hpp"

namespace oval4d::polytopes {

/// The largest absolute value of a coordinate that is accepted.
inline constexpr double kMaxCoordinate = 1e14;

/// Throws an ImportError with this line and reason. `line` counts from 1; it is 0 if no single line is the cause.
[[noreturn]] void throwImportError(std::size_t line, std::string reason);

/// Splits a text into words separated by white space. Skips comments, which extend from # to the end of the line, and a
/// UTF-8 byte order mark at the start. If `commas` is true, commas and semicolons also separate words. The text must
/// outlive the tokenizer and the words.
class FileTokenizer {
  public:
    explicit FileTokenizer(std::string_view text, bool commas = false);

    /// Returns the line of the word read last, counted from 1.
    std::size_t line() const { return line_; }

    /// Returns the next word, on this or a later line; empty at the end of the text.
    std::string_view next();

    /// Returns the next word on the current line; empty at the end of the line.
    std::string_view nextOnLine();

    /// Skips the rest of the current line. nextOnLine() then returns an empty word; next() reads the next line.
    void skipLine();

  private:
    // CR LF is one line end, since CR is a blank. A lone CR, the line end of classic Mac OS, is not supported.
    static bool isBreak(char c) { return c == '\n'; }
    bool isBlank(char c) const;
    std::string_view word();

    std::string_view text_;
    bool commas_;
    std::size_t at_ = 0, line_ = 1;
};

/// Returns the word in quotes, for a message. Truncates it after 24 bytes, and replaces each blank, control character
/// and non-ASCII byte by '?'.
std::string inQuotes(std::string_view word);

/// Parses an integer from 0 to 2³² − 1. Throws an ImportError if the word is not such an integer, or is empty (at the
/// end of the file). `what` describes the expected word in the error message, such as "a number of vertices".
std::uint32_t parseCount(std::string_view word, std::size_t line, const std::string& what);

/// Parses a coordinate into `value`. Returns false if the word is not a number within ±kMaxCoordinate; `value` may then
/// have changed.
bool tryParseCoordinate(std::string_view word, double& value);

/// Parses and returns a coordinate. Throws an ImportError with this line if the word is not a number within
/// ±kMaxCoordinate, or is empty (at the end of the file).
double parseCoordinate(std::string_view word, std::size_t line);

}  // namespace oval4d::polytopes
