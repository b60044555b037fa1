#include "scene/slice_label.hpp"

#include <gtest/gtest.h>

namespace oval4d::scene {
namespace {

int decimalsOf(double spacing, std::vector<double> listed) {
    const int count = listed.empty() ? 21 : static_cast<int>(listed.size());
    return labelDecimals(geometry::Hyperplanes{0, count, spacing, 0, std::move(listed)});
}

TEST(SliceLabel, HasEnoughDecimalsToTellNeighborsApart) {
    EXPECT_EQ(decimalsOf(5, {}), 2);
    EXPECT_EQ(decimalsOf(0.1, {}), 2);
    EXPECT_EQ(decimalsOf(0.01, {}), 3);
    EXPECT_EQ(decimalsOf(1e-30, {}), 9);
    EXPECT_EQ(decimalsOf(0.1, {0.002, -1, 0.001}), 4);
    EXPECT_EQ(decimalsOf(1e-3, {1, 2}), 2) << "the spacing is not that of the listed hyperplanes";
    EXPECT_EQ(decimalsOf(0.1, {3}), 2);
}

TEST(SliceLabel, HasNoSignWithoutDigits) {
    EXPECT_EQ(labelNumber(0.25, 2), "0.25");
    EXPECT_EQ(labelNumber(-0.25, 3), "\u22120.250");
    EXPECT_EQ(labelNumber(-0.0049, 2), "0");
    EXPECT_EQ(labelNumber(-0.0, 2), "0");
}

}  // namespace
}  // namespace oval4d::scene
