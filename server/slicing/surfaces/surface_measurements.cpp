#include "slicing/surfaces/surface_measurements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

namespace oval4d::slicing {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// The connected parts of a surface, as a union–find structure on the surface's points.
class ConnectedComponents {
  public:
    ConnectedComponents(std::size_t points, std::span<const Triangle> triangles) : parents_(points) {
        std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
        for (const auto& [a, b, c] : triangles) {
            unite(a, b);
            unite(b, c);
        }
    }
    /// Returns the point that represents the connected part to which `point` belongs.
    std::uint32_t representativeOf(std::uint32_t point) {
        while (parents_[point] != point) point = parents_[point] = parents_[parents_[point]];
        return point;
    }

  private:
    void unite(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t first = representativeOf(a), second = representativeOf(b);
        parents_[std::max(first, second)] = std::min(first, second);
    }

    std::vector<std::uint32_t> parents_;
};

struct VolumeAndMoment {
    double volume = 0;
    // The volume of a connected part times its centroid, relative to the point that represents the part.
    glm::dvec3 moment{0};
};

template <typename Point>
SurfaceMeasurements measureTriangles(std::span<const Point> points, std::span<const Triangle> triangles,
                                     std::size_t firstCap) {
    SurfaceMeasurements result;
    ConnectedComponents connected(points.size(), triangles);
    std::vector<VolumeAndMoment> parts(points.size());
    std::vector<bool> used(points.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& corners = triangles[t];
        const std::uint32_t root = connected.representativeOf(corners[0]);
        // Coordinates are relative to a point of the connected part. So rounding errors are small even if the volume of
        // the part is small.
        const glm::dvec3 base(points[root]);
        const glm::dvec3 a = glm::dvec3(points[corners[0]]) - base, b = glm::dvec3(points[corners[1]]) - base,
                         c = glm::dvec3(points[corners[2]]) - base;
        const double volume = glm::dot(a, glm::cross(b, c)) / 6;
        parts[root].volume += volume;
        parts[root].moment += volume * (a + b + c) / 4.0;
        (t < firstCap ? result.area : result.capArea) += glm::length(glm::cross(b - a, c - a)) / 2;
        for (const std::uint32_t corner : corners) used[corner] = true;
    }
    glm::dvec3 moment(0);
    for (std::size_t point = 0; point < points.size(); ++point) {
        const VolumeAndMoment& part = parts[point];
        if (part.volume > 0) ++result.components;
        result.volume += part.volume;
        moment += part.moment + part.volume * glm::dvec3(points[point]);
    }
    if (result.volume > 0) result.centroid = moment / result.volume;
    // The Euler characteristic is V − E + F. Each triangle has three edges, and each edge belongs to two triangles. So
    // E = 3F / 2, and the Euler characteristic is V − F / 2.
    result.euler = static_cast<long>(std::ranges::count(used, true)) - static_cast<long>(triangles.size() / 2);
    return result;
}

/// The triangles of one level of a slice.
struct LevelTriangles {
    std::span<const Triangle> all;
    std::size_t firstCap;

    LevelTriangles(const SliceSurface& surface, std::size_t level) {
        const auto first = std::ranges::find_if(surface.levelAndCap, [&](std::uint8_t levelAndCap) {
            return (levelAndCap & ~SliceSurface::kCap) == static_cast<int>(level);
        });
        const auto cap =
            std::find(first, surface.levelAndCap.end(), static_cast<std::uint8_t>(level | SliceSurface::kCap));
        const auto end = std::find_if(first, surface.levelAndCap.end(), [&](std::uint8_t levelAndCap) {
            return (levelAndCap & ~SliceSurface::kCap) != static_cast<int>(level);
        });
        const auto index = [&](auto at) { return static_cast<std::size_t>(at - surface.levelAndCap.begin()); };
        all = std::span(surface.triangles).subspan(index(first), index(end) - index(first));
        firstCap = std::min(index(cap), index(end)) - index(first);
    }
};

}  // namespace

SurfaceMeasurements measureSurface(const SliceSurface& surface, std::size_t level) {
    const LevelTriangles triangles(surface, level);
    return measureTriangles(std::span(surface.points), triangles.all, triangles.firstCap);
}

SurfaceComponents findConnectedParts(const SliceSurface& surface, std::size_t level) {
    const LevelTriangles triangles(surface, level);
    ConnectedComponents connected(surface.points.size(), triangles.all);
    SurfaceComponents result;
    result.ofPoint.assign(surface.points.size(), SurfaceComponents::kNone);
    std::vector<long> triangleCounts;
    for (const auto& corners : triangles.all) {
        const std::uint32_t root = connected.representativeOf(corners[0]);
        std::uint32_t& part = result.ofPoint[root];
        if (part == SurfaceComponents::kNone) {
            part = static_cast<std::uint32_t>(result.parts.size());
            result.parts.emplace_back();
            triangleCounts.push_back(0);
        }
        const glm::dvec3 base(surface.points[root]);
        const auto corner = [&](std::size_t i) { return glm::dvec3(surface.points[corners[i]]) - base; };
        ++triangleCounts[part];
        result.parts[part].volume += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6;
        for (const std::uint32_t point : corners) result.ofPoint[point] = part;
    }
    for (const std::uint32_t part : result.ofPoint) {
        if (part != SurfaceComponents::kNone) ++result.parts[part].euler;
    }
    for (std::size_t i = 0; i < result.parts.size(); ++i) result.parts[i].euler -= triangleCounts[i] / 2;
    return result;
}

SurfaceMeasurements measureSurface(const ClosedSurface& surface) {
    return measureTriangles(std::span(surface.points), std::span(surface.triangles), surface.firstCap);
}

std::optional<double> meanOnSurface(const ClosedSurface& surface, std::span<const float> values) {
    double area = 0, sum = 0;
    for (std::size_t t = 0; t < surface.firstCap; ++t) {
        const auto& [a, b, c] = surface.triangles[t];
        const glm::dvec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
        const double mean = (double{values[a]} + values[b] + values[c]) / 3,
                     own = glm::length(glm::cross(q - p, r - p));
        if (!std::isfinite(mean)) continue;
        area += own;
        sum += own * mean;
    }
    return area > 0 ? std::optional(sum / area) : std::nullopt;
}

}  // namespace oval4d::slicing
