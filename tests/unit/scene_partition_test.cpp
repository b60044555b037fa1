// Drawing order of slices that are not convex: against rays that meet the faces by distance.

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/coxeter.hpp"
#include "scene/scene.hpp"

namespace {

using namespace oval4d;
using geometry::Branch;
using scene::Partition;

constexpr Branch k3{3, 1}, k5{5, 1}, kStar{5, 2};

geometry::Polytope regular(Branch p, Branch q, Branch r) {
    const auto diagram = geometry::Diagram::linear(p, q, r, {true, false, false, false});
    return geometry::wythoff("regular", diagram, geometry::mirrorsOf(diagram));
}

geometry::Rotation anyRotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto quaternion = [&] {
        const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
        return glm::normalize(glm::dquat(a, b, c, d));
    };
    const glm::dquat left = quaternion();
    return {left, quaternion()};
}

/// Whether a ray meets the piece's inside, and at what distance; `margin` is how far from its edges, at least.
bool meets(const Partition& tree, const Partition::Piece& piece, const glm::dvec3& eye, const glm::dvec3& ray,
           double margin, double& distance) {
    const auto& patch = tree.patch(piece);
    distance = (patch.offset - glm::dot(patch.normal, eye)) / glm::dot(patch.normal, ray);
    const glm::dvec3 hit = eye + ray * distance;
    int left = 0, right = 0, count = 0;
    for (auto c = piece.begin; c < piece.end; ++c, ++count) {
        const glm::dvec3 a = tree.corner(c), b = tree.corner(c + 1 < piece.end ? c + 1 : piece.begin);
        const double side = glm::dot(glm::cross(b - a, hit - a), patch.normal) / std::max(glm::length(b - a), 1e-12);
        left += side > margin ? 1 : 0;
        right += side < -margin ? 1 : 0;
    }
    return distance > 0 && (left == count || right == count);
}

struct Subject {
    geometry::Polytope polytope;
    geometry::SliceSet slices;
    scene::Scene scene;

    Subject(geometry::Polytope shown, unsigned seed, int count, const scene::Look& look = {})
        : polytope(std::move(shown)) {
        std::mt19937 random(seed);
        const geometry::Hyperplanes planes{-(count - 1) / 2, count, polytope.circumradius / std::max(1, count / 2)};
        geometry::Slicer().slice(polytope, anyRotation(random), planes, slices);
        scene::compose(polytope, planes, 0, look, {640, 480}, scene);
    }
    glm::dvec3 eye(std::size_t slice) const { return (scene.camera.eye - scene.stands[slice].position) / scene.scale; }
};

double areaOf(const geometry::Fill& fill) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < fill.cornerBegin.size(); ++k) {
        glm::dvec3 area(0);
        for (auto i = fill.cornerBegin[k] + 2; i < fill.cornerBegin[k + 1]; ++i) {
            const glm::dvec3& apex = fill.corners[fill.cornerBegin[k]];
            area += glm::cross(fill.corners[i - 1] - apex, fill.corners[i] - apex);
        }
        sum += glm::length(area) / 2;
    }
    return sum;
}

TEST(Partition, OfConvexPolytopesIsEmpty) {
    Subject subject(regular(k5, k3, k3), 1, 3);
    scene::part(subject.polytope, subject.slices, subject.scene);
    EXPECT_TRUE(subject.scene.partition.empty());
}

TEST(Partition, OrdersAllPiecesFromAnyEye) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const auto& [p, q, r] : {std::array{k3, k5, kStar}, {k5, kStar, k5}, {kStar, k5, k3}, {kStar, k3, k5}}) {
        const Subject subject(regular(p, q, r), 11, 3);
        const double radius = subject.polytope.circumradius;
        Partition tree;
        tree.build(subject.polytope, subject.slices, {});
        std::size_t met = 0;
        for (int trial = 0; trial < 40; ++trial) {
            const auto direction = [&] {
                return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            };
            const glm::dvec3 eye = direction() * (3 * radius);
            const glm::dvec3 ray = glm::normalize(direction() * (0.8 * radius) - eye);
            double last = 1e9;
            std::vector<double> inOrder;
            tree.fromFarToNear(1, eye, [&](const Partition::Piece& piece) {
                double distance = 0;
                if (!meets(tree, piece, eye, ray, 1e-7 * radius, distance)) return;
                EXPECT_LE(distance, last + 1e-7 * radius);
                last = distance;
                ++met;
            });
        }
        EXPECT_GT(met, 100U);
    }
}

TEST(Partition, KeepsTheArea) {
    for (const auto& [p, q, r] : {std::array{k5, k3, kStar}, {kStar, k5, kStar}}) {
        const Subject subject(regular(p, q, r), 12, 3);
        geometry::Fill fill;
        geometry::Filler().fill(subject.slices, subject.polytope.circumradius, fill);
        Partition tree;
        tree.build(subject.polytope, subject.slices, {});
        double area = 0;
        for (std::size_t slice = 0; slice < 3; ++slice)
            tree.fromFarToNear(slice, {9, 8, 7}, [&](const Partition::Piece& piece) { area += piece.area; });
        EXPECT_NEAR(area / areaOf(fill), 1, 1e-6);
    }
}

// The light that comes through all faces along a ray, by distance; and what of it the tree's order gives.
TEST(Partition, LeavesOutOnlyWhatCannotBeSeen) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-0.9, 0.9);
    for (const auto& [p, q, r] : {std::array{k3, k3, kStar}, {kStar, k5, k3}, {k5, k3, kStar}}) {
        Subject subject(regular(p, q, r), 13, 3);
        scene::part(subject.polytope, subject.slices, subject.scene);
        const Partition& tree = subject.scene.partition;
        geometry::Fill fill;
        geometry::Filler().fill(subject.slices, subject.polytope.circumradius, fill);
        const double opacity = scene::style().faceOpacity;
        const glm::dvec3 eye = subject.eye(1);
        double worst = 0, sum = 0;
        constexpr int kRays = 300;
        for (int trial = 0; trial < kRays; ++trial) {
            const glm::dvec3 at = subject.polytope.circumradius * glm::dvec3(place(random), place(random), 0);
            const glm::dvec3 ray = glm::normalize(at - eye);
            std::vector<std::pair<double, std::uint32_t>> hits;
            for (auto f = fill.patchBegin[1]; f < fill.patchBegin[2]; ++f) {
                const auto& patch = fill.patches[f];
                const double distance = (patch.offset - glm::dot(patch.normal, eye)) / glm::dot(patch.normal, ray);
                const glm::dvec3 hit = eye + ray * distance;
                for (auto k = fill.pieceBegin[f]; k < fill.pieceBegin[f + 1]; ++k) {
                    const auto begin = fill.cornerBegin[k], end = fill.cornerBegin[k + 1];
                    bool inside = true;
                    for (auto c = begin; c < end; ++c) {
                        const glm::dvec3 &a = fill.corners[c], &b = fill.corners[c + 1 < end ? c + 1 : begin];
                        inside = inside && glm::dot(glm::cross(b - a, hit - a), patch.normal) >= 0;
                    }
                    if (inside) hits.emplace_back(-distance, patch.of);
                }
            }
            std::sort(hits.begin(), hits.end());
            const auto grey = [](std::uint32_t cell) { return static_cast<double>(cell % 7) / 6; };
            double expected = 0, drawn = 0;
            for (const auto& [ignored, cell] : hits) expected += opacity * (grey(cell) - expected);
            tree.fromFarToNear(1, eye, [&](const Partition::Piece& piece) {
                double distance = 0;
                if (meets(tree, piece, eye, ray, 0, distance)) drawn += opacity * (grey(tree.patch(piece).of) - drawn);
            });
            worst = std::max(worst, std::abs(drawn - expected));
            sum += std::abs(drawn - expected);
        }
        // Pieces of a few pixels may stand before what cuts them; all others are where they belong.
        EXPECT_LT(sum / kRays, 0.01);
        EXPECT_LT(worst, 0.6);
    }
}

TEST(Partition, LeavesOutHiddenKinds) {
    Subject subject(regular(k3, k5, kStar), 14, 1);
    subject.polytope.kinds = {"even", "odd"};
    for (std::uint32_t c = 0; c < subject.polytope.cellKinds.size(); ++c) subject.polytope.cellKinds[c] = c % 2;
    scene::Look look;
    look.kinds.hidden = {1};
    scene::Scene scene;
    scene::compose(subject.polytope, subject.slices.planes, 0, look, {}, scene);
    scene::part(subject.polytope, subject.slices, scene);
    std::size_t pieces = 0;
    scene.partition.fromFarToNear(0, subject.eye(0), [&](const Partition::Piece& piece) {
        EXPECT_EQ(scene.partition.patch(piece).of % 2, 0U);
        ++pieces;
    });
    EXPECT_GT(pieces, 20U);
}

}  // namespace
