#pragma once
// The commands that change a session. They come from messages, from keys and from the ':' line, which is the command
// line of the page.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/element.hpp"

namespace oval4d::session {

/// A key press.
struct Key {
    std::string key;  ///< the value of KeyboardEvent.key in a browser: "y", "K", "2", " ", "["
    bool shift = false, ctrl = false;
};
/// Rotates the object.
struct Rotate {
    geometry::Turn turn;
    bool continues = false;  ///< whether it belongs to the undo step of the previous command, as in a gesture
};
/// Turns an element of the object toward +w, by the shortest rotation.
struct TurnToward {
    slicing::ElementKind kind = slicing::ElementKind::cell;
    /// The index of the element; if absent, the element closest to +w, or the next one if that is already there.
    std::optional<std::size_t> index;
    bool immediately = false;  ///< whether to jump there instead of moving
};
/// Changes the settings that are present; the others keep their values.
struct Set {
    bool continues = false;             ///< as in Rotate
    std::optional<std::string> object;  ///< a name or alias in the catalogue, or the name of a loaded object
    std::optional<glm::dmat4> orientation;
    std::optional<double> alpha, beta;  ///< the angles of the rotation keys, in radians
    std::optional<double> step;         ///< the change of alpha or beta by the keys k, j, K and J, in radians
    std::optional<int> count;           ///< SliceSettings::count, which is odd
    std::optional<double> spacing;      ///< SliceSettings::spacing
    std::optional<int> focus;           ///< SliceSettings::focus
    std::optional<double> offset;       ///< SliceSettings::offset
    std::optional<double> focusW;       ///< w of the focus slice: sets focus and offset (see moveFocusTo())
    std::optional<scene::View> view;
    std::optional<glm::dvec4> focusPoint;  ///< Look::focusPoint; and w of the focus slice, as focusW, which
                                           ///< is ignored if `focus`, `offset` or `focusW` is present
    std::optional<bool> turning;           ///< whether the object turns continuously
    std::array<std::optional<bool>, scene::kParts.size()> parts;  ///< per row of scene::kParts: whether it is shown
    std::optional<double> azimuth, elevation, zoom;               ///< the members of scene::CameraOrbit
    std::optional<scene::Coloring> coloring;
    std::optional<scene::ProjectionKind> projection;
    std::optional<double> eye;                                ///< ProjectionSettings::eye
    std::optional<std::vector<std::uint32_t>> hidden, faded;  ///< indices of cell types, in any order
    /// The element that is drawn in another color. The outer optional is empty if it stays the same.
    std::optional<std::optional<slicing::Element>> highlight;
    std::optional<geometry::Turn> lastTurn;  ///< the last rotation, which the keys '.' and space repeat
};
/// Loads an object from the text of a file and shows it.
struct Load {
    std::string name;    ///< the name to give to the object
    std::string format;  ///< the name of the file format: "off", "points" or "cloud"
    std::string data;    ///< the text of the file
};
struct Undo {};
struct Redo {};
/// Restores the initial orientation and focus, and stops continuous turning.
struct Reset {};
/// Applies a ':' line; see parseCommandLine().
struct CommandLine {
    std::string line;  ///< with or without the ':'
};
using Command = std::variant<Key, Rotate, TurnToward, Set, Load, Undo, Redo, Reset, CommandLine>;

}  // namespace oval4d::session
