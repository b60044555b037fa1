#include "export/formats/writers.hpp"

#include <string_view>
#include <utility>

#include "export/formats/text.hpp"

namespace oval4d::exports {

namespace {

// Returns the name of the module for the body with the index `body`.
std::string moduleName(std::size_t body) { return "body_" + std::to_string(body + 1); }

// Appends a vector in the syntax of OpenSCAD, such as "[1, 0.5, 0]".
void appendBracketed(std::string& out, const glm::dvec3& vector) {
    for (int axis = 0; axis < 3; ++axis) {
        out += axis == 0 ? "[" : ", ";
        appendDecimal(out, vector[axis]);
    }
    out += ']';
}

void appendModule(std::string& out, const std::string& name, const PlacedMesh& solid) {
    // `convexity` is the number of times that a line of sight may enter the body. If a line enters the body more often,
    // previews of differences and intersections in OpenSCAD are wrong.
    out += "\n// " + removeNonXmlCharacters(solid.name) + "\nmodule " + name + "() {\n    color(\"" +
           scene::cssColor(solid.color) + "\") polyhedron(convexity = 10, points = [";
    std::string_view separator = "\n";
    for (const glm::dvec3& point : solid.mesh.points) {
        out += std::exchange(separator, ",\n");
        appendBracketed(out, point);
    }
    out += "\n], faces = [";
    separator = "\n[";
    for (const auto& [a, b, c] : solid.mesh.triangles) {
        out += std::exchange(separator, ",\n[");
        // Swap two corners: seen from outside, faces in OpenSCAD are clockwise, but triangles of a Mesh are
        // counterclockwise.
        out += std::to_string(a) + ", " + std::to_string(c) + ", " + std::to_string(b) + ']';
    }
    out += "\n]);\n}\n";
}

}  // namespace

std::string scad(const MeshesToWrite& meshes) {
    // removeNonXmlCharacters() removes line ends, because a line end in a name would end the comment.
    std::string out = "// " + removeNonXmlCharacters(meshes.title) + ", in millimeters, from oval4d\n";
    for (std::size_t i = 0; i < meshes.solids.size(); ++i) {
        meshes.budget.checkTimeAndStop();
        appendModule(out, moduleName(i), meshes.solids[i]);
    }
    out += '\n';
    for (std::size_t i = 0; i < meshes.solids.size(); ++i) {
        out += "translate(";
        appendBracketed(out, meshes.solids[i].at);
        out += ") " + moduleName(i) + "();\n";
    }
    return out;
}

}  // namespace oval4d::exports
