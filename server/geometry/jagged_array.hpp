#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace oval4d::geometry {

/// A jagged array: rows of different lengths, stored one after another. Row i consists of the items with the indices
/// begin[i] … begin[i + 1] − 1.
struct JaggedArray {
    std::vector<std::uint32_t> begin{0};  ///< the index in `items` of the first item of each row, followed by
                                          ///< items.size()
    std::vector<std::uint32_t> items;

    /// Returns the number of rows.
    std::size_t size() const { return begin.size() - 1; }
    /// Returns row i (0 … size() − 1). The span is valid until the array changes.
    std::span<const std::uint32_t> operator[](std::size_t i) const {
        return {items.data() + begin[i], begin[i + 1] - begin[i]};
    }
    /// Appends a row. `row` must not point into `items` of this array, because appending may reallocate `items`.
    void add(std::span<const std::uint32_t> row) {
        items.insert(items.end(), row.begin(), row.end());
        begin.push_back(static_cast<std::uint32_t>(items.size()));
    }
    bool operator==(const JaggedArray&) const = default;
};

}  // namespace oval4d::geometry
