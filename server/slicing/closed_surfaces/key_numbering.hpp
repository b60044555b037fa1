#pragma once
// A hash table that gives keys consecutive numbers. The keys identify, for example, the lattice simplices in which the
// points of a surface lie.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace oval4d::slicing {

/// A hash table that numbers 64-bit keys 0, 1, 2 … in the order in which they are first looked up. Keys must be less
/// than 2⁶⁴ − 1. Uses open addressing with linear probing.
class KeyNumbering {
  public:
    /// Returns the number of `key`, and true if this is the first lookup of `key`. A new key gets the next number.
    std::pair<std::uint32_t, bool> findOrAdd(std::uint64_t key) {
        if (2 * (count_ + 1) > slots_.size()) grow();
        KeySlot& slot = findSlot(key);
        if (slot.key == key) return {slot.number, false};
        slot = {key, static_cast<std::uint32_t>(count_++)};
        return {slot.number, true};
    }
    /// Removes all keys.
    void clear() {
        slots_.assign(slots_.size(), KeySlot{});
        count_ = 0;
    }

  private:
    static constexpr std::uint64_t kFree = ~std::uint64_t{0};
    struct KeySlot {
        std::uint64_t key = kFree;
        std::uint32_t number = 0;
    };

    KeySlot& findSlot(std::uint64_t key) {
        const std::size_t mask = slots_.size() - 1;
        const std::uint64_t hash = key * 0x9e3779b97f4a7c15ULL;
        for (std::size_t i = (hash ^ hash >> 32U) & mask;; i = (i + 1) & mask) {
            if (slots_[i].key == key || slots_[i].key == kFree) return slots_[i];
        }
    }
    void grow() {
        std::vector<KeySlot> old(slots_.empty() ? 1024 : 2 * slots_.size());
        std::swap(old, slots_);
        for (const KeySlot& slot : old) {
            if (slot.key != kFree) findSlot(slot.key) = slot;
        }
    }

    std::vector<KeySlot> slots_;  // the size is 0 or a power of two
    std::size_t count_ = 0;
};

}  // namespace oval4d::slicing
