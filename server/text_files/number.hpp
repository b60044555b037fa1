#pragma once
// Reads numbers in the forms in which programs and people write them in text files.

#include <string>
#include <string_view>

namespace oval4d::text_files {

/// The largest absolute value of a coordinate that is accepted.
inline constexpr double kMaxCoordinate = 1e14;

/// The character that separates the decimals of a number from its integer part.
enum class DecimalMark : char { point = '.', comma = ',' };

/// The result of reading a word as a coordinate.
struct ParsedCoordinate {
    double value = 0;
    /// The number in the form that std::from_chars() reads: a decimal point, the exponent e, no plus sign, and a hyphen
    /// as minus sign. Empty if the word is not a coordinate.
    std::string_view text;
    std::string fault;  ///< why the word is not a coordinate, such as "is not a number"; empty if it is one
};

/// Reads coordinates, which are numbers within ±kMaxCoordinate. The reader keeps the text of the last coordinate that
/// it has read; ParsedCoordinate::text refers to this text.
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

/// Returns whether a word is a number. Numbers that CoordinateReader refuses as coordinates count, too: "nan", "1e20"
/// and, even if `mark` is a point, "0,5" are numbers; "2theta" is not.
bool isNumber(std::string_view word, DecimalMark mark = DecimalMark::point);

/// Returns whether a word begins with a digit, after a sign or a decimal mark if there is one, as "2theta" and "-.5"
/// do. Returns true for words such as "nan" and "-inf", too.
bool beginsLikeANumber(std::string_view word);

}  // namespace oval4d::text_files
