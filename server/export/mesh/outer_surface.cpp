#include "export/mesh/outer_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "export/mesh/marching.hpp"

namespace oval4d::exports {

namespace {

constexpr double kCubes = 128;  // number of cubes along the slice's largest dimension

/// A triangle of the fan into which a face is divided. The winding number of the face around a point of its plane is
/// the sum of the winding numbers of these triangles, even for a star polygon.
struct FanTriangle {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t cell;
};

class OuterSurfaceMesher {
  public:
    OuterSurfaceMesher(const slicing::SliceSet& slices, int i, double scale, const ExportBudget& budget)
        : budget_(budget) {
        for (std::uint32_t v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
            points_.push_back(slices.vertices[v] * scale);
            box_.include(points_.back());
        }
        for (std::uint32_t f = slices.faceBegin[i]; f < slices.faceBegin[i + 1]; ++f) {
            const std::uint32_t first = slices.cornerBegin[f];
            for (std::uint32_t c = first + 1; c + 1 < slices.cornerBegin[f + 1]; ++c) {
                triangles_.push_back(
                    {{slices.corners[first], slices.corners[c], slices.corners[c + 1]}, slices.faceSource[f]});
            }
        }
    }

    Mesh makeMesh(const RoundingGrid& grid) {
        const glm::dvec3 size = box_.size();
        const double cube = std::max({size.x, size.y, size.z}) / kCubes;
        if (!(cube > kGoodFieldStep * grid.step())) return {};
        // The offset keeps the points of the field away from the symmetry planes of the slice. On these planes, points
        // might lie exactly on faces.
        SampledField field(box_.min - glm::dvec3(0.371, 0.217, 0.449) * cube, cube);
        markInterior(field);
        sortTrianglesIntoBoxes(4 * cube);
        return marchTetrahedra(
            field,
            [&](const glm::ivec3& inside, const glm::ivec3& outside) {
                return findCrossing(field.positionOf(inside), field.positionOf(outside));
            },
            grid, budget_);
    }

  private:
    // A crossing of a line with a triangle. `at` is the position of the crossing on the line: in markInterior(), its x;
    // in findCrossing(), the fraction of the way from the outside point to the inside point. `windingChange` is the
    // change of the winding number at the crossing, in the direction in which `at` increases. `cell` is the cell of the
    // triangle.
    struct LineCrossing {
        double at;
        int windingChange;
        std::uint32_t cell;
    };

    // Returns −1 if the edge from a to b, projected to the yz-plane, crosses the ray y = row.y, z > row.z in the
    // direction +y; 1 if it crosses the ray in the direction −y; else 0. The results for (a, b) and (b, a) are exactly
    // opposite. So despite rounding, a closed surface crosses every line along x equally often in both directions.
    int signedRayCrossing(std::uint32_t a, std::uint32_t b, const glm::dvec3& row) const {
        if (a > b) return -signedRayCrossing(b, a, row);
        const glm::dvec3& p = points_[a];
        const glm::dvec3& q = points_[b];
        if ((p.y <= row.y) == (q.y <= row.y)) return 0;
        const double z = p.z + (q.z - p.z) * ((row.y - p.y) / (q.y - p.y));
        if (z <= row.z) return 0;
        return p.y <= row.y ? -1 : 1;
    }

    /// Sets the field to −1 at all points inside the surface. Works through the lines of points along x, one after
    /// another.
    void markInterior(SampledField& field) const {
        std::unordered_map<std::uint64_t, std::vector<LineCrossing>> lines;
        for (const FanTriangle& triangle : triangles_) {
            const auto [a, b, c] = triangle.corners;
            BoundingBox box;
            for (const std::uint32_t corner : triangle.corners) box.include(points_[corner]);
            const glm::ivec3 least = field.floorIndex(box.min);
            const glm::ivec3 most = field.floorIndex(box.max) + 1;
            const glm::dvec3 normal = glm::cross(points_[b] - points_[a], points_[c] - points_[a]);
            for (int k = least.z; k <= most.z; ++k) {
                for (int j = least.y; j <= most.y; ++j) {
                    const glm::dvec3 row = field.positionOf({0, j, k});
                    const int windingChange =
                        signedRayCrossing(a, b, row) + signedRayCrossing(b, c, row) + signedRayCrossing(c, a, row);
                    if (windingChange == 0) continue;
                    const glm::dvec3 to = row - points_[a];
                    const double x = points_[a].x - (normal.y * to.y + normal.z * to.z) / normal.x;
                    lines[lineKey(j, k)].push_back({std::clamp(x, box.min.x, box.max.x), windingChange, triangle.cell});
                }
            }
        }
        for (auto& [where, hits] : lines) {
            budget_.checkTimeAndStop();
            std::ranges::sort(hits, {}, &LineCrossing::at);
            const int j = static_cast<int>(where >> 32U) - kShift;
            const int k = static_cast<int>(where & 0xffffffffU) - kShift;
            int winding = 0;
            for (std::size_t h = 0; h + 1 < hits.size(); ++h) {
                winding += hits[h].windingChange;
                if (winding == 0) continue;
                const int first = field.floorIndex({hits[h].at, 0, 0}).x + 1;
                const int last = field.floorIndex({hits[h + 1].at, 0, 0}).x;
                for (int i = first; i <= last; ++i) field[{i, j, k}] = -1;
                // marchTetrahedra() visits a cube only if the block of its lowest corner exists. Create this block for
                // all cubes around the points that were set above.
                for (int i = first - 1; i <= last; ++i) {
                    for (const int n : {j - 1, j}) {
                        field.ensureBlock({i, n, k});
                        field.ensureBlock({i, n, k - 1});
                    }
                }
            }
        }
    }

    /// Divides space into cubic boxes with this width. Sets boxes_: for each box, the triangles that may intersect it.
    void sortTrianglesIntoBoxes(double width) {
        width_ = width;
        for (std::uint32_t p = 0; p < triangles_.size(); ++p) {
            budget_.checkTimeAndStop();
            const auto& corners = triangles_[p].corners;
            BoundingBox box;
            for (const std::uint32_t corner : corners) box.include(points_[corner]);
            const glm::dvec3 base = points_[corners[0]];
            const glm::dvec3 normal = glm::cross(points_[corners[1]] - base, points_[corners[2]] - base);
            const double reach = 0.51 * width * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
            const glm::ivec3 least = boxAt(box.min);
            const glm::ivec3 most = boxAt(box.max);
            for (int z = least.z; z <= most.z; ++z) {
                for (int y = least.y; y <= most.y; ++y) {
                    for (int x = least.x; x <= most.x; ++x) {
                        const glm::dvec3 middle = box_.min + width * (glm::dvec3(x, y, z) + 0.5);
                        if (std::abs(glm::dot(middle - base, normal)) <= reach) boxes_[boxKey({x, y, z})].push_back(p);
                    }
                }
            }
        }
    }

    /// Returns the first crossing on the way from `outside` to `inside` at which the winding number becomes nonzero. If
    /// there is none because of rounding errors, returns the middle of the way with kNoCell.
    EdgeCrossing findCrossing(const glm::dvec3& inside, const glm::dvec3& outside) const {
        std::vector<std::uint32_t> near;
        const glm::ivec3 least = boxAt(glm::min(inside, outside));
        const glm::ivec3 most = boxAt(glm::max(inside, outside));
        for (int z = least.z; z <= most.z; ++z) {
            for (int y = least.y; y <= most.y; ++y) {
                for (int x = least.x; x <= most.x; ++x) {
                    const auto found = boxes_.find(boxKey({x, y, z}));
                    if (found != boxes_.end()) near.insert(near.end(), found->second.begin(), found->second.end());
                }
            }
        }
        std::ranges::sort(near);
        near.erase(std::unique(near.begin(), near.end()), near.end());
        std::vector<LineCrossing> hits;
        const glm::dvec3 way = inside - outside;
        for (const std::uint32_t p : near) {
            // The method of T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
            const auto& [a, b, c] = triangles_[p].corners;
            const glm::dvec3 u = points_[b] - points_[a];
            const glm::dvec3 v = points_[c] - points_[a];
            const glm::dvec3 across = glm::cross(way, v);
            const double determinant = glm::dot(u, across);
            if (determinant == 0) continue;
            const glm::dvec3 to = outside - points_[a];
            const double s = glm::dot(to, across) / determinant;
            const glm::dvec3 up = glm::cross(to, u);
            const double t = glm::dot(way, up) / determinant;
            const double at = glm::dot(v, up) / determinant;
            if (s < 0 || t < 0 || s + t > 1 || at < 0 || at > 1) continue;
            hits.push_back({at, determinant > 0 ? 1 : -1, triangles_[p].cell});
        }
        std::ranges::sort(hits, {}, &LineCrossing::at);
        int winding = 0;
        for (const LineCrossing& hit : hits) {
            winding += hit.windingChange;
            if (winding != 0) return {1 - hit.at, hit.cell};
        }
        return {};
    }

    glm::ivec3 boxAt(const glm::dvec3& place) const { return {glm::floor((place - box_.min) / width_)}; }
    static constexpr int kShift = 1 << 20;
    static std::uint64_t lineKey(int j, int k) {
        return std::uint64_t{static_cast<std::uint32_t>(j + kShift)} << 32U | static_cast<std::uint32_t>(k + kShift);
    }
    static std::uint64_t boxKey(const glm::ivec3& box) {
        const auto bits = [](int i) { return std::uint64_t{static_cast<std::uint32_t>(i + kShift)}; };
        return bits(box.z) << 42U | bits(box.y) << 21U | bits(box.x);
    }

    const ExportBudget& budget_;
    std::vector<glm::dvec3> points_;
    std::vector<FanTriangle> triangles_;
    BoundingBox box_;
    double width_ = 1;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> boxes_;
};

}  // namespace

Mesh outerSurfaceOf(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid,
                    const ExportBudget& budget) {
    return OuterSurfaceMesher(slices, i, scale, budget).makeMesh(grid);
}

}  // namespace oval4d::exports
