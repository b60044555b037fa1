#pragma once
// Reads numbers in the forms that programs and people use in text files.

#include <string>
#include <string_view>

namespace oval4d::text_files {

/// The largest absolute value of a coordinate that a file may contain.
inline constexpr double kMaxCoordinate = 1e14;

/// The character between the integer part of a number and its decimals.
enum class DecimalMark : char { point = '.', comma = ',' };

/// A coordinate read from a word, or the reason why the word is not a coordinate.
struct ParsedCoordinate {
    double value = 0;
    /// The number in the form for std::from_chars(): with a decimal point, the exponent e, no plus sign, and a hyphen
    /// as minus sign. Empty if the word is not a coordinate.
    std::string_view text;
    std::string fault;  ///< why the word is not a coordinate, such as "is not a number"; else empty
};

/// A reader of coordinates, which are numbers within ±kMaxCoordinate. Keeps the text of the last coordinate;
/// ParsedCoordinate::text refers to this text.
class CoordinateReader {
  public:
    /// Reads a word as a coordinate. Accepts the minus sign U+2212 and Fortran's exponent letter D. Numbers too small
    /// for a double become 0. Decimal points are always accepted, and decimal commas only if `mark` is
    /// DecimalMark::comma; a number with a comma and a point is an error. Errors are in ParsedCoordinate::fault. The
    /// `text` of the result is valid until the next call.
    ParsedCoordinate read(std::string_view word, DecimalMark mark = DecimalMark::point);

  private:
    std::string text_;
};

/// Returns whether a word is a number. Also returns true for numbers that CoordinateReader refuses, such as "nan",
/// "1e20" and, if `mark` is DecimalMark::point, "0,5". Returns false for "2theta".
bool isNumber(std::string_view word, DecimalMark mark = DecimalMark::point);

/// Returns whether a word begins like a number: with a digit, after an optional sign and decimal mark, as "2theta" and
/// "-.5" do. Returns true for words such as "nan" and "-inf", too.
bool beginsLikeANumber(std::string_view word);

}  // namespace oval4d::text_files
