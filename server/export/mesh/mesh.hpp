#pragma once
// Triangle meshes, and a grid of coordinates that file formats in millimeters represent exactly.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace oval4d::exports {

/// The entry in Mesh::cells for a triangle without a cell.
inline constexpr std::uint32_t kNoCell = 0xffffffffU;

/// A triangle mesh. Seen from outside, its triangles are counterclockwise.
struct Mesh {
    std::vector<glm::dvec3> points;                       ///< positions in millimeters
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three indices into `points` for each triangle
    /// For each triangle: the cell of the object from which it was cut, or kNoCell.
    std::vector<std::uint32_t> cells;
    /// For the surface of a field: the color of each point, and the value of the function there. Otherwise, both lists
    /// are empty.
    std::vector<scene::Color> pointColors;
    std::vector<float> pointValues;

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t cell) {
        triangles.push_back({a, b, c});
        cells.push_back(cell);
    }
};

/// A body in an exported file, with its name, color and position.
struct PlacedMesh {
    std::string name;
    Mesh mesh;
    scene::Color color;  ///< color of triangles without a cell, and of points without a color
    /// The position, in the file, of the origin of the mesh's coordinates, in millimeters. Lies on the RoundingGrid.
    glm::dvec3 at{0};
};

/// A grid to which coordinates are rounded: multiples of a power of two. File formats in millimeters represent such
/// numbers exactly, as decimals, as 32-bit floats or, with a grid for doubles, as 64-bit floats. So two points are
/// equal in a file if and only if their rounded coordinates are equal. A mesh stays closed in programs that identify
/// points by their coordinates.
class RoundingGrid {
  public:
    /// Chooses the step: the smallest power of two that is at least size / 2^17 and at least extent / 2^23. `size` is
    /// the diameter of the object's circumscribed sphere, and `extent` the largest absolute coordinate in the file,
    /// both in millimeters.
    RoundingGrid(double size, double extent);
    /// Returns a much finer grid, for formats with 64-bit floats. The step of this grid is the smallest power of two
    /// that is at least size / 2^40 and at least extent / 2^50.
    static RoundingGrid forDoublePrecision(double size, double extent);

    /// Returns the distance between neighboring grid points in millimeters, a power of two.
    double step() const { return step_; }
    /// Returns the grid point that is nearest to `point`.
    glm::dvec3 snap(const glm::dvec3& point) const;

  private:
    double step_;
};

/// Returns whether the mesh is a closed 2-manifold: every edge belongs to exactly two triangles, which traverse it in
/// opposite directions, and the triangles around every point form one ring.
bool isClosedManifold(const Mesh& mesh);

/// Returns the volume that the mesh encloses, in cubic millimeters. Negative if the triangles face inward.
double volumeOf(const Mesh& mesh);

/// Returns whether the body is thick enough to keep its shape on the grid. The mean thickness of the body (its volume
/// divided by half its surface area) must exceed 4 grid steps.
bool isThickEnough(const Mesh& mesh, const RoundingGrid& grid);

/// Returns the normal of a triangle of the mesh, with a length of twice the triangle's area.
glm::dvec3 doubleAreaNormalOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);

/// Returns a unit normal for each corner of each triangle: the direction of the mean normal of the triangles around the
/// corner's point, weighted by their areas. Triangles whose normals differ by more than 40° from the normal of the
/// corner's triangle are left out. The result is 0 for triangles without area.
std::vector<std::array<glm::dvec3, 3>> smoothNormals(const Mesh& mesh);

/// An axis-aligned bounding box, which is empty at first.
struct BoundingBox {
    glm::dvec3 min{1e300}, max{-1e300};
    void include(const glm::dvec3& point);
    glm::dvec3 size() const { return max - min; }
};
/// Returns the bounding box of the mesh's points.
BoundingBox boundingBoxOf(const Mesh& mesh);

}  // namespace oval4d::exports
