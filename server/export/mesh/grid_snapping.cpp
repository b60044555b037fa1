#include "export/mesh/grid_snapping.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <unordered_set>
#include <utility>

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>

#include "geometry/index.hpp"

namespace oval4d::exports {

namespace {

using geometry::kNone;

// Half-edge 3t + i leads from corner i of triangle t to the next corner of t.
std::uint32_t triangleOf(std::uint32_t edge) { return edge / 3; }
std::uint32_t nextHalfEdge(std::uint32_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
std::uint32_t previousHalfEdge(std::uint32_t edge) { return edge % 3 == 0 ? edge + 2 : edge - 1; }

/// A hash function for points on the grid, whose coordinates are in grid steps.
struct PositionHash {
    std::size_t operator()(const glm::i64vec3& at) const {
        std::uint64_t hash = 0;
        for (int i = 0; i < 3; ++i) hash = (hash ^ hash >> 29U ^ static_cast<std::uint64_t>(at[i])) * kOddMultiplier;
        return static_cast<std::size_t>(hash ^ hash >> 32U);
    }
    static constexpr std::uint64_t kOddMultiplier = 0x9e3779b97f4a7c15ULL;
};
using PositionSet = std::unordered_set<glm::i64vec3, PositionHash>;

/// Returns whether a · b = c · d, exactly, for whole numbers between −2⁵³ and 2⁵³. An exact product is the sum of the
/// rounded product and its rounding error, which fma() returns exactly.
bool productsAreEqual(double a, double b, double c, double d) {
    const double first = a * b, second = c * d;
    return first == second && std::fma(a, b, -first) == std::fma(c, d, -second);
}

/// A closed surface, stored as half-edges. Each half-edge has a twin: the half-edge of the neighboring triangle that
/// joins the same points in the opposite direction.
class HalfEdgeMesh {
  public:
    HalfEdgeMesh(std::span<const glm::dvec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                 const RoundingGrid& grid, const ExportBudget& budget)
        : grid_(grid), budget_(budget) {
        for (const auto& triangle : triangles) origins_.insert(origins_.end(), triangle.begin(), triangle.end());
        removed_.assign(triangles.size(), false);
        pairTwins();
        budget_.checkTimeAndStop();
        separateFans(points);
    }

    /// Removes connected parts that are smaller than `least` grid steps along all axes.
    void removeSmallParts(std::int64_t least) {
        std::vector<bool> seen(removed_.size());
        std::vector<std::uint32_t> part;
        for (std::uint32_t start = 0; start < removed_.size(); ++start) {
            if (seen[start]) continue;
            part.assign(1, start);
            seen[start] = true;
            glm::i64vec3 low = at_[origins_[3 * start]], high = low;
            for (std::size_t i = 0; i < part.size(); ++i) {
                for (std::uint32_t edge = 3 * part[i]; edge < 3 * part[i] + 3; ++edge) {
                    low = glm::min(low, at_[origins_[edge]]);
                    high = glm::max(high, at_[origins_[edge]]);
                    const std::uint32_t next = triangleOf(twins_[edge]);
                    if (!seen[next]) part.push_back(next);
                    seen[next] = true;
                }
            }
            const glm::i64vec3 size = high - low;
            if (std::max({size.x, size.y, size.z}) >= least) continue;
            for (const std::uint32_t triangle : part) removed_[triangle] = true;
        }
    }

    /// Collapses edges whose ends are equal on the grid (see collapseEdge()), as long as any edge can be collapsed.
    void collapseEdges() {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t edge = 0; edge < origins_.size(); ++edge) {
                if (!removed_[triangleOf(edge)] && at_[origins_[edge]] == at_[endOf(edge)])
                    changed |= collapseEdge(edge);
            }
            budget_.checkTimeAndStop();
        }
    }

    /// Flips the longest edge of each triangle whose corners lie on a line (see flipEdge()).
    void flipDegenerateTriangles() {
        constexpr int kRounds = 4;
        for (int round = 0; round < kRounds; ++round) {
            for (std::uint32_t t = 0; t < removed_.size(); ++t) {
                if (removed_[t] || !isDegenerateTriangleAt(3 * t)) continue;
                std::uint32_t longest = 3 * t;
                for (std::uint32_t edge = 3 * t + 1; edge < 3 * t + 3; ++edge)
                    longest = lengthOf(edge) > lengthOf(longest) ? edge : longest;
                flipEdge(longest);
            }
            budget_.checkTimeAndStop();
        }
    }

    /// Moves each point that has the same position as an earlier point to a free grid point nearby.
    void separateCoincidingPoints() {
        PositionSet taken;
        for (std::uint32_t point = 0; point < at_.size(); ++point) {
            if (outgoing_[point] == kNone || removed_[triangleOf(outgoing_[point])]) continue;
            if (taken.insert(at_[point]).second) continue;
            at_[point] = nearestFreePosition(at_[point], taken);
            taken.insert(at_[point]);
        }
    }

    SnappedSurface toSnappedSurface() const {
        SnappedSurface result;
        std::vector<std::uint32_t> number(at_.size(), kNone);
        const auto numberOf = [&](std::uint32_t point) {
            if (number[point] == kNone) {
                number[point] = static_cast<std::uint32_t>(result.source.size());
                result.mesh.points.push_back(glm::dvec3(at_[point]) * grid_.step());
                result.source.push_back(sources_[point]);
            }
            return number[point];
        };
        for (std::uint32_t t = 0; t < removed_.size(); ++t) {
            if (removed_[t]) continue;
            const std::uint32_t a = numberOf(origins_[3 * t]), b = numberOf(origins_[3 * t + 1]);
            result.mesh.add(a, b, numberOf(origins_[3 * t + 2]), kNoCell);
        }
        return result;
    }

  private:
    std::uint32_t endOf(std::uint32_t edge) const { return origins_[nextHalfEdge(edge)]; }
    /// Returns the next half-edge with the same origin, in counterclockwise order.
    std::uint32_t nextAroundOrigin(std::uint32_t edge) const { return twins_[previousHalfEdge(edge)]; }

    void pairTwins() {
        struct HalfEdge {
            std::uint64_t ends;  // both points, the smaller index first
            std::uint32_t edge;
            bool upward;  // whether the half-edge starts at the smaller index
        };
        std::vector<HalfEdge> halfEdges;
        halfEdges.reserve(origins_.size());
        for (std::uint32_t edge = 0; edge < origins_.size(); ++edge) {
            const auto [low, high] = std::minmax({origins_[edge], endOf(edge)});
            halfEdges.push_back({std::uint64_t{low} << 32U | high, edge, origins_[edge] == low});
        }
        // After sorting, half-edges with the same ends follow one another: first those from the larger index to the
        // smaller, then those in the opposite direction.
        std::ranges::sort(halfEdges, [](const HalfEdge& a, const HalfEdge& b) {
            return std::tuple(a.ends, a.upward, a.edge) < std::tuple(b.ends, b.upward, b.edge);
        });
        twins_.assign(origins_.size(), kNone);
        for (auto first = halfEdges.begin(); first != halfEdges.end();) {
            const auto last =
                std::find_if(first, halfEdges.end(), [&](const HalfEdge& each) { return each.ends != first->ends; });
            const auto up = std::find_if(first, last, [](const HalfEdge& each) { return each.upward; });
            if (up - first != last - up) throw std::invalid_argument("the surface is not closed");
            for (auto down = first, to = up; to != last; ++down, ++to) {
                twins_[down->edge] = to->edge;
                twins_[to->edge] = down->edge;
            }
            first = last;
        }
    }

    // Gives each fan a point of its own, at which the half-edges of the fan start. A fan is a ring of triangles around
    // a point; a point may have several fans.
    void separateFans(std::span<const glm::dvec3> points) {
        std::vector<bool> seen(origins_.size());
        std::vector<std::uint32_t> pointOf(origins_.size());
        for (std::uint32_t edge = 0; edge < origins_.size(); ++edge) {
            if (seen[edge]) continue;
            const auto point = static_cast<std::uint32_t>(at_.size());
            for (std::uint32_t around = edge; !seen[around]; around = nextAroundOrigin(around)) {
                seen[around] = true;
                pointOf[around] = point;
            }
            sources_.push_back(origins_[edge]);
            at_.emplace_back(glm::round(grid_.snap(points[origins_[edge]]) / grid_.step()));
            outgoing_.push_back(edge);
        }
        origins_ = std::move(pointOf);
    }

    void findNeighborsOfOrigin(std::uint32_t edge, std::vector<std::uint32_t>& out) const {
        out.clear();
        std::uint32_t around = edge;
        do {
            out.push_back(endOf(around));
            around = nextAroundOrigin(around);
        } while (around != edge);
        std::ranges::sort(out);
    }

    // Collapses an edge into its origin and returns true. Returns false and changes nothing in two cases: the ends of
    // the edge have a common neighbor other than the third corners of the two triangles at the edge, or the surface is
    // a tetrahedron, which would become flat.
    bool collapseEdge(std::uint32_t edge) {
        const std::uint32_t twin = twins_[edge], kept = origins_[edge], lost = origins_[twin];
        findNeighborsOfOrigin(edge, neighbors_);
        findNeighborsOfOrigin(twin, otherNeighbors_);
        common_.clear();
        std::ranges::set_intersection(neighbors_, otherNeighbors_, std::back_inserter(common_));
        if (common_.size() != 2 || (neighbors_.size() == 3 && otherNeighbors_.size() == 3)) return false;
        std::uint32_t around = twin;
        do {
            origins_[around] = kept;
            around = nextAroundOrigin(around);
        } while (around != twin);
        outgoing_[lost] = kNone;
        for (const std::uint32_t side : {edge, twin}) {
            const std::uint32_t a = twins_[nextHalfEdge(side)], b = twins_[previousHalfEdge(side)];
            twins_[a] = b;
            twins_[b] = a;
            outgoing_[origins_[a]] = a;
            outgoing_[origins_[b]] = b;
            removed_[triangleOf(side)] = true;
        }
        return true;
    }

    // The components of these vectors are whole numbers, in grid steps.
    glm::dvec3 vectorBetween(std::uint32_t from, std::uint32_t to) const { return glm::dvec3(at_[to] - at_[from]); }
    glm::dvec3 vectorOf(std::uint32_t edge) const { return vectorBetween(origins_[edge], endOf(edge)); }
    double lengthOf(std::uint32_t edge) const {
        const glm::dvec3 v = vectorOf(edge);
        return v.x * v.x + v.y * v.y + v.z * v.z;
    }
    static bool areParallel(const glm::dvec3& a, const glm::dvec3& b) {
        return productsAreEqual(a.y, b.z, a.z, b.y) && productsAreEqual(a.z, b.x, a.x, b.z) &&
               productsAreEqual(a.x, b.y, a.y, b.x);
    }
    bool isDegenerateTriangleAt(std::uint32_t edge) const {
        return areParallel(vectorOf(edge), vectorOf(nextHalfEdge(edge)));
    }

    // Flips an edge: replaces it by an edge between the third corners of the two triangles at the edge. Changes nothing
    // if an edge already joins these corners, or if the corners of a new triangle would lie on a line.
    void flipEdge(std::uint32_t h) {
        const std::uint32_t g = twins_[h], h1 = nextHalfEdge(h), h2 = previousHalfEdge(h), g1 = nextHalfEdge(g),
                            g2 = previousHalfEdge(g);
        const std::uint32_t p = origins_[h], r = origins_[g], q = origins_[h2], s = origins_[g2];
        findNeighborsOfOrigin(h2, neighbors_);
        if (q == s || std::ranges::binary_search(neighbors_, s)) return;
        const auto isLine = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            return areParallel(vectorBetween(a, b), vectorBetween(a, c));
        };
        if (isLine(q, p, s) || isLine(q, s, r)) return;
        const std::array<std::uint32_t, 4> outer{twins_[h1], twins_[h2], twins_[g1], twins_[g2]};
        const auto set = [&](std::uint32_t edge, std::uint32_t origin, std::uint32_t twin) {
            origins_[edge] = origin;
            twins_[edge] = twin;
            twins_[twin] = edge;
            outgoing_[origin] = edge;
        };
        set(h, s, g);
        set(h1, q, outer[1]);
        set(h2, p, outer[2]);
        set(g, q, h);
        set(g1, s, outer[3]);
        set(g2, r, outer[0]);
    }

    static glm::i64vec3 nearestFreePosition(const glm::i64vec3& at, const PositionSet& taken) {
        for (int reach = 1;; ++reach) {
            for (int z = -reach; z <= reach; ++z) {
                for (int y = -reach; y <= reach; ++y) {
                    for (int x = -reach; x <= reach; ++x) {
                        const glm::i64vec3 other = at + glm::i64vec3(x, y, z);
                        if (!taken.contains(other)) return other;
                    }
                }
            }
        }
    }

    const RoundingGrid& grid_;
    const ExportBudget& budget_;
    std::vector<std::uint32_t> origins_, twins_;  // for each half-edge: its first point, and its twin
    std::vector<bool> removed_;                   // for each triangle: whether it was removed
    std::vector<glm::i64vec3> at_;                // for each point: its position in grid steps
    std::vector<std::uint32_t> sources_;          // for each point: the input point from which it was made
    // For each point: a half-edge that starts there; kNone if the point was merged into another point.
    std::vector<std::uint32_t> outgoing_;
    std::vector<std::uint32_t> neighbors_, otherNeighbors_, common_;
};

}  // namespace

SnappedSurface snapSurface(std::span<const glm::dvec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                           const RoundingGrid& grid, const ExportBudget& budget) {
    constexpr std::int64_t kLeastSteps = 4;
    HalfEdgeMesh surface(points, triangles, grid, budget);
    surface.removeSmallParts(kLeastSteps);
    surface.collapseEdges();
    surface.flipDegenerateTriangles();
    surface.separateCoincidingPoints();
    return surface.toSnappedSurface();
}

}  // namespace oval4d::exports
