#include "scene/fog_look.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/color.hpp"

namespace oval4d::scene {
namespace {

FogTransferTable tableOf(const std::vector<slicing::FogControlPoint>& points) {
    FogTransferTable table{1, 2, 3};
    makeFogTable(points, table);
    return table;
}

TEST(FogTransferTable, IsLinearBetweenItsPoints) {
    // Entry i stands for the value (i − 1) / 254 · 4 − 2.
    const FogTransferTable table = tableOf({{-2, 0, 0xff0000}, {0, 1, 0x00ff00}, {2, 0.5, 0x0000ff}});
    ASSERT_EQ(table.size(), kFogEntries);
    EXPECT_EQ(table[0], 0U);
    EXPECT_EQ(table[1], 0x00ff0000U);
    EXPECT_EQ(table[128], 0xff00ff00U);
    EXPECT_EQ(table[255] & 0xffffff, 0x0000ffU);
    for (std::size_t i = 1; i < table.size(); ++i) {
        const double value = (static_cast<double>(i) - 1) / 254 * 4 - 2;
        const double opacity = value < 0 ? 1 + value / 2 : 1 - value / 4;
        EXPECT_NEAR(table[i] >> 24, 255 * opacity, 0.51);
        EXPECT_NEAR(table[i] >> 8 & 255, 255 * (1 - std::abs(value) / 2), 0.51);
    }
}

TEST(FogTransferTable, PointsWithoutAColorHaveThatOfTheScale) {
    const FogTransferTable table = tableOf({{10, 0.5}, {11, 0.5}, {12, 0.5}});
    EXPECT_EQ(table[1] & 0xffffff, divergingColor(-1));
    EXPECT_EQ(table[128] & 0xffffff, divergingColor(0));
    EXPECT_EQ(table[255] & 0xffffff, divergingColor(1));
}

TEST(FogTransferTable, IsEmptyWithoutFog) { EXPECT_TRUE(tableOf({}).empty()); }

// A block contains fog if a visible value lies between the least and the greatest value of the block's points.
TEST(FogBlocks, AreThoseWhoseValuesPassAVisibleOne) {
    FogTransferTable table(kFogEntries, 0);
    for (std::size_t value = 100; value < 110; ++value) table[value] = 0x01ffffff;
    slicing::SliceFog fog;
    fog.size = {10, 6, 2};  // the lattice has 9 × 5 × 1 cells: three, two and one blocks along the axes
    fog.values.assign(120, 50);
    const auto blocksWith = [&](glm::ivec3 at, std::uint8_t value) {
        std::vector<std::uint8_t> blocks;
        std::uint8_t& held = fog.values.at(at.x + 10 * (at.y + 6 * at.z));
        const std::uint8_t before = std::exchange(held, value);
        EXPECT_EQ(findFogBlocks(fog, table, blocks), glm::ivec3(3, 2, 1));
        held = before;
        return blocks;
    };
    using Blocks = std::vector<std::uint8_t>;
    const Blocks none(6, 0);
    EXPECT_EQ(blocksWith({0, 0, 0}, 50), none);
    EXPECT_EQ(blocksWith({1, 1, 0}, 99), none);
    EXPECT_EQ(blocksWith({1, 1, 0}, 100), (Blocks{255, 0, 0, 0, 0, 0}));
    EXPECT_EQ(blocksWith({1, 1, 1}, 255), (Blocks{255, 0, 0, 0, 0, 0})) << "between 50 and 255 there is fog";
    EXPECT_EQ(blocksWith({4, 4, 0}, 105), (Blocks{255, 255, 0, 255, 255, 0})) << "a point of four blocks";
    EXPECT_EQ(blocksWith({9, 5, 1}, 105), (Blocks{0, 0, 0, 0, 0, 255}));
    fog.values.assign(120, 0);
    EXPECT_EQ(blocksWith({1, 1, 0}, 255), none) << "values are not mixed with points without a value";
    EXPECT_EQ(blocksWith({1, 1, 0}, 109), (Blocks{255, 0, 0, 0, 0, 0}));
}

TEST(FogTransferTable, MayHaveStepsOfAnyHeight) {
    const FogTransferTable table = tableOf({{0, 0}, {1e-12, 1}, {1, 1}});
    EXPECT_EQ(table[1] >> 24, 0U);
    EXPECT_EQ(table[2] >> 24, 255U);
}

}  // namespace
}  // namespace oval4d::scene
