#include "polytopes/import/polygon_soup.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "text_files/file_error.hpp"

namespace oval4d::polytopes {

using text_files::throwFileError;

namespace {

constexpr double kThin = 1e-6;  // the minimum extent of a polytope in each direction, relative to halfDiagonal()

// Returns the largest distance of a point from a flat through some of the points. The flat is a plane if `dimension` is
// 2, and a hyperplane if it is 3. The flat passes through points that are far apart.
double deviationFromFlat(std::vector<glm::dvec4> points, int dimension) {
    if (points.empty()) return 0;  // a cell that has lost all its 2-faces has no points; build() will reject it
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

std::string nameOf(const char* element, const PolygonSoup::SourcePosition& position) {
    return std::string(element) + ' ' + std::to_string(position.number) + ' ';
}

}  // namespace

double halfDiagonal(std::span<const glm::dvec4> points) {
    glm::dvec4 low(std::numeric_limits<double>::infinity());
    glm::dvec4 high = -low;
    for (const auto& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return points.empty() ? 0 : glm::length(high - low) / 2;
}

double doublePrecisionErrorBound(std::span<const glm::dvec4> points) {
    double largest = 0;
    for (const glm::dvec4& p : points) largest = std::max(largest, glm::length(p));
    return 4 * std::numeric_limits<double>::epsilon() * largest;
}

void checkFlatnessAndDimension(const PolygonSoup& soup) {
    const double size = halfDiagonal(soup.vertices);
    if (soup.vertices.empty() || deviationFromFlat(soup.vertices, 3) <= kThin * size)
        throwFileError(0, "all vertices lie in one hyperplane");
    std::vector<glm::dvec4> points;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        points.clear();
        for (const std::uint32_t v : soup.faces[f]) points.push_back(soup.vertices[v]);
        const auto& position = soup.faceSourcePositions[f];
        if (deviationFromFlat(points, 2) > kFlatnessTolerance * size)
            throwFileError(position.line, nameOf("2-face", position) + "is not flat");
    }
    for (std::size_t c = 0; c < soup.cells.size(); ++c) {
        points.clear();
        for (const std::uint32_t f : soup.cells[c]) {
            for (const std::uint32_t v : soup.faces[f]) points.push_back(soup.vertices[v]);
        }
        const auto& position = soup.cellSourcePositions[c];
        if (deviationFromFlat(points, 3) > kFlatnessTolerance * size)
            throwFileError(position.line, nameOf("cell", position) + "does not lie in a hyperplane");
    }
}

Polytope build(PolygonSoup soup, std::string name) {
    try {
        return makePolytope(std::move(name), std::move(soup.vertices), std::move(soup.faces), std::move(soup.cells));
    } catch (const InvalidPolytope& fault) {
        const bool face = fault.part == InvalidPolytope::FaultLocation::face;
        if (fault.part == InvalidPolytope::FaultLocation::whole) throwFileError(0, fault.detail);
        const auto& position = (face ? soup.faceSourcePositions : soup.cellSourcePositions)[fault.index];
        throwFileError(position.line, nameOf(face ? "2-face" : "cell", position) + fault.detail);
    }
}

}  // namespace oval4d::polytopes
