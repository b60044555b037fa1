#include "slicing/coordinate_value_histograms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "fields/field.hpp"

namespace oval4d::slicing {

namespace {

using fields::UnitCubePoints;
using fields::writeQuasirandomPoints;

constexpr std::size_t kHistogramBatch = fields::kQuasirandomPoints;
static_assert(CoordinateValueHistograms::kMinPoints % kHistogramBatch == 0);
constexpr std::uint8_t kNoRow = 255;
static_assert(CoordinateValueHistograms::kRows < kNoRow);

// Returns the number of points at which `function` is evaluated. A slower function is evaluated at fewer points, so
// that the evaluation always takes about the same time.
std::size_t histogramPointCount(const fields::ScalarFunction& function) {
    constexpr double kTime = 2e7;  // the intended time for all evaluations of the function, in nanoseconds
    const double count = kTime / std::max(function.cost().value, 1.0);
    constexpr auto kLeast = static_cast<double>(CoordinateValueHistograms::kMinPoints);
    constexpr auto kMost = static_cast<double>(CoordinateValueHistograms::kMaxPoints);
    return static_cast<std::size_t>(std::clamp(count, kLeast, kMost)) / kHistogramBatch * kHistogramBatch;
}

}  // namespace

void CoordinateValueHistograms::compute(const fields::Field& field, const geometry::Rotation& orientation,
                                        std::span<const double> levels) {
    if (function_.lock() != field.function || !(box_ == field.box)) sampleField(field);
    chooseRange(levels);
    countValues(field, orientation);
    computeTones();
}

// Evaluates the function of `field` at quasirandom points, and sets fullRange_ and typicalRange_ to the ranges of its
// values.
void CoordinateValueHistograms::sampleField(const fields::Field& field) {
    // The length of each side of the domain, in steps of ScalarFunction::downsampledForSteps().
    constexpr double kResolution = 128;
    const glm::dvec4 size = field.box.max - field.box.min;
    std::array<glm::dvec4, 4> steps{};
    for (int k = 0; k < 4; ++k) steps[static_cast<std::size_t>(k)][k] = size[k] / kResolution;
    const fields::ScalarFunction& function = field.function->downsampledForSteps(steps);
    values_.resize(histogramPointCount(function));
    UnitCubePoints points;
    for (std::size_t first = 0; first < values_.size(); first += kHistogramBatch) {
        writeQuasirandomPoints(first, points);
        for (int k = 0; k < 4; ++k)
            for (float& u : points[static_cast<std::size_t>(k)]) u = static_cast<float>(field.box.min[k] + u * size[k]);
        function.evaluate({points[0], points[1], points[2], points[3]},
                          std::span(values_).subspan(first, kHistogramBatch));
    }
    function_ = field.function;
    box_ = field.box;
    // NaN equals no number. So chooseRange() will find that the range has changed, and will call assignPointsToRows().
    range_ = {std::numeric_limits<double>::quiet_NaN(), 0};

    const fields::FullAndTypicalRange ranges = fields::fullAndTypicalRange(values_);
    fullRange_ = ranges.full;
    typicalRange_ = ranges.typical;
}

void CoordinateValueHistograms::chooseRange(std::span<const double> levels) {
    Range range = typicalRange_;
    for (const double level : levels) {
        if (level < fullRange_.least || level > fullRange_.greatest) continue;
        range = {std::min(range.least, level), std::max(range.greatest, level)};
    }
    if (!(range.least < range.greatest)) {
        // All values are equal, for example those of a constant function. The range extends equally far below and above
        // this value, so that the middle row stands for it.
        const double reach = std::max(std::abs(range.least), 1.0);
        range = {range.least - reach, range.least + reach};
    }
    if (range == range_) return;
    range_ = range;
    assignPointsToRows();
}

void CoordinateValueHistograms::assignPointsToRows() {
    const double scale = (kRows - 1) / (range_.greatest - range_.least);
    rowOf_.resize(values_.size());
    countedPoints_ = 0;
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const double value = values_[i];
        const bool isInside = value >= range_.least && value <= range_.greatest;  // false if the value is NaN
        rowOf_[i] = isInside ? static_cast<std::uint8_t>(std::lround((range_.greatest - value) * scale)) : kNoRow;
        countedPoints_ += isInside ? 1 : 0;
    }
}

void CoordinateValueHistograms::countValues(const fields::Field& field, const geometry::Rotation& orientation) {
    // The next two loops complete toSteps. It then maps the unit cube, centered at the origin, to the rotated domain.
    // The unit along each axis is 1 / kPointWeight of a column, so that the domain extends from −kReach to +kReach.
    constexpr float kReach = (kPanel - 1) * kPointWeight / 2.0F;
    glm::dmat4 toSteps = orientation.matrix() * glm::inverse(field.toFunction);
    for (int j = 0; j < 4; ++j) toSteps[j] *= field.box.max[j] - field.box.min[j];
    for (int k = 0; k < 4; ++k) {
        double& reach = reach_[static_cast<std::size_t>(k)];
        reach = 0;
        for (int j = 0; j < 4; ++j) reach += std::abs(toSteps[j][k]) / 2;
        for (int j = 0; j < 4; ++j) toSteps[j][k] *= kReach / reach;
    }
    const glm::mat4 m(toSteps);
    weights_.assign(static_cast<std::size_t>(kRows) * kColumns, 0);
    UnitCubePoints points;
    std::array<std::int32_t, kHistogramBatch> steps;
    for (std::size_t first = 0; first < values_.size(); first += kHistogramBatch) {
        writeQuasirandomPoints(first, points);
        const std::uint8_t* rows = rowOf_.data() + first;
        for (int k = 0; k < 4; ++k) {
            const float x = m[0][k], y = m[1][k], z = m[2][k], w = m[3][k];
            const float middle = kReach + 0.5F - (x + y + z + w) / 2;
            for (std::size_t i = 0; i < kHistogramBatch; ++i) {
                const float at = middle + x * points[0][i] + y * points[1][i] + z * points[2][i] + w * points[3][i];
                steps[i] = static_cast<std::int32_t>(std::clamp(at, 0.5F, 2 * kReach + 0.5F));
            }
            for (std::size_t i = 0; i < kHistogramBatch; ++i) {
                if (rows[i] == kNoRow) continue;
                const auto step = static_cast<std::uint32_t>(steps[i]), beyond = step % kPointWeight;
                std::uint32_t* weight = &weights_[index(rows[i], k, static_cast<int>(step / kPointWeight))];
                weight[0] += kPointWeight - beyond;
                if (beyond > 0) weight[1] += beyond;
            }
        }
    }
}

void CoordinateValueHistograms::computeTones() {
    tones_.resize(weights_.size());
    const std::uint32_t most = *std::ranges::max_element(weights_);
    const float unit = most > 0 ? 255.0F / std::cbrt(static_cast<float>(most)) : 0;
    std::ranges::transform(weights_, tones_.begin(), [unit](std::uint32_t weight) {
        return static_cast<std::uint8_t>(std::lround(unit * std::cbrt(static_cast<float>(weight))));
    });
}

}  // namespace oval4d::slicing
