#pragma once
// Marching tetrahedra (A. Doi, A. Koide, IEICE Transactions E74, 1991): finds the surface where a field, sampled on a
// cubic grid, changes its sign. Each cube is divided into six tetrahedra around one diagonal (H. Freudenthal, Annals of
// Mathematics 43, 1942). All cubes are divided in the same way, so that adjacent cubes share whole faces.
//
// In a tetrahedron, the surface is a triangle or a quadrilateral. It has one corner on each edge of the tetrahedron
// that joins an inside point to an outside point. The polygons around such a corner form one ring, because the
// tetrahedra around the edge form one ring. Therefore the surface is closed and 2-manifold and does not intersect
// itself, for every field.

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

/// A scalar field, sampled at the points origin + step · (i, j, k), in millimeters. Points with negative values are
/// inside. Values are stored in cubic blocks. A block is created when one of its values is written, or by
/// ensureBlock(). Points that were never written have the value +infinity.
class SampledField {
  public:
    static constexpr int kSide = 8;  ///< number of points along each edge of a block
    /// The greatest absolute value that the indices i, j and k of a point may have. Callers must not exceed it.
    static constexpr int kFarthest = 1 << 19;

    SampledField(const glm::dvec3& origin, double step) : origin_(origin), step_(step) {}

    double step() const { return step_; }
    /// Returns the position of the point with these indices.
    glm::dvec3 positionOf(const glm::ivec3& at) const { return origin_ + step_ * glm::dvec3(at); }
    /// Returns the indices of the point at `place` or next below it: (place − origin) / step, rounded down along each
    /// axis.
    glm::ivec3 floorIndex(const glm::dvec3& place) const;

    /// Returns a reference to the value at a point. Creates the point's block if necessary.
    float& operator[](const glm::ivec3& point);
    /// Creates the block that contains the point, unless it exists.
    void ensureBlock(const glm::ivec3& point) { (*this)[point]; }
    /// Returns the value at a point.
    float value(const glm::ivec3& point) const;

    struct ValueBlock {
        /// The indices of the block's point with the least x, y and z.
        glm::ivec3 corner;
        /// The values of the block's points; x varies fastest, and z slowest.
        std::array<float, kSide * kSide * kSide> values;
    };
    /// Returns all blocks, in an order that depends only on their positions.
    std::vector<const ValueBlock*> blocks() const;
    /// Returns the block that contains the point, or nullptr if there is no such block.
    const ValueBlock* findBlock(const glm::ivec3& point) const;

  private:
    glm::dvec3 origin_;
    double step_;
    std::unordered_map<std::uint64_t, std::unique_ptr<ValueBlock>> blocks_;
    ValueBlock* last_ = nullptr;  // the block to which a value was written last
};

/// The point where the surface crosses an edge of a tetrahedron. `fraction` is the position of the point on the edge,
/// from 0 at the inside end to 1 at the outside end. `cell` is the cell of the 4-D object from which the surface was
/// cut at this point, or kNoCell.
struct EdgeCrossing {
    double fraction = 0.5;
    std::uint32_t cell = kNoCell;
};
/// A function that finds the crossing on the edge from an inside point to a neighboring outside point.
using CrossingFinder = std::function<EdgeCrossing(const glm::ivec3& inside, const glm::ivec3& outside)>;

/// Two steps of a SampledField, in steps of the RoundingGrid: the least step that marchTetrahedra() allows, and the
/// step from which rounding hardly changes the shapes of triangles.
inline constexpr double kLeastFieldStep = 24, kGoodFieldStep = 64;

/// Returns a mesh of the surface that separates inside points from outside points. Rounds the points of the mesh to
/// `grid`. Throws ExportRefused if `budget` is exceeded.
///
/// The caller must ensure for each cube with an inside corner:
/// - The block of the cube's lowest corner exists (see SampledField::ensureBlock()). Cubes without this block are
///   skipped.
/// - `field` has all values that `crossing` reads for the edges of the cube.
///
/// The step of the field must be at least kLeastFieldStep steps of `grid`. Then no two crossings become equal by
/// rounding, because crossings are kept away from the ends of their edges. From kGoodFieldStep on, rounding hardly
/// changes the shapes of triangles.
Mesh marchTetrahedra(const SampledField& field, const CrossingFinder& crossing, const RoundingGrid& grid,
                     const ExportBudget& budget);

/// Returns a function that finds crossings by linear interpolation of `field` along an edge. EdgeCrossing::cell of
/// these crossings is kNoCell. `field` must outlive the function.
CrossingFinder linearCrossingFinder(const SampledField& field);

}  // namespace oval4d::exports
