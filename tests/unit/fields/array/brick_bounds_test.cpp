#include "fields/array/brick_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <glm/vector_relational.hpp>

#include "unit/fields/array/random_arrays.hpp"

namespace oval4d::fields::test {
namespace {

Box randomBox(const Box& around, double size, std::mt19937& random) {
    std::uniform_real_distribution<double> part(-0.2, 1.2), length(0, size);
    Box box;
    for (glm::length_t axis = 0; axis < 4; ++axis) {
        box.min[axis] = around.min[axis] + part(random) * (around.max[axis] - around.min[axis]);
        box.max[axis] = box.min[axis] + length(random) * (around.max[axis] - around.min[axis]);
    }
    return box;
}

class BrickBoundsOf : public testing::TestWithParam<bool> {};

TEST_P(BrickBoundsOf, ContainTheValuesInEveryRegion) {
    std::mt19937 random(1);
    const Box box{{-1, 5, -100, 0}, {1, 5.5, 300, 1}};
    for (const Shape& shape : {Shape{9, 14, 6, 11}, Shape{40, 1, 33, 2}, Shape{5, 5, 5, 5}, Shape{1, 1, 1, 200}}) {
        for (const double missing : {0., 0.002, 0.3, 1.}) {
            const ArrayFunction array(shape, box, SampleStorage(randomSamples(shape, missing, random)),
                                      GetParam() ? sampleCount(shape) : 0);
            for (int trial = 0; trial < 150; ++trial) {
                const Box region = randomBox(box, trial % 3 == 0 ? 1 : 0.1, random);
                const ValueBounds bounds = array.boundsIn(region);
                Points points = randomPoints(region, 64, random);
                points.add(region.min);
                points.add(region.max);
                array.evaluate(points.batch(), points.values);
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const float value = points.values[i];
                    const glm::dvec4 point = points[i];
                    if (glm::any(glm::lessThan(point, region.min)) || glm::any(glm::greaterThan(point, region.max)))
                        continue;  // rounding has moved the point out of the region
                    if (std::isnan(value)) {
                        EXPECT_FALSE(bounds.hasValueEverywhere);
                    } else {
                        EXPECT_LE(bounds.min, value);
                        EXPECT_GE(bounds.max, value);
                    }
                }
                // A query of more than kMaxLazyBricks bricks is unbounded if the array is read only as needed.
                if (!GetParam() && trial % 3 == 0 && bounds.min == -std::numeric_limits<double>::infinity()) continue;
                if (missing == 1) {
                    EXPECT_GT(bounds.min, bounds.max);
                }
                if (missing == 0) {
                    EXPECT_TRUE(bounds.hasValueEverywhere);
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EagerAndLazy, BrickBoundsOf, testing::Bool());

TEST(BrickBounds, AreThoseOfTheBricksThatMeetTheRegion) {
    const Shape shape{17, 17, 17, 17};
    const Box box{glm::dvec4(0), glm::dvec4(16)};
    // The largest sample of the brick with the indices i, j, k, l is 4 (i + 10 j + 100 k + 1000 l + 1111).
    const ArrayFunction array(shape, box, SampleStorage(sampled(shape, box, [](const glm::dvec4& p) {
                                  return p.x + 10 * p.y + 100 * p.z + 1000 * p.w;
                              })));
    const auto expectBounds = [&](const glm::dvec4& min, const glm::dvec4& max, double low, double high) {
        const ValueBounds bounds = array.boundsIn({min, max});
        EXPECT_NEAR(bounds.min, low, 0.1);
        EXPECT_NEAR(bounds.max, high, 0.1);
        EXPECT_TRUE(bounds.hasValueEverywhere);
    };
    expectBounds(glm::dvec4(0), glm::dvec4(16), 0, 16 * 1111);
    expectBounds(glm::dvec4(4), glm::dvec4(8), 4 * 1111, 8 * 1111);  // a brick, and the faces that it shares with its
                                                                     // neighbors
    expectBounds(glm::dvec4(4), glm::dvec4(8.01), 4 * 1111, 12 * 1111);
    expectBounds(glm::dvec4(3.99), glm::dvec4(4), 0, 4 * 1111);
    expectBounds(glm::dvec4(16), glm::dvec4(20), 12 * 1111, 16 * 1111);
    expectBounds(glm::dvec4(-9), glm::dvec4(-8), 0, 4 * 1111);
    expectBounds({0, 0, 0, 13}, {1, 1, 1, 14}, 12000, 16000 + 4 * 111);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expectBounds({0, 0, 0, nan}, {1, 1, 1, 3}, 0, 16000 + 4 * 111);
}

TEST(BrickBounds, CountEachMissingSampleOnce) {
    std::mt19937 random(3);
    for (const Shape& shape : {Shape{9, 14, 6, 11}, Shape{300, 2, 1, 7}, Shape{1, 1, 1, 1}}) {
        auto samples = randomSamples(shape, 0.1, random);
        samples[0] = 0.5F;
        std::size_t missing = 0;
        float min = 1, max = -1;
        for (const float each : samples) {
            missing += std::isfinite(each) ? 0 : 1;
            if (std::isfinite(each)) min = std::min(min, each), max = std::max(max, each);
        }
        const ArrayFunction array(shape, {}, SampleStorage(samples));
        EXPECT_EQ(array.statistics().missing, missing);
        EXPECT_EQ(array.statistics().min, min);
        EXPECT_EQ(array.statistics().max, max);
        EXPECT_TRUE(array.statisticsAreExact());
    }
}

TEST(BrickBounds, ReadLittleOfALargeArray) {
    const Shape shape{64, 64, 64, 64};
    std::mt19937 random(4);
    const ArrayFunction array(shape, {}, SampleStorage(randomSamples(shape, 0, random)), 1000);
    EXPECT_FALSE(array.statisticsAreExact());
    EXPECT_LT(array.statistics().min, -0.99F);  // the least of a selection of the samples
    EXPECT_GT(array.statistics().max, 0.99F);
    const std::size_t before = array.memoryBytes();
    const ValueBounds all = array.boundsIn({});
    EXPECT_FALSE(all.hasValueEverywhere);
    EXPECT_EQ(all.min, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(array.memoryBytes(), before);
    const ValueBounds part = array.boundsIn({glm::dvec4(-0.1), glm::dvec4(0.1)});
    EXPECT_TRUE(part.hasValueEverywhere);
    EXPECT_NEAR(part.min, -1, 0.01);
    EXPECT_LE(array.memoryBytes(), before + BrickBounds::kMaxEntries * 4096);
}

}  // namespace
}  // namespace oval4d::fields::test
