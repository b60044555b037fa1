#pragma once
// The units of the axes of a picture, which shows a field in a frame of reference and after a rotation.

#include <array>
#include <optional>
#include <string>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"

namespace oval4d::fields {

/// The unit of an axis of a picture.
struct PictureAxisUnit {
    std::string text;        ///< empty if it is unknown, or if the axis mixes axes of the box with different units
    bool isToScale = false;  ///< whether a length of 1 along the axis in the picture is one such unit
    bool operator==(const PictureAxisUnit&) const = default;
};
using PictureUnits = std::array<PictureAxisUnit, 4>;

/// Returns the units of the axes x, y, z and w after the field has been rotated by `orientation`. Each coordinate in
/// the picture is a linear combination of the coordinates in the box. The coordinate in the picture has a unit if all
/// coordinates in the box with a nonzero factor have the same unit. It is to scale if the factors, as a vector, have
/// the length 1. For example, the axis w of an array is not to scale if fieldFromArray() or ReferenceFrame::pace has
/// scaled w.
PictureUnits pictureUnits(const Field& field, const geometry::Rotation& orientation);

/// The coordinate in the box of a field that all points of a slice w = const of a picture have in common.
struct CommonCoordinate {
    int axis = 3;       ///< 0 … 3 for x … w
    double center = 0;  ///< the coordinate in the slice w = 0
    double scale = 1;   ///< by how much the coordinate grows if w grows by 1

    double at(double w) const { return center + scale * w; }
    /// Returns whether this is the coordinate along the axis w of the box and equals the w of the picture: at(w) = w.
    bool isW() const;
};
/// Returns the coordinate that all points of a slice have in common after the field has been rotated by `orientation`;
/// an empty optional if the slices are perpendicular to no axis of the box. For example, without a rotation, all points
/// of a slice have the same w in the box of an array, and after a quarter turn in xw, the same x.
std::optional<CommonCoordinate> commonCoordinate(const Field& field, const geometry::Rotation& orientation);

/// Returns the coordinate in the box of a field that all points of the slice `w` have in common, as a text: "130 s" for a
/// coordinate along the axis w whose unit is known, else "box x = 0.5 m" or "box w = 130". Returns an empty text if
/// there is no such coordinate, or if it is w itself, without a unit. `spacing` is the distance between slices; the text
/// has as many decimals as are needed to distinguish neighboring slices.
std::string placeInBox(const Field& field, const geometry::Rotation& orientation, double w, double spacing);

/// Returns the unit of lengths in a hyperplane w = const of the picture: the unit of the axes x, y and z if all three
/// have the same unit and are to scale, else an empty string.
std::string lengthUnit(const PictureUnits& units);

/// Returns the label of an axis, 0 … 3 for x … w: "x, m" for the axis 0 with the unit m, and only "x" if the unit is
/// unknown.
std::string axisLabel(int axis, const PictureAxisUnit& unit);

}  // namespace oval4d::fields
