#include "slicing/closed_surfaces/closed_surface_slicer.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fields/array/array_function.hpp"
#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "slicing/field_slicer.hpp"
#include "slicing/surfaces/surface_measurements.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/directed_edges.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::slicing {
namespace {

using fields::BodySide;

// Returns an array with random samples between −1 and 1. The fraction `holes` of the samples are NaN.
fields::Field randomArray(const fields::Shape& shape, const fields::Box& box, std::mt19937& random, double holes = 0) {
    std::uniform_real_distribution<float> value(-1, 1);
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<float> samples(fields::sampleCount(shape));
    for (float& sample : samples) sample = chance(random) < holes ? NAN : value(random);
    auto function =
        std::make_shared<const fields::ArrayFunction>(shape, box, fields::SampleStorage(std::move(samples)));
    fields::Field field = fields::makeField("random", function, box);
    field.array = function;
    return field;
}

fields::Field formula(std::string_view text, const fields::Box& box) {
    auto field = fields::fieldFromFormula("formula", text, box);
    EXPECT_TRUE(field) << field.error().message;
    return std::move(*field);
}

ClosedSurface exactSlice(ClosedSurfaceSlicer& slicer, double w, double level, BodySide inside = BodySide::below) {
    ClosedSurface surface;
    const auto done = slicer.slice(w, {.level = level, .inside = inside}, surface);
    EXPECT_TRUE(done);
    return surface;
}

// Returns the fraction of a simplex in which a linear function is below the level. `below` and `above` are the values
// at the corners below and above the level. An edge between two such corners is cut where the function has the value of
// the level. This cut divides the simplex in two simplices, whose volumes are proportional to the lengths of the parts
// of the edge.
double shareBelow(std::vector<double> below, std::vector<double> above, double level) {
    if (above.empty()) return 1;
    if (below.empty()) return 0;
    const double a = below.back(), b = above.back(), t = (level - a) / (b - a);
    std::vector<double> fewerBelow = below, fewerAbove = above;
    fewerBelow.pop_back();
    fewerAbove.pop_back();
    return t * shareBelow(below, fewerAbove, level) + (1 - t) * shareBelow(fewerBelow, above, level);
}

struct Cut {
    std::vector<glm::dvec4> corners;
    std::vector<double> values;
};

// Returns the simplices of the subdivision of an array's lattice, found from the definition: the points of a cell whose
// fractional coordinates have the same order form a simplex. Simplices with a corner without a value are left out.
std::vector<Cut> simplicesOf(const fields::Field& field, const geometry::Rotation& orientation) {
    std::vector<Cut> simplices;
    const fields::Shape shape = field.array->shape();
    const glm::dmat4 toSlice = orientation.matrix() * glm::inverse(field.toFunction);
    for (std::size_t cell = 0; cell < field.array->samples().size(); ++cell) {
        std::array<std::size_t, 4> at{};
        std::size_t rest = cell;
        bool isLast = false;
        for (std::size_t a = 0; a < 4; rest /= shape[a], ++a) {
            at[a] = rest % shape[a];
            isLast |= at[a] + 1 == shape[a];
        }
        if (isLast) continue;
        std::array<std::size_t, 4> order{0, 1, 2, 3};
        do {
            Cut simplex;
            auto corner = at;
            for (std::size_t i = 0; i <= 4; ++i) {
                if (i > 0) ++corner[order[i - 1]];
                glm::dvec4 position;
                for (std::size_t a = 0; a < 4; ++a) {
                    const auto k = static_cast<int>(a);
                    position[k] = glm::mix(field.box.min[k], field.box.max[k],
                                           static_cast<double>(corner[a]) / static_cast<double>(shape[a] - 1));
                }
                simplex.corners.push_back(toSlice * (position - field.center));
                simplex.values.push_back(
                    field.array->samples()[corner[0] +
                                           shape[0] * (corner[1] + shape[1] * (corner[2] + shape[2] * corner[3]))]);
            }
            if (std::ranges::none_of(simplex.values, [](double v) { return std::isnan(v); }))
                simplices.push_back(simplex);
        } while (std::ranges::next_permutation(order).found);
    }
    return simplices;
}

double bodyVolume(const std::vector<Cut>& simplices, double level, BodySide inside) {
    double sum = 0;
    for (const Cut& s : simplices) {
        std::vector<double> below, above;
        for (const double value : s.values) (value < level ? below : above).push_back(value);
        const double share = shareBelow(below, above, level);
        const glm::dmat4 sides(s.corners[1] - s.corners[0], s.corners[2] - s.corners[0], s.corners[3] - s.corners[0],
                               s.corners[4] - s.corners[0]);
        sum += std::abs(glm::determinant(sides)) / 24 * (inside == BodySide::below ? share : 1 - share);
    }
    return sum;
}

// Returns the values of w between which the volume of the slices is a polynomial of degree 3: those of the vertices of
// the simplices that form the body.
std::vector<double> breakpoints(const std::vector<Cut>& simplices, double level) {
    std::vector<double> all;
    for (const Cut& s : simplices) {
        for (std::size_t i = 0; i < 5; ++i) {
            all.push_back(s.corners[i].w);
            for (std::size_t j = 0; j < i; ++j) {
                if ((s.values[i] < level) == (s.values[j] < level)) continue;
                all.push_back(
                    glm::mix(s.corners[i].w, s.corners[j].w, (level - s.values[i]) / (s.values[j] - s.values[i])));
            }
        }
    }
    std::ranges::sort(all);
    return all;
}

// The volumes of the slices add up: their integral over w is the 4-volume of the body (the region inside the level).
// The 4-volume is computed from the volumes of the simplices. Gauss's formula with two points is exact for polynomials
// of degree 3.
TEST(ClosedSurfaceSlicer, VolumesAddUpToThatOfTheBody) {
    std::mt19937 random(30);
    for (int trial = 0; trial < 8; ++trial) {
        const fields::Field field = randomArray({3, 2, 3, 2}, {glm::dvec4(-1, 0, 0.5, -2), glm::dvec4(1, 1.5, 2, 1)},
                                                random, trial == 7 ? 0.1 : 0);
        const geometry::Rotation orientation = trial < 2 ? geometry::Rotation() : support::randomRotation(random);
        const double level = std::uniform_real_distribution<double>(-0.6, 0.6)(random);
        const BodySide inside = trial % 2 == 0 ? BodySide::below : BodySide::above;
        const auto simplices = simplicesOf(field, orientation);
        const std::vector<double> ws = breakpoints(simplices, level);
        ClosedSurfaceSlicer slicer(field, orientation);
        double sum = 0;
        for (std::size_t i = 1; i < ws.size(); ++i) {
            const double half = (ws[i] - ws[i - 1]) / 2, middle = (ws[i] + ws[i - 1]) / 2;
            if (half < 1e-12) continue;
            for (const double side : {-1.0, 1.0}) {
                const ClosedSurface surface =
                    exactSlice(slicer, middle + side * half / std::numbers::sqrt3, level, inside);
                EXPECT_EQ(support::DirectedEdges(surface.triangles).unbalanced(), 0U);
                sum += half * measureSurface(surface).volume;
            }
        }
        const double expected = bodyVolume(simplices, level, inside);
        EXPECT_GT(expected, 0.1);
        EXPECT_NEAR(sum / expected, 1, 1e-9) << "trial " << trial;
    }
}

// The surfaces of all fields are closed manifolds. Sums of waves on small lattices have surfaces with many components
// and tunnels.
TEST(ClosedSurfaceSlicer, SurfacesOfRandomFieldsAreClosedManifolds) {
    std::mt19937 random(31);
    std::uniform_int_distribution<std::size_t> samples(2, 6);
    std::size_t triangles = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const fields::Shape shape{samples(random), samples(random), samples(random), samples(random)};
        const bool holes = trial % 4 == 3;
        const fields::Field field =
            randomArray(shape, {glm::dvec4(-1), glm::dvec4(1, 1, 1, 1.5)}, random, holes ? 0.05 : 0);
        ClosedSurfaceSlicer slicer(field, trial % 5 == 0 ? geometry::Rotation() : support::randomRotation(random));
        for (const double level : {-0.5, 0.0, 0.4}) {
            // The hyperplane w = 0 is in the middle of the lattice, and often contains lattice points.
            for (const double w : {-0.3, 0.0, 0.7}) {
                const BodySide inside = trial % 2 == 0 ? BodySide::below : BodySide::above;
                const ClosedSurface surface = exactSlice(slicer, w, level, inside);
                triangles += surface.triangles.size();
                EXPECT_EQ(support::DirectedEdges(surface.triangles).unbalanced(), 0U) << "trial " << trial;
                if (!holes) {
                    EXPECT_TRUE(support::DirectedEdges(surface.triangles).isManifold()) << "trial " << trial;
                    EXPECT_EQ(measureSurface(surface).euler % 2, 0);
                }
                EXPECT_GE(measureSurface(surface).volume, 0);
                EXPECT_LE(surface.firstCap, surface.triangles.size());
            }
        }
    }
    EXPECT_GT(triangles, 100'000U);
}

// Points of the surface have the values and gradients of the function. The interpolation of a linear function is the
// function itself, which has only one gradient.
TEST(ClosedSurfaceSlicer, PointsHaveValuesAndGradients) {
    std::mt19937 random(38);
    const glm::dvec4 slope(0.7, -1.1, 0.4, 0.9);
    fields::Field field = sampledField(testField([&](const glm::dvec4& p) { return glm::dot(slope, p) + 0.1; }, 2,
                                                 {glm::dvec4(-1, -1, -1, -2), glm::dvec4(1, 1.5, 1, 1)}),
                                       5);
    glm::dmat4 sheared(1);
    sheared[3][0] = 0.5;
    field.toFunction = glm::inverse(sheared);
    for (const BodySide inside : {BodySide::below, BodySide::above}) {
        const geometry::Rotation orientation = support::randomRotation(random);
        const glm::dmat4 toFunction = field.toFunction * orientation.inverse().matrix();
        const glm::dvec4 expected = glm::normalize(glm::transpose(toFunction) * slope);
        const double level = glm::dot(slope, field.center + toFunction * glm::dvec4(0, 0, 0, 0.1)) + 0.15;
        ClosedSurfaceSlicer slicer(field, orientation);
        ClosedSurface surface;
        ASSERT_TRUE(slicer.slice(0.1, {.level = level, .inside = inside, .pointData = true}, surface));
        ASSERT_GT(surface.firstCap, 0U);
        ASSERT_LT(surface.firstCap, surface.triangles.size());
        ASSERT_EQ(surface.values.size(), surface.points.size());
        ASSERT_EQ(surface.gradients.size(), surface.points.size());
        for (std::size_t i = 0; i < surface.points.size(); ++i) {
            const glm::dvec4 at = field.center + toFunction * glm::dvec4(surface.points[i], 0.1);
            EXPECT_NEAR(surface.values[i], glm::dot(slope, at) + 0.1, 1e-5);
        }
        for (std::size_t t = 0; t < surface.firstCap; ++t) {
            for (const std::uint32_t corner : surface.triangles[t]) {
                EXPECT_EQ(surface.values[corner], static_cast<float>(level));
                EXPECT_LT(glm::distance(glm::normalize(surface.gradients[corner]), expected), 1e-4);
            }
        }
        EXPECT_TRUE(exactSlice(slicer, 0.1, level, inside).values.empty());
    }
}

// The region below a level and the region above it together fill the domain.
TEST(ClosedSurfaceSlicer, BothSidesOfALevelFillTheDomain) {
    std::mt19937 random(32);
    const fields::Field field = randomArray({4, 5, 3, 4}, {glm::dvec4(-1), glm::dvec4(1)}, random);
    for (int trial = 0; trial < 20; ++trial) {
        const geometry::Rotation orientation = trial == 0 ? geometry::Rotation() : support::randomRotation(random);
        ClosedSurfaceSlicer slicer(field, orientation);
        const double w = std::uniform_real_distribution<double>(-0.9, 0.9)(random);
        const auto below = measureSurface(exactSlice(slicer, w, 0.1, BodySide::below));
        const auto above = measureSurface(exactSlice(slicer, w, 0.1, BodySide::above));
        const auto all = measureSurface(exactSlice(slicer, w, 2, BodySide::below));
        EXPECT_NEAR(below.volume + above.volume, all.volume, 1e-12);
        EXPECT_NEAR(below.area, above.area, 1e-10);
        EXPECT_NEAR(below.capArea + above.capArea, all.capArea, 1e-10);
        EXPECT_EQ(all.area, 0);
        EXPECT_EQ(all.components, 1U);
        EXPECT_EQ(all.euler, 2);
        if (trial == 0) {
            EXPECT_NEAR(all.volume, 8, 1e-12);
            EXPECT_NEAR(all.capArea, 24, 1e-12);
        }
    }
}

TEST(ClosedSurfaceSlicer, ConstantAndSmallFields) {
    const auto constant = [](float value, const fields::Shape& shape) {
        auto function = std::make_shared<const fields::ArrayFunction>(
            shape, fields::Box{}, fields::SampleStorage(std::vector<float>(fields::sampleCount(shape), value)));
        fields::Field field = fields::makeField("constant", function, {});
        field.array = function;
        return field;
    };
    for (const fields::Shape& shape :
         {fields::Shape{2, 2, 2, 2}, fields::Shape{1, 1, 1, 1}, fields::Shape{9, 1, 3, 2}}) {
        const fields::Field field = constant(0.5F, shape);
        ClosedSurfaceSlicer slicer(field, {});
        EXPECT_NEAR(measureSurface(exactSlice(slicer, 0, 1)).volume, 8, 1e-12);
        EXPECT_TRUE(exactSlice(slicer, 0, 0.5).triangles.empty()) << "a value on the level is outside";
        EXPECT_TRUE(exactSlice(slicer, 0, 0.5, BodySide::above).triangles.empty());
        EXPECT_TRUE(exactSlice(slicer, 0, -1).triangles.empty());
        EXPECT_TRUE(exactSlice(slicer, 1.5, 1).triangles.empty()) << "beside the domain";
        for (const double end : {-1.0, 1.0, std::nextafter(-1.0, -2.0), std::nextafter(1.0, 2.0)})
            EXPECT_NEAR(measureSurface(exactSlice(slicer, end, 1)).volume, 8, 1e-12) << "a facet of the domain";
        EXPECT_TRUE(exactSlice(slicer, -1.001, 1).triangles.empty()) << "just beside the domain";
    }
    const fields::Field nothing = constant(NAN, {3, 3, 3, 3});
    ClosedSurfaceSlicer slicer(nothing, {});
    EXPECT_TRUE(exactSlice(slicer, 0, 1).triangles.empty());
}

// Where samples have no value, the surface has caps. If one sample of a lattice has no value, the pentatopes around it
// are missing from the body.
TEST(ClosedSurfaceSlicer, HolesHaveCaps) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float hole : {NAN, kInfinity, -kInfinity}) {
        std::vector<float> samples(5 * 5 * 5 * 5, -1);
        samples[2 + 5 * (2 + 5 * (2 + 5 * 2))] = hole;
        const fields::Box box{glm::dvec4(-2), glm::dvec4(2)};
        auto function = std::make_shared<const fields::ArrayFunction>(fields::Shape{5, 5, 5, 5}, box,
                                                                      fields::SampleStorage(std::move(samples)));
        fields::Field field = fields::makeField("hole", function, box);
        field.array = function;
        ClosedSurfaceSlicer slicer(field, {});
        for (const auto& [level, inside] : {std::pair{0.0, BodySide::below}, {-2.0, BodySide::above}}) {
            SCOPED_TRACE(testing::Message() << hole << " beside " << level);
            const ClosedSurface surface = exactSlice(slicer, 0.25, level, inside);
            EXPECT_EQ(support::DirectedEdges(surface.triangles).unbalanced(), 0U);
            EXPECT_EQ(surface.firstCap, 0U);
            const auto measured = measureSurface(surface);
            EXPECT_EQ(measured.components, 1U);
            EXPECT_EQ(measured.euler, 4) << "a cube with a cavity";
            EXPECT_LT(measured.volume, 64);
            EXPECT_GT(measured.volume, 56);  // the missing part is within 8 cells of the lattice
            EXPECT_EQ(measured.area, 0);
            ASSERT_TRUE(measured.centroid);
            EXPECT_LT(glm::length(*measured.centroid), 0.25);
        }
    }
}

// A pole of a formula belongs to the body (the region inside the level). The function is infinite at the origin, which
// is a lattice point in the middle of the body.
TEST(ClosedSurfaceSlicer, PolesOfFormulasBelongToTheBody) {
    const double w = 0.01, radius = std::sqrt(0.25 - w * w),
                 expected = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
    for (const auto& [text, level, inside] :
         {std::tuple{"1/(x^2+y^2+z^2+w^2)", 4.0, BodySide::above}, {"-1/(x^2+y^2+z^2+w^2)", -4.0, BodySide::below}}) {
        const fields::Field field = formula(text, {glm::dvec4(-1), glm::dvec4(1)});
        ClosedSurfaceSlicer slicer(field, {}, 32);
        const ClosedSurface surface = exactSlice(slicer, w, level, inside);
        EXPECT_EQ(support::DirectedEdges(surface.triangles).unbalanced(), 0U);
        EXPECT_EQ(surface.firstCap, surface.triangles.size());
        const auto measured = measureSurface(surface);
        EXPECT_EQ(measured.components, 1U);
        EXPECT_EQ(measured.euler, 2) << "a ball without a cavity";
        EXPECT_NEAR(measured.volume / expected, 1, 0.1);
    }
}

TEST(ClosedSurfaceSlicer, EllipsoidsConverge) {
    // The rotated ellipsoid x²/a² + y²/b² + z²/c² + w²/d² < 1 has the extent h along w. Its slice at w is an ellipsoid
    // with the volume 4/3 π abcd/h (1 − w²/h²)^(3/2).
    const glm::dvec4 axes(0.9, 0.7, 0.8, 0.6);
    const fields::Field field =
        formula("(x/0.9)^2 + (y/0.7)^2 + (z/0.8)^2 + (w/0.6)^2 < 1", {glm::dvec4(-1), glm::dvec4(1)});
    std::mt19937 random(33);
    for (int trial = 0; trial < 3; ++trial) {
        const geometry::Rotation orientation = support::randomRotation(random);
        const glm::dmat4 m = orientation.matrix();
        const double extent = glm::length(glm::dvec4(m[0][3], m[1][3], m[2][3], m[3][3]) * axes), w = 0.2;
        const double expected = 4.0 / 3 * std::numbers::pi * axes.x * axes.y * axes.z * axes.w / extent *
                                std::pow(1 - w * w / (extent * extent), 1.5);
        std::array<double, 3> errors{};
        for (std::size_t i = 0; i < 3; ++i) {
            ClosedSurfaceSlicer slicer(field, orientation, 12 << i);
            const auto measured = measureSurface(exactSlice(slicer, w, 0));
            EXPECT_EQ(measured.euler, 2);
            EXPECT_EQ(measured.components, 1U);
            errors[i] = std::abs(measured.volume / expected - 1);
        }
        // The error of linear interpolation is of second order in the size of the lattice cells.
        EXPECT_LT(errors[1], errors[0] / 3);
        EXPECT_LT(errors[2], errors[1] / 3);
        EXPECT_LT(errors[2], 0.005);
    }
}

TEST(ClosedSurfaceSlicer, TheInteractiveSurfacesConvergeToIt) {
    const fields::Field field = formula("(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 < 0.09",
                                        {glm::dvec4(-1.5, -1.5, -0.9, -1.2), glm::dvec4(1.5, 1.2, 1.2, 1.2)});
    std::mt19937 random(34);
    const geometry::Rotation orientation = support::randomRotation(random);
    const geometry::Hyperplanes planes{-2, 5, 0.2, 0.03};
    ClosedSurfaceSlicer exact(field, orientation, 96);
    SliceSet slices;
    SurfaceDetail detail;
    setUniformDetail(field.circumradius, planes, Quality::file, detail);
    FieldSlicer().slice(field, orientation, planes, {}, detail, slices);
    for (int i = 0; i < planes.count; ++i) {
        const auto expected = measureSurface(exactSlice(exact, planes.w(i), 0));
        const auto measured = measureSurface(slices.surfaces[static_cast<std::size_t>(i)], 0);
        ASSERT_GT(expected.volume, 0.1);
        EXPECT_NEAR(measured.volume / expected.volume, 1, 0.01);
        EXPECT_NEAR(measured.area / expected.area, 1, 0.01);
        EXPECT_NEAR(measured.capArea, expected.capArea, 0.02);
        EXPECT_LT(glm::distance(*measured.centroid, *expected.centroid), 0.01);
        EXPECT_EQ(measured.components, expected.components);
        EXPECT_EQ(measured.euler, expected.euler);
    }
}

// The object's axes may be any linear images of the function's axes.
TEST(ClosedSurfaceSlicer, LinearMapsOfTheObjectAreTakenIntoAccount) {
    std::mt19937 random(35);
    fields::Field field = randomArray({4, 4, 4, 4}, {glm::dvec4(-1), glm::dvec4(1)}, random);
    glm::dmat4 sheared(1);
    sheared[3][0] = 0.5;  // a moving frame of reference: x' = x + t / 2
    sheared[1][1] = 2;
    field.toFunction = glm::inverse(sheared);
    const geometry::Rotation orientation = support::randomRotation(random);
    const auto simplices = simplicesOf(field, orientation);
    const std::vector<double> ws = breakpoints(simplices, 0);
    ClosedSurfaceSlicer slicer(field, orientation);
    double sum = 0;
    constexpr int kSlices = 400;
    for (int i = 0; i < kSlices; ++i) {
        const double w = glm::mix(ws.front(), ws.back(), (i + 0.5) / kSlices);
        sum += (ws.back() - ws.front()) / kSlices * measureSurface(exactSlice(slicer, w, 0)).volume;
    }
    EXPECT_NEAR(sum / bodyVolume(simplices, 0, BodySide::below), 1, 1e-4);
}

TEST(ClosedSurfaceSlicer, ALongAxisTakesLittleMemory) {
    std::mt19937 random(37);
    constexpr std::size_t kSamples = std::size_t{1} << 20U;
    const fields::Field field = randomArray({kSamples, 1, 1, 1}, {glm::dvec4(-1), glm::dvec4(1)}, random);
    const auto used = [] {
        const auto info = mallinfo2();
        return info.uordblks + info.hblkhd;
    };
    const std::size_t before = used();
    const ClosedSurfaceSlicer slicer(field, {});
    EXPECT_LT(used(), before + 2 * sizeof(double) * kSamples);
    EXPECT_LT(glm::distance(slicer.lattice().position(glm::ivec4(0)), glm::dvec4(-1)), 1e-12);
}

TEST(ClosedSurfaceSlicer, IsBoundedAndCancelable) {
    std::mt19937 random(36);
    const fields::Field field = randomArray({12, 12, 12, 12}, {glm::dvec4(-1), glm::dvec4(1)}, random);
    ClosedSurfaceSlicer slicer(field, support::randomRotation(random));
    ClosedSurface surface;
    auto done = slicer.slice(0, {.maxTriangles = 1000}, surface);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("1000 triangles"), std::string::npos);
    EXPECT_LT(surface.triangles.size(), 2000U);
    int asked = 0;
    done = slicer.slice(0, {.mustStop = [&] { return ++asked == 2; }}, surface);
    ASSERT_FALSE(done);
    EXPECT_EQ(asked, 2);
    EXPECT_TRUE(slicer.slice(0, {}, surface));  // after an error, the slicer works again
    EXPECT_EQ(support::DirectedEdges(surface.triangles).unbalanced(), 0U);
}

}  // namespace
}  // namespace oval4d::slicing
