#pragma once
// Types of arrays of numbers in messages.

#include <array>
#include <cstdint>
#include <span>

namespace oval4d::wire {

/// Two or three indices, such as the two ends of an edge or the three corners of a triangle.
using IndexPair = std::array<std::uint32_t, 2>;
using IndexTriple = std::array<std::uint32_t, 3>;

/// A view of a jagged array: n lists, stored one after another in `items`. `begin` has n + 1 entries. List i is the
/// half-open range [begin[i] − begin[0], begin[i + 1] − begin[0]) of `items`. `begin` may be a part of a longer array,
/// so its first entry need not be 0.
struct JaggedArrayView {
    std::span<const std::uint32_t> begin, items;
};

}  // namespace oval4d::wire
