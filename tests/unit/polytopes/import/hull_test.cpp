#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "polytopes/import/import.hpp"
#include "polytopes/import/written_precision.hpp"
#include "unit/polytopes/import/import_support.hpp"

namespace oval4d::polytopes {
namespace {

using support::asPoints;
using support::countsOf;
using support::importPoints;
using support::named;
using support::reasonOf;
using support::sound;
using support::turned;
using support::warningsOf;
using Points = std::vector<glm::dvec4>;

constexpr std::array kRegular{"5-cell", "8-cell", "16-cell", "24-cell", "120-cell", "600-cell"};

/// The points as text, one on each line. `format` is a printf format with a precision argument, such as "%.*f".
std::string formatted(const Points& points, const char* format, int digits) {
    std::string text;
    for (const auto& p : points) {
        for (int i = 0; i < 4; ++i) {
            char number[64];
            std::snprintf(number, sizeof number, format, digits, p[i]);
            text += std::string(number) + (i == 3 ? '\n' : ' ');
        }
    }
    return text;
}

/// The Euler characteristic of the boundary, a 3-sphere: V − E + F − C = 0.
std::ptrdiff_t eulerOf(const Polytope& p) {
    const auto [v, e, f, c] = countsOf(p);
    return static_cast<std::ptrdiff_t>(v + f) - static_cast<std::ptrdiff_t>(e + c);
}

/// The vertices of a regular polytope of circumradius 1 in random orientation.
Points turnedToSize1(const char* name, std::mt19937& random) {
    Points points = turned(named(name), random);
    for (auto& p : points) p /= named(name).circumradius;
    return points;
}

glm::dvec4 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec4(normal(random), normal(random), normal(random), normal(random)));
}

void expectTheSame(const char* name, const std::string& text, const std::string& how) {
    const Imported imported = sound(importPoints(text));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named(name))) << name << ", " << how;
    EXPECT_EQ(warningsOf(imported), "") << name << ", " << how;
    EXPECT_EQ(imported.polytope.cellTypes.size(), 1U) << name << ", " << how;
}

/// Like expectTheSame(), but allows for several types of cells.
void expectTheCounts(const char* name, const std::string& text, const std::string& how) {
    const Imported imported = sound(importPoints(text));
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
    Points tesseract, permutations;  // (±1, ±1, ±1, ±1); the permutations of (±1, ±1, 0, 0), which form a 24-cell
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
    const Imported imported = sound(importPoints(asPoints(points)));
    EXPECT_EQ(countsOf(imported.polytope), countsOf(named("120-cell")));
    EXPECT_NE(warningsOf(imported).find("treated as rounded: the hull has 120 cells if they are rounded"),
              std::string::npos)
        << warningsOf(imported);
}

TEST(Hull, WarnsHowFewDecimalsAreTreated) {
    std::mt19937 random(37);
    for (int trial = 0; trial < 10; ++trial) {
        const std::string text = formatted(turnedToSize1("24-cell", random), "%.*f", 2);
        const Imported imported = sound(importPoints(text));
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
        const Imported imported = sound(importPoints(asPoints(points)));
        EXPECT_EQ(warningsOf(imported).find("treated as rounded"), std::string::npos) << warningsOf(imported);
    }
}

// Checked in integer arithmetic: all points lie on one side of each cell's hyperplane, and the vertices of the hull in
// the hyperplane are exactly those of the cell.
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
        const Imported imported = sound(importPoints(asPoints(points)));
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
            const Imported imported = sound(importPoints(formatted(points, "%.*f", decimals)));
            const Polytope& hull = imported.polytope;
            EXPECT_EQ(eulerOf(hull), 0) << count << " with " << decimals;
            if (decimals == 17) {  // the points are in general position, so all cells are simplices
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
    const Imported imported = sound(importPoints(formatted(points, "%.*f", 5)));
    EXPECT_EQ(imported.polytope.vertices.size(), points.size());
    EXPECT_EQ(eulerOf(imported.polytope), 0);
    // The points are about 0.1 apart, so nearly flat tetrahedra are not rare.
    EXPECT_NE(warningsOf(imported).find("too imprecise to tell whether the two cells lie in one hyperplane"),
              std::string::npos)
        << warningsOf(imported);
}

// The moment curve (t, t², t³, t⁴), whose coordinates are whole numbers of very different sizes.
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

// Points inside edges, 2-faces and cells of the tesseract are not vertices, whatever their rounding.
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
            const Imported imported = sound(importPoints(text));
            EXPECT_EQ(countsOf(imported.polytope), countsOf(named("8-cell")));
            EXPECT_EQ(warningsOf(imported), said + " and were left out");
        }
    }
}

TEST(Hull, MergesDuplicatePoints) {
    std::mt19937 random(29);
    Points points = turnedToSize1("600-cell", random);
    points.push_back(points[7]);
    const Imported one = sound(importPoints(formatted(points, "%.*f", 6)));
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

/// A number in the fewest digits that tell it from the next of its type, as Python and C++ write it.
template <class Number>
std::string shortest(Number value) {
    std::array<char, 64> digits{};
    return {digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr};
}

/// The points, rounded to single precision, with the shortest digits.
std::string shortestSingles(const Points& points) {
    std::string text;
    for (const auto& p : points) {
        for (int i = 0; i < 4; ++i) text += shortest(static_cast<float>(p[i])) + (i == 3 ? '\n' : ' ');
    }
    return text;
}

// Numbers of single precision, with as many digits as programs write.
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

// A coordinate near 0 has fewer digits after a fixed point than single precision.
TEST(Hull, OfSinglePrecisionNumbersMayHaveACoordinateNearZero) {
    std::mt19937 random(34);
    for (const double tiny : {1e-3, 1e-4, 1e-6, 1e-9}) {
        Points points = turnedToSize1("8-cell", random);
        for (const double by = tiny - points[0].y; auto& p : points) p.y += by;
        for (auto& p : points) p = glm::dvec4(glm::vec4(p));
        for (const int decimals : {8, 10, 12}) expectTheCounts("8-cell", formatted(points, "%.*f", decimals), "tiny");
    }
}

// Two cells at an angle of 1e-5 are told apart in double precision, and are one cell in single precision.
TEST(Hull, OfDoublesIsNotTakenForSinglePrecision) {
    std::mt19937 random(35);
    Points points = turnedToSize1("8-cell", random);
    const Points corners = points;
    glm::dvec4 middle(0);  // of a cell
    const Polytope& cube = named("8-cell");
    std::set<std::uint32_t> own;
    for (const auto f : cube.cells[0]) own.insert(cube.faces[f].begin(), cube.faces[f].end());
    for (const auto v : own) middle += corners[v] / static_cast<double>(own.size());
    points.push_back(middle * (1 + 1e-7));
    for (const int digits : {10, 12, 17}) {
        // A pyramid on each of the six 2-faces of the cell takes its place.
        EXPECT_EQ(sound(importPoints(formatted(points, "%.*f", digits))).polytope.cellCount(), 13U) << digits;
    }
    for (auto& p : points) p = glm::dvec4(glm::vec4(p));
    for (const int digits : {10, 12, 17})
        EXPECT_EQ(sound(importPoints(formatted(points, "%.*f", digits))).polytope.cellCount(), 8U) << digits;
}

TEST(WrittenPrecision, IsThatOfSinglePrecisionNumbers) {
    std::mt19937 random(36);
    std::uniform_real_distribution<double> uniform(0.5, 1);
    const auto errorOf = [](const std::vector<std::string>& words, double size = 1) {
        WrittenPrecision precision;
        for (const std::string& word : words) precision.add(word, 0, std::strtod(word.c_str(), nullptr));
        return precision.maxRoundingError(size).x;
    };
    const auto words = [&](bool single, const char* format, int digits) {
        std::vector<std::string> result(40);
        for (std::string& word : result) {
            const double value = uniform(random);
            std::array<char, 64> text{};
            std::snprintf(text.data(), text.size(), format, digits, single ? static_cast<float>(value) : value);
            word = text.data();
        }
        return result;
    };
    for (const int digits : {8, 9, 12, 17}) {
        EXPECT_NEAR(errorOf(words(true, "%.*f", digits)), 0x1p-24, 1e-8) << digits;
        EXPECT_LE(errorOf(words(false, "%.*f", digits)), 1e-8) << digits;
    }
    for (const bool single : {false, true}) {
        for (const int digits : {3, 6, 7})
            EXPECT_DOUBLE_EQ(errorOf(words(single, "%.*f", digits)), 0.5 * std::pow(10.0, -digits));
    }
    // Short decimals are numbers of any precision.
    EXPECT_LE(errorOf({"0.500000000", "1.000000000", "0.250000000", "0.750000000"}), 1e-8);
    EXPECT_EQ(errorOf({"0.5", "1", "-0.25"}), 0);
    EXPECT_EQ(errorOf({"16777216", "33554432", "1234567168"}, 1e9), 0.5);
}

TEST(WrittenPrecision, IsHalfTheUnitOfTheLastDigit) {
    const auto maxRoundingError = [](const std::vector<const char*>& words, double size) {
        WrittenPrecision precision;
        for (const char* word : words) precision.add(word, 0, std::stod(word));
        return precision.maxRoundingError(size).x;
    };
    EXPECT_DOUBLE_EQ(maxRoundingError({"0.70711", "-1.00000"}, 1), 0.5e-5);
    EXPECT_DOUBLE_EQ(maxRoundingError({"10.70711", "0.70711", "0.5"}, 1), 0.5e-5);  // fixed number of decimals
    EXPECT_DOUBLE_EQ(maxRoundingError({"10.7071", "0.707107", "0.5"}, 1),
                     0.5e-4);  // fixed number of digits, determined by the largest number
    EXPECT_DOUBLE_EQ(maxRoundingError({"1.0707e+05", "7.0711E-1"}, 1e5), 5);
    EXPECT_DOUBLE_EQ(maxRoundingError({"7.0711e-10", "0"}, 1e-9), 0.5e-14);
    EXPECT_EQ(maxRoundingError({"0.5", "1.5", "0"}, 2), 0);
    EXPECT_EQ(maxRoundingError({"100000.5", "99999.5"}, 2), 0);
    EXPECT_EQ(maxRoundingError({"5e-10", "1e-9"}, 2e-9), 0);
}

}  // namespace
}  // namespace oval4d::polytopes
