#pragma once
// Helpers for the tests of exports: a check of meshes that is independent of the tested code, and objects to export.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "export/export.hpp"
#include "export/mesh/mesh.hpp"
#include "fields/formula_field.hpp"
#include "scene/composer.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/directed_edges.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::support {

using namespace exports;

using Key = std::tuple<float, float, float>;

/// Expects that a mesh can be printed: every edge belongs to two triangles, which traverse it in opposite directions;
/// the triangles around every point form one ring; the volume is positive. Points with the same 32-bit coordinates
/// count as one point, as in the software of 3-D printers.
inline void expectPrintable(const Mesh& mesh) {
    ASSERT_FALSE(mesh.triangles.empty());
    ASSERT_EQ(mesh.cells.size(), mesh.triangles.size());
    std::map<Key, std::uint32_t> points;
    std::vector<std::uint32_t> same;
    for (const auto& p : mesh.points) {
        const Key key{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        same.push_back(points.try_emplace(key, points.size()).first->second);
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& t : mesh.triangles) {
        const auto& corners = triangles.emplace_back(std::array{same[t[0]], same[t[1]], same[t[2]]});
        for (std::size_t i = 0; i < 3; ++i) ASSERT_NE(corners[i], corners[(i + 1) % 3]);
    }
    ASSERT_TRUE(DirectedEdges(triangles).isManifold());
    double volume = 0;
    for (const auto& t : mesh.triangles) {
        volume += glm::dot(mesh.points[t[0]], glm::cross(mesh.points[t[1]], mesh.points[t[2]])) / 6;
    }
    ASSERT_GT(volume, 0);
    ASSERT_NEAR(volume, volumeOf(mesh), 1e-9 * std::abs(volume));
}

/// The default limits with 24 hours of time, so that no export fails on a slow machine.
inline const ExportLimits kUnhurried{.time = std::chrono::hours(24)};

inline const ExportBudget& unhurried() {
    static const ExportBudget kBudget({100'000'000, std::numeric_limits<std::size_t>::max(), kUnhurried.time}, {});
    return kBudget;
}

inline const Polygon kSquare{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
inline const Polygon kDented{{-2, -2}, {2, -2}, {2, 0}, {0.5, 0}, {0.5, 1.5}, {-0.5, 1.5}, {-0.5, 0}, {-2, 0}};
inline constexpr double kDentedArea = 4 * 2 + 1 * 1.5;

inline Polygon pentagram() {
    Polygon star;
    for (int i = 0; i < 5; ++i)
        star.emplace_back(std::cos(4 * i * std::numbers::pi / 5), std::sin(4 * i * std::numbers::pi / 5));
    return star;
}
/// The area of the region with nonzero winding number in a pentagram with the circumradius 1. The region consists of
/// ten triangles. The corners of a triangle are the center, a tip at the distance 1, and an inner corner at the
/// distance φ⁻². The angle at the center is 36°.
inline const double kPentagramArea =
    10 * 0.5 * std::sin(std::numbers::pi / 5) / (std::numbers::phi * std::numbers::phi);

/// Returns the scene of a polytope's slices. The scene refers to `slices`, which must outlive the scene.
inline scene::Scene composed(const polytopes::Polytope& polytope, const geometry::Rotation& orientation,
                             const slicing::SliceSet& slices) {
    scene::Scene scene;
    scene::Composer composer;
    composer.limitFaceFilling(0);
    const int focus = slices.planes.first + (slices.planes.count - 1) / 2;
    composer.compose(objectOf(polytope), orientation, slices, focus, {}, {}, scene);
    return scene;
}

/// Slices a polytope, and returns the exported slices.
inline std::variant<ExportedFile, ExportRefusal> exported(
    const polytopes::Polytope& polytope, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
    const ExportRequest& request, const ExportLimits& limits = kUnhurried, std::stop_token stop = {}) {
    slicing::SliceSet slices;
    slicing::CellComplexSlicer().slice(polytope, orientation, planes, slices);
    return exports::exportScene(composed(polytope, orientation, slices), objectOf(polytope), orientation, request,
                                limits, std::move(stop));
}

/// The slices and the scene of a field whose inside is a ball with the radius 1.
struct SlicedBall {
    slicing::Object object;
    slicing::SliceSet slices;
    scene::Scene scene;  ///< refers to `slices`

    explicit SlicedBall(const geometry::Hyperplanes& planes) {
        auto read = fields::fieldFromFormula("ball", "x^2 + y^2 + z^2 + w^2 < 1", {glm::dvec4(-1.2), glm::dvec4(1.2)});
        EXPECT_TRUE(read) << read.error().message;
        object = std::make_shared<const fields::Field>(std::move(*read));
        slicing::SurfaceDetail detail;
        slicing::setUniformDetail(slicing::infoOf(object).circumradius, planes, slicing::Quality::file, detail);
        slicing::Slicer().slice(object, {}, planes, {}, detail, slices);
        scene::Composer().compose(object, {}, slices, 0, {}, {}, scene);
    }
    SlicedBall(const SlicedBall&) = delete;
    SlicedBall& operator=(const SlicedBall&) = delete;

    std::variant<ExportedFile, ExportRefusal> exported(const ExportRequest& request,
                                                       const ExportLimits& limits = kUnhurried,
                                                       std::stop_token stop = {}) const {
        return exports::exportScene(scene, object, {}, request, limits, std::move(stop));
    }
};

/// Returns the bytes of an exported file. If the export was refused, returns "refused: " and the reason.
inline std::string bytesOf(std::variant<ExportedFile, ExportRefusal> made) {
    if (auto* refusal = std::get_if<ExportRefusal>(&made)) return "refused: " + refusal->message;
    return std::get<ExportedFile>(std::move(made)).bytes;
}

/// Slices a polytope and exports the slices. Returns the bytes of the file or, if the export was refused, "refused: "
/// and the reason.
inline std::string fileOf(const polytopes::Polytope& polytope, const geometry::Rotation& orientation,
                          const geometry::Hyperplanes& planes, const ExportRequest& request,
                          const ExportLimits& limits = kUnhurried) {
    return bytesOf(exported(polytope, orientation, planes, request, limits));
}

/// Returns a polytope that consists of `a` and of `b`, translated by the vector `by`.
inline polytopes::Polytope compound(const polytopes::Polytope& a, const polytopes::Polytope& b, const glm::dvec4& by) {
    std::vector<glm::dvec4> vertices = a.vertices;
    for (const auto& v : b.vertices) vertices.push_back(v + by);
    geometry::JaggedArray faces = a.faces;
    geometry::JaggedArray cells = a.cells;
    const auto append = [](geometry::JaggedArray& into, const geometry::JaggedArray& from, std::size_t shift) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            std::vector<std::uint32_t> list(from[i].begin(), from[i].end());
            for (auto& item : list) item += static_cast<std::uint32_t>(shift);
            into.add(list);
        }
    };
    append(faces, b.faces, a.vertices.size());
    append(cells, b.cells, a.faces.size());
    return polytopes::makePolytope("compound", std::move(vertices), std::move(faces), std::move(cells));
}

}  // namespace oval4d::support
