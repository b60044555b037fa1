#pragma once

#include <cstdint>

namespace oval4d::fields {

/// Which level of a multiscale image an array is.
struct ImageLevel {
    std::uint32_t level = 0;   ///< 0 for the finest level; less than `levels`, if that is not 0
    std::uint32_t levels = 0;  ///< how many levels the image has; 0 if the array is no level of an image
    bool operator==(const ImageLevel&) const = default;
};

}  // namespace oval4d::fields
