#pragma once
// Messages between the server and its rasterizer processes.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scene/scene.hpp"
#include "session/session.hpp"

namespace oval4d::raster {

/// Limits on the work and memory of a rasterizer process.
struct RasterizerLimits {
    std::size_t fillSteps = 0;    ///< maximum number of steps in one picture: see slicing::Filler::fill
    std::size_t objectBytes = 0;  ///< maximum size of the object cache; the last object is always cached
};

/// The request for one picture.
struct DrawRequest {
    std::uint64_t object = 0;  ///< serial number of the object, which is sent only if the process lacks it
    session::State state;      ///< only the members that affect pictures are sent, and not the object
    scene::Viewport viewport;
    RasterizerLimits limits;
};

/// Encodes a draw request. Overwrites `out`.
void encodeRequest(const session::State& state, scene::Viewport viewport, const RasterizerLimits& limits,
                   std::string& out);
/// Decodes a draw request into `out`. Throws std::runtime_error if bytes are missing or the orientation is invalid.
void decodeRequest(std::string_view bytes, DrawRequest& out);

}  // namespace oval4d::raster
