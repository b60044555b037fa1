#pragma once
// Counting into consecutive ranges, one a hyperplane.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace oval4d::geometry {

/// Counts one more element in hyperplanes from … to − 1, as differences that `accumulate` sums up; none where
/// from = to.
inline void countSpan(std::vector<std::uint32_t>& counts, std::int32_t from, std::int32_t to) {
    counts[from] += 1;
    counts[to] -= 1;  // wraps below zero for a while; the sums do not
}

/// Elements of slices that are made elsewhere: by hyperplane, where such a slice is, how many; kOwn where it is not.
inline constexpr std::uint32_t kOwn = 0xffffffffU;

/// Turns the differences into the begin of each range, the total last. Where `elsewhere` has a slice, its range is as
/// long as that, and its own elements go behind all others. `place` gets where the elements of each slice go, and its
/// end last.
inline void accumulate(std::vector<std::uint32_t>& begin, const std::vector<std::uint32_t>& elsewhere,
                       std::vector<std::uint32_t>& place) {
    const std::size_t slices = begin.size() - 1;
    place.resize(slices + 1);
    std::uint32_t total = 0;
    std::uint32_t here = 0;
    for (std::size_t k = 0; k < slices; ++k) {
        here += begin[k];
        begin[k] = total;
        place[k] = elsewhere[k] == kOwn ? total : here;
        total += elsewhere[k] == kOwn ? here : elsewhere[k];
    }
    begin[slices] = total;
    for (std::size_t k = 0; k < slices; ++k) {
        if (elsewhere[k] != kOwn) total += std::exchange(place[k], total);
    }
    place[slices] = total;
}

/// Turns the differences into the begin of each range, the total last, and returns the total.
inline std::uint32_t accumulate(std::vector<std::uint32_t>& begin) {
    std::uint32_t total = 0;
    std::uint32_t here = 0;
    for (auto& entry : begin) {
        here += entry;
        entry = total;
        total += here;
    }
    return begin.back();
}

}  // namespace oval4d::geometry
