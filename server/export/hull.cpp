#include "export/hull.hpp"

#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace oval4d::exports {

namespace {

using Place = std::array<std::int64_t, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// Point after point: the triangles that see it give way to a fan over the rim of the hole that they leave. A triangle
// in whose plane the point lies stays; so no new triangle is without an area.
class Hull {
  public:
    Hull(const std::vector<glm::dvec3>& points, double step) {
        for (const glm::dvec3& p : points) {
            places_.push_back({std::llround(p.x / step), std::llround(p.y / step), std::llround(p.z / step)});
        }
    }

    std::vector<Triangle> run() {
        if (!begin()) return {};
        for (std::uint32_t p = 0; p < places_.size(); ++p) add(p);
        return std::move(triangles_);
    }

  private:
    /// Six times the volume of the tetrahedron of the triangle and p: positive where p is outside.
    std::int64_t above(const Triangle& t, std::uint32_t p) const {
        const Place& o = places_[t[0]];
        const auto from = [&](std::uint32_t i) {
            return Place{places_[i][0] - o[0], places_[i][1] - o[1], places_[i][2] - o[2]};
        };
        const Place u = from(t[1]);
        const Place v = from(t[2]);
        const Place w = from(p);
        return w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
               w[2] * (u[0] * v[1] - u[1] * v[0]);
    }

    bool inLine(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const auto minor = [&](int i, int j) {
            return (places_[b][i] - places_[a][i]) * (places_[c][j] - places_[a][j]) -
                   (places_[b][j] - places_[a][j]) * (places_[c][i] - places_[a][i]);
        };
        return minor(0, 1) == 0 && minor(1, 2) == 0 && minor(2, 0) == 0;
    }

    /// The first tetrahedron.
    bool begin() {
        const auto count = static_cast<std::uint32_t>(places_.size());
        std::uint32_t b = 1;
        while (b < count && places_[b] == places_[0]) ++b;
        std::uint32_t c = b + 1;
        while (c < count && inLine(0, b, c)) ++c;
        std::uint32_t d = c + 1;
        while (d < count && above({0, b, c}, d) == 0) ++d;
        if (d >= count) return false;
        if (above({0, b, c}, d) > 0) std::swap(b, c);
        triangles_ = {{0, b, c}, {0, c, d}, {c, b, d}, {b, 0, d}};
        return true;
    }

    void add(std::uint32_t p) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;  // edges of the triangles that give way
        const auto giveWay = std::erase_if(triangles_, [&](const Triangle& t) {
            if (above(t, p) <= 0) return false;
            for (int i = 0; i < 3; ++i) seen.emplace(t[i], t[(i + 1) % 3]);
            return true;
        });
        if (giveWay == 0) return;
        for (const auto& [a, b] : seen) {
            if (!seen.contains({b, a})) triangles_.push_back({a, b, p});
        }
    }

    std::vector<Place> places_;
    std::vector<Triangle> triangles_;
};

}  // namespace

Mesh hullOf(const std::vector<glm::dvec3>& points, const Grid& grid) {
    Mesh mesh;
    std::vector<std::optional<std::uint32_t>> numbers(points.size());
    const auto number = [&](std::uint32_t point) {
        if (!numbers[point]) {
            numbers[point] = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.push_back(points[point]);
        }
        return *numbers[point];
    };
    for (const auto& [a, b, c] : Hull(points, grid.step()).run()) {
        const std::uint32_t first = number(a);
        const std::uint32_t second = number(b);
        mesh.add(first, second, number(c), kNoCell);
    }
    return mesh;
}

}  // namespace oval4d::exports
