#pragma once
// How large a picture may be.

#include <cstdint>

#include "protocol/cpp/error.hpp"
#include "scene/scene.hpp"

namespace oval4d::picture {

/// In pixels.
struct FrameLimits {
    int minSide = 16, maxWidth = 8192, maxHeight = 8192;
    std::int64_t maxPixels = 16'777'216;
};

/// `out_of_range`, saying what is allowed, unless a picture of this size may be made.
protocol::Result<scene::Viewport> checked(scene::Viewport viewport, const FrameLimits& limits);

}  // namespace oval4d::picture
