#include "polytopes/construction/diminished.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "polytopes/cell_types.hpp"
#include "polytopes/construction/coxeter.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

namespace {

constexpr std::uint32_t kRemoved = 0xffffffffU;

Polytope build600Cell() {
    const CoxeterDiagram diagram = CoxeterDiagram::linear({3, 1}, {3, 1}, {5, 1}, {true, false, false, false});
    return wythoffConstruction("600-cell", diagram, mirrorsOf(diagram));
}

// Returns the vertex loop of a polygon whose edges are given in any order.
std::vector<std::uint32_t> vertexLoopOf(const std::vector<std::array<std::uint32_t, 2>>& edges) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
    for (const auto& [a, b] : edges) {
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    std::vector<std::uint32_t> loop{edges[0][0]};
    std::uint32_t next = edges[0][1];
    while (next != loop[0]) {
        const auto& both = beside.at(next);
        const std::uint32_t on = both[both[0] == loop.back() ? 1 : 0];
        loop.push_back(next);
        next = on;
    }
    return loop;
}

// Cuts off vertices of a polytope whose cells are tetrahedra. Each removed vertex is replaced by a cell, which is the
// convex hull of the vertex's remaining neighbors. If two neighboring vertices are removed, the cells that replace them
// share a polygon, whose corners are the common neighbors of the two vertices.
Polytope diminished(std::string name, const Polytope& whole, const std::vector<bool>& removed) {
    std::vector<glm::dvec4> vertices;
    std::vector<std::uint32_t> newVertex(whole.vertices.size(), kRemoved);
    for (std::size_t v = 0; v < whole.vertices.size(); ++v) {
        if (removed[v]) continue;
        newVertex[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(whole.vertices[v]);
    }
    // Divides the corners of a cell into the removed and the remaining ones.
    const auto partition = [&](const std::set<std::uint32_t>& corners) {
        std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> lostAndKept;
        for (const std::uint32_t v : corners) (removed[v] ? lostAndKept.first : lostAndKept.second).push_back(v);
        return lostAndKept;
    };
    geometry::JaggedArray faces;
    std::vector<std::uint32_t> newFace(whole.faces.size(), kRemoved);
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
        std::vector<std::uint32_t> loop;
        for (const std::uint32_t v : whole.faces[f]) loop.push_back(newVertex[v]);
        if (std::count(loop.begin(), loop.end(), kRemoved) != 0) continue;
        newFace[f] = static_cast<std::uint32_t>(faces.size());
        faces.add(loop);
    }
    geometry::JaggedArray cells;
    std::map<std::uint32_t, std::vector<std::uint32_t>> cellOfLost;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::array<std::uint32_t, 2>>> between;
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
        std::set<std::uint32_t> corners;
        std::vector<std::uint32_t> kept;
        for (const std::uint32_t f : whole.cells[c]) {
            corners.insert(whole.faces[f].begin(), whole.faces[f].end());
            if (newFace[f] != kRemoved) kept.push_back(newFace[f]);
        }
        const auto [lost, remaining] = partition(corners);
        if (lost.empty()) cells.add(kept);
        // A tetrahedron with one removed vertex contributes a triangle to the cell that replaces this vertex. A
        // tetrahedron with two removed vertices contributes an edge to the polygon between the two cells that replace
        // them.
        if (lost.size() == 1) cellOfLost[lost[0]].push_back(kept.at(0));
        if (lost.size() == 2) between[{lost[0], lost[1]}].push_back({newVertex[remaining[0]], newVertex[remaining[1]]});
    }
    for (const auto& [pair, edges] : between) {
        const auto number = static_cast<std::uint32_t>(faces.size());
        faces.add(vertexLoopOf(edges));
        cellOfLost[pair.first].push_back(number);
        cellOfLost[pair.second].push_back(number);
    }
    for (const auto& [ignored, own] : cellOfLost) cells.add(own);
    Polytope p = makePolytope(std::move(name), std::move(vertices), std::move(faces), std::move(cells));
    numberCellTypes(p, cellTypesByNeighbors(p, p.typeOfCell));
    return p;
}

Polytope buildSnub24Cell(std::string name) {
    // In the usual coordinates, scaled to the circumradius 2, the 600-cell has 24 vertices without irrational
    // coordinates: the permutations of (±2, 0, 0, 0) and all (±1, ±1, ±1, ±1). These vertices are those of a 24-cell.
    const Polytope whole = build600Cell();
    const double unit = whole.circumradius / 2;
    std::vector<bool> removed;
    for (const glm::dvec4& v : whole.vertices) {
        bool rational = true;
        for (int i = 0; i < 4; ++i) rational = rational && std::abs(v[i] / unit - std::round(v[i] / unit)) < 1e-6;
        removed.push_back(rational);
    }
    return diminished(std::move(name), whole, removed);
}

Polytope buildGrandAntiprism(std::string name) {
    // Two neighboring vertices and the center span the plane of the first decagon, whose sides are edges of the
    // 600-cell. The second decagon lies in the completely orthogonal plane. `part` is the length of a vertex's
    // projection onto the first plane, in circumradii. It is 1 for a vertex of the first decagon, and 0 for a vertex of
    // the second.
    const Polytope whole = build600Cell();
    const glm::dvec4 u = glm::normalize(whole.vertices[whole.edges[0][0]]);
    glm::dvec4 v = whole.vertices[whole.edges[0][1]];
    v = glm::normalize(v - u * glm::dot(u, v));
    std::vector<bool> removed;
    for (const glm::dvec4& x : whole.vertices) {
        const double part = std::hypot(glm::dot(x, u), glm::dot(x, v)) / whole.circumradius;
        removed.push_back(part < 1e-6 || part > 1 - 1e-6);
    }
    return diminished(std::move(name), whole, removed);
}

/// A recipe for a diminished 600-cell, that is, a 600-cell with some vertices cut off. The constructor takes the
/// numbers of elements, which only building the polytope could compute.
class Diminished600CellRecipe : public Recipe {
  public:
    using BuildFunction = Polytope (*)(std::string name);

    Diminished600CellRecipe(ElementCounts counts, std::uint64_t symmetryOrder, std::string linearNotation,
                            std::string schlaefli, BuildFunction builder)
        : counts_(counts),
          symmetryOrder_(symmetryOrder),
          linearNotation_(std::move(linearNotation)),
          schlaefli_(std::move(schlaefli)),
          builder_(builder) {}

    ElementCounts countElements() const override { return counts_; }
    std::uint64_t symmetryOrder() const override { return symmetryOrder_; }
    std::string linearNotation() const override { return linearNotation_; }
    std::string schlaefli() const override { return schlaefli_; }
    Polytope build(const std::string& name) const override { return builder_(name); }

  private:
    ElementCounts counts_;
    std::uint64_t symmetryOrder_;
    std::string linearNotation_, schlaefli_;
    BuildFunction builder_;
};

}  // namespace

// The 144 cells are 600 − 24 · 20 tetrahedra and 24 icosahedra.
PolytopeDesign snub24CellDesign() {
    return {"snub 24-cell", std::make_shared<Diminished600CellRecipe>(ElementCounts{96, 432, 480, 144}, 576, "s3s4o3o",
                                                                      "s{3,4,3}", buildSnub24Cell)};
}

// The 320 cells are 20 antiprisms and 300 tetrahedra.
PolytopeDesign grandAntiprismDesign() {
    return {"grand antiprism", std::make_shared<Diminished600CellRecipe>(ElementCounts{100, 500, 720, 320}, 400, "", "",
                                                                         buildGrandAntiprism)};
}

}  // namespace oval4d::polytopes
