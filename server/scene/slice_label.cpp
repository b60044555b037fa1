#include "scene/slice_label.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace oval4d::scene {

namespace {

// Returns the distance between neighboring hyperplanes. If these distances differ, returns the least of them.
double leastHyperplaneSpacing(const geometry::Hyperplanes& planes) {
    if (planes.listed.size() < 2) return planes.spacing;
    std::vector<double> sorted = planes.listed;
    std::ranges::sort(sorted);
    double least = sorted[1] - sorted[0];
    for (std::size_t i = 2; i < sorted.size(); ++i) least = std::min(least, sorted[i] - sorted[i - 1]);
    return least;
}

std::string fixedDecimal(double number, int decimals) {
    std::array<char, 48> digits{};
    std::snprintf(digits.data(), digits.size(), "%.*f", decimals, number);
    return digits.data();
}

// Returns the text that labelNumber() writes for a positive number if `decimals` is greater than kMaxPlainDecimals. The
// function formatW() of the page in the browser (web_client/src/format.ts) must return the same text.
std::string withExponentIfSmall(double number, int decimals) {
    constexpr int kMostDigits = 17;  // the significant digits of a double
    constexpr double kLeastWithoutExponent = 1e-4;
    std::array<char, 48> digits{};
    std::snprintf(digits.data(), digits.size(), "%.*e", kMostDigits - 1, number);
    std::string text = digits.data();
    const int exponent = std::atoi(text.c_str() + text.find('e') + 1);
    if (number >= kLeastWithoutExponent)
        return fixedDecimal(number, std::clamp(kMostDigits - 1 - exponent, 0, decimals));
    std::snprintf(digits.data(), digits.size(), "%.*e", std::clamp(exponent + decimals, 0, kMostDigits - 1), number);
    text = digits.data();
    const std::size_t first = text.find("e-") + 2;
    text.erase(first, text.find_first_not_of('0', first) - first);  // "e-05" becomes "e-5"
    return text;
}

}  // namespace

int labelDecimals(const geometry::Hyperplanes& planes) {
    return static_cast<int>(std::clamp(std::ceil(-std::log10(leastHyperplaneSpacing(planes))) + 1, 2.0, 300.0));
}

std::string labelNumber(double w, int decimals) {
    if (std::abs(w) < 0.5 * std::pow(10, -decimals)) return "0";
    return (w < 0 ? "\u2212" : "") + (decimals > kMaxPlainDecimals ? withExponentIfSmall(std::abs(w), decimals)
                                                                   : fixedDecimal(std::abs(w), decimals));
}

}  // namespace oval4d::scene
