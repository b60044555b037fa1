// Tests of the views: the table of views, and how each view arranges the slices.

#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/arrangement.hpp"
#include "unit/scene/composed_scene.hpp"

namespace {

using namespace oval4d;

/// Returns a room with this aspect ratio (width / height) and the height of the picture. The symbol of the axes takes a
/// part of the room.
scene::AvailableSpace roomOf(double aspect, bool hasProjection = false) {
    return {glm::dvec2(aspect, 1), {glm::dvec2(0.9 * aspect, 1), glm::dvec2(aspect, 0.9)}, hasProjection};
}

TEST(Views, haveDifferentNamesAndNumbers) {
    std::set<std::string_view> names;
    std::set<scene::View> values;
    for (const scene::ViewTableRow& view : scene::kViews) {
        names.insert(view.name);
        values.insert(view.value);
    }
    EXPECT_EQ(names.size(), scene::kViews.size());
    EXPECT_EQ(values.size(), scene::kViews.size());
}

TEST(Views, drawTheSlicesThatTheTableSays) {
    for (const scene::ViewTableRow& view : scene::kViews) {
        SCOPED_TRACE(view.name);
        scene::Look look;
        look.view = view.value;
        const scene::Scene s = scene::composed("8-cell", 21, {}, look);
        std::size_t drawn = 0;
        for (const auto& placement : s.placements) drawn += placement.drawn ? 1 : 0;
        EXPECT_EQ(drawn, view.showsAllSlices ? s.placements.size() : 1);
    }
}

TEST(SliceArrangement, hasTheFocusSliceAtTheOriginAndInFrontOfTheCamera) {
    constexpr double kBallRadius = 0.05;
    for (const scene::ViewTableRow& view : scene::kViews) {
        for (const int count : {1, 3, 21, 201}) {
            for (const double aspect : {0.5, 1.0, 16.0 / 9, 4.0}) {
                SCOPED_TRACE(testing::Message() << view.name << ", " << count << ", " << aspect);
                const scene::SliceArrangement made =
                    scene::arrangementOf(view.value, count, kBallRadius, aspect, roomOf(aspect));
                EXPECT_EQ(made.positionAt(0), glm::dvec3(0));
                EXPECT_DOUBLE_EQ(made.reach, made.sliceRadius * (1 + kBallRadius));
                EXPECT_GT(made.distance, made.reach);
                for (const double u : {-1.0, 1.0})
                    EXPECT_LE(glm::length(made.positionAt(u)), made.maxDistanceFromFocus());
            }
        }
    }
}

TEST(SliceArrangement, ofAllSlicesHasADifferentPlaceForEach) {
    constexpr int kCount = 21;
    for (const scene::ViewTableRow& view : scene::kViews) {
        if (!view.showsAllSlices) continue;
        const scene::SliceArrangement made = scene::arrangementOf(view.value, kCount, 0, 1.5, roomOf(1.5));
        for (int i = 1; i < kCount; ++i) {
            const glm::dvec3 before = made.positionAt(scene::sliceParameter(i - 1, kCount));
            EXPECT_GT(glm::distance(made.positionAt(scene::sliceParameter(i, kCount)), before), made.sliceRadius)
                << view.name;
        }
    }
}

TEST(SliceArrangement, hasNoNegativeZeroInPositions) {
    for (const scene::ViewTableRow& view : scene::kViews) {
        const scene::SliceArrangement made = scene::arrangementOf(view.value, 21, 0.05, 1.5, roomOf(1.5));
        for (const double u : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
            const glm::dvec3 position = made.positionAt(u);
            for (int i = 0; i < 3; ++i)
                EXPECT_FALSE(position[i] == 0 && std::signbit(position[i])) << view.name << ", " << u << ", " << i;
        }
    }
}

TEST(SliceArrangement, ofAColumnIsARowTurnedByAQuarter) {
    constexpr double kBallRadius = 0.05;
    for (const int count : {3, 21, 201}) {
        for (const double aspect : {0.25, 0.5625, 1.0, 1.5}) {
            SCOPED_TRACE(testing::Message() << count << ", " << aspect);
            const scene::SliceArrangement row =
                scene::arrangementOf(scene::View::strip, count, kBallRadius, 1 / aspect, roomOf(1 / aspect));
            const scene::SliceArrangement column =
                scene::arrangementOf(scene::View::column, count, kBallRadius, aspect, roomOf(aspect));
            for (const double u : {-1.0, -0.25, 0.0, 1.0})
                EXPECT_EQ(column.positionAt(u), glm::dvec3(0, row.positionAt(u).x, 0)) << u;
            EXPECT_GT(column.positionAt(1).y, 0) << "the largest w is at the top";
            EXPECT_EQ(column.distance, row.distance);
            EXPECT_EQ(column.maxDistanceFromFocus(), row.maxDistanceFromFocus());
            const auto above = scene::placeProjectionBeside(scene::View::strip, row, count, 1 / aspect);
            const auto aside = scene::placeProjectionBeside(scene::View::column, column, count, aspect);
            EXPECT_TRUE(aside.shown);
            EXPECT_EQ(aside.radius, above.radius);
            EXPECT_EQ(aside.position, glm::dvec3(-above.position.y, 0, 0));
        }
    }
}

TEST(SliceArrangement, ofTwoSlicesHasTheProjectionBesideThem) {
    for (const scene::ViewTableRow& view : scene::kViews) {
        if (!view.showsAllSlices) continue;
        for (const double aspect : {0.5625, 1.0, 16.0 / 9}) {
            SCOPED_TRACE(testing::Message() << view.name << ", " << aspect);
            const scene::SliceArrangement made =
                scene::arrangementOf(view.value, 2, 0.05, aspect, roomOf(aspect, true));
            const auto placement = scene::placeProjectionBeside(view.value, made, 2, aspect);
            ASSERT_TRUE(placement.shown);
            EXPECT_GT(placement.radius, 0.25 * made.reach);
            for (const double u : {-1.0, 1.0})
                EXPECT_GT(glm::distance(placement.position, made.positionAt(u)), placement.radius + made.reach);
        }
    }
}

TEST(SliceArrangement, ofAGridIsReadFromLeftToRightAndFromTopToBottom) {
    constexpr double kBallRadius = 0.05;
    for (const int count : {2, 3, 10, 21, 61, 201}) {
        for (const double aspect : {0.25, 0.5625, 1.0, 16.0 / 9, 4.0}) {
            SCOPED_TRACE(testing::Message() << count << ", " << aspect);
            const scene::SliceArrangement made =
                scene::arrangementOf(scene::View::grid, count, kBallRadius, aspect, roomOf(aspect));
            const auto positionOf = [&](int i) { return made.positionAt(scene::sliceParameter(i, count)); };
            ASSERT_GE(made.grid.columns, 1);
            EXPECT_EQ(positionOf((count - 1) / 2), glm::dvec3(0)) << "the focus slice";
            for (int i = 1; i < count; ++i) {
                const glm::dvec3 before = positionOf(i - 1), here = positionOf(i);
                EXPECT_LE(glm::length(here), made.maxDistanceFromFocus()) << i;
                EXPECT_EQ(here.z, 0) << i;
                if (i % made.grid.columns > 0) {
                    EXPECT_GT(here.x, before.x + 2 * made.reach) << i;
                    EXPECT_EQ(here.y, before.y) << i;
                } else {
                    EXPECT_EQ(here.x, positionOf(0).x) << i;
                    EXPECT_LT(here.y, before.y - 2 * made.reach) << i;
                }
            }
        }
    }
}

TEST(SliceArrangement, ofAGridHasMoreColumnsInAWiderRoom) {
    int before = 0;
    for (const double aspect : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        const int columns = scene::arrangementOf(scene::View::grid, 41, 0, aspect, roomOf(aspect)).grid.columns;
        EXPECT_GT(columns, before) << aspect;
        before = columns;
    }
}

TEST(SliceArrangement, ofAGridHasTheProjectionBesideItAtTheLeftOrAbove) {
    for (const int count : {2, 21, 201}) {
        for (const double aspect : {0.5625, 1.0, 16.0 / 9, 4.0}) {
            SCOPED_TRACE(testing::Message() << count << ", " << aspect);
            const scene::SliceArrangement made =
                scene::arrangementOf(scene::View::grid, count, 0.05, aspect, roomOf(aspect, true));
            const auto placement = scene::placeProjectionBeside(scene::View::grid, made, count, aspect);
            ASSERT_TRUE(placement.shown);
            const glm::dvec3 first = made.positionAt(-1);
            if (aspect > 1.5) {
                EXPECT_LT(placement.position.x + placement.radius, first.x - made.reach);
            } else {
                EXPECT_GT(placement.position.y - placement.radius, first.y + made.reach);
            }
        }
    }
}

}  // namespace
