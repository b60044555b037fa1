#include "geometry/centering.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace oval4d::geometry {

namespace {

// In this file, the extent of an object is the largest distance of one of its points from its center.
// An object is far from the origin if its center is more than this many extents away from the origin.
constexpr double kFar = 3;
// The coordinates of the center are rounded to multiples of 2^−kBitsOfCenter times the leading bit of the extent.
constexpr int kBitsOfCenter = 36;

// Returns the mean of points: the first point plus the mean difference of the points from the first point. If the
// points are close together and far from the origin, these differences are exact; a sum of the coordinates would not
// be.
glm::dvec4 meanOf(std::span<const glm::dvec4> points) {
    glm::dvec4 sum(0);
    for (const glm::dvec4& p : points) sum += p - points.front();
    return points.front() + sum / static_cast<double>(points.size());
}

}  // namespace

glm::dvec4 newOriginFor(const Centering& centering, std::span<const glm::dvec4> points) {
    if (centering.choice == Centering::OriginChoice::origin || points.empty()) return glm::dvec4(0);
    if (centering.choice == Centering::OriginChoice::point) return centering.place;
    glm::dvec4 center = meanOf(points);
    double extent = 0;
    for (const glm::dvec4& p : points) extent = std::max(extent, glm::distance(p, center));
    const bool isFar = extent > 0 && glm::length(center) > kFar * extent;
    if (centering.choice == Centering::OriginChoice::automatic && !isFar) return glm::dvec4(0);
    if (!(extent > 0)) return center;
    // Rounding removes the errors of the mean: a center such as (10, 10, 0, 0) becomes exact.
    const double unit = std::ldexp(1.0, std::ilogb(extent) - kBitsOfCenter);
    return glm::round(center / unit) * unit + 0.0;  // + 0.0 turns −0 into 0
}

}  // namespace oval4d::geometry
