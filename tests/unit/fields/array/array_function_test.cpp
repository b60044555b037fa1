#include "fields/array/array_function.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/fields/array/random_arrays.hpp"

namespace oval4d::fields::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
const Box kBox{{-1, 0.5, -30, 1000}, {2, 0.75, 50, 1004}};

// Returns the product of the coordinates whose bits are set in `bits`. In the box, the coordinates range from 0 to 1.
double monomial(unsigned bits, const Box& box, const glm::dvec4& point) {
    const glm::dvec4 t = (point - box.min) / (box.max - box.min);
    double product = 1;
    for (glm::length_t i = 0; i < 4; ++i) product *= (bits >> static_cast<unsigned>(i) & 1U) != 0 ? t[i] : 1;
    return product;
}

ArrayFunction arrayOf(const Shape& shape, const Box& box, const std::function<double(glm::dvec4)>& f) {
    return {shape, box, SampleStorage(sampled(shape, box, f))};
}

TEST(ArrayFunction, EqualsEveryMultilinearFunctionWithItsGradient) {
    std::mt19937 random(1);
    for (const Shape& shape : {Shape{2, 2, 2, 2}, Shape{5, 6, 7, 8}, Shape{2, 9, 3, 17}}) {
        for (unsigned bits = 0; bits < 16; ++bits) {
            const auto f = [&](const glm::dvec4& point) { return monomial(bits, kBox, point); };
            const ArrayFunction array = arrayOf(shape, kBox, f);
            Points points = randomPoints(kBox, 203, random);  // the number of points is not a multiple of 8
            array.evaluateWithGradient(points.batch(), points.values, points.gradients());
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_NEAR(points.values[i], f(points[i]), 1e-5);
                for (glm::length_t axis = 0; axis < 4; ++axis) {
                    const bool varies = (bits >> static_cast<unsigned>(axis) & 1U) != 0;
                    const double length = kBox.max[axis] - kBox.min[axis];
                    const unsigned rest = bits & ~(1U << static_cast<unsigned>(axis));
                    const double slope = varies ? monomial(rest, kBox, points[i]) / length : 0;
                    EXPECT_NEAR(points.gradient(i)[axis] * length, slope * length, 1e-4);
                }
            }
        }
    }
}

std::vector<float> valuesOf(const SampleStorage& samples) { return {samples.values().begin(), samples.values().end()}; }

TEST(SampleStorage, GrowsInItsOwnMemoryUntilItIsFullAndBranchesIntoCopies) {
    std::vector<float> expected{1, 2, 3, 4};
    SampleStorage samples{expected};
    std::size_t moves = 0;
    for (int i = 0; i < 1000; ++i) {
        const SampleStorage before = samples;
        const std::vector<float> more{static_cast<float>(i), 2};
        samples = before.withAppended(more);
        moves += samples.values().data() == before.values().data() ? 0 : 1;
        EXPECT_EQ(valuesOf(before), expected);
        const SampleStorage branch =
            before.withAppended(std::vector<float>{-1});  // a copy, because `before` is already followed by `more`
        EXPECT_NE(branch.values().data(), samples.values().data());
        expected.insert(expected.end(), more.begin(), more.end());
        EXPECT_EQ(valuesOf(samples), expected);
        EXPECT_EQ(branch.values().back(), -1);
    }
    EXPECT_LT(moves, 20U);  // the logarithm, to the base 1.5, of the growth of the array
    EXPECT_EQ(samples.memoryBytes(), expected.size() * sizeof(float));
}

TEST(ArrayFunction, HasTheValueOfEachSampleAtItsPoint) {
    std::mt19937 random(2);
    const Shape shape{3, 9, 5, 2};
    const Box box{glm::dvec4(0), {2, 8, 4, 1}};
    const auto samples = randomSamples(shape, 0.1, random);
    const ArrayFunction array(shape, box, SampleStorage(samples));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const glm::dvec4 point(i % 3, i / 3 % 9, i / 27 % 5, i / 135);
        const float value = valueAt(array, point);
        if (std::isfinite(samples[i]))
            EXPECT_NEAR(value, samples[i], 1e-6);
        else
            EXPECT_TRUE(std::isnan(value));
    }
}

TEST(ArrayFunction, AddsNoRoundingErrorToAConstantFunction) {
    std::mt19937 random(3);
    const ArrayFunction array = arrayOf({7, 5, 4, 6}, kBox, [](const auto&) { return 0.1; });
    Points points = randomPoints(kBox, 256, random);
    array.evaluate(points.batch(), points.values);
    for (const float value : points.values) EXPECT_EQ(value, 0.1F);
    const ValueBounds bounds = array.boundsIn(kBox);
    EXPECT_NEAR(bounds.min, 0.1F, 1e-8);  // the bounds are rounded by at most one unit in the last place
    EXPECT_NEAR(bounds.max, 0.1F, 1e-8);
}

TEST(ArrayFunction, IsContinuousAtTheFacesOfCells) {
    std::mt19937 random(4);
    const Shape shape{6, 6, 6, 6};
    const Box box{glm::dvec4(0), glm::dvec4(5)};
    const ArrayFunction array(shape, box, SampleStorage(randomSamples(shape, 0, random)));
    std::uniform_real_distribution<double> inside(0.01, 4.99);
    for (int trial = 0; trial < 400; ++trial) {
        glm::dvec4 point(inside(random), inside(random), inside(random), inside(random));
        const glm::length_t axis = trial % 4;
        point[axis] = 1 + trial / 4 % 4;
        glm::dvec4 below = point, above = point;
        below[axis] -= 1e-5;
        above[axis] += 1e-5;
        EXPECT_NEAR(valueAt(array, below), valueAt(array, point), 1e-4);
        EXPECT_NEAR(valueAt(array, above), valueAt(array, point), 1e-4);
    }
}

TEST(ArrayFunction, ContinuesOutsideTheBoxAtTheNearestPoint) {
    std::mt19937 random(5);
    const Shape shape{4, 5, 3, 6};
    const ArrayFunction array(shape, kBox, SampleStorage(randomSamples(shape, 0, random)));
    const Box larger{kBox.min - 2. * (kBox.max - kBox.min), kBox.max + 2. * (kBox.max - kBox.min)};
    Points points = randomPoints(larger, 500, random);
    points.add({kInfinity, 0.6, 0, 1001});
    points.add({1, -kInfinity, kInfinity, 1e38});
    Points nearest;
    for (std::size_t i = 0; i < points.size(); ++i) {
        glm::dvec4 point = points[i];
        for (glm::length_t axis = 0; axis < 4; ++axis)
            point[axis] = std::clamp(point[axis], kBox.min[axis], kBox.max[axis]);
        nearest.add(point);
    }
    array.evaluateWithGradient(points.batch(), points.values, points.gradients());
    array.evaluateWithGradient(nearest.batch(), nearest.values, nearest.gradients());
    EXPECT_EQ(points.values, nearest.values);
    EXPECT_EQ(points.dx, nearest.dx);
    EXPECT_EQ(points.dw, nearest.dw);
}

TEST(ArrayFunction, HasNoValueAtCoordinatesThatAreNotNumbers) {
    std::mt19937 random(6);
    for (const Shape& shape : {Shape{4, 4, 4, 4}, Shape{1, 4, 4, 4}, Shape{4, 1, 1, 1}}) {
        const ArrayFunction array(shape, {}, SampleStorage(randomSamples(shape, 0, random)));
        for (glm::length_t axis = 0; axis < 4; ++axis) {
            Points points = randomPoints({}, 16, random);
            glm::dvec4 point(0.3);
            point[axis] = kNan;
            points.add(point);
            array.evaluateWithGradient(points.batch(), points.values, points.gradients());
            EXPECT_TRUE(std::isnan(points.values.back()));
            EXPECT_EQ(points.gradient(16), glm::dvec4(0));
            EXPECT_TRUE(std::all_of(points.values.begin(), points.values.end() - 1, [](float v) { return v == v; }));
        }
    }
}

TEST(ArrayFunction, IsConstantAlongAnAxisWithOneSample) {
    std::mt19937 random(7);
    for (unsigned bits = 0; bits < 16; ++bits) {
        Shape shape{};
        for (std::size_t i = 0; i < 4; ++i) shape[i] = (bits >> i & 1U) != 0 ? 4 : 1;
        const auto f = [&](const glm::dvec4& point) { return monomial(bits, kBox, point) + 1; };
        const ArrayFunction array = arrayOf(shape, kBox, f);
        Points points = randomPoints(kBox, 100, random);
        array.evaluateWithGradient(points.batch(), points.values, points.gradients());
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(points.values[i], f(points[i]), 1e-5);
            for (glm::length_t axis = 0; axis < 4; ++axis) {
                if ((bits >> static_cast<unsigned>(axis) & 1U) == 0) {
                    EXPECT_EQ(points.gradient(i)[axis], 0);
                }
            }
        }
    }
    EXPECT_EQ(valueAt(ArrayFunction({1, 1, 1, 1}, {glm::dvec4(3), glm::dvec4(3)}, SampleStorage({5})), glm::dvec4(0)),
              5);
}

// The function has a value at a point exactly if all samples with a weight other than 0 have values.
TEST(ArrayFunction, HasNoValueWhereAMissingSampleHasAWeight) {
    std::mt19937 random(8);
    const Shape shape{5, 5, 5, 5};
    const Box box{glm::dvec4(0), glm::dvec4(4)};
    const auto samples = randomSamples(shape, 0.15, random);
    const ArrayFunction array(shape, box, SampleStorage(samples));
    std::uniform_int_distribution<int> quarters(0, 16), eighths(0, 32);
    Points points;
    for (int trial = 0; trial < 4000; ++trial) {
        const auto coordinate = [&] {
            return trial % 2 == 0 ? eighths(random) / 8. : std::round(quarters(random) / 4.);
        };
        points.add({coordinate(), eighths(random) / 8., coordinate(), coordinate()});
    }
    array.evaluateWithGradient(points.batch(), points.values, points.gradients());
    int holes = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool missing = false;
        for (unsigned corner = 0; corner < 16; ++corner) {
            std::size_t index = 0;
            for (glm::length_t axis = 3; axis >= 0; --axis) {
                const double at = points[i][axis];
                const bool upper = (corner >> static_cast<unsigned>(axis) & 1U) != 0;
                index = index * 5 + static_cast<std::size_t>(upper ? std::ceil(at) : std::floor(at));
            }
            missing = missing || !std::isfinite(samples[index]);
        }
        EXPECT_EQ(std::isnan(points.values[i]), missing) << i;
        EXPECT_FALSE(std::isinf(points.values[i]));
        if (missing) {
            EXPECT_EQ(points.gradient(i), glm::dvec4(0));
        }
        holes += missing ? 1 : 0;
    }
    EXPECT_GT(holes, 100);
    EXPECT_LT(holes, 3900);
}

TEST(ArrayFunction, TheGradientIsTheLimitOfDifferences) {
    std::mt19937 random(9);
    const Shape shape{6, 5, 7, 4};
    const ArrayFunction array(shape, {}, SampleStorage(randomSamples(shape, 0, random)));
    Points points = randomPoints({}, 400, random);
    array.evaluateWithGradient(points.batch(), points.values, points.gradients());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (glm::length_t axis = 0; axis < 4; ++axis) {
            // The function is linear along an axis within a cell, so a difference of two values gives the derivative.
            const double cell = 2. / static_cast<double>(shape.at(static_cast<std::size_t>(axis)) - 1);
            glm::dvec4 low = points[i], high = points[i];
            low[axis] = -1 + cell * (std::floor((points[i][axis] + 1) / cell) + 0.1);
            high[axis] = low[axis] + 0.8 * cell;
            const double slope = (double{valueAt(array, high)} - valueAt(array, low)) / (high[axis] - low[axis]);
            EXPECT_NEAR(points.gradient(i)[axis], slope, 2e-5);
        }
    }
}

TEST(ArrayFunction, OverflowGivesNoValue) {
    const float most = std::numeric_limits<float>::max();
    const ArrayFunction array({2, 1, 1, 1}, {}, SampleStorage({-most, most}));
    Points points;
    points.add({0.3, 0, 0, 0});
    array.evaluateWithGradient(points.batch(), points.values, points.gradients());
    EXPECT_TRUE(std::isnan(points.values[0]));
    EXPECT_EQ(points.gradient(0), glm::dvec4(0));
    EXPECT_FALSE(array.boundsIn({}).hasValueEverywhere);
    EXPECT_EQ(array.statistics().missing, 0);
}

TEST(ArrayFunction, RefusesShapesAndBoxesThatAreNotValid) {
    const auto make = [](const Shape& shape, const Box& box, std::size_t count) {
        return ArrayFunction(shape, box, SampleStorage(std::vector<float>(count)));
    };
    EXPECT_NO_THROW(make({2, 2, 2, 2}, {}, 16));
    EXPECT_THROW(make({2, 2, 2, 2}, {}, 15), std::invalid_argument);
    EXPECT_THROW(make({0, 2, 2, 2}, {}, 0), std::invalid_argument);
    EXPECT_THROW(make({std::size_t{1} << 25U, 1, 1, 1}, {}, 16), std::invalid_argument);
    constexpr std::size_t kLarge = std::size_t{1} << 24U;
    EXPECT_THROW(make({kLarge, kLarge, kLarge, kLarge}, {}, 0), std::invalid_argument);  // the product of the sizes is
                                                                                         // 2^96
    EXPECT_THROW(make({2, 1, 1, 1}, {glm::dvec4(0), glm::dvec4(0)}, 2), std::invalid_argument);
    EXPECT_THROW(make({2, 1, 1, 1}, {glm::dvec4(1), glm::dvec4(0)}, 2), std::invalid_argument);
    EXPECT_THROW(make({2, 1, 1, 1}, {glm::dvec4(0), glm::dvec4(kNan)}, 2), std::invalid_argument);
    EXPECT_THROW(make({2, 1, 1, 1}, {glm::dvec4(0), glm::dvec4(kInfinity)}, 2), std::invalid_argument);
    EXPECT_THROW(make({2, 1, 1, 1}, {glm::dvec4(1), glm::dvec4(1 + 1e-12)}, 2), std::invalid_argument);
}

TEST(ArrayFunction, SharesSamplesWithTheirOwner) {
    const auto owner = std::make_shared<std::vector<float>>(std::vector<float>{1, 3});
    const ArrayFunction array({2, 1, 1, 1}, {}, SampleStorage(owner, *owner));
    EXPECT_EQ(array.samples().data(), owner->data());
    EXPECT_EQ(array.storage().memoryBytes(), 2 * sizeof(float));
    EXPECT_EQ(valueAt(array, glm::dvec4(0)), 2);
}

}  // namespace
}  // namespace oval4d::fields::test
