#pragma once

#include <cstdint>

#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// Which level of a multiscale image an array is. A multiscale image stores the same image at several resolutions.
struct MultiscaleImageLevel {
    std::uint32_t level = 0;   ///< 0 for the finest level; less than `levels`, unless `levels` is 0
    std::uint32_t levels = 0;  ///< the number of levels of the image; 0 if the array is not a level of an image
    std::uint32_t finer = 0;   ///< the number of finer levels that fit into memory, and are read after this one
    bool operator==(const MultiscaleImageLevel&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<MultiscaleImageLevel> auto& image, auto& visit) {
    auto& [level, levels, finer] = image;
    visit.member(0, level);
    visit.member(1, levels);
    visit.memberAddedLater(2, finer);
}

}  // namespace oval4d::fields
