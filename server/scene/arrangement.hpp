#pragma once
// Arranges the slices, their labels and the projection of the whole object in each view, and places the camera.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/layout.hpp"
#include "scene/look.hpp"

namespace oval4d::scene {

/// The room that a picture has for the slices, their labels and the projection of the whole object. Sizes are (width,
/// height), in viewport heights.
struct AvailableSpace {
    glm::dvec2 size{0};
    /// The sizes of two parts of the room: first the part to the right of the axes symbol, then the part below the
    /// symbol.
    std::array<glm::dvec2, 2> besideAxes{};
    bool hasProjection = false;  ///< whether the projection of the whole object is shown
};

/// The places of slices that stand in rows, from left to right and from top to bottom. Each row has `columns` slices;
/// only the last row may have fewer. All lengths are in world units. The focus slice stands at the origin. It is the
/// middle slice or, if the number of slices is even, the last one before the middle.
struct SliceGrid {
    int count = 0;  ///< the number of slices; 0 if the view has no grid
    int columns = 1;
    /// The distance from one column to the next, and the distance from one row to the next.
    double columnStep = 0, rowStep = 0;
    double focusGap = 0;  ///< the additional length of the step from the row of the focus slice to the next row
    /// The side length of a square to the left of the grid or above it, which contains the projection of the whole
    /// object. 0 if the projection is not shown.
    double projectionSide = 0;
    /// Whether the square of the projection is above the grid, not to the left of it.
    bool projectionIsAbove = false;

    /// Returns the position of slice i. No coordinate is −0, because messages would show the minus sign.
    glm::dvec3 positionOf(int i) const {
        const int focus = (count - 1) / 2;
        const int right = i % columns - focus % columns, down = i / columns - focus / columns;
        return {right * columnStep, -down * rowStep - (down > 0 ? focusGap : 0), 0};
    }
};

/// The arrangement of the slices in a view, before the viewer moves the camera. All lengths are in world units. The
/// slices stand in a grid or on a curve: a parabola, a straight row, a straight column or a single place. The middle of
/// the curve is the origin. The focus slice stands at the origin, unless it is on a curve with an even number of
/// slices. Only slices in exported files can have an even number. The camera looks at the origin from the distance
/// `distance`, downward by the angle `pitch` (radians).
struct SliceArrangement {
    /// The x of the last slice; the first slice has −halfWidth. In a grid: the greatest |x| of a slice.
    double halfWidth = 0;
    /// The y of the last slice; the first slice has −halfHeight. In a grid: the greatest |y| of a slice.
    double halfHeight = 0;
    double depth = 0;  ///< how far behind the origin the first and the last slice stand; not 0 only on a parabola
    double pitch = 0, distance = 1;  ///< the downward angle of the camera, in radians, and its distance from the origin
    double sliceRadius = 1;          ///< the radius of the object's circumscribed sphere
    double reach = 1;                ///< the radius of a slice together with its balls
    /// Whether the layout places the slices and the projection of the whole object such that they do not overlap the
    /// symbol of the axes. If false, they may overlap the symbol.
    bool isClearOfAxes = false;
    bool showsMatrix = false;  ///< whether the matrix of planar sections stands beside the slices
    /// How far labels are lowered. The direction from a slice to its label is the sum of two vectors: a unit vector
    /// away from the curve, and a downward vector of this length. If the latter were longer, labels would cover the
    /// next slice. If it were shorter, labels at the sides would leave less room for the slices.
    double labelDrop = 0.54;
    double focusLabelDrop = 0;  ///< the additional gap between the focus slice and its label, in heights of text
    /// Whether the labels are to the right of the slices, so that they take a part of the width of the room.
    bool labelsAreBeside = false;
    /// If not 0, the width of the room is divided into this number of columns, and each label shrinks until it fits
    /// into one column. Labels beside the slices share the column with the gap between slice and label. If labels are
    /// below the slices, the label of the focus slice (the middle one) does not shrink, because it is farther down than
    /// the others. For a grid, these columns are as wide as labels may be, so their number need not be an integer.
    double labelColumns = 0;
    SliceGrid grid = {};  ///< the grid in which the slices stand; its `count` is 0 if the slices stand on a curve

    /// Returns the position of the slice with the parameter u, which is −1 for the first slice and 1 for the last. No
    /// coordinate is −0, because messages would show the minus sign. In a grid, a parameter between those of two slices
    /// gives the position of the nearer slice. LabelLayout finds the direction of the curve from two positions near
    /// that of a slice. In a grid, these are equal, and the label is placed straight below the slice.
    glm::dvec3 positionAt(double u) const {
        if (grid.count > 0) return grid.positionOf(static_cast<int>(std::lround((grid.count - 1) / 2.0 * (1 + u))));
        return glm::dvec3(halfWidth * u, halfHeight * u, -depth * u * u) + 0.0;
    }
    /// Returns an upper bound of the distances of the slices from the origin, at which the camera looks.
    double maxDistanceFromFocus() const { return depth + halfWidth + halfHeight; }
    /// Returns the radius of a sphere that is assumed to contain the slice with the parameter u, as a fraction of the
    /// circumradius. In a grid, a row, a column or a single place, the result is 1. On a parabola, the sphere is a
    /// section of the object's circumscribed sphere. The hyperplanes of the first and the last slice (u = ±1) are
    /// assumed to touch the circumscribed sphere. The parabola has just enough room for such slices.
    double relativeSliceRadiusAt(double u) const { return depth == 0 ? 1 : std::sqrt(1 - u * u); }
};

/// Returns how a view arranges `count` slices in a picture with the aspect ratio `aspect` (width / height).
/// `relativeBall` is the radius of balls as a fraction of the slice radius. Only the arrangement in a grid depends on
/// `room`.
SliceArrangement arrangementOf(View view, int count, double relativeBall, double aspect, const AvailableSpace& room);

/// Places the projection of the whole object beside the slices of a view. `count` is the number of slices. `aspect` is
/// the aspect ratio (width / height) of the room for the slices and the projection. The width of labels beside the
/// slices does not belong to this room. If the view shows the projection between its slices, returns a placement that
/// is not `shown`; the caller must then call placeProjectionInsideOval().
ProjectionPlacement placeProjectionBeside(View view, const SliceArrangement& arrangement, int count, double aspect);

/// Places the projection of the whole object in the middle of the oval, at a point on the axis of the parabola. Chooses
/// the point around which the largest circle on the screen fits between the slices and below `top`. `top` is a height
/// on the plane at distance 1 from the eye.
ProjectionPlacement placeProjectionInsideOval(const SliceArrangement& arrangement,
                                              const std::vector<SlicePlacement>& placements, double top);

/// Returns the parameter u of slice i of `count` slices: −1 … 1 from the first slice to the last. Slices at the same
/// distance from the middle have exactly opposite parameters.
inline double sliceParameter(std::size_t i, std::size_t count) {
    const double middle = static_cast<double>(count - 1) / 2;
    return count == 1 ? 0 : (static_cast<double>(i) - middle) / middle;
}

/// The view space of the camera before the viewer moves the camera. Its axes are those of world space, rotated by the
/// pitch about the x axis.
struct InitialViewSpace {
    double cos, sin, distance;
    explicit InitialViewSpace(const SliceArrangement& arrangement)
        : cos(std::cos(arrangement.pitch)), sin(std::sin(arrangement.pitch)), distance(arrangement.distance) {}
    /// Returns the depth of the point p: its distance from the eye along the view axis.
    double depth(const glm::dvec3& p) const { return distance - p.y * sin - p.z * cos; }
    /// Returns the height of the point p above the view axis.
    double heightAboveAxis(const glm::dvec3& p) const { return p.y * cos - p.z * sin; }
};

}  // namespace oval4d::scene
