#include "render/slices/depth_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace oval4d::render {
namespace {

struct Shape {
    float depth;
};

std::vector<std::uint32_t> sorted(DepthSorter& order, const std::vector<Shape>& shapes) {
    std::vector<std::uint32_t> indices;
    for (const DepthSorter::KeyedShape& entry : order.sortedFarToNear(shapes)) indices.push_back(entry.index);
    return indices;
}

TEST(DepthSorter, IsFromFarToNearAndThenThatOfTheList) {
    const float infinity = std::numeric_limits<float>::infinity();
    std::mt19937 random(5);
    DepthSorter order;
    for (const std::size_t count : {0U, 1U, 2U, 255U, 3000U}) {
        std::vector<Shape> shapes;
        for (std::size_t i = 0; i < count; ++i) {
            const auto number = static_cast<float>(random() % 2000);
            shapes.push_back({0.01F * number - 5});  // some shapes are behind the eye, and many are at the same depth
        }
        for (const float depth : {-0.0F, 0.0F, -0.0F, infinity, -infinity, 1e-30F, -1e-30F}) shapes.push_back({depth});
        std::vector<std::uint32_t> expected(shapes.size());
        for (std::uint32_t i = 0; i < expected.size(); ++i) expected[i] = i;
        std::ranges::stable_sort(expected,
                                 [&](std::uint32_t a, std::uint32_t b) { return shapes[a].depth > shapes[b].depth; });
        EXPECT_EQ(sorted(order, shapes), expected) << count;
    }
    EXPECT_TRUE(sorted(order, {}).empty());
}

TEST(DepthSorter, OfShapesAtOneDepthIsThatOfTheList) {
    DepthSorter order;
    EXPECT_EQ(sorted(order, std::vector<Shape>(5, {7})), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace oval4d::render
