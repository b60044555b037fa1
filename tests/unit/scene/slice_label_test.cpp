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
    EXPECT_EQ(decimalsOf(2e-9, {}), 10);
    EXPECT_EQ(decimalsOf(2e-30, {}), 31);
    EXPECT_EQ(decimalsOf(0.1, {0.002, -1, 0.001}), 4);
    EXPECT_EQ(decimalsOf(1e-3, {1, 2}), 2) << "the spacing is not that of the listed hyperplanes";
    EXPECT_EQ(decimalsOf(0.1, {3}), 2);
}

TEST(SliceLabel, HasNoSignWithoutDigits) {
    EXPECT_EQ(labelNumber(0.25, 2), "0.25");
    EXPECT_EQ(labelNumber(-0.25, 3), "\u22120.250");
    EXPECT_EQ(labelNumber(-0.0049, 2), "0");
    EXPECT_EQ(labelNumber(-0.0, 2), "0");
    EXPECT_EQ(labelNumber(-4e-13, 12), "0");
}

TEST(SliceLabel, HasAnExponentWhereDecimalsWouldBeTooMany) {
    EXPECT_EQ(labelNumber(1.5e-8, 9), "0.000000015");
    EXPECT_EQ(labelNumber(5e-11, 12), "5.0e-11");
    EXPECT_EQ(labelNumber(-1.25e-10, 12), "\u22121.25e-10");
    EXPECT_EQ(labelNumber(0.75e-4, 10), "7.50000e-5");
    EXPECT_EQ(labelNumber(0.5, 12), "0.500000000000");
    EXPECT_EQ(labelNumber(3e6, 12), "3000000.0000000000") << "17 digits";
    EXPECT_EQ(labelNumber(3e-120, 121), "3.0e-120");
    for (int n = 1; n < 100; ++n) EXPECT_NE(labelNumber(n * 1e-20, 21), labelNumber((n + 1) * 1e-20, 21));
}

}  // namespace
}  // namespace oval4d::scene
