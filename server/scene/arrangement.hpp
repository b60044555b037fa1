#pragma once
// What the views differ in: how they arrange the slices, their labels and the projection, and how the camera sees them.

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/layout.hpp"
#include "scene/look.hpp"

namespace oval4d::scene {

/// The arrangement of the slices in a view, before the viewer moves the camera. All lengths are in world units. The
/// slices stand on a curve, a parabola, a straight row, a straight column or a single place, whose middle is the
/// origin. The focus slice is there, unless the number of slices is even, as it may be in files. The camera looks at
/// the origin from the distance `distance`, downward by the angle `pitch` (radians).
struct Arrangement {
    double halfWidth = 0;   ///< the x of the last slice; the first slice has −halfWidth
    double halfHeight = 0;  ///< the y of the last slice; the first slice has −halfHeight
    double depth = 0;       ///< how far behind the focus slice the first and the last slice stand
    double pitch = 0, distance = 1;
    double sliceRadius = 1;  ///< the radius of the object's circumscribed sphere
    double reach = 1;        ///< the radius of a slice with its balls
    /// Whether the layout places the slices and the projection such that they do not overlap the symbol of the axes.
    /// Otherwise they may overlap it.
    bool isClearOfAxes = false;
    bool showsMatrix = false;  ///< whether the matrix of planar sections is beside the slices
    /// The direction from a slice to its label: a downward vector of this length is added to the unit vector away from
    /// the curve. With a longer vector, labels would cover the next slice; with a shorter one, labels at the sides
    /// would leave less room for the slices.
    double labelDrop = 0.54;
    double focusLabelDrop = 0;  ///< how much larger the gap to its label is for the focus slice, in heights of text
    /// Whether the labels are to the right of the slices, so that they take a part of the width of the room.
    bool labelsAreBeside = false;
    /// If not 0, the width of the room is divided into this many columns, and labels shrink until they fit into one
    /// column. If the labels are beside the slices, all of them shrink, and the gap between slice and label takes a
    /// part of the column. If the labels are below the slices, the label of the focus slice keeps its size, because it
    /// is farther down than the others.
    int labelColumns = 0;

    /// Returns the position of the slice with the parameter u, which is −1 for the first slice and 1 for the last. No
    /// coordinate is −0, because messages would contain the sign.
    glm::dvec3 positionAt(double u) const { return glm::dvec3(halfWidth * u, halfHeight * u, -depth * u * u) + 0.0; }
    /// Returns an upper bound of the distance from the focus slice to the first and to the last slice.
    double extent() const { return depth + halfWidth + halfHeight; }
    /// Returns the radius, relative to the circumradius, of the circle within which the slice with the parameter u is
    /// assumed to lie. In a row, a column or a single place, this radius is 1. On a parabola, it is the radius of the
    /// slice of the circumscribed sphere, on the assumption that the hyperplanes of the first and the last slice only
    /// touch this sphere; the parabola has just enough room for such slices.
    double reachAt(double u) const { return depth == 0 ? 1 : std::sqrt(1 - u * u); }
};

/// Returns how a view arranges `count` slices in a picture with this aspect ratio (width / height). `relativeBall`: the
/// radius of balls as a fraction of the slice radius.
Arrangement arrangementOf(View view, int count, double relativeBall, double aspect);

/// Places the projection of the whole object beside the slices of a view. `count`: the number of slices. `aspect`: the
/// aspect ratio of the room that the slices and the projection have, without the part of the width that labels beside
/// the slices take. If the view has the projection between its slices, returns a placement that is not `shown`; the
/// caller must then call projectionInside().
ProjectionPlacement projectionBeside(View view, const Arrangement& arrangement, int count, double aspect);

/// Places the projection in the middle of the oval, on the axis of the parabola: at the point where the largest circle
/// on the screen fits between the slices and below `top`, a height on the plane at distance 1 from the eye.
ProjectionPlacement projectionInside(const Arrangement& arrangement, const std::vector<SlicePlacement>& placements,
                                     double top);

/// Returns the parameter u of slice i: −1 … 1 from the first to the last. Slices at the same distance from the middle
/// have exactly opposite parameters.
inline double parameterOf(std::size_t i, std::size_t count) {
    const double middle = static_cast<double>(count - 1) / 2;
    return count == 1 ? 0 : (static_cast<double>(i) - middle) / middle;
}

/// The view space of the camera before the viewer moves it: world space with its y and z axes rotated by the pitch
/// about the x axis.
struct InitialViewSpace {
    double cos, sin, distance;
    explicit InitialViewSpace(const Arrangement& arrangement)
        : cos(std::cos(arrangement.pitch)), sin(std::sin(arrangement.pitch)), distance(arrangement.distance) {}
    /// Returns the depth of a point: its distance from the eye along the view axis.
    double depth(const glm::dvec3& p) const { return distance - p.y * sin - p.z * cos; }
    /// Returns the height of a point above the view axis.
    double up(const glm::dvec3& p) const { return p.y * cos - p.z * sin; }
};

}  // namespace oval4d::scene
