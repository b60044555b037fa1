#include "export/mesh/hull.hpp"

#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace oval4d::exports {

namespace {

using GridPoint = std::array<std::int64_t, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// An incremental convex hull. For each new point, triangles that are visible from the point are removed, and a fan of
// triangles joins the point to the boundary of the hole. Triangles whose plane contains the point are kept, so that no
// new triangle is degenerate.
class IncrementalHull {
  public:
    IncrementalHull(const std::vector<glm::dvec3>& points, double step) {
        for (const glm::dvec3& p : points) {
            points_.push_back({std::llround(p.x / step), std::llround(p.y / step), std::llround(p.z / step)});
        }
    }

    std::vector<Triangle> computeFacets(const ExportBudget* budget) {
        if (!findInitialTetrahedron()) return {};
        for (std::uint32_t p = 0; p < points_.size(); ++p) {
            if (budget != nullptr) budget->checkTimeAndStop();
            addPoint(p);
        }
        return std::move(triangles_);
    }

  private:
    /// Returns six times the volume of the tetrahedron abcp, where a, b and c are the corners of the triangle t. The
    /// result is ((b − a) × (c − a)) · (p − a), which is positive if p is on the outer side of t.
    std::int64_t sixVolume(const Triangle& t, std::uint32_t p) const {
        const GridPoint& o = points_[t[0]];
        const auto from = [&](std::uint32_t i) {
            return GridPoint{points_[i][0] - o[0], points_[i][1] - o[1], points_[i][2] - o[2]};
        };
        const GridPoint u = from(t[1]);
        const GridPoint v = from(t[2]);
        const GridPoint w = from(p);
        return w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
               w[2] * (u[0] * v[1] - u[1] * v[0]);
    }

    bool areCollinear(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const auto minor = [&](int i, int j) {
            return (points_[b][i] - points_[a][i]) * (points_[c][j] - points_[a][j]) -
                   (points_[b][j] - points_[a][j]) * (points_[c][i] - points_[a][i]);
        };
        return minor(0, 1) == 0 && minor(1, 2) == 0 && minor(2, 0) == 0;
    }

    /// Finds four points for the first tetrahedron. Returns false if all points lie in one plane.
    bool findInitialTetrahedron() {
        const auto count = static_cast<std::uint32_t>(points_.size());
        std::uint32_t b = 1;
        while (b < count && points_[b] == points_[0]) ++b;
        std::uint32_t c = b + 1;
        while (c < count && areCollinear(0, b, c)) ++c;
        std::uint32_t d = c + 1;
        while (d < count && sixVolume({0, b, c}, d) == 0) ++d;
        if (d >= count) return false;
        if (sixVolume({0, b, c}, d) > 0) std::swap(b, c);
        triangles_ = {{0, b, c}, {0, c, d}, {c, b, d}, {b, 0, d}};
        return true;
    }

    void addPoint(std::uint32_t p) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;  // directed edges of removed triangles
        const auto removed = std::erase_if(triangles_, [&](const Triangle& t) {
            if (sixVolume(t, p) <= 0) return false;
            for (int i = 0; i < 3; ++i) seen.emplace(t[i], t[(i + 1) % 3]);
            return true;
        });
        if (removed == 0) return;
        for (const auto& [a, b] : seen) {
            if (!seen.contains({b, a})) triangles_.push_back({a, b, p});
        }
    }

    std::vector<GridPoint> points_;
    std::vector<Triangle> triangles_;
};

}  // namespace

Mesh convexHullOfGridPoints(const std::vector<glm::dvec3>& points, const RoundingGrid& grid,
                            const ExportBudget* budget) {
    Mesh mesh;
    std::vector<std::optional<std::uint32_t>> numbers(points.size());
    const auto number = [&](std::uint32_t point) {
        if (!numbers[point]) {
            numbers[point] = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.push_back(points[point]);
        }
        return *numbers[point];
    };
    for (const auto& [a, b, c] : IncrementalHull(points, grid.step()).computeFacets(budget)) {
        const std::uint32_t first = number(a);
        const std::uint32_t second = number(b);
        mesh.add(first, second, number(c), kNoCell);
    }
    return mesh;
}

}  // namespace oval4d::exports
