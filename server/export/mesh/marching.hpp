#pragma once
// Marching tetrahedra (A. Doi, A. Koide, IEICE Transactions E74, 1991): extracts the surface where a field sampled on a
// cubic grid changes sign. Each cube is divided into six tetrahedra around one diagonal (H. Freudenthal, Annals of
// Mathematics 43, 1942), in the same way in all cubes, so that adjacent cubes share whole faces. The surface in a
// tetrahedron is a triangle or a quadrilateral. It has one corner on each tetrahedron edge that joins an inside point
// to an outside point. The polygons that share a corner form one ring, because the tetrahedra that share the edge on
// which this corner lies form one ring. Therefore the surface is closed and 2-manifold and does not intersect itself,
// whatever the field is.

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

/// A scalar field that is sampled at the points origin + step · (i, j, k), in millimeters. Points with negative values
/// are inside. Values are stored in cubic blocks. A block exists once a value in it was written or ensureBlock() was
/// called; the value of every point that was never written is +infinity.
class SampledField {
  public:
    static constexpr int kSide = 8;  ///< points along each edge of a block
    /// The greatest absolute value that the indices i, j and k of a point may have. The caller must ensure this.
    static constexpr int kFarthest = 1 << 19;

    SampledField(const glm::dvec3& origin, double step) : origin_(origin), step_(step) {}

    double step() const { return step_; }
    /// Returns the position of the point with these indices.
    glm::dvec3 positionOf(const glm::ivec3& at) const { return origin_ + step_ * glm::dvec3(at); }
    /// Returns the indices of the point at `place` or next below it: (place − origin) / step, with each coordinate
    /// rounded down.
    glm::ivec3 floorIndex(const glm::dvec3& place) const;

    /// Returns a reference to the value at a point. Creates the point's block if it does not exist.
    float& operator[](const glm::ivec3& point);
    /// Creates the block that contains the point, if it does not exist.
    void ensureBlock(const glm::ivec3& point) { (*this)[point]; }
    /// Returns the value at a point.
    float value(const glm::ivec3& point) const;

    struct ValueBlock {
        glm::ivec3 corner;                                ///< the indices of the block's point with the least x, y, z
        std::array<float, kSide * kSide * kSide> values;  ///< x varies fastest, z slowest
    };
    /// Returns all blocks, in an order that depends only on their positions and not on the order of their creation.
    std::vector<const ValueBlock*> blocks() const;
    /// Returns the block that contains the point, or nullptr if the block does not exist.
    const ValueBlock* find(const glm::ivec3& point) const;

  private:
    glm::dvec3 origin_;
    double step_;
    std::unordered_map<std::uint64_t, std::unique_ptr<ValueBlock>> blocks_;
    ValueBlock* last_ = nullptr;  // the block last written to
};

/// The point where the surface crosses an edge of a tetrahedron. `fraction` is the position of the point on the edge,
/// from 0 at the inside end to 1 at the outside end. `cell` is the cell of the object from which the surface at this
/// point was cut, or kNoCell.
struct EdgeCrossing {
    double fraction = 0.5;
    std::uint32_t cell = kNoCell;
};
/// A function that finds the crossing on the edge between an inside point and a neighboring outside point.
using CrossingFinder = std::function<EdgeCrossing(const glm::ivec3& inside, const glm::ivec3& outside)>;

inline constexpr double kLeastFieldStep = 24, kGoodFieldStep = 64;  ///< in RoundingGrid steps; see marchTetrahedra()

/// Returns a mesh of the surface that separates inside points from outside points. The points of the mesh are rounded
/// to `grid`. Throws ExportRefused if `budget` is exceeded.
///
/// The caller must ensure for each cube with an inside corner:
/// - The block of the cube's lowest corner exists (see SampledField::ensureBlock()). Cubes without this block are
///   skipped.
/// - `field` has the values that `crossing` reads for the edges of the cube.
///
/// The field's step must be at least kLeastFieldStep steps of `grid`. Then no two crossings coincide after rounding,
/// because crossings are kept away from the ends of their edges. If the step is at least kGoodFieldStep steps of
/// `grid`, rounding hardly changes the shapes of the triangles.
Mesh marchTetrahedra(const SampledField& field, const CrossingFinder& crossing, const RoundingGrid& grid,
                     const Budget& budget);

/// Returns a function that finds crossings by linear interpolation of the values of `field` at the ends of an edge. The
/// EdgeCrossing::cell of these crossings is kNoCell. `field` must outlive the function.
CrossingFinder linearCrossing(const SampledField& field);

}  // namespace oval4d::exports
