#pragma once

#include "scene/picture_request.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Writes to `out` what is needed to draw the picture of a state. Overwrites `out` and reuses its memory.
void writePictureRequest(const State& state, scene::Viewport viewport, slicing::Quality quality,
                         scene::PictureRequest& out);

/// Returns the request that writePictureRequest() writes.
scene::PictureRequest pictureRequestOf(const State& state, scene::Viewport viewport = {},
                                       slicing::Quality quality = slicing::Quality::full);

}  // namespace oval4d::session
