#pragma once
// The range of the values of a function on a box.

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "fields/scalar_function.hpp"

namespace oval4d::fields {

/// An interval of values, from `least` to `greatest`.
struct ValueRange {
    double least = 0, greatest = 1;
    bool operator==(const ValueRange&) const = default;
};

/// The number of points that writeQuasirandomPoints() writes.
inline constexpr std::size_t kQuasirandomPoints = 1024;

/// Points of the unit cube [0, 1)⁴ as a structure of arrays.
using UnitCubePoints = std::array<std::array<float, kQuasirandomPoints>, 4>;

/// Writes the points `first` … `first` + kQuasirandomPoints − 1 of a quasirandom sequence. The sequence is an additive
/// recurrence that fills the cube evenly (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
void writeQuasirandomPoints(std::size_t first, UnitCubePoints& out);

/// Two ranges of a set of values. `full` extends from the least to the greatest value. `typical` ignores outliers, such
/// as values near a pole: it contains the middle 98 % of the values, and is extended at both ends by a tenth of its
/// length, but not beyond `full`. For most functions, the two ranges are equal.
struct FullAndTypicalRange {
    ValueRange full, typical;
};

/// Returns the full and the typical range of the finite numbers in `values`. If no number is finite, both ranges are 0
/// … 1.
FullAndTypicalRange fullAndTypicalRange(std::span<const float> values);

/// The range of the values of a function on a box, without outliers. The range is like FullAndTypicalRange::typical,
/// but extended at both ends by half of its length instead of a tenth. The first call of typicalRange() computes the
/// range from 2,048 to 9,216 points of the box, among them its center, its corners, and the midpoints of its edges,
/// faces and cells. The range depends only on the function and the box. Thread-safe.
class TypicalRangeOnBox {
  public:
    TypicalRangeOnBox(std::shared_ptr<const ScalarFunction> function, const Box& box)
        : function_(std::move(function)), box_(box) {}

    const ValueRange& typicalRange() const;

  private:
    const std::shared_ptr<const ScalarFunction> function_;
    const Box box_;
    mutable std::once_flag measured_;
    mutable ValueRange range_;
};

}  // namespace oval4d::fields
