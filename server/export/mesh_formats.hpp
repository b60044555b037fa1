#pragma once
// Bodies as the bytes of a file.

#include <span>
#include <string>

#include "export/budget.hpp"
#include "export/mesh.hpp"

namespace oval4d::exports {

/// What the cells are painted in; a triangle without a cell has its solid's colour.
using Colours = std::span<const scene::Colour>;

scene::Colour colourOf(const Solid& solid, std::size_t triangle, Colours cells);

/// Binary STL: all bodies in one.
std::string stl(std::span<const Solid> solids);
/// Wavefront OBJ: an object for each body, in it a group for each cell.
std::string obj(std::span<const Solid> solids);
/// Binary PLY, little-endian: all bodies in one, each triangle with its colour.
std::string ply(std::span<const Solid> solids, Colours cells);
/// glTF 2.0 in one file, in metres: a node for each body, the colours at the vertices.
std::string glb(std::span<const Solid> solids, Colours cells);
/// 3MF: an object for each body, in millimetres. Throws std::runtime_error if lib3mf fails, Refused if it takes too
/// long.
std::string threeMf(std::span<const Solid> solids, const std::string& title, const Budget& budget);

}  // namespace oval4d::exports
