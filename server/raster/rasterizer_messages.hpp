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
    std::size_t fillSteps = 0;    ///< per picture, for slicing::Filler::fill
    std::size_t objectBytes = 0;  ///< for the objects cached between pictures; the last one is always cached
};

/// The request for one picture.
struct DrawRequest {
    std::uint64_t object = 0;  ///< its serial number; the object follows only if the receiver lacks it
    session::State state;      ///< only the members that affect pictures, without the object
    scene::Viewport viewport;
    RasterizerLimits limits;
};

/// Encodes a draw request. Overwrites `out`.
void encodeRequest(const session::State& state, scene::Viewport viewport, const RasterizerLimits& limits,
                   std::string& out);
/// Decodes a draw request into `out`. Throws std::runtime_error if bytes are missing or the orientation is invalid.
void decodeRequest(std::string_view bytes, DrawRequest& out);

}  // namespace oval4d::raster
