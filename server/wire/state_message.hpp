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

/// Returns the `state` message of a state. `section` has the names of the section in the state's focus slice, and
/// `quality` is the quality of the picture that follows. `viewer` is the color scheme of this picture if the background
/// is scene::Background::automatic; it determines the colors of cell types and of values in the message. The PNG files
/// of frames contain the same text.
///
/// The serial number of the object in the message is that of State::source, because the frame of reference is a setting
/// of the message.
std::string stateMessage(const session::State& state, const slicing::SectionNamePair& section, std::uint64_t revision,
                         std::optional<double> id = {}, slicing::Quality quality = slicing::Quality::full,
                         scene::Scheme viewer = scene::Scheme::dark);
/// Writes the `state` message to `out`. Overwrites `out` and reuses its memory.
void stateMessage(const session::State& state, const slicing::SectionNamePair& section, std::uint64_t revision,
                  std::optional<double> id, std::string& out, slicing::Quality quality = slicing::Quality::full,
                  scene::Scheme viewer = scene::Scheme::dark);

/// Returns the `state` message for a picture that belongs to no session: with revision 0, for viewers who prefer dark
/// pictures, and without the serial number of the object, so that equal pictures are equal files.
std::string stateMessageOutsideSessions(const session::State& state, const slicing::SectionNamePair& section);

}  // namespace oval4d::wire
