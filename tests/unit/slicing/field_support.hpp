#pragma once
// Test functions for fields, and measurements of closed surfaces.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include "fields/field.hpp"
#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "slicing/surface_detail.hpp"
#include "slicing/surfaces/slice_surface.hpp"

namespace oval4d::slicing {

/// Returns lattices whose cubes have 1/`cubes` of the field's diameter as their width.
inline SurfaceDetail detailOf(const fields::Field& field, const geometry::Hyperplanes& planes, int cubes) {
    SurfaceDetail detail;
    detail.steps.assign(static_cast<std::size_t>(planes.count), 2 * field.circumradius / cubes);
    detail.secondValues = true;
    return detail;
}

/// A function given by a callable, whose slope is at most `lipschitz` everywhere.
class TestFunction : public fields::ScalarFunction {
  public:
    using Callable = std::function<double(const glm::dvec4&)>;

    TestFunction(Callable f, double lipschitz) : f_(std::move(f)), lipschitz_(lipschitz) {}

    void evaluate(const fields::PointBatch& points, std::span<float> values) const override {
        for (std::size_t i = 0; i < points.size(); ++i) values[i] = static_cast<float>(f_(point(points, i)));
    }
    void evaluateWithGradient(const fields::PointBatch& points, std::span<float> values,
                              const fields::GradientBatch& gradients) const override {
        constexpr double kStep = 1e-4;
        const std::array<std::span<float>, 4> parts{gradients.x, gradients.y, gradients.z, gradients.w};
        evaluate(points, values);
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (int k = 0; k < 4; ++k) {
                glm::dvec4 before = point(points, i), after = before;
                before[k] -= kStep;
                after[k] += kStep;
                parts[static_cast<std::size_t>(k)][i] = static_cast<float>((f_(after) - f_(before)) / (2 * kStep));
            }
        }
    }
    fields::Bounds boundsIn(const fields::Box& region) const override {
        const double middle = f_(region.center());
        if (std::isnan(middle) || std::isnan(lipschitz_)) return {-INFINITY, INFINITY, false};
        const double reach = 0.5 * lipschitz_ * glm::length(region.max - region.min) + 1e-5;
        return {middle - reach, middle + reach, true};
    }
    fields::EvaluationCost cost() const override { return {}; }
    std::size_t memory() const override { return sizeof *this; }

  private:
    static glm::dvec4 point(const fields::PointBatch& points, std::size_t i) {
        return {points.x[i], points.y[i], points.z[i], points.w[i]};
    }

    Callable f_;
    double lipschitz_;
};

inline fields::Field testField(TestFunction::Callable f, double lipschitz, const fields::Box& box) {
    return fields::makeField("test", std::make_shared<TestFunction>(std::move(f), lipschitz), box);
}

/// The measurements of the body that the triangles of one level enclose.
struct Measure {
    double volume = 0;
    glm::dvec3 moment{0};        ///< the volume times the centroid
    long euler = 0;              ///< the Euler characteristic of the surface
    std::size_t components = 0;  ///< the number of connected components of the surface
    std::size_t unpaired = 0;    ///< the number of directed edges that occur more than once, or whose opposite edge
                                 ///< does not occur exactly once
};

inline Measure measure(const SliceSurface& surface, std::size_t level) {
    Measure result;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    // Each point refers to a point of the same component with a smaller number, or to itself.
    std::map<std::uint32_t, std::uint32_t> points;
    const auto rootOf = [&](std::uint32_t point) {
        while (points.at(point) != point) point = points.at(point) = points.at(points.at(point));
        return point;
    };
    long triangles = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.level(t) != level) continue;
        ++triangles;
        const auto& corners = surface.triangles[t];
        const glm::dvec3 a(surface.points[corners[0]]), b(surface.points[corners[1]]), c(surface.points[corners[2]]);
        const double volume = glm::dot(a, glm::cross(b, c)) / 6;
        result.volume += volume;
        result.moment += volume * (a + b + c) / 4.0;
        for (std::size_t i = 0; i < 3; ++i) {
            ++edges[{corners[i], corners[(i + 1) % 3]}];
            points.try_emplace(corners[i], corners[i]);
        }
        for (std::size_t i = 0; i < 2; ++i) {
            const auto [low, high] = std::minmax({rootOf(corners[i]), rootOf(corners[i + 1])});
            points[high] = low;
        }
    }
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end() || opposite->second != 1) ++result.unpaired;
    }
    for (const auto& [point, next] : points) result.components += point == next ? 1 : 0;
    result.euler = static_cast<long>(points.size()) - static_cast<long>(edges.size()) / 2 + triangles;
    return result;
}

}  // namespace oval4d::slicing
