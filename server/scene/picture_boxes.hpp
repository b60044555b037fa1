#pragma once
// Rectangles in a picture. The unit of length is the viewport's height.

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>

namespace oval4d::scene {

/// The width of the margin along the edges of the picture, in viewport heights.
inline constexpr double kMargin = 0.02;

/// A rectangle, given by its sides.
struct Rect {
    double left, right, bottom, top;
};

/// A rectangle, given by its center and half its size.
struct CenteredRect {
    glm::dvec2 center, half;
};

/// Returns whether two boxes overlap.
inline bool overlap(const CenteredRect& a, const CenteredRect& b) {
    return glm::all(glm::lessThan(glm::abs(a.center - b.center), a.half + b.half));
}

/// Returns whether a box overlaps the disk with this center and this radius.
inline bool overlap(const CenteredRect& box, const glm::dvec2& center, double radius) {
    return glm::length(glm::max(glm::abs(center - box.center) - box.half, glm::dvec2(0))) < radius;
}

}  // namespace oval4d::scene
