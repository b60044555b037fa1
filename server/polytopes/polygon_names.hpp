#pragma once
// Names of polygons.

#include <span>
#include <string>

#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// Returns the name of the polygon with these corners, at least three, in cyclic order. A triangle is called
/// "triangle". A quadrilateral is called "square", "rhombus" or "rectangle" if it is flat and has this shape, else
/// "quadrilateral". A regular star polygon {n/d} has the name that polygonNoun() returns, such as "pentagram" or
/// "10/3-gon". Any other polygon is named for its number of sides, such as "pentagon" or "17-gon". Lengths count as
/// equal if they differ by at most 1 %.
std::string nameOfPolygon(std::span<const glm::dvec4> corners);

}  // namespace oval4d::polytopes
