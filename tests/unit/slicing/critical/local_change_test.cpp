#include "slicing/critical/local_change.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/slicing/field_support.hpp"

namespace oval4d::slicing {
namespace {

using fields::BodySide;

// Returns a rotation in space (x, y, z), which does not change w.
geometry::Rotation turnedInSpace() {
    return geometry::Rotation(geometry::RotationAngles{geometry::Plane::xy, 0.4, {}}) *
           geometry::Rotation(geometry::RotationAngles{geometry::Plane::yz, 1.1, {}});
}

glm::dvec3 placeOf(const fields::Field& field, const geometry::Rotation& orientation, const glm::dvec4& point) {
    return glm::dvec3(orientation.matrix() * (point - field.center));
}

bool never() { return false; }

TEST(LocalChange, HeatKernelsInAnArrayMerge) {
    const HeatKernels heat;
    const geometry::Rotation orientation = turnedInSpace();
    LocalTopologyChangeSearch search(heat.array, orientation, HeatKernels::kLevel, BodySide::above, never);
    const double expected = HeatKernels::merging(), center = heat.array.center.w;
    for (const double early : {-5e-4, 0.0, 5e-4}) {
        LocalTopologyChangeSearch::SearchStart start{
            .point = placeOf(heat.array, orientation, {0.02, -0.03, 0.02, center}),
            .half = 0.11,
            .w = expected - center - early,
            .reach = 1.2e-3,
            .tolerance = 2.4e-5};
        const auto found = search.find({.ofBody = true, .becomesMore = false}, start);
        ASSERT_TRUE(found) << early;
        EXPECT_NEAR((*found + center) / expected, 1, 1e-3);
        EXPECT_FALSE(search.find({.ofBody = true, .becomesMore = true}, start)) << "nothing splits";
        start.point = placeOf(heat.array, orientation, {1.85, 0, 0, center});
        EXPECT_FALSE(search.find({.ofBody = true, .becomesMore = false}, start)) << "the surface only moves there";
    }
}

// The search finds the w at which a ball appears: −1. The ball is the body in one case, and the region outside of the
// body in the other case.
TEST(LocalChange, BallsAppear) {
    const fields::Field ball = sampledField(
        testField([](const glm::dvec4& p) { return glm::dot(p, p) - 1; }, 6, {glm::dvec4(-1.5), glm::dvec4(1.5)}), 25);
    const geometry::Rotation orientation = turnedInSpace();
    for (const BodySide inside : {BodySide::below, BodySide::above}) {
        LocalTopologyChangeSearch search(ball, orientation, 0, inside, never);
        const LocalTopologyChangeSearch::SearchStart start{
            .point = glm::dvec3(0.02, -0.01, 0.03), .half = 0.075, .w = -0.995, .reach = 0.015, .tolerance = 3e-4};
        const bool ofBody = inside == BodySide::below;
        const auto found = search.find({.ofBody = ofBody, .becomesMore = true}, start);
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, -1, 1e-3);
        EXPECT_FALSE(search.find({.ofBody = ofBody, .becomesMore = false}, start));
    }
}

TEST(LocalChange, EndsWhenItMust) {
    const HeatKernels heat;
    int asked = 0;
    LocalTopologyChangeSearch search(heat.array, {}, HeatKernels::kLevel, BodySide::above, [&] { return ++asked > 2; });
    const double center = heat.array.center.w;
    EXPECT_FALSE(
        search.find({.ofBody = true, .becomesMore = false}, {.point = placeOf(heat.array, {}, {0, 0, 0, center}),
                                                             .half = 0.11,
                                                             .w = HeatKernels::merging() - center,
                                                             .reach = 1.2e-3,
                                                             .tolerance = 2.4e-5}));
    EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace oval4d::slicing
