#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "text/decimal.hpp"

namespace oval4d::text {
namespace {

std::string textOf(const std::vector<glm::dvec3>& list) {
    std::string text((3 * list.size() + 2) * kBytesPerNumber, '?');
    text.resize(putVectorsAsJson(text.data(), list) - text.data());
    return text;
}

float floatOf(std::uint32_t bits) { return std::bit_cast<float>(bits); }

// Expects that each number is read back as the same float, and that its text is at most as long as that of
// std::to_chars in the same notation.
void expectExact(const std::vector<float>& numbers) {
    std::vector<glm::dvec3> list(numbers.size() / 3);
    ASSERT_EQ(numbers.size(), 3 * list.size());
    std::copy(numbers.begin(), numbers.end(), &list[0].x);
    const std::string text = textOf(list);
    const char* at = text.data();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i % 3 == 0) {
            ASSERT_EQ(*at++, '[');
        }
        float read = 0;
        const auto [end, error] = std::from_chars(at, text.data() + text.size(), read);
        ASSERT_EQ(error, std::errc());
        ASSERT_EQ(std::bit_cast<std::uint32_t>(read), std::bit_cast<std::uint32_t>(numbers[i])) << numbers[i];
        ASSERT_EQ(static_cast<float>(std::strtod(at, nullptr)), numbers[i]) << "when read as a double first";
        char shortest[128];
        const bool scientific = std::find(at, end, 'e') != end;
        const auto format = scientific ? std::chars_format::scientific : std::chars_format::fixed;
        const auto* shortestEnd = std::to_chars(shortest, shortest + sizeof shortest, numbers[i], format).ptr;
        ASSERT_LE(end - at, shortestEnd - shortest) << std::string(at, end);
        at = end;
        const std::string_view between = i + 1 == numbers.size() ? "]" : i % 3 == 2 ? "]," : ",";
        ASSERT_EQ(std::string_view(at, between.size()), between);
        at += between.size();
    }
    ASSERT_EQ(at, text.data() + text.size());
}

TEST(Decimal, FloatsOfEveryExponentReadBackTheSame) {
    std::mt19937 random(1);
    for (std::uint32_t exponent = 0; exponent < 255; ++exponent) {
        const std::uint32_t power = exponent << 23;
        std::vector<float> numbers;
        for (std::uint32_t i = 0; i < 40; ++i) {  // floats just above a power of two, and just below the next power
            numbers.push_back(floatOf(power + i));
            numbers.push_back(-floatOf(power + 0x7F'FFFF - i));
        }
        const int trials = exponent > 110 && exponent < 140 ? 20'000 : 400;
        for (int i = 0; i < trials; ++i) numbers.push_back(floatOf(random() << 31 | power | random() >> 9));
        numbers.resize(numbers.size() / 3 * 3);
        expectExact(numbers);
        ASSERT_FALSE(HasFatalFailure()) << "exponent " << exponent;
    }
}

TEST(Decimal, FloatsNextToShortDecimalsReadBackTheSame) {
    std::mt19937 random(2);
    std::vector<float> numbers;
    for (int decimals = 0; decimals <= 10; ++decimals) {  // numbers with few digits, and the floats next to them
        for (int i = 0; i < 500; ++i) {
            const auto number = static_cast<float>(static_cast<int>(random() % 20'000'000) * std::pow(10, -decimals));
            for (const float each : {number, std::nextafter(number, 0.0F), -std::nextafter(number, 1e9F)}) {
                numbers.push_back(each);
            }
        }
    }
    for (int power = -12; power <= 12; ++power) {
        const auto number = static_cast<float>(std::pow(10, power));
        for (const float each : {number, std::nextafter(number, 0.0F), std::nextafter(number, 1e30F)}) {
            numbers.push_back(each);
        }
    }
    expectExact(numbers);
}

TEST(Decimal, IntegersHaveNoExponent) {
    const std::vector<glm::dvec3> list{{100'000, -1'000'000, 16'777'216}, {0x1p53, -0x1p53, 131'072.5}};
    EXPECT_EQ(textOf(list), "[100000,-1000000,16777216],[9007199254740992,-9007199254740992,131072.5]");
}

TEST(Decimal, SpecialNumbersDoNotAffectTheirNeighbors) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> usual(-40, 40);
    using Limits = std::numeric_limits<float>;
    const std::vector<float> odd{0,
                                 -0.0F,
                                 1,
                                 -1,
                                 0.5F,
                                 64,
                                 63.999F,
                                 -100,
                                 1e-4F,
                                 3e9F,
                                 1e-30F,
                                 7.5F,
                                 Limits::max(),
                                 Limits::min(),
                                 Limits::denorm_min()};
    for (std::size_t vectors = 0; vectors < 14; ++vectors) {
        for (int trial = 0; trial < 40; ++trial) {
            std::vector<float> numbers(3 * vectors);
            for (float& number : numbers) number = random() % 5 == 0 ? odd[random() % odd.size()] : usual(random);
            if (!numbers.empty()) expectExact(numbers);
        }
    }
    EXPECT_EQ(textOf({}), "");
}

TEST(Decimal, VectorsAreValidJson) {
    EXPECT_EQ(textOf({{1, 0.25, -0.1}, {1.0 / 3, -2.0 / 3, 1e-20}}), "[1,0.25,-0.1],[0.33333334,-0.6666667,1e-20]");
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (std::size_t size = 1; size < 10; ++size) {
        std::vector<glm::dvec4> list(size);
        for (auto& v : list) v = {normal(random), normal(random), normal(random), normal(random)};
        std::string text((4 * size + 2) * kBytesPerNumber, '?');
        text.resize(putVectorsAsJson(text.data(), std::span<const glm::dvec4>(list)) - text.data());
        const auto json = nlohmann::json::parse("[" + text + "]");
        ASSERT_EQ(json.size(), size);
        for (std::size_t i = 0; i < size; ++i) {
            for (int c = 0; c < 4; ++c) EXPECT_EQ(json[i][c].get<float>(), static_cast<float>(list[i][c]));
        }
    }
}

TEST(Decimal, IntegersHaveAllTheirDigits) {
    const auto expectDigits = [](std::uint32_t number) {
        char text[2 * kBytesPerNumber];
        ASSERT_EQ(std::string(text, putInteger(text, number)), std::to_string(number));
    };
    for (std::uint32_t number = 0; number < 120'000; ++number) expectDigits(number);
    for (std::uint32_t power = 1; power <= 1'000'000'000; power *= 10) {
        for (const std::uint32_t number : {power - 1, power, power + 1, 4 * power}) expectDigits(number);
        if (power == 1'000'000'000) break;
    }
    expectDigits(std::numeric_limits<std::uint32_t>::max());
    std::mt19937 random(5);
    for (int i = 0; i < 20'000; ++i) expectDigits(random() >> random() % 32);
}

}  // namespace
}  // namespace oval4d::text
