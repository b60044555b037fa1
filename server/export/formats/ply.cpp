#include "export/formats/ply.hpp"

#include "export/formats/little_endian.hpp"

namespace oval4d::exports {

std::string ply(const BodiesToWrite& bodies) {
    const auto solids = bodies.solids;
    std::size_t points = 0;
    std::size_t triangles = 0;
    for (const NamedMesh& solid : solids) {
        points += solid.mesh.points.size();
        triangles += solid.mesh.triangles.size();
    }
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment oval4d, millimeters\nelement vertex " +
                      std::to_string(points) + "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(triangles) +
                      "\nproperty list uchar uint vertex_indices\nproperty uchar red\nproperty uchar green\n"
                      "property uchar blue\nend_header\n";
    for (const NamedMesh& solid : solids) {
        for (const glm::dvec3& point : solid.mesh.points) put(out, point + solid.at);
    }
    std::uint32_t first = 0;
    for (const NamedMesh& solid : solids) {
        for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
            put(out, std::uint8_t{3});
            for (const std::uint32_t corner : solid.mesh.triangles[t]) put(out, first + corner);
            const scene::Color color = bodies.colorOf(solid, t);
            for (const unsigned shift : {16U, 8U, 0U}) put(out, static_cast<std::uint8_t>(color >> shift));
        }
        first += static_cast<std::uint32_t>(solid.mesh.points.size());
    }
    return out;
}

}  // namespace oval4d::exports
