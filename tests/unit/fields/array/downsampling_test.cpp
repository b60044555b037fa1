#include "fields/array/downsampling.hpp"

#include <gtest/gtest.h>

#include "unit/fields/array/random_arrays.hpp"

namespace oval4d::fields::test {
namespace {

TEST(Downsampling, HalvesTheCells) {
    EXPECT_EQ(downsampledShape({1, 2, 3, 4}), (Shape{1, 2, 2, 3}));
    EXPECT_EQ(downsampledShape({5, 64, 65, 100}), (Shape{3, 33, 33, 51}));
}

TEST(Downsampling, KeepsMultilinearFunctions) {
    const Box box{{-1, 0, 2, -3}, {1, 4, 3, 3}};
    const auto f = [](const glm::dvec4& p) { return (1 + p.x) * (2 - p.y) * (p.z + 0.5) * (3 - p.w); };
    for (const Shape& shape : {Shape{9, 8, 7, 6}, Shape{4, 3, 2, 5}, Shape{33, 2, 2, 2}}) {
        const Shape coarse = downsampledShape(shape);
        const auto expected = sampled(coarse, box, f);
        const auto found = downsample(shape, sampled(shape, box, f));
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 5e-4) << i;
    }
}

// A sample of the downsampled array is a weighted mean of its neighborhood. For an odd number of samples, the weights
// in the interior are 1/4, 1/2, 1/4.
TEST(Downsampling, AveragesTheNeighborhood) {
    const auto coarse = downsample({9, 1, 1, 1}, std::vector<float>{7, 0, 0, 4, 0, 0, 0, 0, 5});
    EXPECT_EQ(coarse, (std::vector<float>{7, 1, 1, 0, 5}));
}

TEST(Downsampling, LeavesOutMissingSamples) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN(), kInfinite = std::numeric_limits<float>::infinity();
    const auto coarse = downsample({1, 9, 1, 1}, std::vector<float>{kNone, 0, kNone, 4, kNone, kInfinite, kNone, 2, 2});
    ASSERT_EQ(coarse.size(), 5);
    EXPECT_TRUE(std::isnan(coarse[0]));
    EXPECT_EQ(coarse[1], 2);  // (0 + 4) / 2
    EXPECT_EQ(coarse[2], 4);
    EXPECT_EQ(coarse[3], 2);
    EXPECT_EQ(coarse[4], 2);
}

TEST(Downsampling, KeepsTheBoxAndNarrowsTheRange) {
    std::mt19937 random(1);
    const Shape shape{12, 7, 1, 16};
    const Box box{{0, 1, 2, 3}, {4, 5, 6, 7}};
    const ArrayFunction fine(shape, box, SampleStorage(randomSamples(shape, 0.1, random)));
    const auto coarse = fine.downsampled();
    EXPECT_EQ(coarse->box(), box);
    EXPECT_EQ(coarse->shape(), (Shape{7, 4, 1, 9}));
    EXPECT_GE(coarse->statistics().min, fine.statistics().min - 1e-6F);
    EXPECT_LE(coarse->statistics().max, fine.statistics().max + 1e-6F);
}

TEST(Downsampling, LongStepsUseTheCoarsestVersionWhoseCellsAreNoLonger) {
    std::mt19937 random(2);
    const Shape shape{65, 33, 17, 9};
    const Box box{glm::dvec4(0), {64, 32, 16, 8}};  // the cells have the length 1
    const ArrayFunction fine(shape, box, SampleStorage(randomSamples(shape, 0, random)));
    const auto shapeFor = [&](double x, double y, double z) {
        const std::array<glm::dvec4, 3> steps{{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, 0.6 * z, 0.8 * z}}};
        const auto* used = dynamic_cast<const ArrayFunction*>(&fine.downsampledForSteps(steps));
        return used == nullptr ? Shape{} : used->shape();
    };
    EXPECT_EQ(shapeFor(1.9, 8, 8), shape);
    EXPECT_EQ(shapeFor(8, 8, 1.9), shape);
    EXPECT_EQ(shapeFor(2, 2, 2), (Shape{33, 17, 9, 5}));
    EXPECT_EQ(shapeFor(100, 100, 100), (Shape{33, 17, 9, 5})) << "which is small enough";
}

TEST(Downsampling, SelectionsHaveTheSamplesAtTheEndsAndAtEqualDistances) {
    EXPECT_EQ(selectionShape({256, 256, 256, 100}, std::size_t{1} << 20U), (Shape{32, 32, 32, 25}));
    EXPECT_EQ(selectionShape({1, 5, 1, 1}, 100), (Shape{1, 5, 1, 1}));
    const Shape shape{9, 1, 5, 4}, size{3, 1, 5, 2};
    std::vector<float> samples(sampleCount(shape));
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i);
    const std::vector<float> selected = selectSamples(shape, SampleStorage(samples), size);
    ASSERT_EQ(selected.size(), sampleCount(size));
    EXPECT_EQ(selected[0], 0);
    EXPECT_EQ(selected[1], 4);
    EXPECT_EQ(selected[2], 8);
    EXPECT_EQ(selected[3], 9) << "the next z";
    EXPECT_EQ(selected[15], 9 * 5 * 3) << "the last w";
}

TEST(Downsampling, LargeArraysUseASelectionInDraftsWhateverTheSteps) {
    std::mt19937 random(3);
    const Shape shape{40, 40, 40, 40};
    const ArrayFunction large(shape, {glm::dvec4(0), glm::dvec4(39)}, SampleStorage(randomSamples(shape, 0, random)),
                              100'000);
    const std::array<glm::dvec4, 1> step{glm::dvec4(0.1, 0, 0, 0)};
    const auto* used = dynamic_cast<const ArrayFunction*>(&large.downsampledForSteps(step));
    ASSERT_NE(used, nullptr);
    EXPECT_LE(sampleCount(used->shape()), 100'000U);
    EXPECT_EQ(used->samples().front(), large.samples().front());
    EXPECT_EQ(used->samples().back(), large.samples().back());
    EXPECT_EQ(used->box(), large.box());
}

}  // namespace
}  // namespace oval4d::fields::test
