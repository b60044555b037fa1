// Tests of the convex hulls of points: their elements, and the points that are not accepted.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/vec4.hpp>

#include "polytopes/import/import.hpp"
#include "unit/polytopes/import/import_support.hpp"

namespace oval4d::polytopes {
namespace {

using support::asPoints;
using support::countsOf;
using support::formatted;
using support::importPoints;
using support::kRegular;
using support::named;
using support::randomDirection;
using support::reasonOf;
using support::sound;
using support::turnedToSize1;
using support::warningsOf;
using Points = std::vector<glm::dvec4>;

/// Returns the Euler characteristic V − E + F − C of the boundary; it is 0 for a 3-sphere.
std::ptrdiff_t eulerOf(const Polytope& p) {
    const auto [v, e, f, c] = countsOf(p);
    return static_cast<std::ptrdiff_t>(v + f) - static_cast<std::ptrdiff_t>(e + c);
}

// The hull of points with whole coordinates is exact, which is checked in integer arithmetic: all points lie on one
// side of each cell's hyperplane, and the hull's vertices in the hyperplane are exactly the corners of the cell.
TEST(Hull, OfWholeNumbersIsExact) {
    using Exact = std::array<std::int64_t, 4>;
    const auto between = [](const glm::dvec4& a, const glm::dvec4& b) {
        Exact d;
        for (int i = 0; i < 4; ++i) d.at(i) = static_cast<std::int64_t>(a[i] - b[i]);
        return d;
    };
    const auto dot = [](const Exact& a, const Exact& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    };
    const auto normalOf = [](const Exact& a, const Exact& b, const Exact& c) {
        Exact n;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t x = (i + 1) % 4, y = (i + 2) % 4, z = (i + 3) % 4;
            const auto minor = [&](std::size_t p, std::size_t q) { return b.at(p) * c.at(q) - b.at(q) * c.at(p); };
            n.at(i) = (i % 2 == 0 ? 1 : -1) * (a.at(x) * minor(y, z) - a.at(y) * minor(x, z) + a.at(z) * minor(x, y));
        }
        return n;
    };
    std::mt19937 random(25);
    for (int trial = 0; trial < 200; ++trial) {
        const int most = std::array{2, 3, 5, 10, 30, 100, 300, 1000}.at(trial % 8);
        std::uniform_int_distribution<int> coordinate(-most, most);
        Points points(static_cast<std::size_t>(8 + trial % 70));
        const glm::dvec4 by(trial % 3 * 1000);
        for (auto& p : points)
            p = by + glm::dvec4(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
        const ImportedPolytope imported = sound(importPoints(asPoints(points)));
        const Polytope& hull = imported.polytope;
        EXPECT_EQ(eulerOf(hull), 0);
        Points corners;  // in the coordinates of the file, which are exact even if the origin was moved to the center
        for (const auto& v : hull.vertices) {
            corners.push_back(v + hull.originInFile);
            ASSERT_NE(std::find(points.begin(), points.end(), corners.back()), points.end()) << "trial " << trial;
        }
        for (std::size_t c = 0; c < hull.cellCount(); ++c) {
            std::set<std::uint32_t> own;
            for (const auto f : hull.cells[c]) own.insert(hull.faces[f].begin(), hull.faces[f].end());
            const auto face = hull.faces[hull.cells[c][0]];
            const glm::dvec4& at = corners[face[0]];
            Exact normal{};
            for (const auto v : own) {
                normal =
                    normalOf(between(corners[face[1]], at), between(corners[face[2]], at), between(corners[v], at));
                if (normal != Exact{}) break;
            }
            ASSERT_NE(normal, Exact{}) << "cell " << c << " is flat";
            bool above = false, below = false;
            for (const auto& p : points) {
                above = above || dot(normal, between(p, at)) > 0;
                below = below || dot(normal, between(p, at)) < 0;
            }
            EXPECT_NE(above, below) << "trial " << trial << ", cell " << c;
            for (std::uint32_t v = 0; v < corners.size(); ++v) {
                EXPECT_EQ(dot(normal, between(corners[v], at)) == 0, own.count(v) == 1)
                    << "trial " << trial << ", cell " << c << ", vertex " << v;
            }
        }
    }
}

TEST(Hull, OfPointsInABallIsASphere) {
    std::mt19937 random(26);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const int count : {6, 20, 100, 1000}) {
        for (const int decimals : {3, 6, 17}) {
            Points points(static_cast<std::size_t>(count));
            for (auto& p : points) p = std::pow(uniform(random), 0.25) * randomDirection(random);
            const ImportedPolytope imported = sound(importPoints(formatted(points, "%.*f", decimals)));
            const Polytope& hull = imported.polytope;
            EXPECT_EQ(eulerOf(hull), 0) << count << " with " << decimals;
            if (decimals == 17) {  // all cells are simplices, because the points are in general position
                EXPECT_EQ(hull.faces.size(), 2 * hull.cellCount());
                EXPECT_TRUE(hull.convex);
            }
            const std::size_t inside = points.size() - hull.vertices.size();
            if (inside > 0) {
                EXPECT_EQ(imported.warnings.at(0).substr(0, std::to_string(inside).size() + 4),
                          std::to_string(inside) + " of ");
            }
        }
    }
}

TEST(Hull, OfManyPointsOnASphereHasThemAll) {
    std::mt19937 random(27);
    Points points(14'000);
    for (auto& p : points) p = randomDirection(random);
    const ImportedPolytope imported = sound(importPoints(formatted(points, "%.*f", 5)));
    EXPECT_EQ(imported.polytope.vertices.size(), points.size());
    EXPECT_EQ(eulerOf(imported.polytope), 0);
    // The points are about 0.1 apart, so some tetrahedra are nearly flat.
    EXPECT_NE(warningsOf(imported).find("too imprecise to tell whether the two cells lie in one hyperplane"),
              std::string::npos)
        << warningsOf(imported);
}

// The hull of points on the moment curve (t, t², t³, t⁴) is the cyclic polytope, although the coordinates are whole
// numbers of very different sizes.
TEST(Hull, OfTheMomentCurveIsTheCyclicPolytope) {
    for (const int n : {6, 13, 30, 60}) {
        for (const double start : {0.0, -n / 2.0}) {
            Points points;
            for (int i = 0; i < n; ++i) {
                const double t = std::round(start) + i;
                points.emplace_back(t, t * t, t * t * t, t * t * t * t);
            }
            const Polytope hull = sound(importPoints(asPoints(points))).polytope;
            EXPECT_EQ(hull.vertices.size(), points.size());
            EXPECT_EQ(hull.edges.size(), points.size() * (points.size() - 1) / 2) << n;
            EXPECT_EQ(hull.cellCount(), points.size() * (points.size() - 3) / 2) << n;
        }
    }
}

// Points inside edges, 2-faces and cells of the tesseract are not vertices of the hull, even if they are rounded.
TEST(Hull, OfAGridIsTheTesseract) {
    std::mt19937 random(28);
    for (const int n : {3, 5}) {
        Points grid;
        for (int i = 0; i < n * n * n * n; ++i) grid.emplace_back(i % n, i / n % n, i / n / n % n, i / n / n / n);
        const geometry::Rotation rotation = support::randomRotation(random);
        Points rotated;
        for (const auto& p : grid) rotated.push_back(rotation(p));
        const std::string said =
            std::to_string(grid.size() - 16) + " of " + std::to_string(grid.size()) + " points are not hull vertices";
        for (const auto& text : {asPoints(grid), formatted(rotated, "%.*f", 4), formatted(rotated, "%.*g", 17)}) {
            const ImportedPolytope imported = sound(importPoints(text));
            EXPECT_EQ(countsOf(imported.polytope), countsOf(named("8-cell")));
            EXPECT_EQ(warningsOf(imported), said + " and were left out");
        }
    }
}

TEST(Hull, MergesDuplicatePoints) {
    std::mt19937 random(29);
    Points points = turnedToSize1("600-cell", random);
    points.push_back(points[7]);
    const ImportedPolytope one = sound(importPoints(formatted(points, "%.*f", 6)));
    EXPECT_EQ(countsOf(one.polytope), countsOf(named("600-cell")));
    EXPECT_EQ(warningsOf(one), "1 of 121 points is not a hull vertex and was left out");
    const Points all = turnedToSize1("600-cell", random);
    points = all;
    points.insert(points.end(), all.begin(), all.end());
    EXPECT_EQ(warningsOf(sound(importPoints(asPoints(points)))),
              "120 of 240 points are not hull vertices and were left out");
}

TEST(Hull, OfFlattenedPolytopesKeepsTheirCells) {
    std::mt19937 random(30);
    for (const char* name : kRegular) {
        const geometry::Rotation rotation = support::randomRotation(random);
        Points points = turnedToSize1(name, random);
        for (auto& p : points) p = rotation(p * glm::dvec4(1, 1, 1, 1e-5));
        EXPECT_EQ(countsOf(sound(importPoints(asPoints(points))).polytope), countsOf(named(name))) << name;
    }
}

TEST(Hull, OfPointsInAHyperplaneIsRefused) {
    std::mt19937 random(31);
    const geometry::Rotation rotation = support::randomRotation(random);
    const std::array<std::string, 4> says{"are the same point", "lie on one line", "lie in one plane",
                                          "lie in one hyperplane"};
    for (int dimension = 0; dimension < 4; ++dimension) {
        Points points;
        for (int i = 0; i < 50; ++i) {
            glm::dvec4 p(0.3, 0.4, 0.5, 0.6);
            const glm::dvec4 d = randomDirection(random);
            for (int k = 0; k < dimension; ++k) p[k] = d[k];
            points.push_back(1e-3 * rotation(p) + glm::dvec4(5));
        }
        for (const auto& text : {asPoints(points), formatted(points, "%.*f", 6)}) {
            const std::string reason = reasonOf(importPoints(text));
            EXPECT_NE(reason.find("all points " + says.at(static_cast<std::size_t>(dimension))), std::string::npos)
                << reason;
        }
    }
}

}  // namespace
}  // namespace oval4d::polytopes
