#pragma once
// Ranges of numbers.

#include <limits>

namespace oval4d::geometry {

/// A range of numbers from `least` to `most`, both included.
struct NumberRange {
    double least, most;

    /// Returns whether a number is in the range. NaN is in no range.
    constexpr bool contains(double value) const { return value >= least && value <= most; }

    /// Returns the numbers whose absolute value is at most `most`.
    static constexpr NumberRange ofAbsoluteValuesUpTo(double most) { return {-most, most}; }
    /// Returns the positive normal numbers (the positive numbers except the subnormal ones) that are at most `most`.
    static constexpr NumberRange positiveUpTo(double most) { return {std::numeric_limits<double>::min(), most}; }
    /// Returns the finite numbers.
    static constexpr NumberRange ofFiniteNumbers() { return ofAbsoluteValuesUpTo(std::numeric_limits<double>::max()); }
};

}  // namespace oval4d::geometry
