#include "scene/presence.hpp"

#include <algorithm>

namespace oval4d::scene {

void findPresences(const geometry::Polytope& polytope, const Kinds& kinds, Presences& out) {
    const std::size_t cells = polytope.cellCount(), faces = polytope.faces.size(), edges = polytope.edges.size();
    out = {};
    if (kinds == Kinds{}) return;
    const auto holds = [](const std::vector<std::uint32_t>& list, std::uint32_t kind) {
        return std::find(list.begin(), list.end(), kind) != list.end();
    };
    std::vector<Presence> ofKind;
    for (std::uint32_t k = 0; k < polytope.kinds.size(); ++k) {
        ofKind.push_back(holds(kinds.hidden, k)  ? Presence::hidden
                         : holds(kinds.faded, k) ? Presence::faded
                                                 : Presence::full);
    }
    // Everything counts on to the elements of one dimension less, as "of" numbers do.
    out.faces.assign(cells + faces, Presence::hidden);
    out.edges.assign(faces + edges, Presence::hidden);
    out.vertices.assign(edges + polytope.vertices.size(), Presence::hidden);
    const auto raise = [](Presence& presence, Presence to) { presence = std::max(presence, to); };
    for (std::size_t c = 0; c < cells; ++c) {
        const Presence own = out.faces[c] = ofKind[polytope.cellKinds[c]];
        for (const std::uint32_t f : polytope.cells[c]) raise(out.faces[cells + f], own);
    }
    for (std::size_t f = 0; f < faces; ++f) {
        const Presence own = out.edges[f] = out.faces[cells + f];
        for (const std::uint32_t e : polytope.faceEdges[f]) raise(out.edges[faces + e], own);
    }
    for (std::size_t e = 0; e < edges; ++e) {
        const Presence own = out.vertices[e] = out.edges[faces + e];
        for (const std::uint32_t v : polytope.edges[e]) raise(out.vertices[edges + v], own);
    }
}

std::uint32_t tintOf(const geometry::Polytope& polytope, const Presences& presences, std::uint32_t of) {
    const auto cells = static_cast<std::uint32_t>(polytope.cellCount());
    if (of < cells) return of;
    const auto& [first, second] = polytope.faceCells[of - cells];
    return presences.face(first) == Presence::hidden ? second : first;
}

}  // namespace oval4d::scene
