// Tests of the lines of single vertices in a density strip.

#include "scene/density_strip_lines.hpp"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace oval4d::scene {
namespace {

// Returns the vertices whose lines are drawn if the highlighted element has `count` vertices: 7, 8, 9, …
std::vector<std::uint32_t> drawnOf(std::size_t count) {
    std::vector<std::uint32_t> own(count), drawn;
    std::iota(own.begin(), own.end(), 7U);
    forEachLineOverDensityStrip(own, [&](std::uint32_t v) { drawn.push_back(v); });
    return drawn;
}

TEST(DensityStripLines, AreThoseOfAllVerticesUpToTheMaximum) {
    EXPECT_TRUE(drawnOf(0).empty());
    EXPECT_EQ(drawnOf(1), std::vector<std::uint32_t>{7});
    const std::vector<std::uint32_t> most = drawnOf(kMaxLinesOverDensityStrip);
    ASSERT_EQ(most.size(), kMaxLinesOverDensityStrip);
    for (std::size_t i = 0; i < most.size(); ++i) EXPECT_EQ(most[i], 7 + i);
}

TEST(DensityStripLines, AreSpreadOverTheVerticesBeyondTheMaximum) {
    for (const std::size_t count :
         {kMaxLinesOverDensityStrip + 1, 3 * kMaxLinesOverDensityStrip, std::size_t{100'000}}) {
        const std::vector<std::uint32_t> drawn = drawnOf(count);
        ASSERT_EQ(drawn.size(), kMaxLinesOverDensityStrip);
        EXPECT_EQ(drawn.front(), 7U);
        EXPECT_EQ(drawn.back(), 6 + count);
        const std::size_t widest = (count - 1) / (kMaxLinesOverDensityStrip - 1) + 1;
        for (std::size_t i = 1; i < drawn.size(); ++i) {
            EXPECT_GT(drawn[i], drawn[i - 1]);
            EXPECT_LE(drawn[i] - drawn[i - 1], widest);
        }
    }
}

}  // namespace
}  // namespace oval4d::scene
