#pragma once
// Reads numbers in the forms in which programs and people write them in text files.

#include <string>
#include <string_view>

namespace oval4d::text_files {

/// The largest absolute value of a coordinate that is accepted.
inline constexpr double kMaxCoordinate = 1e14;

/// The character before the decimals of a number.
enum class DecimalMark : char { point = '.', comma = ',' };

/// A coordinate that was read from a text.
struct ParsedCoordinate {
    double value = 0;
    /// The number in the form that std::from_chars() reads: a decimal point, the exponent e, no plus sign, and a hyphen
    /// as minus sign. Empty if the word is not a coordinate.
    std::string_view text;
    std::string fault;  ///< why the word is not a coordinate, such as "is not a number"; empty if it is one
};

/// Reads coordinates, which are numbers within ±kMaxCoordinate. An object holds the text of the coordinate that it read
/// last, to which ParsedCoordinate::text refers.
class CoordinateReader {
  public:
    /// Reads a word as a coordinate. Accepts a true minus sign (U+2212), the exponent letter D of Fortran, and numbers
    /// that are too small for a double, which become 0. A decimal point is always accepted, a decimal comma only if
    /// `mark` is DecimalMark::comma, but never both in one number. The result's `text` remains valid until the next
    /// call.
    ParsedCoordinate read(std::string_view word, DecimalMark mark = DecimalMark::point);

  private:
    std::string text_;
};

/// Returns whether a word is a number, even if CoordinateReader refuses it: "nan", "1e20" and "0,5" are numbers,
/// "2theta" is none.
bool isNumber(std::string_view word, DecimalMark mark = DecimalMark::point);

/// Returns whether a word begins as a number does, or is "nan" or "inf".
bool beginsLikeANumber(std::string_view word);

}  // namespace oval4d::text_files
