#pragma once
// Writes the `state` message as JSON text.

#include <cstdint>
#include <optional>
#include <string>

#include "scene/background.hpp"
#include "session/session.hpp"
#include "slicing/section_name.hpp"
#include "slicing/surface_detail.hpp"

namespace oval4d::wire {

/// Returns the `state` message of a state. `section` contains the names of the section in the focus slice, and
/// `quality` is the quality of the next picture. `viewer` is the color scheme that the viewer prefers. If the
/// background is scene::Background::automatic, this scheme determines the colors of cell types and of values in the
/// message. The PNG files of pictures contain the same text.
///
/// The message contains the serial number of State::source, the object in its own coordinates, and not that of
/// State::object. The difference between both objects is the frame of reference, which is one of the settings in the
/// message.
std::string stateMessage(const session::State& state, const slicing::SliceAndHullNames& section, std::uint64_t revision,
                         std::optional<double> id = {}, slicing::Quality quality = slicing::Quality::full,
                         scene::ColorScheme viewer = scene::ColorScheme::dark);
/// Writes the `state` message to `out`. Overwrites `out` and reuses its memory.
void stateMessage(const session::State& state, const slicing::SliceAndHullNames& section, std::uint64_t revision,
                  std::optional<double> id, std::string& out, slicing::Quality quality = slicing::Quality::full,
                  scene::ColorScheme viewer = scene::ColorScheme::dark);

/// Returns the `state` message for a picture outside of sessions: with revision 0, in the dark color scheme, and
/// without the serial number of the object. So equal pictures are equal files.
std::string stateMessageOutsideSessions(const session::State& state, const slicing::SliceAndHullNames& section);

}  // namespace oval4d::wire
