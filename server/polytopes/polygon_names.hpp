#pragma once
// Names of polygons.

#include <span>
#include <string>

#include <glm/vec4.hpp>

namespace oval4d::polytopes {

/// Returns the name of the polygon with these corners, in the order around it; there must be at least three. A triangle
/// is called "triangle". A quadrilateral is a "square", "rhombus" or "rectangle" if it is flat and has this shape, else
/// a "quadrilateral". A regular star polygon {n/d} has the name of nounOf(), such as "pentagram" or "10/3-gon". Any
/// other polygon is named for the number of its sides, such as "pentagon" or "17-gon". All comparisons of lengths have
/// a relative tolerance of 1 %.
std::string nameOfPolygon(std::span<const glm::dvec4> corners);

}  // namespace oval4d::polytopes
