// Tests of shapes drawn into memory without OpenGL: they are compared with those that OpenGL draws, and with each
// other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <ostream>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "parallel/fork_join.hpp"
#include "render/slices/shape_rasterizer.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

using scene::ProjectionKind;

struct Example {
    const char* name;
    const char* polytope;
    scene::Look look;
    scene::Viewport viewport{640, 360};
    double unequal = 0;  ///< the part of the pixels that may differ by more than the antialiasing of an edge
};

std::ostream& operator<<(std::ostream& out, const Example& example) { return out << example.name; }

constexpr scene::ShownParts kOnlyFaces{.faces = true, .bars = false, .balls = false};
constexpr scene::ShownParts kSections{.projectionFaces = true, .allSections = true};

class ShapesInMemory : public testing::TestWithParam<Example> {
  protected:
    void SetUp() override {
        if (!ShapeRasterizer::isSupported()) GTEST_SKIP() << "this processor lacks AVX2 or FMA";
    }
};

TEST_P(ShapesInMemory, LookLikeThoseOfOpenGl) {
    const Example& example = GetParam();
    const Subject subject(example.polytope, randomRotation(31), 21, example.look, example.viewport);
    Renderer inMemory, withOpenGl(defaultFontPath(), ShapeBackend::open_gl);
    const image::Image one = subject.draw(inMemory), other = subject.draw(withOpenGl);
    ASSERT_EQ(one.pixels.size(), other.pixels.size());
    int unequal = 0;
    double sum = 0;
    for (int y = 0; y < one.height; ++y) {
        for (int x = 0; x < one.width; ++x) {
            const int d = difference(pixelAt(one, x, y), pixelAt(other, x, y));
            sum += d;
            unequal += d > 32 ? 1 : 0;
        }
    }
    const double pixels = static_cast<double>(one.width) * one.height;
    EXPECT_LE(unequal / pixels, example.unequal + 3e-4);
    EXPECT_LT(sum / pixels, 0.3 + 40 * example.unequal);
    for (std::size_t i = 3; i < one.pixels.size(); i += 4) ASSERT_EQ(one.pixels[i], 255) << "opacity at byte " << i;
}

TEST_P(ShapesInMemory, AreTheSameWithTwoThreads) {
    const Example& example = GetParam();
    const Subject subject(example.polytope, randomRotation(32), 21, example.look, example.viewport);
    parallel::ForkJoin forkJoin;
    Renderer one, two(defaultFontPath(), ShapeBackend::fastest, &forkJoin);
    const image::Image expected = subject.draw(one);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(subject.draw(two).pixels, expected.pixels);
}

// The pictures may differ at the edges of the projection. There, OpenGL lets the edge of a shape hide what is behind
// it, even in pixels of which the shape covers less than half.
INSTANTIATE_TEST_SUITE_P(
    All, ShapesInMemory,
    testing::Values(
        Example{"few", "8-cell", {}}, Example{"many", "600-cell", {}},
        Example{"faces", "24-cell", {.parts = kOnlyFaces, .orbit = {}}},
        Example{
            "near", "16-cell", {.view = scene::View::single, .parts = {}, .orbit = {0.4, 0.3, 1.5}}, {640, 360}, 1e-3},
        Example{"narrow", "24-cell", {}, {9, 300}, 2e-3},
        Example{"projection",
                "8-cell",
                {.parts = {}, .orbit = {}, .projection = {.kind = ProjectionKind::perspective}},
                {640, 360},
                0.02},
        Example{"sections",
                "24-cell",
                {.parts = kSections, .orbit = {}, .projection = {.kind = ProjectionKind::orthogonal}},
                {640, 360},
                0.04},
        Example{"bands_behind_coordinates",
                "24-cell",
                {.view = scene::View::single,
                 .parts = {},
                 .orbit = {},
                 .highlight = slicing::Element{slicing::ElementKind::cell, 1}}},
        Example{"lines_over_a_density",
                "120-cell",
                {.view = scene::View::single,
                 .parts = {},
                 .orbit = {},
                 .highlight = slicing::Element{slicing::ElementKind::cell, 1}},
                {640, 360},
                2e-3},
        Example{"crossing", "great stellated 120-cell", {}, {640, 360}, 0.02},
        Example{"crossing_faces", "grand 600-cell", {.parts = kOnlyFaces, .orbit = {}}, {640, 360}, 1e-3},
        Example{"crossing_and_projection",
                "small stellated 120-cell",
                {.parts = {}, .orbit = {}, .projection = {.kind = ProjectionKind::perspective}},
                {640, 360},
                0.04}));

/// A picture of 64 × 64 pixels whose center is a common corner of four pixels. A unit at the distance 10 is 32 pixels.
class Depths : public testing::Test {
  protected:
    static constexpr int kSize = 64;
    static constexpr scene::Color kRed = 0xff0000, kBlue = 0x0000ff;

    void SetUp() override {
        if (!ShapeRasterizer::isSupported()) GTEST_SKIP() << "this processor lacks AVX2 or FMA";
        for (ShapeBatch* shapes : {&solid, &translucent}) {
            shapes->begin(scene::style());
            shapes->setProjection({kSize, kSize, 10, 10, 0, 0});
        }
    }

    Rgb drawnAt(int x, int y) {
        constexpr std::size_t kBytes = kSize * kSize * 4, kGuard = 4096;
        constexpr std::uint8_t kUntouched = 0xa5;
        std::vector<std::uint8_t> memory(kBytes + 2 * kGuard, kUntouched);
        const std::span<std::uint8_t> pixels = std::span(memory).subspan(kGuard, kBytes);
        rasterizer.begin({kSize, kSize}, scene::style(), pixels);
        rasterizer.setDepthArea({{0, 0}, {kSize, kSize}});
        rasterizer.add(solid, ShapeRasterizer::DepthUse::written);
        rasterizer.add(translucent, ShapeRasterizer::DepthUse::tested);
        rasterizer.drawAdded(nullptr);
        for (std::size_t i = 0; i < kGuard; ++i) {
            EXPECT_EQ(memory[i], kUntouched);
            EXPECT_EQ(memory[kGuard + kBytes + i], kUntouched);
        }
        return pixelAt({kSize, kSize, {pixels.begin(), pixels.end()}}, x, y);
    }

    ShapeRasterizer rasterizer;
    ShapeBatch solid, translucent;
};

TEST_F(Depths, NearerShapesHideFartherOnesThatAreDrawnLater) {
    solid.addBall({0, 0, -9}, 0.3F, kRed);
    solid.addBall({0, 0, -10}, 0.6F, kBlue);
    EXPECT_GT(drawnAt(32, 32)[0], 100);
    EXPECT_LT(drawnAt(32, 32)[2], drawnAt(32, 32)[0]);
    EXPECT_GT(drawnAt(32, 32 + 15)[2], 80) << "beside the smaller ball";
    EXPECT_EQ(drawnAt(32, 32 + 15)[0], drawnAt(32, 32 - 16)[0]) << "no edge of the smaller ball is left";
}

TEST_F(Depths, WhatIsFartherShowsThroughTheRestOfThePixelsAtAnEdge) {
    // A face with slanted, soft edges, and behind it a face with the same color, which is drawn later and fills the
    // picture. Where the nearer face covers the part c of a pixel, at most c (1 − c) ≤ 1/4 of the background may remain
    // visible.
    solid.addFace(
        std::vector<glm::vec3>{{-0.5F, -0.6F, -10}, {0.6F, -0.5F, -10}, {0.5F, 0.6F, -10}, {-0.6F, 0.5F, -10}},
        {0, 0, 1}, kBlue, 1, true);
    translucent.addFace(std::vector<glm::vec3>{{-2, -2, -11}, {2, -2, -11}, {2, 2, -11}, {-2, 2, -11}}, {0, 0, 1},
                        kBlue, 1, false);
    const int face = drawnAt(0, 0)[2];
    EXPECT_EQ(drawnAt(32, 32)[2], face);
    for (int x = 20; x < 44; ++x)
        for (int y = 8; y < 20; ++y) EXPECT_GT(drawnAt(x, y)[2], 0.74 * face) << "at (" << x << ", " << y << ")";
}

TEST_F(Depths, HideNothingWhereTheyHaveBeenCleared) {
    solid.addFace(std::vector<glm::vec3>{{-2, -2, -9}, {2, -2, -9}, {2, 2, -9}, {-2, 2, -9}}, {0, 0, 1}, kRed, 1,
                  false);
    translucent.addFace(std::vector<glm::vec3>{{-2, -2, -11}, {2, -2, -11}, {2, 2, -11}, {-2, 2, -11}}, {0, 0, 1},
                        kBlue, 1, false);
    image::Image picture{kSize, kSize, std::vector<std::uint8_t>(kSize * kSize * 4)};
    rasterizer.begin({kSize, kSize}, scene::style(), picture.pixels);
    rasterizer.setDepthArea({{0, 0}, {kSize, kSize}});
    rasterizer.add(solid, ShapeRasterizer::DepthUse::written);
    rasterizer.addDepthClearing({{-5, 10}, {kSize / 2, kSize + 5}});
    rasterizer.add(translucent, ShapeRasterizer::DepthUse::tested);
    rasterizer.drawAdded(nullptr);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const Rgb color = pixelAt(picture, x, y);
            EXPECT_EQ(color[2] > color[0], x < kSize / 2 && y >= 10) << x << ", " << y;
        }
    }
}

TEST_F(Depths, PointsThatAreNotFiniteDrawNothingOutsideThePicture) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = std::numeric_limits<float>::max();
    for (const float odd : {nan, huge, -huge}) {
        for (ShapeBatch* shapes : {&solid, &translucent}) {
            shapes->addBall({odd, 0, -10}, 0.3F, kRed);
            shapes->addBall({0, odd, -10}, 0.3F, kRed);
            shapes->addBarFromFarEnd({0, odd, -10}, {odd, 0, -9}, 0.1F, kRed);
            shapes->addFace(std::vector<glm::vec3>{{0, 0, -9}, {odd, 1, -9}, {1, odd, -8}}, {0, 0, 1}, kRed, 1, true);
            shapes->addFace(std::vector<glm::vec3>{{0, 0, -9}, {1, 1, odd}, {1, -1, -8}}, {0, 0, 1}, kRed, 1, false);
            shapes->addFace(std::vector<glm::vec3>{}, {0, 0, 1}, kRed, 1, false);
        }
    }
    drawnAt(0, 0);
}

TEST_F(Depths, ABarGoesThroughABall) {
    // The front of the bar is nearer than the center of the ball, and farther than the front of the ball.
    solid.addBall({0, 0, -10}, 0.5F, kRed);
    solid.addBarFromFarEnd({-0.9F, 0, -10}, {0.9F, 0, -10}, 0.1F, kBlue);
    EXPECT_GT(drawnAt(32, 32)[0], drawnAt(32, 32)[2]) << "inside the ball";
    EXPECT_GT(drawnAt(32 + 22, 32)[2], drawnAt(32 + 22, 32)[0]) << "outside the ball";
}

TEST_F(Depths, FacesAreHiddenWhereSolidShapesAreNearer) {
    // A face that comes toward the eye from left to right passes through the plane of a bar at x = 0.
    solid.addBarFromFarEnd({-0.9F, 0, -10}, {0.9F, 0, -10}, 0.1F, kRed);
    const std::vector<glm::vec3> corners{
        {-0.9F, -0.9F, -10.9F}, {0.9F, -0.9F, -9.1F}, {0.9F, 0.9F, -9.1F}, {-0.9F, 0.9F, -10.9F}};
    translucent.addFace(corners, glm::normalize(glm::vec3(-1, 0, 1)), kBlue, 1, false);
    EXPECT_GT(drawnAt(32 - 16, 32)[0], drawnAt(32 - 16, 32)[2]) << "the bar is nearer";
    EXPECT_GT(drawnAt(32 + 16, 32)[2], drawnAt(32 + 16, 32)[0]) << "the face is nearer";
    EXPECT_GT(drawnAt(32 - 16, 32 + 16)[2], 60) << "the face beside the bar";
}

TEST_F(Depths, FacesInFrontOfAllSolidShapesLookAsWithoutDepths) {
    const auto drawn = [&](ShapeRasterizer::DepthUse depth) {
        std::vector<std::uint8_t> pixels(image::byteCount(kSize, kSize));
        rasterizer.begin({kSize, kSize}, scene::style(), pixels);
        rasterizer.setDepthArea({{0, 0}, {kSize, kSize}});
        rasterizer.add(solid, ShapeRasterizer::DepthUse::written);
        rasterizer.add(translucent, depth);
        rasterizer.drawAdded(nullptr);
        return pixels;
    };
    solid.addBall({0.3F, 0.2F, -12}, 0.4F, kRed);
    translucent.addFace(std::vector<glm::vec3>{{-0.9F, -0.8F, -10.5F}, {0.7F, -0.3F, -10}, {0.6F, 0.9F, -9.5F}},
                        {0, 0, 1}, kBlue, 0.4F, false);
    EXPECT_EQ(drawn(ShapeRasterizer::DepthUse::tested), drawn(ShapeRasterizer::DepthUse::unused));
}

TEST_F(Depths, StrokesHaveTheirColorAndWidthAndLeaveTheRestOfThePicture) {
    constexpr int kGray = 100;
    image::Image image{kSize, kSize, std::vector<std::uint8_t>(image::byteCount(kSize, kSize), kGray)};
    solid.addStroke({10, 20}, {50, 20}, 3, kRed);
    rasterizer.beginOverPicture({kSize, kSize}, scene::style(), image.pixels);
    rasterizer.add(solid, ShapeRasterizer::DepthUse::unused);
    rasterizer.drawAdded(nullptr);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double fromEdge = 1.5 - std::abs(y + 0.5 - 20);
            const double covered = x < 10 || x >= 50 ? 0 : std::clamp(fromEdge + 0.5, 0.0, 1.0);
            const int red = static_cast<int>(std::lround(kGray + covered * (255 - kGray)));
            const int other = static_cast<int>(std::lround(kGray * (1 - covered)));
            EXPECT_LE(difference(pixelAt(image, x, y), Rgb{red, other, other}), 1) << "at (" << x << ", " << y << ")";
        }
    }
}

}  // namespace
}  // namespace oval4d::render
