#pragma once
// The user's choices of how the object is displayed.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/parts.hpp"
#include "slicing/element.hpp"
#include "text/choice.hpp"

namespace oval4d::scene {

/// What is shown: all slices on the oval, only the focus slice, or the focus slice and the matrix of planar sections.
enum class View : std::uint8_t { oval, single, matrix };
inline constexpr auto kViews =
    std::to_array<text::Choice<View>>({{"oval", View::oval}, {"single", View::single}, {"matrix", View::matrix}});

/// The property of a cell that determines the color of the faces that are cut from the cell.
enum class Coloring : std::uint8_t {
    cell,       ///< the cell itself
    cell_type,  ///< the type of the cell, which messages call a kind
    w,          ///< the w of the cell's center after the rotation
    plain,      ///< none: all cells have the same color
    light,      ///< how the cell faces a light in four dimensions
};
inline constexpr auto kColorings = std::to_array<text::Choice<Coloring>>({{"cell", Coloring::cell},
                                                                          {"kind", Coloring::cell_type},
                                                                          {"w", Coloring::w},
                                                                          {"plain", Coloring::plain},
                                                                          {"light", Coloring::light}});

/// The projection of the whole object that is shown in the middle of the oval.
enum class ProjectionKind : std::uint8_t {
    off,
    perspective,  ///< from an eye on the positive w axis
    orthogonal,   ///< parallel to the w axis
};
inline constexpr auto kProjectionKinds =
    std::to_array<text::Choice<ProjectionKind>>({{"off", ProjectionKind::off},
                                                 {"perspective", ProjectionKind::perspective},
                                                 {"orthogonal", ProjectionKind::orthogonal}});

/// How the whole object is projected.
struct ProjectionSettings {
    ProjectionKind kind = ProjectionKind::off;
    double eye = 3;  ///< perspective: the w coordinate of the 4-D eye, in circumradii; greater than 1
    bool operator==(const ProjectionSettings&) const = default;
};

/// The cell types that are not fully visible, as indices into ObjectInfo::cellTypes. Each list is sorted. No cell type
/// occurs twice in a list, and none occurs in both lists.
struct CellTypeFilter {
    std::vector<std::uint32_t> hidden, faded;
    bool operator==(const CellTypeFilter&) const = default;
};

/// The viewer's changes to the camera: its rotation about its target in radians, and a factor of magnification. The
/// defaults mean no change.
struct CameraOrbit {
    double azimuth = 0, elevation = 0, zoom = 1;
    bool operator==(const CameraOrbit&) const = default;
};

/// All of the user's choices of how the object is displayed.
struct Look {
    View view = View::oval;
    Parts parts;
    CameraOrbit orbit;
    Coloring coloring = Coloring::cell;
    CellTypeFilter cellTypes = {};
    ProjectionSettings projection = {};
    std::optional<slicing::Element> highlight = {};  ///< the element that is drawn in another color
    /// The x, y and z of the focus point, in the object's units; its w is that of the focus slice. The planes of the
    /// matrix view pass through it.
    glm::dvec3 focusPoint{0};
    bool operator==(const Look&) const = default;
};

}  // namespace oval4d::scene
