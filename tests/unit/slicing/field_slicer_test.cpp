#include "slicing/field_slicer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "fields/formula_field.hpp"
#include "sanitizers/sanitized.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::slicing {
namespace {

const geometry::Hyperplanes kPlanes{-10, 21, 0.15, 0};

SliceSet slicesOf(const fields::Field& field, const geometry::Rotation& orientation, const FieldSettings& settings = {},
                  int detail = 64, const geometry::Hyperplanes& planes = kPlanes) {
    FieldSlicer slicer;
    SliceSet out;
    slicer.slice(field, orientation, planes, settings, detailOf(field, planes, detail), out);
    return out;
}

// Slices of ellipsoids have the right volumes and centroids: the slice of a 4-D ellipsoid by a hyperplane is a 3-D
// ellipsoid.
TEST(FieldSlicer, EllipsoidsHaveTheRightVolumesAndCentroids) {
    std::mt19937 random(20);
    std::uniform_real_distribution<double> axis(0.7, 1.5), shift(-0.2, 0.2);
    for (int trial = 0; trial < 4; ++trial) {
        const geometry::Rotation own = support::randomRotation(random), orientation = support::randomRotation(random);
        const glm::dvec4 axes(axis(random), axis(random), axis(random), axis(random));
        const glm::dvec4 center(shift(random), shift(random), shift(random), shift(random));
        const auto f = [&](const glm::dvec4& p) { return glm::length(own(p - center) / axes) - 1; };
        const fields::Field field = testField(f, 1 / 0.7, {glm::dvec4(-2), glm::dvec4(2)});
        const SliceSet slices = slicesOf(field, orientation, {}, 128);
        // The ellipsoid is {c + M u : |u| ≤ 1}, where M = orientation · own⁻¹ · diag(axes). Let m be the last row of M.
        // Then the slice at w is the image of the u with m · u = w − c.w: a 3-ball.
        const glm::dvec4 rotatedCenter = orientation(center);
        glm::dmat4 m = (orientation * own.inverse()).matrix();
        for (int k = 0; k < 4; ++k) m[k] *= axes[k];
        const glm::dvec4 row(m[0][3], m[1][3], m[2][3], m[3][3]);
        const double reach = glm::length(row);
        const double volume4 = axes.x * axes.y * axes.z * axes.w;
        for (int i = 0; i < kPlanes.count; ++i) {
            const double height = (kPlanes.w(i) - rotatedCenter.w) / reach;
            const Measure result = measure(slices.surfaces[static_cast<std::size_t>(i)], 0);
            EXPECT_EQ(result.unpaired, 0U);
            if (std::abs(height) >= 1) {
                EXPECT_EQ(result.volume, 0) << height;
                continue;
            }
            if (std::abs(height) > 0.97) continue;
            const double radius = std::sqrt(1 - height * height);
            const double expected = 4.0 / 3 * std::numbers::pi * radius * radius * radius * volume4 / reach;
            EXPECT_EQ(result.euler, 2);
            if (std::abs(height) < 0.8) {
                EXPECT_NEAR(result.volume / expected, 1, 0.005) << "trial " << trial << " slice " << i;
            }
            const glm::dvec4 middle = rotatedCenter + m * (row / reach * height);
            EXPECT_LT(glm::distance(result.moment / result.volume, glm::dvec3(middle)), 0.01);
            if (std::abs(height) > 0.8) continue;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec4 along(m[0][k], m[1][k], m[2][k], m[3][k]);
                const double extent = radius * glm::length(along - row * (glm::dot(along, row) / (reach * reach)));
                double most = -INFINITY;
                for (const glm::vec3& point : slices.surfaces[static_cast<std::size_t>(i)].points)
                    most = std::max(most, static_cast<double>(point[k]));
                EXPECT_NEAR(most, middle[k] + extent, 0.01) << "trial " << trial << " slice " << i;
            }
        }
    }
}

// With largerStepsWhereSmooth, the slices of a large ball together have about 1/kSmoothStepFactor² times as many
// points. Slices of a body that is thinner than a lattice step, or that the larger steps miss, keep all their points.
TEST(FieldSlicer, OnlySmoothSlicesHaveLargerSteps) {
    const auto pointsOf = [&](const fields::Field& field, bool largerStepsWhereSmooth) {
        SurfaceDetail detail = detailOf(field, kPlanes, 40);
        detail.largerStepsWhereSmooth = largerStepsWhereSmooth;
        FieldSlicer slicer;
        SliceSet slices;
        slicer.slice(field, {}, kPlanes, {}, detail, slices);
        std::vector<std::size_t> points;
        for (const SliceSurface& surface : slices.surfaces) {
            EXPECT_EQ(measure(surface, 0).unpaired, 0U);
            points.push_back(surface.points.size());
        }
        return points;
    };
    const fields::Box box{glm::dvec4(-2), glm::dvec4(2)};
    const auto ball = [](const glm::dvec4& p) { return glm::length(p) - 1.8; };
    const auto disk = [](const glm::dvec4& p) {
        return std::max(std::hypot(p.x, p.y) - 1.5, std::abs(0.8 * p.z - 0.6 * p.y) - 0.06);
    };
    const auto total = [](const std::vector<std::size_t>& points) {
        return static_cast<double>(std::accumulate(points.begin(), points.end(), std::size_t{0}));
    };
    const double ratio =
        total(pointsOf(testField(ball, 1, box), false)) / total(pointsOf(testField(ball, 1, box), true));
    EXPECT_NEAR(ratio, kSmoothStepFactor * kSmoothStepFactor, 0.1);
    EXPECT_EQ(pointsOf(testField(disk, 1.5, box), true), pointsOf(testField(disk, 1.5, box), false));
    // The center of the small ball is a lattice point, but none of the lattice with the larger steps.
    const auto smallBall = [](const glm::dvec4& p) { return glm::length(p - glm::dvec4(0.2, 0.2, 0.2, 0)) - 0.12; };
    const auto pointsOfSmallBall = pointsOf(testField(smallBall, 1, box), true);
    EXPECT_GT(total(pointsOfSmallBall), 0);
    EXPECT_EQ(pointsOfSmallBall, pointsOf(testField(smallBall, 1, box), false));
}

// If the whole domain is inside the level, the caps bound exactly the slice of the domain.
TEST(FieldSlicer, CapsFillTheDomainExactly) {
    std::mt19937 random(21);
    const fields::Field field =
        testField([](const glm::dvec4&) { return -1; }, 0, {glm::dvec4(-1, -0.5, 0, 2), glm::dvec4(1, 0.7, 1, 3.5)});
    for (int trial = 0; trial < 8; ++trial) {
        const geometry::Rotation orientation = trial == 0 ? geometry::Rotation() : support::randomRotation(random);
        const SliceSet slices = slicesOf(field, orientation, {}, 40, {-2, 5, 0.3, 0.01});
        for (int i = 0; i < 5; ++i) {
            double expected = 0;
            for (std::size_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1]; ++f) {
                const auto corner = [&](std::size_t c) {
                    return slices.vertices[slices.vertexBegin[i] + slices.corners[c]];
                };
                const std::size_t first = slices.cornerBegin[f];
                for (std::size_t c = first + 2; c < slices.cornerBegin[f + 1]; ++c)
                    expected += glm::dot(corner(first), glm::cross(corner(c - 1), corner(c))) / 6;
            }
            const SliceSurface& surface = slices.surfaces[static_cast<std::size_t>(i)];
            const Measure result = measure(surface, 0);
            EXPECT_EQ(result.unpaired, 0U);
            EXPECT_NEAR(result.volume / expected, 1, trial == 0 ? 1e-6 : 0.004) << "trial " << trial << " slice " << i;
            // Where the domain is thinner than a lattice step, the surface may consist of several parts.
            EXPECT_EQ(result.euler, 2 * static_cast<long>(result.components));
        }
    }
}

// Surfaces are closed, whatever the field. Sums of waves have level sets with many components and tunnels. Where two
// parts almost touch, faces of the lattice have alternating corners.
TEST(FieldSlicer, SurfacesOfRandomFieldsAreClosed) {
    std::mt19937 random(22);
    std::normal_distribution<double> normal;
    std::size_t triangles = 0;
    for (int trial = 0; trial < trials(200); ++trial) {
        std::string text;
        for (int i = 0; i < 5; ++i) {
            text += (i > 0 ? " + sin(" : "sin(") + std::to_string(3 * normal(random));
            for (const char axis : {'x', 'y', 'z', 'w'})
                text += " + " + std::to_string(3 * normal(random)) + "*" + axis;
            text += ")";
        }
        // The square root has no value in a ball.
        if (trial % 4 == 3) text += " + 0.1*sqrt(x^2 + y^2 + z^2 + w^2 - 0.5)";
        const auto field = fields::fieldFromFormula("waves", text, {glm::dvec4(-1), glm::dvec4(1, 1, 1, 1.5)});
        ASSERT_TRUE(field) << field.error().message;
        FieldSettings settings{{-0.5, normal(random)},
                               trial % 2 == 0 ? fields::BodySide::below : fields::BodySide::above};
        const SliceSet slices = slicesOf(*field, support::randomRotation(random), settings, 24, {-1, 3, 0.5, 0.05});
        for (const SliceSurface& surface : slices.surfaces) {
            triangles += surface.triangles.size();
            for (std::size_t level = 0; level < 2; ++level) {
                const Measure result = measure(surface, level);
                EXPECT_EQ(result.unpaired, 0U) << "trial " << trial;
                EXPECT_EQ(result.euler % 2, 0);
                EXPECT_GE(result.volume, 0);
            }
        }
    }
    EXPECT_GT(triangles, trials(100'000U));
}

constexpr std::string_view kTiger = "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 < 0.09";

// The 4-volume of the tiger, found from its slices, does not depend on its rotation. It follows from Pappus' theorem: 4
// π³ a b r².
TEST(FieldSlicer, TheTigersVolumeDoesNotDependOnItsRotation) {
    const auto tiger = fields::fieldFromFormula("tiger", kTiger, {glm::dvec4(-1.6), glm::dvec4(1.6)});
    ASSERT_TRUE(tiger) << tiger.error().message;
    const double expected = 4 * std::pow(std::numbers::pi, 3) * 0.7 * 0.09;
    std::mt19937 random(23);
    for (int trial = 0; trial < 5; ++trial) {
        const geometry::Hyperplanes planes{-30, 61, 0.07};
        const SliceSet slices =
            slicesOf(*tiger, trial == 0 ? geometry::Rotation() : support::randomRotation(random), {}, 100, planes);
        double volume = 0;
        for (const SliceSurface& surface : slices.surfaces) volume += planes.spacing * measure(surface, 0).volume;
        EXPECT_NEAR(volume / expected, 1, 0.005) << "trial " << trial;
    }
}

// The slices of the tiger have the right topology. At w = 0, the slice consists of two coaxial tori around the circle
// x² + y² = 1, at z = ±0.7. If |w| is between 0.7 − 0.3 and 0.7 + 0.3, the two tori have merged to one torus. For
// greater |w|, the slice is empty.
TEST(FieldSlicer, TheTigersSlicesHaveTheRightTopology) {
    const auto tiger = fields::fieldFromFormula("tiger", kTiger, {glm::dvec4(-1.6), glm::dvec4(1.6)});
    ASSERT_TRUE(tiger) << tiger.error().message;
    const geometry::Hyperplanes planes{0, 23, 0.05, 0.01};
    const SliceSet slices = slicesOf(*tiger, {}, {}, 100, planes);
    for (int i = 0; i < planes.count; ++i) {
        const double w = planes.w(i);
        const Measure result = measure(slices.surfaces[static_cast<std::size_t>(i)], 0);
        EXPECT_EQ(result.euler, 0);  // a torus has the Euler characteristic 0
        if (std::abs(w - 0.4) < 0.05) continue;
        EXPECT_EQ(result.components, w < 0.4 ? 2U : w < 1 ? 1U : 0U) << "w = " << w;
    }
}

// The rim of a surface is smooth even where the surface meets the box at a small angle: the hyperplane z + s x = 1
// meets the wall z = 1 at x = 0. This holds for any position of the lattice.
TEST(FieldSlicer, RimsAreSmoothWhereASurfaceMeetsTheBoxAtASmallAngle) {
    std::mt19937 random(22);
    for (const double slope : {1.0, 0.3, 0.1}) {
        const auto f = [slope](const glm::dvec4& p) { return p.z + slope * p.x - 1; };
        const fields::Field field = testField(f, 1 + slope, {glm::dvec4(-1), glm::dvec4(1)});
        for (int trial = 0; trial < 4; ++trial) {
            // These rotations do not change w, so the slice at w = 0 contains the whole rim.
            const geometry::Rotation orientation =
                geometry::Rotation(geometry::RotationAngles{geometry::Plane::xy, 0.3 + trial, {}}) *
                geometry::Rotation(geometry::RotationAngles{geometry::Plane::xz, 0.8 * trial, {}}) *
                geometry::Rotation(geometry::RotationAngles{geometry::Plane::yz, 0.1 + 0.6 * trial, {}});
            const SliceSet slices = slicesOf(field, orientation, {}, 64, {0, 1, 1, 0});
            const SliceSurface& surface = slices.surfaces.front();
            EXPECT_EQ(measure(surface, 0).unpaired, 0U);
            std::vector<bool> onCap(surface.points.size()), onLevel(surface.points.size());
            for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
                for (const std::uint32_t point : surface.triangles[t])
                    (surface.isCap(t) ? onCap : onLevel)[point] = true;
            }
            std::size_t rim = 0;
            for (std::size_t k = 0; k < surface.points.size(); ++k) {
                const glm::dvec4 p = orientation.inverse()(glm::dvec4(surface.points[k], 0));
                if (!onCap[k] || !onLevel[k] || std::abs(p.y) > 0.95 || std::abs(p.x) > 0.95) continue;
                EXPECT_NEAR(p.x, 0, 1e-4) << "slope " << slope << ", trial " << trial;
                EXPECT_NEAR(p.z, 1, 1e-4);
                ++rim;
            }
            EXPECT_GT(rim, 30U);
        }
    }
}

// Levels are independent of each other. The same sphere bounds the body inside a level, the body outside the level, and
// one of two bodies that are shown at the same time.
TEST(FieldSlicer, LevelsAreIndependentOfEachOther) {
    const auto ball = fields::fieldFromFormula("ball", "x^2 + y^2 + z^2 + w^2", {glm::dvec4(-1), glm::dvec4(1)});
    ASSERT_TRUE(ball);
    const SliceSet both = slicesOf(*ball, {}, {{0.25, 0.81}, fields::BodySide::below}, 64, {0, 1, 1});
    const SliceSet inner = slicesOf(*ball, {}, {{0.25}, fields::BodySide::below}, 64, {0, 1, 1});
    const SliceSet outside = slicesOf(*ball, {}, {{0.25}, fields::BodySide::above}, 64, {0, 1, 1});
    const double volume = 4.0 / 3 * std::numbers::pi * 0.125;
    EXPECT_NEAR(measure(both.surfaces[0], 0).volume / volume, 1, 0.01);
    EXPECT_EQ(measure(both.surfaces[0], 0).volume, measure(inner.surfaces[0], 0).volume);
    EXPECT_NEAR(measure(both.surfaces[0], 1).volume / (volume * 1.8 * 1.8 * 1.8), 1, 0.01);
    EXPECT_NEAR(measure(outside.surfaces[0], 0).volume, 8 - volume, 0.01);
    // The region outside the level is a cube with a spherical cavity.
    EXPECT_EQ(measure(outside.surfaces[0], 0).euler, 4);
}

TEST(FieldSlicer, GrowthIsTheSpeedOfTheSurface) {
    // The ball's radius at the time t is 0.3 + 0.25 t.
    const auto ball =
        fields::fieldFromFormula("growing", "sqrt(x^2+y^2+z^2) < 0.3 + 0.25*t", {glm::dvec4(-1), glm::dvec4(1)});
    ASSERT_TRUE(ball);
    const SliceSet slices = slicesOf(*ball, {}, {}, 48, {0, 3, 0.3});
    for (const SliceSurface& surface : slices.surfaces) {
        ASSERT_FALSE(surface.points.empty());
        for (const float growth : surface.growth) EXPECT_NEAR(growth, 0.25, 1e-4);
    }
}

// An array with the values of a formula has nearly the same surfaces as the formula. Where the field has the value of
// the level, the array differs from the formula by at most 0.005, because it is interpolated between its samples.
TEST(FieldSlicer, AnArrayOfAFormulasValuesHasItsSurfaces) {
    SKIP_IF_SANITIZED();
    struct Flow {
        double level;
        std::string_view speed;
    };
    // The speeds of two flows that solve the Navier-Stokes equations exactly: the flow of Ethier and Steinman, and a
    // decaying flow of Arnold, Beltrami and Childress.
    for (const Flow& flow :
         {Flow{0.8,
               "exp(-d^2*t)*a*sqrt((exp(a*x)*sin(a*y+d*z)+exp(a*z)*cos(a*x+d*y))^2"
               " + (exp(a*y)*sin(a*z+d*x)+exp(a*x)*cos(a*y+d*z))^2"
               " + (exp(a*z)*sin(a*x+d*y)+exp(a*y)*cos(a*z+d*x))^2); a=pi/4, d=pi/2"},
          Flow{0.9, "exp(-t)*hypot(sin(3*z)+0.5*cos(3*y), 0.7*sin(3*x)+cos(3*z), 0.5*sin(3*y)+0.7*cos(3*x))"}}) {
        const auto formula = fields::fieldFromFormula("flow", flow.speed, {{-1, -1, -1, 0}, {1, 1, 1, 0.6}});
        ASSERT_TRUE(formula) << formula.error().message;
        const fields::Field array = sampledField(*formula, 33);
        const FieldSettings settings{{flow.level}, fields::BodySide::above};
        // The errors are of second order in the distances h of the samples, and in those of the lattice points of the
        // slice. The error of linear interpolation is at most h²/8 times the sum of the second derivatives. A point of
        // the surface is the mean of the places where the surface crosses the edges of a cube. The sum reaches 160
        // where the speed is low.
        constexpr double kMaxError = 160.0 / (16 * 16 * 8);
        std::mt19937 random(24);
        const geometry::Rotation orientation = support::randomRotation(random);
        const geometry::Hyperplanes planes{-2, 5, 0.3, 0.01};
        const SliceSet ofFormula = slicesOf(*formula, orientation, settings, 64, planes);
        const SliceSet ofArray = slicesOf(array, orientation, settings, 64, planes);
        std::size_t compared = 0;
        for (int i = 0; i < planes.count; ++i) {
            const SliceSurface &one = ofFormula.surfaces[static_cast<std::size_t>(i)],
                               &other = ofArray.surfaces[static_cast<std::size_t>(i)];
            const double volume = measure(one, 0).volume;
            EXPECT_NEAR(measure(other, 0).volume, volume, 0.02 + 0.03 * volume);
            for (std::size_t t = 0; t < other.triangles.size(); ++t) {
                if (other.isCap(t)) continue;
                const glm::dvec4 shown(glm::dvec3(other.points[other.triangles[t][0]]), planes.w(i));
                const glm::vec4 p(formula->center + orientation.inverse()(shown));
                float value = 0;
                formula->function->evaluate({{&p.x, 1}, {&p.y, 1}, {&p.z, 1}, {&p.w, 1}}, {&value, 1});
                ASSERT_NEAR(value, flow.level, kMaxError);
                ++compared;
            }
        }
        EXPECT_GT(compared, 1000U);
    }
}

// The region where heat is above a level is a ball of known radius. Where the temperature w^(-3/2) exp(-r²/4w) is L, r²
// = -4w log(L w^(3/2)).
TEST(FieldSlicer, HeatIsWarmerThanALevelInABallOfKnownRadius) {
    constexpr double kLevel = 3, kBegin = 0.05, kEnd = 0.45;
    const auto heat = fields::fieldFromFormula("heat", "w^(-3/2)*exp(-(x^2+y^2+z^2)/(4*w))",
                                               {{-1.5, -1.5, -1.5, kBegin}, {1.5, 1.5, 1.5, kEnd}});
    ASSERT_TRUE(heat) << heat.error().message;
    const geometry::Hyperplanes planes{-1, 3, 0.1, 0};
    const SliceSet slices = slicesOf(*heat, {}, {{kLevel}, fields::BodySide::above}, 64, planes);
    for (int i = 0; i < planes.count; ++i) {
        const double w = (kBegin + kEnd) / 2 + planes.w(i);
        const double radius = std::sqrt(-4 * w * std::log(kLevel * std::pow(w, 1.5)));
        const SliceSurface& surface = slices.surfaces[static_cast<std::size_t>(i)];
        EXPECT_EQ(measure(surface, 0).euler, 2);
        for (const glm::vec3& point : surface.points) EXPECT_NEAR(glm::length(point), radius, 1e-3) << "w = " << w;
    }
}

// The second values of surface points are those of the second function at the field's own points: the points of the
// slice, rotated back. This also holds in a frame of reference, on caps, and for each level.
TEST(FieldSlicer, SecondValuesAreThoseOfTheFieldsOwnPoints) {
    std::mt19937 random(21);
    const auto field = fields::fieldFromFormula(
        "ball", "x^2+y^2+z^2+w^2", {glm::dvec4(-1, -2, -1, -1), glm::dvec4(2, 1, 1, 1)}, "x + 2*y - 3*z + sin(w)");
    ASSERT_TRUE(field);
    for (const geometry::ReferenceFrame& frame :
         {geometry::ReferenceFrame{}, geometry::ReferenceFrame{2, glm::dvec3(0.3, 0, 0), glm::dvec3(0, 0.4, 0)}}) {
        const fields::Field image = transformedTo(*field, frame, 1);
        const geometry::Rotation orientation = support::randomRotation(random);
        const SliceSet slices = slicesOf(image, orientation, {{0.8, 1.5}, fields::BodySide::below}, 40);
        std::size_t points = 0;
        for (int i = 0; i < kPlanes.count; ++i) {
            const SliceSurface& surface = slices.surfaces[static_cast<std::size_t>(i)];
            ASSERT_EQ(surface.secondValues.size(), surface.points.size());
            for (std::size_t k = 0; k < surface.points.size(); ++k) {
                const glm::dvec4 shown(glm::dvec3(surface.points[k]), kPlanes.w(i));
                const glm::dvec4 p = image.center + image.toFunction * orientation.inverse()(shown);
                EXPECT_NEAR(surface.secondValues[k], p.x + 2 * p.y - 3 * p.z + std::sin(p.w), 1e-4);
                ++points;
            }
        }
        EXPECT_GT(points, 1000U);
    }
}

TEST(FieldSlicer, EvaluatesTheSecondFunctionOnlyIfItsValuesAreNeeded) {
    const auto field = fields::fieldFromFormula("ball", "x^2+y^2+z^2+w^2", {glm::dvec4(-1), glm::dvec4(1)}, "x + y");
    ASSERT_TRUE(field);
    SurfaceDetail detail = detailOf(*field, kPlanes, 40);
    detail.secondValues = false;
    SliceSet slices;
    FieldSlicer().slice(*field, {}, kPlanes, {{0.5}, fields::BodySide::below}, detail, slices);
    EXPECT_FALSE(slices.surfaces[10].points.empty());
    EXPECT_TRUE(slices.surfaces[10].secondValues.empty());
}

TEST(FieldSlicer, WithoutASecondFunctionThereAreNoSecondValues) {
    const SliceSet slices = slicesOf(*fields::fieldFromFormula("ball", "x^2+y^2+z^2+w^2 < 1"), {});
    EXPECT_FALSE(slices.surfaces[10].points.empty());
    EXPECT_TRUE(slices.surfaces[10].secondValues.empty());
    EXPECT_EQ(&slices.surfaces[10].coloringValues(), &slices.surfaces[10].values);
}

}  // namespace
}  // namespace oval4d::slicing
