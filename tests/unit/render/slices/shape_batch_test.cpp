// Tests of single balls, bars and faces: their pixels are compared with values computed from geometry and light.

#include <gtest/gtest.h>

#include <algorithm>

#include <glm/geometric.hpp>

#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

constexpr int kMiddle = HandMade::kSize / 2;
constexpr double kPi = 3.14159265358979323846;

/// Returns the color of a lit surface with this normal, in camera coordinates.
Rgb litColor(scene::Color color, const glm::dvec3& normal) {
    const scene::PictureStyle& style = scene::style();
    const glm::dvec3 half = glm::normalize(style.light + glm::dvec3(0, 0, 1));
    const double diffuse = style.ambient + style.diffuse * std::max(glm::dot(normal, style.light), 0.0);
    const double highlight = style.specular * std::pow(std::max(glm::dot(normal, half), 0.0), style.shininess);
    Rgb rgb = rgbOf(color);
    for (int& channel : rgb)
        channel = static_cast<int>(std::lround(std::clamp(channel * diffuse + 255 * highlight, 0.0, 255.0)));
    return rgb;
}

/// Returns the area that a color covers, in pixels: the sum of the coverages, computed from one channel.
double area(const image::Image& image, int channelOfInterest, int full) {
    const auto c = static_cast<std::size_t>(channelOfInterest);
    const double background = rgbOf(scene::style().background)[c];
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += (pixelAt(image, x, y)[c] - background) / (full - background);
    return sum;
}

class Shapes : public testing::Test {
  protected:
    static Renderer& renderer() {
        static Renderer instance;
        return instance;
    }
};

TEST_F(Shapes, BallIsALitSphere) {
    const image::Image image = HandMade({glm::dvec3(0)}).draw(renderer());
    const double radius = 0.5 * HandMade::kUnit * 10 / std::sqrt(100 - 0.25);
    for (const glm::dvec2 uv : {glm::dvec2(0, 0), {0.5, 0}, {-0.5, 0.5}, {0, -0.7}, {-0.3, 0.6}, {0.6, 0.6}}) {
        const int x = kMiddle + static_cast<int>(std::lround(uv.x * radius));
        const int y = kMiddle + static_cast<int>(std::lround(uv.y * radius));
        const double u = (x - kMiddle) / radius, v = (y - kMiddle) / radius;
        const Rgb expected = litColor(scene::style().ball, {u, v, std::sqrt(1 - u * u - v * v)});
        EXPECT_LE(difference(pixelAt(image, x, y), expected), 3) << uv.x << ", " << uv.y;
    }
    const Rgb background = rgbOf(scene::style().background);
    for (const int step : {-1, 1}) {
        const int outside = kMiddle + step * static_cast<int>(std::ceil(radius + 1));
        EXPECT_EQ(pixelAt(image, outside, kMiddle), background);
        EXPECT_EQ(pixelAt(image, kMiddle, outside), background);
    }
}

TEST_F(Shapes, BallKeepsItsSilhouetteUnderPerspective) {
    // Away from the optical axis, the perspective image of a sphere is an ellipse that is longer in the radial
    // direction.
    HandMade hand({glm::dvec3(4, 0, 0)});
    hand.scene.camera.fieldOfView = 2 * std::atan(0.5);  // ±5 units are visible at the distance 10
    const image::Image image = hand.draw(renderer());
    const double pixels = HandMade::kSize / 10.0;
    const double angle = std::atan2(4.0, 10.0), half = std::asin(0.5 / std::hypot(4.0, 10.0));
    const double inner = kMiddle + 0.5 + 10 * std::tan(angle - half) * pixels;
    const double outer = kMiddle + 0.5 + 10 * std::tan(angle + half) * pixels;
    const Rgb background = rgbOf(scene::style().background);
    int first = -1, last = -1;
    for (int x = 0; x < image.width; ++x)
        if (difference(pixelAt(image, x, kMiddle), background) > 60) {
            if (first < 0) first = x;
            last = x;
        }
    EXPECT_NEAR(first, inner, 1.0);
    EXPECT_NEAR(last + 1, outer, 1.0);
}

TEST_F(Shapes, BallSendsAsMuchLightAtEverySize) {
    // The total brightness that a ball adds is its area times its mean color, even if the ball is smaller than a pixel.
    constexpr int kSteps = 200, kGreen = 1;
    const int background = rgbOf(scene::style().background)[kGreen];
    double mean = 0;
    int samples = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double u = (2 * i + 1.0) / kSteps - 1, v = (2 * k + 1.0) / kSteps - 1, q = 1 - u * u - v * v;
            if (q < 0) continue;
            mean += litColor(scene::style().ball, {u, v, std::sqrt(q)})[kGreen] - background;
            ++samples;
        }
    mean /= samples;
    for (const double radius : {0.004, 0.008, 0.02, 0.04, 0.1, 0.3, 0.7}) {
        HandMade hand({glm::dvec3(0.003, 0.002, 0)});
        hand.scene.ballRadius = radius;
        const double r = radius * HandMade::kUnit * 10 / std::sqrt(100 - radius * radius);
        const double light = area(hand.draw(renderer()), kGreen, background + 1);
        EXPECT_NEAR(light / (kPi * r * r * mean), 1, r < 1 ? 0.25 : 0.08) << r << " pixels";
    }
}

TEST_F(Shapes, BarIsALitCylinderOfItsWidth) {
    HandMade hand({{-0.8, 0, 0}, {0.8, 0, 0}});
    hand.addEdge(0, 1);
    hand.scene.look.parts.balls = false;
    const image::Image image = hand.draw(renderer());
    const double radius = 0.1 * HandMade::kUnit;
    for (int y = kMiddle - 8; y <= kMiddle + 8; ++y) {
        const double v = (y - kMiddle) / radius;
        const Rgb expected = litColor(scene::style().bar, {0, v, std::sqrt(1 - v * v)});
        EXPECT_LE(difference(pixelAt(image, kMiddle, y), expected), 3) << y;
    }
    const Rgb background = rgbOf(scene::style().background);
    EXPECT_EQ(pixelAt(image, kMiddle, kMiddle + 12), background);
    EXPECT_EQ(pixelAt(image, kMiddle, kMiddle - 12), background);
}

TEST_F(Shapes, ThinBarFadesInsteadOfBreakingUp) {
    HandMade hand({{-0.9, -0.31, 0}, {0.9, 0.43, 0}});
    hand.addEdge(0, 1);
    hand.scene.look.parts.balls = false;
    hand.scene.barRadius = 0.001;  // the bar is a fifth of a pixel wide
    const image::Image image = hand.draw(renderer());
    const Rgb background = rgbOf(scene::style().background);
    for (int x = kMiddle - 60; x <= kMiddle + 60; ++x) {
        int brightest = 0;
        for (int y = 0; y < image.height; ++y)
            brightest = std::max(brightest, difference(pixelAt(image, x, y), background));
        EXPECT_GT(brightest, 3) << "a gap in column " << x;
        EXPECT_LT(brightest, 90) << "too strong in column " << x;
    }
}

TEST_F(Shapes, FaceIsTintedAndLitAlikeFromBothSides) {
    const scene::PictureStyle& style = scene::style();
    std::vector<image::Image> images;
    for (const bool turned : {false, true}) {
        HandMade hand({{-0.8, -0.8, 0}, {0.8, -0.8, 0}, {0.8, 0.8, 0}, {-0.8, 0.8, 0}});
        hand.addEdge(0, 1);
        hand.addFace(turned ? std::vector<std::uint32_t>{3, 2, 1, 0} : std::vector<std::uint32_t>{0, 1, 2, 3}, 0);
        hand.scene.look.parts.balls = hand.scene.look.parts.bars = false;
        images.push_back(hand.draw(renderer()));
    }
    for (int i = 0; i < HandMade::kSize; ++i)
        EXPECT_LE(difference(pixelAt(images[0], i, kMiddle + 10), pixelAt(images[1], i, kMiddle + 10)), 2) << i;
    const double lit = style.ambient + style.diffuse * std::abs(style.light.z);
    for (std::size_t c = 0; c < 3; ++c) {
        const double expected =
            rgbOf(0x4080c0)[c] * lit * style.faceOpacity + rgbOf(style.background)[c] * (1 - style.faceOpacity);
        EXPECT_NEAR(pixelAt(images[0], kMiddle, kMiddle)[c], expected, 2);
    }
    const int full = pixelAt(images[0], kMiddle, kMiddle)[2];
    EXPECT_NEAR(area(images[0], 2, full), 160 * 160, 40) << "soft edges keep the area";
}

TEST_F(Shapes, FaceInTheHyperplaneTakesItsFirstCellsColor) {
    HandMade hand({{-0.8, -0.8, 0}, {0.8, -0.8, 0}, {0.8, 0.8, 0}});
    hand.addEdge(0, 1);
    // The 2-face 1 is shared by the cells 1 and 2 of three cells. Its source number (see SliceSet) follows those of the
    // cells.
    polytopes::Polytope polytope;
    for (const std::vector<std::uint32_t>& cell : {std::vector<std::uint32_t>{0}, {0, 1}, {1}})
        polytope.cells.add(cell);
    for (int i = 0; i < 2; ++i) polytope.faces.add(std::vector<std::uint32_t>{0, 1, 2});
    hand.addFace({0, 1, 2}, 3 + 1);
    polytope.faceCells = {{0, 1}, {1, 2}};
    hand.scene.faceCells = {slicing::coloringCell(support::objectOf(polytope), hand.scene.visibilities, 3 + 1)};
    hand.scene.cellColors = {0xff0000, 0x00ff00, 0x0000ff};
    hand.scene.look.parts.balls = hand.scene.look.parts.bars = false;
    const Rgb pixel = pixelAt(hand.draw(renderer()), kMiddle + 30, kMiddle - 30);
    EXPECT_GT(pixel[1], pixel[0] + 40);
    EXPECT_GT(pixel[1], pixel[2] + 40);
}

}  // namespace
}  // namespace oval4d::render
