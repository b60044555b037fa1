#pragma once
// Limits on the size of pictures that clients request.

#include <cstdint>

#include "errors/error.hpp"
#include "scene/scene.hpp"

namespace oval4d::pipeline {

/// The allowed sizes of pictures, in pixels. `minSide` is the minimum of the width and of the height. `maxPixels` is
/// the maximum of width times height.
struct PictureSizeLimits {
    int minSide = 16, maxWidth = 8192, maxHeight = 8192;
    std::int64_t maxPixels = 16'777'216;
};

/// Returns the size of a picture for which the client gives no size: the size of a default scene::Viewport or, if the
/// limits do not allow this size, an allowed size near it. If the limits contradict each other, no size is allowed, and
/// checkViewport() refuses the result.
scene::Viewport defaultViewport(const PictureSizeLimits& limits);

/// Returns `viewport` if it is within the limits. Otherwise returns the error `out_of_range`, whose message says which
/// sizes are allowed.
Result<scene::Viewport> checkViewport(scene::Viewport viewport, const PictureSizeLimits& limits);

}  // namespace oval4d::pipeline
