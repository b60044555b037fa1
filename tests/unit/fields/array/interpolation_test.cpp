#include "fields/array/interpolation.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "unit/fields/array/random_arrays.hpp"

namespace oval4d::fields::test {
namespace {

std::vector<std::uint32_t> bitsOf(const std::vector<float>& numbers) {
    std::vector<std::uint32_t> bits;
    for (const float number : numbers) bits.push_back(std::bit_cast<std::uint32_t>(number));
    return bits;
}

TEST(Interpolation, GivesTheSameBitsWithAllInstructions) {
    std::mt19937 random(1);
    for (const Shape& shape : {Shape{7, 6, 5, 8}, Shape{2, 2, 2, 2}, Shape{9, 1, 4, 1}, Shape{1, 3, 3, 3}}) {
        for (const double missing : {0., 0.05}) {
            const Box box{{-1, 0, 100, -3}, {0.3, 7, 101, 1}};
            const Lattice lattice(shape, box);
            const auto samples = randomSamples(shape, missing, random);
            Points points = randomPoints({box.min - 0.2, box.max + 0.2}, 1003, random);
            for (std::size_t i = 0; i < points.size(); i += 5) points.x[i] = -1 + 1.3F * static_cast<float>(i % 7) / 6;
            points.z[17] = std::numeric_limits<float>::quiet_NaN();
            points.y[18] = std::numeric_limits<float>::infinity();
            Points other = points;
            const SampledLattice from{lattice, samples.data()};
            const auto fastest = fastestInstructionSet();
            interpolate(from, points.batch(), points.values, InstructionSet::portable);
            interpolate(from, other.batch(), other.values, fastest);
            EXPECT_EQ(bitsOf(points.values), bitsOf(other.values));
            const auto values = points.values;
            interpolateWithGradient(from, points.batch(), points.values, points.gradients(), InstructionSet::portable);
            interpolateWithGradient(from, other.batch(), other.values, other.gradients(), fastest);
            EXPECT_EQ(bitsOf(points.values), bitsOf(values));
            EXPECT_EQ(bitsOf(points.values), bitsOf(other.values));
            EXPECT_EQ(points.dx, other.dx);  // compares floats by ==, so −0 equals 0
            EXPECT_EQ(points.dy, other.dy);
            EXPECT_EQ(points.dz, other.dz);
            EXPECT_EQ(points.dw, other.dw);
        }
    }
}

TEST(Interpolation, DoesNotDependOnTheOtherPoints) {
    std::mt19937 random(2);
    const Shape shape{5, 5, 5, 5};
    const Lattice lattice(shape, {});
    const auto samples = randomSamples(shape, 0.02, random);
    const SampledLattice from{lattice, samples.data()};
    Points all = randomPoints({}, 61, random);
    interpolate(from, all.batch(), all.values, fastestInstructionSet());
    for (std::size_t i = 0; i < all.size(); ++i) {
        Points one;
        one.add(all[i]);
        interpolate(from, one.batch(), one.values, fastestInstructionSet());
        EXPECT_EQ(std::bit_cast<std::uint32_t>(one.values[0]), std::bit_cast<std::uint32_t>(all.values[i]));
    }
    interpolate(from, {}, {}, fastestInstructionSet());
}

}  // namespace
}  // namespace oval4d::fields::test
