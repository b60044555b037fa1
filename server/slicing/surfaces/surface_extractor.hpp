#pragma once
// Extracts the surfaces of one slice of a field by dual marching cubes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include "fields/inside.hpp"
#include "fields/scalar_function.hpp"
#include "slicing/surfaces/constrained_step.hpp"
#include "slicing/surfaces/cube_cases.hpp"
#include "slicing/surfaces/field_section.hpp"
#include "slicing/surfaces/function_points.hpp"
#include "slicing/surfaces/slice_surface.hpp"

namespace oval4d::slicing {

/// Extracts the surfaces of slices by dual marching cubes on a cubic lattice. Skips blocks of the lattice that
/// certainly contain no surface. A cube through which the surface passes gets one point per patch (see CubeCase).
/// Newton's method moves this point onto the level set. Where the surface leaves the domain, Newton's method also moves
/// the point onto the walls of the domain (see FieldSection). So caps (see SliceSurface) are flat, and their rims are
/// sharp.
///
/// Lattice points just beyond a wall are moved onto the wall before the function is sampled (as in F. Labelle, J.
/// Shewchuk, "Isosurface stuffing", 2007). So the rims follow the values on the walls themselves. The rims are smooth
/// even where a surface meets a wall at a small angle, so that the body is a wedge thinner than a cube.
///
/// An extractor keeps its memory, so that further extractions of similar size allocate nothing. Only one thread at a
/// time may use it.
class SurfaceExtractor {
  public:
    /// Says which surfaces to extract, and limits the work.
    struct ExtractionOptions {
        std::span<const double> levels;  ///< the values of the function on the surfaces; at most 7
        fields::BodySide inside = fields::BodySide::below;
        /// The distance between neighboring lattice points, in the units of the object. The coordinates of lattice
        /// points are multiples of the step, so that the lattice stays in place while an object turns. The step is
        /// enlarged if necessary, so that no axis has more than kMaxCubes cubes.
        double step = 0.1;
        /// `maxTime` limits the estimated time of the extraction, in nanoseconds. `maxPoints` limits the number of
        /// points of the surfaces. The step is enlarged until both limits are met, or until no axis has more than 8
        /// cubes.
        double maxTime = 1e9;
        std::size_t maxPoints = 10'000'000;
        bool topologyOnly = false;  ///< whether only the topology is needed: see SurfaceDetail::topologyOnly
        double pointTime = 0;  ///< the estimated time that the caller spends on each extracted point, in nanoseconds
    };
    static constexpr int kMaxCubes = 256;

    /// Extracts the surfaces of all levels, and writes them to `out`. Points where the function has no value are
    /// outside the body. Calls with the same arguments give the same surfaces. Overwrites `out`; leaves
    /// `out.secondValues` empty.
    void extract(const fields::ScalarFunction& function, const FieldSection& section, const ExtractionOptions& options,
                 SliceSurface& out);

  private:
    static constexpr int kBlock = 4;  // the number of cubes along each side of a block
    static constexpr std::size_t kBlockPoints = 64;
    // The bits of a constraint mask, which says on what a point of the surface must lie. The bit 1 << i stands for wall
    // i of the domain; kWalls has the bits of all walls. kOnLevel stands for the level set, and kAtHole for the
    // boundary of a hole, a region where the function has no value.
    static constexpr std::uint16_t kWalls = 0xff, kOnLevel = 0x100, kAtHole = 0x200;

    struct Evaluation;
    struct LatticeBlock {
        bool isActive = false;  // whether the block may contain a surface
        // If the block is sampled: a bit for each wall of the domain that the block may touch or extend beyond.
        std::uint8_t walls = 0;
        glm::u8vec3 needed{0};  // how many points along each axis are sampled, from the least index on
        bool needsSampling() const { return needed.x != 0; }
    };
    // A lattice cube through which the surface passes, and the points of its patches.
    struct CrossedCube {
        std::uint32_t at;     // the lattice index of corner 0 of the cube
        std::uint8_t inside;  // a bit for each corner: whether the corner is inside the body
        bool joined;          // whether the case of the cube is joinedCubeCase(inside), not cubeCase(inside)
        // For the edges from corner 0 along x, y and z: 1 if a cap crosses the edge, else 0.
        std::array<std::uint8_t, 3> cap;
        std::uint32_t firstPoint;  // the index in positions_ of the point of the cube's first patch
    };
    // A corner of a lattice cube.
    struct CubeCorner {
        glm::dvec3 position;
        bool inDomain;  // whether the corner is in the domain, or has been moved onto its walls
    };
    // A place where the surface crosses an edge of the lattice.
    struct LatticeEdgeCrossing {
        glm::dvec3 position;
        std::uint16_t constraint;  // the constraint mask (see kWalls): on what the place lies
    };

    using ExtentsTowardWalls = std::array<double, FieldSection::kMaxWalls>;

    void layOutLattice(const FieldSection& section, double step);
    bool tryExtract(double step, const fields::ScalarFunction& function, const FieldSection& section,
                    const ExtractionOptions& options, SliceSurface& out);
    void chooseLattice(double step, const fields::ScalarFunction& function, const FieldSection& section,
                       const ExtractionOptions& options);
    void classifyBlocks(const fields::ScalarFunction& function, const FieldSection& section,
                        const ExtractionOptions& options);
    void activateBlock(glm::ivec3 block);
    std::uint8_t wallsTouchingCube(const FieldSection& section, const ExtentsTowardWalls& extents,
                                   const glm::dvec3& center, bool& outside) const;
    ExtentsTowardWalls extentsTowardWalls(const FieldSection& section, double half) const;
    void sampleBlocks(const fields::ScalarFunction& function, const FieldSection& section,
                      const ExtractionOptions& options);
    void moveOntoWalls(const FieldSection& section, glm::ivec3 first, glm::ivec3 size, std::size_t begin,
                       PointsInFunctionCoordinates& points, std::span<bool> inDomain) const;
    bool moveIntoDomain(const FieldSection& section, std::uint8_t walls, glm::dvec3& point) const;
    void findLevelsContaining(std::span<const float> values, const ExtractionOptions& options,
                              std::span<std::uint8_t> inside) const;
    bool findSurfaceCubes(const FieldSection& section, std::size_t level, std::size_t maxPoints);
    void addCube(const FieldSection& section, std::size_t level, glm::ivec3 place);
    bool addPatchPoints(const CubeCase& patches, const CrossedCube& cube, glm::ivec3 place);
    void addPatchPointsAtWalls(const FieldSection& section, const CubeCase& patches, std::uint8_t walls,
                               glm::ivec3 place, CrossedCube& cube);
    LatticeEdgeCrossing latticeEdgeCrossing(const FieldSection& section, std::uint8_t walls, const CubeCorner& inner,
                                            float atInner, const CubeCorner& outer, float atOuter) const;
    void movePointsOntoSurface(const fields::ScalarFunction& function, const FieldSection& section, SliceSurface& out);
    void makeNewtonStep(const fields::ScalarFunction& function, const FieldSection& section, Evaluation& at);
    MinimumNormStep constrainedStep(const FieldSection& section, std::uint32_t point) const;
    void movePointBy(const glm::dvec3& step, std::uint32_t point);
    void addTriangles(std::size_t level, SliceSurface& out);

    std::uint32_t index(glm::ivec3 point) const {
        return static_cast<std::uint32_t>(point.x + points_.x * (point.y + points_.y * point.z));
    }
    // Returns whether the lattice is already so coarse that its step must not be enlarged further.
    bool isCoarsest() const { return std::max({blockCount_.x, blockCount_.y, blockCount_.z}) <= 3; }
    // Calls visit(LatticeBlock&, ivec3 block) for all blocks, in the order of blocks_.
    template <typename Visit>
    void forEachBlock(Visit&& visit) {
        std::size_t number = 0;
        for (glm::ivec3 b(0); b.z < blockCount_.z; ++b.z) {
            for (b.y = 0; b.y < blockCount_.y; ++b.y) {
                for (b.x = 0; b.x < blockCount_.x; ++b.x) visit(blocks_[number++], b);
            }
        }
    }
    const LatticeBlock& blockOf(glm::ivec3 cube) const { return blocks_[blockIndex(cube / kBlock)]; }
    std::size_t blockIndex(glm::ivec3 block) const {
        const glm::i64vec3 b(block), count(blockCount_);
        return static_cast<std::size_t>(b.x + count.x * (b.y + count.y * b.z));
    }
    glm::dvec3 position(glm::ivec3 point) const { return glm::dvec3(base_ + point) * step_; }
    std::uint8_t insideCornerMask(glm::ivec3 cube, std::size_t level) const;

    double step_ = 0;
    // Per wall of the domain: the greatest distance from the wall at which a lattice point beyond the wall is moved
    // onto it.
    std::array<double, FieldSection::kMaxWalls> maxMoveOntoWall_{};
    double sign_ = 1, level_ = 0;  // the body of the current level is where sign_ · (f − level_) < 0 for the function f
    glm::ivec3 base_{0};           // the coordinates of the lattice point (0, 0, 0), in lattice steps
    glm::ivec3 blockCount_{0};     // the number of blocks along each axis, with an inactive block at the upper end
    glm::ivec3 points_{0};         // the numbers of lattice points along each axis
    // The lattice indices of the corners of any cube, minus the lattice index of its corner 0.
    std::array<std::uint32_t, 8> cornerOffsets_{};
    std::size_t capacity_ = 0;         // the size of each of the arrays values_, inside_ and cubeAt_
    std::unique_ptr<float[]> values_;  // per lattice point of a sampled block: the value of the function
    // Per lattice point of a sampled block: a bit for each level, set if the point is inside the level's body.
    std::unique_ptr<std::uint8_t[]> inside_;
    // Per lattice point: the index in cubes_ of the cube whose corner 0 is this point; without meaning if cubes_ has
    // none.
    std::unique_ptr<std::uint32_t[]> cubeAt_;
    std::vector<LatticeBlock> blocks_;
    std::vector<std::uint32_t> active_;  // the indices of the blocks that may contain a surface
    std::vector<CrossedCube> cubes_;     // the cubes through which the surface of the current level passes
    // Per point of the surface of the current level: its position, and its first position, before Newton's method moved
    // it.
    std::vector<glm::dvec3> positions_, starts_;
    std::vector<std::uint32_t> moving_;  // the indices of the points that makeNewtonStep() moves
    // The triangles of the caps of the current level. In the result, they follow the other triangles of this level.
    std::vector<std::array<std::uint32_t, 3>> caps_;
    // Per point of the surface of the current level: its constraint mask (see kWalls).
    std::vector<std::uint16_t> constraints_;
};

}  // namespace oval4d::slicing
