#include "export/formats/writers.hpp"

#include <algorithm>

#include "export/formats/text.hpp"

namespace oval4d::exports {

namespace {

// Replaces white space and other control characters by underscores, because names in OBJ files are single words.
std::string toSingleWord(std::string name) {
    std::ranges::replace_if(name, [](unsigned char c) { return c <= ' ' || c == 0x7F; }, '_');
    return name;
}

}  // namespace

std::string obj(const MeshesToWrite& meshes) {
    std::string out = "# oval4d, millimeters\n";
    std::size_t first = 1;
    for (const PlacedMesh& solid : meshes.solids) {
        meshes.budget.checkTimeAndStop();
        const Mesh& mesh = solid.mesh;
        out += "o " + toSingleWord(solid.name) + "\n";
        for (const glm::dvec3& point : mesh.points) {
            out += "v ";
            appendDecimal(out, point + solid.at);
            out += '\n';
        }
        std::uint32_t cell = kNoCell;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (mesh.cells[t] != cell) {
                cell = mesh.cells[t];
                out += cell == kNoCell ? "g body\n" : "g cell_" + std::to_string(cell) + "\n";
            }
            out += 'f';
            for (const std::uint32_t corner : mesh.triangles[t]) out += ' ' + std::to_string(first + corner);
            out += '\n';
        }
        first += mesh.points.size();
    }
    return out;
}

}  // namespace oval4d::exports
