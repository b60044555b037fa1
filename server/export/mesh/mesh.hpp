#pragma once
// Triangle meshes, and the grid of coordinates that every file format in millimeters represents exactly.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace oval4d::exports {

/// The entry of Mesh::cells for a triangle that belongs to no cell.
inline constexpr std::uint32_t kNoCell = 0xffffffffU;

/// A triangle mesh. Its triangles are counterclockwise seen from outside.
struct Mesh {
    std::vector<glm::dvec3> points;                       ///< millimeters
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `points`
    std::vector<std::uint32_t> cells;                     ///< per triangle: the cell from which it was cut, or kNoCell
    /// For the surface of a field: the color of each point, and the value of the function at each point. Otherwise both
    /// lists are empty.
    std::vector<scene::Color> pointColors;
    std::vector<float> pointValues;

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t cell) {
        triangles.push_back({a, b, c});
        cells.push_back(cell);
    }
};

/// One body of a file.
struct PlacedMesh {
    std::string name;
    Mesh mesh;
    scene::Color color;  ///< the color of triangles without a cell and of points without a color
    glm::dvec3 at{0};    ///< the position of the mesh's origin in the file, in millimeters; lies on the grid
};

/// Rounds coordinates to multiples of a power of two, so that file formats in millimeters represent them exactly, as
/// decimals, as 32-bit floats or, with a grid for doubles, as 64-bit floats. Therefore two points are equal in a file
/// if and only if their rounded coordinates are equal, and a mesh remains closed for a program that identifies points
/// by their coordinates.
class RoundingGrid {
  public:
    /// Chooses the step: the smallest power of two that is at least both size / 2^17 and extent / 2^23. `size` is the
    /// diameter of the object's circumscribed sphere and `extent` the largest absolute coordinate in the file, both in
    /// millimeters.
    RoundingGrid(double size, double extent);
    /// Returns a grid for formats with 64-bit floats, which is much finer: its step is the smallest power of two that
    /// is at least both size / 2^40 and extent / 2^50.
    static RoundingGrid forDoubles(double size, double extent);

    /// Returns the distance between neighboring grid points in millimeters, a power of two.
    double step() const { return step_; }
    /// Returns the nearest grid point.
    glm::dvec3 snap(const glm::dvec3& point) const;

  private:
    double step_;
};

/// Returns whether the mesh is a closed 2-manifold: every edge belongs to exactly two triangles, which traverse it in
/// opposite directions, and the triangles around every point form one ring.
bool isClosedManifold(const Mesh& mesh);

/// Returns the volume that the mesh encloses, in cubic millimeters; negative if its triangles face inward.
double volumeOf(const Mesh& mesh);

/// Returns whether the body is thick enough to keep its shape on the grid: its mean thickness, the volume divided by
/// half the surface area, must exceed 4 grid steps.
bool isThickEnough(const Mesh& mesh, const RoundingGrid& grid);

/// Returns the normal of a triangle of the mesh; its length is twice the triangle's area.
glm::dvec3 doubleAreaNormalOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);

/// Returns a unit normal for each corner of each triangle: the mean of the normals of the triangles around the corner's
/// point, weighted by their areas. Leaves out triangles whose normal differs by more than 40° from the normal of the
/// corner's own triangle. The result is 0 for the corners of triangles without area.
std::vector<std::array<glm::dvec3, 3>> smoothNormals(const Mesh& mesh);

/// An axis-aligned bounding box. It is empty until it includes a point.
struct BoundingBox {
    glm::dvec3 min{1e300}, max{-1e300};
    void include(const glm::dvec3& point);
    glm::dvec3 size() const { return max - min; }
};
/// Returns the bounding box of the mesh's points.
BoundingBox boxOf(const Mesh& mesh);

}  // namespace oval4d::exports
