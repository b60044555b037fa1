#include "slicing/coordinate_value_histograms.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fields/field.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::slicing {
namespace {

constexpr int kRows = CoordinateValueHistograms::kRows, kPanel = CoordinateValueHistograms::kPanel;
const fields::Box kCube{glm::dvec4(-1), glm::dvec4(1)};

CoordinateValueHistograms histogramOf(const fields::Field& field, const geometry::Rotation& orientation = {},
                                      const std::vector<double>& levels = {}) {
    CoordinateValueHistograms histogram;
    histogram.compute(field, orientation, levels);
    return histogram;
}

double weightAt(const CoordinateValueHistograms& histogram, int row, int axis, int column) {
    return histogram.weights()[CoordinateValueHistograms::index(row, axis, column)];
}

/// Returns, for each row of the panel of `axis`, the sum of its weights.
std::vector<double> valuesAlong(const CoordinateValueHistograms& histogram, int axis) {
    std::vector<double> sums(kRows, 0.0);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kPanel; ++column)
            sums[static_cast<std::size_t>(row)] += weightAt(histogram, row, axis, column);
    return sums;
}

/// Returns the value of the field that the middle of a row stands for.
double valueOf(const CoordinateValueHistograms& histogram, int row) {
    const auto [least, greatest] = histogram.valueRange();
    return greatest - row * (greatest - least) / (kRows - 1);
}

/// Returns the coordinate along `axis` that the middle of a column stands for.
double coordinateOf(const CoordinateValueHistograms& histogram, int axis, int column) {
    return histogram.reach()[static_cast<std::size_t>(axis)] * (2.0 * column / (kPanel - 1) - 1);
}

void expectRidge(const CoordinateValueHistograms& histogram, int axis) {
    for (int column = 0; column < kPanel; ++column) {
        double inside = 0;
        for (int row = 0; row < kRows; ++row) {
            const double apart = coordinateOf(histogram, axis, column) - valueOf(histogram, row);
            const double weight = weightAt(histogram, row, axis, column);
            if (std::abs(apart) > 0.06) {
                EXPECT_EQ(weight, 0) << row << ' ' << column;
            }
            inside += weight;
        }
        EXPECT_GT(inside, 0) << column;
    }
}

TEST(CoordinateValueHistograms, OfACoordinateIsADiagonalAndUniformAlongTheOthers) {
    const fields::Field field = testField([](const glm::dvec4& p) { return p.x; }, 1, kCube);
    const CoordinateValueHistograms histogram = histogramOf(field);
    EXPECT_NEAR(histogram.valueRange().least, -1, 1e-3);
    EXPECT_NEAR(histogram.valueRange().greatest, 1, 1e-3);
    EXPECT_EQ(histogram.countedPoints(), CoordinateValueHistograms::kMaxPoints);
    expectRidge(histogram, 0);
    const double mean = double(CoordinateValueHistograms::kPointWeight) *
                        static_cast<double>(histogram.countedPoints()) / ((kRows - 1) * (kPanel - 1));
    for (int axis = 1; axis < 4; ++axis) {
        for (int row = 1; row < kRows - 1; ++row)
            for (int column = 1; column < kPanel - 1; ++column)
                EXPECT_NEAR(weightAt(histogram, row, axis, column) / mean, 1, 0.35)
                    << axis << ' ' << row << ' ' << column;
    }
}

TEST(CoordinateValueHistograms, TurnsWithTheField) {
    const fields::Field field = testField([](const glm::dvec4& p) { return p.x; }, 1, kCube);
    const geometry::Rotation quarter(geometry::RotationAngles{geometry::Plane::xw, std::numbers::pi / 2, {}});
    expectRidge(histogramOf(field, quarter), 3);
    // An eighth of a turn shows the cube from an edge.
    const geometry::Rotation eighth(geometry::RotationAngles{geometry::Plane::xy, std::numbers::pi / 4, {}});
    const CoordinateValueHistograms turned = histogramOf(field, eighth);
    EXPECT_NEAR(turned.reach()[0], std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.reach()[2], 1, 1e-12);
}

// The histogram of the distance from the origin counts the volumes of balls. The ball of radius r has the volume π² r⁴
// / 2. No point at the distance r from the origin has a coordinate greater than r.
TEST(CoordinateValueHistograms, OfTheDistanceCountsTheVolumesOfBalls) {
    const fields::Field field = testField([](const glm::dvec4& p) { return glm::length(p); }, 1, kCube);
    std::mt19937 random(31);
    for (const geometry::Rotation& orientation : {geometry::Rotation(), support::randomRotation(random)}) {
        const CoordinateValueHistograms histogram = histogramOf(field, orientation);
        for (int axis = 0; axis < 4; ++axis) {
            const std::vector<double> sums = valuesAlong(histogram, axis);
            const double all = std::accumulate(sums.begin(), sums.end(), 0.0);
            double inside = 0;
            for (int row = kRows - 1; row >= 0; --row) {
                const double radius = valueOf(histogram, row);
                for (int column = 0; column < kPanel; ++column) {
                    if (std::abs(coordinateOf(histogram, axis, column)) <= radius + 0.1) continue;
                    EXPECT_EQ(weightAt(histogram, row, axis, column), 0) << radius << ' ' << column;
                }
                // `edge` is the distance that the upper edge of the row stands for.
                inside += sums[static_cast<std::size_t>(row)];
                const double edge = row > 0 ? (radius + valueOf(histogram, row - 1)) / 2 : radius;
                if (edge > 1) continue;
                const double expected = std::pow(std::numbers::pi * edge * edge, 2) / 2 / 16;
                EXPECT_NEAR(inside / all, expected, 0.003) << edge;
            }
        }
    }
}

TEST(CoordinateValueHistograms, KeepsItsTotalsUnderRotation) {
    const fields::Field field = testField([](const glm::dvec4& p) { return std::sin(3 * p.x) * p.y + p.z * p.w; }, 4,
                                          {glm::dvec4(-1, 0, 2, -3), glm::dvec4(1, 0.5, 5, 1)});
    const CoordinateValueHistograms straight = histogramOf(field);
    const std::vector<double> values = valuesAlong(straight, 0);
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0.0),
              double(CoordinateValueHistograms::kPointWeight) * static_cast<double>(straight.countedPoints()));
    std::mt19937 random(32);
    CoordinateValueHistograms histogram;  // the same object measures all fields, one after another
    for (int trial = 0; trial < 5; ++trial) {
        histogram.compute(field, support::randomRotation(random), {});
        EXPECT_EQ(histogram.valueRange(), straight.valueRange());
        for (int axis = 0; axis < 4; ++axis) EXPECT_EQ(valuesAlong(histogram, axis), values);
    }
}

// A histogram shows the domain in its frame of reference. If a unit of time is worth two units of space, the domain is
// twice as long along w, and has the same values.
TEST(CoordinateValueHistograms, ShowsTheDomainInAFrameOfReference) {
    const fields::Field field = testField([](const glm::dvec4& p) { return p.w; }, 1, kCube);
    const CoordinateValueHistograms longer = histogramOf(fields::transformedTo(field, {.pace = 2}, 71));
    EXPECT_NEAR(longer.reach()[3], 2, 1e-12);
    EXPECT_NEAR(longer.reach()[0], 1, 1e-12);
    EXPECT_EQ(valuesAlong(longer, 3), valuesAlong(histogramOf(field), 3));
    // In the sheared frame, x' = x − w / 2 extends from −1.5 to 1.5, and differs from −w / 2 by at most 1.
    const CoordinateValueHistograms sheared = histogramOf(fields::transformedTo(field, {.follow = {0.5, 0, 0}}, 72));
    EXPECT_NEAR(sheared.reach()[0], 1.5, 1e-12);
    for (int column = 0; column < kPanel; ++column) {
        for (int row = 0; row < kRows; ++row) {
            if (weightAt(sheared, row, 0, column) == 0) continue;
            EXPECT_LE(std::abs(coordinateOf(sheared, 0, column) + valueOf(sheared, row) / 2), 1.06);
        }
    }
}

TEST(CoordinateValueHistograms, LeavesOutWhatIsNearAPoleUnlessALevelIsThere) {
    const fields::Field field = testField([](const glm::dvec4& p) { return 1 / p.x; }, NAN, kCube);
    const CoordinateValueHistograms usual = histogramOf(field);
    EXPECT_LT(usual.valueRange().greatest, 150);
    EXPECT_LT(usual.countedPoints(), CoordinateValueHistograms::kMaxPoints);
    EXPECT_GT(usual.countedPoints(), 0.95 * CoordinateValueHistograms::kMaxPoints);
    EXPECT_EQ(histogramOf(field, {}, {1000}).valueRange().greatest, 1000);
    EXPECT_EQ(histogramOf(field, {}, {1e30}).valueRange(), usual.valueRange()) << "no value is so large";
}

TEST(CoordinateValueHistograms, ShowsConstantsAndNothing) {
    const CoordinateValueHistograms constant = histogramOf(testField([](const glm::dvec4&) { return 5; }, 0, kCube));
    EXPECT_LT(constant.valueRange().least, 5);
    EXPECT_EQ(valuesAlong(constant, 2)[kRows / 2], double(CoordinateValueHistograms::kPointWeight) *
                                                       static_cast<double>(CoordinateValueHistograms::kMaxPoints));
    const CoordinateValueHistograms nothing =
        histogramOf(testField([](const glm::dvec4&) { return std::numeric_limits<double>::quiet_NaN(); }, NAN, kCube));
    EXPECT_EQ(nothing.countedPoints(), 0U);
    for (const std::uint8_t tone : nothing.tones()) ASSERT_EQ(tone, 0);
}

TEST(CoordinateValueHistograms, HasTonesThatGrowWithTheWeights) {
    const CoordinateValueHistograms histogram =
        histogramOf(testField([](const glm::dvec4& p) { return p.x * p.y; }, 2, kCube));
    const auto most = *std::ranges::max_element(histogram.weights());
    for (std::size_t i = 0; i < histogram.tones().size(); ++i) {
        const double expected = 255 * std::cbrt(double(histogram.weights()[i]) / most);
        EXPECT_NEAR(histogram.tones()[i], expected, 0.51);
    }
}

}  // namespace
}  // namespace oval4d::slicing
