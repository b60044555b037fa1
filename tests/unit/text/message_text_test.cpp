#include "text/message_text.hpp"

#include <numbers>
#include <string>
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

}  // namespace
}  // namespace oval4d::text
