#pragma once

#include "raster/picture_request.hpp"
#include "session/session.hpp"

namespace oval4d::pipeline {

/// Writes the request for the picture of a session's state. Overwrites `out` and reuses its memory.
void writePictureOfState(const session::State& state, scene::Viewport viewport, slicing::Quality quality,
                         raster::PictureRequest& out);

}  // namespace oval4d::pipeline
