#pragma once
// The precision with which the numbers in a text file are written.

#include <limits>
#include <string_view>

#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// Infers from the digits of coordinates how they were rounded. Programs write numbers with a fixed number of decimals
/// or a fixed number of significant digits, and may omit trailing zeros. Therefore, the maximum number of decimals in
/// the file gives one unit for the last digit of a number, and the maximum number of significant digits gives another
/// one; the larger of the two is taken.
class WrittenPrecision {
  public:
    /// Adds a coordinate along axis 0 … 3, as text and as a number.
    void add(std::string_view word, int axis, double value);

    /// Returns the maximum rounding error of a coordinate along each axis: half the unit of the last digit. Returns 0
    /// (the coordinates are exact) if the units are so coarse that the numbers were hardly rounded to them: if `size`,
    /// half the diagonal of the points' bounding box, is at most 400 units, as for coordinates such as 0.5 and 10.5.
    glm::dvec4 rounding(double size) const;

    /// Returns whether all coordinates are whole numbers that are written without decimal point and exponent.
    bool whole() const { return whole_; }

  private:
    glm::dvec4 largest_{0};
    int digits_ = 0;                                   // the maximum number of significant digits
    int lastPlace_ = std::numeric_limits<int>::max();  // the least power of ten that has a digit, as its exponent
    bool whole_ = true;
};

}  // namespace oval4d::polytopes
