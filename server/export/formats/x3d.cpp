#include "export/formats/writers.hpp"

#include "export/formats/text.hpp"

namespace oval4d::exports {

namespace {

constexpr double kMeter = 1e-3;  // meters per millimeter

void appendColor(std::string& out, scene::Color color) {
    for (const unsigned shift : {16U, 8U, 0U}) {
        appendDecimal(out, static_cast<float>(color >> shift & 0xffU) / 255.0F);
        out += ' ';
    }
}

// Returns a text as a string of an MFString (a list of strings) in an XML attribute: in double quotes, with a backslash
// before each double quote and backslash (ISO/IEC 19776-1).
std::string quotedString(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

void appendBody(std::string& out, const PlacedMesh& solid, const MeshesToWrite& meshes) {
    out += "<Transform translation=\"";
    appendDecimal(out, glm::dvec3(solid.at * kMeter));
    const std::vector<scene::Color>& colors = solid.mesh.pointColors;
    out += "\"><Shape><Appearance><Material/></Appearance>\n<IndexedFaceSet ";
    out += colors.empty() ? "colorPerVertex=\"false\"" : "creaseAngle=\"0.7\"";
    out += " coordIndex=\"";
    for (const auto& [a, b, c] : solid.mesh.triangles)
        out += std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + " -1 ";
    out += "\">\n<Coordinate point=\"";
    for (const glm::dvec3& point : solid.mesh.points) {
        appendDecimal(out, glm::dvec3(point * kMeter));
        out += ' ';
    }
    out += "\"/>\n<Color color=\"";
    for (const scene::Color color : colors) appendColor(out, color);
    for (std::size_t t = 0; t < solid.mesh.triangles.size() && colors.empty(); ++t)
        appendColor(out, meshes.colorOf(solid, t));
    out += "\"/>\n</IndexedFaceSet>\n<MetadataString name=\"name\" value='" + xmlEscaped(quotedString(solid.name)) +
           "'/>\n</Shape></Transform>\n";
}

}  // namespace

std::string x3d(const MeshesToWrite& meshes) {
    std::string out =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<X3D profile=\"Interchange\" version=\"3.3\">\n<head><meta name=\"title\" content=\"" +
        xmlEscaped(meshes.title) + "\"/><meta name=\"generator\" content=\"oval4d\"/></head>\n<Scene>\n";
    for (const PlacedMesh& solid : meshes.solids) {
        meshes.budget.checkTimeAndStop();
        appendBody(out, solid, meshes);
    }
    return out + "</Scene>\n</X3D>\n";
}

}  // namespace oval4d::exports
