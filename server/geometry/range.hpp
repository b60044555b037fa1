#pragma once
// Ranges of numbers.

namespace oval4d::geometry {

/// The numbers from `least` to `most`, both included.
struct Range {
    double least, most;

    /// Returns whether a number is in the range. NaN is in no range.
    constexpr bool contains(double value) const { return value >= least && value <= most; }
};

}  // namespace oval4d::geometry
