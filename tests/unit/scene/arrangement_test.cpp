// The views: their table, and how each of them arranges the slices.

#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "scene/arrangement.hpp"
#include "unit/scene/composed_scene.hpp"

namespace {

using namespace oval4d;

TEST(Views, haveDifferentNamesAndNumbers) {
    std::set<std::string_view> names;
    std::set<scene::View> values;
    for (const scene::ViewRow& view : scene::kViews) {
        names.insert(view.name);
        values.insert(view.value);
    }
    EXPECT_EQ(names.size(), scene::kViews.size());
    EXPECT_EQ(values.size(), scene::kViews.size());
}

TEST(Views, drawTheSlicesThatTheTableSays) {
    for (const scene::ViewRow& view : scene::kViews) {
        SCOPED_TRACE(view.name);
        scene::Look look;
        look.view = view.value;
        const scene::Scene s = scene::composed("8-cell", 21, {}, look);
        std::size_t drawn = 0;
        for (const auto& placement : s.placements) drawn += placement.drawn ? 1 : 0;
        EXPECT_EQ(drawn, view.showsAllSlices ? s.placements.size() : 1);
    }
}

TEST(Arrangement, hasTheFocusSliceAtTheOriginAndInFrontOfTheCamera) {
    constexpr double kBallRadius = 0.05;
    for (const scene::ViewRow& view : scene::kViews) {
        for (const int count : {1, 3, 21, 201}) {
            for (const double aspect : {0.5, 1.0, 16.0 / 9, 4.0}) {
                SCOPED_TRACE(testing::Message() << view.name << ", " << count << ", " << aspect);
                const scene::Arrangement made = scene::arrangementOf(view.value, count, kBallRadius, aspect);
                EXPECT_EQ(made.positionAt(0), glm::dvec3(0));
                EXPECT_DOUBLE_EQ(made.reach, made.sliceRadius * (1 + kBallRadius));
                EXPECT_GT(made.distance, made.reach);
                for (const double u : {-1.0, 1.0}) EXPECT_LE(glm::length(made.positionAt(u)), made.extent());
            }
        }
    }
}

TEST(Arrangement, ofAllSlicesHasADifferentPlaceForEach) {
    constexpr int kCount = 21;
    for (const scene::ViewRow& view : scene::kViews) {
        if (!view.showsAllSlices) continue;
        const scene::Arrangement made = scene::arrangementOf(view.value, kCount, 0, 1.5);
        for (int i = 1; i < kCount; ++i) {
            const glm::dvec3 before = made.positionAt(scene::parameterOf(i - 1, kCount));
            EXPECT_GT(glm::distance(made.positionAt(scene::parameterOf(i, kCount)), before), made.sliceRadius)
                << view.name;
        }
    }
}

TEST(Arrangement, hasNoNegativeZeroInPositions) {
    for (const scene::ViewRow& view : scene::kViews) {
        const scene::Arrangement made = scene::arrangementOf(view.value, 21, 0.05, 1.5);
        for (const double u : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
            const glm::dvec3 position = made.positionAt(u);
            for (int i = 0; i < 3; ++i)
                EXPECT_FALSE(position[i] == 0 && std::signbit(position[i])) << view.name << ", " << u << ", " << i;
        }
    }
}

TEST(Arrangement, ofAColumnIsARowTurnedByAQuarter) {
    constexpr double kBallRadius = 0.05;
    for (const int count : {3, 21, 201}) {
        for (const double aspect : {0.25, 0.5625, 1.0, 1.5}) {
            SCOPED_TRACE(testing::Message() << count << ", " << aspect);
            const scene::Arrangement row = scene::arrangementOf(scene::View::strip, count, kBallRadius, 1 / aspect);
            const scene::Arrangement column = scene::arrangementOf(scene::View::column, count, kBallRadius, aspect);
            for (const double u : {-1.0, -0.25, 0.0, 1.0})
                EXPECT_EQ(column.positionAt(u), glm::dvec3(0, row.positionAt(u).x, 0)) << u;
            EXPECT_GT(column.positionAt(1).y, 0) << "the largest w is at the top";
            EXPECT_EQ(column.distance, row.distance);
            EXPECT_EQ(column.extent(), row.extent());
            const auto above = scene::projectionBeside(scene::View::strip, row, count, 1 / aspect);
            const auto aside = scene::projectionBeside(scene::View::column, column, count, aspect);
            EXPECT_TRUE(aside.shown);
            EXPECT_EQ(aside.radius, above.radius);
            EXPECT_EQ(aside.position, glm::dvec3(-above.position.y, 0, 0));
        }
    }
}

}  // namespace
