#pragma once
// Helpers of tests of what the projection of an object leaves out because it lies behind its cells.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "slicing/projector.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {

/// A box with sides parallel to the axes.
struct TestBox {
    glm::dvec4 least, most;
};

inline TestBox cubeAt(const glm::dvec4& center, double halfEdge) { return {center - halfEdge, center + halfEdge}; }

/// Returns boxes as one polytope. Box i has the vertices 16 i … 16 i + 15, the 2-faces 24 i … 24 i + 23 and 8 cells.
inline polytopes::Polytope boxes(const std::vector<TestBox>& all) {
    const support::Polygon square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const polytopes::Polytope tesseract = support::product(square, square);
    std::vector<glm::dvec4> vertices;
    geometry::JaggedArray faces, cells;
    for (const TestBox& box : all) {
        const auto firstVertex = static_cast<std::uint32_t>(vertices.size());
        const auto firstFace = static_cast<std::uint32_t>(faces.size());
        const auto shifted = [](std::span<const std::uint32_t> row, std::uint32_t by) {
            std::vector<std::uint32_t> out(row.begin(), row.end());
            for (std::uint32_t& item : out) item += by;
            return out;
        };
        for (const glm::dvec4& v : tesseract.vertices) {
            glm::dvec4 corner(0);
            for (int i = 0; i < 4; ++i) corner[i] = v[i] > 0 ? box.most[i] : box.least[i];
            vertices.push_back(corner);
        }
        for (std::size_t f = 0; f < tesseract.faces.size(); ++f) faces.add(shifted(tesseract.faces[f], firstVertex));
        for (std::size_t c = 0; c < tesseract.cells.size(); ++c) cells.add(shifted(tesseract.cells[c], firstFace));
    }
    return polytopes::makePolytope("boxes", std::move(vertices), std::move(faces), std::move(cells));
}

/// Returns the projection of an object, without sections.
inline SliceSet projectionWith(Projector& projector, const polytopes::Polytope& p, const geometry::Rotation& turn,
                               const Projector::ProjectionOptions& options) {
    SliceSet slices, parts;
    std::vector<std::uint32_t> faceCells;
    Slicer().sliceWithoutSurfaces(support::objectOf(p), turn, {0, 1, 1}, slices);
    projector.project(support::objectOf(p), turn, slices, options, parts, faceCells);
    return parts;
}

/// The drawn elements of an object: the vertices with balls, the edges of which a part is drawn, and the 2-faces.
struct Drawn {
    std::set<std::uint32_t> vertices, edges, faces;
    bool operator==(const Drawn&) const = default;
};

inline Drawn drawnWith(Projector& projector, const polytopes::Polytope& p, const geometry::Rotation& turn,
                       const Projector::ProjectionOptions& options) {
    const SliceSet parts = projectionWith(projector, p, turn, options);
    const auto vertices = static_cast<std::uint32_t>(p.edges.size()),
               edges = static_cast<std::uint32_t>(p.faces.size()), faces = static_cast<std::uint32_t>(p.cells.size());
    Drawn out;
    for (std::size_t v = 0; v < parts.vertices.size(); ++v) {
        if (parts.hasBall(v)) out.vertices.insert(parts.vertexSource[v] - vertices);
    }
    for (const std::uint32_t source : parts.edgeSource) out.edges.insert(source - edges);
    for (const std::uint32_t source : parts.faceSource) out.faces.insert(source - faces);
    return out;
}

inline Drawn drawn(const polytopes::Polytope& p, const geometry::Rotation& turn,
                   const Projector::ProjectionOptions& options) {
    Projector projector;
    return drawnWith(projector, p, turn, options);
}

/// The drawn parts of each edge: the ends of their bars in the projection.
using Bars = std::multimap<std::uint32_t, std::array<glm::dvec3, 2>>;

inline Bars barsOf(const polytopes::Polytope& p, const geometry::Rotation& turn,
                   const Projector::ProjectionOptions& options) {
    Projector projector;
    const SliceSet parts = projectionWith(projector, p, turn, options);
    Bars bars;
    for (std::size_t e = 0; e < parts.edges.size(); ++e) {
        const auto& [a, b] = parts.edges[e];
        bars.emplace(parts.edgeSource[e] - static_cast<std::uint32_t>(p.faces.size()),
                     std::array{parts.vertices[a], parts.vertices[b]});
    }
    return bars;
}

/// Returns whether a bar of an edge contains a point of this edge, which is projected to `place`.
inline bool isDrawnAt(const Bars& bars, std::uint32_t edge, const glm::dvec3& place) {
    const auto [first, end] = bars.equal_range(edge);
    return std::any_of(first, end, [&](const auto& bar) {
        const auto& [from, to] = bar.second;
        return glm::distance(from, place) + glm::distance(place, to) < glm::distance(from, to) + 1e-9;
    });
}

/// Returns the winding number of the boundary of a cell around a point, both projected, as a sum of solid angles: see
/// A. Van Oosterom and J. Strackee, "The solid angle of a plane triangle", 1983.
inline int windingBySolidAngle(const polytopes::Polytope& p, std::size_t cell, const std::vector<glm::dvec3>& projected,
                               const glm::dvec3& point) {
    double sum = 0;
    for (std::uint32_t at = p.cells.begin[cell]; at < p.cells.begin[cell + 1]; ++at) {
        const auto loop = p.faces[p.cells.items[at]];
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            const glm::dvec3 a = projected[loop[0]] - point, b = projected[loop[i]] - point,
                             c = projected[loop[i + 1]] - point;
            const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
            const double angle =
                2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                               la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
            sum += p.cellSigns[at] * angle;
        }
    }
    return static_cast<int>(std::lround(sum / (4 * std::numbers::pi)));
}

/// Looks along rays at points of the elements of a polytope, without the code under test.
class RayCaster {
  public:
    RayCaster(const polytopes::Polytope& p, const geometry::Rotation& turn, double inverseDistance)
        : p_(p), inverseDistance_(inverseDistance) {
        for (const glm::dvec4& v : p.vertices) {
            turned_.push_back(turn(v));
            projected_.push_back(ProjectionToHyperplane{inverseDistance}(turned_.back()));
        }
        findCellHyperplanes(support::objectOf(p), normals_, offsets_);
        for (glm::dvec4& normal : normals_) normal = turn(normal);
    }

    const glm::dvec4& vertex(std::uint32_t v) const { return turned_[v]; }

    /// Lets the cells of this type hide nothing.
    void hide(std::uint32_t type) { hidden_ = type; }

    /// Returns whether no cell but those in `own` is between the point and the eye.
    bool sees(const glm::dvec4& point, const std::set<std::uint32_t>& own) const {
        const bool perspective = inverseDistance_ > 0;
        const glm::dvec4 up(0, 0, 0, 1), way = perspective ? up / inverseDistance_ - point : up;
        const glm::dvec3 at = ProjectionToHyperplane{inverseDistance_}(point);
        for (std::uint32_t c = 0; c < p_.cells.size(); ++c) {
            const double speed = glm::dot(normals_[c], way);
            if (own.contains(c) || p_.typeOfCell[c] == hidden_ || speed == 0) continue;
            const double when = (offsets_[c] - glm::dot(normals_[c], point)) / speed;
            if (when > 1e-6 && windingBySolidAngle(p_, c, projected_, at) != 0) return false;
        }
        return true;
    }

  private:
    const polytopes::Polytope& p_;
    double inverseDistance_;
    std::vector<glm::dvec4> turned_, normals_;
    std::vector<glm::dvec3> projected_;
    std::vector<double> offsets_;
    std::optional<std::uint32_t> hidden_;
};

/// Returns the cells that contain each edge.
inline std::vector<std::set<std::uint32_t>> cellsOfEdges(const polytopes::Polytope& p) {
    std::vector<std::set<std::uint32_t>> out(p.edges.size());
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
        for (const std::uint32_t e : p.faceEdges[f]) out[e].insert(p.faceCells[f].begin(), p.faceCells[f].end());
    }
    return out;
}

}  // namespace oval4d::slicing
