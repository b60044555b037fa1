#include "session/example_fields.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "fields/formula_field.hpp"

namespace oval4d::session {
namespace {

float valueAt(const fields::Field& field, const glm::dvec4& point) {
    const glm::vec4 p(point);
    float value = NAN;
    field.function->evaluate({{&p.x, 1}, {&p.y, 1}, {&p.z, 1}, {&p.w, 1}}, {&value, 1});
    return value;
}

/// Returns the field "Julia set" of the examples, with c = a + b i + c j + d k. `constants` contains the values of a,
/// b, c and d in the syntax of formulas.
fields::Field juliaSet(std::string_view constants) {
    constexpr std::string_view kConstants = "a=-0.2, b=0.6, c=0.2, d=0.2";
    std::string text = exampleNamed("Julia set")->formula;
    const std::size_t at = text.find(kConstants);
    EXPECT_NE(at, std::string::npos) << text;
    auto field = fields::fieldFromFormula("Julia set", text.replace(at, kConstants.size(), constants));
    EXPECT_TRUE(field) << field.error().message;
    return *field;
}

// Without the constant c, the Julia set is a ball. Squaring a quaternion q squares its absolute value, so the function
// is log |q| − 0.02.
TEST(ExampleFields, JuliaSetOfZeroIsABall) {
    const fields::Field ball = juliaSet("a=0, b=0, c=0, d=0");
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> radius(0.6, 1.4);
    for (int trial = 0; trial < 100; ++trial) {
        const double length = radius(random);
        const glm::dvec4 direction(normal(random), normal(random), normal(random), normal(random));
        EXPECT_NEAR(valueAt(ball, length * glm::normalize(direction)), std::log(length) - 0.02, 1e-4);
    }
}

// If the constant c is a complex number, the Julia set is symmetric: rotations of the plane of j and k commute with
// each step of the iteration.
TEST(ExampleFields, JuliaSetOfAComplexNumberIsSymmetric) {
    const fields::Field julia = juliaSet("a=-0.2, b=0.6, c=0, d=0");
    std::mt19937 random(2);
    std::uniform_real_distribution<double> coordinate(0.4, 1);
    for (int trial = 0; trial < 100; ++trial) {
        const glm::dvec4 p(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
        EXPECT_NEAR(valueAt(julia, p), valueAt(julia, {p.x, p.y, std::hypot(p.z, p.w), 0}), 1e-3);
    }
}

// The torus link is a tube around a trefoil knot. The points (i s³, s²) with constant |s|, on the curve u² + v³ = 0,
// form a closed curve that winds three times around one circle and twice around another. The points (s³, s²) lie
// between its windings.
TEST(ExampleFields, TorusLinkIsATubeAroundATrefoilKnot) {
    const fields::Field& link = *exampleNamed("torus link")->field;
    constexpr double kSize = 1.2;
    const double u = std::pow(kSize, 3), v = std::pow(kSize, 2);
    for (int i = 0; i < 60; ++i) {
        const double angle = 2 * std::numbers::pi * i / 60;
        const auto at = [&](double turn) {
            return glm::dvec4(u * std::cos(3 * angle + turn), u * std::sin(3 * angle + turn), v * std::cos(2 * angle),
                              v * std::sin(2 * angle));
        };
        EXPECT_LT(valueAt(link, at(std::numbers::pi / 2)), -1) << i;
        EXPECT_GT(valueAt(link, at(0)), 1) << i;
    }
}

}  // namespace
}  // namespace oval4d::session
