#pragma once
// The commands that change a session. They come from messages, from keys and from the ':' line.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "geometry/rotation.hpp"
#include "scene/scene.hpp"

namespace oval4d::session {

struct Key {
    std::string key;  ///< the value of KeyboardEvent.key in a browser: "y", "K", "2", " ", "["
    bool shift = false, ctrl = false;
};
struct Rotate {
    geometry::Turn turn;
};
/// Changes the settings that are present; the others keep their values.
struct Set {
    std::optional<std::string> object;  ///< a name or alias in the catalogue, or the name of a loaded object
    std::optional<glm::dmat4> orientation;
    std::optional<double> alpha, beta;  ///< radians
    std::optional<double> step;         ///< radians; the change of an angle by the keys k, j, K and J
    std::optional<int> count;           ///< odd
    std::optional<double> spacing;
    std::optional<int> focus;
    std::optional<scene::View> view;
    std::optional<bool> turning;
    std::array<std::optional<bool>, scene::kParts.size()> parts;  ///< on or off, in the order of scene::kParts
    std::optional<double> azimuth, elevation, zoom;
    std::optional<scene::Coloring> coloring;
    std::optional<std::vector<std::uint32_t>> hidden, faded;  ///< cell types, in any order
    std::optional<geometry::Turn> last;                       ///< the last rotation, which '.' and the space bar repeat
};
/// Loads an object from the text of a file and shows it.
struct Load {
    std::string name, format, data;
};
struct Undo {};
struct Redo {};
struct Reset {};
struct CommandLine {
    std::string line;  ///< without the ':'
};
using Command = std::variant<Key, Rotate, Set, Load, Undo, Redo, Reset, CommandLine>;

}  // namespace oval4d::session
