#include "render/slices/fog_painter.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

constexpr std::uint32_t kRed = 0xe03020;

/// A picture of a cube of fog from −1 to 1 in the middle of the picture, cut off at z = ±depth. The values of the fog
/// are those of a callable with three coordinates.
struct FogPicture : HandMade {
    template <typename Values>
    FogPicture(double depth, double step, Values valueAt) : HandMade({}) {
        slicing::SliceFog& fog = slices.fogs.emplace_back();
        fog.size = slicing::fogLatticeSize(glm::dvec3(-1), glm::dvec3(1), step);
        fog.min = step * glm::floor(glm::dvec3(-1) / step);
        fog.step = step;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 normal(0);
            normal[axis] = 1;
            for (const double side : {1.0, -1.0}) fog.walls.push_back({side * normal, axis == 2 ? depth : 0.8});
        }
        for (glm::ivec3 p(0); p.z < fog.size.z; ++p.z)
            for (p.y = 0; p.y < fog.size.y; ++p.y)
                for (p.x = 0; p.x < fog.size.x; ++p.x)
                    fog.values.push_back(static_cast<std::uint8_t>(valueAt(fog.min + step * glm::dvec3(p))));
        scene.needsDepthBuffer = true;
        slices.vertices.clear();
    }

    void setOpacity(double opacity) {
        scene::makeFogTable(std::vector<slicing::FogControlPoint>{{0, opacity, kRed}, {1, opacity, kRed}}, scene.fog);
    }
};

const auto kConstant = [](const glm::dvec3&) { return 100; };

Renderer& renderer() {
    static Renderer instance;
    return instance;
}

Rgb centerOf(const FogPicture& picture) {
    return pixelAt(picture.draw(renderer()), HandMade::kSize / 2, HandMade::kSize / 2);
}

/// Returns the color of the background behind a layer of red fog with this opacity.
Rgb blended(double opacity) {
    Rgb mixed = rgbOf(kRed);
    const Rgb background = rgbOf(scene::style().background);
    for (std::size_t i = 0; i < 3; ++i)
        mixed[i] = static_cast<int>(std::lround(opacity * mixed[i] + (1 - opacity) * background[i]));
    return mixed;
}

TEST(FogPainter, AbsorptionGrowsExponentiallyWithTheLength) {
    for (const double opacity : {0.0, 0.1, 0.5, 0.9}) {
        for (const double depth : {0.05, 0.3, 0.75}) {
            FogPicture picture(depth, 0.1, kConstant);
            picture.setOpacity(opacity);
            for (const double circumradius : {1.0, 2.5}) {
                picture.scene.circumradius = circumradius;
                const double expected = 1 - std::pow(1 - opacity, 2 * depth / circumradius);
                EXPECT_LE(difference(centerOf(picture), blended(expected)), 2) << opacity << ' ' << depth;
            }
        }
    }
}

TEST(FogPainter, LooksTheSameInAnyUnitOfLength) {
    const Rgb expected = blended(1 - std::pow(0.4, 2 * 0.3));
    for (const double unit : {1e-25, 1e-3, 1.0, 1e6, 1e25}) {
        FogPicture picture(0.3, 0.1, kConstant);
        picture.setOpacity(0.6);
        slicing::SliceFog& fog = picture.slices.fogs[0];
        fog.min *= unit;
        fog.step *= unit;
        for (slicing::FieldSection::HalfSpace& wall : fog.walls) wall.offset *= unit;
        picture.scene.circumradius = unit;
        picture.scene.scale = 1 / unit;
        EXPECT_LE(difference(centerOf(picture), expected), 2) << unit;
    }
}

TEST(FogPainter, AnOpacityOfOneLetsAlmostNothingThrough) {
    FogPicture picture(0.5, 0.1, kConstant);
    picture.setOpacity(1);
    EXPECT_LE(difference(centerOf(picture), blended(1 - FogPainter::kMinTransmittance)), 2);
}

TEST(FogPainter, TheTotalDoesNotDependOnTheLattice) {
    // The opacity along the ray is not constant, so the total is an integral.
    const auto ramp = [](const glm::dvec3& p) { return std::lround(1 + 254 * std::clamp((p.z + 1) / 2, 0.0, 1.0)); };
    std::vector<slicing::FogControlPoint> points{{0, 0, kRed}, {1, 0.9, kRed}};
    // The integral ∫ −log(1 − a(z)) dz for a(z) = 0.9 (z + 1) / 2, computed numerically.
    double thickness = 0;
    constexpr int kParts = 10'000;
    for (int i = 0; i < kParts; ++i) thickness += -std::log(1 - 0.9 * (i + 0.5) / kParts) * 2 / kParts;
    for (const double step : {0.4, 0.2, 0.1, 0.03}) {
        FogPicture picture(1, step, ramp);
        scene::makeFogTable(points, picture.scene.fog);
        EXPECT_LE(difference(centerOf(picture), blended(1 - std::exp(-thickness))), 3) << step;
    }
}

TEST(FogPainter, EndsAtTheWallsAndHasNoneWhereThereIsNoValue) {
    FogPicture picture(0.5, 0.05, [](const glm::dvec3& p) { return p.x < 0 ? 0 : 100; });
    picture.setOpacity(0.9);
    const image::Image image = picture.draw(renderer());
    const auto at = [&](double x, double y) {
        return pixelAt(image, static_cast<int>(HandMade::kSize / 2.0 + HandMade::kUnit * x),
                       static_cast<int>(HandMade::kSize / 2.0 + HandMade::kUnit * y));
    };
    const Rgb background = rgbOf(scene::style().background);
    EXPECT_GT(difference(at(0.5, 0.2), background), 60);
    EXPECT_EQ(difference(at(-0.2, 0.2), background), 0) << "no value";
    EXPECT_EQ(difference(at(0.5, 0.9), background), 0) << "beyond a wall";
    EXPECT_EQ(difference(at(0.9, 0.2), background), 0) << "beyond a wall";
}

TEST(FogPainter, SolidThingsHideTheFogBehindThem) {
    // A ball in the middle of the layer of fog hides the rear half of the layer.
    FogPicture picture(0.6, 0.05, kConstant);
    picture.slices.vertices = {glm::dvec3(0)};
    picture.slices.vertexBegin = {0, 1};
    picture.slices.vertexSource = {0};
    picture.scene.ballRadius = 0.3;
    picture.setOpacity(0);
    const Rgb ball = centerOf(picture);
    picture.setOpacity(0.7);
    const Rgb seen = centerOf(picture);
    const double opacity = 1 - std::pow(0.3, 0.6 - 0.3);  // the fog from z = 0.6 to the ball at z = 0.3
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(seen[i], opacity * rgbOf(kRed)[i] + (1 - opacity) * ball[i], 4) << i;
}

TEST(FogPainter, IsSeenThroughTheEdgesOfBars) {
    // Bars are before the fog and in it. Where their antialiased edges are translucent, the fog behind them is seen.
    FogPicture picture(0.6, 0.05, kConstant);
    picture.slices.vertices = {{-0.7, -0.6, 0.7}, {0.7, 0.5, 0.7}, {-0.7, 0.6, 0.3}, {0.7, -0.4, 0.3}};
    picture.slices.vertexBegin = {0, 4};
    picture.slices.vertexSource.resize(4);
    picture.slices.edgeBegin = {0, 0};
    picture.addEdge(0, 1);
    picture.addEdge(2, 3);
    picture.scene.look.parts.balls = false;
    picture.setOpacity(0.95);
    // No pixel is darker than both the fog and a bar without direct light.
    const scene::PictureStyle& style = scene::style();
    const double darkest = style.ambient * rgbOf(style.bar)[0] - 2;
    ASSERT_GT(darkest, rgbOf(style.background)[0] + 20);
    ASSERT_LT(darkest, centerOf(picture)[0]);
    for (const double radius : {0.002, 0.01, 0.03}) {
        picture.scene.barRadius = radius;
        const image::Image image = picture.draw(renderer());
        for (int y = 31; y < HandMade::kSize - 31; ++y) {
            for (int x = 31; x < HandMade::kSize - 31; ++x)
                EXPECT_GE(pixelAt(image, x, y)[0], darkest) << x << ' ' << y;
        }
    }
}

TEST(FogPainter, AnEyeInTheFogSeesIt) {
    FogPicture picture(1, 0.1, kConstant);
    picture.setOpacity(0.8);
    picture.scene.camera.eye = {0, 0, 0.5};
    EXPECT_LE(difference(centerOf(picture), blended(1 - std::pow(0.2, 1.5))), 3);
}

}  // namespace
}  // namespace oval4d::render
