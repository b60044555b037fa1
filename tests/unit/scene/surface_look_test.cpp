#include "scene/surface_look.hpp"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "fields/formula_field.hpp"
#include "scene/composer.hpp"
#include "slicing/object.hpp"

namespace oval4d::scene {
namespace {

TEST(ValueColorScale, DivergesAtZeroIfItIsInTheMiddle) {
    const ValueColorScale even = valueColorScaleFor({-1, 3});
    EXPECT_EQ(even, (ValueColorScale{-3, 3, true}));
    EXPECT_EQ(even.colorOf(0), divergingColor(0));
    EXPECT_EQ(even.colorOf(3), divergingColor(1));
    EXPECT_EQ(even.colorOf(-1.5), divergingColor(-0.5));
    const ValueColorScale positive = valueColorScaleFor({0, 3});
    EXPECT_EQ(positive, (ValueColorScale{0, 3, false}));
    EXPECT_EQ(positive.colorOf(3), sequentialColor(1));
    EXPECT_EQ(valueColorScaleFor({-0.1, 3}), (ValueColorScale{-0.1, 3, false}));
    EXPECT_EQ(valueColorScaleFor({-3, -1}), (ValueColorScale{-3, -1, false}));
    EXPECT_EQ(positive.colorOf(std::numeric_limits<double>::quiet_NaN()), noValueColor());
    EXPECT_EQ(valueColorScaleFor({2, 2}).colorOf(2), sequentialColor(0.5)) << "a constant";
}

int lightness(Color color) { return static_cast<int>((color >> 16U & 255U) + (color >> 8U & 255U) + (color & 255U)); }

TEST(ValueColorScale, TheSequentialScaleBecomesLighter) {
    int last = lightness(sequentialColor(0));
    for (int i = 1; i <= 8; ++i) {
        const int next = lightness(sequentialColor(i / 8.0));
        EXPECT_GT(next, last) << i;
        last = next;
    }
    EXPECT_EQ(sequentialColor(-5), sequentialColor(0));
    EXPECT_EQ(sequentialColor(5), sequentialColor(1));
}

TEST(SurfaceLook, CapsFollowTheirSetting) {
    const auto field = fields::fieldFromFormula("test", "x^2 - 1", fields::kFormulaBox, "y");
    ASSERT_TRUE(field);
    Look look;
    SurfaceLook out;
    const geometry::Hyperplanes planes{0, 1, 1, 0};
    chooseSurfaceLook(*field, look, planes, out);
    EXPECT_TRUE(out.levels.back().caps);
    EXPECT_FALSE(out.colorsPoints() || out.colorsCapPoints());
    look.caps = SurfaceCapStyle::open;
    look.coloring = Coloring::value;
    chooseSurfaceLook(*field, look, planes, out);
    EXPECT_FALSE(out.levels.back().caps);
    EXPECT_TRUE(out.colorsPoints());
    EXPECT_EQ(out.scale, (ValueColorScale{-2, 2, true}));
    slicing::SliceSurface surface;
    surface.values = {0, 0};
    surface.secondValues = {-1, 2};
    EXPECT_EQ(out.pointColor(surface, 0), divergingColor(-0.5));
    EXPECT_EQ(out.pointColor(surface, 1), divergingColor(1));
    look.caps = SurfaceCapStyle::value;
    look.coloring = Coloring::cell;
    chooseSurfaceLook(*field, look, planes, out);
    EXPECT_TRUE(out.levels.back().caps && out.colorsCapPoints() && !out.colorsPoints());
    EXPECT_EQ(out.capPointColor(surface, 1), divergingColor(1));
}

TEST(SurfaceDetail, PicturesInFullQualityAreNoCoarserThanMessages) {
    const slicing::Object field =
        std::make_shared<const fields::Field>(*fields::fieldFromFormula("ball", "x^2+y^2+z^2+w^2 < 1"));
    const geometry::Hyperplanes planes{-10, 21, 0.2};
    for (const Viewport viewport : {Viewport{320, 200}, {1280, 720}}) {
        Composer composer;
        Scene scene;
        slicing::SurfaceDetail pictures, messages;
        composer.layOutAndChooseDetail(field, planes, 0, {}, viewport, slicing::Quality::full, scene, pictures);
        slicing::setUniformDetail(slicing::infoOf(field).circumradius, planes, slicing::Quality::full, messages);
        ASSERT_EQ(pictures.steps.size(), messages.steps.size());
        for (std::size_t i = 0; i < pictures.steps.size(); ++i) EXPECT_LE(pictures.steps[i], messages.steps[i]);
    }
}

}  // namespace
}  // namespace oval4d::scene
