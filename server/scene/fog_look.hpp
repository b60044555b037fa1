#pragma once
// Makes the colors and opacities with which the fog of a field is drawn.

#include <cstdint>
#include <span>
#include <vector>

#include <glm/gtc/type_precision.hpp>

#include "scene/background.hpp"
#include "slicing/field_settings.hpp"
#include "slicing/surfaces/slice_fog.hpp"

namespace oval4d::scene {

/// The transfer function of fog as a table. Entry v is the color 0xAARRGGBB of the lattice points whose byte in
/// SliceFog::values is v. AA is the opacity, 0 … 255, of a layer of fog that is as thick as the object's circumradius.
/// Entry 0, for points without a value, is transparent. The table is empty if there is no fog.
using FogTransferTable = std::vector<std::uint32_t>;

/// The number of entries of a FogTransferTable that is not empty.
inline constexpr std::size_t kFogEntries = 256;

/// Makes the table of the transfer function with the control points `points`, and writes it to `out`. The caller must
/// ensure that `points` is empty (for no fog), or contains at least two points with strictly ascending values. Entry 1
/// is for the value of the first point, entry 255 for the value of the last. A point without a color gets a color of
/// divergingColor(), from blue at the first point to amber at the last. Between two points, sRGB colors and opacities
/// are interpolated linearly. Overwrites `out`.
void makeFogTable(std::span<const slicing::FogControlPoint> points, FogTransferTable& out,
                  ColorScheme scheme = ColorScheme::dark);

/// The number of lattice cubes along each side of the blocks into which findFogBlocks() divides a fog lattice.
inline constexpr int kFogBlock = 4;

/// Finds the blocks of a lattice that may contain visible fog. Writes one byte per block to `out`; x varies fastest.
/// The byte is 255 if `table` gives an opacity above 0 to any value from the least to the greatest value of the block's
/// lattice points. Otherwise it is 0. Lattice points without a value are ignored. Returns the number of blocks along
/// each axis.
glm::ivec3 findFogBlocks(const slicing::SliceFog& fog, const FogTransferTable& table, std::vector<std::uint8_t>& out);

}  // namespace oval4d::scene
