// Tests of the histogram of a field's values in the picture.

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "scene/composer.hpp"
#include "slicing/slicer.hpp"

namespace {

using namespace oval4d;
using slicing::CoordinateValueHistograms;

slicing::Object radialField() {
    auto field = fields::fieldFromFormula("formula", "x^2+y^2+z^2+w^2", {glm::dvec4(-1), glm::dvec4(1)});
    return std::make_shared<const fields::Field>(*std::move(field));
}

/// Composes pictures of a field, without the surfaces of the field.
struct FieldPictures {
    slicing::Object object = radialField();
    slicing::SliceSet slices;
    scene::Composer composer;
    scene::Scene scene;

    const scene::Scene& composed(const scene::Look& look, const geometry::Rotation& orientation = {},
                                 scene::Viewport viewport = {}) {
        slicing::Slicer().sliceWithoutSurfaces(object, orientation, {-10, 21, 0.1}, slices);
        composer.compose(object, orientation, slices, 0, look, viewport, scene);
        return scene;
    }
};

scene::Look lookAt(std::vector<double> levels) {
    scene::Look look;
    look.parts.faces = false;
    look.field.levels = std::move(levels);
    return look;
}

TEST(Histogram, IsShownOfFieldsUnlessItIsHidden) {
    FieldPictures pictures;
    scene::Look look = lookAt({0.5, 2});
    const scene::Scene& shown = pictures.composed(look);
    EXPECT_TRUE(shown.look.parts.coordinates);
    EXPECT_TRUE(shown.showsHistogram());
    EXPECT_FALSE(shown.showsDensityStrip());
    EXPECT_EQ(shown.plotTones.size(),
              std::size_t{CoordinateValueHistograms::kRows} * CoordinateValueHistograms::kColumns);
    const double eye = shown.camera.shiftY;
    look.parts.coordinates = false;
    EXPECT_FALSE(pictures.composed(look).showsHistogram());
    EXPECT_NE(shown.camera.shiftY, eye) << "the oval takes the room";
}

TEST(Histogram, HasALineForEachLevelInsideItsRange) {
    FieldPictures pictures;
    const scene::HistogramAxes& histogram = pictures.composed(lookAt({0.5, 2, 17, -1})).histogram;
    ASSERT_EQ(histogram.levelLines.size(), 2U);
    EXPECT_EQ(histogram.levelLines[0].value, 0.5);
    EXPECT_EQ(histogram.levelLines[0].color, scene::levelColor(0, 4));
    EXPECT_EQ(histogram.levelLines[1].color, scene::levelColor(1, 4));
    EXPECT_EQ(histogram.heightOf(histogram.least), 0);
    EXPECT_EQ(histogram.heightOf(histogram.greatest), 1);
    EXPECT_EQ(pictures.composed(lookAt({1})).histogram.levelLines.size(), 1U);
}

TEST(Histogram, SaysWhatTheValuesAndTheAxesMeasure) {
    FieldPictures pictures;
    EXPECT_EQ(pictures.composed(lookAt({1})).histogram.quantity, "");
    EXPECT_EQ(pictures.scene.axisUnits, fields::PictureUnits());
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(-1), glm::dvec4(1)};
    array.samples = fields::SampleStorage(std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
    array.units = {"m", "m", "m", "s"};
    array.quantity = {"temperature", "K"};
    pictures.object = std::make_shared<const fields::Field>(*fields::fieldFromArray("run", array));
    EXPECT_EQ(pictures.composed(lookAt({1})).histogram.quantity, "temperature, K");
    EXPECT_EQ(pictures.scene.axisUnits[0].text, "m");
    EXPECT_EQ(pictures.scene.axisUnits[3].text, "s");
    const auto focus = std::ranges::find_if(pictures.scene.placements, &scene::SlicePlacement::focus);
    ASSERT_NE(focus, pictures.scene.placements.end());
    EXPECT_TRUE(focus->label.ends_with(" s")) << focus->label;
    pictures.composed(lookAt({1}), geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, 0.5, 0.3}));
    EXPECT_EQ(pictures.scene.axisUnits[0].text, "");
}

TEST(Histogram, FollowsTheRotationAndTheObject) {
    FieldPictures pictures;
    const std::vector<std::uint8_t> straight = pictures.composed(lookAt({1})).plotTones;
    const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::xw, 0.5, 0.3});
    EXPECT_NE(pictures.composed(lookAt({1}), turn).plotTones, straight);
    EXPECT_EQ(pictures.composed(lookAt({1})).plotTones, straight);
    pictures.object = slicing::transformedTo(pictures.object, {.follow = {0.5, 0, 0}});
    EXPECT_NE(pictures.composed(lookAt({1})).plotTones, straight);
}

TEST(Histogram, StaysInsideEveryViewport) {
    FieldPictures pictures;
    for (const scene::Viewport viewport :
         {scene::Viewport{1280, 720}, {640, 640}, {375, 667}, {64, 900}, {3000, 300}}) {
        const scene::ParallelCoordinatesLayout& layout = pictures.composed(lookAt({1}), {}, viewport).coordinates;
        const double aspect = double(viewport.width) / viewport.height;
        EXPECT_GT(layout.panel, 0);
        EXPECT_GT(layout.lineStep, layout.panel);
        EXPECT_GE(layout.left, 0);
        EXPECT_LE(layout.left + 3 * layout.lineStep + layout.panel, aspect + 1e-12);
        EXPECT_GT(layout.zero, layout.amplitude);
    }
}

}  // namespace
