#include "polytopes/construction/convex_hull.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "polytopes/construction/design.hpp"
#include "polytopes/import/hull.hpp"
#include "polytopes/import/import.hpp"
#include "text_files/file_error.hpp"

namespace oval4d::polytopes {

using text_files::FileError;

namespace {

// The assumed rounding error of the points, relative to their largest distance from the origin. This error is much
// larger than the rounding error of a double, because constructions may be nested, and each increases the error.
constexpr double kRounding = 1e-12;

ConvexHull hullOf(std::span<const glm::dvec4> points) {
    if (points.size() > kMaxHullPoints) {
        throw TooLarge("it takes the convex hull of " + std::to_string(points.size()) + " points; at most " +
                       std::to_string(kMaxHullPoints) + " are allowed");
    }
    double largest = 0;
    for (const glm::dvec4& point : points) largest = std::max(largest, glm::length(point));
    try {
        return convexHull(points, glm::dvec4(kRounding * largest), kMaxHullCells);
    } catch (const FileError& error) {
        if (error.tooLarge) throw TooLarge(error.reason);
        throw std::invalid_argument(error.reason);
    }
}

// Moves points such that their mean is the origin, and returns true. If the mean is already the origin, apart from
// rounding errors, leaves the points unchanged and returns false.
bool centerAtOrigin(std::vector<glm::dvec4>& points) {
    glm::dvec4 middle(0);
    double largest = 0;
    for (const glm::dvec4& point : points) {
        middle += point / static_cast<double>(points.size());
        largest = std::max(largest, glm::length(point));
    }
    if (glm::length(middle) <= kRounding * largest) return false;
    for (glm::dvec4& point : points) point -= middle;
    return true;
}

Polytope polytopeFromHull(std::string name, ConvexHull hull) {
    return makePolytope(std::move(name), std::move(hull.vertices), std::move(hull.faces), std::move(hull.cells));
}

}  // namespace

Polytope hullPolytope(std::string name, std::span<const glm::dvec4> points) {
    return polytopeFromHull(std::move(name), hullOf(points));
}

Polytope centeredHull(std::string name, std::span<const glm::dvec4> points) {
    ConvexHull hull = hullOf(points);
    centerAtOrigin(hull.vertices);
    return polytopeFromHull(std::move(name), std::move(hull));
}

Polytope centered(Polytope polytope) {
    if (!centerAtOrigin(polytope.vertices)) return polytope;
    return makePolytope(std::move(polytope.name), std::move(polytope.vertices), std::move(polytope.faces),
                        std::move(polytope.cells));
}

Polytope buildRequiringConvex(const PolytopeDesign& design) {
    Polytope polytope = build(design);
    if (!polytope.convex) {
        throw std::invalid_argument(
            "the " + polytope.name +
            " is not convex; truncations, rectifications, hulls and intersections need convex polytopes");
    }
    for (std::size_t f = 0; f < polytope.faces.size(); ++f) {
        if (polytope.faces[f].size() <= kMaxHullSides) continue;
        throw TooLarge("a 2-face of the " + polytope.name + " has " + std::to_string(polytope.faces[f].size()) +
                       " sides; at most " + std::to_string(kMaxHullSides) +
                       " are allowed in truncations, rectifications, hulls and intersections");
    }
    return polytope;
}

}  // namespace oval4d::polytopes
