#pragma once
// Sorts shapes by their depths, in time proportional to their number.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace oval4d::render {

/// Sorts shapes from far to near by a radix sort. Reuses its memory.
class DepthOrder {
  public:
    /// A shape of the list, with the key by which it is sorted.
    struct KeyedShape {
        std::uint32_t key;    ///< ascends as the depth descends
        std::uint32_t index;  ///< of the shape in the list
    };

    /// Returns the order of `shapes`, a random-access range, by their member `depth`, a float: from the greatest depth
    /// to the least; shapes at the same depth in the order of the list. The result is valid until the next call.
    template <typename Shapes>
    std::span<const KeyedShape> farToNear(const Shapes& shapes) {
        entries_.clear();
        for (const auto& shape : shapes)
            entries_.push_back({keyOf(shape.depth), static_cast<std::uint32_t>(entries_.size())});
        sort();
        return entries_;
    }

  private:
    static constexpr std::size_t kDigits = 4, kDigitBits = 8;
    static constexpr std::uint32_t digitOf(std::uint32_t key, std::size_t digit) {
        return key >> (kDigitBits * digit) & ((1U << kDigitBits) - 1);
    }

    // The bits of floats with the same sign are ordered as their absolute values. 0 is added because −0 and 0 are
    // equal.
    static std::uint32_t keyOf(float depth) {
        constexpr std::uint32_t kSign = 1U << 31;
        const auto bits = std::bit_cast<std::uint32_t>(depth + 0.0F);
        return (bits & kSign) != 0 ? bits : ~(bits | kSign);
    }

    // Sorts by one digit of the keys after the other, from the lowest on; each pass keeps the order of equal digits.
    void sort() {
        if (entries_.empty()) return;
        std::array<std::array<std::uint32_t, std::size_t{1} << kDigitBits>, kDigits> counts{};
        for (const KeyedShape& entry : entries_)
            for (std::size_t digit = 0; digit < kDigits; ++digit) ++counts[digit][digitOf(entry.key, digit)];
        sorted_.resize(entries_.size());
        for (std::size_t digit = 0; digit < kDigits; ++digit) {
            auto& places = counts[digit];
            if (places[digitOf(entries_.front().key, digit)] == entries_.size()) continue;  // all are equal
            std::uint32_t next = 0;
            for (std::uint32_t& place : places) next += std::exchange(place, next);
            for (const KeyedShape& entry : entries_) sorted_[places[digitOf(entry.key, digit)]++] = entry;
            entries_.swap(sorted_);
        }
    }

    std::vector<KeyedShape> entries_, sorted_;
};

}  // namespace oval4d::render
