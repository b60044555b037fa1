#include "export/mesh/solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>

#include "export/mesh/hull.hpp"
#include "export/mesh/outer_surface.hpp"

namespace oval4d::exports {

namespace {

using VertexLoop = std::vector<std::uint32_t>;

std::span<const std::uint32_t> cornersOf(const slicing::SliceSet& slices, std::uint32_t face) {
    return {slices.corners.data() + slices.cornerBegin[face], slices.cornerBegin[face + 1] - slices.cornerBegin[face]};
}

/// Returns the normal of a face, with a length of twice the face's area.
glm::dvec3 doubleAreaNormalOfFace(const slicing::SliceSet& slices, int i, std::uint32_t face) {
    const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
    const auto corners = cornersOf(slices, face);
    const glm::dvec3 base = points[corners[0]];
    glm::dvec3 normal(0);
    for (std::size_t c = 1; c + 1 < corners.size(); ++c)
        normal += glm::cross(points[corners[c]] - base, points[corners[c + 1]] - base);
    return normal;
}

/// Returns the unit normal of a face; zero if the face has no area.
glm::dvec3 unitNormalOfFace(const slicing::SliceSet& slices, int i, std::uint32_t face) {
    const glm::dvec3 normal = doubleAreaNormalOfFace(slices, i, face);
    const double length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3(0);
}

/// Returns whether the slice is convex: it lies on the inner side of every face, apart from rounding errors.
bool isConvex(const slicing::SliceSet& slices, int i, const ExportBudget& budget) {
    const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
    const std::size_t count = slices.vertexCount(i);
    double extent = 0;
    for (std::size_t v = 0; v < count; ++v) extent = std::max(extent, glm::distance(points[v], points[0]));
    constexpr double kFlat = 1e-7;
    for (std::uint32_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1]; ++f) {
        budget.checkTimeAndStop();
        const glm::dvec3 base = points[cornersOf(slices, f)[0]];
        glm::dvec3 normal = doubleAreaNormalOfFace(slices, i, f);
        // Skip a face with almost no area, because its normal is unreliable. Testing the neighboring faces is enough.
        if (glm::length(normal) < kFlat * extent * extent) continue;
        normal = glm::normalize(normal);
        for (std::size_t v = 0; v < count; ++v) {
            if (glm::dot(points[v] - base, normal) > kFlat * extent) return false;
        }
    }
    return true;
}

/// The vertices of a slice, in millimeters and rounded to the grid. Vertices that become equal are merged to one point.
class WeldedVertices {
  public:
    WeldedVertices(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid) {
        std::map<std::tuple<double, double, double>, std::uint32_t> known;
        for (std::uint32_t v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
            const glm::dvec3 point = grid.snap(slices.vertices[v] * scale);
            const auto [at, fresh] = known.try_emplace({point.x, point.y, point.z}, points_.size());
            if (fresh) points_.push_back(point);
            index_.push_back(at->second);
        }
    }
    /// Converts the corners of a face from indices of the slice's vertices to indices into points(). Leaves out edges
    /// of length zero.
    VertexLoop weldedLoop(std::span<const std::uint32_t> corners) const {
        VertexLoop out;
        for (const std::uint32_t corner : corners) {
            if (out.empty() || out.back() != index_[corner]) out.push_back(index_[corner]);
        }
        while (out.size() > 1 && out.back() == out.front()) out.pop_back();
        return out;
    }
    const std::vector<glm::dvec3>& points() const { return points_; }

  private:
    std::vector<glm::dvec3> points_;
    std::vector<std::uint32_t> index_;
};

/// Divides a convex loop into a fan of triangles around one corner, and adds them to `mesh` with the cell `cell`.
/// Chooses the corner for which the area of the smallest triangle is largest.
void triangulateConvexLoop(const VertexLoop& loop, std::uint32_t cell, Mesh& mesh, const ExportBudget& budget) {
    const std::size_t n = loop.size();
    std::size_t best = 0;
    double bestLeast = -1;
    for (std::size_t apex = 0; apex < n; ++apex) {
        budget.checkTimeAndStop();
        double least = 1e300;
        for (std::size_t c = 1; c + 1 < n; ++c) {
            const glm::dvec3 normal =
                doubleAreaNormalOf(mesh, {loop[apex], loop[(apex + c) % n], loop[(apex + c + 1) % n]});
            least = std::min(least, glm::dot(normal, normal));
        }
        if (least > bestLeast) {
            bestLeast = least;
            best = apex;
        }
    }
    for (std::size_t c = 1; c + 1 < n; ++c) mesh.add(loop[best], loop[(best + c) % n], loop[(best + c + 1) % n], cell);
}

Mesh convexSolid(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid,
                 const ExportBudget& budget) {
    const WeldedVertices welded(slices, i, scale, grid);
    Mesh mesh;
    mesh.points = welded.points();
    for (std::uint32_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1]; ++f) {
        const VertexLoop weldedLoop = welded.weldedLoop(cornersOf(slices, f));
        if (weldedLoop.size() > 2) triangulateConvexLoop(weldedLoop, slices.faceSource[f], mesh, budget);
    }
    return mesh;
}

/// Returns the convex hull of the points of `faces`, the rounded faces of a convex slice. The hull is needed if
/// vertices of the slice become equal on the grid, because two rounded faces may then share several edges. Each
/// triangle gets the cell of the slice face with the most similar normal.
Mesh convexHull(const slicing::SliceSet& slices, int i, const Mesh& faces, const RoundingGrid& grid,
                const ExportBudget& budget) {
    Mesh hull = convexHullOfGridPoints(faces.points, grid, &budget);
    std::vector<std::pair<glm::dvec3, std::uint32_t>> normals;
    for (std::uint32_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1]; ++f)
        normals.emplace_back(unitNormalOfFace(slices, i, f), slices.faceSource[f]);
    for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
        budget.checkTimeAndStop();
        const glm::dvec3 normal = doubleAreaNormalOf(hull, hull.triangles[t]);
        hull.cells[t] = std::ranges::max_element(normals, {}, [&](const auto& face) {
                            return glm::dot(face.first, normal);
                        })->second;
    }
    return hull;
}

}  // namespace

Mesh solidOf(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid,
             const ExportBudget& budget) {
    if (slices.faceCount(i) < 4) return {};
    if (isConvex(slices, i, budget)) {
        Mesh mesh = convexSolid(slices, i, scale, grid, budget);
        if (!isClosedManifold(mesh)) mesh = convexHull(slices, i, mesh, grid, budget);
        return isThickEnough(mesh, grid) ? mesh : Mesh{};
    }
    Mesh surface = outerSurfaceOf(slices, i, scale, grid, budget);
    return isThickEnough(surface, grid) ? surface : Mesh{};
}

}  // namespace oval4d::exports
