#pragma once
// The key table: protocol/keymap.json, read once.

#include <optional>
#include <string>
#include <string_view>

#include "protocol/cpp/error.hpp"
#include "protocol/cpp/request.hpp"

namespace oval4d::session {

/// What a key does. The names are those of the "action" member in protocol/keymap.json; those that are for the client
/// alone are not among them.
enum class Action {
    rotate,  ///< planes in `planes`; Shift gives the inverse
    alpha_up,
    alpha_down,
    beta_up,
    beta_down,
    focus_right,
    focus_left,
    focus_zero,
    focus_first,
    focus_last,
    undo,
    redo,
    repeat,
    turn,
    spacing_smaller,
    spacing_larger,
    slices_fewer,
    slices_more,
    polytope_next,
    polytope_previous,
    view,
    coordinates,
    faces,
    bars,
    balls,
};

struct Binding {
    Action action;
    geometry::Plane plane = geometry::Plane::xy;
    bool doubled = false;  ///< the perpendicular plane turns by beta too
    bool inverse = false;
};

/// Finds the meaning of a key. `pending` is the session's pending key: set to "g" by a first g, cleared by any other.
/// Nothing is returned for the first key of a sequence; an unknown key is an error that names the key.
protocol::Result<std::optional<Binding>> bindingOf(const protocol::Key& key, std::string& pending);

}  // namespace oval4d::session
