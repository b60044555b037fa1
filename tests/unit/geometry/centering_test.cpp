#include "geometry/centering.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace oval4d::geometry {
namespace {

using Points = std::vector<glm::dvec4>;

// Returns the vertices of a 16-cell of circumradius 1 around `center`.
Points crossAt(const glm::dvec4& center) {
    Points points;
    for (int axis = 0; axis < 4; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            points.push_back(center);
            points.back()[axis] += sign;
        }
    }
    return points;
}

TEST(Centering, OfAnObjectFarFromTheOriginIsItsCenter) {
    for (const glm::dvec4& center :
         {glm::dvec4(10, 10, 0, 0), glm::dvec4(0, 0, 0, -3.5), glm::dvec4(5e6, 0, 0.25, 7), glm::dvec4(0, 1e13, 0, 0)})
        EXPECT_EQ(newOriginFor({}, crossAt(center)), center);
    for (const glm::dvec4& center : {glm::dvec4(0), glm::dvec4(1, 1, 1, 1), glm::dvec4(0, -3, 0, 0)})
        EXPECT_EQ(newOriginFor({}, crossAt(center)), glm::dvec4(0));
}

TEST(Centering, IsWhatIsAskedFor) {
    using OriginChoice = Centering::OriginChoice;
    const glm::dvec4 near(0.5, 0, 0, 0), far(0, 0, 50, 0), place(1, 2, 3, 4);
    for (const glm::dvec4& center : {near, far}) {
        EXPECT_EQ(newOriginFor({OriginChoice::object}, crossAt(center)), center);
        EXPECT_EQ(newOriginFor({OriginChoice::origin}, crossAt(center)), glm::dvec4(0));
        EXPECT_EQ(newOriginFor({OriginChoice::point, place}, crossAt(center)), place);
    }
}

TEST(Centering, OfPointsWithoutExtentIsTheOriginUnlessAskedFor) {
    const Points one{{1, 2, 3, 4}, {1, 2, 3, 4}};
    EXPECT_EQ(newOriginFor({}, one), glm::dvec4(0));
    EXPECT_EQ(newOriginFor({Centering::OriginChoice::object}, one), one.front());
    EXPECT_EQ(newOriginFor({Centering::OriginChoice::object}, Points()), glm::dvec4(0));
}

// Moving an object from afar to the origin loses no digits: the coordinates relative to the new origin are exact.
TEST(Centering, KeepsTheDigitsOfPointsThatAreFarAway) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    Points points;
    for (int i = 0; i < 1000; ++i) {
        glm::dvec4 p;
        for (int axis = 0; axis < 4; ++axis) p[axis] = coordinate(random);
        points.push_back(p + glm::dvec4(5e6, 0, -3e6, 1));
    }
    const glm::dvec4 center = newOriginFor({}, points);
    glm::dvec4 sum(0);
    for (const glm::dvec4& p : points) {
        for (const int axis : {0, 2}) EXPECT_EQ(center[axis] + (p - center)[axis], p[axis]);
        sum += p - center;
    }
    EXPECT_LT(glm::length(sum) / 1000, 1e-8);
}

}  // namespace
}  // namespace oval4d::geometry
