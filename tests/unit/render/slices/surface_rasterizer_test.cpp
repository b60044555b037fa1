// Tests of surfaces drawn into memory without OpenGL: they are compared with those that OpenGL draws, and with
// mathematics.

#include "render/slices/surface_rasterizer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "fields/formula_field.hpp"
#include "parallel/fork_join.hpp"
#include "render/slices/shape_rasterizer.hpp"
#include "slicing/slicer.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

struct SurfaceExample {
    const char* name;
    scene::Look look;
    scene::Viewport viewport;
    double unequal = 0;  ///< the part of the pixels that may differ by more than the antialiasing of an edge
    int slices = 11;
};

std::ostream& operator<<(std::ostream& out, const SurfaceExample& example) { return out << example.name; }

/// The slices of a field, and their scene. The regions inside the levels have holes, and reach the boundary of the
/// domain.
struct FieldSubject {
    slicing::SliceSet slices;
    scene::Scene scene;  // the scene refers to `slices`

    FieldSubject(const SurfaceExample& example, unsigned seed) {
        auto field = fields::fieldFromFormula("test", "sin(3*x)*cos(2*y) + (z^2 - w^2)/4", fields::kFormulaBox, "x+y");
        const slicing::Object object = std::make_shared<const fields::Field>(std::move(*field));
        const geometry::Rotation orientation = randomRotation(seed);
        const int half = example.slices / 2;
        const geometry::Hyperplanes planes{-half, example.slices, 2.0 / std::max(half, 1)};
        scene::Composer composer;
        slicing::SurfaceDetail detail;
        composer.layOutAndChooseDetail(object, planes, 0, example.look, example.viewport, slicing::Quality::full, scene,
                                       detail);
        slicing::Slicer().slice(object, orientation, planes, example.look.field, detail, slices);
        composer.compose(object, orientation, slices, 0, example.look, example.viewport, scene);
    }
    FieldSubject(const FieldSubject&) = delete;
    FieldSubject& operator=(const FieldSubject&) = delete;

    image::Image draw(Renderer& renderer) const {
        image::Image image;
        renderer.draw(scene, image);
        return image;
    }
};

class SurfacesInMemory : public testing::TestWithParam<SurfaceExample> {
  protected:
    void SetUp() override {
        if (!ShapeRasterizer::isSupported()) GTEST_SKIP() << "this processor lacks AVX2 or FMA";
    }
};

TEST_P(SurfacesInMemory, LookLikeThoseOfOpenGl) {
    const SurfaceExample& example = GetParam();
    const FieldSubject subject(example, 41);
    Renderer inMemory, withOpenGl(defaultFontPath(), ShapeBackend::open_gl);
    const image::Image one = subject.draw(inMemory), other = subject.draw(withOpenGl);
    ASSERT_EQ(one.pixels.size(), other.pixels.size());
    int unequal = 0, covered = 0;
    double sum = 0;
    for (int y = 0; y < one.height; ++y) {
        for (int x = 0; x < one.width; ++x) {
            const int d = difference(pixelAt(one, x, y), pixelAt(other, x, y));
            sum += d;
            unequal += d > 32 ? 1 : 0;
            covered += pixelAt(other, x, y) == rgbOf(scene::style().background) ? 0 : 1;
        }
    }
    const double pixels = static_cast<double>(one.width) * one.height;
    EXPECT_GT(covered / pixels, 0.01);
    EXPECT_LE(unequal / pixels, example.unequal + 3e-4);
    EXPECT_LT(sum / pixels, 0.3 + 60 * example.unequal);
    for (std::size_t i = 3; i < one.pixels.size(); i += 4) ASSERT_EQ(one.pixels[i], 255) << "opacity at byte " << i;
}

TEST_P(SurfacesInMemory, AreTheSameWithTwoThreads) {
    const SurfaceExample& example = GetParam();
    const FieldSubject subject(example, 42);
    parallel::ForkJoin forkJoin;
    Renderer one, two(defaultFontPath(), ShapeBackend::fastest, &forkJoin);
    const image::Image expected = subject.draw(one);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(subject.draw(two).pixels, expected.pixels);
}

constexpr scene::ShownParts kOnlySurfaces{.bars = false, .balls = false};
constexpr auto kBelow = fields::BodySide::below;

scene::Look lookOf(const scene::ShownParts& parts, std::vector<double> levels, scene::Look look = {}) {
    look.parts = parts;
    look.field = {.levels = std::move(levels), .inside = kBelow};
    return look;
}

// The pictures may differ at the edges of bars. With OpenGL, the edge of a bar hides translucent surfaces behind it,
// even in pixels of which the bar covers less than half.
INSTANTIATE_TEST_SUITE_P(
    All, SurfacesInMemory,
    testing::Values(
        SurfaceExample{"opaque", lookOf(kOnlySurfaces, {0}), {640, 360}},
        SurfaceExample{"three", lookOf(kOnlySurfaces, {-0.4, 0, 0.4}), {640, 360}},
        SurfaceExample{"open",
                       lookOf(kOnlySurfaces, {0}, {.parts = {}, .orbit = {}, .caps = scene::SurfaceCapStyle::open}),
                       {640, 360}},
        SurfaceExample{"caps",
                       lookOf(kOnlySurfaces, {0}, {.parts = {}, .orbit = {}, .caps = scene::SurfaceCapStyle::value}),
                       {640, 360}},
        SurfaceExample{"growth",
                       lookOf(kOnlySurfaces, {0}, {.parts = {}, .orbit = {}, .coloring = scene::Coloring::growth}),
                       {640, 360}},
        SurfaceExample{
            "value",
            lookOf(kOnlySurfaces, {-0.4, 0.4}, {.parts = {}, .orbit = {}, .coloring = scene::Coloring::value}),
            {640, 360}},
        SurfaceExample{"box", lookOf({}, {0}), {640, 360}, 2e-3},
        SurfaceExample{"box and levels", lookOf({}, {-0.4, 0, 0.4}), {640, 360}, 0.01},
        SurfaceExample{
            "single", lookOf(kOnlySurfaces, {0}, {.view = scene::View::single, .parts = {}, .orbit = {}}), {640, 360}},
        SurfaceExample{
            "near",
            lookOf(kOnlySurfaces, {-0.4, 0, 0.4}, {.view = scene::View::single, .parts = {}, .orbit = {0.4, 0.3, 1.5}}),
            {640, 360}},
        SurfaceExample{
            "projection",
            lookOf({}, {0}, {.parts = {}, .orbit = {}, .projection = {.kind = scene::ProjectionKind::orthogonal}}),
            {640, 360},
            0.01},
        SurfaceExample{"small", lookOf(kOnlySurfaces, {-0.4, 0, 0.4}), {131, 97}, 1e-3},
        SurfaceExample{"narrow", lookOf(kOnlySurfaces, {-0.4, 0, 0.4}), {9, 300}, 2e-3},
        SurfaceExample{"low", lookOf(kOnlySurfaces, {0}), {301, 11}, 2e-3},
        SurfaceExample{"one", lookOf(kOnlySurfaces, {0}), {33, 1}, 0.04, 1}));

/// Triangles in a picture of 201 × 201 pixels. The eye is at z = 10 and looks along −z at the middle of the picture.
class Triangles : public testing::Test {
  protected:
    static constexpr int kSize = HandMade::kSize;
    static constexpr scene::Color kRed = 0xff0000, kBlue = 0x0000ff;

    void SetUp() override {
        if (!ShapeRasterizer::isSupported()) GTEST_SKIP() << "this processor lacks AVX2 or FMA";
        picture.scene.needsDepthBuffer = true;
        picture.slices.vertices.clear();
        surface = &picture.slices.surfaces.emplace_back();
    }

    /// Adds a level, to which the triangles that are added next belong. A level with an opacity below 1 is translucent.
    void addLevel(scene::Color color, double opacity) {
        picture.scene.surfaces.levels.push_back({picture.scene.surfaces.levels.size(), color, opacity, false});
    }
    std::uint32_t addPoint(const glm::vec3& at) {
        surface->points.push_back(at);
        surface->normals.emplace_back(0, 0, 1);
        surface->growth.push_back(0);
        surface->values.push_back(0);
        return static_cast<std::uint32_t>(surface->points.size() - 1);
    }
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        surface->triangles.push_back({a, b, c});
        surface->levelAndCap.push_back(static_cast<std::uint8_t>(picture.scene.surfaces.levels.size() - 1));
    }
    void addTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const std::uint32_t first = addPoint(a);
        addTriangle(first, addPoint(b), addPoint(c));
    }

    image::Image draw() const {
        constexpr std::size_t kBytes = std::size_t{4} * kSize * kSize, kGuard = 4096;
        constexpr std::uint8_t kUntouched = 0xa5;
        std::vector<std::uint8_t> memory(kBytes + 2 * kGuard, kUntouched);
        const std::span<std::uint8_t> pixels = std::span(memory).subspan(kGuard, kBytes);
        Renderer renderer;
        renderer.draw(picture.scene, pixels);
        for (std::size_t i = 0; i < kGuard; ++i) {
            EXPECT_EQ(memory[i], kUntouched);
            EXPECT_EQ(memory[kGuard + kBytes + i], kUntouched);
        }
        return {kSize, kSize, {pixels.begin(), pixels.end()}};
    }

    /// Returns the point at this distance from the eye that is projected to the center of the pixel (x, y).
    static glm::vec3 pointAt(double x, double y, double distance) {
        const double scale = distance / 10 / HandMade::kUnit;
        return {(x + 0.5 - kSize / 2.0) * scale, (y + 0.5 - kSize / 2.0) * scale, 10 - distance};
    }

    HandMade picture{{}};
    slicing::SliceSurface* surface = nullptr;
};

// Triangles that share edges cover each pixel once, even if some corners are at centers of pixels.
TEST_F(Triangles, ThatShareEdgesCoverEachPixelOnce) {
    addLevel(kRed, 0.4);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-1.4, 1.4);
    constexpr int kStep = 4, kCount = 42;
    const auto number = [](int row, int column) { return static_cast<std::uint32_t>(row * kCount + column); };
    for (int row = 0; row < kCount; ++row) {
        for (int column = 0; column < kCount; ++column) {
            const bool isMoved = (row + column) % 3 != 0;
            addPoint(pointAt(15 + kStep * column + (isMoved ? jitter(random) : 0),
                             15 + kStep * row + (isMoved ? jitter(random) : 0), 10));
        }
    }
    for (int row = 0; row + 1 < kCount; ++row) {
        for (int column = 0; column + 1 < kCount; ++column) {
            const std::uint32_t a = number(row, column), b = number(row, column + 1), c = number(row + 1, column),
                                d = number(row + 1, column + 1);
            addTriangle(a, b, random() % 2 == 0 ? d : c);
            if (surface->triangles.back()[2] == d) {
                addTriangle(a, d, c);
            } else {
                addTriangle(b, d, c);
            }
        }
    }
    const image::Image image = draw();
    const Rgb expected = pixelAt(image, kSize / 2, kSize / 2);
    EXPECT_GT(expected[0], 60);
    int wrong = 0;
    for (int y = 17; y < 177; ++y)
        for (int x = 17; x < 177; ++x) wrong += difference(pixelAt(image, x, y), expected) > 1 ? 1 : 0;
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(pixelAt(image, 5, 100), rgbOf(scene::style().background));
}

// Thin triangles cover each pixel once. The triangles of a fan around a point are all thin, and many contain no center
// of a pixel.
TEST_F(Triangles, ThatAreThinCoverEachPixelOnce) {
    addLevel(kRed, 0.4);
    constexpr int kCount = 3000;
    const std::uint32_t middle = addPoint(pointAt(100.3, 100.2, 10));
    for (int i = 0; i < kCount; ++i) {
        const double angle = 6.283185307179586 * i / kCount;
        addPoint(pointAt(100.3 + 90 * std::cos(angle), 100.2 + 90 * std::sin(angle), 10));
    }
    for (std::uint32_t i = 0; i < kCount; ++i) addTriangle(middle, 1 + i, 1 + (i + 1) % kCount);
    const image::Image image = draw();
    const Rgb inside = pixelAt(image, 60, 60), outside = rgbOf(scene::style().background);
    int wrong = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double distance = std::hypot(x - 100.3, y - 100.2);
            if (std::abs(distance - 90) < 0.1) continue;
            wrong += difference(pixelAt(image, x, y), distance < 90 ? inside : outside) > 1 ? 1 : 0;
        }
    }
    EXPECT_EQ(wrong, 0);
}

TEST_F(Triangles, IntersectWhereTheyHaveTheSameDepth) {
    // Two large triangles: one at the distance 10 from the eye, and one in the plane z = x.
    addLevel(kRed, 1);
    addTriangle({-5, -5, 0}, {5, -5, 0}, {0, 8, 0});
    addLevel(kBlue, 1);
    addTriangle({-5, -5, -5}, {5, -5, 5}, {0, 8, 0});
    const image::Image image = draw();
    for (int y = 5; y < kSize; y += 10) {
        for (int x = 5; x < kSize; x += 5) {
            const Rgb color = pixelAt(image, x, y);
            if (x == kSize / 2) continue;
            EXPECT_EQ(color[2] > color[0], x > kSize / 2) << x << ' ' << y;
        }
    }
}

TEST_F(Triangles, AreHiddenBehindOpaqueOnesAndSeenThroughTranslucentOnes) {
    addLevel(kRed, 1);
    addTriangle(pointAt(20, 20, 10), pointAt(180, 20, 10), pointAt(100, 180, 10));
    addLevel(kBlue, 0.5);
    addTriangle(pointAt(20, 20, 11), pointAt(180, 20, 11), pointAt(20, 180, 11));
    addTriangle(pointAt(20, 20, 9), pointAt(180, 20, 9), pointAt(180, 180, 9));
    const image::Image image = draw();
    const Rgb both = pixelAt(image, 140, 40), onlyRed = pixelAt(image, 60, 90), onlyBlue = pixelAt(image, 24, 140);
    EXPECT_GT(both[2], 60);
    EXPECT_GT(both[0], 60);
    EXPECT_EQ(onlyRed[1], onlyRed[2]) << "blue is hidden";
    EXPECT_GT(onlyBlue[2], onlyBlue[0]);
}

// Triangles are cut off behind the eye. Of a plane that extends from in front of the eye to behind it, the part with a
// positive clip coordinate w is drawn.
TEST_F(Triangles, AreCutOffBehindTheEye) {
    addLevel(kRed, 1);
    // The plane y = −1 below the eye, from z = −40 to z = 30. The eye is at z = 10.
    addTriangle({-500, -1, -40}, {500, -1, -40}, {0, -1, 30});
    const image::Image image = draw();
    // The ray through the pixel meets the plane at the distance d: 1 / d = −(y of the pixel) / (10 · unit).
    for (int y = 2; y < kSize; y += 3) {
        const double slope = -(y + 0.5 - kSize / 2.0) / HandMade::kUnit / 10;
        const double distance = slope > 0 ? 1 / slope : INFINITY;
        if (std::abs(distance - 50) < 5) continue;
        const Rgb color = pixelAt(image, kSize / 2, y);
        EXPECT_EQ(color[0] > 60, distance < 50) << y;
    }
}

TEST_F(Triangles, ThatAreNotFiniteDrawNothingOutsideThePicture) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = std::numeric_limits<float>::max(),
                infinity = std::numeric_limits<float>::infinity();
    for (const double opacity : {1.0, 0.5}) {
        addLevel(kRed, opacity);
        for (const float odd : {nan, huge, -huge, infinity, -infinity, 1e9F, -1e9F, 10.0F, 9.9999F}) {
            addTriangle({odd, 0, 0}, {1, 0, 0}, {0, 1, 0});
            addTriangle({0, odd, 0}, {1, 0, 0}, {0, 1, 0});
            addTriangle({0, 0, odd}, {1, 0, 0}, {0, 1, 0});
            addTriangle({odd, odd, 0}, {-1, odd, 0}, {0, 1, odd});
            addTriangle({odd, odd, odd}, {odd, 0, odd}, {0, odd, 0});
        }
        addTriangle(0, 0, 0);
        addTriangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0});
    }
    draw();
}

}  // namespace
}  // namespace oval4d::render
