#pragma once
// The precision of the numbers in a text file.

#include <limits>
#include <string_view>

#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// Infers from the digits of coordinates how they were rounded. Programs write numbers with a fixed number of decimals
/// or of significant digits and may omit trailing zeros. So the unit of a number's last digit is the larger of the two
/// units that follow from the maximum number of decimals and of significant digits in the file.
class WrittenPrecision {
  public:
    /// Adds a coordinate along axis 0 … 3, as text and as a number.
    void add(std::string_view word, int axis, double value);

    /// Returns the maximum rounding error of a coordinate along each axis: half the unit of the last digit. Returns 0,
    /// for exact coordinates, if `size`, half the diagonal of the points' bounding box, is so few units that rounding
    /// to them is implausible, as for 0.5 and 10.5.
    glm::dvec4 rounding(double size) const;

    /// Returns whether all coordinates are whole numbers, written without decimal point and exponent.
    bool whole() const { return whole_; }

  private:
    glm::dvec4 largest_{0};
    int digits_ = 0;                                   // the maximum number of significant digits
    int lastPlace_ = std::numeric_limits<int>::max();  // the least exponent of ten of any digit
    bool whole_ = true;
};

}  // namespace oval4d::polytopes
