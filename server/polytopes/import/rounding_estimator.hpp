#pragma once
// An estimate of the precision with which the numbers in a text file are written.

#include <limits>
#include <string_view>

#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// Infers from the digits of the coordinates in a file how they were rounded. Programs write numbers with a fixed
/// number of decimals or a fixed number of significant digits, and may omit trailing zeros. Therefore the unit of the
/// last digit, which may be an omitted zero, is estimated in two ways: from the maximum number of decimals in the file,
/// and from the maximum number of significant digits. The larger estimate is used.
///
/// Single-precision numbers (IEEE 754 binary32) are often written with more digits than they have, such as 0.1 as
/// 0.100000001. The coordinates count as rounded to single precision if two conditions are met. First, each coordinate
/// is at most half a unit of its last digit away from a single-precision number. Second, this is hardly a coincidence:
/// other decimals with as many digits would meet the first condition with a probability of at most 2⁻¹⁰. Coordinates
/// that are all whole numbers never count as rounded to single precision.
class RoundingEstimator {
  public:
    /// Adds a coordinate along `axis`, from 0 to 3. `word` is the text of the coordinate (see
    /// text_files::ParsedCoordinate::text); `value` is the number.
    void add(std::string_view word, int axis, double value);

    /// Returns the maximum rounding error of a coordinate along each axis: half the unit of the last digit. If the
    /// coordinates count as rounded to single precision, adds half the unit of the last bit of the largest coordinate.
    /// `size` is half the diagonal of the points' bounding box. If `size` is at most 400 units of the last digit,
    /// returns 0 for all axes: programs rarely round so coarsely, so coordinates such as 0.5 and 10.5 are probably
    /// exact.
    glm::dvec4 maxRoundingError(double size) const;

    /// Returns what maxRoundingError() returns for coordinates that do not count as exact.
    glm::dvec4 roundingErrorIfRounded() const;

    /// Returns whether every coordinate is written as an integer: without a decimal point and without an exponent.
    bool hasOnlyIntegers() const { return whole_; }

  private:
    glm::dvec4 lastDigitUnit() const;  // per axis: the unit of the last digit
    void updateFloat32Evidence(int lastPlace, int lastNonzeroPlace, int axis, double value);

    glm::dvec4 largest_{0};                            // per axis: the largest absolute value of a coordinate
    int digits_ = 0;                                   // the maximum number of significant digits
    int lastPlace_ = std::numeric_limits<int>::max();  // the least exponent of ten of the last digit of a coordinate
    bool whole_ = true;
    bool single_ = true;         // whether each coordinate is the rounding of a single-precision number
    glm::dvec4 fromSingle_{0};   // per axis: the largest distance of a coordinate from a single-precision number
    double singleEvidence_ = 0;  // −log₂ of the probability that random decimals with as many digits would be as near
                                 // to single-precision numbers
};

}  // namespace oval4d::polytopes
