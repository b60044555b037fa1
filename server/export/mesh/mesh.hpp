#pragma once
// Triangle meshes with coordinates that every file format represents exactly.

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
    std::vector<std::uint32_t> cells;                     ///< the cell that each triangle was cut from, or kNoCell

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t cell) {
        triangles.push_back({a, b, c});
        cells.push_back(cell);
    }
};

/// One body of a file.
struct NamedMesh {
    std::string name;
    Mesh mesh;
    scene::Color color;  ///< the color of triangles without a cell
    glm::dvec3 at{0};    ///< position of the mesh's origin in millimeters; a multiple of the grid step
};

/// Rounds coordinates to multiples of a power of two, which float32 and decimal formats represent exactly. Therefore
/// two points are equal in a file if and only if they are equal here, and a mesh remains closed for a program that
/// identifies points by their coordinates.
class Grid {
  public:
    /// `size` is the diameter of the polytope in millimeters, `extent` the largest absolute coordinate in the file in
    /// millimeters.
    Grid(double size, double extent);

    /// Returns the distance between neighboring grid points in millimeters, a power of two.
    double step() const { return step_; }
    /// Returns the nearest grid point.
    glm::dvec3 snap(const glm::dvec3& point) const;

  private:
    double step_;
};

/// Returns whether every edge belongs to exactly two triangles that traverse it in opposite directions, and the
/// triangles around every point form one ring.
bool isClosedManifold(const Mesh& mesh);

/// Returns the volume that the mesh encloses; negative if its triangles face inward.
double volumeOf(const Mesh& mesh);

/// Returns the normal of a triangle of the mesh; its length is twice the triangle's area.
glm::dvec3 normalOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);

/// An axis-aligned bounding box. It is empty until it includes a point.
struct Box {
    glm::dvec3 min{1e300}, max{-1e300};
    void include(const glm::dvec3& point);
    glm::dvec3 size() const { return max - min; }
};
/// Returns the bounding box of the mesh's points.
Box boxOf(const Mesh& mesh);

}  // namespace oval4d::exports
