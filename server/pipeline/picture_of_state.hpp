#pragma once

#include "raster/picture_request.hpp"
#include "session/session.hpp"

namespace oval4d::pipeline {

/// Returns the request for the picture of a session's state.
raster::PictureRequest pictureOfState(const session::State& state, scene::Viewport viewport, slicing::Quality quality);

}  // namespace oval4d::pipeline
