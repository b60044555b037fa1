#pragma once
// Triangle meshes on a grid of coordinates that every format holds exactly.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace oval4d::exports {

inline constexpr std::uint32_t kNoCell = 0xffffffffU;

/// Triangles run counter-clockwise seen from outside.
struct Mesh {
    std::vector<glm::dvec3> points;  ///< millimetres
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> cells;  ///< beside `triangles`: the cell that each was cut from, or kNoCell

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t cell) {
        triangles.push_back({a, b, c});
        cells.push_back(cell);
    }
};

/// One body of a file.
struct Solid {
    std::string name;
    Mesh mesh;
    scene::Colour colour;  ///< of the triangles without a cell
    glm::dvec3 at{0};      ///< millimetres: where the mesh's origin stands; a multiple of the grid
};

/// Coordinates are multiples of a power of two. Points so rounded are equal or differ in every format, be its numbers
/// float32 or decimals: what is closed here is closed for whoever compares coordinates.
class Grid {
  public:
    /// For bodies of polytopes `size` mm across in a file that is `extent` mm long.
    Grid(double size, double extent);

    double step() const { return step_; }
    glm::dvec3 snap(const glm::dvec3& point) const;

  private:
    double step_;
};

/// Whether every edge lies in exactly two triangles, which run along it in opposite directions, and the triangles
/// around every point form one ring.
bool isClosedManifold(const Mesh& mesh);

/// The signed volume that the mesh encloses.
double volumeOf(const Mesh& mesh);

/// Twice the triangle's area, along its normal.
glm::dvec3 normalOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);

struct Box {
    glm::dvec3 least{1e300}, most{-1e300};
    void include(const glm::dvec3& point);
    glm::dvec3 size() const { return most - least; }
};
Box boxOf(const Mesh& mesh);

}  // namespace oval4d::exports
