// Tests of pictures on every background.

#include <gtest/gtest.h>

#include <string>

#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

int alphaAt(const image::Image& image, int x, int y) {
    return image.pixels
        [(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) * 4 + 3];
}

struct GroundExample {
    const char* polytope;
    scene::Look look;
};

/// Returns scenes that together have all parts: translucent and opaque faces, the projection, parallel coordinates as
/// lines and as a density strip, and the matrix.
std::vector<GroundExample> examples() {
    using scene::ProjectionKind;
    return {{"24-cell", {.parts = {}, .orbit = {}, .projection = {.kind = ProjectionKind::perspective}}},
            {"120-cell", {.parts = {}, .orbit = {}, .coloring = scene::Coloring::w}},
            {"16-cell", {.view = scene::View::matrix, .parts = {}, .orbit = {}}},
            {"small stellated 120-cell", {.view = scene::View::single, .parts = {}, .orbit = {}}}};
}

class Backgrounds : public testing::TestWithParam<ShapeBackend> {};

TEST_P(Backgrounds, AreSeenWhereNothingIsDrawn) {
    Renderer renderer(defaultFontPath(), GetParam());
    for (const auto& [name, background] : scene::kBackgrounds) {
        SCOPED_TRACE(name);
        scene::Look look;
        look.background = background;
        Subject subject("5-cell", {}, 3, look, {64, 48});
        subject.slicesOnly();
        const image::Image image = subject.draw(renderer);
        const bool isClear = background == scene::Background::transparent;
        EXPECT_EQ(pixelAt(image, 1, 1), isClear ? Rgb{} : rgbOf(scene::style(background).background));
        EXPECT_EQ(alphaAt(image, 1, 1), isClear ? 0 : 255);
    }
}

// A transparent picture that is placed on white looks like a picture with a white background.
TEST_P(Backgrounds, ATransparentPictureOnWhiteIsTheWhiteOne) {
    Renderer renderer(defaultFontPath(), GetParam());
    for (const GroundExample& example : examples()) {
        SCOPED_TRACE(example.polytope);
        const auto drawn = [&](scene::Background background) {
            scene::Look look = example.look;
            look.background = background;
            return Subject(example.polytope, randomRotation(3), 5, look, {240, 135}).draw(renderer);
        };
        const image::Image clear = drawn(scene::Background::transparent), white = drawn(scene::Background::white);
        int empty = 0, between = 0, worst = 0;
        for (int y = 0; y < clear.height; ++y) {
            for (int x = 0; x < clear.width; ++x) {
                const int alpha = alphaAt(clear, x, y);
                ASSERT_EQ(alphaAt(white, x, y), 255);
                Rgb onWhite = pixelAt(clear, x, y);
                for (int& channel : onWhite) {
                    ASSERT_LE(channel, alpha + 1) << "colors are multiplied by alpha";
                    channel += 255 - alpha;
                }
                worst = std::max(worst, difference(onWhite, pixelAt(white, x, y)));
                empty += alpha == 0 ? 1 : 0;
                between += alpha > 0 && alpha < 255 ? 1 : 0;
            }
        }
        EXPECT_LE(worst, 8) << "each layer is rounded to a whole number";
        EXPECT_GT(empty, clear.width * clear.height / 10);
        EXPECT_GT(between, 100) << "edges and translucent faces";
    }
}

INSTANTIATE_TEST_SUITE_P(Drawing, Backgrounds, testing::Values(ShapeBackend::fastest, ShapeBackend::open_gl));

}  // namespace
}  // namespace oval4d::render
