#pragma once
// What the tests of exported bodies share: a check of meshes of their own, and subjects to export.

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "export/budget.hpp"
#include "export/mesh.hpp"
#include "geometry_support.hpp"

namespace oval4d::exports::support {

using Key = std::tuple<float, float, float>;

/// As a program that knows nothing but the coordinates, in float32: every edge lies in two triangles, once each way,
/// the triangles around every point are one ring, and the volume is positive.
inline void expectPrintable(const Mesh& mesh) {
    ASSERT_FALSE(mesh.triangles.empty());
    ASSERT_EQ(mesh.cells.size(), mesh.triangles.size());
    std::map<Key, std::uint32_t> points;
    std::vector<std::uint32_t> same;
    for (const auto& p : mesh.points) {
        const Key key{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        same.push_back(points.try_emplace(key, points.size()).first->second);
    }
    // Each edge is there once in each direction, and what is around a point is one ring.
    const auto edge = [](std::uint32_t from, std::uint32_t to) { return (std::uint64_t{from} << 32U) | to; };
    std::unordered_map<std::uint64_t, std::uint32_t> next;  // from a point's neighbour to the one beside it
    next.reserve(3 * mesh.triangles.size());
    std::vector<std::size_t> sides(points.size());
    std::vector<std::uint32_t> neighbour(points.size());
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const auto a = same[t[i]];
            const auto b = same[t[(i + 1) % 3]];
            ASSERT_NE(a, b);
            ASSERT_TRUE(next.try_emplace(edge(a, b), same[t[(i + 2) % 3]]).second);
            ++sides[a];
            neighbour[a] = b;
        }
    }
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) ASSERT_TRUE(next.contains(edge(same[t[(i + 1) % 3]], same[t[i]])));
    }
    for (std::uint32_t a = 0; a < points.size(); ++a) {
        if (sides[a] == 0) continue;
        std::size_t steps = 1;
        for (auto b = next.at(edge(a, neighbour[a])); b != neighbour[a]; b = next.at(edge(a, b))) {
            ASSERT_LE(++steps, sides[a]);
        }
        ASSERT_EQ(steps, sides[a]);
    }
    double volume = 0;
    for (const auto& t : mesh.triangles) {
        volume += glm::dot(mesh.points[t[0]], glm::cross(mesh.points[t[1]], mesh.points[t[2]])) / 6;
    }
    ASSERT_GT(volume, 0);
    ASSERT_NEAR(volume, volumeOf(mesh), 1e-9 * std::abs(volume));
}

inline const Budget& unhurried() {
    static const Budget kBudget({100'000'000, std::numeric_limits<std::size_t>::max(), std::chrono::hours(1)}, {});
    return kBudget;
}

using geometry::support::named;
using geometry::support::Polygon;
using geometry::support::product;

inline const Polygon kSquare{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
inline const Polygon kDented{{-2, -2}, {2, -2}, {2, 0}, {0.5, 0}, {0.5, 1.5}, {-0.5, 1.5}, {-0.5, 0}, {-2, 0}};
inline constexpr double kDentedArea = 4 * 2 + 1 * 1.5;

inline Polygon pentagram() {
    Polygon star;
    for (int i = 0; i < 5; ++i)
        star.emplace_back(std::cos(4 * i * std::numbers::pi / 5), std::sin(4 * i * std::numbers::pi / 5));
    return star;
}
/// Of all that a pentagram of circumradius 1 winds around: ten triangles from its middle, between a point of the star
/// at distance 1 and an inner corner at distance φ⁻², 36° apart.
inline const double kPentagramArea =
    10 * 0.5 * std::sin(std::numbers::pi / 5) / (std::numbers::phi * std::numbers::phi);

/// Two polytopes as one, the second moved.
inline geometry::Polytope compound(const geometry::Polytope& a, const geometry::Polytope& b, const glm::dvec4& by) {
    std::vector<glm::dvec4> vertices = a.vertices;
    for (const auto& v : b.vertices) vertices.push_back(v + by);
    geometry::Lists faces = a.faces;
    geometry::Lists cells = a.cells;
    const auto append = [](geometry::Lists& into, const geometry::Lists& from, std::size_t shift) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            std::vector<std::uint32_t> list(from[i].begin(), from[i].end());
            for (auto& item : list) item += static_cast<std::uint32_t>(shift);
            into.add(list);
        }
    };
    append(faces, b.faces, a.vertices.size());
    append(cells, b.cells, a.faces.size());
    return geometry::makePolytope("compound", std::move(vertices), std::move(faces), std::move(cells));
}

}  // namespace oval4d::exports::support
