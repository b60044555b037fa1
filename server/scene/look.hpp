#pragma once
// The user's choices of how an object is displayed.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "geometry/range.hpp"
#include "scene/background.hpp"
#include "scene/shown_parts.hpp"
#include "serialization/stored_members.hpp"
#include "slicing/element.hpp"
#include "slicing/field_settings.hpp"
#include "text/choice.hpp"

namespace oval4d::scene {

/// A view: which slices are shown, and how they are arranged. Stored sessions contain the numbers of the enumerators;
/// therefore these numbers must not change.
enum class View : std::uint8_t {
    oval = 0,    ///< all slices, on the oval
    single = 1,  ///< only the focus slice
    matrix = 2,  ///< the focus slice, beside the matrix of planar sections
    strip = 3,   ///< all slices, at the same size in a straight row
    column = 4,  ///< all slices, at the same size in a straight column
    grid = 5,    ///< all slices, at the same size in rows that are read from left to right and from top to bottom
};
/// A row of the table of views. arrangement.cpp says where each view shows the slices, the labels and the projection.
struct ViewTableRow {
    std::string_view name;  ///< the name in messages, queries and on the command line
    View value;
    bool showsAllSlices;  ///< whether the view shows all slices, not only the focus slice
    /// Whether exported drawings of the view are in portrait format (taller than wide).
    bool isExportedInPortrait = false;
};
inline constexpr auto kViews = text::completeTable<ViewTableRow>(
    {{.name = "oval", .value = View::oval, .showsAllSlices = true},
     {.name = "single", .value = View::single, .showsAllSlices = false},
     {.name = "matrix", .value = View::matrix, .showsAllSlices = false},
     {.name = "strip", .value = View::strip, .showsAllSlices = true},
     {.name = "column", .value = View::column, .showsAllSlices = true, .isExportedInPortrait = true},
     {.name = "grid", .value = View::grid, .showsAllSlices = true}});
constexpr const auto& choicesOf(View /*type*/) { return kViews; }
/// Returns whether the view shows all slices, not only the focus slice.
constexpr bool showsAllSlices(View view) {
    return std::ranges::any_of(kViews,
                               [view](const ViewTableRow& row) { return row.value == view && row.showsAllSlices; });
}
/// Returns whether exported drawings of the view are in portrait format (taller than wide).
constexpr bool isExportedInPortrait(View view) {
    return std::ranges::any_of(
        kViews, [view](const ViewTableRow& row) { return row.value == view && row.isExportedInPortrait; });
}

/// The property that determines the colors of cells or, for fields, of surfaces. Each face of a slice has the color of
/// the cell from which it was cut. Stored sessions contain the numbers of the enumerators; therefore these numbers must
/// not change.
enum class Coloring : std::uint8_t {
    cell = 0,       ///< the cell itself; for fields: the level
    cell_type = 1,  ///< the type of the cell; called "kind" in messages
    w = 2,          ///< the w of the cell's center after the rotation; for fields: the w of the hyperplane of the slice
    plain = 3,      ///< no property: everything has the same color
    light = 4,      ///< the angle between the cell's normal and the direction toward a light in four dimensions
    growth = 5,     ///< for fields: how fast the surface moves outward while w increases
    value = 6,      ///< for fields: the value of the second function or, if there is none, of the function itself
};
inline constexpr auto kColorings = text::completeTable<text::NamedValue<Coloring>>({{"cell", Coloring::cell},
                                                                                    {"kind", Coloring::cell_type},
                                                                                    {"w", Coloring::w},
                                                                                    {"plain", Coloring::plain},
                                                                                    {"light", Coloring::light},
                                                                                    {"growth", Coloring::growth},
                                                                                    {"value", Coloring::value}});
constexpr const auto& choicesOf(Coloring /*type*/) { return kColorings; }

/// How the caps of a field's surfaces are drawn. A cap is a part of the boundary of the field's domain that closes the
/// body inside a surface where the domain ends. Stored sessions contain the numbers of the enumerators; therefore these
/// numbers must not change.
enum class SurfaceCapStyle : std::uint8_t {
    plain = 0,  ///< in the color of the level or of the slice
    value = 1,  ///< in colors that show values, as with Coloring::value
    open = 2,   ///< no caps: the surfaces are open at the domain's boundary
};
inline constexpr auto kCapStyles = text::completeTable<text::NamedValue<SurfaceCapStyle>>(
    {{"plain", SurfaceCapStyle::plain}, {"value", SurfaceCapStyle::value}, {"open", SurfaceCapStyle::open}});
constexpr const auto& choicesOf(SurfaceCapStyle /*type*/) { return kCapStyles; }

/// The kinds of projection of the whole object to three dimensions. placeProjectionBeside() says where each view shows
/// the projection. Stored sessions contain the numbers of the enumerators; therefore these numbers must not change.
enum class ProjectionKind : std::uint8_t {
    off = 0,
    perspective = 1,  ///< from an eye on the positive w axis
    orthogonal = 2,   ///< parallel to the w axis
};
inline constexpr auto kProjectionKinds =
    text::completeTable<text::NamedValue<ProjectionKind>>({{"off", ProjectionKind::off},
                                                           {"perspective", ProjectionKind::perspective},
                                                           {"orthogonal", ProjectionKind::orthogonal}});
constexpr const auto& choicesOf(ProjectionKind /*type*/) { return kProjectionKinds; }

/// How the whole object is projected.
struct ProjectionSettings {
    /// The range of `eye`, in circumradii; above 1, so that the eye is outside the object.
    static constexpr geometry::NumberRange kEyeRange{1.05, 1000};

    ProjectionKind kind = ProjectionKind::off;
    double eye = 3;  ///< for the perspective: the w coordinate of the 4-D eye, in circumradii; within kEyeRange
    bool operator==(const ProjectionSettings&) const = default;
};

/// The cell types that are hidden, and those that are faded (translucent), as indices into ObjectInfo::cellTypes. Each
/// list is sorted and has no duplicates. No cell type is in both lists.
struct CellTypeFilter {
    std::vector<std::uint32_t> hidden, faded;
    bool operator==(const CellTypeFilter&) const = default;
};

/// The user's changes to the camera. `azimuth` and `elevation` rotate the camera about its target, in radians; positive
/// values move the camera to the right and up. `zoom` multiplies the magnification. The defaults mean no change.
struct CameraOrbit {
    /// The range of `azimuth` and `elevation`, in radians.
    static constexpr geometry::NumberRange kAngleRange{-1000, 1000};
    static constexpr geometry::NumberRange kZoomRange{0.05, 20};

    double azimuth = 0, elevation = 0, zoom = 1;
    bool operator==(const CameraOrbit&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<CameraOrbit> auto& orbit, auto& visit) {
    auto& [azimuth, elevation, zoom] = orbit;
    visit.member(0, azimuth, CameraOrbit::kAngleRange);
    visit.member(1, elevation, CameraOrbit::kAngleRange);
    visit.member(2, zoom, CameraOrbit::kZoomRange);
}

/// All choices of the user about the display of an object.
struct Look {
    static constexpr geometry::NumberRange kThicknessRange{0.25, 4}, kOpacityRange{0.25, 4};

    View view = View::oval;
    ShownParts parts;
    CameraOrbit orbit;
    Coloring coloring = Coloring::cell;
    CellTypeFilter cellTypes = {};
    ProjectionSettings projection = {};
    std::optional<slicing::Element> highlight = {};  ///< the element of the object that is drawn in the highlight color
    /// The x, y and z of the focus point, in the object's units, after the rotation. The w of the focus point is that
    /// of the focus slice (the middle one). The planes of the matrix view pass through this point.
    glm::dvec3 focusPoint{0};
    slicing::FieldSettings field = {};  ///< for a field: the levels whose surfaces are shown, and the fog
    SurfaceCapStyle caps = SurfaceCapStyle::plain;
    Background background = Background::automatic;
    double thickness = 1;  ///< multiplies the radii of all balls and bars; within kThicknessRange
    double opacity = 1;    ///< multiplies the opacity of translucent faces; within kOpacityRange
    bool operator==(const Look&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<Look> auto& look, auto& visit) {
    auto& [view, parts, orbit, coloring, cellTypes, projection, highlight, focusPoint, field, caps, background,
           thickness, opacity] = look;
    auto& [hidden, faded] = cellTypes;
    auto& [kind, eye] = projection;
    visit.member(0, view);
    visit.member(1, parts);
    visit.member(2, orbit);
    visit.member(3, coloring);
    visit.member(4, hidden);
    visit.member(5, faded);
    visit.memberAddedLater(6, kind);
    visit.memberAddedLater(7, eye, ProjectionSettings::kEyeRange);
    visit.memberAddedLater(8, highlight);
    visit.memberAddedLater(9, focusPoint, geometry::NumberRange::ofFiniteNumbers());
    visit.memberAddedLater(10, field);
    visit.memberAddedLater(11, caps);
    visit.memberAddedLater(12, background);
    visit.memberAddedLater(13, thickness, Look::kThicknessRange);
    visit.memberAddedLater(14, opacity, Look::kOpacityRange);
}

}  // namespace oval4d::scene
