#pragma once
// Prefix sums: from the numbers of elements by hyperplane to consecutive ranges, one for each hyperplane.

#include <cstdint>
#include <vector>

namespace oval4d::slicing {

/// Counts an element in hyperplanes from … to − 1 (in none if from = to). `counts` holds the differences of successive
/// counts, for `accumulate`.
inline void countSpan(std::vector<std::uint32_t>& counts, std::int32_t from, std::int32_t to) {
    counts[from] += 1;
    counts[to] -= 1;  // may wrap around below zero; the sums do not
}

/// Replaces the differences by the beginnings of the ranges, followed by the total. Returns the total.
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

}  // namespace oval4d::slicing
