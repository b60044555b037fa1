#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "polytopes/import/rounding_estimator.hpp"

namespace oval4d::polytopes {
namespace {

TEST(RoundingEstimator, IsThatOfSinglePrecisionNumbers) {
    std::mt19937 random(36);
    std::uniform_real_distribution<double> uniform(0.5, 1);
    const auto errorOf = [](const std::vector<std::string>& words, double size = 1) {
        RoundingEstimator precision;
        for (const std::string& word : words) precision.add(word, 0, std::strtod(word.c_str(), nullptr));
        return precision.maxRoundingError(size).x;
    };
    const auto words = [&](bool single, const char* format, int digits) {
        std::vector<std::string> result(40);
        for (std::string& word : result) {
            const double value = uniform(random);
            std::array<char, 64> text{};
            std::snprintf(text.data(), text.size(), format, digits, single ? static_cast<float>(value) : value);
            word = text.data();
        }
        return result;
    };
    for (const int digits : {8, 9, 12, 17}) {
        EXPECT_NEAR(errorOf(words(true, "%.*f", digits)), 0x1p-24, 1e-8) << digits;
        EXPECT_LE(errorOf(words(false, "%.*f", digits)), 1e-8) << digits;
    }
    for (const bool single : {false, true}) {
        for (const int digits : {3, 6, 7})
            EXPECT_DOUBLE_EQ(errorOf(words(single, "%.*f", digits)), 0.5 * std::pow(10.0, -digits));
    }
    // Short decimals are no evidence for single precision.
    EXPECT_LE(errorOf({"0.500000000", "1.000000000", "0.250000000", "0.750000000"}), 1e-8);
    EXPECT_EQ(errorOf({"0.5", "1", "-0.25"}), 0);
    EXPECT_EQ(errorOf({"16777216", "33554432", "1234567168"}, 1e9), 0.5);
}

TEST(RoundingEstimator, IsHalfTheUnitOfTheLastDigit) {
    const auto maxRoundingError = [](const std::vector<const char*>& words, double size) {
        RoundingEstimator precision;
        for (const char* word : words) precision.add(word, 0, std::stod(word));
        return precision.maxRoundingError(size).x;
    };
    EXPECT_DOUBLE_EQ(maxRoundingError({"0.70711", "-1.00000"}, 1), 0.5e-5);
    EXPECT_DOUBLE_EQ(maxRoundingError({"10.70711", "0.70711", "0.5"}, 1), 0.5e-5);  // a fixed number of decimals
    EXPECT_DOUBLE_EQ(maxRoundingError({"10.7071", "0.707107", "0.5"}, 1),
                     0.5e-4);  // a fixed number of digits: the largest number determines the last place
    EXPECT_DOUBLE_EQ(maxRoundingError({"1.0707e+05", "7.0711E-1"}, 1e5), 5);
    EXPECT_DOUBLE_EQ(maxRoundingError({"7.0711e-10", "0"}, 1e-9), 0.5e-14);
    EXPECT_EQ(maxRoundingError({"0.5", "1.5", "0"}, 2), 0);
    EXPECT_EQ(maxRoundingError({"100000.5", "99999.5"}, 2), 0);
    EXPECT_EQ(maxRoundingError({"5e-10", "1e-9"}, 2e-9), 0);
}

}  // namespace
}  // namespace oval4d::polytopes
