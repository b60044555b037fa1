#pragma once
// Marching tetrahedra (A. Doi, A. Koide, IEICE Transactions E74, 1991): extracts the surface where a field sampled on a
// cubic grid changes sign. Each cube is divided into six tetrahedra around one diagonal (H. Freudenthal, Annals of
// Mathematics 43, 1942), in the same way in all cubes, so that adjacent cubes share whole faces. The surface in a
// tetrahedron is a triangle or a quadrilateral with one corner on each edge whose ends differ in sign. Around each
// corner these polygons form one ring, as do the tetrahedra around the edge. So the surface is closed and 2-manifold
// and does not intersect itself, whatever the field is.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include <glm/vec3.hpp>

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// A sparse field: values at the points origin + step · (i, j, k), stored in blocks where they were set and infinite
/// elsewhere. Negative values are inside.
class SampledField {
  public:
    static constexpr int kSide = 8;  ///< points along a block
    /// Indices lie in ±kFarthest.
    static constexpr int kFarthest = 1 << 19;

    SampledField(const glm::dvec3& origin, double step) : origin_(origin), step_(step) {}

    double step() const { return step_; }
    glm::dvec3 place(const glm::ivec3& at) const { return origin_ + step_ * glm::dvec3(at); }
    /// Rounds a position down to a grid point.
    glm::ivec3 below(const glm::dvec3& place) const;

    /// The value at a point, for writing; creates the block if needed.
    float& at(const glm::ivec3& point);
    float value(const glm::ivec3& point) const;

    struct Block {
        glm::ivec3 corner;
        std::array<float, kSide * kSide * kSide> values;
    };
    /// All blocks, in an order that depends only on their positions.
    std::vector<const Block*> blocks() const;
    /// The block that contains the point, or nullptr.
    const Block* find(const glm::ivec3& point) const;

  private:
    glm::dvec3 origin_;
    double step_;
    std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks_;
    Block* last_ = nullptr;  // the block last written to
};

/// The intersection of the surface with the edge from grid point `inside` to its neighbor `outside`: `part` is its
/// position as a fraction of the edge, and `cell` the cell whose face it belongs to.
struct EdgeCrossing {
    double part = 0.5;
    std::uint32_t cell = kNoCell;
};
using FindCrossing = std::function<EdgeCrossing(const glm::ivec3& inside, const glm::ivec3& outside)>;

/// Meshes the surface around the inside points. All corners of every cube with an inside corner must be set. The
/// field's step must be at least 64 grid steps; crossings are kept away from the ends of their edges, so that no two
/// coincide.
Mesh marchTetrahedra(const SampledField& field, const FindCrossing& crossing, const Grid& grid, const Budget& budget);

/// Finds crossings in a distance field by linear interpolation.
FindCrossing linearCrossing(const SampledField& field);

}  // namespace oval4d::exports
