#pragma once
// The settings that say how a field is shown: its levels, which side of them is inside, and its fog.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fields/inside.hpp"
#include "geometry/range.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::slicing {

/// The maximum number of levels of a field that are shown at the same time.
inline constexpr std::size_t kMaxLevels = 4;
/// The maximum absolute value of a level, and of the value of a control point of fog.
inline constexpr double kMaxLevel = 1e30;

/// A control point of the transfer function of fog. The transfer function maps the values of a field to opacities and
/// colors. It is linear between two successive control points, and constant below the first and above the last.
struct FogControlPoint {
    double value = 0;
    double opacity = 0;  ///< 0 … 1: the opacity of a layer of fog that is as thick as the object's circumradius
    std::optional<std::uint32_t> color = {};  ///< 0xRRGGBB; if empty, scene::makeFogTable() chooses a color
    bool operator==(const FogControlPoint&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<FogControlPoint> auto& point, auto& visit) {
    auto& [value, opacity, color] = point;
    visit.member(0, value, geometry::NumberRange::ofAbsoluteValuesUpTo(kMaxLevel));
    visit.member(1, opacity, geometry::NumberRange{0, 1});
    visit.member(2, color);
}

/// The least and the greatest number of control points of a transfer function.
inline constexpr std::size_t kMinFogControlPoints = 2, kMaxFogControlPoints = 8;

/// The settings that say how a field is shown: the levels whose surfaces are shown, which side of a level is inside,
/// and the fog in the slices.
struct FieldSettings {
    std::vector<double> levels{0};  ///< 1 … kMaxLevels different numbers
    fields::BodySide inside = fields::BodySide::below;
    /// The control points of the transfer function of fog: none if there is no fog, otherwise kMinFogControlPoints …
    /// kMaxFogControlPoints points with strictly ascending values.
    std::vector<FogControlPoint> fog = {};
    bool operator==(const FieldSettings&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<FieldSettings> auto& field, auto& visit) {
    auto& [levels, inside, fog] = field;
    visit.member(0, levels, geometry::NumberRange::ofAbsoluteValuesUpTo(kMaxLevel));
    visit.member(1, inside);
    visit.memberAddedLater(2, fog);
}

}  // namespace oval4d::slicing
