#pragma once
// Indices of vertices, edges, faces and cells.

#include <cstdint>

namespace oval4d::geometry {

/// The value of an index that refers to no vertex, edge, 2-face or cell.
inline constexpr std::uint32_t kNone = 0xffffffffU;

}  // namespace oval4d::geometry
