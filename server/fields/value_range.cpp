#include "fields/value_range.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace oval4d::fields {

// Coordinate j (0 … 3) of point n is the fractional part of 1/2 + n / g^(j + 1), where g, kRoot, is the real root of g⁵
// = g + 1. The coordinates are computed as 32-bit integers in units of 2⁻³². Their overflow removes the integer part.
void writeQuasirandomPoints(std::size_t first, UnitCubePoints& out) {
    constexpr double kRoot = 1.1673039782614187;
    double fraction = 1;
    for (std::array<float, kQuasirandomPoints>& axis : out) {
        fraction /= kRoot;
        const auto step = static_cast<std::uint32_t>(fraction * 0x1p32);
        const std::uint32_t start = 0x80000000U + step * static_cast<std::uint32_t>(first);
        for (std::uint32_t i = 0; i < kQuasirandomPoints; ++i)
            axis[i] = static_cast<float>(static_cast<std::int32_t>((start + step * i) >> 8U)) * 0x1p-24F;
    }
}

namespace {

// Returns the full and the typical range of the values. The typical range contains the middle 98 % of the values, and
// is extended at both ends by `margin` times its length, but not beyond the full range.
FullAndTypicalRange fullAndTypicalRangeWithMargin(std::span<const float> values, double margin) {
    std::vector<float> found;
    found.reserve(values.size());
    for (const float value : values)
        if (std::isfinite(value)) found.push_back(value);
    if (found.empty()) return {};
    const auto [least, greatest] = std::ranges::minmax(found);
    const ValueRange full{least, greatest};
    const auto rare = static_cast<std::ptrdiff_t>(found.size() / 100);
    const auto quantile = [&](std::ptrdiff_t i) {
        std::ranges::nth_element(found, found.begin() + i);
        return double(found[static_cast<std::size_t>(i)]);
    };
    const double low = quantile(rare), high = quantile(static_cast<std::ptrdiff_t>(found.size()) - 1 - rare);
    const double reach = margin * (high - low);
    return {full, {std::max(full.least, low - reach), std::min(full.greatest, high + reach)}};
}

}  // namespace

FullAndTypicalRange fullAndTypicalRange(std::span<const float> values) {
    return fullAndTypicalRangeWithMargin(values, 0.1);
}

const ValueRange& TypicalRangeOnBox::typicalRange() const {
    std::call_once(measured_, [&] {
        // There are from 1 to kMaxBatches batches after the first; the slower the function, the fewer.
        constexpr double kTime = 1e6;  // nanoseconds for all evaluations together
        constexpr std::size_t kMaxBatches = 8, kCorners = 81;
        const double batches = kTime / (static_cast<double>(kQuasirandomPoints) * function_->cost().value);
        const auto count = static_cast<std::size_t>(std::clamp(batches, 1.0, double{kMaxBatches}));
        std::vector<float> values((count + 1) * kQuasirandomPoints);
        // The step 0 asks for the function itself. However, an array that is too large for memory returns a selection
        // of its samples that is in memory.
        const ScalarFunction& function = function_->downsampledForSteps(std::array{glm::dvec4(0)});
        UnitCubePoints points;
        for (std::size_t batch = 0; batch <= count; ++batch) {
            writeQuasirandomPoints(batch * kQuasirandomPoints, points);
            // The first 81 points are the corners of the box, the midpoints of its edges, faces and cells, and its
            // center.
            for (std::size_t i = 0; batch == 0 && i < kCorners; ++i)
                for (std::size_t axis = 0, rest = i; axis < 4; ++axis, rest /= 3)
                    points[axis][i] = 0.5F * static_cast<float>(rest % 3);
            for (int axis = 0; axis < 4; ++axis) {
                const double size = box_.max[axis] - box_.min[axis];
                for (float& u : points[static_cast<std::size_t>(axis)])
                    u = static_cast<float>(box_.min[axis] + u * size);
            }
            function.evaluate({points[0], points[1], points[2], points[3]},
                              std::span(values).subspan(batch * kQuasirandomPoints, kQuasirandomPoints));
        }
        // Large, so that the range, which becomes a color scale, rarely excludes an extreme value.
        constexpr double kMargin = 0.5;
        range_ = fullAndTypicalRangeWithMargin(values, kMargin).typical;
    });
    return range_;
}

}  // namespace oval4d::fields
