// Tests that the convex hull does not change when its points are moved, scaled or rounded.

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
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
using support::sound;
using support::turned;
using support::turnedToSize1;
using support::warningsOf;
using Points = std::vector<glm::dvec4>;

void expectTheSame(const char* name, const std::string& text, const std::string& how) {
    const ImportedPolytope imported = sound(importPoints(text));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named(name))) << name << ", " << how;
    EXPECT_EQ(warningsOf(imported), "") << name << ", " << how;
    EXPECT_EQ(imported.polytope.cellTypes.size(), 1U) << name << ", " << how;
}

/// Expects the numbers of elements of a named polytope. Unlike expectTheSame(), allows several types of cells.
void expectTheCounts(const char* name, const std::string& text, const std::string& how) {
    const ImportedPolytope imported = sound(importPoints(text));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named(name))) << name << ", " << how;
    EXPECT_EQ(warningsOf(imported), "") << name << ", " << how;
}

TEST(Hull, IsInvariantUnderTranslation) {
    std::mt19937 random(21);
    for (const char* name : kRegular) {
        for (const double distance : {0.3, 7.0, 1e3, 1e5}) {
            Points points = turnedToSize1(name, random);
            const glm::dvec4 by = distance * randomDirection(random);
            for (auto& p : points) p += by;
            const std::string how = "moved by " + std::to_string(distance);
            for (const int decimals : {4, 6, 9}) expectTheSame(name, formatted(points, "%.*f", decimals), how);
            expectTheSame(name, formatted(points, "%.*g", 17), how);
            expectTheSame(name, formatted(points, "%.*e", 12), how);
        }
    }
}

TEST(Hull, OfWholeNumbersIsInvariantUnderTranslation) {
    Points tesseract, permutations;  // tesseract: (±1, ±1, ±1, ±1); permutations: those of (±1, ±1, 0, 0), which are a
                                     // 24-cell
    for (int i = 0; i < 81; ++i) {
        const glm::dvec4 p(i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1, i / 27 - 1);
        if (glm::dot(p, p) == 4) tesseract.push_back(p);
        if (glm::dot(p, p) == 2) permutations.push_back(p);
    }
    for (const glm::dvec4& by : {glm::dvec4(10, 0, 0, 0), glm::dvec4(0, 0, 0, -10), glm::dvec4(1e5, 3e4, 0, 7)}) {
        for (const double size : {1.0, 0.5, 1000.0}) {
            for (const auto& [name, corners] : {std::pair("8-cell", tesseract), std::pair("24-cell", permutations)}) {
                Points points = corners;
                for (auto& p : points) p = size * p + by;
                expectTheSame(name, asPoints(points), "with whole numbers and halves");
            }
        }
    }
}

TEST(Hull, IsInvariantUnderScaling) {
    std::mt19937 random(22);
    for (const char* name : kRegular) {
        for (int power = -9; power <= 8; power += support::kSanitized ? 6 : 1) {
            Points points = turnedToSize1(name, random);
            for (auto& p : points) p = std::pow(10.0, power) * (p + glm::dvec4(0.7, 0, 3, 0));
            const std::string how = "times 10^" + std::to_string(power);
            for (const int digits : {5, 11, 17}) expectTheSame(name, formatted(points, "%.*g", digits), how);
            if (power <= 0) expectTheSame(name, formatted(points, "%.*f", 4 - power), how);
        }
    }
}

TEST(Hull, IsTheSameWithAnyNumberOfDecimals) {
    std::mt19937 random(23);
    for (const char* name : kRegular) {
        for (int decimals = 3; decimals <= 17; decimals += support::kSanitized ? 5 : 1) {
            const Points points = turnedToSize1(name, random);
            const std::string how = std::to_string(decimals) + " decimals";
            expectTheSame(name, formatted(points, "%.*f", decimals), how);
            expectTheSame(name, formatted(points, "%.*g", decimals), how);
        }
    }
}

TEST(Hull, WarnsHowWholeNumbersAreTreated) {
    std::mt19937 random(24);
    Points points = turnedToSize1("120-cell", random);
    for (auto& p : points) p = glm::round(1e6 * p);
    const ImportedPolytope imported = sound(importPoints(asPoints(points)));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named("120-cell")));
    EXPECT_NE(warningsOf(imported).find("treated as rounded: the hull has 120 cells if they are rounded"),
              std::string::npos)
        << warningsOf(imported);
}

TEST(Hull, WarnsHowFewDecimalsAreTreated) {
    std::mt19937 random(37);
    for (int trial = 0; trial < 10; ++trial) {
        const std::string text = formatted(turnedToSize1("24-cell", random), "%.*f", 2);
        const ImportedPolytope imported = sound(importPoints(text));
        EXPECT_EQ(countsOf(imported.polytope), countsOf(named("24-cell")));
        EXPECT_NE(warningsOf(imported).find("the coordinates have few decimals and were treated as rounded: the hull "
                                            "has 24 cells if they are rounded, "),
                  std::string::npos)
            << warningsOf(imported);
    }
    for (int trial = 0; trial < 100; ++trial) {
        std::uniform_int_distribution<int> coordinate(-20 * (trial % 5 + 1), 20 * (trial % 5 + 1));
        Points points(static_cast<std::size_t>(8 + trial % 70));
        for (auto& p : points)
            p = glm::dvec4(coordinate(random), coordinate(random), coordinate(random), coordinate(random)) / 4.0;
        const ImportedPolytope imported = sound(importPoints(asPoints(points)));
        EXPECT_EQ(warningsOf(imported).find("treated as rounded"), std::string::npos) << warningsOf(imported);
    }
}

TEST(Hull, FarFromTheOriginIsOrientedOutward) {
    std::mt19937 random(32);
    for (const char* name : kRegular) {
        const double volume = support::hypervolumeBySlices(named(name), support::randomRotation(random));
        const double size = named(name).circumradius;
        Points points = turned(named(name), random);
        const glm::dvec4 by = 1e4 * size * randomDirection(random);
        for (auto& p : points) p += by;
        const Polytope moved = sound(importPoints(asPoints(points))).polytope;
        EXPECT_TRUE(moved.convex) << name;
        EXPECT_NEAR(support::hypervolumeBySlices(moved, support::randomRotation(random)), volume, 1e-2 * volume);
    }
}

TEST(Hull, CellTypesAreTheSameFarFromTheOrigin) {
    const auto polygon = [](int n) {
        support::Polygon corners;
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * i / n;
            corners.emplace_back(std::cos(angle), std::sin(angle));
        }
        return corners;
    };
    Points points = support::product(polygon(4), {{0, 0}, {1, 0}, {1, 3}, {0, 3}}).vertices;
    const std::size_t cellTypes = sound(importPoints(asPoints(points))).polytope.cellTypes.size();
    EXPECT_GT(cellTypes, 1U);
    for (auto& p : points) p += glm::dvec4(1e4, 0, -1e4, 5e3);
    EXPECT_EQ(sound(importPoints(asPoints(points))).polytope.cellTypes.size(), cellTypes);
}

/// Returns a number with the fewest digits that identify it among the numbers of its type, as Python and C++ write it.
template <class Number>
std::string shortest(Number value) {
    std::array<char, 64> digits{};
    return {digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr};
}

/// Returns the points as text: each coordinate is rounded to single precision and written with the fewest digits.
std::string shortestSingles(const Points& points) {
    std::string text;
    for (const auto& p : points) {
        for (int i = 0; i < 4; ++i) text += shortest(static_cast<float>(p[i])) + (i == 3 ? '\n' : ' ');
    }
    return text;
}

// The hull of a polytope's vertices is the polytope, even if the coordinates are single-precision numbers. The
// coordinates are written with the numbers of digits that programs use.
TEST(Hull, OfSinglePrecisionNumbersIsThePolytope) {
    std::mt19937 random(33);
    constexpr std::array kNames{"8-cell", "24-cell", "120-cell", "600-cell", "3,6-duoprism", "rectified 5-cell"};
    const std::array<std::pair<const char*, int>, 9> formats{{{"%.*g", 8},
                                                              {"%.*g", 9},
                                                              {"%.*g", 17},
                                                              {"%.*e", 8},
                                                              {"%.*e", 9},
                                                              {"%.*f", 8},
                                                              {"%.*f", 10},
                                                              {"%.*f", 12},
                                                              {"%.*e", 18}}};
    for (const char* name : kNames) {
        for (const double scale : {1e-3, 1.0, 1e3}) {
            for (const double distance : {0.0, 3.0}) {
                Points points = turnedToSize1(name, random);
                const glm::dvec4 by = distance * randomDirection(random);
                for (auto& p : points) p = glm::dvec4(glm::vec4(scale * (p + by)));
                const std::string how = " at scale " + std::to_string(scale) + " by " + std::to_string(distance);
                for (const auto& [format, digits] : formats)
                    expectTheCounts(name, formatted(points, format, digits), format + std::to_string(digits) + how);
                expectTheCounts(name, shortestSingles(points), "shortest" + how);
            }
        }
    }
}

// With a fixed number of decimals, a coordinate near 0 has fewer significant digits than single precision. The
// coordinates still count as single-precision numbers.
TEST(Hull, OfSinglePrecisionNumbersMayHaveACoordinateNearZero) {
    std::mt19937 random(34);
    for (const double tiny : {1e-3, 1e-4, 1e-6, 1e-9}) {
        Points points = turnedToSize1("8-cell", random);
        for (const double by = tiny - points[0].y; auto& p : points) p.y += by;
        for (auto& p : points) p = glm::dvec4(glm::vec4(p));
        for (const int decimals : {8, 10, 12}) expectTheCounts("8-cell", formatted(points, "%.*f", decimals), "tiny");
    }
}

// Two cells at an angle of 1e-5 are separate cells if the points are in double precision, and one cell if they are in
// single precision.
TEST(Hull, OfDoublesIsNotTakenForSinglePrecision) {
    std::mt19937 random(35);
    Points points = turnedToSize1("8-cell", random);
    const Points corners = points;
    glm::dvec4 middle(0);  // the center of a cell
    const Polytope& cube = named("8-cell");
    std::set<std::uint32_t> own;
    for (const auto f : cube.cells[0]) own.insert(cube.faces[f].begin(), cube.faces[f].end());
    for (const auto v : own) middle += corners[v] / static_cast<double>(own.size());
    points.push_back(middle * (1 + 1e-7));
    for (const int digits : {10, 12, 17}) {
        // A point above the center of a cell replaces the cell by six pyramids, one on each of its 2-faces.
        EXPECT_EQ(sound(importPoints(formatted(points, "%.*f", digits))).polytope.cellCount(), 13U) << digits;
    }
    for (auto& p : points) p = glm::dvec4(glm::vec4(p));
    for (const int digits : {10, 12, 17})
        EXPECT_EQ(sound(importPoints(formatted(points, "%.*f", digits))).polytope.cellCount(), 8U) << digits;
}

}  // namespace
}  // namespace oval4d::polytopes
