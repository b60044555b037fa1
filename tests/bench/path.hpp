#pragma once
// The way from an orientation to a picture, step by step, all memory kept: what the benchmarks measure.

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "geometry/coxeter.hpp"
#include "geometry/slicer.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"

namespace oval4d::bench {

/// Polytopes from the smallest to the largest, each from its Coxeter diagram.
struct Subject {
    const char* name;
    int p, q, r;                 ///< {p, q, r}
    std::array<bool, 4> ringed;  ///< mirrors

    geometry::Diagram diagram() const { return geometry::Diagram::linear({p, 1}, {q, 1}, {r, 1}, ringed); }
    geometry::Polytope build() const { return geometry::wythoff(name, diagram(), geometry::mirrorsOf(diagram())); }
};
inline constexpr Subject kSubjects[] = {
    {"5-cell", 3, 3, 3, {true, false, false, false}},
    {"8-cell", 4, 3, 3, {true, false, false, false}},
    {"24-cell", 3, 4, 3, {true, false, false, false}},
    {"omnitruncated 5-cell", 3, 3, 3, {true, true, true, true}},
    {"120-cell", 5, 3, 3, {true, false, false, false}},
    {"600-cell", 3, 3, 5, {true, false, false, false}},
    {"omnitruncated 24-cell", 3, 4, 3, {true, true, true, true}},
    {"truncated 120-cell", 5, 3, 3, {true, true, false, false}},
    {"cantitruncated 120-cell", 5, 3, 3, {true, true, true, false}},
    {"omnitruncated 120-cell", 5, 3, 3, {true, true, true, true}},
};

/// Orientations drawn at random, the same ones in every run.
inline std::vector<geometry::Rotation> randomOrientations(int count = 64) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    const auto quaternion = [&] {
        const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
        return glm::normalize(glm::dquat(a, b, c, d));
    };
    std::vector<geometry::Rotation> orientations;
    for (int i = 0; i < count; ++i) {
        const glm::dquat left = quaternion(), right = quaternion();
        orientations.emplace_back(left, right);
    }
    return orientations;
}

struct Path {
    std::shared_ptr<const geometry::Polytope> polytope;
    geometry::Hyperplanes planes;
    scene::Viewport viewport;
    std::vector<geometry::Rotation> orientations = randomOrientations();
    std::size_t next = 0;
    geometry::Slicer slicer;
    geometry::SliceSet slices;
    scene::Scene scene;
    render::Image image;
    render::PngEncoder encoder;
    std::vector<std::uint8_t> png;

    /// `count` slices (odd) that span the polytope.
    explicit Path(std::shared_ptr<const geometry::Polytope> shown, int count = 21, scene::Viewport size = {1280, 720})
        : polytope(std::move(shown)),
          planes{-(count - 1) / 2, count, polytope->circumradius / std::max(1, (count - 1) / 2)},
          viewport(size) {}

    void slice() { slicer.slice(*polytope, orientations[next++ % orientations.size()], planes, slices); }
    void compose() {
        scene::compose(*polytope, planes, 0, {}, viewport, scene);
        scene::fill(*polytope, slices, scene);
    }
    void draw() { renderer().draw(*polytope, slices, scene, image); }
    void encode() { encoder.encode(image, "{}", png); }
    void frame() {
        slice();
        compose();
        draw();
        encode();
    }

    std::size_t elements() const { return slices.vertices.size() + slices.edges.size() + slices.faceOf.size(); }

    static render::Renderer& renderer() {
        static render::Renderer instance;
        return instance;
    }
};

/// Built once and kept.
inline std::shared_ptr<const geometry::Polytope> subject(std::size_t number) {
    static std::array<std::shared_ptr<const geometry::Polytope>, std::size(kSubjects)> built;
    auto& slot = built.at(number);
    if (!slot) slot = std::make_shared<const geometry::Polytope>(kSubjects[number].build());
    return slot;
}

}  // namespace oval4d::bench
