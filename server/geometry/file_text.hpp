#pragma once
// Files of numbers, read word by word.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "geometry/import.hpp"

namespace oval4d::geometry {

inline constexpr double kMaxCoordinate = 1e9;

/// Throws an ImportError.
[[noreturn]] void refuse(std::size_t line, std::string reason);

/// The text as words between blanks; a comment runs from # to the end of its line. With `commas`, commas and semicolons
/// are blanks too.
class FileText {
  public:
    explicit FileText(std::string_view text, bool commas = false);

    /// The line of the word read last, counted from 1.
    std::size_t line() const { return line_; }

    /// The next word, on whatever line; empty at the end.
    std::string_view next();

    /// The next word on the same line, or empty.
    std::string_view nextHere();

    void skipLine();

  private:
    // CR LF counts once: the CR is a blank. A lone CR, as old Macintosh files had it, is not a line end.
    static bool isBreak(char c) { return c == '\n'; }
    bool isBlank(char c) const;
    std::string_view word();

    std::string_view text_;
    bool commas_;
    std::size_t at_ = 0, line_ = 1;
};

/// The word in quotes, cut short, fit for a message.
std::string shown(std::string_view word);

/// A number from 0; `what` is what stands in the error if it is none: "a number of vertices".
std::uint32_t countFrom(std::string_view word, std::size_t line, const std::string& what);

/// Whether the word is a number within ± kMaxCoordinate, which then is `value`.
bool readCoordinate(std::string_view word, double& value);
double coordinateFrom(std::string_view word, std::size_t line);

}  // namespace oval4d::geometry
