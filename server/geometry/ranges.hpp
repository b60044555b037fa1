#pragma once
// Counting into consecutive ranges, one a hyperplane.

#include <cstdint>
#include <vector>

namespace oval4d::geometry {

/// Counts one more element in hyperplanes from … to − 1, as differences that `accumulate` sums up; none where
/// from = to.
inline void countSpan(std::vector<std::uint32_t>& counts, std::int32_t from, std::int32_t to) {
    counts[from] += 1;
    counts[to] -= 1;  // wraps below zero for a while; the sums do not
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
