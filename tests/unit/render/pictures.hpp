#pragma once
// Helpers of the tests of rendering: scenes to draw, and access to pixels.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <png.h>

#include "image/image.hpp"
#include "image/png.hpp"
#include "render/renderer.hpp"
#include "scene/composer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::render {

using Rgb = std::array<int, 3>;

/// Returns the color of the pixel in column x of row y. Rows are counted from the bottom.
inline Rgb pixelAt(const image::Image& image, int x, int y) {
    const std::uint8_t* p = &image.pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                           static_cast<std::size_t>(x)) *
                                          4];
    return {p[0], p[1], p[2]};
}

inline Rgb rgbOf(scene::Color color) {
    return {static_cast<int>(color >> 16 & 255), static_cast<int>(color >> 8 & 255), static_cast<int>(color & 255)};
}

inline int difference(const Rgb& a, const Rgb& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// A polytope with its slices, and the scene that shows the slices. The focus slice is at w = 0.
struct Subject {
    std::shared_ptr<const polytopes::Polytope> polytope;
    slicing::SliceSet slices;
    scene::Scene scene;  // the scene refers to `slices`

    Subject(const char* name, const geometry::Rotation& orientation, int count, const scene::Look& look,
            scene::Viewport viewport)
        : polytope(support::shared(name)) {
        const int half = count / 2;
        const geometry::Hyperplanes planes{-half, count, polytope->circumradius / std::max(half, 1)};
        slicing::CellComplexSlicer().slice(*polytope, orientation, planes, slices);
        scene::Composer().compose(polytope, orientation, slices, 0, look, viewport, scene);
    }
    Subject(const Subject&) = delete;
    Subject& operator=(const Subject&) = delete;

    /// Removes the parallel coordinates, the axes and the labels from the scene, so that it shows only the slices.
    void slicesOnly() {
        scene.look.parts.coordinates = false;
        scene.axes.length = 0;
        for (scene::SlicePlacement& placement : scene.placements) placement.label.clear();
    }

    image::Image draw(Renderer& renderer) const {
        image::Image image;
        renderer.draw(scene, image);
        return image;
    }
};

/// A slice that a test builds from vertices, edges and faces, and the scene that shows it. The camera looks from z = 10
/// along −z. At the center of the picture, one unit of the slice is 100 pixels.
struct HandMade {
    static constexpr int kSize = 201;
    static constexpr double kUnit = 100;
    slicing::SliceSet slices;
    scene::Scene scene;  // the scene refers to `slices`

    explicit HandMade(std::vector<glm::dvec3> vertices) {
        slices.planes = {0, 1, 1};
        slices.vertexBegin = {0, static_cast<std::uint32_t>(vertices.size())};
        slices.vertices = std::move(vertices);
        slices.vertexSource.resize(slices.vertices.size());
        slices.edgeBegin = slices.faceBegin = {0, 0};
        slices.cornerBegin = {0};
        scene.viewport = {kSize, kSize};
        scene.camera.eye = {0, 0, 10};
        scene.camera.fieldOfView = 2 * std::atan(kSize / 2.0 / kUnit / 10);
        scene.placements.resize(1);
        scene.ballRadius = 0.5;
        scene.barRadius = 0.1;
        scene.look.parts.coordinates = false;
        scene.cellColors = {0x4080c0u};
        scene.slices = &slices;
    }
    HandMade(const HandMade&) = delete;
    HandMade& operator=(const HandMade&) = delete;

    void addEdge(std::uint32_t a, std::uint32_t b) {
        slices.edges.push_back({a, b});
        slices.edgeSource.push_back(0);
        ++slices.edgeBegin[1];
    }

    void addFace(std::vector<std::uint32_t> loop, std::uint32_t of) {
        slices.cornerEdges.insert(slices.cornerEdges.end(), loop.size(), 0);
        slices.corners.insert(slices.corners.end(), loop.begin(), loop.end());
        slices.cornerBegin.push_back(static_cast<std::uint32_t>(slices.corners.size()));
        slices.faceSource.push_back(of);
        ++slices.faceBegin[1];
    }

    image::Image draw(Renderer& renderer) const {
        image::Image image;
        renderer.draw(scene, image);
        return image;
    }
};

inline geometry::Rotation randomRotation(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto quaternion = [&] {
        const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
        return glm::normalize(glm::dquat(a, b, c, d));
    };
    const glm::dquat left = quaternion(), right = quaternion();
    return {left, right};
}

/// Reads a PNG file with libpng, and sets alpha to 255. Returns an image without pixels if the file is not valid.
inline image::Image readPng(std::span<const std::uint8_t> file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&png, file.data(), file.size()) == 0) return {};
    png.format = PNG_FORMAT_RGBA;
    image::Image image{static_cast<int>(png.width), static_cast<int>(png.height),
                       std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
    // With a negative stride, the rows are stored from the bottom up.
    if (png_image_finish_read(&png, nullptr, image.pixels.data(), -4 * image.width, nullptr) == 0) return {};
    return image;
}

}  // namespace oval4d::render
