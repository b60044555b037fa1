#include "scene/fog_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "scene/color.hpp"

namespace oval4d::scene {

void makeFogTable(std::span<const slicing::FogControlPoint> points, FogTransferTable& out, ColorScheme scheme) {
    out.clear();
    if (points.empty()) return;
    const double least = points.front().value, range = points.back().value - least;
    // Returns the color (r, g, b) and the opacity (a) of a control point, each from 0 to 255.
    const auto look = [&](const slicing::FogControlPoint& point) {
        const Color color = point.color.value_or(divergingColor(2 * ((point.value - least) / range) - 1, scheme));
        return glm::dvec4(color >> 16 & 255, color >> 8 & 255, color & 255, 255 * point.opacity);
    };
    out.push_back(0);
    std::size_t next = 1;  // the index of the control point at the end of the current segment
    for (std::size_t entry = 1; entry < kFogEntries; ++entry) {
        const double value = least + static_cast<double>(entry - 1) / (kFogEntries - 2) * range;
        while (next + 1 < points.size() && points[next].value < value) ++next;
        const slicing::FogControlPoint &from = points[next - 1], &to = points[next];
        const double part = std::clamp((value - from.value) / (to.value - from.value), 0.0, 1.0);
        const glm::uvec4 mixed(glm::round(glm::mix(look(from), look(to), part)));
        out.push_back(mixed.a << 24 | mixed.r << 16 | mixed.g << 8 | mixed.b);
    }
}

glm::ivec3 findFogBlocks(const slicing::SliceFog& fog, const FogTransferTable& table, std::vector<std::uint8_t>& out) {
    const glm::ivec3 blocks = glm::max((fog.size - 1 + kFogBlock - 1) / kFogBlock, 1);
    // Entry v is the number of entries of `table` with an index less than v that are not transparent.
    std::array<std::uint16_t, kFogEntries + 1> visibleBelow{};
    for (std::size_t value = 0; value < kFogEntries; ++value)
        visibleBelow[value + 1] = static_cast<std::uint16_t>(visibleBelow[value] + (table[value] >> 24 != 0 ? 1 : 0));
    out.clear();
    for (glm::ivec3 b(0); b.z < blocks.z; ++b.z) {
        for (b.y = 0; b.y < blocks.y; ++b.y) {
            for (b.x = 0; b.x < blocks.x; ++b.x) {
                // Points without a value (byte 0) are skipped, because FogPainter, which draws the fog, leaves them out
                // of the interpolation.
                const glm::ivec3 first = b * kFogBlock, last = glm::min(first + kFogBlock, fog.size - 1);
                std::uint8_t least = 255, greatest = 0;
                for (int k = first.z; k <= last.z; ++k) {
                    for (int j = first.y; j <= last.y; ++j) {
                        const auto row =
                            (static_cast<std::size_t>(k) * fog.size.y + static_cast<std::size_t>(j)) * fog.size.x;
                        for (int i = first.x; i <= last.x; ++i) {
                            const std::uint8_t value = fog.values[row + static_cast<std::size_t>(i)];
                            least = std::min<std::uint8_t>(least, value == 0 ? 255 : value);
                            greatest = std::max(greatest, value);
                        }
                    }
                }
                const bool hasFog = greatest > 0 && visibleBelow[greatest + 1U] > visibleBelow[least];
                out.push_back(hasFog ? 255 : 0);
            }
        }
    }
    return blocks;
}

}  // namespace oval4d::scene
