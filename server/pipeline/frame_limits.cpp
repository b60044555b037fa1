#include "pipeline/frame_limits.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace oval4d::pipeline {

scene::Viewport defaultViewport(const PictureSizeLimits& limits) {
    const scene::Viewport usual;
    const int width = std::max(limits.minSide, std::min(usual.width, limits.maxWidth));
    const int height = std::max(limits.minSide, std::min(usual.height, limits.maxHeight));
    const double pixels = static_cast<double>(width) * height;
    const double scale = std::min(1.0, std::sqrt(static_cast<double>(limits.maxPixels) / pixels));
    // Returns the greatest length of one side of a picture whose other side has the length `length`, so that the
    // picture has at most maxPixels pixels. The result is at most `side`, but at least minSide.
    const auto beside = [&limits](int length, int side) {
        return std::max(limits.minSide, static_cast<int>(std::min<std::int64_t>(side, limits.maxPixels / length)));
    };
    scene::Viewport out;
    out.height = std::max(limits.minSide, static_cast<int>(height * scale));
    out.width = beside(out.height, width);
    out.height = beside(out.width, out.height);  // less than before if minSide has enlarged the width
    return out;
}

Result<scene::Viewport> checkViewport(scene::Viewport viewport, const PictureSizeLimits& limits) {
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
