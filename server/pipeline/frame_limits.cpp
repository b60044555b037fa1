#include "pipeline/frame_limits.hpp"

#include <string>

namespace oval4d::pipeline {

Result<scene::Viewport> checkViewport(scene::Viewport viewport, const FrameLimits& limits) {
    const auto [width, height] = viewport;
    const auto complaint = [&](const std::string& allowed) {
        return Error{ErrorCode::out_of_range, "a picture of " + std::to_string(width) + "×" + std::to_string(height) +
                                                  " pixels cannot be made: " + allowed};
    };
    const std::string least = std::to_string(limits.minSide);
    if (width < limits.minSide || width > limits.maxWidth) {
        return complaint("the width must be between " + least + " and " + std::to_string(limits.maxWidth));
    }
    if (height < limits.minSide || height > limits.maxHeight) {
        return complaint("the height must be between " + least + " and " + std::to_string(limits.maxHeight));
    }
    if (std::int64_t{width} * height > limits.maxPixels) {
        return complaint("it may have at most " + std::to_string(limits.maxPixels) + " pixels");
    }
    return viewport;
}

}  // namespace oval4d::pipeline
