#pragma once
// From a field sampled on a cubic grid to the surface where it changes its sign, by marching tetrahedra (A. Doi,
// A. Koide, IEICE Transactions E74, 1991). Each cube is cut into six tetrahedra along one diagonal (H. Freudenthal,
// Annals of Mathematics 43, 1942), alike in all cubes, so that neighbours share whole faces. A tetrahedron's section is
// a triangle or a quadrilateral with one corner on each edge that changes its sign; around each such corner they form
// one ring, that of the tetrahedra around the edge. So the surface is closed and 2-manifold, whatever the field, and
// does not cross itself.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include <glm/vec3.hpp>

#include "export/budget.hpp"
#include "export/mesh.hpp"

namespace oval4d::exports {

/// Values at the points origin + step · (i, j, k), kept in blocks where they were set; elsewhere infinite. Negative
/// is inside.
class SampledField {
  public:
    static constexpr int kSide = 8;
    /// Indices lie in ±kFarthest.
    static constexpr int kFarthest = 1 << 19;

    SampledField(const glm::dvec3& origin, double step) : origin_(origin), step_(step) {}

    double step() const { return step_; }
    glm::dvec3 place(const glm::ivec3& at) const { return origin_ + step_ * glm::dvec3(at); }
    /// The indices of the last grid point not above `place`.
    glm::ivec3 below(const glm::dvec3& place) const;

    float& at(const glm::ivec3& point);
    float value(const glm::ivec3& point) const;

    struct Block {
        glm::ivec3 corner;
        std::array<float, kSide * kSide * kSide> values;
    };
    /// All of them, in an order that depends on their places only.
    std::vector<const Block*> blocks() const;
    const Block* find(const glm::ivec3& point) const;

  private:
    glm::dvec3 origin_;
    double step_;
    std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks_;
    Block* last_ = nullptr;  // the block last written to
};

/// Where the surface crosses from the grid point `inside` to its neighbour `outside`: as a part of the way, and in
/// which cell's face.
struct Cross {
    double part = 0.5;
    std::uint32_t cell = kNoCell;
};
using Crossing = std::function<Cross(const glm::ivec3& inside, const glm::ivec3& outside)>;

/// The surface around the points inside. Every cube that holds a point inside must have all its corners set. The
/// field's step must be 64 of the grid's at least; crossings are kept off the ends of their edges, so that no two of
/// them meet.
Mesh march(const SampledField& field, const Crossing& crossing, const Grid& grid, const Budget& budget);

/// For a field that is a distance: the zero of the line through the two values.
Crossing linearCrossing(const SampledField& field);

}  // namespace oval4d::exports
