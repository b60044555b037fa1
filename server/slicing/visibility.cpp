#include "slicing/visibility.hpp"

#include <algorithm>

#include "polytopes/polytope.hpp"
#include "slicing/overloaded.hpp"

namespace oval4d::slicing {

namespace {

using geometry::CellComplex;
using geometry::PointCloud;

void findVisibilities(const CellComplex& p, std::span<const Visibility> ofType, VisibilityBySource& out) {
    const std::size_t cells = p.cells.size(), faces = p.faces.size(), edges = p.edges.size();
    // From cells down to vertices, each element passes its visibility to the elements on its boundary. The index of an
    // entry of `out` is a source number, which says from which element a slice element was cut (see SliceSet).
    out.faces.assign(cells + faces, Visibility::hidden);
    out.edges.assign(faces + edges, Visibility::hidden);
    out.vertices.assign(edges + p.vertices.size(), Visibility::hidden);
    const auto raise = [](Visibility& visibility, Visibility to) { visibility = std::max(visibility, to); };
    for (std::size_t c = 0; c < cells; ++c) {
        const Visibility own = out.faces[c] = ofType[p.typeOfCell[c]];
        for (const std::uint32_t f : p.cells[c]) raise(out.faces[cells + f], own);
    }
    for (std::size_t f = 0; f < faces; ++f) {
        const Visibility own = out.edges[f] = out.faces[cells + f];
        for (const std::uint32_t e : p.faceEdges[f]) raise(out.edges[faces + e], own);
    }
    for (std::size_t e = 0; e < edges; ++e) {
        const Visibility own = out.vertices[e] = out.edges[faces + e];
        for (const std::uint32_t v : p.edges[e]) raise(out.vertices[edges + v], own);
    }
}

std::uint32_t coloringCell(const CellComplex& p, const VisibilityBySource& visibilities, std::uint32_t source) {
    const auto cells = static_cast<std::uint32_t>(p.cells.size());
    if (source < cells) return source;
    const auto& [first, second] = p.faceCells[source - cells];
    return visibilities.face(first) == Visibility::hidden ? second : first;
}

}  // namespace

void findVisibilities(const Object& object, std::span<const Visibility> ofType, VisibilityBySource& out) {
    out = {};
    if (std::ranges::all_of(ofType, [](Visibility visibility) { return visibility == Visibility::full; })) return;
    visitElements(Overloaded{[&](const CellComplex& complex) { findVisibilities(complex, ofType, out); },
                             [](const PointCloud& /*cloud*/) {}},
                  object);
}

void findVisibilities(const Object& object, std::span<const std::uint32_t> hidden, std::span<const std::uint32_t> faded,
                      VisibilityBySource& out) {
    std::vector<Visibility> ofType(infoOf(object).cellTypes.size(), Visibility::full);
    const auto set = [&](std::span<const std::uint32_t> types, Visibility visibility) {
        for (const std::uint32_t type : types) {
            if (type < ofType.size()) ofType[type] = visibility;
        }
    };
    set(faded, Visibility::faded);
    set(hidden, Visibility::hidden);
    findVisibilities(object, ofType, out);
}

Visibility visibilityOf(const Object& object, const VisibilityBySource& visibilities, const Element& element) {
    const auto index = static_cast<std::uint32_t>(element.index);
    switch (element.kind) {
        case ElementKind::vertex:
            return visibilities.vertex(static_cast<std::uint32_t>(elementCount(object, ElementKind::edge)) + index);
        case ElementKind::edge:
            return visibilities.vertex(index);
        case ElementKind::face:
            return visibilities.edge(index);
        case ElementKind::cell:
            break;
    }
    return visibilities.face(index);
}

std::uint32_t coloringCell(const Object& object, const VisibilityBySource& visibilities, std::uint32_t source) {
    return visitElements(
        Overloaded{[&](const CellComplex& complex) { return coloringCell(complex, visibilities, source); },
                   [&](const PointCloud& /*cloud*/) { return source; }},
        object);
}

}  // namespace oval4d::slicing
