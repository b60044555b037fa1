// Tests of whole pictures: the order of surfaces, symmetry, unusual viewpoints and sizes.

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/gl.hpp"
#include "render/offscreen_gl_context.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

class Pictures : public testing::Test {
  protected:
    static Renderer& renderer() {
        static Renderer instance;
        return instance;
    }
};

/// Computes the color of a pixel without the code under test: casts a ray from the eye through the center of the pixel,
/// and blends all faces that the ray hits, from far to near.
class RayCaster {
  public:
    explicit RayCaster(const Subject& subject) : subject_(subject) {
        const scene::Camera& camera = subject.scene.camera;
        const scene::Viewport viewport = subject.scene.viewport;
        toWorld_ =
            glm::inverse(camera.projection(static_cast<double>(viewport.width) / viewport.height) * camera.view());
        toCamera_ = glm::dmat3(camera.view());
    }

    struct Result {
        glm::dvec3 color;
        double nearestEdge;  ///< the approximate distance from the nearest edge, in pixels
    };

    Result cast(int x, int y) const {
        struct Hit {
            double distance;
            glm::dvec3 color;
        };
        const scene::PictureStyle& style = scene::style();
        const glm::dvec3 eye = subject_.scene.camera.eye, direction = ray(x, y);
        const double pixel = glm::length(ray(x + 1, y) - direction);
        std::vector<Hit> hits;
        double nearestEdge = 1e9;
        const slicing::SliceSet& set = subject_.slices;
        for (std::size_t s = 0; s < subject_.scene.placements.size(); ++s) {
            if (!subject_.scene.placements[s].drawn) continue;
            for (std::size_t f = set.faceBegin[s]; f < set.faceBegin[s + 1]; ++f) {
                const std::vector<glm::dvec3> corners = cornersOf(s, f);
                glm::dvec3 normal(0);
                for (std::size_t i = 2; i < corners.size(); ++i)
                    normal += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
                normal = glm::normalize(normal);
                const double t = glm::dot(corners[0] - eye, normal) / glm::dot(direction, normal);
                double inside = 1e9;
                for (std::size_t i = 0; i < corners.size(); ++i) {
                    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
                    // The signed angle between the ray and the plane through the eye and this edge.
                    const glm::dvec3 side = glm::normalize(glm::cross(a - eye, b - eye));
                    const double sense = glm::dot(normal, corners[0] - eye) < 0 ? -1 : 1;
                    inside = std::min(inside, sense * glm::dot(side, direction) / pixel);
                }
                nearestEdge = std::min(nearestEdge, std::abs(inside));
                if (inside < 0) continue;
                const double lit = style.ambient + style.diffuse * std::abs(glm::dot(toCamera_ * normal, style.light));
                const Rgb tint = rgbOf(subject_.scene.cellColors[set.faceSource[f]]);
                hits.push_back({t, glm::dvec3(tint[0], tint[1], tint[2]) * lit});
            }
        }
        std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.distance > b.distance; });
        const Rgb background = rgbOf(style.background);
        glm::dvec3 color(background[0], background[1], background[2]);
        for (const Hit& hit : hits) color = glm::mix(color, glm::min(hit.color, glm::dvec3(255)), style.faceOpacity);
        return {color, nearestEdge};
    }

  private:
    glm::dvec3 ray(int x, int y) const {
        const scene::Viewport viewport = subject_.scene.viewport;
        const glm::dvec4 p =
            toWorld_ * glm::dvec4(2 * (x + 0.5) / viewport.width - 1, 2 * (y + 0.5) / viewport.height - 1, 0, 1);
        return glm::normalize(glm::dvec3(p) / p.w - subject_.scene.camera.eye);
    }

    std::vector<glm::dvec3> cornersOf(std::size_t slice, std::size_t face) const {
        const slicing::SliceSet& set = subject_.slices;
        std::vector<glm::dvec3> corners;
        for (std::size_t i = set.cornerBegin[face]; i < set.cornerBegin[face + 1]; ++i)
            corners.push_back(subject_.scene.placements[slice].position +
                              subject_.scene.scale * set.vertices[set.vertexBegin[slice] + set.corners[i]]);
        return corners;
    }

    const Subject& subject_;
    glm::dmat4 toWorld_;
    glm::dmat3 toCamera_;
};

class Transparency : public Pictures,
                     public testing::WithParamInterface<std::tuple<const char*, scene::View, unsigned, double>> {};

TEST_P(Transparency, FacesAreBlendedInTheirTrueOrder) {
    const auto& [name, view, seed, zoom] = GetParam();
    scene::Look look;
    look.view = view;
    look.orbit = {0.4, 0.3, zoom};
    look.parts = {.faces = true, .bars = false, .balls = false, .coordinates = false};
    Subject subject(name, randomRotation(seed), 21, look, {640, 360});
    subject.slicesOnly();
    const image::Image image = subject.draw(renderer());
    const RayCaster rays(subject);
    int compared = 0, hit = 0, wrong = 0;
    for (int y = 0; y < image.height; y += 5)
        for (int x = 0; x < image.width; x += 5) {
            const auto [color, nearestEdge] = rays.cast(x, y);
            if (nearestEdge < 2) continue;
            ++compared;
            const Rgb expected{static_cast<int>(std::lround(color[0])), static_cast<int>(std::lround(color[1])),
                               static_cast<int>(std::lround(color[2]))};
            hit += difference(expected, rgbOf(scene::style().background)) > 3 ? 1 : 0;
            wrong += difference(pixelAt(image, x, y), expected) > 4 ? 1 : 0;
        }
    EXPECT_GT(compared, 4000);
    EXPECT_GT(hit, 150);
    EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Pictures, Transparency,
                         testing::Values(std::tuple("5-cell", scene::View::oval, 1u, 1.0),
                                         std::tuple("5-cell", scene::View::single, 2u, 1.0),
                                         std::tuple("8-cell", scene::View::single, 3u, 1.0),
                                         std::tuple("24-cell", scene::View::single, 4u, 1.0),
                                         // The eye is so close that faces extend behind it.
                                         std::tuple("8-cell", scene::View::single, 5u, 5.0),
                                         std::tuple("16-cell", scene::View::single, 6u, 12.0)));

TEST_F(Pictures, MirroredSceneGivesMirroredSilhouette) {
    // The slices of an unrotated tesseract are cubes, so the oval is its own mirror image. The light is not symmetric,
    // so only silhouettes are compared.
    scene::Look look;
    Subject subject("8-cell", {}, 21, look, {400, 300});
    subject.slicesOnly();
    const image::Image image = subject.draw(renderer());
    const Rgb background = rgbOf(scene::style().background);
    int covered = 0, different = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const bool here = difference(pixelAt(image, x, y), background) > 8;
            const bool there = difference(pixelAt(image, image.width - 1 - x, y), background) > 8;
            covered += here ? 1 : 0;
            different += here != there ? 1 : 0;
        }
    EXPECT_GT(covered, 5000);
    EXPECT_LE(different, covered / 200);
}

TEST_F(Pictures, AreTheSameEveryTime) {
    const Subject subject("600-cell", randomRotation(5), 21, {}, {640, 360});
    const image::Image first = subject.draw(renderer());
    Subject("5-cell", {}, 11, {}, {123, 456}).draw(renderer());
    EXPECT_EQ(subject.draw(renderer()).pixels, first.pixels);
    Renderer another;
    EXPECT_EQ(subject.draw(another).pixels, first.pixels);
}

TEST_F(Pictures, ShowNothingOfEarlierPictures) {
    using scene::ProjectionKind, scene::View;
    // A picture full of opaque faces, which are nearer than everything in the other pictures.
    scene::Look close;
    close.view = View::single;
    close.orbit.zoom = 8;
    close.parts.coordinates = false;
    const scene::Viewport viewport{320, 180};
    const Subject before("small stellated 120-cell", {}, 1, close, viewport);
    ASSERT_TRUE(before.scene.needsDepthBuffer);

    struct Later {
        const char* name;
        View view;
        scene::CameraOrbit orbit;
        scene::ProjectionSettings projection;
    };
    const std::vector<Later> examples{
        {"no projection", View::oval, {}, {}},
        {"inside the oval", View::oval, {}, {ProjectionKind::perspective, 1.05}},
        // Far from the view axis, the image of a sphere is a long ellipse.
        {"above the view axis", View::oval, {0, 0.6, 0.2}, {ProjectionKind::orthogonal, 3}},
        {"far above the view axis", View::oval, {0, 0.9, 0.15}, {ProjectionKind::perspective, 1000}},
        {"beside a slice", View::single, {0.3, 0, 0.4}, {ProjectionKind::perspective, 1000}},
        {"beside the matrix", View::matrix, {}, {ProjectionKind::perspective, 3}},
        {"above a row", View::strip, {0.5, -0.7, 0.3}, {ProjectionKind::orthogonal, 3}},
        {"beside a grid", View::grid, {0.3, 0.2, 0.8}, {ProjectionKind::perspective, 3}},
    };
    const auto subjectOf = [&](const Later& example) {
        scene::Look look;
        look.view = example.view;
        look.orbit = example.orbit;
        look.projection = example.projection;
        return Subject("24-cell", randomRotation(12), 21, look, viewport);
    };
    for (const ShapeBackend backend : {ShapeBackend::fastest, ShapeBackend::open_gl}) {
        std::vector<image::Image> wanted;  // each picture is drawn by a renderer that has drawn nothing else
        for (const Later& example : examples) {
            Renderer fresh(defaultFontPath(), backend);
            wanted.push_back(subjectOf(example).draw(fresh));
        }
        Renderer used(defaultFontPath(), backend);
        for (std::size_t i = 0; i < examples.size(); ++i) {
            SCOPED_TRACE(examples[i].name);
            before.draw(used);
            EXPECT_TRUE(subjectOf(examples[i]).draw(used).pixels == wanted[i].pixels);
        }
    }
}

TEST_F(Pictures, OnTwoThreadsDoNotDisturbEachOther) {
    const Subject a("24-cell", randomRotation(6), 21, {}, {320, 240}),
        b("16-cell", randomRotation(7), 11, {}, {320, 240});
    const image::Image wantedA = a.draw(renderer()), wantedB = b.draw(renderer());
    const auto drawMany = [](const Subject& subject, const image::Image& wanted, int& wrong) {
        Renderer own;
        for (int i = 0; i < 40; ++i) wrong += subject.draw(own).pixels != wanted.pixels ? 1 : 0;
    };
    int wrongA = 0, wrongB = 0;
    std::thread one([&] { drawMany(a, wantedA, wrongA); }), two([&] { drawMany(b, wantedB, wrongB); });
    one.join();
    two.join();
    EXPECT_EQ(wrongA, 0);
    EXPECT_EQ(wrongB, 0);
}

TEST_F(Pictures, OfNothingIsBackground) {
    scene::Look look;
    Subject subject("5-cell", {}, 3, look, {64, 48});
    subject.slices = {};
    subject.slices.vertexBegin = subject.slices.edgeBegin = subject.slices.faceBegin = {0, 0, 0, 0};
    subject.slicesOnly();
    const image::Image image = subject.draw(renderer());
    ASSERT_EQ(image.pixels.size(), 64u * 48 * 4);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) ASSERT_EQ(pixelAt(image, x, y), rgbOf(scene::style().background));
}

TEST_F(Pictures, OfEverySizeAndViewAreDrawn) {
    for (const scene::Viewport viewport :
         {scene::Viewport{1, 1}, {1, 2}, {3, 1}, {16, 4096}, {4096, 16}, {2, 2000}, {7680, 64}})
        for (const scene::ViewTableRow& view : scene::kViews) {
            SCOPED_TRACE(view.name);
            scene::Look look;
            look.view = view.value;
            const image::Image image = Subject("120-cell", randomRotation(8), 5, look, viewport).draw(renderer());
            EXPECT_EQ(image.width, viewport.width);
            EXPECT_EQ(image.height, viewport.height);
            EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(viewport.width * viewport.height) * 4);
        }
}

TEST_F(Pictures, FromAnyPlaceAreDrawn) {
    // The viewpoint may also be between the slices or behind them.
    for (const double azimuth : {0.0, 2.0, 3.14159})
        for (const double elevation : {-1.4, 0.0, 1.4})
            for (const double zoom : {0.05, 1.0, 30.0}) {
                scene::Look look;
                look.orbit = {azimuth, elevation, zoom};
                const image::Image image = Subject("16-cell", randomRotation(9), 21, look, {160, 90}).draw(renderer());
                EXPECT_EQ(image.pixels.size(), 160u * 90 * 4);
            }
}

TEST_F(Pictures, ShowWhatIsAskedFor) {
    const auto drawn = [&](scene::ShownParts parts) {
        scene::Look look;
        look.parts = parts;
        return Subject("16-cell", randomRotation(10), 11, look, {320, 180}).draw(renderer()).pixels;
    };
    const auto all = drawn({});
    EXPECT_NE(drawn({.faces = false}), all);
    EXPECT_NE(drawn({.bars = false}), all);
    EXPECT_NE(drawn({.balls = false}), all);
    EXPECT_NE(drawn({.coordinates = false}), all);
}

TEST_F(Pictures, ShowTheDensityOfManyVertices) {
    using scene::DensityPlot;
    const Subject subject("120-cell", randomRotation(21), 3, {}, {960, 540});
    const image::Image image = subject.draw(renderer());
    const scene::ParallelCoordinatesLayout& layout = subject.scene.coordinates;
    const scene::PictureStyle& style = scene::style();
    const auto& colors = style.axes;
    const double height = subject.scene.viewport.height;
    const auto xOf = [&](double column) {
        return static_cast<int>((layout.left + layout.lineWidth / 2 + column / DensityPlot::kGap * layout.lineStep) *
                                height);
    };
    const auto yOf = [&](int row) {
        const double level = 1 - 2.0 * row / (DensityPlot::kRows - 1);
        return static_cast<int>((layout.zero + level * layout.amplitude) * height);
    };
    double sum = 0;
    int count = 0;
    for (int row = 1; row + 1 < DensityPlot::kRows; ++row)
        for (int column = 3; column + 3 < DensityPlot::kColumns; ++column) {
            // Skips the columns that the axes cover.
            if (column % DensityPlot::kGap < 3 || column % DensityPlot::kGap > DensityPlot::kGap - 3) continue;
            const double opacity = subject.scene.plotTones[DensityPlot::index(row, column)] / 255.0;
            const auto gap = static_cast<std::size_t>(column / DensityPlot::kGap);
            const double part = column % DensityPlot::kGap / double(DensityPlot::kGap);
            const Rgb from = rgbOf(colors[gap]), to = rgbOf(colors[gap + 1]), behind = rgbOf(style.background);
            const Rgb drawn = pixelAt(image, xOf(column), yOf(row));
            for (std::size_t k = 0; k < 3; ++k)
                sum += std::abs(behind[k] + opacity * ((1 - part) * from[k] + part * to[k] - behind[k]) - drawn[k]);
            count += 3;
        }
    EXPECT_LT(sum / count, 5) << "mean difference of a channel from the density in the axes' colors";
    for (std::size_t k = 0; k < 4; ++k) {
        const Rgb axis = pixelAt(image, xOf(static_cast<double>(k) * DensityPlot::kGap), yOf(3));
        EXPECT_LE(difference(axis, rgbOf(colors[k])), 1) << "axis " << k;
    }
    scene::Look without;
    without.parts.coordinates = false;
    const Subject bare("120-cell", randomRotation(21), 3, without, {960, 540});
    const image::Image empty = bare.draw(renderer());
    EXPECT_EQ(pixelAt(empty, xOf(20), yOf(5)), rgbOf(style.background));
}

// Over a density strip, the lines of the highlighted vertices are shown. The line of a vertex joins its coordinates on
// the axes.
TEST_F(Pictures, ShowTheLinesOfTheHighlightedVerticesOverTheDensity) {
    const scene::Viewport viewport{1920, 1080};
    const geometry::Rotation orientation = randomRotation(22);
    scene::Look look;
    const Subject plain("120-cell", orientation, 1, look, viewport);
    look.highlight = slicing::Element{slicing::ElementKind::cell, 5};
    const Subject lit("120-cell", orientation, 1, look, viewport);
    ASSERT_EQ(lit.scene.highlight.ownVertices.size(), 20U) << "a dodecahedron";
    const image::Image before = plain.draw(renderer()), after = lit.draw(renderer());
    const scene::ParallelCoordinatesLayout& layout = lit.scene.coordinates;
    const Rgb color = rgbOf(scene::style().highlight);
    for (const std::uint32_t v : lit.scene.highlight.ownVertices) {
        const glm::dvec4 at = lit.slices.rotatedVertices[v] / lit.scene.circumradius;
        for (int k = 0; k < 3; ++k) {
            const double x = layout.left + layout.lineWidth / 2 + (k + 0.5) * layout.lineStep;
            const double y = layout.zero + (at[k] + at[k + 1]) / 2 * layout.amplitude;
            const int column = static_cast<int>(x * viewport.height), row = static_cast<int>(y * viewport.height);
            EXPECT_LE(difference(pixelAt(after, column, row), color), 3) << "vertex " << v << ", axis " << k;
            EXPECT_GT(difference(pixelAt(before, column, row), color), 40);
        }
    }
}

TEST(OffscreenGlContextTest, LeavesTheRestOfMemoryAlone) {
    OffscreenGlContext context;
    constexpr int kWidth = 37, kHeight = 21;
    constexpr std::size_t kGuard = 4096, kSize = kWidth * kHeight * 4;
    std::vector<std::uint8_t> memory(kSize + 2 * kGuard, 0xa5);
    context.begin(kWidth, kHeight, memory.data() + kGuard);
    glClearColor(1, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    context.readPixels();
    for (std::size_t i = 0; i < memory.size(); ++i) {
        const bool inside = i >= kGuard && i < kGuard + kSize;
        const std::size_t channel = (i - kGuard) % 4;
        ASSERT_EQ(memory[i], !inside ? 0xa5 : channel == 0 || channel == 3 ? 255 : 0) << "byte " << i;
    }
}

TEST(OffscreenGlContextTest, RefusesAPictureThatIsTooLarge) {
    OffscreenGlContext context;
    std::uint8_t pixel[4];
    EXPECT_GE(context.maxPictureSide(), 8192);
    EXPECT_THROW(context.begin(context.maxPictureSide() + 1, 1, pixel), std::runtime_error);
}

TEST(RendererTest, SaysWhichFontIsMissing) {
    try {
        Renderer renderer("/nowhere/Font.ttf");
        FAIL() << "no font, no renderer";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("/nowhere/Font.ttf"), std::string::npos);
    }
}

}  // namespace
}  // namespace oval4d::render
