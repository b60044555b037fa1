// Tests of the places to which the numbers of files go.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "fields/readers/axis_mapping.hpp"

namespace oval4d::fields::test {
namespace {

TEST(AxisMapping, SlabsCoverTheArrayInItsOrder) {
    std::mt19937 random(5);
    const auto below = [&](std::size_t most) { return random() % most; };
    for (int round = 0; round < 300; ++round) {
        std::vector<std::size_t> axes{0, 1, 2, 3};
        std::shuffle(axes.begin(), axes.end(), random);
        std::vector<ArrayDimension> dimensions(1 + below(4));
        for (std::size_t i = 0; i < dimensions.size(); ++i) dimensions[i] = {1 + below(7), axes[i], below(2) == 1};
        const auto mapping = AxisMapping::fromDimensions(dimensions, kMaxSamples);
        ASSERT_TRUE(mapping);
        // Convert the numbers 0, 1, 2 … at once and slab by slab.
        std::vector<float> numbers(mapping->count()), whole(numbers.size()), parts(numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
        const auto* from = reinterpret_cast<const std::byte*>(numbers.data());
        convertToFloats({}, from, mapping->layout(), whole.data() + mapping->firstSampleIndex());
        const std::size_t most = 1 + below(2 * numbers.size());
        const auto slabs = mapping->slabs(most);
        for (const Slab& slab : slabs) {
            const auto& size = slab.layout.size;
            const std::size_t count = size[0] * size[1] * size[2] * size[3];
            EXPECT_LE(count, std::max(most, mapping->layout().size[3]));
            convertToFloats({}, from, slab.layout, parts.data() + slab.first);
            from += count * sizeof(float);
        }
        EXPECT_EQ(from, reinterpret_cast<const std::byte*>(numbers.data() + numbers.size()));
        EXPECT_EQ(parts, whole);
        EXPECT_TRUE(most < numbers.size() || slabs.size() == 1);
    }
}

}  // namespace
}  // namespace oval4d::fields::test
