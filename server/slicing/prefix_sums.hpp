#pragma once
// Prefix sums that convert the numbers of elements in parallel hyperplanes to consecutive ranges of indices.

#include <cstdint>
#include <vector>

namespace oval4d::slicing {

/// Counts one element in each of the hyperplanes with the indices in [from, to). Requires from ≤ to. `counts` is a
/// difference array with one more entry than there are hyperplanes: entry k is the number of elements in hyperplane k
/// minus the number in hyperplane k − 1. When all elements are counted, differencesToRangeBegins() converts it.
inline void addToDifferences(std::vector<std::uint32_t>& counts, std::int32_t from, std::int32_t to) {
    counts[from] += 1;
    counts[to] -= 1;  // may wrap around below 0, but the sums are correct
}

/// Converts the difference array of addToDifferences() in place. Entry k becomes the index at which the range of
/// hyperplane k begins; the last entry becomes the total number of elements. Returns this total.
inline std::uint32_t differencesToRangeBegins(std::vector<std::uint32_t>& begin) {
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
