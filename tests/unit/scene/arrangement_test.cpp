// The views: their table, and how each of them arranges the slices.

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

}  // namespace
