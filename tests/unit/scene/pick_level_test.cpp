// Tests of picking a point of a field's surfaces at a pixel of a picture.

#include "scene/pick_level.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string_view>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "fields/formula_field.hpp"
#include "scene/composer.hpp"
#include "slicing/field_sample.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::scene {
namespace {

constexpr Viewport kViewport{1280, 720};
constexpr std::string_view kBall = "x^2+y^2+z^2+w^2";

// A picture of a field, and what it shows at a pixel.
struct FieldPicture {
    std::shared_ptr<const fields::Field> field;
    geometry::Rotation orientation;
    slicing::SliceSet slices;
    Composer composer;
    Scene scene;

    FieldPicture(std::string_view formula, const Look& look, const geometry::Rotation& turn, const fields::Box& box,
                 int focus = 0)
        : field(std::make_shared<const fields::Field>(*fields::fieldFromFormula("test", formula, box))),
          orientation(turn) {
        const slicing::Object object = field;
        slicing::Slicer().sliceWithoutSurfaces(object, turn, {-10, 21, field->circumradius / 15}, slices);
        composer.compose(object, turn, slices, focus, look, kViewport, scene, slicing::Quality::full,
                         ScenePurpose::pointing);
    }

    std::optional<PickedLevel> at(glm::dvec2 pixel) {
        return pickLevel(scene, *field, orientation, pixel, pickElement(scene, field, pixel));
    }
    // Returns the pixel at which the point p of a slice is drawn, counted from the upper left corner.
    glm::dvec2 pixelOf(std::size_t slice, const glm::dvec3& p) const {
        return pixelOfWorld(scene.placements[slice].position + scene.scale * p);
    }
    glm::dvec2 pixelOfWorld(const glm::dvec3& world) const {
        const double aspect = double(kViewport.width) / kViewport.height;
        const glm::dvec4 clip = scene.camera.projection(aspect) * scene.camera.view() * glm::dvec4(world, 1);
        return {(clip.x / clip.w + 1) / 2 * kViewport.width, (1 - clip.y / clip.w) / 2 * kViewport.height};
    }
    glm::dvec4 placeOf(const PickedLevel& hit) const {
        return slicing::sampleField(*field, orientation, hit.point).place;
    }
};

const fields::Box kBox{glm::dvec4(-1), glm::dvec4(1)};

TEST(PickLevel, FindsTheNearestPointOfTheOuterLevelOnTheRay) {
    std::mt19937 random(12);
    Look look;
    look.field.levels = {0.3, 0.6};
    look.parts.balls = look.parts.bars = false;
    for (int round = 0; round < 3; ++round) {
        FieldPicture picture(kBall, look, support::randomRotation(random), kBox);
        int found = 0;
        for (int x = 20; x < kViewport.width; x += 40) {
            for (int y = 20; y < kViewport.height; y += 40) {
                const auto hit = picture.at({x, y});
                if (!hit) continue;
                ++found;
                EXPECT_EQ(hit->level, 1U) << "it encloses the other level";
                EXPECT_FALSE(hit->cap);
                EXPECT_EQ(hit->in, PickLocation::slice);
                EXPECT_NEAR(glm::dot(hit->point, hit->point), 0.6, 1e-5);
                EXPECT_EQ(hit->point.w, picture.scene.placements[hit->slice].w);
                const glm::dvec2 pixel = picture.pixelOf(hit->slice, glm::dvec3(hit->point));
                EXPECT_LT(glm::distance(pixel, glm::dvec2(x, y)), 1e-3);
                const glm::dvec3 center = picture.scene.placements[hit->slice].position;
                const glm::dvec3 outward = glm::dvec3(hit->point);
                const glm::dvec3 toEye = picture.scene.camera.eye - (center + picture.scene.scale * outward);
                EXPECT_GT(glm::dot(outward, toEye), 0) << "the front of the ball";
            }
        }
        EXPECT_GT(found, 20);
    }
}

TEST(PickLevel, FindsTheSilhouettesOfTheBalls) {
    Look look;
    look.view = View::single;
    look.field.levels = {0.36};
    look.parts.balls = look.parts.bars = false;
    FieldPicture picture(kBall, look, {}, kBox);
    const glm::dvec3 eye = picture.scene.camera.eye;
    // The distance of the eye from the focus slice, which is at the origin, in units of the object.
    const double distance = glm::length(eye) / picture.scene.scale;
    const glm::dvec3 toEye = glm::normalize(eye), side = glm::normalize(glm::cross(toEye, glm::dvec3(0, 1, 0)));
    // The tangents from the eye touch the ball in a circle: at the distance `along` from the center of the ball toward
    // the eye, with the radius `across`.
    const double radius = 0.6, along = radius * radius / distance, across = std::sqrt(radius * radius - along * along);
    for (const double sign : {-1.0, 1.0}) {
        EXPECT_TRUE(picture.at(picture.pixelOf(10, along * toEye + sign * 0.99 * across * side)));
        EXPECT_FALSE(picture.at(picture.pixelOf(10, along * toEye + sign * 1.01 * across * side)));
    }
}

TEST(PickLevel, FindsCapsIfTheyAreDrawn) {
    Look look;
    look.view = View::single;
    look.parts.balls = look.parts.bars = false;
    for (const auto inside : {fields::BodySide::below, fields::BodySide::above}) {
        for (const SurfaceCapStyle caps : {SurfaceCapStyle::plain, SurfaceCapStyle::open}) {
            look.field.levels = {0};
            look.field.inside = inside;
            look.caps = caps;
            FieldPicture picture("x", look, {}, kBox);
            const double x = inside == fields::BodySide::below ? -0.5 : 0.5;
            const auto hit = picture.at(picture.pixelOf(10, {x, 0.1, 1}));
            if (caps == SurfaceCapStyle::open) {
                EXPECT_TRUE(!hit || !hit->cap);
                continue;
            }
            ASSERT_TRUE(hit);
            EXPECT_TRUE(hit->cap);
            const glm::dvec4 place = picture.placeOf(*hit);
            EXPECT_NEAR(place.z, 1, 1e-6) << "on the front of the box";
            EXPECT_NEAR(place.x, x, 1e-6);
        }
    }
}

TEST(PickLevel, FindsTheEndOfWhereTheFunctionHasNoValue) {
    Look look;
    look.view = View::single;
    look.parts.balls = look.parts.bars = false;
    look.field.levels = {5};
    // The field is less than 5 everywhere outside a ball, in which it has no value.
    FieldPicture picture("sqrt(x^2+y^2+z^2+w^2-0.25)", look, {}, kBox);
    look.field.levels = {0.1};
    // The field is less than 0.1 in the outer shell of a ball.
    FieldPicture shell("sqrt(0.25-x^2-y^2-z^2-w^2)", look, {}, kBox);
    const auto cap = shell.at(shell.pixelOf(10, glm::dvec3(0)));
    ASSERT_TRUE(cap);
    EXPECT_TRUE(cap->cap) << "the body ends where the function does";
    EXPECT_NEAR(glm::length(shell.placeOf(*cap)), 0.5, 1e-4);
    const auto wall = picture.at(picture.pixelOf(10, glm::dvec3(0)));
    ASSERT_TRUE(wall);
    EXPECT_TRUE(wall->cap);
    EXPECT_NEAR(picture.placeOf(*wall).z, 1, 1e-6);
}

TEST(PickLevel, FindsTheSurfaceOfTheFocusSliceInTheProjection) {
    std::mt19937 random(14);
    Look look;
    look.view = View::single;
    look.projection.kind = ProjectionKind::perspective;
    look.field.levels = {0.9};
    look.parts.balls = look.parts.bars = false;
    const int focus = 5;
    FieldPicture picture(kBall, look, support::randomRotation(random), kBox, focus);
    const Scene& scene = picture.scene;
    ASSERT_TRUE(scene.projectionPlacement.shown && scene.projection.focusSurface);
    const double scale = scene.projection.focusSurface->scale;
    EXPECT_GT(scale, 1.1 * scene.projection.scale) << "the slice is nearer to the 4-D eye than the middle";
    const std::size_t slice = 10 + focus;
    const double w = scene.placements[slice].w, radius = std::sqrt(0.9 - w * w);
    const glm::dvec3 center = scene.projectionPlacement.position;
    const double distance = glm::distance(scene.camera.eye, center) / scale;
    const glm::dvec3 toEye = glm::normalize(scene.camera.eye - center);
    const glm::dvec3 side = glm::normalize(glm::cross(toEye, glm::dvec3(0, 1, 0)));
    const auto at = [&](const glm::dvec3& p) { return picture.at(picture.pixelOfWorld(center + scale * p)); };
    const auto hit = at(radius * toEye);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->in, PickLocation::projection);
    EXPECT_EQ(hit->slice, slice);
    EXPECT_FALSE(hit->cap);
    EXPECT_LT(glm::distance(hit->point, glm::dvec4(radius * toEye, w)), 1e-4);
    const double along = radius * radius / distance, across = std::sqrt(radius * radius - along * along);
    for (const double sign : {-1.0, 1.0}) {
        EXPECT_TRUE(at(along * toEye + sign * 0.99 * across * side));
        EXPECT_FALSE(at(along * toEye + sign * 1.01 * across * side));
    }
}

TEST(PickLevel, FindsTheSurfacesOfSlicesBeforeThatOfTheProjection) {
    std::size_t both = 0, onlyProjection = 0;
    for (const double azimuth : {-1.1, 0.8, 1.1, 1.4}) {
        Look look;
        look.view = View::single;
        look.orbit.azimuth = azimuth;
        look.orbit.elevation = 0.2;
        look.projection.kind = ProjectionKind::orthogonal;
        look.field.levels = {2.5};
        look.parts.balls = look.parts.bars = look.parts.coordinates = false;
        FieldPicture picture(kBall, look, {}, kBox);
        Scene& scene = picture.scene;
        for (int y = 20; y < kViewport.height; y += 40) {
            for (int x = 20; x < kViewport.width; x += 40) {
                const glm::dvec2 pixel(x, y);
                const auto found = picture.at(pixel);
                scene.projectionPlacement.shown = false;
                const auto inSlice = picture.at(pixel);
                scene.projectionPlacement.shown = true;
                if (!inSlice) {
                    onlyProjection += found ? 1 : 0;
                    continue;
                }
                ASSERT_TRUE(found);
                EXPECT_EQ(found->in, PickLocation::slice);
                EXPECT_EQ(found->slice, inSlice->slice);
                EXPECT_EQ(found->point, inSlice->point);
                // If the slice is moved behind the eye, the projection is found.
                scene.placements[10].position = 11.0 * scene.camera.eye;
                const auto alone = picture.at(pixel);
                both += alone && alone->in == PickLocation::projection ? 1 : 0;
                scene.placements[10].position = glm::dvec3(0);
            }
        }
    }
    EXPECT_GT(both, 10U) << "the slice covers a part of the projection";
    EXPECT_GT(onlyProjection, 10U);
}

TEST(PickLevel, LeavesWhatIsInFrontOfTheSurface) {
    Look look;
    look.view = View::single;
    look.field.levels = {1.5};
    FieldPicture picture(kBall, look, {}, kBox);
    const auto& s = picture.slices;
    int bars = 0;
    for (std::uint32_t e = s.edgeBegin[10]; e < s.edgeBegin[11]; ++e) {
        const glm::dvec3 a = s.vertices[s.vertexBegin[10] + s.edges[e][0]];
        const glm::dvec3 b = s.vertices[s.vertexBegin[10] + s.edges[e][1]];
        const glm::dvec2 pixel = picture.pixelOf(10, 0.9 * a + 0.1 * b);
        const auto hit = picture.at(pixel);
        const auto element = pickElement(picture.scene, picture.field, pixel);
        ASSERT_TRUE(element);
        EXPECT_GT(element->depth, 0);
        if (!hit) ++bars;
    }
    EXPECT_GE(bars, 3) << "the bars at the front";
    EXPECT_LT(bars, 12) << "the bars at the back";
    EXPECT_TRUE(picture.at(picture.pixelOf(10, glm::dvec3(0))));
}

TEST(PickLevel, FindsContoursInThePanelsOfTheMatrix) {
    std::mt19937 random(13);
    Look look;
    look.view = View::matrix;
    look.field.levels = {0.16, 0.64};
    look.focusPoint = {0.1, -0.2, 0.05};
    FieldPicture picture(kBall, look, support::randomRotation(random), kBox);
    const Scene& scene = picture.scene;
    const glm::dvec4 point = scene.sectionMatrix.point;
    const double pixels = scene.matrix.panelScale(scene.circumradius) * kViewport.height;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            if (row == column) continue;
            const double square = glm::dot(point, point) - point[row] * point[row] - point[column] * point[column];
            for (const std::size_t level : {0U, 1U}) {
                const double radius = std::sqrt(look.field.levels[level] - square);
                const auto pixelAt = [&](double right, double up) {
                    const glm::dvec2 center = scene.matrix.center(row, column) * double(kViewport.height);
                    return glm::dvec2(center.x + pixels * right, kViewport.height - center.y - pixels * up);
                };
                const auto hit = picture.at(pixelAt(0.6 * radius, 0.8 * radius));
                ASSERT_TRUE(hit) << row << ", " << column;
                EXPECT_EQ(hit->level, level);
                EXPECT_EQ(hit->in, PickLocation::matrix);
                EXPECT_NEAR(glm::dot(hit->point, hit->point), look.field.levels[level], 0.01);
                glm::dvec4 expected = point;
                expected[column] = 0.6 * radius;
                expected[row] = 0.8 * radius;
                EXPECT_LT(glm::distance(hit->point, expected), 0.02);
                EXPECT_FALSE(picture.at(pixelAt(0.6 * radius + 8 / pixels, 0.8 * radius)));
            }
        }
    }
}

}  // namespace
}  // namespace oval4d::scene
