// Binary STL: 80 bytes of header, the number of triangles, and for each its normal, three corners and two spare bytes,
// all little-endian.

#include <array>
#include <bit>
#include <cstring>

#include <glm/geometric.hpp>

#include "export/bytes.hpp"
#include "export/mesh_formats.hpp"

namespace oval4d::exports {

std::string stl(std::span<const Solid> solids) {
    constexpr std::size_t kHeader = 80;
    constexpr std::size_t kTriangle = 50;
    std::size_t count = 0;
    for (const Solid& solid : solids) count += solid.mesh.triangles.size();
    std::string out = "oval4d, millimetres";
    out.reserve(kHeader + 4 + kTriangle * count);
    out.resize(kHeader, ' ');
    put(out, static_cast<std::uint32_t>(count));
    for (const Solid& solid : solids) {
        for (const auto& triangle : solid.mesh.triangles) {
            const glm::dvec3 across = normalOf(solid.mesh, triangle);
            const double length = glm::length(across);
            put(out, length > 0 ? across / length : glm::dvec3(0));
            for (const std::uint32_t corner : triangle) put(out, solid.mesh.points[corner] + solid.at);
            put(out, std::uint16_t{0});
        }
    }
    return out;
}

}  // namespace oval4d::exports
