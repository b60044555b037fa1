#include "export/drawing/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/common.hpp>

namespace oval4d::exports {

namespace {

// A visitor that cuts shapes at x = ±farthest and y = ±farthest.
class ShapeClipper {
  public:
    explicit ShapeClipper(double farthest) : farthest_(farthest) {}

    std::optional<DrawnShape> operator()(LineSegment line) const {
        for (int bound = 0; bound < 4; ++bound) {
            const double a = distanceInsideBound(line.from, bound), b = distanceInsideBound(line.to, bound);
            if (a < 0 && b < 0) return std::nullopt;
            if (a < 0) line.from = crossingOfBound(line.from, line.to, a, b);
            if (b < 0) line.to = crossingOfBound(line.from, line.to, a, b);
        }
        return line;
    }
    std::optional<DrawnShape> operator()(Polyline line) const {
        cutPolylineAtBounds(line.points, false);
        if (line.points.size() < 2) return std::nullopt;
        return line;
    }
    std::optional<DrawnShape> operator()(FilledPolygon polygon) const {
        cutPolylineAtBounds(polygon.corners, true);
        if (polygon.corners.empty()) return std::nullopt;
        return polygon;
    }
    std::optional<DrawnShape> operator()(const Disk& disk) const {
        const glm::dvec2 reach = glm::abs(disk.center) + disk.radius;
        if (std::max(reach.x, reach.y) <= farthest_) return disk;
        constexpr int kCorners = 360;
        FilledPolygon polygon{{}, disk.color, disk.opacity};
        for (int i = 0; i < kCorners; ++i) {
            const double angle = 2 * std::numbers::pi * i / kCorners;
            polygon.corners.push_back(disk.center + disk.radius * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
        return (*this)(std::move(polygon));
    }
    std::optional<DrawnShape> operator()(const TextLine& line) const {
        if (std::max(std::abs(line.at.x), std::abs(line.at.y)) > farthest_) return std::nullopt;
        return line;
    }
    std::optional<DrawnShape> operator()(const OpacityImage& density) const { return density; }

  private:
    // Cuts a polyline at all four bounds. If `closed`, the polyline also joins the last point to the first.
    void cutPolylineAtBounds(std::vector<glm::dvec2>& points, bool closed) const {
        for (int bound = 0; bound < 4; ++bound) {
            std::vector<glm::dvec2> kept;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const glm::dvec2& here = points[i];
                const double a = distanceInsideBound(here, bound);
                if (a >= 0) kept.push_back(here);
                if (!closed && i + 1 == points.size()) break;
                const glm::dvec2& next = points[(i + 1) % points.size()];
                const double b = distanceInsideBound(next, bound);
                if ((a < 0) != (b < 0)) kept.push_back(crossingOfBound(here, next, a, b));
            }
            points = std::move(kept);
        }
    }

    // Returns the distance from position `at` to a bound: positive inside the bound, negative outside. The bounds 0 … 3
    // are x = farthest, x = −farthest, y = farthest and y = −farthest.
    double distanceInsideBound(const glm::dvec2& at, int bound) const {
        return farthest_ - (bound % 2 == 0 ? 1 : -1) * at[bound / 2];
    }

    // Returns the point where the line from `a` to `b` crosses a bound. `insideA` and `insideB` are the results of
    // distanceInsideBound() for `a` and `b`. Exactly one of them must be negative.
    static glm::dvec2 crossingOfBound(const glm::dvec2& a, const glm::dvec2& b, double insideA, double insideB) {
        return a + insideA / (insideA - insideB) * (b - a);
    }

    double farthest_;
};

}  // namespace

std::optional<DrawnShape> cutAtBounds(const DrawnShape& shape, double farthest) {
    return std::visit(ShapeClipper(farthest), shape);
}

}  // namespace oval4d::exports
