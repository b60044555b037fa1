// Tests of the contours of a field in the matrix of planar sections.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fields/formula_field.hpp"
#include "scene/composer.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using slicing::PlanarContours;

slicing::Object fieldOf(const std::string& formula) {
    auto field = fields::fieldFromFormula("formula", formula, {glm::dvec4(-1.6), glm::dvec4(1.6)});
    EXPECT_TRUE(field) << field.error().message;
    return std::make_shared<const fields::Field>(*std::move(field));
}

/// Composes pictures of the matrix of a field.
struct MatrixPictures {
    slicing::Object object = fieldOf("sqrt(x^2+y^2+z^2+w^2)");
    slicing::SliceSet slices;
    scene::Composer composer;
    scene::Scene scene;
    scene::Look look;

    MatrixPictures() {
        look.view = scene::View::matrix;
        look.field.levels = {1, 1.5};
    }

    const slicing::MatrixContours& contours(slicing::Quality quality = slicing::Quality::full,
                                            scene::Viewport viewport = {}, const geometry::Rotation& orientation = {}) {
        slicing::Slicer().sliceWithoutSurfaces(object, orientation, {-10, 21, 0.1}, slices);
        composer.compose(object, orientation, slices, 0, look, viewport, scene, quality);
        return scene.sectionMatrix.contours;
    }
};

void expectCircles(const PlanarContours& contours, const std::vector<double>& radii) {
    ASSERT_EQ(contours.lineCount(), radii.size());
    for (std::size_t i = 0; i < radii.size(); ++i) {
        EXPECT_EQ(contours.level[i], i);
        for (const glm::dvec2& p : contours.line(i)) EXPECT_NEAR(glm::length(p), radii[i], 0.02);
    }
}

TEST(MatrixContours, FollowTheLevelsThePointAndTheObject) {
    MatrixPictures pictures;
    for (const PlanarContours& contours : pictures.contours()) expectCircles(contours, {1, 1.5});
    pictures.look.field.levels = {0.7};
    for (const PlanarContours& contours : pictures.contours()) expectCircles(contours, {0.7});
    pictures.look.field.levels = {1, 1.5};
    pictures.look.focusPoint = {0, 0, 0.6};  // the focus point is not at the center in the planes xy, xw and yw
    expectCircles(pictures.contours()[0], {0.8, std::sqrt(2.25 - 0.36)});
    pictures.look.focusPoint = {0, 0, 0};
    pictures.object = fieldOf("2*sqrt(x^2+y^2+z^2+w^2)");
    for (const PlanarContours& contours : pictures.contours()) expectCircles(contours, {0.5, 0.75});
    pictures.object = fieldOf("sqrt(4*x^2+y^2+z^2+w^2)");
    const auto farthestW = [](const PlanarContours& inZw) {
        double most = 0;
        for (const glm::dvec2& p : inZw.line(0)) most = std::max(most, p.y);
        return most;
    };
    EXPECT_NEAR(farthestW(pictures.contours()[5]), 1, 0.02);
    const double angle = 0.5;  // a turn of the direction of w toward that of x, along which the ellipsoid is shorter
    const geometry::Rotation turn(geometry::RotationAngles{geometry::Plane::xw, angle});
    EXPECT_NEAR(farthestW(pictures.contours(slicing::Quality::full, {}, turn)[5]),
                1 / std::sqrt(std::pow(std::cos(angle), 2) + 4 * std::pow(std::sin(angle), 2)), 0.02);
}

TEST(MatrixContours, AreThereOnlyForFieldsWhoseSurfacesAreShown) {
    MatrixPictures pictures;
    EXPECT_GT(pictures.contours()[0].lineCount(), 0U);
    pictures.look.parts.faces = false;
    for (const PlanarContours& contours : pictures.contours()) EXPECT_TRUE(contours.points.empty());
    pictures.look.parts.faces = true;
    EXPECT_GT(pictures.contours()[0].lineCount(), 0U);
    pictures.object = support::objectOf(support::named("24-cell"));
    for (const PlanarContours& contours : pictures.contours()) EXPECT_TRUE(contours.points.empty());
}

TEST(MatrixContours, HaveTheColorsOfTheirLevels) {
    MatrixPictures pictures;
    pictures.contours();
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(pictures.scene.surfaces.contourColor(i), scene::levelColor(i, 2));
    pictures.look.coloring = scene::Coloring::w;
    pictures.contours();
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(pictures.scene.surfaces.contourColor(i), scene::plainColor());
}

TEST(MatrixContours, AreFinerInLargerPanelsAndCoarserInDrafts) {
    MatrixPictures pictures;
    const auto points = [&](slicing::Quality quality, scene::Viewport viewport) {
        return pictures.contours(quality, viewport)[0].points.size();
    };
    const std::size_t usual = points(slicing::Quality::full, {1280, 720});
    EXPECT_LT(points(slicing::Quality::draft, {1280, 720}), usual);
    EXPECT_EQ(points(slicing::Quality::full, {1280, 720}), usual);
    EXPECT_GT(points(slicing::Quality::full, {2560, 1440}), usual);
    EXPECT_GT(points(slicing::Quality::file, {1280, 720}), usual);
}

}  // namespace
