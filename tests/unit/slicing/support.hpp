#pragma once
// Helpers for tests of slices: objects, single slices and their volumes.

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "polytopes/construction/coxeter.hpp"
#include "slicing/cell_complex_slicer.hpp"
#include "slicing/object.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::support {

/// Returns an Object that refers to `polytope`. `polytope` must outlive the Object.
inline slicing::Object objectOf(const polytopes::Polytope& polytope) {
    return slicing::PolytopePtr(slicing::PolytopePtr(), &polytope);
}

/// Returns the rectified 5-cell. Its cells of type 0 are octahedra, and those of type 1 are tetrahedra.
inline polytopes::Polytope rectifiedFiveCell() {
    const polytopes::DiagramBranch three{3, 1};
    const auto diagram = polytopes::CoxeterDiagram::linear(three, three, three, {false, true, false, false});
    auto polytope = polytopes::wythoffConstruction("rectified 5-cell", diagram, polytopes::mirrorsOf(diagram));
    polytope.cellTypes = {{"octahedron"}, {"tetrahedron"}};
    for (std::size_t c = 0; c < polytope.cells.size(); ++c)
        polytope.typeOfCell[c] = polytope.cells[c].size() == 8 ? 0 : 1;
    return polytope;
}

/// Returns the slice at `w` of `p`, rotated by `orientation`, as the only slice of a set.
inline slicing::SliceSet cutAt(const polytopes::Polytope& p, const geometry::Rotation& orientation, double w) {
    slicing::SliceSet out;
    slicing::CellComplexSlicer slicer;
    const bool zero = std::abs(w) < 1e-300;
    slicer.slice(p, orientation, {zero ? 0 : w > 0 ? 1 : -1, 1, zero ? 1 : std::abs(w)}, out);
    return out;
}

/// Returns the position of a corner of slice number `slice`. `at` is the index of the corner in SliceSet::corners.
inline glm::dvec3 corner(const slicing::SliceSet& s, int slice, std::uint32_t at) {
    return s.vertices[s.vertexBegin[slice] + s.corners[at]];
}

/// Returns the signed volume of slice number `slice`: the integral of the winding number of its faces.
inline double volumeOf(const slicing::SliceSet& s, int slice) {
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

/// Returns the hypervolume of `p` as the integral over w of the volumes of its slices. Between the w of two neighboring
/// vertices, the volume of the section is a cubic polynomial in w, which Simpson's rule integrates exactly. The rule
/// also evaluates the degenerate sections through vertices. Therefore the result is correct only if these sections are
/// correct, too.
inline double hypervolumeBySlices(const polytopes::Polytope& p, const geometry::Rotation& orientation) {
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

}  // namespace oval4d::support
