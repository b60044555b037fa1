#include "export/mesh/marching.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "geometry/index.hpp"

namespace oval4d::exports {

namespace {

constexpr int kSide = SampledField::kSide;
constexpr int kPoints = kSide * kSide * kSide;
using geometry::kNone;

glm::ivec3 blockOf(const glm::ivec3& point) { return {point.x >> 3, point.y >> 3, point.z >> 3}; }

int indexInBlock(const glm::ivec3& point) { return (point.x & 7) | (point.y & 7) << 3 | (point.z & 7) << 6; }

std::uint64_t pointKey(const glm::ivec3& point) {
    const glm::ivec3 block = blockOf(point);
    const auto part = [](int i) { return static_cast<std::uint64_t>(i + SampledField::kFarthest) & 0xfffffU; };
    return part(block.z) << 40U | part(block.y) << 20U | part(block.x);
}

// Returns the position of a cube's corner relative to the cube's lowest corner, or the direction of an edge, in steps
// of the field. `bits` has one bit for each axis: 1 for x, 2 for y, 4 for z.
glm::ivec3 cornerOffset(unsigned bits) { return {bits & 1U, bits >> 1U & 1U, bits >> 2U & 1U}; }

// The six tetrahedra of a cube. The number of a corner is the parameter of cornerOffset(). The corners of a tetrahedron
// lie on a path from corner 0 to corner 7 with one step along each axis. There is one tetrahedron for each order of the
// axes. The four corners a, b, c, d of a tetrahedron are listed such that ((b − a) × (c − a)) · (d − a) > 0.
constexpr std::array<std::array<unsigned, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};

// A permutation of a tetrahedron's corners for each set of inside corners (bit c stands for corner c). The inside
// corners come first; but if only one corner is outside, this corner comes first. All permutations are even, so that
// ((b − a) × (c − a)) · (d − a) stays positive.
constexpr std::array<std::array<unsigned, 4>, 16> kOrder{{{0, 1, 2, 3},
                                                          {0, 1, 2, 3},
                                                          {1, 0, 3, 2},
                                                          {0, 1, 2, 3},
                                                          {2, 3, 0, 1},
                                                          {0, 2, 3, 1},
                                                          {1, 2, 0, 3},
                                                          {3, 2, 1, 0},
                                                          {3, 2, 1, 0},
                                                          {0, 3, 1, 2},
                                                          {1, 3, 2, 0},
                                                          {2, 3, 0, 1},
                                                          {2, 3, 0, 1},
                                                          {1, 0, 3, 2},
                                                          {0, 1, 2, 3},
                                                          {0, 1, 2, 3}}};

class MarchingTetrahedra {
  public:
    MarchingTetrahedra(const SampledField& field, const CrossingFinder& crossing, const RoundingGrid& grid,
                       const ExportBudget& budget)
        : field_(field), crossing_(crossing), grid_(grid), budget_(budget) {}

    Mesh march() {
        for (const SampledField::ValueBlock* block : field_.blocks()) {
            budget_.checkTimeAndStop();
            budget_.checkTrianglesAndMemory(mesh_.triangles.size());
            loadInsideFlags(block->corner);
            for (int i = 0; i < kPoints; ++i) triangulateCube(block->corner, {i & 7, i >> 3 & 7, i >> 6});
        }
        assignTrianglesToCells();
        return std::move(mesh_);
    }

  private:
    // Sets inside_: for each corner of the cubes of a block, whether the corner is inside the surface. The cubes of the
    // block at `corner` are those with their lowest corner in the block, so some of their corners are in adjacent
    // blocks.
    void loadInsideFlags(const glm::ivec3& corner) {
        inside_.fill(false);
        for (unsigned c = 0; c < 8; ++c) {
            const SampledField::ValueBlock* block = field_.findBlock(corner + kSide * cornerOffset(c));
            if (block == nullptr) continue;
            const glm::ivec3 shift = kSide * cornerOffset(c);
            const glm::ivec3 count = glm::mix(glm::ivec3(kSide), glm::ivec3(1), glm::bvec3(cornerOffset(c)));
            for (int z = 0; z < count.z; ++z) {
                for (int y = 0; y < count.y; ++y) {
                    for (int x = 0; x < count.x; ++x) {
                        inside_[cornerIndexInBlock(shift + glm::ivec3(x, y, z))] =
                            block->values[indexInBlock({x, y, z})] < 0;
                    }
                }
            }
        }
    }

    static int cornerIndexInBlock(const glm::ivec3& in) { return in.x + (kSide + 1) * (in.y + (kSide + 1) * in.z); }

    void triangulateCube(const glm::ivec3& block, const glm::ivec3& in) {
        unsigned inside = 0;
        for (unsigned c = 0; c < 8; ++c) inside |= (inside_[cornerIndexInBlock(in + cornerOffset(c))] ? 1U : 0U) << c;
        if (inside == 0 || inside == 0xffU) return;
        const glm::ivec3 at = block + in;
        for (const auto& tetrahedron : kTetrahedra) {
            unsigned mask = 0;
            for (unsigned c = 0; c < 4; ++c) mask |= (inside >> tetrahedron[c] & 1U) << c;
            if (mask != 0 && mask != 0xfU) addSection(at, tetrahedron, mask);
        }
    }

    void addSection(const glm::ivec3& at, const std::array<unsigned, 4>& tetrahedron, unsigned mask) {
        std::array<unsigned, 4> v{};
        for (unsigned c = 0; c < 4; ++c) v[c] = tetrahedron[kOrder[mask][c]];
        const auto corner = [&](unsigned i, unsigned o) { return findOrAddVertex(at, v[i], v[o]); };
        const int count = std::popcount(mask);
        if (count == 2) {
            const std::array<std::uint32_t, 4> q{corner(0, 2), corner(0, 3), corner(1, 3), corner(1, 2)};
            mesh_.triangles.push_back({q[0], q[1], q[2]});
            mesh_.triangles.push_back({q[0], q[2], q[3]});
        } else if (count == 1) {
            mesh_.triangles.push_back({corner(0, 1), corner(0, 2), corner(0, 3)});
        } else {
            mesh_.triangles.push_back({corner(1, 0), corner(3, 0), corner(2, 0)});
        }
    }

    // Returns the index of the mesh point on the edge from the corner `inside` to the corner `outside` of the cube at
    // `at`. Creates the point at the first call for an edge. A corner is a set of bits (see cornerOffset()). On every
    // edge of a tetrahedron, the bits of one end are a subset of the bits of the other end.
    std::uint32_t findOrAddVertex(const glm::ivec3& at, unsigned inside, unsigned outside) {
        const glm::ivec3 lower = at + cornerOffset(inside & outside);
        auto& ids = findOrAddEdgePointTable(lower);
        std::uint32_t& id = ids[static_cast<std::size_t>(indexInBlock(lower)) * 7 + (inside ^ outside) - 1];
        if (id == kNone) {
            id = static_cast<std::uint32_t>(mesh_.points.size());
            // The least distance of a crossing from each end of its edge, as a fraction of the edge. Crossings on two
            // edges with a common end are therefore several grid steps apart.
            const double off = std::min(1.0 / 12, 6 * grid_.step() / field_.step());
            const glm::ivec3 from = at + cornerOffset(inside);
            const glm::ivec3 to = at + cornerOffset(outside);
            const EdgeCrossing cross = crossing_(from, to);
            const double part = std::clamp(cross.fraction, off, 1 - off);
            mesh_.points.push_back(grid_.snap(glm::mix(field_.positionOf(from), field_.positionOf(to), part)));
            pointCells_.push_back(cross.cell);
        }
        return id;
    }

    // Assigns each triangle to the cell of at least two of its corners. If all three corners have different cells,
    // assigns the triangle to the cell of the first corner.
    void assignTrianglesToCells() {
        for (const auto& [a, b, c] : mesh_.triangles) {
            mesh_.cells.push_back(pointCells_[b] == pointCells_[c] ? pointCells_[b] : pointCells_[a]);
        }
    }

    using EdgePointIndices = std::array<std::uint32_t, static_cast<std::size_t>(kPoints) * 7>;
    // Returns the table of mesh points for the block that contains `point`. Each point of the block has seven entries,
    // one for each direction of an edge (see cornerOffset()): the index of the mesh point on this edge, or kNone.
    // Creates the table at the first call for a block.
    EdgePointIndices& findOrAddEdgePointTable(const glm::ivec3& point) {
        const std::uint64_t key = pointKey(point);
        if (last_ == nullptr || lastKey_ != key) {
            auto& ids = ids_[key];
            if (!ids) {
                ids = std::make_unique<EdgePointIndices>();
                ids->fill(kNone);
            }
            last_ = ids.get();
            lastKey_ = key;
        }
        return *last_;
    }

    const SampledField& field_;
    const CrossingFinder& crossing_;
    const RoundingGrid& grid_;
    const ExportBudget& budget_;
    Mesh mesh_;
    std::vector<std::uint32_t> pointCells_;
    std::array<bool, (kSide + 1) * (kSide + 1) * (kSide + 1)> inside_{};
    std::unordered_map<std::uint64_t, std::unique_ptr<EdgePointIndices>> ids_;
    EdgePointIndices* last_ = nullptr;
    std::uint64_t lastKey_ = 0;
};

}  // namespace

glm::ivec3 SampledField::floorIndex(const glm::dvec3& place) const { return {glm::floor((place - origin_) / step_)}; }

float& SampledField::operator[](const glm::ivec3& point) {
    const glm::ivec3 corner = blockOf(point) * kSide;
    if (last_ == nullptr || last_->corner != corner) {
        auto& block = blocks_[pointKey(point)];
        if (!block) {
            block = std::make_unique<ValueBlock>();
            block->corner = corner;
            block->values.fill(std::numeric_limits<float>::infinity());
        }
        last_ = block.get();
    }
    return last_->values[indexInBlock(point)];
}

const SampledField::ValueBlock* SampledField::findBlock(const glm::ivec3& point) const {
    const auto found = blocks_.find(pointKey(point));
    return found == blocks_.end() ? nullptr : found->second.get();
}

float SampledField::value(const glm::ivec3& point) const {
    const ValueBlock* block = findBlock(point);
    return block != nullptr ? block->values[indexInBlock(point)] : std::numeric_limits<float>::infinity();
}

std::vector<const SampledField::ValueBlock*> SampledField::blocks() const {
    std::vector<std::pair<std::uint64_t, const ValueBlock*>> sorted;
    for (const auto& [key, block] : blocks_) sorted.emplace_back(key, block.get());
    std::ranges::sort(sorted);
    std::vector<const ValueBlock*> out;
    for (const auto& [key, block] : sorted) out.push_back(block);
    return out;
}

Mesh marchTetrahedra(const SampledField& field, const CrossingFinder& crossing, const RoundingGrid& grid,
                     const ExportBudget& budget) {
    return MarchingTetrahedra(field, crossing, grid, budget).march();
}

CrossingFinder linearCrossingFinder(const SampledField& field) {
    return [&field](const glm::ivec3& inside, const glm::ivec3& outside) {
        const double in = field.value(inside);
        const double out = field.value(outside);
        return EdgeCrossing{in / (in - out), kNoCell};
    };
}

}  // namespace oval4d::exports
