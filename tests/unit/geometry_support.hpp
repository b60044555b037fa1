#pragma once
// What the tests of the slicer share: rotations, single slices, volumes.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "geometry/slicer.hpp"

namespace oval4d::geometry::support {

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
