#include "polytopes/off.hpp"

#include <algorithm>

#include "text/decimal.hpp"
#include "text/message_text.hpp"

namespace oval4d::polytopes {

namespace {

void appendRows(std::string& out, const geometry::JaggedArray& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        out += std::to_string(rows[i].size());
        for (const std::uint32_t item : rows[i]) out += ' ' + std::to_string(item);
        out += '\n';
    }
}

}  // namespace

std::string write4Off(const geometry::CellComplex& complex, std::span<const glm::dvec4> vertices) {
    std::string name = complex.name;
    std::ranges::replace_if(name, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    std::string out = "4OFF\n# " + name + "\n# vertices, 2-faces, edges, cells\n" + std::to_string(vertices.size()) +
                      ' ' + std::to_string(complex.faces.size()) + ' ' + std::to_string(complex.edges.size()) + ' ' +
                      std::to_string(complex.cells.size()) + '\n';
    for (const glm::dvec4& v : vertices) {
        for (int axis = 0; axis < 4; ++axis) {
            out += text::shortestDecimal(v[axis]);
            out += axis < 3 ? ' ' : '\n';
        }
    }
    appendRows(out, complex.faces);
    appendRows(out, complex.cells);
    return out;
}

}  // namespace oval4d::polytopes
