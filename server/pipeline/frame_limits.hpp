#pragma once
// Limits on the size of a picture.

#include <cstdint>

#include "errors/error.hpp"
#include "scene/scene.hpp"

namespace oval4d::pipeline {

/// The allowed sizes of pictures. `minSide` is the minimum width and height. All values are in pixels.
struct FrameLimits {
    int minSide = 16, maxWidth = 8192, maxHeight = 8192;
    std::int64_t maxPixels = 16'777'216;
};

/// Returns the size of a picture if the client gives no size: the size of a default scene::Viewport or, if the limits
/// do not allow it, a size near it that they allow. If the limits contradict each other, no size is allowed, and
/// checkViewport() refuses the result.
scene::Viewport usualViewport(const FrameLimits& limits);

/// Returns the viewport if it is within the limits, else the error `out_of_range`, whose message says what is allowed.
Result<scene::Viewport> checkViewport(scene::Viewport viewport, const FrameLimits& limits);

}  // namespace oval4d::pipeline
