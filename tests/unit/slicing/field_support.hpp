#pragma once
// Test functions and fields, and measurements of closed surfaces.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "fields/array/array_function.hpp"
#include "fields/field.hpp"
#include "geometry/hyperplanes.hpp"
#include "geometry/rotation.hpp"
#include "slicing/surface_detail.hpp"
#include "slicing/surfaces/slice_surface.hpp"
#include "unit/slicing/directed_edges.hpp"

namespace oval4d::slicing {

/// Returns the settings of lattices whose cubes are 1/`cubes` as wide as the field's diameter, for all hyperplanes of
/// `planes`.
inline SurfaceDetail detailOf(const fields::Field& field, const geometry::Hyperplanes& planes, int cubes) {
    SurfaceDetail detail;
    detail.steps.assign(static_cast<std::size_t>(planes.count), 2 * field.circumradius / cubes);
    detail.secondValues = true;
    return detail;
}

/// A scalar function that calls a callable. The slope of the callable must be at most `lipschitz` everywhere.
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
    fields::ValueBounds boundsIn(const fields::Box& region) const override {
        const double middle = f_(region.center());
        if (std::isnan(middle) || std::isnan(lipschitz_)) return {-INFINITY, INFINITY, false};
        const double reach = 0.5 * lipschitz_ * glm::length(region.max - region.min) + 1e-5;
        return {middle - reach, middle + reach, true};
    }
    fields::EvaluationCost cost() const override { return {}; }
    std::size_t memoryBytes() const override { return sizeof *this; }

  private:
    static glm::dvec4 point(const fields::PointBatch& points, std::size_t i) {
        return {points.x[i], points.y[i], points.z[i], points.w[i]};
    }

    Callable f_;
    double lipschitz_;
};

/// Returns a field with the function `f`, whose slope is at most `lipschitz`, in the box `box`.
inline fields::Field testField(TestFunction::Callable f, double lipschitz, const fields::Box& box) {
    return fields::makeField("test", std::make_shared<TestFunction>(std::move(f), lipschitz), box);
}

/// Returns a field that is an array with `shape` samples along its axes. The samples are the values of `field` in its
/// box.
inline fields::Field sampledField(const fields::Field& field, const fields::Shape& shape) {
    const fields::Box& box = field.box;
    const auto at = [&](int axis, std::size_t i) {
        return static_cast<float>(box.min[axis] + (box.max[axis] - box.min[axis]) * static_cast<double>(i) /
                                                      static_cast<double>(shape[static_cast<std::size_t>(axis)] - 1));
    };
    const std::size_t row = shape[0];
    std::vector<float> samples(fields::sampleCount(shape)), x(row), y(row), z(row), w(row);
    for (std::size_t i = 0; i < row; ++i) x[i] = at(0, i);
    for (std::size_t n = 0; n < samples.size() / row; ++n) {
        std::ranges::fill(y, at(1, n % shape[1]));
        std::ranges::fill(z, at(2, n / shape[1] % shape[2]));
        std::ranges::fill(w, at(3, n / shape[1] / shape[2]));
        field.function->evaluate({x, y, z, w}, std::span(samples).subspan(n * row, row));
    }
    auto function =
        std::make_shared<const fields::ArrayFunction>(shape, box, fields::SampleStorage(std::move(samples)));
    fields::Field array = fields::makeField("array", function, box);
    array.array = function;
    return array;
}

/// Returns an array that has the values of `field` at `side` points along each axis of its box.
inline fields::Field sampledField(const fields::Field& field, std::size_t side) {
    return sampledField(field, fields::Shape{side, side, side, side});
}

/// Heat that spreads from two points, x = ±1 with y = z = 0, since the time w = 0, as a field and as an array. The
/// samples of the array lie so close together along w that the level is reached halfway between the points at nearly
/// the right time. At each moment, one of the samples lies there. The middle of the box does not lie there.
struct HeatKernels {
    static constexpr double kLevel = 5;
    fields::Box box{{-2.1, -1.1, -1.1, 0.06}, {2.3, 1.3, 1.2, 0.3}};
    fields::Field field = testField(
        [](const glm::dvec4& p) {
            const auto kernel = [&](double x) { return std::exp(-(x * x + p.y * p.y + p.z * p.z) / (4 * p.w)); };
            return std::pow(p.w, -1.5) * (kernel(p.x - 1) + kernel(p.x + 1));
        },
        1000, box);
    fields::Field array = sampledField(field, fields::Shape{45, 25, 24, 97});

    /// Returns the time at which the two regions with a temperature above kLevel merge.
    static double merging() {
        double below = 0.06, above = 1.0 / 6;  // halfway between the points, the temperature is highest at the time 1/6
        for (int i = 0; i < 60; ++i) {
            const double t = (below + above) / 2;
            (2 * std::pow(t, -1.5) * std::exp(-1 / (4 * t)) < kLevel ? below : above) = t;
        }
        return below;
    }
};

/// The measurements of the body that the triangles of one level enclose.
struct Measure {
    double volume = 0;
    glm::dvec3 moment{0};        ///< the volume times the centroid
    long euler = 0;              ///< the Euler characteristic of the surface
    std::size_t components = 0;  ///< the number of connected components of the surface
    /// The number of directed edges that occur more than once, or whose opposite edge does not occur exactly once.
    std::size_t unpaired = 0;
};

/// Measures the body that the triangles of the level with the index `level` enclose, without the code under test.
inline Measure measure(const SliceSurface& surface, std::size_t level) {
    Measure result;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // A union–find structure: each point refers to a point of the same component with a smaller number, or to itself.
    constexpr std::uint32_t kUnused = ~0U;
    std::vector<std::uint32_t> points(surface.points.size(), kUnused);
    const auto rootOf = [&](std::uint32_t point) {
        while (points[point] != point) point = points[point] = points[points[point]];
        return point;
    };
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.levelIndex(t) != level) continue;
        const auto& corners = triangles.emplace_back(surface.triangles[t]);
        const glm::dvec3 a(surface.points[corners[0]]), b(surface.points[corners[1]]), c(surface.points[corners[2]]);
        const double volume = glm::dot(a, glm::cross(b, c)) / 6;
        result.volume += volume;
        result.moment += volume * (a + b + c) / 4.0;
        for (const std::uint32_t corner : corners) points[corner] = std::min(points[corner], corner);
        for (std::size_t i = 0; i < 2; ++i) {
            const auto [low, high] = std::minmax({rootOf(corners[i]), rootOf(corners[i + 1])});
            points[high] = low;
        }
    }
    const support::DirectedEdges edges(triangles);
    result.unpaired = edges.unpaired();
    long used = 0;
    for (std::uint32_t point = 0; point < points.size(); ++point) {
        used += points[point] != kUnused ? 1 : 0;
        result.components += points[point] == point ? 1 : 0;
    }
    result.euler = used - static_cast<long>(edges.different()) / 2 + static_cast<long>(triangles.size());
    return result;
}

}  // namespace oval4d::slicing
