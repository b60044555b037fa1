#pragma once
// What the tests share of geometry: rotations, subjects, single slices, volumes.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "geometry/catalogue.hpp"
#include "geometry/slicer.hpp"

namespace oval4d::geometry::support {

/// One of the catalogue, kept until the end: the catalogue itself keeps the latest only.
inline const Polytope& named(std::string_view name) {
    static std::map<std::string, std::shared_ptr<const Polytope>, std::less<>> kept;
    auto& polytope = kept[std::string(name)];
    if (!polytope) polytope = polytopeOf(*findEntry(name));
    return *polytope;
}

inline Rotation randomRotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto quaternion = [&] { return glm::dquat(normal(random), normal(random), normal(random), normal(random)); };
    const glm::dquat left = quaternion();
    return {left, quaternion()};
}

/// The rotation that turns `direction` onto the w axis.
inline Rotation ontoW(const glm::dvec4& direction) {
    return {glm::conjugate(glm::normalize(glm::dquat(direction.w, direction.x, direction.y, direction.z))),
            glm::dquat(1, 0, 0, 0)};
}

using Polygon = std::vector<glm::dvec2>;

/// The Cartesian product of a polygon in xy and one in zw: its cells are prisms over the one and over the other.
inline Polytope product(const Polygon& p, const Polygon& q) {
    const auto n = static_cast<std::uint32_t>(p.size());
    const auto m = static_cast<std::uint32_t>(q.size());
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return (i % n) * m + j % m; };
    std::vector<glm::dvec4> vertices;
    for (const auto& a : p) {
        for (const auto& b : q) vertices.emplace_back(a, b);
    }
    Lists faces;  // n·m squares, then m copies of p, then n copies of q
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            faces.add(std::array{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    std::vector<std::uint32_t> loop;
    for (std::uint32_t j = 0; j < m; ++j) {
        loop.clear();
        for (std::uint32_t i = 0; i < n; ++i) loop.push_back(vertex(i, j));
        faces.add(loop);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        loop.clear();
        for (std::uint32_t j = 0; j < m; ++j) loop.push_back(vertex(i, j));
        faces.add(loop);
    }
    Lists cells;
    for (std::uint32_t j = 0; j < m; ++j) {
        loop = {n * m + j, n * m + (j + 1) % m};
        for (std::uint32_t i = 0; i < n; ++i) loop.push_back(i * m + j);
        cells.add(loop);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        loop = {n * m + m + i, n * m + m + (i + 1) % n};
        for (std::uint32_t j = 0; j < m; ++j) loop.push_back(i * m + j);
        cells.add(loop);
    }
    return makePolytope("product", std::move(vertices), std::move(faces), std::move(cells));
}

/// A 4OFF file such as people write, with a wrong number of edges.
inline constexpr const char* kPentachoron = R"(#before the header
4OFF# the edges below are wrong on purpose
5 10 7 5
+1 1 1 -.4472136 # glued comments, signs, few digits
1e0 -1 -1 -.4472136 255 0 0
-1 1 -1 -.4472136

-1	-1 1 -.4472136   
0 0 0 1.7888544
3 0 1 2 0.5 0.5 0.5
3 0 1 3 12 200 7 255
3 0 1 4#
3 0 2 3
3 0 2 4
3 0 3 4
3 1 2 3
3 1 2 4
3 1 3 4
3 2 3 4
4 0 1 3 6 255 0 0
4 0 2 4 7
4 1 2 5 8
4 3 4 5 9
4 6 7 8 9
# the end)";

inline glm::dvec4 centreOfCell(const Polytope& p, std::size_t cell) {
    glm::dvec4 sum(0);
    double count = 0;
    for (const auto f : p.cells[cell]) {
        for (const auto v : p.faces[f]) {
            sum += p.vertices[v];
            ++count;
        }
    }
    return sum / count;
}

/// One slice at any w.
inline SliceSet cutAt(const Polytope& p, const Rotation& orientation, double w) {
    SliceSet out;
    Slicer slicer;
    const bool zero = std::abs(w) < 1e-300;
    slicer.slice(p, orientation, {zero ? 0 : w > 0 ? 1 : -1, 1, zero ? 1 : std::abs(w)}, out);
    return out;
}

inline glm::dvec3 corner(const SliceSet& s, int slice, std::uint32_t at) {
    return s.vertices[s.vertexBegin[slice] + s.corners[at]];
}

/// Signed; where a slice covers a place more than once, so does its volume.
inline double volumeOf(const SliceSet& s, int slice) {
    double sum = 0;
    for (std::uint32_t f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        for (std::uint32_t i = s.cornerBegin[f] + 1; i + 1 < s.cornerBegin[f + 1]; ++i) {
            sum +=
                glm::dot(corner(s, slice, s.cornerBegin[f]), glm::cross(corner(s, slice, i), corner(s, slice, i + 1))) /
                6;
        }
    }
    return sum;
}

/// The integral of the slices' volumes over w. Between two vertex levels the volume of the section is a cubic in w,
/// which Simpson's rule integrates exactly: the sections at the levels themselves, all degenerate, must be right too.
inline double hypervolumeBySlices(const Polytope& p, const Rotation& orientation) {
    std::vector<double> levels;
    for (const auto& v : p.vertices) levels.push_back(orientation(v).w);
    std::sort(levels.begin(), levels.end());
    const auto volume = [&](double w) { return volumeOf(cutAt(p, orientation, w), 0); };
    double sum = 0;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
        const double a = levels[i];
        const double b = levels[i + 1];
        if (b - a < 1e-7) continue;
        sum += (b - a) / 6 * (volume(a) + 4 * volume((a + b) / 2) + volume(b));
    }
    return sum;
}

}  // namespace oval4d::geometry::support
