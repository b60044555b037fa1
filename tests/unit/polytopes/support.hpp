#pragma once
// Helpers that several tests share: polytopes by name, polytopes made by hand, rotations, directions.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "geometry/rotation.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::support {

/// Whether the tests are built with AddressSanitizer or ThreadSanitizer, which make them several times slower. Long
/// property tests then try fewer inputs, because a sanitizer finds an error of memory or threads with any input that
/// reaches the faulty code.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Returns the cache of polytopes that all tests of the program share.
inline polytopes::PolytopeCache& cache() {
    static polytopes::PolytopeCache kCache;
    return kCache;
}

/// Returns the design (polytopes::designNamed()) of a polytope with at most 1,000,000 vertices. Throws
/// std::bad_variant_access if `name` names no such polytope.
inline polytopes::PolytopeDesign designFor(std::string_view name) {
    return std::get<polytopes::PolytopeDesign>(polytopes::designNamed(name, 1'000'000));
}

inline std::shared_ptr<const polytopes::Polytope> shared(std::string_view name) {
    return cache().findOrBuild(designFor(name));
}

/// Returns the polytope with this name. The reference remains valid until the program ends.
inline const polytopes::Polytope& named(std::string_view name) {
    static std::map<std::string, std::shared_ptr<const polytopes::Polytope>, std::less<>> kept;
    auto& polytope = kept[std::string(name)];
    if (!polytope) polytope = shared(name);
    return *polytope;
}

inline geometry::Rotation randomRotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto quaternion = [&] { return glm::dquat(normal(random), normal(random), normal(random), normal(random)); };
    const glm::dquat left = quaternion();
    return {left, quaternion()};
}

/// Returns a random point of the unit sphere.
inline glm::dvec4 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec4(normal(random), normal(random), normal(random), normal(random)));
}

/// Returns a rotation that turns `direction` onto the +w axis.
inline geometry::Rotation ontoW(const glm::dvec4& direction) {
    return {glm::conjugate(glm::normalize(glm::dquat(direction.w, direction.x, direction.y, direction.z))),
            glm::dquat(1, 0, 0, 0)};
}

/// Expects that both lists have equally many points, and that each point of `one` is less than `tolerance` away from a
/// point of `other`.
inline void expectSamePoints(const std::vector<glm::dvec4>& one, const std::vector<glm::dvec4>& other,
                             double tolerance) {
    ASSERT_EQ(one.size(), other.size());
    for (const glm::dvec4& p : one) {
        const auto nearest = std::ranges::min(other, {}, [&](const glm::dvec4& q) { return glm::distance(p, q); });
        EXPECT_LT(glm::distance(p, nearest), tolerance);
    }
}

using Polygon = std::vector<glm::dvec2>;

/// Returns the Cartesian product of the polygon `p` in the xy plane and the polygon `q` in the zw plane. Its cells are
/// prisms over the two polygons.
inline polytopes::Polytope product(const Polygon& p, const Polygon& q) {
    const auto n = static_cast<std::uint32_t>(p.size());
    const auto m = static_cast<std::uint32_t>(q.size());
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return (i % n) * m + j % m; };
    std::vector<glm::dvec4> vertices;
    for (const auto& a : p) {
        for (const auto& b : q) vertices.emplace_back(a, b);
    }
    geometry::JaggedArray faces;  // n · m rectangles, then m copies of the polygon p, then n copies of the polygon q
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            faces.add(std::array{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    std::vector<std::uint32_t> loop;
    for (std::uint32_t j = 0; j < m; ++j) {
        loop.clear();
        for (std::uint32_t i = 0; i < n; ++i) loop.push_back(vertex(i, j));
        faces.add(loop);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        loop.clear();
        for (std::uint32_t j = 0; j < m; ++j) loop.push_back(vertex(i, j));
        faces.add(loop);
    }
    geometry::JaggedArray cells;
    for (std::uint32_t j = 0; j < m; ++j) {
        loop = {n * m + j, n * m + (j + 1) % m};
        for (std::uint32_t i = 0; i < n; ++i) loop.push_back(i * m + j);
        cells.add(loop);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        loop = {n * m + m + i, n * m + m + (i + 1) % n};
        for (std::uint32_t j = 0; j < m; ++j) loop.push_back(i * m + j);
        cells.add(loop);
    }
    return polytopes::makePolytope("product", std::move(vertices), std::move(faces), std::move(cells));
}

/// The text of a 4OFF file of a 5-cell that looks as if written by hand: it has comments, irregular white space,
/// various number formats, colors, and a wrong number of edges.
inline constexpr const char* kPentachoron = R"(#before the header
4OFF# the edges below are wrong on purpose
5 10 7 5
+1 1 1 -.4472136 # glued comments, signs, few digits
1e0 -1 -1 -.4472136 255 0 0
-1 1 -1 -.4472136

-1	-1 1 -.4472136   
0 0 0 1.7888544
3 0 1 2 0.5 0.5 0.5
3 0 1 3 12 200 7 255
3 0 1 4#
3 0 2 3
3 0 2 4
3 0 3 4
3 1 2 3
3 1 2 4
3 1 3 4
3 2 3 4
4 0 1 3 6 255 0 0
4 0 2 4 7
4 1 2 5 8
4 3 4 5 9
4 6 7 8 9
# the end)";

inline glm::dvec4 centerOfCell(const polytopes::Polytope& p, std::size_t cell) {
    glm::dvec4 sum(0);
    double count = 0;
    for (const auto f : p.cells[cell]) {
        for (const auto v : p.faces[f]) {
            sum += p.vertices[v];
            ++count;
        }
    }
    return sum / count;
}

}  // namespace oval4d::support
