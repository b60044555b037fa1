#include "text/message_text.hpp"
#include "text/words.hpp"

#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace oval4d::text {
namespace {

TEST(RoundedDecimal, HasSixDigitsAndNoTrailingZeros) {
    const std::vector<std::pair<double, std::string>> rows{
        {0, "0"},
        {-0.0, "0"},
        {1, "1"},
        {-20, "\u221220"},
        {0.1, "0.1"},
        {2 * std::numbers::pi, "6.28319"},
        {-0.000123456789, "\u22120.000123457"},
        {9.9999999, "10"},
        {28647.889756541162, "28647.9"},
        {1234567.8, "1234568"},
        {1e6, "1000000"},
        {9007199254740992.0, "9007199254740992"},
        {1.5e-7, "1.5e-07"},
        {1e300, "1e+300"},
    };
    for (const auto& [value, expected] : rows) EXPECT_EQ(roundedDecimal(value), expected);
}

TEST(OutsideBounds, RoundsUnlessTheNumberIsCloseToABound) {
    EXPECT_EQ(outsideBoundsText(-2, 0.1234567, " m", -7.1234567), "from −2 to 0.123457 m, not −7.12346");
    EXPECT_EQ(outsideBoundsText(-2, 2, "", -2.0000001), "from −2 to 2, not −2.0000001");
}

TEST(ClosestMatch, IsTheFirstOfThoseWithTheLeastDistance) {
    const std::string letters(100'000, 'a');
    const std::vector<std::string_view> names{letters, "density", "intensity", "intensities"};
    EXPECT_EQ(closestMatch("intensitys", names), "intensity");
    EXPECT_EQ(closestMatch("desnity", names), "density");
    EXPECT_EQ(closestMatch(letters, names), "");
    EXPECT_EQ(closestMatch("xyz", names), "");
}

TEST(PlainBlanks, ReplaceEachKindOfSpace) {
    EXPECT_EQ(withPlainBlanks("a\u00a0b\u2009c\u202fd\u3000e\u2000f\u200ag"), "a b c d e f g");
    EXPECT_EQ(withPlainBlanks("−π \xE2\x80 \xC2"), "−π \xE2\x80 \xC2");
}

}  // namespace
}  // namespace oval4d::text
