#pragma once
// The precision with which the numbers in a text file are written.

#include <limits>
#include <string_view>

#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// Infers from the digits of the coordinates in a file how they were rounded. Programs write numbers with a fixed
/// number of decimals or a fixed number of significant digits, and may omit trailing zeros. Therefore the unit of the
/// last digit before trailing zeros were omitted is estimated in two ways: from the maximum number of decimals in the
/// file, and from the maximum number of significant digits. The larger estimate is used.
///
/// Single-precision numbers are often written with more digits than they have, such as 0.1 as 1.000000014901161194e-01.
/// If every coordinate is a single-precision number to the digits written, and some have more digits than a
/// single-precision number needs, all are taken as rounded to single precision (IEEE 754 binary32).
class WrittenPrecision {
  public:
    /// Adds a coordinate along axis 0 … 3, as text (see text_files::ParsedNumber::text) and as a number.
    void add(std::string_view word, int axis, double value);

    /// Returns the maximum rounding error of a coordinate along each axis: half the unit of the last digit, or of the
    /// last bit of the largest coordinate in single precision. `size` is
    /// half the diagonal of the points' bounding box. If it is at most 400 units of the last digit, the coordinates
    /// count as exact, and the result is 0 for all axes: programs hardly ever round so coarsely, so that coordinates
    /// such as 0.5 and 10.5 are probably exact.
    glm::dvec4 maxRoundingError(double size) const;

    /// Returns whether every coordinate is written as an integer: without a decimal point and without an exponent.
    bool whole() const { return whole_; }

  private:
    glm::dvec4 largest_{0};                            // per axis: the largest absolute value of a coordinate
    int digits_ = 0;                                   // the maximum number of significant digits
    int lastPlace_ = std::numeric_limits<int>::max();  // the least exponent of ten of any last digit
    bool whole_ = true;
    bool single_ = true;  // whether every coordinate is a single-precision number
};

}  // namespace oval4d::polytopes
