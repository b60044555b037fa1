#include "polytopes/polygon_names.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include <glm/geometric.hpp>

#include "polytopes/construction/polyhedra.hpp"

namespace oval4d::polytopes {

namespace {

// Compares the lengths of the sides and diagonals of a polygon.
class PolygonLengths {
  public:
    explicit PolygonLengths(std::span<const glm::dvec4> corners) : corners_(corners) {}

    // Returns the density d if the polygon is the regular polygon {n/d} of n ≥ 4 sides, else 0.
    int densityIfRegular() const {
        const std::size_t n = corners_.size();
        const glm::dvec4 center = std::accumulate(corners_.begin(), corners_.end(), glm::dvec4(0)) / double(n);
        const double side = distance(0, 1), diagonal = distance(0, 2), radius = glm::distance(corners_[0], center);
        for (std::size_t i = 0; i < n; ++i) {
            if (!isNear(distance(i, i + 1), side) || !isNear(distance(i, i + 2), diagonal)) return 0;
            if (!isNear(glm::distance(corners_[i], center), radius)) return 0;
        }
        if (side > 2 * radius) return 0;
        // In a circle of this radius, a side of {n/d} is a chord over the angle 2π d/n. The diagonal that skips one
        // corner is a chord over twice this angle. In a polygon that is not flat, no d gives both lengths.
        const double half = std::asin(side / (2 * radius));
        const int sides = static_cast<int>(n), d = static_cast<int>(std::lround(sides * half / std::numbers::pi));
        const double exact = std::numbers::pi * d / sides;
        const bool fits =
            isNear(side, 2 * radius * std::sin(exact)) && isNear(diagonal, 2 * radius * std::abs(std::sin(2 * exact)));
        return fits && d > 0 && 2 * d < sides && std::gcd(d, sides) == 1 ? d : 0;
    }
    // The following functions are only for quadrilaterals.
    bool isParallelogram() const {
        const double skew = glm::distance(corners_[0] + corners_[2], corners_[1] + corners_[3]);
        return skew <= kRelative * std::max(distance(0, 2), distance(1, 3));
    }
    bool hasEqualSides() const { return isNear(distance(0, 1), distance(1, 2)); }
    bool hasEqualDiagonals() const { return isNear(distance(0, 2), distance(1, 3)); }

  private:
    static constexpr double kRelative = 0.01;

    double distance(std::size_t i, std::size_t j) const {
        return glm::distance(corners_[i % corners_.size()], corners_[j % corners_.size()]);
    }
    static bool isNear(double a, double b) { return std::abs(a - b) <= kRelative * std::max(a, b); }

    std::span<const glm::dvec4> corners_;
};

}  // namespace

std::string nameOfPolygon(std::span<const glm::dvec4> corners) {
    const PolygonLengths lengths(corners);
    const int sides = static_cast<int>(corners.size());
    if (sides == 4) {
        if (!lengths.isParallelogram()) return "quadrilateral";
        if (lengths.hasEqualSides()) return lengths.hasEqualDiagonals() ? "square" : "rhombus";
        return lengths.hasEqualDiagonals() ? "rectangle" : "quadrilateral";
    }
    const int density = sides > 4 ? lengths.densityIfRegular() : 0;
    return polygonNoun({sides, std::max(density, 1)});
}

}  // namespace oval4d::polytopes
