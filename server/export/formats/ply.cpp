#include "export/formats/writers.hpp"

#include <bit>
#include <cstdint>
#include <limits>

#include "export/formats/little_endian.hpp"

namespace oval4d::exports {

namespace {

void putColor(std::string& out, scene::Color color) {
    for (const unsigned shift : {16U, 8U, 0U}) putLittleEndian(out, static_cast<std::uint8_t>(color >> shift));
}

void putPoints(std::string& out, const PlacedMesh& solid, bool colored, bool asDoubles) {
    const Mesh& mesh = solid.mesh;
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        const glm::dvec3 point = mesh.points[p] + solid.at;
        if (asDoubles) {
            for (int i = 0; i < 3; ++i) putLittleEndian(out, std::bit_cast<std::uint64_t>(point[i]));
        } else {
            putLittleEndian(out, point);
        }
        if (!colored) continue;
        const bool own = !mesh.pointColors.empty();
        putColor(out, own ? mesh.pointColors[p] : solid.color);
        putLittleEndian(out, own ? mesh.pointValues[p] : std::numeric_limits<float>::quiet_NaN());
    }
}

}  // namespace

std::string ply(const MeshesToWrite& meshes) {
    const auto solids = meshes.solids;
    std::size_t points = 0;
    std::size_t triangles = 0;
    for (const PlacedMesh& solid : solids) {
        points += solid.mesh.points.size();
        triangles += solid.mesh.triangles.size();
    }
    // Whether points have colors. If not, triangles have colors.
    const bool colored = meshes.anyHasPointColors();
    const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string number = meshes.hasDoubles ? "double" : "float";
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment oval4d, millimeters\nelement vertex " +
                      std::to_string(points) + "\nproperty " + number + " x\nproperty " + number + " y\nproperty " +
                      number + " z\n" + (colored ? colors + "property float value\n" : "") + "element face " +
                      std::to_string(triangles) + "\nproperty list uchar uint vertex_indices\n" +
                      (colored ? "" : colors) + "end_header\n";
    for (const PlacedMesh& solid : solids) {
        meshes.budget.checkTimeAndStop();
        putPoints(out, solid, colored, meshes.hasDoubles);
    }
    std::uint32_t first = 0;
    for (const PlacedMesh& solid : solids) {
        meshes.budget.checkTimeAndStop();
        for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
            putLittleEndian(out, std::uint8_t{3});
            for (const std::uint32_t corner : solid.mesh.triangles[t]) putLittleEndian(out, first + corner);
            if (!colored) putColor(out, meshes.colorOf(solid, t));
        }
        first += static_cast<std::uint32_t>(solid.mesh.points.size());
    }
    return out;
}

}  // namespace oval4d::exports
