// This file is long because its class is not divided: the stages of the extraction work on the same lattice, and the
// compiler inlines the inner loops of one stage into the next.

#include "slicing/surfaces/surface_extractor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "slicing/surfaces/cube_cases.hpp"

namespace oval4d::slicing {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Distances in lattice steps. kOnWall: a point within this distance of a wall of the domain counts as on the wall.
// kMostMoved: points are moved onto walls by at most this along each axis. The layers of points that layOutLattice()
// adds around the domain must be thicker than kMostMoved.
constexpr double kOnWall = 1e-6, kMostMoved = 1.5;

/// Returns the least float that is not less than `value`. A float is less than the result if and only if it is less
/// than `value`.
float roundedUp(double value) {
    const auto rounded = static_cast<float>(value);
    return rounded < value ? std::nextafter(rounded, kInfinity) : rounded;
}

/// For each set of inside corners of a cube (bit c is corner c): a bit for each edge with one end inside and the other
/// outside.
constexpr std::array<std::uint16_t, 256> kCrossedEdges = [] {
    std::array<std::uint16_t, 256> crossed{};
    for (unsigned inside = 0; inside < crossed.size(); ++inside) {
        for (unsigned e = 0; e < kCubeEdges.size(); ++e) {
            const bool differ = ((inside >> kCubeEdges[e][0] ^ inside >> kCubeEdges[e][1]) & 1U) != 0;
            if (differ) crossed[inside] |= static_cast<std::uint16_t>(1U << e);
        }
    }
    return crossed;
}();

/// Returns a bit for each wall of the domain beyond which a point of a block of cubes may lie, before or after the
/// point is moved onto other walls. `first` is the position of the block's corner 0, `cubes` the number of cubes along
/// each side of the block, and `step` the lattice step.
std::uint8_t wallsNearBlock(const FieldSection& section, const glm::dvec3& first, double cubes, double step) {
    const double half = 0.5 * cubes * step;
    const glm::dvec3 center = first + half;
    const double reach = std::sqrt(3.0) * (half + kMostMoved * step);
    unsigned near = 0;
    for (std::size_t i = 0; i < section.walls.size(); ++i) {
        const auto& [normal, offset] = section.walls[i];
        near |= glm::dot(normal, center) - offset > -reach ? 1U << i : 0U;
    }
    return static_cast<std::uint8_t>(near);
}

}  // namespace

/// The values and gradients of a function at some points.
struct SurfaceExtractor::Evaluation {
    PointsInFunctionCoordinates points;
    std::array<float, PointsInFunctionCoordinates::kCapacity> values;
    std::array<std::array<float, PointsInFunctionCoordinates::kCapacity>, 4> gradients;

    void evaluate(const fields::ScalarFunction& function, std::size_t size) {
        const auto part = [&](std::size_t k) { return std::span(gradients[k]).first(size); };
        function.evaluateWithGradient(points.batch(size), std::span(values).first(size),
                                      {part(0), part(1), part(2), part(3)});
    }
    glm::dvec4 gradient(std::size_t i) const {
        return {gradients[0][i], gradients[1][i], gradients[2][i], gradients[3][i]};
    }
    /// Returns the gradient at point i, in the coordinates of the slice.
    glm::dvec3 slope(const FieldSection& section, std::size_t i) const {
        const glm::dvec4 steepest = gradient(i);
        return {glm::dot(steepest, section.axes[0]), glm::dot(steepest, section.axes[1]),
                glm::dot(steepest, section.axes[2])};
    }
};

void SurfaceExtractor::extract(const fields::ScalarFunction& function, const FieldSection& section,
                               const ExtractionOptions& options, SliceSurface& out) {
    out.clear();
    if (glm::any(glm::greaterThanEqual(section.min, section.max))) return;
    sign_ = options.inside == fields::BodySide::below ? 1 : -1;
    // While the surfaces have too many points, the lattice step is multiplied by kEnlarge. The number of points, which
    // is inversely proportional to the square of the step, then falls to about 40 %.
    constexpr double kEnlarge = 1.6;
    for (double step = options.step; !tryExtract(step, function, section, options, out); step = kEnlarge * step_)
        out.clear();
}

// Extracts the surfaces of all levels with a lattice step of at least `step`. Returns false if the surfaces have too
// many points and the step can still be enlarged.
bool SurfaceExtractor::tryExtract(double step, const fields::ScalarFunction& function, const FieldSection& section,
                                  const ExtractionOptions& options, SliceSurface& out) {
    chooseLattice(step, function, section, options);
    if (active_.empty()) return true;
    sampleBlocks(function, section, options);
    for (std::size_t level = 0; level < options.levels.size(); ++level) {
        level_ = options.levels[level];
        cubes_.clear();
        positions_.clear();
        constraints_.clear();
        if (!findSurfaceCubes(section, level, options.maxPoints - std::min(options.maxPoints, out.points.size())))
            return false;
        if (options.topologyOnly) {
            out.points.insert(out.points.end(), positions_.begin(), positions_.end());
        } else {
            movePointsOntoSurface(function, section, out);
        }
        addTriangles(level, out);
    }
    return true;
}

// Lays out the lattice and classifies its blocks. Begins with the step `step`, and enlarges it until the estimated time
// of the extraction is at most options.maxTime, or until isCoarsest().
void SurfaceExtractor::chooseLattice(double step, const fields::ScalarFunction& function, const FieldSection& section,
                                     const ExtractionOptions& options) {
    const fields::EvaluationCost cost = function.cost();
    constexpr double kEnlarge = 1.25, kBoundsShare = 0.25;
    // The surface passes through about one in six cubes of an active block, and each of these cubes gives about one
    // point. The gradient is evaluated kGradients times for each point. kPerPoint and kPerSample are times in
    // nanoseconds.
    constexpr double kPointsPerBlock = kBlockPoints / 6.0, kGradients = 2, kPerPoint = 60, kPerSample = 1;
    const double perBlock =
        kBlockPoints * (cost.value + kPerSample) + static_cast<double>(options.levels.size()) * kPointsPerBlock *
                                                       (kGradients * cost.gradient + kPerPoint + options.pointTime);
    for (;; step = kEnlarge * step_) {
        layOutLattice(section, step);
        const glm::dvec3 groups = glm::ceil(glm::dvec3(blockCount_ - 1) / 2.0);
        if (!isCoarsest() && groups.x * groups.y * groups.z * cost.bounds > kBoundsShare * options.maxTime) continue;
        classifyBlocks(function, section, options);
        if (isCoarsest() || static_cast<double>(active_.size()) * perBlock <= options.maxTime) return;
    }
}

void SurfaceExtractor::layOutLattice(const FieldSection& section, double step) {
    const glm::dvec3 size = section.max - section.min;
    step_ = std::max(step, std::max({size.x, size.y, size.z}) / (kMaxCubes - 5));
    for (std::size_t i = 0; i < section.walls.size(); ++i) {
        const glm::dvec3 n = glm::abs(section.walls[i].normal);
        maxMoveOntoWall_[i] = (1 - kOnWall) * step_ * std::max({n.x, n.y, n.z});
    }
    // Adds two layers of lattice points on each side of the domain's bounding box: a layer of points that may be moved
    // onto walls, and a layer of points outside the domain.
    base_ = glm::ivec3(glm::floor(section.min / step_)) - 2;
    const glm::ivec3 cubes = glm::ivec3(glm::ceil(section.max / step_)) + 2 - base_;
    blockCount_ = (cubes + kBlock - 1) / kBlock + 1;
    points_ = blockCount_ * kBlock;
    for (int c = 0; c < 8; ++c)
        cornerOffsets_[static_cast<std::size_t>(c)] = index(glm::ivec3(c & 1, c >> 1 & 1, c >> 2));
    const std::size_t needed = static_cast<std::size_t>(points_.x) * points_.y * points_.z;
    if (needed <= capacity_) return;
    // The arrays are not initialized. So the memory of blocks that are skipped is never touched.
    values_ = std::make_unique_for_overwrite<float[]>(needed);
    inside_ = std::make_unique_for_overwrite<std::uint8_t[]>(needed);
    cubeAt_ = std::make_unique_for_overwrite<std::uint32_t[]>(needed);
    capacity_ = needed;
}

// Returns a bit for each wall of the domain that a cube with the center `center` may touch or lie beyond. Sets
// `outside` to true if the whole cube lies so far beyond one of the walls that none of its points is moved onto this
// wall; else leaves `outside` unchanged. `extents` must be the result of extentsTowardWalls() for the size of the cube.
std::uint8_t SurfaceExtractor::wallsTouchingCube(const FieldSection& section, const ExtentsTowardWalls& extents,
                                                 const glm::dvec3& center, bool& outside) const {
    unsigned walls = 0;
    for (std::size_t i = 0; i < section.walls.size(); ++i) {
        const double distance = glm::dot(section.walls[i].normal, center) - section.walls[i].offset;
        outside = outside || distance > extents[i] + maxMoveOntoWall_[i];
        if (distance >= -extents[i]) walls |= 1U << i;
    }
    return static_cast<std::uint8_t>(walls);
}

// Returns, for each wall of the domain, how far a cube extends from its center toward the wall, with a small allowance
// for rounding. `half` is half the side of the cube.
SurfaceExtractor::ExtentsTowardWalls SurfaceExtractor::extentsTowardWalls(const FieldSection& section,
                                                                          double half) const {
    ExtentsTowardWalls extents{};
    for (std::size_t i = 0; i < section.walls.size(); ++i) {
        const glm::dvec3 n = glm::abs(section.walls[i].normal);
        extents[i] = half * (n.x + n.y + n.z) + 1e-6 * step_;
    }
    return extents;
}

// Finds the blocks that may contain a surface, and marks them as active. Notes which points of these blocks and of
// their upper neighbors must be sampled. Looks at groups of 2 × 2 × 2 blocks first. Looks at the single blocks of a
// group only if the group may contain a surface.
void SurfaceExtractor::classifyBlocks(const fields::ScalarFunction& function, const FieldSection& section,
                                      const ExtractionOptions& options) {
    blocks_.assign(static_cast<std::size_t>(blockCount_.x) * blockCount_.y * blockCount_.z, LatticeBlock{});
    active_.clear();
    glm::dvec4 unit(0);  // half the size of the bounding box of a cube with the side 2, in the function's coordinates
    for (const glm::dvec4& axis : section.axes) unit += glm::abs(axis);
    // Returns whether a cube that consists of blocks may contain a surface. `half` is half the side of the cube, and
    // `extents` the result of extentsTowardWalls() for `half`.
    const auto mayContain = [&](const glm::dvec3& center, double half, const ExtentsTowardWalls& extents) {
        bool outside = false;
        const std::uint8_t walls = wallsTouchingCube(section, extents, center, outside);
        if (outside) return false;
        // Half the size of the bounding box of the cube, in the function's coordinates. The box is larger near walls,
        // because points that are moved onto a wall may leave the cube.
        const glm::dvec4 reach = unit * (walls == 0 ? half : half + kMostMoved * step_);
        const glm::dvec4 middle =
            section.origin + center.x * section.axes[0] + center.y * section.axes[1] + center.z * section.axes[2];
        // The added part allows for rounding of positions.
        const glm::dvec4 margin = reach + 1e-6 * (glm::abs(middle) + reach);
        const fields::ValueBounds bounds = function.boundsIn({middle - margin, middle + margin});
        return std::ranges::any_of(options.levels, [&](double level) {
            // Whether the whole cube is in the body of the level.
            const bool full = sign_ > 0 ? bounds.max < level : bounds.min > level;
            return bounds.mayCross(level) || (walls != 0 && full);
        });
    };
    // The bounds of single blocks are computed only if this takes less than half of the time that the samples of a
    // block take.
    const fields::EvaluationCost cost = function.cost();
    const bool refines = cost.bounds < 0.5 * kBlockPoints * cost.value;
    const double half = 0.5 * kBlock * step_;
    const ExtentsTowardWalls ofBlock = extentsTowardWalls(section, half);
    const ExtentsTowardWalls ofGroup = extentsTowardWalls(section, 2 * half);
    const glm::ivec3 last = blockCount_ - 1;  // blocks with one of these indices are never active
    for (glm::ivec3 g(0); g.z < last.z; g.z += 2) {
        for (g.y = 0; g.y < last.y; g.y += 2) {
            for (g.x = 0; g.x < last.x; g.x += 2) {
                if (!mayContain(position(g * kBlock) + 2 * half, 2 * half, ofGroup)) continue;
                for (int i = 0; i < 8; ++i) {
                    const glm::ivec3 b = g + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
                    if (glm::any(glm::greaterThanEqual(b, last))) continue;
                    const glm::dvec3 center = position(b * kBlock) + half;
                    if (refines && !mayContain(center, half, ofBlock)) continue;
                    activateBlock(b);
                }
            }
        }
    }
    bool outside = false;
    forEachBlock([&](LatticeBlock& block, glm::ivec3 b) {
        if (block.needsSampling())
            block.walls = wallsTouchingCube(section, ofBlock, position(b * kBlock) + half, outside);
    });
}

// Marks a block as active. Notes that all points of the block must be sampled, and also the first layer of points of
// each of its upper neighbors.
void SurfaceExtractor::activateBlock(glm::ivec3 block) {
    active_.push_back(static_cast<std::uint32_t>(blockIndex(block)));
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 offset(i & 1, i >> 1 & 1, i >> 2);
        LatticeBlock& other = blocks_[blockIndex(block + offset)];
        for (int axis = 0; axis < 3; ++axis) {
            const auto needed = static_cast<std::uint8_t>(offset[axis] == 0 ? kBlock : 1);
            other.needed[axis] = std::max(other.needed[axis], needed);
        }
        if (i == 0) other.isActive = true;
    }
}

void SurfaceExtractor::sampleBlocks(const fields::ScalarFunction& function, const FieldSection& section,
                                    const ExtractionOptions& options) {
    // Blocks are collected until they fill a batch. The function is then evaluated at all points of the batch at once.
    struct BatchedBlock {
        const LatticeBlock* block;
        glm::ivec3 first;   // the block's lattice point with the least coordinates
        std::size_t begin;  // the index of the block's first point in the batch
    };
    constexpr std::size_t kCapacity = PointsInFunctionCoordinates::kCapacity;
    PointsInFunctionCoordinates points;
    std::array<BatchedBlock, kCapacity> batched{};
    std::array<float, kCapacity> values{};
    std::array<std::uint8_t, kCapacity> inside{};
    std::array<bool, kCapacity> inDomain{};  // valid only for the points of blocks at walls of the domain
    std::size_t batchedCount = 0, size = 0;
    const auto sample = [&] {
        function.evaluate(points.batch(size), std::span(values).first(size));
        findLevelsContaining(std::span(values).first(size), options, std::span(inside).first(size));
        for (const auto& [block, first, begin] : std::span(batched).first(batchedCount)) {
            const auto row = static_cast<std::size_t>(block->needed.x);
            std::size_t at = begin;
            for (int k = 0; k < block->needed.z; ++k) {
                for (int j = 0; j < block->needed.y; ++j, at += row) {
                    const glm::ivec3 start = first + glm::ivec3(0, j, k);
                    if (block->walls != 0) {
                        for (std::size_t i = at; i < at + row; ++i) {
                            if (!inDomain[i]) inside[i] = 0;
                        }
                    }
                    std::copy_n(&values[at], row, &values_[index(start)]);
                    std::copy_n(&inside[at], row, &inside_[index(start)]);
                }
            }
        }
        batchedCount = size = 0;
    };
    // The vectors from a lattice point to the next along x, y and z, in the function's coordinates.
    std::array<glm::vec4, 3> steps;
    for (std::size_t i = 0; i < 3; ++i) steps[i] = glm::vec4(step_ * section.axes[i]);
    forEachBlock([&](const LatticeBlock& block, glm::ivec3 b) {
        if (!block.needsSampling()) return;
        const glm::ivec3 needed(block.needed), first = b * kBlock;
        const std::size_t count = static_cast<std::size_t>(needed.x) * static_cast<std::size_t>(needed.y) *
                                  static_cast<std::size_t>(needed.z);
        if (size + count > kCapacity) sample();
        points.setPointsInBox(size, section, position(first), steps, needed);
        if (block.walls != 0)
            moveOntoWalls(section, first, needed, size, points, std::span(inDomain).subspan(size, count));
        batched[batchedCount++] = {&block, first, size};
        size += count;
    });
    sample();
}

// Sets inside[i] to a bit mask of levels: bit l is set if points with the value values[i] are in the body of level l.
void SurfaceExtractor::findLevelsContaining(std::span<const float> values, const ExtractionOptions& options,
                                            std::span<std::uint8_t> inside) const {
    std::ranges::fill(inside, std::uint8_t{0});
    for (std::size_t l = 0; l < options.levels.size(); ++l) {
        const auto bit = static_cast<std::uint8_t>(1U << l);
        if (sign_ > 0) {
            const float bound = roundedUp(options.levels[l]);
            for (std::size_t i = 0; i < values.size(); ++i) inside[i] |= values[i] < bound ? bit : 0;
        } else {
            const float bound = -roundedUp(-options.levels[l]);
            for (std::size_t i = 0; i < values.size(); ++i) inside[i] |= values[i] > bound ? bit : 0;
        }
    }
}

// Moves the points of a block that are just beyond walls of the domain onto these walls. Then sets `inDomain` to
// whether each point is in the domain. `first` is the block's lattice point with the least coordinates, `size` the
// number of points along each axis, and `begin` the index in `points` of the point `first`.
void SurfaceExtractor::moveOntoWalls(const FieldSection& section, glm::ivec3 first, glm::ivec3 size, std::size_t begin,
                                     PointsInFunctionCoordinates& points, std::span<bool> inDomain) const {
    const std::uint8_t walls = wallsNearBlock(section, position(first), kBlock, step_);
    std::size_t n = 0;
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; ++j) {
            const glm::dvec3 start = position(first + glm::ivec3(0, j, k));
            std::array<bool, kBlock> beyond{}, tooFar{};
            for (unsigned rest = walls; rest != 0; rest &= rest - 1) {
                const auto wall = static_cast<std::size_t>(std::countr_zero(rest));
                const auto& [normal, offset] = section.walls[wall];
                const double distance = glm::dot(normal, start) - offset, step = step_ * normal.x;
                for (std::size_t i = 0; i < kBlock; ++i) {
                    const double d = distance + static_cast<double>(i) * step;
                    beyond[i] |= d > -kOnWall * step_;
                    tooFar[i] |= d > maxMoveOntoWall_[wall] + kOnWall * step_;
                }
            }
            for (int i = 0; i < size.x; ++i, ++n) {
                const auto column = static_cast<std::size_t>(i);
                inDomain[n] = !tooFar[column];
                if (tooFar[column] || !beyond[column]) continue;
                glm::dvec3 point = position(first + glm::ivec3(i, j, k));
                inDomain[n] = moveIntoDomain(section, walls, point);
                if (inDomain[n]) points.setPoint(begin + n, section, point);
            }
        }
    }
}

// Returns whether a point is in the domain, or so close beyond walls of the domain that it can be moved onto them. In
// the latter case, moves the point onto these walls; if it is beyond only one wall, moves the point along an axis of
// the lattice. `walls` has a bit for each wall to consider, and must include all walls near the point.
bool SurfaceExtractor::moveIntoDomain(const FieldSection& section, std::uint8_t walls, glm::dvec3& point) const {
    const auto wall = [&](unsigned bits) -> const FieldSection::HalfSpace& {
        return section.walls[static_cast<std::size_t>(std::countr_zero(bits))];
    };
    const auto distance = [&](const FieldSection::HalfSpace& from) {
        return glm::dot(from.normal, point) - from.offset;
    };
    const auto moveAlongAxis = [&](const FieldSection::HalfSpace& to, double by) {
        const glm::dvec3 n = glm::abs(to.normal);
        const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
        point[axis] -= by / to.normal[axis];
    };
    if (std::has_single_bit(walls)) {
        const FieldSection::HalfSpace& only = wall(walls);
        const double d = distance(only);
        if (d > maxMoveOntoWall_[static_cast<std::size_t>(std::countr_zero(walls))]) return false;
        if (d > 0) moveAlongAxis(only, d);
        return true;
    }
    unsigned beyond = 0;
    for (unsigned rest = walls; rest != 0; rest &= rest - 1) {
        const double d = distance(wall(rest));
        if (d > maxMoveOntoWall_[static_cast<std::size_t>(std::countr_zero(rest))]) return false;
        if (d > 0) beyond |= rest & -rest;
    }
    if (beyond == 0) return true;
    const glm::dvec3 start = point;
    if (std::has_single_bit(beyond)) moveAlongAxis(wall(beyond), distance(wall(beyond)));
    // A point beyond several walls of the domain is moved to the nearest place where these walls meet. If the point is
    // then beyond another wall, the next round includes this wall.
    for (int round = 0; round < 3; ++round) {
        unsigned now = 0;
        for (unsigned rest = walls; rest != 0; rest &= rest - 1)
            now |= distance(wall(rest)) > kOnWall * step_ ? rest & -rest : 0U;
        if (now == 0) {
            const glm::dvec3 moved = glm::abs(point - start);
            return std::max({moved.x, moved.y, moved.z}) <= kMostMoved * step_;
        }
        beyond |= now;
        point = start;
        MinimumNormStep step;
        for (unsigned rest = beyond; rest != 0; rest &= rest - 1)
            step.addConstraint(wall(rest).normal, distance(wall(rest)));
        point += step.solve();
    }
    return false;
}

std::uint8_t SurfaceExtractor::insideCornerMask(glm::ivec3 cube, std::size_t level) const {
    const std::uint8_t* const first = &inside_[index(cube)];
    unsigned corners = 0;
    for (unsigned c = 0; c < 8; ++c) corners |= (first[cornerOffsets_[c]] >> level & 1U) << c;
    return static_cast<std::uint8_t>(corners);
}

// Sets cubes_ to the cubes through which the surface of level number `level` passes, and appends their points. Returns
// false if these cubes have more than `maxPoints` points and the step of the lattice can still be enlarged.
bool SurfaceExtractor::findSurfaceCubes(const FieldSection& section, std::size_t level, std::size_t maxPoints) {
    // CornerPairs describes a row of lattice points along x, for the four cubes along the row. Each cube has two
    // corners in the row. Each member of CornerPairs has one byte per cube, and in this byte a bit for each level, as
    // in inside_.
    constexpr std::size_t kRows = kBlock + 1;
    struct CornerPairs {
        // Bits: whether at least one (`some`) or both (`all`) of the cube's two corners in the row are inside the body
        std::uint32_t some, all;
    };
    const auto rowAt = [&](std::uint32_t at) -> CornerPairs {
        std::array<std::uint32_t, 2> ends{};
        for (std::size_t i = 0; i < 2; ++i) std::memcpy(&ends[i], &inside_[at + i], kBlock);
        return {ends[0] | ends[1], ends[0] & ends[1]};
    };
    const std::uint32_t levelBits = 0x01010101U << level;
    const std::uint32_t nextRow = cornerOffsets_[2], nextLayer = cornerOffsets_[4];
    for (const std::uint32_t number : active_) {
        const auto n = static_cast<int>(number);
        const glm::ivec3 first =
            glm::ivec3(n % blockCount_.x, n / blockCount_.x % blockCount_.y, n / (blockCount_.x * blockCount_.y)) *
            kBlock;
        std::array<std::array<CornerPairs, kRows>, kRows> rows{};
        for (std::size_t k = 0; k < kRows; ++k) {
            const auto layer = index(first) + static_cast<std::uint32_t>(k) * nextLayer;
            for (std::size_t j = 0; j < kRows; ++j) rows[k][j] = rowAt(layer + static_cast<std::uint32_t>(j) * nextRow);
        }
        for (std::size_t k = 0; k < kBlock; ++k) {
            for (std::size_t j = 0; j < kBlock; ++j) {
                const CornerPairs &a = rows[k][j], &b = rows[k][j + 1], &c = rows[k + 1][j], &d = rows[k + 1][j + 1];
                std::uint32_t crossed =
                    ((a.some | b.some | c.some | d.some) ^ (a.all & b.all & c.all & d.all)) & levelBits;
                for (; crossed != 0; crossed &= crossed - 1)
                    addCube(section, level, first + glm::ivec3(std::countr_zero(crossed) / 8, j, k));
            }
        }
        if (positions_.size() > maxPoints && !isCoarsest()) return false;
    }
    return true;
}

void SurfaceExtractor::addCube(const FieldSection& section, std::size_t level, glm::ivec3 place) {
    const std::uint8_t inside = insideCornerMask(place, level);
    const CubeCase* patches = &cubeCase(inside);
    bool joined = false;
    if (patches->mergingFace != CubeCase::kNoFace) {
        const unsigned face = patches->mergingFace;
        glm::ivec3 neighbor = place;
        neighbor[static_cast<int>(face / 2)] += face % 2 == 1 ? 1 : -1;
        joined = blockOf(neighbor).isActive && cubeCase(insideCornerMask(neighbor, level)).mergingFace == (face ^ 1U);
        if (joined) patches = &joinedCubeCase(inside);
    }
    CrossedCube cube{index(place), inside, joined, {}, static_cast<std::uint32_t>(positions_.size())};
    if (const std::uint8_t walls = blockOf(place).walls; walls != 0 || !addPatchPoints(*patches, cube, place))
        addPatchPointsAtWalls(section, *patches, walls, place, cube);
    cubeAt_[cube.at] = static_cast<std::uint32_t>(cubes_.size());
    cubes_.push_back(cube);
}

// Appends the points of a cube through which no wall of the domain passes: one point for each patch of the surface. The
// point is the mean of the places where the level set crosses the cube edges of the patch. Returns false, and appends
// nothing, if the value of the function at one of the corners is not finite.
bool SurfaceExtractor::addPatchPoints(const CubeCase& patches, const CrossedCube& cube, glm::ivec3 place) {
    std::array<float, 8> values{};
    for (std::size_t c = 0; c < values.size(); ++c) {
        values[c] = values_[cube.at + cornerOffsets_[c]];
        if (!std::isfinite(values[c])) return false;
    }
    std::array<glm::vec3, 4> sums{};
    std::array<int, 4> counts{};
    const auto level = static_cast<float>(level_);
    for (unsigned rest = kCrossedEdges[cube.inside]; rest != 0; rest &= rest - 1) {
        const auto e = static_cast<std::size_t>(std::countr_zero(rest));
        const unsigned from = kCubeEdges[e][0];
        const float start = values[from] - level, end = values[kCubeEdges[e][1]] - level;
        glm::vec3 point(from & 1U, from >> 1U & 1U, from >> 2U);
        // The level is rounded to a float, so both ends may be on the same side of the level. Therefore the quotient is
        // clamped.
        point[static_cast<int>(e / 4)] = start == end ? 0.5F : std::clamp(start / (start - end), 0.0F, 1.0F);
        const std::size_t patch = patches.patchOfEdge[e];
        sums[patch] += point;
        ++counts[patch];
    }
    for (std::size_t patch = 0; patch < patches.patches; ++patch) {
        const glm::dvec3 mean(sums[patch] / static_cast<float>(counts[patch]));
        positions_.push_back(position(place) + step_ * mean);
        constraints_.push_back(kOnLevel);
    }
    return true;
}

// Appends the points of a cube through which a wall of the domain, or the boundary of a hole (where the function has no
// value), may pass: one point for each patch of the surface (see CubeCase). The point is the mean of the places where
// the cube edges of the patch leave the body. Its constraint mask is the union of the masks of these places. Notes in
// `cube.cap` at which of the edges from corner 0 the surface is a cap.
void SurfaceExtractor::addPatchPointsAtWalls(const FieldSection& section, const CubeCase& patches, std::uint8_t walls,
                                             glm::ivec3 place, CrossedCube& cube) {
    std::array<CubeCorner, 8> corners{};
    std::array<float, 8> values{};
    const std::uint8_t near = wallsNearBlock(section, position(place), 1, step_);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const auto bits = static_cast<int>(c);
        corners[c].position = position(place + glm::ivec3(bits & 1, bits >> 1 & 1, bits >> 2));
        corners[c].inDomain = moveIntoDomain(section, near, corners[c].position);
        values[c] = values_[cube.at + cornerOffsets_[c]];
    }
    std::array<glm::dvec3, 4> sums{};
    std::array<int, 4> counts{};
    std::array<std::uint16_t, 4> constraints{};
    for (unsigned rest = kCrossedEdges[cube.inside]; rest != 0; rest &= rest - 1) {
        const auto e = static_cast<std::size_t>(std::countr_zero(rest));
        const std::size_t patch = patches.patchOfEdge[e];
        std::size_t inner = kCubeEdges[e][0], outer = kCubeEdges[e][1];
        if ((cube.inside >> inner & 1U) == 0) std::swap(inner, outer);
        const LatticeEdgeCrossing at =
            latticeEdgeCrossing(section, walls, corners[inner], values[inner], corners[outer], values[outer]);
        sums[patch] += at.position;
        ++counts[patch];
        constraints[patch] |= at.constraint;
        if (kCubeEdges[e][0] == 0) cube.cap[e / 4] = at.constraint != kOnLevel ? 1 : 0;
    }
    for (std::size_t patch = 0; patch < patches.patches; ++patch) {
        positions_.push_back(sums[patch] / static_cast<double>(counts[patch]));
        constraints_.push_back(constraints[patch]);
    }
}

// Returns the place where a lattice edge leaves the body. There, the edge meets the level set or, if its outer end is
// not in the domain, a wall of the domain. If the function has no value at the outer end, the edge meets the boundary
// of a hole, which is assumed to be halfway between the two ends. If the edge meets several of these, returns the place
// closest to its inner end.
SurfaceExtractor::LatticeEdgeCrossing SurfaceExtractor::latticeEdgeCrossing(const FieldSection& section,
                                                                            std::uint8_t walls, const CubeCorner& inner,
                                                                            float atInner, const CubeCorner& outer,
                                                                            float atOuter) const {
    constexpr double kSame = 1e-9;
    const glm::dvec3 way = outer.position - inner.position;
    double first = 0.5;
    std::uint16_t constraint = kAtHole;
    bool found = false;
    // Two kinds of values are negative or zero at the inner end: sign_ · (f − level_), and the signed distances from
    // the walls of the domain. `from` is such a value at the inner end, and `to` at the outer end. A value that is not
    // negative at the outer end crosses zero between the two ends.
    const auto consider = [&](double from, double to, std::uint16_t by) {
        if (to < 0) return false;
        const double zero = from / (from - to);
        const double t = std::isfinite(zero) ? std::clamp(zero, 0.0, 1.0) : 0.5;
        if (found && t >= first - kSame) return false;
        first = t;
        constraint = by;
        return found = true;
    };
    consider(sign_ * (atInner - level_), sign_ * (atOuter - level_), std::isnan(atOuter) ? kAtHole : kOnLevel);
    double steepest = 0;
    for (unsigned rest = outer.inDomain ? 0U : walls; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        const auto& [normal, offset] = section.walls[static_cast<std::size_t>(i)];
        const double from = std::min(glm::dot(normal, inner.position) - offset, 0.0);
        const double to = glm::dot(normal, outer.position) - offset, rise = to - from;
        const auto by = static_cast<std::uint16_t>(1U << static_cast<unsigned>(i));
        const double t = to > 0 ? -from / rise : 1;
        // If the inner end lies on several walls, the edge leaves the domain through the wall that it meets at the
        // greatest angle.
        const bool same = found && constraint < kOnLevel && to > 0 && std::abs(t - first) <= kSame;
        if (same && rise > steepest) constraint = by;
        if (same || consider(from, to, by)) steepest = std::max(same ? steepest : 0.0, rise);
    }
    return {inner.position + first * way, constraint};
}

// Moves each point of the current level onto the level set and onto the walls of the domain in its constraint mask (see
// kWalls). Then appends the points to `out`. The points of a batch make all their steps before the points of the next
// batch. So the samples of an array that one step reads are still in the cache when the next step reads them again.
void SurfaceExtractor::movePointsOntoSurface(const fields::ScalarFunction& function, const FieldSection& section,
                                             SliceSurface& out) {
    constexpr int kRimSteps = 2;  // the number of Newton steps of points on rims, whose first positions may be far off
    starts_ = positions_;
    std::size_t next = out.points.size();  // the index in `out` of the next point
    const std::size_t end = next + positions_.size();
    out.points.resize(end);
    out.normals.resize(end);
    out.growth.resize(end);
    out.values.resize(end);
    Evaluation at;
    for (std::size_t begin = 0; begin < positions_.size(); begin += PointsInFunctionCoordinates::kCapacity) {
        const std::size_t size = std::min(PointsInFunctionCoordinates::kCapacity, positions_.size() - begin);
        moving_.clear();
        for (std::size_t k = begin; k < begin + size; ++k) {
            const auto i = static_cast<std::uint32_t>(k);
            if ((constraints_[i] & kOnLevel) != 0) {
                moving_.push_back(i);
            } else {
                movePointBy(constrainedStep(section, i).solve(), i);
            }
        }
        makeNewtonStep(function, section, at);
        // Points that have left the domain through a wall belong to the rim of the surface. So this wall becomes one of
        // their constraints.
        for (const std::uint32_t i : moving_) {
            for (std::size_t wall = 0; wall < section.walls.size(); ++wall) {
                const auto& [normal, offset] = section.walls[wall];
                if (glm::dot(normal, positions_[i]) - offset > kOnWall * step_)
                    constraints_[i] |= static_cast<std::uint16_t>(1U << wall);
            }
        }
        std::erase_if(moving_, [&](std::uint32_t i) { return (constraints_[i] & kWalls) == 0; });
        for (int i = 1; i < kRimSteps; ++i) makeNewtonStep(function, section, at);

        for (std::size_t i = 0; i < size; ++i) at.points.setPoint(i, section, positions_[begin + i]);
        at.evaluate(function, size);
        for (std::size_t i = 0; i < size; ++i, ++next) {
            const glm::dvec3 slope = at.slope(section, i);
            const double length = glm::length(slope);
            const bool valid = length > 0 && std::isfinite(length);
            out.points[next] = glm::vec3(positions_[begin + i]);
            out.normals[next] = glm::vec3(valid ? slope * (sign_ / length) : glm::dvec3(0, 0, 1));
            out.growth[next] =
                valid ? static_cast<float>(-sign_ * glm::dot(at.gradient(i), section.normal) / length) : kInfinity;
            out.values[next] = at.values[i];
        }
    }
}

// Moves each of the points with the indices `moving_` by one step of Newton's method: toward the level set f = level_,
// and toward the walls of the domain in the point's constraint mask (see kWalls). `moving_` must have at most
// PointsInFunctionCoordinates::kCapacity indices. With the gradient g of f in the slice, the step of a point that need
// not lie on a wall is −(f − level_) g / |g|². Overwrites `at`.
void SurfaceExtractor::makeNewtonStep(const fields::ScalarFunction& function, const FieldSection& section,
                                      Evaluation& at) {
    if (moving_.empty()) return;
    for (std::size_t i = 0; i < moving_.size(); ++i) at.points.setPoint(i, section, positions_[moving_[i]]);
    at.evaluate(function, moving_.size());
    for (std::size_t i = 0; i < moving_.size(); ++i) {
        const std::uint32_t point = moving_[i];
        const glm::dvec3 slope = at.slope(section, i);
        const double square = glm::dot(slope, slope), excess = at.values[i] - level_;
        const bool valid = square > 0 && std::isfinite(square) && std::isfinite(excess);
        if ((constraints_[point] & kWalls) == 0) {
            // The step of a point that need not lie on a wall of the domain. MinimumNormStep would compute the same
            // step with several more divisions and roots.
            if (valid) movePointBy(slope * (-excess / square), point);
            continue;
        }
        MinimumNormStep step = constrainedStep(section, point);
        if (valid) step.addConstraint(slope / std::sqrt(square), excess / std::sqrt(square));
        movePointBy(step.solve(), point);
    }
}

// Returns a step for a point of the surface, with one condition for each wall of the domain in the constraint mask of
// the point (see kWalls). The condition for a wall is that the signed distance from the wall, normal · p − offset,
// becomes 0. The caller may add the condition for the level set. MinimumNormStep::solve() then gives the shortest step
// that satisfies all conditions.
MinimumNormStep SurfaceExtractor::constrainedStep(const FieldSection& section, std::uint32_t point) const {
    MinimumNormStep step;
    for (unsigned rest = constraints_[point] & kWalls; rest != 0; rest &= rest - 1) {
        const auto& [normal, offset] = section.walls[static_cast<std::size_t>(std::countr_zero(rest))];
        step.addConstraint(normal, glm::dot(normal, positions_[point]) - offset);
    }
    return step;
}

// Moves a point of the surface by a Newton step. If the point would then be more than one lattice step from its start
// along an axis, moves it back to its start instead: the linear approximation does not hold so far away.
void SurfaceExtractor::movePointBy(const glm::dvec3& step, std::uint32_t point) {
    const glm::dvec3 next = positions_[point] + step;
    const glm::dvec3 moved = glm::abs(next - starts_[point]);
    positions_[point] = std::max({moved.x, moved.y, moved.z}) <= step_ ? next : starts_[point];
}

// Appends to `out` two triangles for each lattice edge that the surface crosses. The corners of the triangles are the
// points of the four cubes around the edge, each on the patch that the edge belongs to.
void SurfaceExtractor::addTriangles(std::size_t level, SliceSurface& out) {
    caps_.clear();
    const auto firstPoint = static_cast<std::uint32_t>(out.points.size() - positions_.size());
    // For each axis: the two axes that follow it in the cyclic order x, y, z.
    static constexpr std::array<std::array<int, 2>, 3> kOthers{{{1, 2}, {2, 0}, {0, 1}}};
    // Returns the number that a lattice edge parallel to `axis` has in the cube at the offset (−u, −v) along the next
    // two axes (see kOthers). The numbers are those of kCubeEdges.
    const auto edgeNumber = [](int axis, int u, int v) {
        return static_cast<std::size_t>(4 * axis) + static_cast<std::size_t>(axis == 1 ? v + 2 * u : u + 2 * v);
    };
    // The pairs (u, v) for which (−u, −v) are the offsets of the four cubes around a lattice edge from the cube whose
    // corner 0 is the first end of the edge. The cubes are in counterclockwise order, as seen from the second end of
    // the edge.
    static constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (const CrossedCube& cube : cubes_) {
        const bool cornerInside = (cube.inside & 1U) != 0;
        const auto at = static_cast<int>(cube.at);
        const glm::ivec3 place(at % points_.x, at / points_.x % points_.y, at / (points_.x * points_.y));
        for (int axis = 0; axis < 3; ++axis) {
            if (cornerInside == ((cube.inside >> (1U << static_cast<unsigned>(axis)) & 1U) != 0)) continue;
            std::array<std::uint32_t, 4> corners{};
            bool complete = true;
            for (std::size_t i = 0; i < 4 && complete; ++i) {
                const auto& [u, v] = kAround[i];
                glm::ivec3 other = place;
                other[kOthers[static_cast<std::size_t>(axis)][0]] -= u;
                other[kOthers[static_cast<std::size_t>(axis)][1]] -= v;
                // A surface passes through all cubes around an edge that it crosses, so the blocks of these cubes are
                // active. A block is inactive only if boundsIn() has returned wrong bounds; the triangles at this edge
                // are then omitted.
                complete = glm::all(glm::greaterThanEqual(other, glm::ivec3(0))) && blockOf(other).isActive;
                if (!complete) break;
                const CrossedCube& around = cubes_[cubeAt_[index(other)]];
                const CubeCase& patches = around.joined ? joinedCubeCase(around.inside) : cubeCase(around.inside);
                corners[i] = firstPoint + around.firstPoint + patches.patchOfEdge[edgeNumber(axis, u, v)];
            }
            if (!complete) continue;
            if (!cornerInside) std::swap(corners[1], corners[3]);
            std::vector<std::array<std::uint32_t, 3>>& triangles =
                cube.cap[static_cast<std::size_t>(axis)] != 0 ? caps_ : out.triangles;
            const auto length = [&](std::size_t a, std::size_t b) {
                const glm::vec3 d = out.points[corners[a]] - out.points[corners[b]];
                return glm::dot(d, d);
            };
            // The quadrilateral is divided along its shorter diagonal.
            const std::size_t turn = length(0, 2) <= length(1, 3) ? 0 : 1;
            for (const std::size_t i : {std::size_t{1}, std::size_t{2}})
                triangles.push_back({corners[turn], corners[(turn + i) % 4], corners[(turn + i + 1) % 4]});
        }
    }
    out.levelAndCap.resize(out.triangles.size(), static_cast<std::uint8_t>(level));
    out.triangles.insert(out.triangles.end(), caps_.begin(), caps_.end());
    out.levelAndCap.resize(out.triangles.size(), static_cast<std::uint8_t>(level | SliceSurface::kCap));
}

}  // namespace oval4d::slicing
