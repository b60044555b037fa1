#include "polytopes/import/coplanar_merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geometry/index.hpp"

namespace oval4d::polytopes {

namespace {

using geometry::kNone;
constexpr double kMaxAmplification =
    16;  // limit of the factor by which a flat's noise is assumed to grow by extrapolation
constexpr double kAmbiguityFactor = 3;  // deviations up to this many times the expected noise are ambiguous
constexpr int kMaxRefits = 4;
constexpr int kMaxCorrections = 32;

// Greedily chooses points that span a large simplex: each is the farthest from the flat through the points chosen
// before.
template <std::size_t Count>
std::array<std::uint32_t, Count> largeSimplex(std::span<const std::uint32_t> from, std::span<const glm::dvec4> points) {
    glm::dvec4 middle(0);
    for (const std::uint32_t v : from) middle += points[v] / static_cast<double>(from.size());
    std::array<std::uint32_t, Count> chosen{};
    std::array<glm::dvec4, Count> axes{};
    for (std::size_t i = 0; i < Count; ++i) {
        double most = -1;
        for (const std::uint32_t v : from) {
            glm::dvec4 rest = points[v] - (i == 0 ? middle : points[chosen[0]]);
            for (std::size_t k = 1; k < i; ++k) rest -= glm::dot(rest, axes.at(k)) * axes.at(k);
            if (const double length = glm::dot(rest, rest); length > most) {
                most = length;
                chosen.at(i) = v;
                axes.at(i) = length > 0 ? rest / std::sqrt(length) : glm::dvec4(0);
            }
        }
    }
    return chosen;
}

// A flat: the plane or hyperplane through the corners of a simplex. Its position is uncertain due to the corners'
// noise.
template <std::size_t Dimension>
class Flat {
  public:
    using Corners = std::array<std::uint32_t, Dimension + 1>;

    Flat(const Corners& corners, std::span<const glm::dvec4> points) : corners_(corners), origin_(points[corners[0]]) {
        for (std::size_t j = 0; j < Dimension; ++j) {
            glm::dvec4 rest = points[corners.at(j + 1)] - origin_;
            for (std::size_t i = 0; i < j; ++i) {
                edges_.at(j).at(i) = glm::dot(rest, axes_.at(i));
                rest -= edges_.at(j).at(i) * axes_.at(i);
            }
            const double length = glm::length(rest);
            edges_.at(j).at(j) = length;
            axes_.at(j) = length > 0 ? rest / length : glm::dvec4(0);
            volume_ *= length;
        }
    }

    const Corners& corners() const { return corners_; }
    /// Returns the volume of the simplex times the factorial of its dimension.
    double volume() const { return volume_; }
    const glm::dvec4& axis(std::size_t i) const { return axes_.at(i); }

    /// Returns the coordinates, along the axes of the flat, of the point of the flat nearest to p.
    std::array<double, Dimension> project(const glm::dvec4& p) const {
        glm::dvec4 rest = p - origin_;
        std::array<double, Dimension> along;
        for (std::size_t i = 0; i < Dimension; ++i) {
            along.at(i) = glm::dot(rest, axes_.at(i));
            rest -= along.at(i) * axes_.at(i);
        }
        return along;
    }

    /// Returns the factor by which errors of the corners are amplified at p: the sum of the absolute values of its
    /// barycentric coordinates.
    double errorAmplification(const glm::dvec4& p) const {
        std::array<double, Dimension> weights = project(p);
        double sum = 0, first = 1;
        for (std::size_t j = Dimension; j-- > 0;) {
            if (!(edges_.at(j).at(j) > 0)) return std::numeric_limits<double>::infinity();
            weights.at(j) /= edges_.at(j).at(j);
            for (std::size_t i = 0; i < j; ++i) weights.at(i) -= weights.at(j) * edges_.at(j).at(i);
            sum += std::abs(weights.at(j));
            first -= weights.at(j);
        }
        return sum + std::abs(first);
    }

    /// Returns whether p lies in the flat, within a tolerance: `factor` times the sum of the noise of p and that of the
    /// flat at p.
    bool contains(const glm::dvec4& p, const HullFrame& frame, double factor = 1) const {
        glm::dvec4 rest = p - origin_;
        for (const glm::dvec4& axis : axes_) rest -= glm::dot(rest, axis) * axis;
        const double distance = glm::length(rest);
        if (!(distance > 0)) return true;
        return distance <=
               factor * frame.noise(rest / distance) * (1 + std::min(errorAmplification(p), kMaxAmplification));
    }

  private:
    Corners corners_;
    glm::dvec4 origin_;
    std::array<glm::dvec4, Dimension> axes_{};
    std::array<std::array<double, Dimension>, Dimension> edges_{};  // from the first corner, along axes_
    double volume_ = 1;
};

using Plane = Flat<2>;
using Hyperplane = Flat<3>;
using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Returns the triangle opposite a vertex of the simplex.
Triangle oppositeTo(std::size_t vertex, const SimplexFacet& simplex) {
    Triangle triangle{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        if (i != vertex) triangle.at(at++) = simplex.vertices.at(i);
    }
    return triangle;
}

// Returns the corner of the triangle that does not lie on its edge `edge`.
std::uint32_t cornerBeside(const Edge& edge, const Triangle& triangle) {
    return *std::find_if(triangle.begin(), triangle.end(),
                         [&](std::uint32_t v) { return v != edge.first && v != edge.second; });
}

struct Side {
    Edge edge;
    std::uint32_t triangle;
};

// Returns the sides of all triangles, sorted by edge. `corners` maps an element of `triangles` to its corners.
template <typename Triangles, typename Corners>
std::vector<Side> sidesOf(const Triangles& triangles, Corners corners) {
    std::vector<Side> sides;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Triangle& corner = corners(triangles[t]);
        for (std::size_t i = 0; i < 3; ++i) sides.push_back({std::minmax(corner.at(i), corner.at((i + 1) % 3)), t});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
    });
    return sides;
}

class Merger {
  public:
    Merger(std::span<const SimplexFacet> simplices, std::span<const glm::dvec4> points, const HullFrame& frame)
        : simplices_(simplices),
          points_(points),
          frame_(frame),
          cellOf_(simplices.size(), kNone),
          mark_(simplices.size(), 0),
          signs_(simplices.size(), 0) {
        for (const SimplexFacet& simplex : simplices_)
            volumes_.push_back(Hyperplane(simplex.vertices, points_).volume());
        orient();
    }

    MergedHull run() {
        mergeSimplices();
        collectBorders();
        unmerged_.assign(hyperplanes_.size(), false);
        MergedHull hull;
        do hull = mergeTriangles();
        while (splitDegenerateCells(hull));
        countAmbiguousRidges(hull);
        return hull;
    }

  private:
    // A triangle on the boundary of a group of simplices.
    struct Facet {
        Triangle corners;
        std::uint32_t simplex;
        double sign;  // +1 if its normal, by the right-hand rule, points outward, else −1
    };
    // A triangle between two cells, the one with the smaller index first.
    struct Border {
        std::array<std::uint32_t, 2> cells;
        Triangle corners;
    };

    // Finds a sign for each simplex such that all are oriented coherently. The sign +1 means the orientation given by
    // the ascending order of the vertices.
    void orient() {
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

    // Grows cells from seed simplices. The largest simplices are the first seeds, so that nearly flat simplices, whose
    // hyperplanes are uncertain, join larger ones.
    void mergeSimplices() {
        std::vector<std::uint32_t> order(simplices_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return volumes_[a] > volumes_[b]; });
        for (const std::uint32_t seed : order) {
            if (cellOf_[seed] != kNone) continue;
            Hyperplane hyperplane(simplices_[seed].vertices, points_);
            auto group = grow(seed, [&](std::uint32_t s, std::uint32_t fresh) {
                return cellOf_[s] == kNone && hyperplane.contains(points_[fresh], frame_);
            });
            for (int i = 0; i < kMaxRefits && group.size() > 1; ++i) {
                const Hyperplane wider(largeSimplex<4>(verticesOf(group), points_), points_);
                const auto& own = simplices_[seed].vertices;
                if (!(wider.volume() > 1.01 * hyperplane.volume()) ||
                    !std::all_of(own.begin(), own.end(), [&](auto v) { return wider.contains(points_[v], frame_); })) {
                    break;
                }
                hyperplane = wider;
                group = grow(seed, [&](std::uint32_t s, std::uint32_t fresh) {
                    return cellOf_[s] == kNone && hyperplane.contains(points_[fresh], frame_);
                });
            }
            makeConvex(seed, hyperplane, group);
            const auto cell = static_cast<std::uint32_t>(hyperplanes_.size());
            for (const std::uint32_t s : group) cellOf_[s] = cell;
            hyperplanes_.push_back(group.size() > 1 ? hyperplane : Hyperplane(simplices_[seed].vertices, points_));
        }
    }

    // Returns the simplices that can be reached from `seed` through accepted neighbors, and sets their mark_ to
    // latestMark_. The arguments of `accepts` are a neighbor and the one vertex that it does not share with the current
    // simplex.
    template <typename Accepts>
    std::vector<std::uint32_t> grow(std::uint32_t seed, Accepts accepts) {
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

    // Removes simplices from the group until it forms a convex cell; in the worst case, all but the seed.
    void makeConvex(std::uint32_t seed, const Hyperplane& hyperplane, std::vector<std::uint32_t>& group) {
        for (int i = 0; i < kMaxCorrections && group.size() > 1; ++i) {
            const auto faults = simplicesToRemove(seed, hyperplane, group);
            if (faults.empty()) return;
            std::vector<std::uint32_t> kept;
            std::set_difference(group.begin(), group.end(), faults.begin(), faults.end(), std::back_inserter(kept));
            group = grow(seed, [&](std::uint32_t s, std::uint32_t /*fresh*/) {
                return std::binary_search(kept.begin(), kept.end(), s);
            });
        }
        if (group.size() > 1) group = {seed};
    }

    // Returns the simplices, in ascending order, whose removal may make the group convex; none if the group is convex.
    // Sorts the group.
    std::vector<std::uint32_t> simplicesToRemove(std::uint32_t seed, const Hyperplane& hyperplane,
                                                 std::vector<std::uint32_t>& group) const {
        std::sort(group.begin(), group.end());
        std::vector<Facet> facets;
        for (const std::uint32_t s : group) {
            for (std::size_t i = 0; i < 4; ++i) {
                if (mark_[simplices_[s].neighbors.at(i)] == latestMark_) continue;
                facets.push_back({oppositeTo(i, simplices_[s]), s, i % 2 == 0 ? 1.0 * signs_[s] : -1.0 * signs_[s]});
            }
        }
        const auto& own = simplices_[seed].vertices;
        const auto at = [&](std::uint32_t v) {
            const auto along = hyperplane.project(points_[v]);
            return glm::dvec3(along[0], along[1], along[2]);
        };
        const double turn =
            glm::dot(at(own[1]) - at(own[0]), glm::cross(at(own[2]) - at(own[0]), at(own[3]) - at(own[0])));
        for (Facet& facet : facets) facet.sign *= turn * signs_[seed] < 0 ? -1 : 1;

        const std::vector<Side> sides = sidesOf(facets, [](const Facet& f) -> const Triangle& { return f.corners; });
        std::vector<std::uint32_t> faults;
        const auto blame = [&](std::uint32_t one, std::uint32_t other) {
            if (one == seed || (other != seed && volumes_[other] < volumes_[one])) std::swap(one, other);
            if (one != seed) faults.push_back(one);
        };
        for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
            while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
            const Facet& one = facets[sides[i].triangle];
            if (end - i != 2) {
                for (std::size_t k = i + 1; k < end; ++k) blame(one.simplex, facets[sides[k].triangle].simplex);
                continue;
            }
            const Facet& other = facets[sides[i + 1].triangle];
            if (!isConvexEdge(one, other, sides[i].edge, hyperplane)) blame(one.simplex, other.simplex);
        }
        if (faults.empty()) {
            std::vector<std::uint32_t> corners;
            for (const Facet& facet : facets) corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
            std::sort(corners.begin(), corners.end());
            corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
            // The boundary is not a sphere if V − E + F ≠ 2; for triangles, 2 E = 3 F.
            if (2 * corners.size() != facets.size() + 4) {
                faults = group;
                std::erase(faults, seed);
            }
        }
        std::sort(faults.begin(), faults.end());
        faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
        return faults;
    }

    // Returns whether two triangles of a boundary meet at a convex edge, within the noise of their corners.
    bool isConvexEdge(const Facet& one, const Facet& other, const Edge& edge, const Hyperplane& hyperplane) const {
        const auto place = [&](std::uint32_t v) {
            const auto along = hyperplane.project(points_[v]);
            return glm::dvec3(along[0], along[1], along[2]);
        };
        const glm::dvec3 a = place(edge.first);
        const glm::dvec3 along = place(edge.second) - a;
        struct RelativeHeight {
            glm::dvec3 normal;
            // For the third corner of the other triangle: its height above this triangle, the uncertainty of the
            // height, and its distance from the common edge.
            double height = 0, uncertain = 0, reach = 0;
        };
        const auto heightFrom = [&](const Facet& from, const Facet& to) {
            RelativeHeight height;
            const glm::dvec3 q = place(from.corners[0]);
            height.normal = from.sign * glm::cross(place(from.corners[1]) - q, place(from.corners[2]) - q);
            const double size = glm::length(height.normal);
            const std::uint32_t v = cornerBeside(edge, to.corners);
            const glm::dvec3 third = place(v) - a;
            height.reach = glm::length(glm::cross(along, third)) / glm::length(along);
            if (!(size > 0)) {
                height.uncertain = std::numeric_limits<double>::infinity();
                return height;
            }
            height.normal /= size;
            height.height = glm::dot(height.normal, third);
            const glm::dvec4 direction = height.normal.x * hyperplane.axis(0) + height.normal.y * hyperplane.axis(1) +
                                         height.normal.z * hyperplane.axis(2);
            height.uncertain =
                frame_.noise(direction) * (1 + Plane(from.corners, points_).errorAmplification(points_[v]));
            return height;
        };
        const RelativeHeight there = heightFrom(one, other), back = heightFrom(other, one);
        if (there.height > there.uncertain || back.height > back.uncertain) return false;
        const bool folded = glm::dot(there.normal, back.normal) < 0 && std::abs(there.height) <= there.uncertain &&
                            std::abs(back.height) <= back.uncertain && there.reach > there.uncertain &&
                            back.reach > back.uncertain;
        return !folded;
    }

    void collectBorders() {
        for (std::uint32_t s = 0; s < simplices_.size(); ++s) {
            for (std::size_t i = 0; i < 4; ++i) {
                const std::uint32_t other = cellOf_[simplices_[s].neighbors.at(i)];
                if (cellOf_[s] < other) borders_.push_back({{cellOf_[s], other}, oppositeTo(i, simplices_[s])});
            }
        }
        std::sort(borders_.begin(), borders_.end(), [](const Border& a, const Border& b) {
            return std::pair(a.cells, a.corners) < std::pair(b.cells, b.corners);
        });
    }

    MergedHull mergeTriangles() const {
        MergedHull hull;
        std::vector<std::vector<std::uint32_t>> facesOf(hyperplanes_.size());
        for (std::size_t i = 0, end = 0; i < borders_.size(); i = end) {
            while (end < borders_.size() && borders_[end].cells == borders_[i].cells) ++end;
            const auto [a, b] = borders_[i].cells;
            const std::size_t before = hull.faces.size();
            const auto between = std::span(borders_).subspan(i, end - i);
            if (between.size() == 1 || unmerged_[a] || unmerged_[b]) {
                for (const Border& border : between) hull.faces.add(border.corners);
            } else {
                addPolygons(between, hull.faces);
            }
            for (std::size_t f = before; f < hull.faces.size(); ++f) {
                facesOf[a].push_back(static_cast<std::uint32_t>(f));
                facesOf[b].push_back(static_cast<std::uint32_t>(f));
            }
        }
        for (const auto& faces : facesOf) hull.cells.add(faces);
        return hull;
    }

    // Merges the triangles between two cells into polygons.
    void addPolygons(std::span<const Border> borders, geometry::JaggedArray& faces) const {
        const std::vector<Side> sides = sidesOf(borders, [](const Border& b) -> const Triangle& { return b.corners; });
        std::vector<std::array<std::uint32_t, 3>> beside(borders.size(), {kNone, kNone, kNone});
        for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
            while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
            if (end - i != 2) continue;
            const auto join = [&](std::uint32_t from, std::uint32_t to) {
                *std::find(beside[from].begin(), beside[from].end(), kNone) = to;
            };
            join(sides[i].triangle, sides[i + 1].triangle);
            join(sides[i + 1].triangle, sides[i].triangle);
        }
        std::vector<double> areas;
        for (const Border& border : borders) areas.push_back(Plane(border.corners, points_).volume());
        std::vector<std::uint32_t> order(borders.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return areas[a] > areas[b]; });
        std::vector<bool> done(borders.size(), false);
        std::vector<bool> taken;
        const auto collect = [&](std::uint32_t seed, const Plane& plane) {
            taken.assign(borders.size(), false);
            taken[seed] = true;
            std::vector<std::uint32_t> group{seed};
            for (std::size_t at = 0; at < group.size(); ++at) {
                for (const std::uint32_t t : beside[group[at]]) {
                    if (t == kNone || taken[t] || done[t]) continue;
                    const Triangle& corners = borders[t].corners;
                    if (!std::all_of(corners.begin(), corners.end(),
                                     [&](std::uint32_t v) { return plane.contains(points_[v], frame_); })) {
                        continue;
                    }
                    taken[t] = true;
                    group.push_back(t);
                }
            }
            return group;
        };
        for (const std::uint32_t seed : order) {
            if (done[seed]) continue;
            Plane plane(borders[seed].corners, points_);
            auto group = collect(seed, plane);
            for (int i = 0; i < kMaxRefits && group.size() > 1; ++i) {
                std::vector<std::uint32_t> corners;
                for (const std::uint32_t t : group)
                    corners.insert(corners.end(), borders[t].corners.begin(), borders[t].corners.end());
                const Plane wider(largeSimplex<3>(corners, points_), points_);
                const Triangle& own = borders[seed].corners;
                if (!(wider.volume() > 1.01 * plane.volume()) ||
                    !std::all_of(own.begin(), own.end(), [&](auto v) { return wider.contains(points_[v], frame_); })) {
                    break;
                }
                plane = wider;
                group = collect(seed, plane);
            }
            std::vector<std::uint32_t> loop;
            if (group.size() > 1) loop = boundaryOf(group, borders);
            if (loop.empty() || !isConvex(loop, plane)) {
                group = {seed};
                loop.assign(borders[seed].corners.begin(), borders[seed].corners.end());
            }
            for (const std::uint32_t t : group) done[t] = true;
            faces.add(loop);
        }
    }

    // Returns the boundary loop of triangles that form a disk; empty if they do not form one.
    static std::vector<std::uint32_t> boundaryOf(std::span<const std::uint32_t> group,
                                                 std::span<const Border> borders) {
        std::vector<Triangle> triangles;
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t t : group) {
            triangles.push_back(borders[t].corners);
            corners.insert(corners.end(), borders[t].corners.begin(), borders[t].corners.end());
        }
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        const std::vector<Side> sides = sidesOf(triangles, [](const Triangle& t) -> const Triangle& { return t; });
        std::unordered_map<std::uint32_t, std::array<std::uint32_t, 2>> next;
        std::size_t edges = 0;
        for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
            while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
            ++edges;
            if (end - i > 2) return {};
            if (end - i == 2) continue;
            const auto [a, b] = sides[i].edge;
            for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
                auto& both = next.try_emplace(from, std::array{kNone, kNone}).first->second;
                if (both[1] != kNone) return {};
                both[both[0] == kNone ? 0 : 1] = to;
            }
        }
        if (corners.size() + triangles.size() != edges + 1) return {};
        std::vector<std::uint32_t> loop{next.begin()->first};
        for (std::uint32_t before = kNone, at = loop[0];;) {
            const auto& both = next.at(at);
            const std::uint32_t to = both[0] == before ? both[1] : both[0];
            if (to == kNone) return {};
            before = at;
            at = to;
            if (at == loop[0]) break;
            loop.push_back(at);
            if (loop.size() > next.size()) return {};
        }
        if (loop.size() != next.size()) return {};
        return loop;
    }

    // Returns whether a loop in a plane turns the same way at all corners, within their noise.
    bool isConvex(std::span<const std::uint32_t> loop, const Plane& plane) const {
        std::vector<glm::dvec2> places;
        for (const std::uint32_t v : loop) {
            const auto along = plane.project(points_[v]);
            places.emplace_back(along[0], along[1]);
        }
        const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
        double area = 0;
        for (std::size_t i = 1; i + 1 < places.size(); ++i)
            area += cross(places[i] - places[0], places[i + 1] - places[0]);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec2 before = places[i];
            const glm::dvec2 corner = places[(i + 1) % places.size()] - before;
            const glm::dvec2 across = places[(i + 2) % places.size()] - before;
            const double length = glm::length(across);
            if (!(length > 0)) return false;
            const double out = cross(corner, across) / length * (area < 0 ? -1 : 1);
            const glm::dvec4 direction = (across.y * plane.axis(0) - across.x * plane.axis(1)) / length;
            if (out < -2 * frame_.noise(direction)) return false;
        }
        return true;
    }

    // Marks cells with fewer than four 2-faces, so that the next mergeTriangles() keeps their triangles. Returns false
    // if there are no such cells.
    bool splitDegenerateCells(const MergedHull& hull) {
        bool any = false;
        for (std::size_t c = 0; c < hull.cells.size(); ++c) {
            if (hull.cells[c].size() >= 4) continue;
            any = true;
            unmerged_[c] = true;
        }
        return any;
    }

    void countAmbiguousRidges(MergedHull& hull) const {
        for (std::size_t i = 0, end = 0; i < borders_.size(); i = end) {
            while (end < borders_.size() && borders_[end].cells == borders_[i].cells) ++end;
            const Hyperplane& one = hyperplanes_[borders_[i].cells[0]];
            const Hyperplane& other = hyperplanes_[borders_[i].cells[1]];
            const auto nearly = [&](const Hyperplane& a, const Hyperplane& b) {
                return std::all_of(b.corners().begin(), b.corners().end(),
                                   [&](std::uint32_t v) { return a.contains(points_[v], frame_, kAmbiguityFactor); });
            };
            if (nearly(one, other) || nearly(other, one)) ++hull.ambiguousRidges;
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
    std::vector<Hyperplane> hyperplanes_;  // per cell
    std::vector<Border> borders_;
    std::vector<bool> unmerged_;  // per cell: whether its triangles are kept unmerged
};

}  // namespace

MergedHull mergeCoplanar(std::span<const SimplexFacet> simplices, std::span<const glm::dvec4> points,
                         const HullFrame& frame) {
    return Merger(simplices, points, frame).run();
}

}  // namespace oval4d::polytopes
