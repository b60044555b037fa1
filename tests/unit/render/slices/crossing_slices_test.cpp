// Tests of slices whose faces cross each other: the pictures are compared with rays that search for the nearest point
// with a winding number other than 0.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The nearest face of the focus slice on the ray through the center of a pixel.
struct Sight {
    double distance = kFar;
    std::uint32_t of = 0;
    glm::dvec3 normal{0};
    bool clear = true;  ///< whether no edge is within two pixels, and no other face is at nearly the same depth
};

class Eye {
  public:
    explicit Eye(const Subject& subject) : subject_(subject) {
        const auto& [width, height] = subject.scene.viewport;
        const scene::Camera& camera = subject.scene.camera;
        toWorld_ = glm::inverse(camera.projection(static_cast<double>(width) / height) * camera.view());
    }

    Sight look(int x, int y) const {
        const glm::dvec3 ray = rayOf(x, y);
        const double pixel = glm::length(rayOf(x + 1, y) - ray);
        Sight sight;
        double second = kFar;
        const std::size_t slice = subject_.slices.planes.count / 2;
        const slicing::SliceSet& set = subject_.slices;
        for (std::uint32_t f = set.faceBegin[slice], end = f; f < set.faceBegin[slice + 1]; f = end) {
            while (end < set.faceBegin[slice + 1] && set.faceSource[end] == set.faceSource[f]) ++end;
            lookAt(slice, f, end, ray, pixel, sight, second);
        }
        sight.clear = sight.clear && (sight.distance == kFar || second - sight.distance > 0.03);
        return sight;
    }

  private:
    glm::dvec3 rayOf(int x, int y) const {
        const auto& [width, height] = subject_.scene.viewport;
        const glm::dvec4 p = toWorld_ * glm::dvec4(2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1, 0, 1);
        return glm::normalize(glm::dvec3(p) / p.w - subject_.scene.camera.eye);
    }

    glm::dvec3 corner(std::size_t slice, std::size_t i) const {
        const slicing::SliceSet& set = subject_.slices;
        return subject_.scene.placements[slice].position +
               subject_.scene.scale * set.vertices[set.vertexBegin[slice] + set.corners[i]];
    }

    // Intersects the ray with the faces first … last − 1, the loops that were cut from one cell.
    void lookAt(std::size_t slice, std::uint32_t first, std::uint32_t last, const glm::dvec3& ray, double pixel,
                Sight& sight, double& second) const {
        const std::vector<std::uint32_t>& begin = subject_.slices.cornerBegin;
        const glm::dvec3 origin = corner(slice, begin[first]), eye = subject_.scene.camera.eye;
        glm::dvec3 along(0), normal(0);
        for (std::uint32_t i = begin[first]; i < begin[last]; ++i) {
            const glm::dvec3 d = corner(slice, i) - origin;
            if (glm::length(d) > glm::length(along)) along = d;
        }
        for (std::uint32_t i = begin[first]; i < begin[last]; ++i) {
            const glm::dvec3 n = glm::cross(along, corner(slice, i) - origin);
            if (glm::length(n) > glm::length(normal)) normal = n;
        }
        if (glm::length(normal) < 1e-9) return;
        normal = glm::normalize(normal);
        const double distance = glm::dot(origin - eye, normal) / glm::dot(ray, normal);
        const glm::dvec3 hit = eye + ray * distance;
        double turn = 0;
        for (std::uint32_t f = first; f < last; ++f) {
            const std::uint32_t size = begin[f + 1] - begin[f];
            for (std::uint32_t i = 0; i < size; ++i) {
                const glm::dvec3 a = corner(slice, begin[f] + i), b = corner(slice, begin[f] + (i + 1) % size);
                turn += std::atan2(glm::dot(glm::cross(a - hit, b - hit), normal), glm::dot(a - hit, b - hit));
                const glm::dvec3 side = glm::normalize(glm::cross(a - eye, b - eye));
                const bool within = glm::dot(b - a, hit - a) > 0 && glm::dot(a - b, hit - b) > 0;
                if (within && std::abs(glm::dot(side, ray)) < 2 * pixel) sight.clear = false;
            }
        }
        if (std::abs(turn) < std::numbers::pi) return;
        second = std::min(second, std::max(distance, sight.distance));
        if (distance < sight.distance) {
            sight.distance = distance;
            sight.of = subject_.slices.faceSource[first];
            sight.normal = normal;
        }
    }

    const Subject& subject_;
    glm::dmat4 toWorld_;
};

class CrossingFaces : public testing::TestWithParam<const char*> {};

TEST_P(CrossingFaces, HideEachOtherWhereTheyAreFilled) {
    Renderer renderer;
    scene::Look look;
    look.view = scene::View::single;
    look.parts = {.faces = true, .bars = false, .balls = false, .coordinates = false};
    Subject subject(GetParam(), randomRotation(21), 3, look, {480, 360});
    subject.slicesOnly();
    const image::Image image = subject.draw(renderer);
    const Eye eye(subject);
    const scene::PictureStyle& style = scene::style();
    const glm::dmat3 toCamera(subject.scene.camera.view());
    int clear = 0, hit = 0, wrong = 0;
    for (int y = 0; y < image.height; y += 6) {
        for (int x = 0; x < image.width; x += 6) {
            const Sight sight = eye.look(x, y);
            if (!sight.clear) continue;
            ++clear;
            Rgb expected = rgbOf(style.background);
            if (sight.distance < kFar) {
                ++hit;
                const double lit =
                    style.ambient + style.diffuse * std::abs(glm::dot(toCamera * sight.normal, style.light));
                expected = rgbOf(subject.scene.cellColors[sight.of]);
                for (int& c : expected) c = std::min(255, static_cast<int>(std::lround(c * lit)));
            }
            wrong += difference(pixelAt(image, x, y), expected) > 4 ? 1 : 0;
        }
    }
    EXPECT_GT(clear, 1500);
    EXPECT_GT(hit, 50);
    EXPECT_LE(wrong, hit / 100);
}

INSTANTIATE_TEST_SUITE_P(Stars, CrossingFaces,
                         testing::Values("small stellated 120-cell", "great 120-cell", "great stellated 120-cell",
                                         "grand 120-cell"));

TEST(Crossing, FadedFacesLetTheOthersThrough) {
    Renderer renderer;
    scene::Look look;
    look.view = scene::View::single;
    Subject full("icosahedral 120-cell", randomRotation(22), 1, look, {320, 240});
    look.cellTypes.faded = {0};
    Subject faded("icosahedral 120-cell", randomRotation(22), 1, look, {320, 240});
    look.cellTypes = {.hidden = {0}, .faded = {}};
    Subject hidden("icosahedral 120-cell", randomRotation(22), 1, look, {320, 240});
    for (Subject* subject : {&full, &faded, &hidden}) subject->slicesOnly();
    const Rgb background = rgbOf(scene::style().background);
    const auto ink = [&](const Subject& subject) {
        const image::Image image = subject.draw(renderer);
        double sum = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) sum += difference(pixelAt(image, x, y), background);
        return sum;
    };
    const double most = ink(full);
    EXPECT_EQ(ink(hidden), 0);
    EXPECT_GT(ink(faded), 0.2 * most);
    EXPECT_LT(ink(faded), 0.95 * most);
}

TEST(Crossing, ConvexPicturesAreTheSameAfterward) {
    Renderer renderer;
    const Subject convex("8-cell", randomRotation(23), 5, {}, {320, 240});
    const image::Image before = convex.draw(renderer);
    Subject("great 120-cell", randomRotation(24), 5, {}, {320, 240}).draw(renderer);
    EXPECT_EQ(convex.draw(renderer).pixels, before.pixels);
}

}  // namespace
}  // namespace oval4d::render
