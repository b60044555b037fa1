#include "slicing/critical/critical_sections.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fields/field.hpp"
#include "fields/formula_field.hpp"
#include "sanitizers/sanitized.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using enum SectionChange;

constexpr double kRingA = 1, kRingB = 0.7, kTube = 0.3;
constexpr std::string_view kTigerAlongW = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09";

FieldPtr formulaObject(std::string_view text, const fields::Box& box = fields::kFormulaBox) {
    auto field = fields::fieldFromFormula("field", text, box);
    EXPECT_TRUE(field) << field.error().message;
    return std::make_shared<const fields::Field>(std::move(*field));
}

FieldPtr arrayOf(const FieldPtr& field, std::size_t side) {
    return std::make_shared<const fields::Field>(sampledField(*field, side));
}

CriticalSections criticalOf(const Object& object, const FieldSettings& settings = {},
                            const geometry::Rotation& orientation = {}) {
    auto found = findCriticalSections(object, orientation, settings, {.time = std::chrono::hours(24)});
    EXPECT_TRUE(found);
    return found ? std::move(*found) : CriticalSections{};
}

struct Expected {
    double w;
    SectionChange change;
    SectionTopology before, after;
};

void expectSections(const CriticalSections& found, const std::vector<Expected>& expected, double tolerance) {
    ASSERT_EQ(found.all.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const CriticalSection& section = found.all[i];
        EXPECT_NEAR(section.w, expected[i].w, tolerance) << i;
        EXPECT_EQ(section.change, expected[i].change) << i;
        EXPECT_EQ(section.before, expected[i].before) << i;
        EXPECT_EQ(section.after, expected[i].after) << i;
    }
}

constexpr SectionTopology kNothing{}, kBall{1, 0, 2}, kTwoBalls{2, 0, 4}, kTorus{1, 0, 0}, kTwoTori{2, 0, 0};

const std::vector<Expected> kTigerSections{{-kRingB - kTube, appearance, kNothing, kTorus},
                                           {-kRingB + kTube, split, kTorus, kTwoTori},
                                           {kRingB - kTube, merge, kTwoTori, kTorus},
                                           {kRingB + kTube, disappearance, kTorus, kNothing}};

TEST(CriticalSections, BallAppearsAndVanishes) {
    std::mt19937 random(1);
    const FieldPtr ball = formulaObject("x^2 + y^2 + z^2 + w^2 - 1");
    for (const geometry::Rotation& orientation : {geometry::Rotation(), support::randomRotation(random)}) {
        expectSections(criticalOf(ball, {}, orientation),
                       {{-1, appearance, kNothing, kBall}, {1, disappearance, kBall, kNothing}}, 2e-5);
    }
}

TEST(CriticalSections, EachLevelHasItsOwn) {
    SKIP_IF_SANITIZED();
    const FieldPtr ball = formulaObject("x^2 + y^2 + z^2 + w^2");
    const CriticalSections found = criticalOf(ball, {{0.25, 1, 2.25}});
    ASSERT_EQ(found.all.size(), 6U);
    const std::vector<double> radii{1.5, 1, 0.5, 0.5, 1, 1.5};
    const std::vector<std::size_t> levels{2, 1, 0, 0, 1, 2};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(std::abs(found.all[i].w), radii[i], 2e-5);
        EXPECT_EQ(found.all[i].levelIndex, levels[i]);
    }
}

// The w at which a cavity opens or closes is found. The field is above 0 between the balls of radii 0.5 and 1, so the
// sections near the middle have a cavity.
TEST(CriticalSections, ShellAroundABallHasACavity) {
    SKIP_IF_SANITIZED();
    const FieldPtr shell = formulaObject("(1 - (x^2 + y^2 + z^2 + w^2)) * (x^2 + y^2 + z^2 + w^2 - 0.25)");
    const SectionTopology hollow{1, 1, 4};
    expectSections(criticalOf(shell, {{0}, fields::BodySide::above}),
                   {{-1, appearance, kNothing, kBall},
                    {-0.5, cavity, kBall, hollow},
                    {0.5, cavity, hollow, kBall},
                    {1, disappearance, kBall, kNothing}},
                   2e-5);
}

// The critical sections of a tiger along its axis are known: the distance of its points from the plane xy is at most b
// + r, and at least b − r.
TEST(CriticalSections, TigerAlongItsAxis) {
    expectSections(criticalOf(formulaObject(kTigerAlongW)), kTigerSections, 2e-4);
}

TEST(CriticalSections, ArrayOfTheTiger) {
    SKIP_IF_SANITIZED();
    const FieldPtr array = arrayOf(formulaObject(kTigerAlongW, {glm::dvec4(-1.5), glm::dvec4(1.5)}), 49);
    expectSections(criticalOf(array), kTigerSections, 0.02);
}

// The critical sections of a rotated tiger are known. Its surface is a 3-dimensional torus with the points ((a + r cos
// φ) e^iα, (b + r sin φ) e^iβ). The height is w = u · (x, y) + v · (z, w). It has its critical points where α and β are
// the directions of ±u and ±v, and φ is the direction of (±|u|, ±|v|). There, w = ±a|u| ± b|v| ± r.
TEST(CriticalSections, RotatedTiger) {
    SKIP_IF_SANITIZED();
    std::mt19937 random(2);
    const FieldPtr tiger = formulaObject(kTigerAlongW);
    for (int trial = 0; trial < 3; ++trial) {
        const geometry::Rotation orientation = support::randomRotation(random);
        const glm::dmat4 matrix = orientation.matrix();
        const double u = std::hypot(matrix[0][3], matrix[1][3]), v = std::hypot(matrix[2][3], matrix[3][3]);
        std::vector<double> expected;
        for (int signs = 0; signs < 8; ++signs) {
            const auto sign = [&](int bit) { return (signs >> bit & 1) != 0 ? 1 : -1; };
            expected.push_back(sign(0) * kRingA * u + sign(1) * kRingB * v + sign(2) * kTube);
        }
        std::ranges::sort(expected);
        const CriticalSections found = criticalOf(tiger, {}, orientation);
        ASSERT_EQ(found.all.size(), 8U) << "|u| = " << u;
        long euler = 0;
        for (std::size_t i = 0; i < 8; ++i) {
            EXPECT_NEAR(found.all[i].w, expected[i], 5e-5) << "|u| = " << u << ", number " << i;
            EXPECT_EQ(found.all[i].before.euler, euler);
            EXPECT_EQ(std::abs(found.all[i].after.euler - euler), 2) << "each critical point is one handle";
            euler = found.all[i].after.euler;
        }
        EXPECT_EQ(found.all.front().change, appearance);
        EXPECT_EQ(found.all.back().change, disappearance);
    }
}

// The time at which two regions of heat merge is found. Heat spreads from two points; halfway between them, the
// temperature is 2 t^(−3/2) exp(−1 / 4t).
TEST(CriticalSections, HeatKernelsMerge) {
    SKIP_IF_SANITIZED();
    constexpr double kLevel = 5, kFirst = 0.03, kLast = 0.5;
    const auto halfway = [](double t) { return 2 * std::pow(t, -1.5) * std::exp(-1 / (4 * t)); };
    const auto timeBetween = [&](double below, double above) {
        for (int i = 0; i < 60; ++i) (halfway((below + above) / 2) < kLevel ? below : above) = (below + above) / 2;
        return below;
    };
    constexpr double kHottest = 1.0 / 6;
    const double merging = timeBetween(kFirst, kHottest), splitting = timeBetween(kLast, kHottest);
    const FieldPtr heat = formulaObject("w^(-3/2) * (exp(-((x-1)^2+y^2+z^2)/(4*w)) + exp(-((x+1)^2+y^2+z^2)/(4*w)))",
                                        {{-3, -3, -3, kFirst}, {3, 3, 3, kLast}});
    const FieldSettings settings{{kLevel}, fields::BodySide::above};
    for (const auto& [object, tolerance] : {std::pair{heat, 1e-5}, std::pair{arrayOf(heat, 49), 5e-3}}) {
        const CriticalSections found = criticalOf(object, settings);
        ASSERT_EQ(found.all.size(), 3U);
        const double center = (kFirst + kLast) / 2, accuracy = tolerance + 1e-4 * (kLast - kFirst);
        EXPECT_NEAR(found.all[0].w + center, merging, accuracy);
        EXPECT_EQ(found.all[0].change, merge);
        EXPECT_NEAR(found.all[1].w + center, splitting, accuracy);
        EXPECT_EQ(found.all[1].change, split);
        EXPECT_EQ(found.all[2].change, disappearance);
        EXPECT_EQ(found.all[2].before, kTwoBalls);
    }
}

// In an array, too, the time at which two regions of heat merge is found, with an error of at most a thousandth. This
// also holds if the sections are turned in space, which does not change w.
TEST(CriticalSections, HeatKernelsInAnArrayMergeToAThousandth) {
    SKIP_IF_SANITIZED();
    const HeatKernels heat;
    const FieldPtr array = std::make_shared<const fields::Field>(heat.array);
    const geometry::Rotation turned = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xy, 0.4, {}}) *
                                      geometry::Rotation(geometry::RotationAngles{geometry::Plane::yz, 1.1, {}});
    for (const geometry::Rotation& orientation : {geometry::Rotation(), turned}) {
        const CriticalSections found = criticalOf(array, {{HeatKernels::kLevel}, fields::BodySide::above}, orientation);
        const auto merges = std::ranges::count(found.all, merge, &CriticalSection::change);
        EXPECT_EQ(merges, 1);
        for (const CriticalSection& section : found.all) {
            if (section.change == merge) {
                EXPECT_NEAR((section.w + heat.array.center.w) / HeatKernels::merging(), 1, 1e-3);
            }
        }
    }
}

TEST(CriticalSections, DomainsEndsAreNotCritical) {
    SKIP_IF_SANITIZED();
    std::mt19937 random(3);
    const geometry::Rotation orientation = support::randomRotation(random);
    for (const std::string_view constant : {"-1", "1"})
        EXPECT_TRUE(criticalOf(formulaObject(constant), {}, orientation).all.empty()) << constant;
}

TEST(CriticalSections, OppositeOrientationsAgree) {
    const FieldPtr field = formulaObject("x^2 + 2*y^2 + (z^2 + w^2 - 1)^2 + 0.3*z*w - 0.3 + 0.1*x + 0.05*w");
    std::mt19937 random(4);
    const geometry::Rotation orientation = support::randomRotation(random);
    const geometry::Rotation half(geometry::RotationAngles{geometry::Plane::zw, std::acos(-1), {}});  // maps w to −w
    const CriticalSections up = criticalOf(field, {}, orientation), down = criticalOf(field, {}, half * orientation);
    ASSERT_FALSE(up.all.empty());
    ASSERT_EQ(up.all.size(), down.all.size());
    for (std::size_t i = 0; i < up.all.size(); ++i) {
        const CriticalSection& mirrored = down.all[up.all.size() - 1 - i];
        EXPECT_NEAR(up.all[i].w, -mirrored.w, 1e-4);
        EXPECT_EQ(up.all[i].before, mirrored.after);
    }
}

TEST(CriticalSections, EndsInTime) {
    auto found = findCriticalSections(formulaObject(kTigerAlongW), {}, {}, {.time = std::chrono::seconds(0)});
    ASSERT_TRUE(found);
    EXPECT_GT(found->tolerance, 1) << "nothing was halved";
    std::stop_source stop;
    stop.request_stop();
    found = findCriticalSections(formulaObject(kTigerAlongW), {}, {}, {.stop = stop.get_token()});
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::canceled);
}

TEST(CriticalSections, VerticesOfAPolytope) {
    const polytopes::Polytope polytope = support::rectifiedFiveCell();
    const CriticalSections found = criticalOf(support::objectOf(polytope));
    std::size_t vertices = 0;
    for (const CriticalSection& section : found.all) {
        EXPECT_EQ(section.change, SectionChange::vertices);
        vertices += section.vertices;
    }
    EXPECT_EQ(vertices, 10U);
    EXPECT_NEAR(found.all.front().w, found.least, 1e-12);
    EXPECT_NEAR(found.all.back().w, found.greatest, 1e-12);
}

TEST(CriticalSections, NextAndPrevious) {
    CriticalSections sections;
    for (const double w : {-1.0, 0.0, 2.0}) sections.all.push_back({.w = w});
    EXPECT_EQ(nextCriticalW(sections, 0, true, 1e-9), 2.0);
    EXPECT_EQ(nextCriticalW(sections, 1e-10, false, 1e-9), -1.0);
    EXPECT_EQ(nextCriticalW(sections, 2, true, 1e-9), std::nullopt);
    EXPECT_EQ(nextCriticalW(sections, -1, false, 1e-9), std::nullopt);
}

}  // namespace
}  // namespace oval4d::slicing
