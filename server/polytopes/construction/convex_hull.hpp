#pragma once
// Polytopes that are built as convex hulls of computed points.

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include <glm/vec4.hpp>

#include "polytopes/construction/recipe.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The maximum total number of points of all convex hulls that are computed to build one polytope.
inline constexpr std::uint64_t kMaxHullPoints = 20'000;

/// The maximum number of sides of a 2-face of a polytope that is used in a construction by convex hulls, as in
/// "truncation of X". In a regular polygon with more sides, each vertex lies so close to the line through its two
/// neighbors that rounding errors matter.
inline constexpr std::size_t kMaxHullSides = 1000;

/// The maximum number of cells of a hull.
inline constexpr std::size_t kMaxHullCells = 100'000;

/// Thrown while a polytope is being built, if the polytope exceeds a limit that only building it can check.
class TooLarge : public std::invalid_argument {
  public:
    using std::invalid_argument::invalid_argument;
};

/// Returns the convex hull of the points. Assumes that each coordinate has a rounding error of at most 1e-12 times the
/// largest distance of a point from the origin. Simplices that lie in one hyperplane, to within this error, become one
/// cell. Throws TooLarge if there are more than kMaxHullPoints points or kMaxHullCells cells, and std::invalid_argument
/// if the points do not span four dimensions.
Polytope hullPolytope(std::string name, std::span<const glm::dvec4> points);

/// Returns the convex hull of the points, moved such that the mean of the hull's vertices, an interior point, is the
/// origin. Throws like hullPolytope().
Polytope centeredHull(std::string name, std::span<const glm::dvec4> points);

/// Returns the polytope, moved such that the mean of its vertices is the origin.
Polytope centered(Polytope polytope);

/// Builds the polytope of `design`, from whose vertices a construction will compute a convex hull. Throws
/// std::invalid_argument if the polytope is not convex, and TooLarge if a 2-face has more than kMaxHullSides sides.
/// Also throws the exceptions of build().
Polytope buildRequiringConvex(const PolytopeDesign& design);

}  // namespace oval4d::polytopes
