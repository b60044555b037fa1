#include "export/text.hpp"
#include "export/text_formats.hpp"

namespace oval4d::exports {

namespace {

void append(std::string& out, const geometry::Lists& lists) {
    for (std::size_t i = 0; i < lists.size(); ++i) {
        out += std::to_string(lists[i].size());
        for (const std::uint32_t item : lists[i]) out += ' ' + std::to_string(item);
        out += '\n';
    }
}

}  // namespace

std::string off(const geometry::Polytope& polytope, const geometry::SliceSet& slices) {
    std::string name = polytope.name;
    for (char& c : name) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    std::string out = "4OFF\n# " + name + "\n# vertices, 2-faces, edges, cells\n" +
                      std::to_string(polytope.vertices.size()) + ' ' + std::to_string(polytope.faces.size()) + ' ' +
                      std::to_string(polytope.edges.size()) + ' ' + std::to_string(polytope.cells.size()) + '\n';
    for (const glm::dvec4& v : slices.turned) {
        exports::append(out, glm::dvec3(v.x, v.y, v.z));
        out += ' ';
        exports::append(out, v.w);
        out += '\n';
    }
    append(out, polytope.faces);
    append(out, polytope.cells);
    return out;
}

}  // namespace oval4d::exports
