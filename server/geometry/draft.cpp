#include "geometry/draft.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "geometry/file_text.hpp"

namespace oval4d::geometry {

namespace {

constexpr double kFlat = 5e-3;  // of the size: what three decimals leave, with room
constexpr double kThin = 1e-6;  // of the size: no polytope has less extent in any direction

// How far the points are from lying in one affine subspace of this dimension (2 or 3): the largest distance from the
// one through the points that are farthest from each other.
double deviation(std::vector<glm::dvec4> points, int dimension) {
    if (points.empty()) return 0;  // a cell whose 2-faces have shrunk to nothing: `build` refuses it
    const glm::dvec4 origin = points.front();
    for (auto& p : points) p -= origin;
    const auto shorter = [](const glm::dvec4& a, const glm::dvec4& b) { return glm::dot(a, a) < glm::dot(b, b); };
    for (int i = 0; i < dimension; ++i) {
        const glm::dvec4 longest = *std::max_element(points.begin(), points.end(), shorter);
        const double length = glm::length(longest);
        if (!(length > 0)) return 0;
        for (auto& p : points) p -= longest / length * glm::dot(p, longest / length);
    }
    return glm::length(*std::max_element(points.begin(), points.end(), shorter));
}

std::string nameOf(const char* element, const Draft::Origin& origin) {
    return std::string(element) + ' ' + std::to_string(origin.number) + ' ';
}

}  // namespace

double sizeOf(const Draft& draft) {
    glm::dvec4 low(std::numeric_limits<double>::infinity());
    glm::dvec4 high = -low;
    for (const auto& v : draft.vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    return draft.vertices.empty() ? 0 : glm::length(high - low) / 2;
}

void checkFlat(const Draft& draft) {
    const double size = sizeOf(draft);
    if (draft.vertices.empty() || deviation(draft.vertices, 3) <= kThin * size)
        refuse(0, "all vertices lie in one hyperplane");
    std::vector<glm::dvec4> points;
    for (std::size_t f = 0; f < draft.faces.size(); ++f) {
        points.clear();
        for (const std::uint32_t v : draft.faces[f]) points.push_back(draft.vertices[v]);
        const auto& origin = draft.faceOrigins[f];
        if (deviation(points, 2) > kFlat * size) refuse(origin.line, nameOf("2-face", origin) + "is not flat");
    }
    for (std::size_t c = 0; c < draft.cells.size(); ++c) {
        points.clear();
        for (const std::uint32_t f : draft.cells[c]) {
            for (const std::uint32_t v : draft.faces[f]) points.push_back(draft.vertices[v]);
        }
        const auto& origin = draft.cellOrigins[c];
        if (deviation(points, 3) > kFlat * size)
            refuse(origin.line, nameOf("cell", origin) + "does not lie in a hyperplane");
    }
}

Polytope build(Draft draft, std::string name) {
    try {
        return makePolytope(std::move(name), std::move(draft.vertices), std::move(draft.faces), std::move(draft.cells));
    } catch (const Unsound& fault) {
        const bool face = fault.part == Unsound::Part::face;
        if (fault.part == Unsound::Part::whole) refuse(0, fault.detail);
        const auto& origin = (face ? draft.faceOrigins : draft.cellOrigins)[fault.index];
        refuse(origin.line, nameOf(face ? "2-face" : "cell", origin) + fault.detail);
    }
}

}  // namespace oval4d::geometry
