#include "geometry/cell_complex.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <unordered_map>

#include <glm/geometric.hpp>

namespace oval4d::geometry {

namespace {

// Returns whether a vertex loop is a flat, convex polygon. It is one if its exterior angles, taken as positive, add up
// to 2π; the angles of every other loop add up to more (Fenchel's theorem).
bool isConvexLoop(const CellComplex& complex, std::span<const std::uint32_t> loop) {
    if (loop.size() == 3) return true;
    const std::size_t n = loop.size();
    const auto side = [&](std::size_t i) {
        return complex.vertices[loop[(i + 1) % n]] - complex.vertices[loop[i % n]];
    };
    double turning = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec4 a = side(i);
        const glm::dvec4 b = side(i + 1);
        const double inner = glm::dot(a, b);
        turning += std::acos(std::clamp(inner / (glm::length(a) * glm::length(b)), -1.0, 1.0));
    }
    // 1e-6 allows for rounding errors.
    return turning < 2 * std::numbers::pi + 1e-6;
}

}  // namespace

void findEdges(CellComplex& complex) {
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    known.reserve(complex.faces.items.size());
    std::vector<std::uint32_t> edges;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const auto loop = complex.faces[f];
        edges.clear();
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const auto [a, b] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
            const auto [at, fresh] =
                known.try_emplace((std::uint64_t{a} << 32) | b, static_cast<std::uint32_t>(complex.edges.size()));
            if (fresh) complex.edges.push_back({a, b});
            edges.push_back(at->second);
        }
        complex.faceEdges.add(edges);
    }
}

bool hasConvexFaces(const CellComplex& complex) {
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (!isConvexLoop(complex, complex.faces[f])) return false;
    }
    return true;
}

std::size_t memoryOfRows(const JaggedArray& array) {
    return sizeof(std::uint32_t) * (array.begin.size() + array.items.size());
}

std::size_t memoryOfElements(const CellComplex& complex) {
    return complex.vertices.size() * sizeof complex.vertices[0] + complex.edges.size() * sizeof complex.edges[0] +
           complex.faceCells.size() * sizeof complex.faceCells[0] + complex.cellSigns.size() +
           complex.typeOfCell.size() * sizeof complex.typeOfCell[0] + memoryOfRows(complex.faces) +
           memoryOfRows(complex.faceEdges) + memoryOfRows(complex.cells);
}

}  // namespace oval4d::geometry
