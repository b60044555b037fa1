#include "polytopes/polygon_names.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

// Returns the corners of the polygon {n/d}, with every second corner at the height `height` above the plane.
std::vector<glm::dvec4> starPolygon(int n, int d, double height = 0) {
    std::vector<glm::dvec4> corners;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * d * i / n;
        corners.emplace_back(std::cos(angle), std::sin(angle), i % 2 == 0 ? 0 : height, 0);
    }
    return corners;
}

TEST(PolygonNames, AreThoseOfRegularPolygonsInAnyPlane) {
    std::mt19937 random(3);
    const auto expect = [&](int n, int d, const std::string& name) {
        const geometry::Rotation turn = support::randomRotation(random);
        std::vector<glm::dvec4> corners = starPolygon(n, d);
        for (glm::dvec4& corner : corners) corner = turn(7.0 * corner) + glm::dvec4(1, 2, 3, 4);
        EXPECT_EQ(nameOfPolygon(corners), name);
    };
    expect(3, 1, "triangle");
    expect(4, 1, "square");
    expect(5, 1, "pentagon");
    expect(5, 2, "pentagram");
    expect(7, 2, "7/2-gon");
    expect(7, 3, "7/3-gon");
    expect(10, 3, "10/3-gon");
    expect(12, 1, "dodecagon");
    expect(17, 1, "17-gon");
}

TEST(PolygonNames, OfQuadrilateralsTellTheirShape) {
    const auto name = [](const std::vector<glm::dvec4>& corners) { return nameOfPolygon(corners); };
    EXPECT_EQ(name({{0, 0, 0, 0}, {3, 0, 0, 0}, {3, 0, 0, 1}, {0, 0, 0, 1}}), "rectangle");
    EXPECT_EQ(name({{2, 0, 0, 0}, {0, 1, 0, 0}, {-2, 0, 0, 0}, {0, -1, 0, 0}}), "rhombus");
    EXPECT_EQ(name({{0, 0, 0, 0}, {3, 0, 0, 0}, {4, 1, 0, 0}, {1, 1, 0, 0}}), "quadrilateral") << "a parallelogram";
    EXPECT_EQ(name({{0, 0, 0, 0}, {4, 0, 0, 0}, {3, 1, 0, 0}, {1, 1, 0, 0}}), "quadrilateral") << "a trapezoid";
    EXPECT_EQ(name(starPolygon(4, 1, 0.5)), "quadrilateral") << "skew, with equal sides";
}

TEST(PolygonNames, OfOtherPolygonsTellTheirSides) {
    EXPECT_EQ(nameOfPolygon(std::vector<glm::dvec4>{{0, 0, 0, 0}, {9, 0, 0, 0}, {0, 1, 0, 0}}), "triangle");
    const std::vector<glm::dvec4> l{{-1, -1, 0, 0}, {1, -1, 0, 0}, {1, 0, 0, 0},
                                    {0, 0, 0, 0},   {0, 1, 0, 0},  {-1, 1, 0, 0}};
    EXPECT_EQ(nameOfPolygon(l), "hexagon") << "like the letter L";
    std::vector<glm::dvec4> star = starPolygon(5, 2);
    star[0] *= 1.5;
    EXPECT_EQ(nameOfPolygon(star), "pentagon") << "a star that is not regular";
    // A skew octagon has the same side length and circumradius as {8/3}, but is not named a star polygon.
    const double side = 2 * std::sin(3 * std::numbers::pi / 8), own = 2 * std::sin(std::numbers::pi / 8);
    const double height = std::sqrt((side * side - own * own) / (1 - side * side / 4));
    EXPECT_EQ(nameOfPolygon(starPolygon(8, 1, height)), "octagon");
}

}  // namespace
}  // namespace oval4d::polytopes
