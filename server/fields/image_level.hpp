#pragma once

#include <cstdint>

#include "serialization/stored_members.hpp"

namespace oval4d::fields {

/// Which level of a multiscale image an array is.
struct ImageLevel {
    std::uint32_t level = 0;   ///< 0 for the finest level; less than `levels`, if that is not 0
    std::uint32_t levels = 0;  ///< how many levels the image has; 0 if the array is no level of an image
    std::uint32_t finer = 0;   ///< how many finer levels follow, one after another, as each fits into memory, too
    bool operator==(const ImageLevel&) const = default;
};
void visitStoredMembers(serialization::ReadOrWritten<ImageLevel> auto& image, auto& visit) {
    auto& [level, levels, finer] = image;
    visit.member(0, level);
    visit.member(1, levels);
    visit.addedMember(2, finer);
}

}  // namespace oval4d::fields
