#include "slicing/element_shape.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "geometry/point_cloud.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"

namespace oval4d::slicing {

namespace {

using geometry::CellComplex;
using geometry::PointCloud;

// Returns the index of `number` in a sorted list that contains it.
std::uint32_t indexInSorted(const std::vector<std::uint32_t>& sorted, std::uint32_t number) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(sorted, number) - sorted.begin());
}

// Appends the vertices with the indices `numbers`, rotated by `turn`, to `out`. Sets the entry of
// SliceSet::vertexSource for vertex v to firstSource + v. Returns the w coordinate of the first rotated vertex.
double addVertices(const std::vector<glm::dvec4>& vertices, const std::vector<std::uint32_t>& numbers,
                   std::uint32_t firstSource, const geometry::Rotation& turn, SliceSet& out) {
    for (const std::uint32_t v : numbers) {
        out.vertices.emplace_back(turn(vertices[v]));
        out.vertexSource.push_back(firstSource + v);
    }
    return turn(vertices[numbers.front()]).w;
}

// Appends the 2-faces of a cell to `out`. `vertices` and `edges` are the sorted indices of the cell's vertices and
// edges in the complex; `out` must already contain these vertices.
void addCellFaces(const CellComplex& p, std::size_t cell, const std::vector<std::uint32_t>& vertices,
                  const std::vector<std::uint32_t>& edges, SliceSet& out) {
    const auto pointOf = [&](std::uint32_t v) {
        return out.vertices[indexInSorted(vertices, v)] - out.vertices.front();
    };
    // First, each loop whose entry in cellSigns is −1 is reversed. Then the loops of all 2-faces have the same
    // direction in the hyperplane, as seen from outside the cell. The direction depends on which side of the cell faces
    // toward +w. To find it, these loops are divided into triangles with the corners a, b and c. The direction is
    // counterclockwise if `volume`, the sum of det(a, b, c), is positive, else clockwise.
    double volume = 0;
    for (std::uint32_t at = p.cells.begin[cell]; at < p.cells.begin[cell + 1]; ++at) {
        const auto loop = p.faces[p.cells.items[at]];
        for (std::size_t i = 1; i + 1 < loop.size(); ++i)
            volume += p.cellSigns[at] * glm::dot(pointOf(loop[0]), glm::cross(pointOf(loop[i]), pointOf(loop[i + 1])));
    }
    for (std::uint32_t at = p.cells.begin[cell]; at < p.cells.begin[cell + 1]; ++at) {
        const std::uint32_t face = p.cells.items[at];
        const auto loop = p.faces[face];
        const std::size_t n = loop.size();
        const bool forward = (p.cellSigns[at] > 0) == (volume >= 0);
        for (std::size_t i = 0; i < n; ++i) {
            out.corners.push_back(indexInSorted(vertices, loop[forward ? i : (n - i) % n]));
            out.cornerEdges.push_back(indexInSorted(edges, p.faceEdges[face][forward ? i : n - 1 - i]));
        }
        out.faceSource.push_back(static_cast<std::uint32_t>(p.cells.size()) + face);
        out.cornerBegin.push_back(static_cast<std::uint32_t>(out.corners.size()));
    }
}

// Appends the vertices, edges and 2-faces of the element's shape to `out`, but no entries to vertexBegin, edgeBegin and
// faceBegin. `sources` must be the result of findPartsShowing() for the element. Returns the w coordinate of the shape.
double addShape(const CellComplex& p, const Element& element, const PartsShowingElement& sources,
                const geometry::Rotation& turn, SliceSet& out) {
    const std::vector<std::uint32_t>& vertices = sources.ownVertices;
    const double w = addVertices(p.vertices, vertices, static_cast<std::uint32_t>(p.edges.size()), turn, out);
    // The shape has only edges of the object. sources.edges also contains source numbers of slice edges that were cut
    // from 2-faces; they are skipped.
    const auto faces = static_cast<std::uint32_t>(p.faces.size());
    std::vector<std::uint32_t> edges;
    for (const std::uint32_t source : sources.edges) {
        if (source < faces) continue;
        edges.push_back(source - faces);
        const auto [a, b] = p.edges[edges.back()];
        out.edges.push_back({indexInSorted(vertices, a), indexInSorted(vertices, b)});
        out.edgeSource.push_back(source);
    }
    if (element.kind == ElementKind::cell) addCellFaces(p, element.index, vertices, edges, out);
    return w;
}

}  // namespace

void writeElementAsSlice(const Object& object, const Element& element, const geometry::Rotation& orientation,
                         SliceSet& out) {
    const geometry::Rotation turn = rotationToW(object, element, orientation) * orientation;
    PartsShowingElement sources;
    findPartsShowing(object, element, sources);
    out.rotatedVertices.clear();
    out.surfaces.clear();
    out.fogs.clear();
    out.clearSlices();
    const double w = visitElements(
        Overloaded{
            [&](const CellComplex& complex) { return addShape(complex, element, sources, turn, out); },
            [&](const PointCloud& cloud) { return addVertices(cloud.points, sources.ownVertices, 0, turn, out); }},
        object);
    out.planes = {0, 1, 1, w};
    out.vertexBegin.push_back(static_cast<std::uint32_t>(out.vertices.size()));
    out.edgeBegin.push_back(static_cast<std::uint32_t>(out.edges.size()));
    out.faceBegin.push_back(static_cast<std::uint32_t>(out.faceSource.size()));
}

}  // namespace oval4d::slicing
