#pragma once
// Sorts shapes by their depths, in time proportional to the number of shapes.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace oval4d::render {

/// Sorts shapes from far to near with a radix sort. Reuses its memory for the next list.
class DepthSorter {
  public:
    /// A shape of a list, with the key by which it is sorted.
    struct KeyedShape {
        std::uint32_t key;    ///< a number that increases as the depth of the shape decreases
        std::uint32_t index;  ///< the index of the shape in the list
    };

    /// Returns the order of `shapes` from the greatest depth to the least. `shapes` is a random-access range; the depth
    /// of a shape is its member `depth`, a float. Shapes at the same depth keep the order of the list. The result is
    /// valid until the next call.
    template <typename Shapes>
    std::span<const KeyedShape> sortedFarToNear(const Shapes& shapes) {
        entries_.clear();
        for (const auto& shape : shapes)
            entries_.push_back({sortKeyOf(shape.depth), static_cast<std::uint32_t>(entries_.size())});
        sort();
        return entries_;
    }

  private:
    static constexpr std::size_t kDigits = 4, kDigitBits = 8;
    static constexpr std::uint32_t digitOf(std::uint32_t key, std::size_t digit) {
        return key >> (kDigitBits * digit) & ((1U << kDigitBits) - 1);
    }

    // Returns a number that increases as `depth` decreases. The bits of floats with the same sign are ordered as their
    // absolute values. Adding 0 turns −0 into 0, so that both have the same key.
    static std::uint32_t sortKeyOf(float depth) {
        constexpr std::uint32_t kSign = 1U << 31;
        const auto bits = std::bit_cast<std::uint32_t>(depth + 0.0F);
        return (bits & kSign) != 0 ? bits : ~(bits | kSign);
    }

    // Sorts entries_ by one digit of the keys after another, beginning with the lowest digit. Each pass keeps the order
    // of entries with equal digits.
    void sort() {
        if (entries_.empty()) return;
        std::array<std::array<std::uint32_t, std::size_t{1} << kDigitBits>, kDigits> counts{};
        for (const KeyedShape& entry : entries_)
            for (std::size_t digit = 0; digit < kDigits; ++digit) ++counts[digit][digitOf(entry.key, digit)];
        sorted_.resize(entries_.size());
        for (std::size_t digit = 0; digit < kDigits; ++digit) {
            auto& places = counts[digit];
            // If all keys have the same digit here, the pass would change nothing.
            if (places[digitOf(entries_.front().key, digit)] == entries_.size()) continue;
            std::uint32_t next = 0;
            for (std::uint32_t& place : places) next += std::exchange(place, next);
            for (const KeyedShape& entry : entries_) sorted_[places[digitOf(entry.key, digit)]++] = entry;
            entries_.swap(sorted_);
        }
    }

    std::vector<KeyedShape> entries_, sorted_;
};

}  // namespace oval4d::render
