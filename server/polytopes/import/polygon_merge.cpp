#include "polytopes/import/polygon_merge.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "geometry/index.hpp"
#include "polytopes/import/flat.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;

// Returns the boundary loop of triangles that form a disk. Returns an empty list if they do not form a disk.
std::vector<std::uint32_t> boundaryLoopOf(std::span<const std::uint32_t> group, std::span<const Triangle> all) {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t t : group) {
        triangles.push_back(all[t]);
        corners.insert(corners.end(), all[t].begin(), all[t].end());
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    const std::vector<TriangleEdge> triangleEdges =
        sortedTriangleEdges(triangles, [](const Triangle& t) -> const Triangle& { return t; });
    std::unordered_map<std::uint32_t, std::array<std::uint32_t, 2>> next;
    std::size_t edges = 0;
    for (std::size_t i = 0, end = 0; i < triangleEdges.size(); i = end) {
        while (end < triangleEdges.size() && triangleEdges[end].edge == triangleEdges[i].edge) ++end;
        ++edges;
        if (end - i > 2) return {};
        if (end - i == 2) continue;
        const auto [a, b] = triangleEdges[i].edge;
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
            auto& both = next.try_emplace(from, std::array{kNone, kNone}).first->second;
            if (both[1] != kNone) return {};
            both[both[0] == kNone ? 0 : 1] = to;
        }
    }
    if (corners.size() + triangles.size() != edges + 1) return {};
    std::vector<std::uint32_t> loop{next.begin()->first};
    for (std::uint32_t before = kNone, at = loop[0];;) {
        const auto& both = next.at(at);
        const std::uint32_t to = both[0] == before ? both[1] : both[0];
        if (to == kNone) return {};
        before = at;
        at = to;
        if (at == loop[0]) break;
        loop.push_back(at);
        if (loop.size() > next.size()) return {};
    }
    if (loop.size() != next.size()) return {};
    return loop;
}

// Returns whether a polygon turns the same way at all corners, within the error bounds of the corners. The polygon has
// the vertex loop `loop` and lies in `plane`.
bool isConvex(std::span<const std::uint32_t> loop, const PlaneThroughPoints& plane, std::span<const glm::dvec4> points,
              const HullFrame& frame) {
    std::vector<glm::dvec2> places;
    for (const std::uint32_t v : loop) {
        const auto along = plane.project(points[v]);
        places.emplace_back(along[0], along[1]);
    }
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    double area = 0;
    for (std::size_t i = 1; i + 1 < places.size(); ++i) area += cross(places[i] - places[0], places[i + 1] - places[0]);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec2 before = places[i];
        const glm::dvec2 corner = places[(i + 1) % places.size()] - before;
        const glm::dvec2 across = places[(i + 2) % places.size()] - before;
        const double length = glm::length(across);
        if (!(length > 0)) return false;
        const double out = cross(corner, across) / length * (area < 0 ? -1 : 1);
        const glm::dvec4 direction = (across.y * plane.basisVector(0) - across.x * plane.basisVector(1)) / length;
        if (out < -2 * frame.errorBound(direction)) return false;
    }
    return true;
}

}  // namespace

void addMergedPolygons(std::span<const Triangle> triangles, std::span<const glm::dvec4> points, const HullFrame& frame,
                       geometry::JaggedArray& faces) {
    const std::vector<TriangleEdge> triangleEdges =
        sortedTriangleEdges(triangles, [](const Triangle& t) -> const Triangle& { return t; });
    std::vector<std::array<std::uint32_t, 3>> beside(triangles.size(), {kNone, kNone, kNone});
    for (std::size_t i = 0, end = 0; i < triangleEdges.size(); i = end) {
        while (end < triangleEdges.size() && triangleEdges[end].edge == triangleEdges[i].edge) ++end;
        if (end - i != 2) continue;
        const auto join = [&](std::uint32_t from, std::uint32_t to) {
            *std::find(beside[from].begin(), beside[from].end(), kNone) = to;
        };
        join(triangleEdges[i].triangle, triangleEdges[i + 1].triangle);
        join(triangleEdges[i + 1].triangle, triangleEdges[i].triangle);
    }
    std::vector<double> areas;
    for (const Triangle& triangle : triangles)
        areas.push_back(PlaneThroughPoints(triangle, points).parallelotopeVolume());
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return areas[a] > areas[b]; });
    std::vector<bool> done(triangles.size(), false);
    std::vector<bool> taken;
    const auto collect = [&](std::uint32_t seed, const PlaneThroughPoints& plane) {
        taken.assign(triangles.size(), false);
        taken[seed] = true;
        std::vector<std::uint32_t> group{seed};
        for (std::size_t at = 0; at < group.size(); ++at) {
            for (const std::uint32_t t : beside[group[at]]) {
                if (t == kNone || taken[t] || done[t]) continue;
                const Triangle& corners = triangles[t];
                if (!std::all_of(corners.begin(), corners.end(),
                                 [&](std::uint32_t v) { return plane.contains(points[v], frame); })) {
                    continue;
                }
                taken[t] = true;
                group.push_back(t);
            }
        }
        return group;
    };
    const auto cornersOf = [&](std::span<const std::uint32_t> group) {
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t t : group) corners.insert(corners.end(), triangles[t].begin(), triangles[t].end());
        return corners;
    };
    for (const std::uint32_t seed : order) {
        if (done[seed]) continue;
        PlaneThroughPoints plane(triangles[seed], points);
        const auto collectIn = [&](const PlaneThroughPoints& flat) { return collect(seed, flat); };
        auto group = growAndRefit(plane, triangles[seed], collectIn, cornersOf, points, frame);
        std::vector<std::uint32_t> loop;
        if (group.size() > 1) loop = boundaryLoopOf(group, triangles);
        if (loop.empty() || !isConvex(loop, plane, points, frame)) {
            group = {seed};
            loop.assign(triangles[seed].begin(), triangles[seed].end());
        }
        for (const std::uint32_t t : group) done[t] = true;
        faces.add(loop);
    }
}

}  // namespace oval4d::polytopes
