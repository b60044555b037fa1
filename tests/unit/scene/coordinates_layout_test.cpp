#include <cstddef>

#include <gtest/gtest.h>

#include "polytopes/catalogue/catalogue.hpp"
#include "unit/scene/composed_scene.hpp"

namespace {

using namespace oval4d;
using scene::composed;
using scene::Scene;

TEST(Coordinates, holdEveryVertexInsideTheViewport) {
    for (const auto& entry : polytopes::catalogue().first(6)) {
        const Scene s = composed(entry.name);
        const auto& c = s.coordinates;
        EXPECT_GE(std::size_t(c.rows) * c.perRow, entry.vertices);
        EXPECT_GE(c.left, 0);
        EXPECT_EQ(c.isDensityStrip, entry.vertices > scene::kMaxVerticesAsLines);
        EXPECT_LE(c.left + c.columnStep * c.perRow, 1280.0 / 720 + 1e-9);
        EXPECT_LE(c.left + 3 * c.lineStep + c.lineWidth, 1280.0 / 720);
        EXPECT_LE(c.isDensityStrip ? 0 : 4 * c.lineStep, c.columnStep);
        EXPECT_GT(c.lineWidth * 720, 0.7) << entry.name;  // lines must be at least about one pixel wide
        EXPECT_GE(c.zero - c.amplitude - (c.rows - 1) * c.rowStep, 0);
        EXPECT_LT(c.zero + c.amplitude, 0.3);
    }
    EXPECT_TRUE(composed("5-cell").coordinates.named);
}

TEST(Coordinates, stayWithinWindowsThatAreHardlyWiderThanTheirMargins) {
    for (const scene::Viewport viewport : {scene::Viewport{16, 200}, {16, 8192}, {100, 1250}}) {
        for (const char* name : {"5-cell", "24-cell", "120-cell"}) {
            const auto layout = composed(name, 21, viewport).coordinates;
            const double aspect = double(viewport.width) / viewport.height;
            EXPECT_GE(layout.rows, 1);
            EXPECT_LE(layout.rows, 6);
            EXPECT_GE(layout.lineStep, 0) << name;
            if (layout.isDensityStrip) continue;
            EXPECT_GT(layout.columnStep, 0) << name;
            EXPECT_LE(layout.columnStep * layout.perRow, aspect * (1 + 1e-9)) << name;
        }
    }
}

}  // namespace
