#pragma once
// The oval, and how the camera sees it before the viewer moves the camera.

#include <cmath>
#include <cstddef>

#include <glm/vec3.hpp>

namespace oval4d::scene {

/// The curve on which the slices stand, in world units. The slice with the parameter u (from −1 for the first slice to
/// 1 for the last) is at (halfWidth · u, 0, −depth · u²). The camera looks at the focus slice from the distance
/// `distance`, downward by the angle `pitch` (radians). If the depth is 0, the slices are in a straight row.
struct Oval {
    double halfWidth, depth, pitch, distance;

    /// Returns the radius, relative to the circumradius, of the circle within which the slice with the parameter u is
    /// assumed to lie. In a row, it is 1. On the curve, it is the radius of the slice of the circumscribed sphere, on
    /// the assumption that the hyperplanes of the first and the last slice only touch this sphere; the curve has just
    /// enough room for such slices.
    double reachAt(double u) const { return depth == 0 ? 1 : std::sqrt(1 - u * u); }
    /// Returns whether there are several slices in a straight row.
    bool isRow() const { return depth == 0 && halfWidth > 0; }
};

/// The number of slices for which the oval was designed.
inline constexpr int kReferenceCount = 21;

/// Returns the oval for a picture with this aspect ratio. The numbers of the oval differ for wide and tall pictures.
/// They were found by a search for the largest focus slice at which neighboring slices hide little of each other.
Oval ovalFor(double aspect);

/// Returns the straight row of the strip view; `reach` is the radius of a slice with its balls.
Oval rowFor(int count, double reach);

/// Returns the curve of the views that show one slice.
Oval singleSlice();

/// Returns the parameter u of slice i: −1 … 1 from the first to the last.
inline double parameterOf(std::size_t i, std::size_t count) {
    return count == 1 ? 0 : 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1;
}

/// The view space of the camera before the viewer moves it: world space with its y and z axes rotated by the pitch
/// about the x axis.
struct InitialViewSpace {
    double cos, sin, distance;
    explicit InitialViewSpace(const Oval& oval)
        : cos(std::cos(oval.pitch)), sin(std::sin(oval.pitch)), distance(oval.distance) {}
    /// Returns the depth of a point: its distance from the eye along the view axis.
    double depth(const glm::dvec3& p) const { return distance - p.y * sin - p.z * cos; }
    /// Returns the height of a point above the view axis.
    double up(const glm::dvec3& p) const { return p.y * cos - p.z * sin; }
};

}  // namespace oval4d::scene
