#pragma once
// Messages between the server and its rasterizer processes.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scene/scene.hpp"
#include "session/session.hpp"

namespace oval4d::raster {

struct RasterizerLimits {
    std::size_t fillSteps = 0;    ///< per picture, in the steps of slicing::Filler
    std::size_t objectBytes = 0;  ///< memory for objects cached between pictures
};

/// The request for one picture.
struct DrawRequest {
    std::uint64_t object = 0;  ///< serial number; the object itself is sent if the receiver lacks it
    session::State state;      ///< only the members that affect pictures, without the object
    scene::Viewport viewport;
    RasterizerLimits limits;
};

/// Encodes a draw request. Overwrites `out`.
void encodeRequest(const session::State& state, scene::Viewport viewport, const RasterizerLimits& limits,
                   std::string& out);
/// Decodes a draw request. Throws std::runtime_error if it is invalid.
void decodeRequest(std::string_view bytes, DrawRequest& out);

}  // namespace oval4d::raster
