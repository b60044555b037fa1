#include "geometry/hyperplanes.hpp"

#include <algorithm>
#include <cmath>

namespace oval4d::geometry {

namespace {

// Returns the distance between neighboring hyperplanes, or the least of these distances.
double leastDistance(const Hyperplanes& planes) {
    if (planes.listed.size() < 2) return planes.spacing;
    std::vector<double> sorted = planes.listed;
    std::ranges::sort(sorted);
    double least = sorted[1] - sorted[0];
    for (std::size_t i = 2; i < sorted.size(); ++i) least = std::min(least, sorted[i] - sorted[i - 1]);
    return least;
}

}  // namespace

int labelDecimals(const Hyperplanes& planes) {
    return static_cast<int>(std::clamp(std::ceil(-std::log10(leastDistance(planes))) + 1, 2.0, 9.0));
}

}  // namespace oval4d::geometry
