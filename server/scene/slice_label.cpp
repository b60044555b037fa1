#include "scene/slice_label.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace oval4d::scene {

namespace {

// Returns the distance between neighboring hyperplanes; if these distances differ, the least of them.
double leastDistance(const geometry::Hyperplanes& planes) {
    if (planes.listed.size() < 2) return planes.spacing;
    std::vector<double> sorted = planes.listed;
    std::ranges::sort(sorted);
    double least = sorted[1] - sorted[0];
    for (std::size_t i = 2; i < sorted.size(); ++i) least = std::min(least, sorted[i] - sorted[i - 1]);
    return least;
}

}  // namespace

int labelDecimals(const geometry::Hyperplanes& planes) {
    return static_cast<int>(std::clamp(std::ceil(-std::log10(leastDistance(planes))) + 1, 2.0, 9.0));
}

std::string labelNumber(double w, int decimals) {
    if (std::abs(w) < 0.5 * std::pow(10, -decimals)) return "0";
    std::array<char, 48> digits{};
    std::snprintf(digits.data(), digits.size(), "%.*f", decimals, std::abs(w));
    return (w < 0 ? "\u2212" : "") + std::string(digits.data());
}

}  // namespace oval4d::scene
