#include "export/formats/writers.hpp"

#include <array>
#include <bit>
#include <cstring>

#include <glm/geometric.hpp>

#include "export/formats/little_endian.hpp"

// A binary STL file consists of a header of 80 bytes, the number of triangles, and the triangles. A triangle consists
// of its normal, three corners and two unused bytes. All numbers are little-endian.

namespace oval4d::exports {

std::string stl(const MeshesToWrite& meshes) {
    const auto solids = meshes.solids;
    constexpr std::size_t kHeader = 80;
    constexpr std::size_t kTriangle = 50;
    std::size_t count = 0;
    for (const PlacedMesh& solid : solids) count += solid.mesh.triangles.size();
    std::string out = "oval4d, millimeters";
    out.reserve(kHeader + 4 + kTriangle * count);
    out.resize(kHeader, ' ');
    putLittleEndian(out, static_cast<std::uint32_t>(count));
    for (const PlacedMesh& solid : solids) {
        meshes.budget.checkTimeAndStop();
        for (const auto& triangle : solid.mesh.triangles) {
            const glm::dvec3 across = doubleAreaNormalOf(solid.mesh, triangle);
            const double length = glm::length(across);
            putLittleEndian(out, length > 0 ? across / length : glm::dvec3(0));
            for (const std::uint32_t corner : triangle) putLittleEndian(out, solid.mesh.points[corner] + solid.at);
            putLittleEndian(out, std::uint16_t{0});
        }
    }
    return out;
}

}  // namespace oval4d::exports
