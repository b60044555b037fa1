#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace oval4d::geometry {

/// Rows of different lengths stored in one array: row i is items[begin[i]] … items[begin[i + 1] − 1].
struct JaggedArray {
    std::vector<std::uint32_t> begin{0};
    std::vector<std::uint32_t> items;

    std::size_t size() const { return begin.size() - 1; }
    std::span<const std::uint32_t> operator[](std::size_t i) const {
        return {items.data() + begin[i], begin[i + 1] - begin[i]};
    }
    void add(std::span<const std::uint32_t> row) {
        items.insert(items.end(), row.begin(), row.end());
        begin.push_back(static_cast<std::uint32_t>(items.size()));
    }
    bool operator==(const JaggedArray&) const = default;
};

}  // namespace oval4d::geometry
