// Tests that the projection of the whole object covers no slice, wherever the viewer moves the camera.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "fields/formula_field.hpp"
#include "slicing/slicer.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

/// Returns two renderers: one that draws without OpenGL where possible, and one that draws with OpenGL.
std::vector<std::unique_ptr<Renderer>> bothRenderers() {
    std::vector<std::unique_ptr<Renderer>> made;
    for (const ShapeBackend backend : {ShapeBackend::fastest, ShapeBackend::open_gl})
        made.push_back(std::make_unique<Renderer>(defaultFontPath(), backend));
    return made;
}

/// Counts the pixels at which a picture shows both an opaque part of a slice and a part of the projection.
struct Overlap {
    std::size_t pixels = 0;
    /// How many of the pixels counted in `pixels` differ from the picture without the projection.
    std::size_t changed = 0;
};

/// Adds the overlap in the picture of a scene to `out`. The scene must have a transparent background.
void addOverlap(scene::Scene& scene, Renderer& renderer, Overlap& out) {
    image::Image both, slices, projection;
    renderer.draw(scene, both);
    scene.projectionPlacement.shown = false;
    renderer.draw(scene, slices);
    scene.projectionPlacement.shown = true;
    const std::vector<scene::SlicePlacement> placements = scene.placements;
    for (scene::SlicePlacement& placement : scene.placements) placement.drawn = false;
    renderer.draw(scene, projection);
    scene.placements = placements;
    for (std::size_t i = 0; i < both.pixels.size(); i += 4) {
        if (slices.pixels[i + 3] < 255 || projection.pixels[i + 3] < 64) continue;
        ++out.pixels;
        int most = 0;
        for (std::size_t k = i; k < i + 3; ++k) most = std::max(most, std::abs(both.pixels[k] - slices.pixels[k]));
        out.changed += most > 8 ? 1 : 0;
    }
}

scene::Look randomLook(std::mt19937& random) {
    const auto between = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    scene::Look look;
    look.orbit = {between(-1.5, 1.5), between(-1, 1), between(0.3, 1.5)};
    look.projection.kind = scene::ProjectionKind::perspective;
    look.projection.eye = between(1.1, 4);
    look.parts.coordinates = false;
    look.parts.projectionFaces = random() % 2 == 0;
    look.background = scene::Background::transparent;
    return look;
}

constexpr std::array<scene::Viewport, 2> kShapes{{{240, 135}, {120, 214}}};

void expectUncovered(const Overlap& overlap) {
    EXPECT_GT(overlap.pixels, 100U) << "the projection extends behind the slices";
    EXPECT_EQ(overlap.changed, 0U);
}

class ProjectionBehindSlices : public testing::TestWithParam<const char*> {};

TEST_P(ProjectionBehindSlices, CoversNoPolytopesSlices) {
    std::mt19937 random(71);
    const auto renderers = bothRenderers();
    std::vector<Overlap> overlaps(renderers.size());
    for (const scene::ViewTableRow& view : scene::kViews) {
        // The matrix is like View::single, but its panels cover the slice and the projection.
        if (view.value == scene::View::matrix) continue;
        for (const scene::Viewport viewport : kShapes) {
            scene::Look look = randomLook(random);
            look.view = view.value;
            Subject subject(GetParam(), randomRotation(static_cast<unsigned>(random())), 11, look, viewport);
            subject.slicesOnly();
            subject.scene.faceOpacity = 1;
            for (std::size_t i = 0; i < renderers.size(); ++i) addOverlap(subject.scene, *renderers[i], overlaps[i]);
        }
    }
    for (const Overlap& overlap : overlaps) expectUncovered(overlap);
}

// The 24-cell has convex slices. The slices of the star are drawn with a depth buffer.
INSTANTIATE_TEST_SUITE_P(Pictures, ProjectionBehindSlices, testing::Values("24-cell", "small stellated 120-cell"));

TEST(ProjectionBehindSlicesOfFields, CoversNoSurfaces) {
    std::mt19937 random(72);
    const auto renderers = bothRenderers();
    std::vector<Overlap> overlaps(renderers.size());
    auto field = fields::fieldFromFormula("test", "x^2 + y^2 + z^2 + w^2");
    ASSERT_TRUE(field);
    const slicing::Object object = std::make_shared<const fields::Field>(std::move(*field));
    const geometry::Hyperplanes planes{-3, 7, 0.4};
    constexpr int kCameras = 24;
    for (int camera = 0; camera < kCameras; ++camera) {
        for (const scene::Viewport viewport : kShapes) {
            const bool fog = camera % 2 == 1;
            scene::Look look = randomLook(random);
            look.view = camera % 4 < 2 ? scene::View::strip : scene::View::oval;
            look.field.levels = {6};
            if (fog) look.field.fog = {{.value = 0, .opacity = 0.3}, {.value = 6, .opacity = 0}};
            scene::Scene scene;
            scene::Composer composer;
            slicing::SurfaceDetail detail;
            composer.layOutAndChooseDetail(object, planes, 0, look, viewport, slicing::Quality::draft, scene, detail);
            slicing::SliceSet slices;
            slicing::Slicer().slice(object, {}, planes, look.field, detail, slices);
            composer.compose(object, {}, slices, 0, look, viewport, scene, slicing::Quality::draft);
            scene.axes.length = 0;
            for (scene::SlicePlacement& placement : scene.placements) placement.label.clear();
            for (std::size_t i = 0; i < renderers.size(); ++i) addOverlap(scene, *renderers[i], overlaps[i]);
        }
    }
    for (const Overlap& overlap : overlaps) expectUncovered(overlap);
}

}  // namespace
}  // namespace oval4d::render
