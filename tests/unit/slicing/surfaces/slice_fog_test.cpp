#include "slicing/surfaces/slice_fog.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "slicing/field_slicer.hpp"
#include "unit/polytopes/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace oval4d::slicing {
namespace {

/// Returns the section by w = 0 of the box in which all coordinates are from −`reach` to `reach`.
FieldSection cubeSection(double reach = 1) {
    FieldSection section;
    for (int axis = 0; axis < 3; ++axis) {
        section.axes[static_cast<std::size_t>(axis)][axis] = 1;
        glm::dvec3 normal(0);
        normal[axis] = 1;
        section.walls.push_back({normal, reach});
        section.walls.push_back({-normal, reach});
    }
    section.normal[3] = 1;
    section.min = glm::dvec3(-reach);
    section.max = glm::dvec3(reach);
    return section;
}

SliceFog sampled(const TestFunction::Callable& f, double least, double greatest, double step, double reach = 1) {
    SliceFog fog;
    sampleFog(TestFunction(f, 1), cubeSection(reach), least, greatest, step, fog);
    return fog;
}

std::uint8_t at(const SliceFog& fog, glm::ivec3 p) {
    return fog.values[static_cast<std::size_t>(p.x) +
                      static_cast<std::size_t>(fog.size.x) *
                          (static_cast<std::size_t>(p.y) + static_cast<std::size_t>(fog.size.y) * p.z)];
}

template <typename Visit>
void forEachPoint(const SliceFog& fog, Visit visit) {
    for (glm::ivec3 p(0); p.z < fog.size.z; ++p.z)
        for (p.y = 0; p.y < fog.size.y; ++p.y)
            for (p.x = 0; p.x < fog.size.x; ++p.x) visit(p, fog.min + fog.step * glm::dvec3(p));
}

TEST(SliceFog, HasTheValuesAtThePointsOfItsLattice) {
    const auto f = [](const glm::dvec4& p) { return p.x + 2 * p.y - p.z; };
    const SliceFog fog = sampled(f, -4, 4, 0.13);
    EXPECT_EQ(fog.values.size(), static_cast<std::size_t>(fog.size.x) * fog.size.y * fog.size.z);
    EXPECT_EQ(fog.step, 0.13);
    forEachPoint(fog, [&](glm::ivec3 p, const glm::dvec3& place) {
        const double expected = 1 + (f(glm::dvec4(place, 0)) + 4) / 8 * 254;
        EXPECT_NEAR(at(fog, p), std::clamp(expected, 1.0, 255.0), 0.51);
    });
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(fog.min[axis], -1);
        EXPECT_GE(fog.min[axis] + fog.step * (fog.size[axis] - 1), 1) << "the lattice covers the section";
        EXPECT_NEAR(std::remainder(fog.min[axis], fog.step), 0, 1e-12) << "and contains the origin";
    }
}

TEST(SliceFog, OfASymmetricFieldIsSymmetric) {
    const SliceFog fog = sampled([](const glm::dvec4& p) { return p.x * p.x + p.y * p.y * p.z * p.z; }, 0, 2, 0.19);
    forEachPoint(fog, [&](glm::ivec3 p, const glm::dvec3& /*place*/) {
        const glm::ivec3 last = fog.size - 1;
        EXPECT_EQ(at(fog, p), at(fog, {last.x - p.x, p.y, p.z}));
        EXPECT_EQ(at(fog, p), at(fog, last - p));
        EXPECT_NEAR(at(fog, p), at(fog, {p.x, p.z, p.y}), 1);
    });
}

TEST(SliceFog, IsEmptyWhereTheFieldHasNoValue) {
    const auto f = [](const glm::dvec4& p) { return p.x > 0.1 ? std::numeric_limits<double>::quiet_NaN() : p.y; };
    const SliceFog fog = sampled(f, -1, 1, 0.11);
    forEachPoint(fog, [&](glm::ivec3 p, const glm::dvec3& place) { EXPECT_EQ(at(fog, p) == 0, place.x > 0.1); });
}

TEST(SliceFog, ValuesBeyondTheRangeCountAsItsEnds) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto f = [](const glm::dvec4& p) { return p.x < 0 ? -kInfinity : p.x > 0.5 ? kInfinity : 1e30; };
    for (const auto& [least, greatest] : {std::pair(-1.0, 1.0), {0.0, 5e-324}, {-1e30, 1e30}}) {
        const SliceFog fog = sampled(f, least, greatest, 0.25);
        forEachPoint(fog, [&](glm::ivec3 p, const glm::dvec3& place) { EXPECT_EQ(at(fog, p), place.x < 0 ? 1 : 255); });
    }
}

TEST(SliceFog, HasABoundedNumberOfPoints) {
    const SliceFog fog = sampled([](const glm::dvec4&) { return 0; }, 0, 1, 1e-4, 0.73);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(fog.size[axis], SliceFog::kMaxPoints);
        EXPECT_GT(fog.size[axis], SliceFog::kMaxPoints - 8);
    }
}

TEST(SliceFog, OfAFieldIsSampledInItsHyperplanes) {
    const auto f = [](const glm::dvec4& p) { return p.x + 0.5 * p.y - p.z + 0.25 * p.w; };
    const fields::Field field = testField(f, 2, {glm::dvec4(-1, -2, -1, 0), glm::dvec4(1, 1, 2, 3)});
    std::mt19937 random(3);
    const geometry::Rotation orientation = support::randomRotation(random);
    const geometry::Hyperplanes planes{-3, 7, 0.5, 0};
    FieldSettings settings;
    settings.fog = {{-5, 0}, {5, 1}};
    SurfaceDetail detail = detailOf(field, planes, 20);
    SliceSet out;
    FieldSlicer slicer;
    slicer.slice(field, orientation, planes, settings, detail, out);
    EXPECT_TRUE(out.fogs.empty()) << "none was asked for";
    detail.fogSteps = detail.steps;
    detail.steps.clear();
    slicer.slice(field, orientation, planes, settings, detail, out);
    ASSERT_EQ(out.fogs.size(), 7U);
    int filled = 0;
    for (int i = 0; i < planes.count; ++i) {
        const SliceFog& fog = out.fogs[static_cast<std::size_t>(i)];
        EXPECT_EQ(fog.empty(), out.vertexCount(i) == 0);
        filled += fog.empty() ? 0 : 1;
        forEachPoint(fog, [&](glm::ivec3 p, const glm::dvec3& place) {
            const glm::dvec4 q = field.center + orientation.inverse()(glm::dvec4(place, planes.w(i)));
            EXPECT_NEAR(at(fog, p), std::clamp(1 + (f(q) + 5) / 10 * 254, 1.0, 255.0), 0.51);
        });
        // The walls bound the slice of the domain: each vertex of this slice lies on three walls.
        for (std::size_t v = 0; v < out.vertexCount(i); ++v) {
            const glm::dvec3& vertex = out.vertices[out.vertexBegin[static_cast<std::size_t>(i)] + v];
            int touched = 0;
            for (const auto& [normal, offset] : fog.walls) {
                EXPECT_LE(glm::dot(normal, vertex), offset + 1e-9);
                touched += glm::dot(normal, vertex) > offset - 1e-9 ? 1 : 0;
            }
            EXPECT_GE(touched, 3);
        }
    }
    EXPECT_GE(filled, 5);
    settings.fog.clear();
    slicer.slice(field, orientation, planes, settings, detail, out);
    EXPECT_TRUE(out.fogs.empty()) << "there is no fog";
}

TEST(SliceFog, OfAllSlicesKeepsWithinItsBounds) {
    const fields::Field field = testField([](const glm::dvec4& p) { return p.x; }, 1, {glm::dvec4(-1), glm::dvec4(1)});
    const geometry::Hyperplanes planes{-10, 21, 0.08, 0};
    FieldSettings settings;
    settings.fog = {{0, 0}, {1, 1}};
    for (const Quality quality : {Quality::draft, Quality::full}) {
        SurfaceDetail detail;
        detail.fogSteps.assign(21, 0.004);
        detail.quality = quality;
        SliceSet out;
        FieldSlicer().slice(field, {}, planes, settings, detail, out);
        std::size_t points = 0;
        for (const SliceFog& fog : out.fogs) points += fog.values.size();
        EXPECT_LE(points, 1.1 * static_cast<double>(maxFogSamples(quality)));
        EXPECT_GT(points, 0.7 * static_cast<double>(maxFogSamples(quality)));
    }
}

}  // namespace
}  // namespace oval4d::slicing
