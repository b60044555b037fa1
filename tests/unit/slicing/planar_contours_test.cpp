// Tests of the contours of fields in planes: they are compared with curves that are known.

#include "slicing/planar_contours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fields/formula_field.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::slicing {
namespace {

using geometry::Rotation;

constexpr double kSquares = 96;  // the number of lattice squares across a panel

double stepFor(const fields::Field& field) { return 2 * field.circumradius / kSquares; }

MatrixContours contoursOf(const fields::Field& field, const Rotation& orientation, const glm::dvec4& point,
                          const std::vector<double>& levels = {0}, double step = 0) {
    MatrixContours out;
    out[0].points.emplace_back(7, 7);  // the tracer overwrites what the list contained before
    PlanarContourTracer tracer;
    tracer.trace(field, orientation, point, levels, step > 0 ? step : stepFor(field), Quality::full, out);
    return out;
}

/// Returns the coordinates, as the function takes them, of a point p in the plane through `point` that is parallel to
/// `axes`.
glm::dvec4 inFunction(const fields::Field& field, const Rotation& orientation, const std::array<int, 2>& axes,
                      const glm::dvec2& p, glm::dvec4 point) {
    point[axes[0]] = p.x;
    point[axes[1]] = p.y;
    return field.center + field.toFunction * orientation.inverse()(point);
}

bool isClosed(std::span<const glm::dvec2> line) { return line.front() == line.back(); }

double lengthOf(std::span<const glm::dvec2> line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += glm::distance(line[i - 1], line[i]);
    return sum;
}

/// Returns the least distance of a point from the facets of the box, in the function's coordinates.
double depthInBox(const fields::Box& box, const glm::dvec4& at) {
    double least = INFINITY;
    for (int axis = 0; axis < 4; ++axis) least = std::min({least, at[axis] - box.min[axis], box.max[axis] - at[axis]});
    return least;
}

fields::Field formulaField(const std::string& formula, const fields::Box& box) {
    auto field = fields::fieldFromFormula("field", formula, box);
    EXPECT_TRUE(field) << field.error().message;
    return *std::move(field);
}

TEST(PlanarContours, OfASphereAreCirclesInAllPlanes) {
    std::mt19937 random(41);
    std::uniform_real_distribution<double> shift(-0.15, 0.15);
    for (int trial = 0; trial < 8; ++trial) {
        const Rotation orientation = trial == 0 ? Rotation() : support::randomRotation(random);
        const glm::dvec4 center(shift(random), shift(random), shift(random), shift(random));
        const glm::dvec4 point(shift(random), shift(random), shift(random), shift(random));
        const fields::Field field = testField([&](const glm::dvec4& p) { return glm::distance(p, center); }, 1,
                                              {glm::dvec4(-2), glm::dvec4(2)});
        const std::vector<double> radii{1.5, 1.2};
        const MatrixContours contours = contoursOf(field, orientation, point, radii);
        const glm::dvec4 rotated = orientation(center);
        for (std::size_t plane = 0; plane < contours.size(); ++plane) {
            SCOPED_TRACE(testing::Message() << "trial " << trial << ", plane " << plane);
            const PlanarContours& lines = contours[plane];
            const auto& axes = kPlaneAxes[plane];
            const glm::dvec2 middle(rotated[axes[0]], rotated[axes[1]]);
            double beside = 0;  // the squared distance of the center of the sphere from the plane
            for (int axis = 0; axis < 4; ++axis) {
                if (axis != axes[0] && axis != axes[1]) beside += std::pow(point[axis] - rotated[axis], 2);
            }
            ASSERT_EQ(lines.lineCount(), radii.size());
            for (std::size_t i = 0; i < radii.size(); ++i) {
                ASSERT_EQ(lines.level[i], i);
                ASSERT_TRUE(isClosed(lines.line(i)));
                const double radius = std::sqrt(radii[i] * radii[i] - beside);
                for (const glm::dvec2& p : lines.line(i)) ASSERT_NEAR(glm::distance(p, middle), radius, 0.002);
                ASSERT_NEAR(lengthOf(lines.line(i)) / (2 * std::numbers::pi * radius), 1, 0.003);
            }
        }
    }
}

constexpr const char* kTigerFormula = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09";

// In the planes xy and zw, the contours of a tiger are two circles around the origin. If the other two coordinates are
// constant, the equation of the tiger says that sqrt(x² + y²) or sqrt(z² + w²) has one of two values.
TEST(PlanarContours, OfATigerAreTwoCirclesAroundTheOriginInXyAndZw) {
    const fields::Field field = formulaField(kTigerFormula, {glm::dvec4(-1.6), glm::dvec4(1.6)});
    const glm::dvec4 point(0.6, 0.7, 0.5, 0.4);
    const MatrixContours contours = contoursOf(field, {}, point);
    const double xy = std::hypot(point.x, point.y), zw = std::hypot(point.z, point.w);
    for (const auto& [plane, middle, other] :
         {std::tuple(std::size_t{0}, 1.0, zw - 0.7), std::tuple(std::size_t{5}, 0.7, xy - 1)}) {
        const PlanarContours& lines = contours[plane];
        ASSERT_EQ(lines.lineCount(), 2U);
        const double half = std::sqrt(0.09 - other * other);
        std::vector<double> radii;
        for (std::size_t i = 0; i < 2; ++i) {
            ASSERT_TRUE(isClosed(lines.line(i)));
            radii.push_back(glm::length(lines.line(i)[0]));
            for (const glm::dvec2& p : lines.line(i)) EXPECT_NEAR(glm::length(p), radii[i], 0.006);
        }
        std::ranges::sort(radii);
        EXPECT_NEAR(radii[0], middle - half, 0.004);
        EXPECT_NEAR(radii[1], middle + half, 0.004);
    }
}

TEST(PlanarContours, OfATigerLieOnItInAllRotations) {
    const fields::Field field = formulaField(kTigerFormula, {glm::dvec4(-1.6), glm::dvec4(1.6)});
    const auto f = [](const glm::dvec4& p) {
        return std::pow(std::hypot(p.x, p.y) - 1, 2) + std::pow(std::hypot(p.z, p.w) - 0.7, 2) - 0.09;
    };
    std::mt19937 random(42);
    for (int trial = 0; trial < 6; ++trial) {
        const Rotation orientation = support::randomRotation(random);
        const glm::dvec4 point = orientation(glm::dvec4(0.9, 0.3, 0.5, -0.4));
        const MatrixContours contours = contoursOf(field, orientation, point);
        for (std::size_t plane = 0; plane < contours.size(); ++plane) {
            const PlanarContours& lines = contours[plane];
            EXPECT_GE(lines.lineCount(), 1U) << "the point is in the tiger";
            for (std::size_t i = 0; i < lines.lineCount(); ++i) EXPECT_TRUE(isClosed(lines.line(i)));
            for (const glm::dvec2& p : lines.points)
                ASSERT_NEAR(f(inFunction(field, orientation, kPlaneAxes[plane], p, point)), 0, 0.01);
        }
    }
}

// The contour of a linear function is a chord of the domain: the part in the domain of the line on which the function
// equals the level. The function is evaluated only in the domain.
TEST(PlanarContours, OfALinearFunctionAreChordsOfTheDomain) {
    std::mt19937 random(43);
    std::uniform_real_distribution<double> part(-0.4, 0.4);
    const fields::Box box{glm::dvec4(-1, -0.5, 0, 2), glm::dvec4(1, 0.7, 1, 3.5)};
    for (int trial = 0; trial < 12; ++trial) {
        const Rotation orientation = trial < 2 ? Rotation() : support::randomRotation(random);
        const glm::dvec4 slope =
            trial == 0 ? glm::dvec4(1, 0, 0, 0) : glm::dvec4(part(random), part(random), part(random), part(random));
        const glm::dvec4 own = glm::dvec4(part(random), part(random), part(random), part(random)) * (box.max - box.min);
        double leastDepth = INFINITY;
        const auto f = [&](const glm::dvec4& p) {
            leastDepth = std::min(leastDepth, depthInBox(box, p));
            return glm::dot(slope, p - box.center() - own);
        };
        const fields::Field field = testField(f, 1, box);
        const glm::dvec4 point = orientation(own);  // the function is 0 at this point
        const MatrixContours contours = contoursOf(field, orientation, point);
        EXPECT_GT(leastDepth, -1e-6) << "nothing outside of the domain is evaluated";
        for (std::size_t plane = 0; plane < contours.size(); ++plane) {
            SCOPED_TRACE(testing::Message() << "trial " << trial << ", plane " << plane);
            const PlanarContours& lines = contours[plane];
            const auto& axes = kPlaneAxes[plane];
            const glm::dvec4 turned = orientation(slope);
            const glm::dvec2 across(turned[axes[0]], turned[axes[1]]);
            if (glm::length(across) < 0.05) continue;  // skips planes in which the function is nearly constant
            ASSERT_EQ(lines.lineCount(), 1U);
            const auto line = lines.line(0);
            const glm::dvec2 middle(point[axes[0]], point[axes[1]]);
            for (const glm::dvec2& p : line)
                ASSERT_NEAR(glm::dot(p - middle, glm::normalize(across)), 0, 2e-5 / glm::length(across));
            ASSERT_NEAR(lengthOf(line), glm::distance(line.front(), line.back()), 1e-3);
            for (const glm::dvec2& end : {line.front(), line.back()})
                ASSERT_NEAR(depthInBox(box, inFunction(field, orientation, axes, end, point)), 0, 1e-9);
        }
    }
}

TEST(PlanarContours, EndOnlyAtTheBoundaryOfTheDomain) {
    std::mt19937 random(44);
    std::normal_distribution<double> normal;
    std::size_t closed = 0, open = 0;
    for (int trial = 0; trial < 10; ++trial) {
        std::vector<glm::dvec4> waves;
        for (int i = 0; i < 5; ++i)
            waves.push_back(3.0 * glm::dvec4(normal(random), normal(random), normal(random), normal(random)));
        const auto f = [&](const glm::dvec4& p) {
            double sum = 0;
            for (std::size_t i = 0; i < waves.size(); ++i)
                sum += std::sin(static_cast<double>(i) + glm::dot(waves[i], p));
            return sum;
        };
        const fields::Field field = testField(f, 100, {glm::dvec4(-1), glm::dvec4(1, 1, 1, 1.5)});
        const Rotation orientation = support::randomRotation(random);
        const glm::dvec4 point(0.1, -0.2, 0.15, 0.05);
        const MatrixContours contours = contoursOf(field, orientation, point, {0.51, -0.3});
        for (std::size_t plane = 0; plane < contours.size(); ++plane) {
            for (std::size_t i = 0; i < contours[plane].lineCount(); ++i) {
                const auto line = contours[plane].line(i);
                ASSERT_GE(line.size(), 2U);
                ++(isClosed(line) ? closed : open);
                if (isClosed(line)) continue;
                for (const glm::dvec2& end : {line.front(), line.back()}) {
                    ASSERT_NEAR(depthInBox(field.box, inFunction(field, orientation, kPlaneAxes[plane], end, point)), 0,
                                1e-9);
                }
            }
        }
    }
    EXPECT_GT(closed, 10U);
    EXPECT_GT(open, 50U);
}

TEST(PlanarContours, DoNotCrossAHole) {
    constexpr double kHole = 0.5, kAt = 0.013;
    std::mt19937 random(45);
    for (int trial = 0; trial < 6; ++trial) {
        const Rotation orientation = trial == 0 ? Rotation() : support::randomRotation(random);
        const fields::Field field =
            testField([&](const glm::dvec4& p) { return glm::length(p) < kHole ? NAN : orientation(p).x - kAt; }, NAN,
                      {glm::dvec4(-1), glm::dvec4(1)});
        const MatrixContours contours = contoursOf(field, orientation, glm::dvec4(0));
        for (std::size_t plane = 0; plane < contours.size(); ++plane) {
            SCOPED_TRACE(testing::Message() << "trial " << trial << ", plane " << plane);
            const PlanarContours& lines = contours[plane];
            if (kPlaneAxes[plane][0] != 0) {
                EXPECT_EQ(lines.lineCount(), 0U) << "x is 0 in the plane";
                continue;
            }
            ASSERT_EQ(lines.lineCount(), 2U) << "one on each side of the hole";
            for (std::size_t i = 0; i < 2; ++i) {
                const auto line = lines.line(i);
                EXPECT_GT(line.front().y * line.back().y, 0);
                double nearest = INFINITY;
                for (const glm::dvec2& p : line) {
                    EXPECT_NEAR(p.x, kAt, 1e-6);
                    nearest = std::min(nearest, glm::length(p));
                }
                EXPECT_GE(nearest, kHole - 1e-3);
                EXPECT_LE(nearest, kHole + 2 * stepFor(field));
            }
        }
    }
}

TEST(PlanarContours, AreEmptyBesideTheDomainAndOverwriteWhatWasThere) {
    const fields::Field field = testField([](const glm::dvec4& p) { return p.x; }, 1, {glm::dvec4(-1), glm::dvec4(1)});
    MatrixContours out = contoursOf(field, {}, glm::dvec4(0));
    EXPECT_EQ(out[0].lineCount(), 1U);
    PlanarContourTracer tracer;
    const std::vector<double> levels{0};
    tracer.trace(field, {}, glm::dvec4(1.5), levels, stepFor(field), Quality::full, out);
    for (const PlanarContours& lines : out) {
        EXPECT_EQ(lines.lineCount(), 0U);
        EXPECT_TRUE(lines.points.empty());
    }
}

// The contours of a hyperbola's two branches are separate. Around the center, the corners of a square that are below
// the level alternate with the corners above the level. The function is bilinear, so its interpolation on the sides of
// the square is exact.
TEST(PlanarContours, SeparateTheBranchesOfAHyperbola) {
    const glm::dvec2 center(0.04, -0.055);
    const fields::Field field = testField([&](const glm::dvec4& p) { return (p.x - center.x) * (p.y - center.y); }, 4,
                                          {glm::dvec4(-1), glm::dvec4(1)});
    for (const double level : {-0.0005, 0.0005, 0.00002, -0.00002}) {
        SCOPED_TRACE(level);
        const PlanarContours lines = contoursOf(field, {}, glm::dvec4(0), {level}, 0.1)[0];
        ASSERT_EQ(lines.lineCount(), 2U);
        for (std::size_t i = 0; i < 2; ++i) {
            const glm::dvec2 start = lines.line(i)[0] - center;
            for (const glm::dvec2& p : lines.line(i)) {
                EXPECT_NEAR((p.x - center.x) * (p.y - center.y), level, 1e-6);
                EXPECT_GT((p.x - center.x) * start.x, 0);
                EXPECT_GT((p.y - center.y) * start.y, 0);
            }
        }
    }
}

TEST(PlanarContours, PassBetweenInfiniteValues) {
    const fields::Field field = testField([](const glm::dvec4& p) { return p.x < 0.3 ? -INFINITY : INFINITY; }, NAN,
                                          {glm::dvec4(-1), glm::dvec4(1)});
    const PlanarContours lines = contoursOf(field, {}, glm::dvec4(0))[0];
    ASSERT_EQ(lines.lineCount(), 1U);
    for (const glm::dvec2& p : lines.points) EXPECT_NEAR(p.x, 0.3, stepFor(field));
    EXPECT_NEAR(lengthOf(lines.line(0)), 2, 0.01);
}

/// A function whose estimated cost per value is given, in nanoseconds.
class CostlyFunction : public TestFunction {
  public:
    explicit CostlyFunction(double cost) : TestFunction([](const glm::dvec4& p) { return p.x; }, 1), cost_(cost) {}
    fields::EvaluationCost cost() const override { return {.value = cost_}; }

  private:
    double cost_;
};

TEST(PlanarContours, HaveALatticeThatSuitsThePanelAndTheCost) {
    const auto squares = [](double cost, double pixels, Quality quality) {
        const fields::Field field =
            fields::makeField("costly", std::make_shared<CostlyFunction>(cost), {glm::dvec4(-1), glm::dvec4(1)});
        return 3 / contourStep(field, 3, pixels, quality);
    };
    EXPECT_NEAR(squares(1, 150, Quality::full), 50, 1e-9);
    EXPECT_NEAR(squares(1, 150, Quality::draft), 150 / 4.5, 1e-9);
    EXPECT_NEAR(squares(1, 150, Quality::file), kMaxContourSquares, 1e-9);
    EXPECT_NEAR(squares(1, 5, Quality::full), kMinContourSquares, 1e-9);
    EXPECT_NEAR(squares(1, 1e5, Quality::full), kMaxContourSquares, 1e-9);
    EXPECT_NEAR(squares(1e9, 150, Quality::full), kMinContourSquares, 1e-9);
    for (const Quality quality : {Quality::draft, Quality::full, Quality::file}) {
        const double side = squares(1000, 1e5, quality);
        EXPECT_LT(side, kMaxContourSquares);
        EXPECT_NEAR(6 * side * side * 1003, maxContourTime(quality), 1);
    }
}

TEST(PlanarContours, OfNoiseHaveABoundedNumberOfPoints) {
    const auto noise = [](const glm::dvec4& p) { return std::sin(1e5 * p.x) * std::cos(7e4 * p.y + 3e4 * p.x); };
    const fields::Field field = testField(noise, NAN, {glm::dvec4(-1), glm::dvec4(1)});
    const PlanarContours lines =
        contoursOf(field, {}, glm::dvec4(0), {0, 0.01, 0.02, 0.03}, 2 * field.circumradius / kMaxContourSquares)[0];
    EXPECT_GT(lines.points.size(), 1000U);
    EXPECT_LE(lines.points.size(), kMaxContourPoints);
    EXPECT_EQ(std::set(lines.level.begin(), lines.level.end()).size(), 4U);
}

}  // namespace
}  // namespace oval4d::slicing
