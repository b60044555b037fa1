#include "polytopes/import/coplanar_merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "geometry/index.hpp"
#include "polytopes/import/flat.hpp"
#include "polytopes/import/polygon_merge.hpp"
#include "polytopes/import/triangle_edges.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;
constexpr double kAmbiguityFactor = 3;  // cells that would be merged with error bounds this many times as large are
                                        // ambiguous
constexpr int kMaxCorrections = 32;

// Returns the triangle of `simplex` that lies opposite simplex.vertices[vertex]; `vertex` is from 0 to 3.
Triangle triangleOpposite(std::size_t vertex, const SimplexFacet& simplex) {
    Triangle triangle{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        if (i != vertex) triangle.at(at++) = simplex.vertices.at(i);
    }
    return triangle;
}

// Returns the corner of `triangle` that does not lie on `edge`, one of its edges.
std::uint32_t cornerOpposite(const Edge& edge, const Triangle& triangle) {
    return *std::find_if(triangle.begin(), triangle.end(),
                         [&](std::uint32_t v) { return v != edge.first && v != edge.second; });
}

class SimplexMerger {
  public:
    SimplexMerger(std::span<const SimplexFacet> simplices, std::span<const glm::dvec4> points, const HullFrame& frame)
        : simplices_(simplices),
          points_(points),
          frame_(frame),
          cellOf_(simplices.size(), kNone),
          mark_(simplices.size(), 0),
          signs_(simplices.size(), 0) {
        for (const SimplexFacet& simplex : simplices_)
            volumes_.push_back(HyperplaneThroughPoints(simplex.vertices, points_).parallelotopeVolume());
        orientSimplices();
    }

    MergedHull merge() {
        mergeSimplices();
        collectTrianglesBetweenCells();
        unmerged_.assign(hyperplanes_.size(), false);
        MergedHull hull;
        do hull = mergeTriangles();
        while (markDegenerateCells(hull));
        countAmbiguousCellPairs(hull);
        return hull;
    }

  private:
    // A triangle on the boundary of a group of simplices.
    struct BoundaryTriangle {
        Triangle corners;
        std::uint32_t simplex;
        double sign;  // +1 if the normal, by the right-hand rule, points out of the group, else −1
    };
    // A triangle that two cells share; `cells` lists the cell with the smaller index first.
    struct TriangleBetweenCells {
        std::array<std::uint32_t, 2> cells;
        Triangle corners;
    };

    // Sets signs_ such that all simplices are oriented coherently. A simplex with the sign +1 has the orientation in
    // which its vertices are in ascending order; a simplex with the sign −1 has the opposite orientation.
    void orientSimplices() {
        std::vector<std::uint32_t> waiting{0};
        signs_[0] = 1;
        while (!waiting.empty()) {
            const std::uint32_t s = waiting.back();
            waiting.pop_back();
            for (std::size_t i = 0; i < 4; ++i) {
                const std::uint32_t t = simplices_[s].neighbors.at(i);
                if (signs_[t] != 0) continue;
                const auto& back = simplices_[t].neighbors;
                const auto j = static_cast<std::size_t>(std::find(back.begin(), back.end(), s) - back.begin());
                signs_[t] = static_cast<std::int8_t>((i + j) % 2 == 0 ? -signs_[s] : signs_[s]);
                waiting.push_back(t);
            }
        }
    }

    // Merges simplices into cells, each of which grows from a seed simplex. Larger simplices become seeds before
    // smaller ones: the hyperplane of a small or nearly flat simplex is uncertain, so such a simplex must join the cell
    // of a larger one.
    void mergeSimplices() {
        std::vector<std::uint32_t> order(simplices_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return volumes_[a] > volumes_[b]; });
        for (const std::uint32_t seed : order) {
            if (cellOf_[seed] != kNone) continue;
            HyperplaneThroughPoints hyperplane(simplices_[seed].vertices, points_);
            const auto growIn = [&](const HyperplaneThroughPoints& flat) {
                return growRegion(seed, [&](std::uint32_t s, std::uint32_t fresh) {
                    return cellOf_[s] == kNone && flat.contains(points_[fresh], frame_);
                });
            };
            const auto vertices = [&](const auto& some) { return verticesOf(some); };
            auto group = growAndRefit(hyperplane, simplices_[seed].vertices, growIn, vertices, points_, frame_);
            shrinkGroupUntilConvex(seed, hyperplane, group);
            const auto cell = static_cast<std::uint32_t>(hyperplanes_.size());
            for (const std::uint32_t s : group) cellOf_[s] = cell;
            hyperplanes_.push_back(group.size() > 1 ? hyperplane
                                                    : HyperplaneThroughPoints(simplices_[seed].vertices, points_));
        }
    }

    // Returns a group of simplices: `seed`, and all that can be reached from it by steps to accepted neighbors. Sets
    // mark_ of each of these simplices to latestMark_, a new number. accepts(t, v) returns whether simplex t may join
    // the group; v is the vertex of t that is not a vertex of the neighbor from which t is reached.
    template <typename Accepts>
    std::vector<std::uint32_t> growRegion(std::uint32_t seed, Accepts accepts) {
        ++latestMark_;
        std::vector<std::uint32_t> group{seed};
        mark_[seed] = latestMark_;
        for (std::size_t at = 0; at < group.size(); ++at) {
            const std::uint32_t s = group[at];
            for (const std::uint32_t t : simplices_[s].neighbors) {
                if (mark_[t] == latestMark_) continue;
                const auto& back = simplices_[t].neighbors;
                const auto j = static_cast<std::size_t>(std::find(back.begin(), back.end(), s) - back.begin());
                if (!accepts(t, simplices_[t].vertices.at(j))) continue;
                mark_[t] = latestMark_;
                group.push_back(t);
            }
        }
        return group;
    }

    std::vector<std::uint32_t> verticesOf(std::span<const std::uint32_t> group) const {
        std::vector<std::uint32_t> all;
        for (const std::uint32_t s : group)
            all.insert(all.end(), simplices_[s].vertices.begin(), simplices_[s].vertices.end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }

    // Removes simplices from the group until it forms a convex cell; in the worst case, removes all but the seed.
    void shrinkGroupUntilConvex(std::uint32_t seed, const HyperplaneThroughPoints& hyperplane,
                                std::vector<std::uint32_t>& group) {
        for (int i = 0; i < kMaxCorrections && group.size() > 1; ++i) {
            const auto faults = simplicesToRemove(seed, hyperplane, group);
            if (faults.empty()) return;
            std::vector<std::uint32_t> kept;
            std::set_difference(group.begin(), group.end(), faults.begin(), faults.end(), std::back_inserter(kept));
            group = growRegion(seed, [&](std::uint32_t s, std::uint32_t /*fresh*/) {
                return std::binary_search(kept.begin(), kept.end(), s);
            });
        }
        if (group.size() > 1) group = {seed};
    }

    // Returns simplices of the group whose removal may make the group convex, in ascending order. The result does not
    // include the seed. Returns an empty list if the group is convex. Sorts the group.
    std::vector<std::uint32_t> simplicesToRemove(std::uint32_t seed, const HyperplaneThroughPoints& hyperplane,
                                                 std::vector<std::uint32_t>& group) const {
        std::sort(group.begin(), group.end());
        std::vector<BoundaryTriangle> triangles;
        for (const std::uint32_t s : group) {
            for (std::size_t i = 0; i < 4; ++i) {
                if (mark_[simplices_[s].neighbors.at(i)] == latestMark_) continue;
                triangles.push_back(
                    {triangleOpposite(i, simplices_[s]), s, i % 2 == 0 ? 1.0 * signs_[s] : -1.0 * signs_[s]});
            }
        }
        const auto& own = simplices_[seed].vertices;
        const auto at = [&](std::uint32_t v) {
            const auto along = hyperplane.project(points_[v]);
            return glm::dvec3(along[0], along[1], along[2]);
        };
        const double turn =
            glm::dot(at(own[1]) - at(own[0]), glm::cross(at(own[2]) - at(own[0]), at(own[3]) - at(own[0])));
        for (BoundaryTriangle& triangle : triangles) triangle.sign *= turn * signs_[seed] < 0 ? -1 : 1;

        const std::vector<TriangleEdge> triangleEdges =
            sortedTriangleEdges(triangles, [](const BoundaryTriangle& t) -> const Triangle& { return t.corners; });
        std::vector<std::uint32_t> faults;
        const auto blame = [&](std::uint32_t one, std::uint32_t other) {
            if (one == seed || (other != seed && volumes_[other] < volumes_[one])) std::swap(one, other);
            if (one != seed) faults.push_back(one);
        };
        for (std::size_t i = 0, end = 0; i < triangleEdges.size(); i = end) {
            while (end < triangleEdges.size() && triangleEdges[end].edge == triangleEdges[i].edge) ++end;
            const BoundaryTriangle& one = triangles[triangleEdges[i].triangle];
            if (end - i != 2) {
                for (std::size_t k = i + 1; k < end; ++k)
                    blame(one.simplex, triangles[triangleEdges[k].triangle].simplex);
                continue;
            }
            const BoundaryTriangle& other = triangles[triangleEdges[i + 1].triangle];
            if (!isConvexEdge(one, other, triangleEdges[i].edge, hyperplane)) blame(one.simplex, other.simplex);
        }
        if (faults.empty()) {
            std::vector<std::uint32_t> corners;
            for (const BoundaryTriangle& triangle : triangles)
                corners.insert(corners.end(), triangle.corners.begin(), triangle.corners.end());
            std::sort(corners.begin(), corners.end());
            corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
            // The boundary is a sphere only if V − E + F = 2 for its V corners, E edges and F triangles. With
            // 2 E = 3 F, the condition is 2 V = F + 4.
            if (2 * corners.size() != triangles.size() + 4) {
                faults = group;
                std::erase(faults, seed);
            }
        }
        std::sort(faults.begin(), faults.end());
        faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
        return faults;
    }

    // Returns whether two triangles of a boundary meet at a convex edge, within the error bounds of their corners.
    bool isConvexEdge(const BoundaryTriangle& one, const BoundaryTriangle& other, const Edge& edge,
                      const HyperplaneThroughPoints& hyperplane) const {
        const auto place = [&](std::uint32_t v) {
            const auto along = hyperplane.project(points_[v]);
            return glm::dvec3(along[0], along[1], along[2]);
        };
        const glm::dvec3 a = place(edge.first);
        const glm::dvec3 along = place(edge.second) - a;
        struct HeightAboveNeighbor {
            glm::dvec3 normal;  // the outward unit normal of the triangle `from` (see heightFrom())
            // The corner of the triangle `to` that is not on the common edge has a height above the plane of `from`,
            // positive outward; `uncertain` is the error bound of this height. `reach` is the distance of the corner
            // from the line through the edge.
            double height = 0, uncertain = 0, reach = 0;
        };
        const auto heightFrom = [&](const BoundaryTriangle& from, const BoundaryTriangle& to) {
            HeightAboveNeighbor height;
            const glm::dvec3 q = place(from.corners[0]);
            height.normal = from.sign * glm::cross(place(from.corners[1]) - q, place(from.corners[2]) - q);
            const double size = glm::length(height.normal);
            const std::uint32_t v = cornerOpposite(edge, to.corners);
            const glm::dvec3 third = place(v) - a;
            height.reach = glm::length(glm::cross(along, third)) / glm::length(along);
            if (!(size > 0)) {
                height.uncertain = std::numeric_limits<double>::infinity();
                return height;
            }
            height.normal /= size;
            height.height = glm::dot(height.normal, third);
            const glm::dvec4 direction = height.normal.x * hyperplane.basisVector(0) +
                                         height.normal.y * hyperplane.basisVector(1) +
                                         height.normal.z * hyperplane.basisVector(2);
            height.uncertain = frame_.errorBound(direction) *
                               (1 + PlaneThroughPoints(from.corners, points_).cornerErrorFactor(points_[v]));
            return height;
        };
        const HeightAboveNeighbor there = heightFrom(one, other), back = heightFrom(other, one);
        if (there.height > there.uncertain || back.height > back.uncertain) return false;
        const bool folded = glm::dot(there.normal, back.normal) < 0 && std::abs(there.height) <= there.uncertain &&
                            std::abs(back.height) <= back.uncertain && there.reach > there.uncertain &&
                            back.reach > back.uncertain;
        return !folded;
    }

    void collectTrianglesBetweenCells() {
        for (std::uint32_t s = 0; s < simplices_.size(); ++s) {
            for (std::size_t i = 0; i < 4; ++i) {
                const std::uint32_t other = cellOf_[simplices_[s].neighbors.at(i)];
                if (cellOf_[s] < other)
                    trianglesBetweenCells_.push_back({{cellOf_[s], other}, triangleOpposite(i, simplices_[s])});
            }
        }
        std::sort(trianglesBetweenCells_.begin(), trianglesBetweenCells_.end(),
                  [](const TriangleBetweenCells& a, const TriangleBetweenCells& b) {
                      return std::pair(a.cells, a.corners) < std::pair(b.cells, b.corners);
                  });
    }

    MergedHull mergeTriangles() const {
        MergedHull hull;
        std::vector<std::vector<std::uint32_t>> facesOf(hyperplanes_.size());
        for (std::size_t i = 0, end = 0; i < trianglesBetweenCells_.size(); i = end) {
            while (end < trianglesBetweenCells_.size() &&
                   trianglesBetweenCells_[end].cells == trianglesBetweenCells_[i].cells)
                ++end;
            const auto [a, b] = trianglesBetweenCells_[i].cells;
            const std::size_t before = hull.faces.size();
            const auto between = std::span(trianglesBetweenCells_).subspan(i, end - i);
            if (between.size() == 1 || unmerged_[a] || unmerged_[b]) {
                for (const TriangleBetweenCells& shared : between) hull.faces.add(shared.corners);
            } else {
                std::vector<Triangle> triangles;
                for (const TriangleBetweenCells& shared : between) triangles.push_back(shared.corners);
                addMergedPolygons(triangles, points_, frame_, hull.faces);
            }
            for (std::size_t f = before; f < hull.faces.size(); ++f) {
                facesOf[a].push_back(static_cast<std::uint32_t>(f));
                facesOf[b].push_back(static_cast<std::uint32_t>(f));
            }
        }
        for (const auto& faces : facesOf) hull.cells.add(faces);
        return hull;
    }

    // Marks the cells of `hull` that have fewer than four 2-faces, so that the next call of mergeTriangles() does not
    // merge the triangles of these cells. Returns false if there are no such cells.
    bool markDegenerateCells(const MergedHull& hull) {
        bool any = false;
        for (std::size_t c = 0; c < hull.cells.size(); ++c) {
            if (hull.cells[c].size() >= 4) continue;
            any = true;
            unmerged_[c] = true;
        }
        return any;
    }

    void countAmbiguousCellPairs(MergedHull& hull) const {
        for (std::size_t i = 0, end = 0; i < trianglesBetweenCells_.size(); i = end) {
            while (end < trianglesBetweenCells_.size() &&
                   trianglesBetweenCells_[end].cells == trianglesBetweenCells_[i].cells)
                ++end;
            const HyperplaneThroughPoints& one = hyperplanes_[trianglesBetweenCells_[i].cells[0]];
            const HyperplaneThroughPoints& other = hyperplanes_[trianglesBetweenCells_[i].cells[1]];
            const auto nearly = [&](const HyperplaneThroughPoints& a, const HyperplaneThroughPoints& b) {
                return std::all_of(b.corners().begin(), b.corners().end(),
                                   [&](std::uint32_t v) { return a.contains(points_[v], frame_, kAmbiguityFactor); });
            };
            if (nearly(one, other) || nearly(other, one)) ++hull.ambiguousCellPairs;
        }
    }

    std::span<const SimplexFacet> simplices_;
    std::span<const glm::dvec4> points_;
    const HullFrame& frame_;
    std::vector<double> volumes_;
    std::vector<std::uint32_t> cellOf_;
    std::vector<std::uint32_t> mark_;
    std::uint32_t latestMark_ = 0;
    std::vector<std::int8_t> signs_;
    std::vector<HyperplaneThroughPoints> hyperplanes_;  // the hyperplane of each cell
    std::vector<TriangleBetweenCells> trianglesBetweenCells_;
    std::vector<bool> unmerged_;  // per cell: whether mergeTriangles() must not merge the triangles of the cell
};

}  // namespace

MergedHull mergeCoplanar(std::span<const SimplexFacet> simplices, std::span<const glm::dvec4> points,
                         const HullFrame& frame) {
    return SimplexMerger(simplices, points, frame).merge();
}

}  // namespace oval4d::polytopes
