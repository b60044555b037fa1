#pragma once
// The units of the axes of a picture. The picture shows a field after a transformation and a rotation, so an axis of
// the picture may mix several axes of the field.

#include <array>
#include <optional>
#include <string>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::fields {

/// The unit of an axis of a picture.
struct PictureAxisUnit {
    std::string text;        ///< the unit; empty if it is unknown, or if the axis mixes axes of the box with different
                             ///< units
    bool isToScale = false;  ///< whether one unit has the length 1 in the picture
    bool operator==(const PictureAxisUnit&) const = default;
};
using PictureUnits = std::array<PictureAxisUnit, 4>;

/// Returns the units of the axes x, y, z and w of the picture after a rotation of the field by `orientation`. Each
/// coordinate in the picture is a linear combination of the coordinates in the box. An axis of the picture has a unit
/// if all coordinates in the box that have nonzero factors have the same known unit. The axis is to scale if it has a
/// unit, and if the vector of the factors has the length 1. For example, the axis w of an array is not to scale if
/// fieldFromArray() or ReferenceFrame::pace has scaled w.
PictureUnits pictureUnits(const Field& field, const geometry::Rotation& orientation);

/// A coordinate in the box of a field that is constant in each slice w = const of a picture.
struct ConstantSliceCoordinate {
    int axis = 3;       ///< the axis of the box: 0 … 3 for x … w
    double center = 0;  ///< the coordinate in the slice w = 0
    double scale = 1;   ///< the increase of the coordinate if w increases by 1

    double coordinateAt(double w) const { return center + scale * w; }
    /// Returns whether the coordinate is w itself: whether `axis` is the axis w of the box, and coordinateAt(w) = w.
    bool isW() const;
};
/// Returns the coordinate in the box that is constant in each slice after a rotation of the field by `orientation`.
/// Returns an empty optional if the slices are not perpendicular to an axis of the box. For example, all points of a
/// slice have the same w in the box if there is no rotation, and the same x after a quarter turn in xw.
std::optional<ConstantSliceCoordinate> constantSliceCoordinate(const Field& field,
                                                               const geometry::Rotation& orientation);

/// Returns a text with the coordinate in the box of a field that all points of the slice `w` have in common (see
/// constantSliceCoordinate()). The text is such as "130 s" for the axis w of the box if its unit is known, else such as
/// "box x = 0.5 m" or "box w = 130". Returns an empty text if there is no such coordinate, or if the coordinate is w
/// itself and has no unit. `spacing` is the distance between slices; the text has enough decimals to distinguish
/// neighboring slices.
std::string constantSliceCoordinateText(const Field& field, const geometry::Rotation& orientation, double w,
                                        double spacing);

/// Returns the unit of lengths in a slice w = const of the picture: the common unit of the axes x, y and z if all three
/// are to scale. Returns an empty string if their units differ, or if an axis is not to scale.
std::string lengthUnit(const PictureUnits& units);

/// Returns the label of an axis, 0 … 3 for x … w. For example, the label of axis 0 is "x, m" if the unit is m, and "x"
/// if the unit is unknown.
std::string axisLabel(int axis, const PictureAxisUnit& unit);

}  // namespace oval4d::fields
